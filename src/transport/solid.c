/* Nested dielectrics (transport/interior.h has the rule) and surfaces that touch.
 *
 * Solids that touch (water poured into a glass and exported with the glass's own faces, a glass on
 * a table) have surfaces at one place, in an order that rounding decides, and the origin of the
 * next ray is moved past all of them. So the neighbourhood of each hit is searched, within the
 * bound of its rounding error, and what lies there is crossed at once: all solids' surfaces as one
 * interface; something opaque takes the solid's place, as if in optical contact. */
#include "transport/solid.h"

#include "transport/passing.h"

/* Hits of surfaces at one place: each counts twice on the edge between two triangles. */
enum { MAX_TOUCHING = 12 };

static bool is_entered(const ppmi_surface *surface, ppmi_vec3 direction)
{
    return vec3_dot(direction, surface->ng) < 0.0f;
}

/* What the surface itself says: its solid is on the one side and not on the other. */
static void cross(const ppmi_surface *surface, ppmi_vec3 direction, ppmi_interior *before,
                  ppmi_interior *behind)
{
    const uint32_t material = surface->primitive->material;
    if (is_entered(surface, direction)) {
        ppmi_interior_leave(before, material);
        ppmi_interior_enter(behind, material);
    } else {
        if (!ppmi_interior_has(before, material)) ppmi_interior_enter(before, material);
        ppmi_interior_leave(behind, material);
    }
}

static bool is_same_part(const ppmi_hit *a, const ppmi_hit *b)
{
    return a->instance == b->instance && a->primitive == b->primitive;
}

/* Crosses what lies within a few error bounds of the vertex, other than its own mesh. */
static void cross_touching(ppmi_walker *walker, ppmi_vec3 direction, ppmi_vertex *vertex)
{
    const ppmi_world *world = walker->world;
    const float window = 3.0f * vertex->surface.error;
    const float cosine = ppmi_max(fabsf(vec3_dot(direction, vertex->surface.ng)), 0.05f);
    const ppmi_hit own = vertex->hit;
    const float depth = window / cosine;
    if (!ppmi_contacts_may_touch(world->contacts, own.instance, own.primitive,
                                 vertex->surface.position, depth)) {
        return;
    }
    const float back = ppmi_min(depth, 0.9f * vertex->hit.t); /* not behind where the ray began */
    const ppmi_ray probe = {.origin = vec3_mad(vertex->surface.position, direction, -back),
                            .t_max = back + depth,
                            .direction = direction,
                            .time = walker->time};
    ppmi_hit hits[MAX_TOUCHING];
    walker->rays++;
    const uint32_t count = ppmi_accel_intersect_all(world->accel, &probe, hits, MAX_TOUCHING);
    for (uint32_t i = 0; i < count; i++) {
        if (is_same_part(&hits[i], &own)) continue;
        ppmi_surface surface;
        ppmi_surface_from_hit(world->scene, &hits[i], &surface);
        if (ppmi_is_cut_away(world->scene, &surface)) continue;
        vertex->surface.error = ppmi_max(vertex->surface.error, window);
        if (surface.material->is_solid_glass) {
            cross(&surface, direction, &walker->interior, &vertex->behind);
        } else if (!surface.material->has_alpha && surface.material->desc.transmission == 0.0f) {
            vertex->hit = hits[i];
            vertex->surface = surface;
            vertex->surface.error = ppmi_max(surface.error, window);
            return;
        }
    }
}

bool ppmi_solid_arrive(ppmi_walker *walker, ppmi_vec3 direction, ppmi_vertex *vertex)
{
    const ppm_scene *scene = walker->world->scene;
    vertex->behind = walker->interior;
    cross(&vertex->surface, direction, &walker->interior, &vertex->behind);
    cross_touching(walker, direction, vertex);
    if (!vertex->surface.material->is_solid_glass) return true;
    return ppmi_interior_material(&walker->interior, scene) !=
           ppmi_interior_material(&vertex->behind, scene);
}

/* ---- indices --------------------------------------------------------------------------------- */

static const ppm_material_desc *desc_of(const ppm_scene *scene, const ppmi_interior *interior)
{
    const uint32_t material = ppmi_interior_material(interior, scene);
    return material == PPMI_OUTSIDE ? NULL : &scene->materials[material].desc;
}

static float index_at(const ppm_material_desc *desc, float wavelength_nm)
{
    if (!desc) return 1.0f;
    const float index = ppmi_dielectric_index(desc->ior);
    if (wavelength_nm <= 0.0f || !(desc->dispersion > 0.0f)) return index;
    return ppmi_cauchy_index(index, desc->dispersion, wavelength_nm);
}

static bool disperses(const ppm_material_desc *desc)
{
    return desc && desc->dispersion > 0.0f;
}

void ppmi_solid_refract(ppmi_walker *walker, ppmi_vec3 direction, ppmi_vertex *vertex)
{
    const ppmi_world *world = walker->world;
    const ppm_material_desc *before = desc_of(world->scene, &walker->interior);
    const ppm_material_desc *behind = desc_of(world->scene, &vertex->behind);
    float wavelength = walker->wavelength_nm;
    if (wavelength <= 0.0f && (disperses(before) || disperses(behind))) {
        wavelength = ppmi_spectrum_sample(world->spectrum, ppmi_walker_float(walker));
        vertex->drawn_wavelength = wavelength;
        /* total reflection comes at another angle for each colour */
        const float blue =
            index_at(behind, PPMI_SPECTRUM_FIRST_NM) / index_at(before, PPMI_SPECTRUM_FIRST_NM);
        const float red =
            index_at(behind, PPMI_SPECTRUM_LAST_NM) / index_at(before, PPMI_SPECTRUM_LAST_NM);
        const float cosine = vec3_dot(direction, vertex->surface.ns);
        vertex->splits_always = 1.0f - cosine * cosine > 0.8f * ppmi_sqr(ppmi_min(blue, red));
    }
    vertex->relative_index = index_at(behind, wavelength) / index_at(before, wavelength);
}

/* ---- where a path begins --------------------------------------------------------------------- */

/* A solid whose first surface on the way is left there is one that the way began in. What is left
 * last is entered first. */
ppmi_interior ppmi_solids_around_at(const ppmi_world *world, ppmi_vec3 position, float time)
{
    enum { MAX_SURFACES = 256 };
    ppmi_interior around = {0}, seen = {0};
    ppmi_ray ray = {
        .origin = position, .t_max = INFINITY, .direction = {0.0f, 1.0f, 0.0f}, .time = time};
    for (int i = 0; i < MAX_SURFACES; i++) {
        ppmi_hit hit;
        if (!ppmi_passing_intersect_rounded(world, &ray, PPMI_RAY_OTHER, &hit)) break;
        ppmi_surface surface;
        ppmi_surface_from_hit(world->scene, &hit, &surface);
        const uint32_t material = surface.primitive->material;
        if (surface.material->is_solid_glass && !ppmi_interior_has(&seen, material)) {
            ppmi_interior_enter(&seen, material);
            if (!is_entered(&surface, ray.direction)) ppmi_interior_enter(&around, material);
        }
        ray = ppmi_surface_ray(&surface, ray.direction);
    }
    ppmi_interior ordered = {0};
    for (uint32_t i = around.count; i > 0; i--)
        ppmi_interior_enter(&ordered, around.materials[i - 1]);
    return ordered;
}

ppmi_interior ppmi_solids_around_photon(const ppmi_world *world, const ppmi_ray *ray, bool is_far,
                                        ppmi_solids_memory *memory)
{
    if (is_far || !ppmi_columns_hold(&world->columns, ray->origin)) return (ppmi_interior){0};
    const ppmi_vec3 p = memory->position, q = ray->origin;
    const bool is_known =
        memory->is_known && p.x == q.x && p.y == q.y && p.z == q.z && memory->time == ray->time;
    if (!is_known) {
        memory->is_known = true;
        memory->position = ray->origin;
        memory->time = ray->time;
        memory->interior = ppmi_solids_around_at(world, ray->origin, ray->time);
    }
    return memory->interior;
}
