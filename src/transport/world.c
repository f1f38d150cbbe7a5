/* Steps of a path: to the next surface, to the lights, to emission that lies on the way. */
#include "transport/world.h"

/* A stack of this many sheets with alpha ends a ray: it would be black anyway. */
enum { MAX_PASSES_THROUGH_ALPHA = 256 };

static bool trace(ppmi_walker *walker, const ppmi_ray *ray, ppmi_vertex *vertex)
{
    walker->rays++;
    if (!ppmi_accel_intersect(walker->world->accel, ray, &vertex->hit)) return false;
    ppmi_surface_from_hit(walker->world->scene, &vertex->hit, &vertex->surface);
    return true;
}

/* Whether the ray goes on as if the surface was not there. */
static bool passes_through(ppmi_walker *walker, const ppmi_vertex *vertex, ppmi_vec3 direction,
                           ppmi_ray_kind kind)
{
    const ppmi_material *material = vertex->surface.material;
    if (kind == PPMI_RAY_CAMERA && !material->desc.double_sided && !material->is_solid_glass &&
        vec3_dot(direction, vertex->surface.ng) > 0.0f) {
        return true;
    }
    if (!material->has_alpha) return false;
    const float opacity = ppmi_surface_opacity(walker->world->scene, &vertex->surface);
    if (opacity >= 1.0f) return false;
    return opacity <= 0.0f || ppmi_rng_float(&walker->rng) >= opacity;
}

/* A ray that reaches a solid from its back has come through it. */
static ppmi_vec3 transmittance_to(const ppmi_vertex *vertex, ppmi_vec3 direction)
{
    const ppmi_material *material = vertex->surface.material;
    if (!material->is_solid_glass || vec3_dot(direction, vertex->surface.ng) <= 0.0f) {
        return vec3_splat(1.0f);
    }
    return ppmi_material_transmittance(material, vertex->distance);
}

bool ppmi_walk_to_surface(ppmi_walker *walker, ppmi_ray ray, ppmi_ray_kind kind,
                          ppmi_vertex *out_vertex)
{
    float distance = 0.0f;
    for (int i = 0; i < MAX_PASSES_THROUGH_ALPHA; i++) {
        if (!trace(walker, &ray, out_vertex)) return false;
        distance += out_vertex->hit.t;
        if (!passes_through(walker, out_vertex, ray.direction, kind)) {
            out_vertex->distance = distance;
            out_vertex->transmittance = transmittance_to(out_vertex, ray.direction);
            return true;
        }
        ray = ppmi_surface_ray(&out_vertex->surface, ray.direction);
    }
    return false;
}

float ppmi_walk_visibility(ppmi_walker *walker, ppmi_ray ray)
{
    if (!walker->world->has_alpha) {
        walker->rays++;
        return ppmi_accel_occluded(walker->world->accel, &ray) ? 0.0f : 1.0f;
    }
    float visibility = 1.0f;
    for (int i = 0; i < MAX_PASSES_THROUGH_ALPHA && visibility > 1e-4f; i++) {
        ppmi_vertex vertex;
        if (!trace(walker, &ray, &vertex)) return visibility;
        visibility *= 1.0f - ppmi_surface_opacity(walker->world->scene, &vertex.surface);
        const float left = ray.t_max - vertex.hit.t;
        ray = ppmi_surface_ray(&vertex.surface, ray.direction);
        ray.t_max = left;
        if (!(left > 0.0f)) return visibility;
    }
    return 0.0f;
}

/* From surface to light. Both ends are moved off their surfaces; what is left of rounding grows
 * with the distance, and is taken off it. */
static ppmi_ray shadow_ray(const ppmi_surface *surface, const ppmi_light_sample *light)
{
    const float rounding = 4e-6f;
    ppmi_ray ray = ppmi_surface_ray(surface, light->wi);
    if (light->is_far) return ray;
    const ppmi_vec3 way = vec3_sub(light->target, ray.origin);
    const float distance = vec3_length(way);
    if (!(distance > 0.0f)) return ray;
    ray.direction = vec3_scale(way, 1.0f / distance);
    ray.t_max = distance * (1.0f - rounding);
    return ray;
}

ppmi_vec3 ppmi_walk_light_sample(ppmi_walker *walker, const ppmi_surface *surface,
                                 const ppmi_bsdf *bsdf)
{
    const ppmi_vec3 black = vec3_splat(0.0f);
    if ((bsdf->lobes & ~bsdf->delta_lobes) == 0) return black;
    const ppmi_world *world = walker->world;
    const double u_pick = ppmi_walker_double(walker);
    const float u = ppmi_walker_float(walker), v = ppmi_walker_float(walker);
    ppmi_light_sample light;
    if (!ppmi_lights_sample(world->lights, surface->position, bsdf->frame.n, u_pick, u, v,
                            &light)) {
        return black;
    }
    const ppmi_vec3 f =
        ppmi_bsdf_eval(bsdf, world->albedo, light.wi, PPMI_LOBE_ALL, PPMI_TRANSPORT_RADIANCE);
    if (vec3_is_black(f)) return black;
    const float visibility = ppmi_walk_visibility(walker, shadow_ray(surface, &light));
    if (visibility <= 0.0f) return black;
    const float bsdf_pdf = light.is_delta ? 0.0f : ppmi_bsdf_pdf(bsdf, light.wi, PPMI_LOBE_ALL);
    const float weight = fabsf(ppmi_bsdf_cosine(bsdf, light.wi)) * visibility *
                         ppmi_mis_weight(light.pdf, bsdf_pdf) / light.pdf;
    return vec3_scale(vec3_mul(f, light.radiance), weight);
}

void ppmi_walk_bsdf(const ppmi_walker *walker, const ppmi_vertex *vertex, ppmi_vec3 direction,
                    ppmi_bsdf *out_bsdf)
{
    ppmi_material_point point;
    ppmi_material_evaluate(walker->world->scene, &vertex->surface, &point);
    ppmi_bsdf_make(walker->world->albedo, &vertex->surface, &point, vec3_neg(direction), out_bsdf);
}

ppmi_vec3 ppmi_walk_emission(const ppmi_walker *walker, const ppmi_vertex *vertex,
                             ppmi_vec3 direction, const ppmi_origin *origin)
{
    const ppmi_world *world = walker->world;
    if (!vertex->surface.material->emits) return vec3_splat(0.0f);
    const ppmi_vec3 radiance =
        ppmi_surface_emission(world->scene, &vertex->surface, vec3_neg(direction));
    if (origin->is_delta || vec3_is_black(radiance)) return radiance;
    const float light_pdf = ppmi_lights_pdf_surface(world->lights, &vertex->hit, &vertex->surface,
                                                    direction, vertex->distance);
    return vec3_scale(radiance, ppmi_mis_weight(origin->pdf, light_pdf));
}

ppmi_vec3 ppmi_walk_environment(const ppmi_walker *walker, ppmi_vec3 direction,
                                const ppmi_origin *origin)
{
    const ppmi_lights *lights = walker->world->lights;
    const ppmi_vec3 radiance = ppmi_lights_environment(lights, direction);
    if (origin->is_delta || vec3_is_black(radiance)) return radiance;
    const float light_pdf = ppmi_lights_pdf_environment(lights, origin->normal, direction);
    return vec3_scale(radiance, ppmi_mis_weight(origin->pdf, light_pdf));
}
