/* Filters of hits. What they answer depends on the hit alone and not on the order of the search, so
 * that pictures do not depend on how a tree was built: lots are drawn by a hash of the hit, and
 * products summed up as whole numbers. */
#include "transport/passing.h"

/* Whether a material's surfaces have to be looked at. */
static const ppmi_material *material_of(const ppm_scene *scene, const ppmi_hit *hit)
{
    const ppmi_mesh *mesh = &scene->meshes[scene->instances[hit->instance].mesh];
    return &scene->materials[mesh->primitives[hit->primitive].material];
}

bool ppmi_is_cut_away(const ppm_scene *scene, const ppmi_surface *surface)
{
    return surface->material->has_alpha && ppmi_surface_opacity(scene, surface) < 0.5f;
}

/* ---- paths ----------------------------------------------------------------------------------- */

typedef struct path_filter {
    ppmi_hit_filter base;
    const ppm_scene *scene;
    ppmi_vec3 direction;
    uint64_t seed; /* of lots */
    bool is_of_camera, rounds;
} path_filter;

/* In 0 .. 1, as good as drawn for each hit. */
static float lot(uint64_t seed, const ppmi_hit *hit)
{
    union {
        float t;
        uint32_t bits;
    } place = {hit->t};
    const uint64_t what = ((uint64_t)hit->instance << 32) ^ ((uint64_t)hit->primitive << 48);
    const uint64_t where = ((uint64_t)hit->triangle << 32) | place.bits;
    return ppmi_unit_float((uint32_t)(ppmi_hash64(ppmi_hash64(seed ^ what) ^ where) >> 32));
}

static bool passes(ppmi_hit_filter *base, const ppmi_hit *hit)
{
    const path_filter *filter = (const path_filter *)base;
    const ppmi_material *material = material_of(filter->scene, hit);
    const bool has_unseen_back =
        filter->is_of_camera && !material->desc.double_sided && !material->is_solid_glass;
    if (!has_unseen_back && !material->has_alpha) return false;
    ppmi_surface surface;
    ppmi_surface_from_hit(filter->scene, hit, &surface);
    if (has_unseen_back && vec3_dot(filter->direction, surface.ng) > 0.0f) return true;
    if (!material->has_alpha) return false;
    const float opacity = ppmi_surface_opacity(filter->scene, &surface);
    if (filter->rounds) return opacity < 0.5f;
    return opacity < 1.0f && lot(filter->seed, hit) >= opacity;
}

static bool intersect(const ppmi_world *world, const ppmi_ray *ray, path_filter *filter,
                      ppmi_hit *out_hit)
{
    if (!world->has_alpha && !(filter->is_of_camera && world->has_single_sided)) {
        return ppmi_accel_intersect(world->accel, ray, out_hit);
    }
    filter->base.passes = passes;
    filter->scene = world->scene;
    filter->direction = ray->direction;
    return ppmi_accel_intersect_filtered(world->accel, ray, &filter->base, out_hit);
}

bool ppmi_passing_intersect(ppmi_walker *walker, const ppmi_ray *ray, ppmi_ray_kind kind,
                            ppmi_hit *out_hit)
{
    path_filter filter = {.is_of_camera = kind == PPMI_RAY_CAMERA,
                          .rounds = walker->rounds_opacity};
    if (walker->world->has_alpha) {
        filter.seed = (uint64_t)ppmi_rng_u32(&walker->rng) << 32;
        filter.seed |= ppmi_rng_u32(&walker->rng);
    }
    return intersect(walker->world, ray, &filter, out_hit);
}

bool ppmi_passing_intersect_rounded(const ppmi_world *world, const ppmi_ray *ray,
                                    ppmi_ray_kind kind, ppmi_hit *out_hit)
{
    path_filter filter = {.is_of_camera = kind == PPMI_RAY_CAMERA, .rounds = true};
    return intersect(world, ray, &filter, out_hit);
}

/* ---- shadow rays ----------------------------------------------------------------------------- */

/* Fixed point of binary logarithms, and what is taken as opaque: 2^-40. */
#define ONE_LOG2 4294967296.0f
enum { OPAQUE_LOG2 = 40 };

typedef struct shadow_filter {
    ppmi_hit_filter base;
    const ppmi_world *world;
    ppmi_vec3 direction;
    int64_t depth[3]; /* -log2 of the product, by channel */
} shadow_filter;

/* What the material lets straight through, where there is a surface. Made as for an eye path that
 * goes the ray's way. */
static ppmi_vec3 straight_through(const ppmi_world *world, const ppmi_surface *surface,
                                  ppmi_vec3 direction)
{
    ppmi_material_point point;
    ppmi_bsdf bsdf;
    ppmi_material_evaluate(world->scene, surface, &point);
    ppmi_bsdf_make(world->albedo, surface, &point, vec3_neg(direction), &bsdf);
    return ppmi_bsdf_straight(&bsdf, world->albedo);
}

/* What a hit leaves of the light. */
static ppmi_vec3 left_by(const ppmi_world *world, const ppmi_hit *hit, ppmi_vec3 direction)
{
    const ppmi_material *material = material_of(world->scene, hit);
    ppmi_vec3 left = vec3_splat(0.0f);
    if (!material->has_alpha && !material->is_sheet) return left;
    ppmi_surface surface;
    ppmi_surface_from_hit(world->scene, hit, &surface);
    const float opacity = ppmi_surface_opacity(world->scene, &surface);
    if (material->is_sheet && opacity > 0.0f) left = straight_through(world, &surface, direction);
    return vec3_mad(vec3_splat(1.0f - opacity), left, opacity);
}

static int64_t depth_of(float left)
{
    if (!(left > 0.0f)) return OPAQUE_LOG2 * (int64_t)ONE_LOG2;
    return left < 1.0f ? (int64_t)(-ONE_LOG2 * log2f(left)) : 0;
}

static bool dims(ppmi_hit_filter *base, const ppmi_hit *hit)
{
    shadow_filter *filter = (shadow_filter *)base;
    const ppmi_vec3 left = left_by(filter->world, hit, filter->direction);
    if (vec3_is_black(left)) return false;
    filter->depth[0] += depth_of(left.x);
    filter->depth[1] += depth_of(left.y);
    filter->depth[2] += depth_of(left.z);
    bool is_opaque = true;
    for (int i = 0; i < 3; i++)
        is_opaque = is_opaque && filter->depth[i] >= OPAQUE_LOG2 * (int64_t)ONE_LOG2;
    return !is_opaque;
}

static float product(int64_t depth)
{
    if (depth >= OPAQUE_LOG2 * (int64_t)ONE_LOG2) return 0.0f;
    return exp2f(-(float)depth / ONE_LOG2);
}

ppmi_vec3 ppmi_passing_visibility(const ppmi_world *world, const ppmi_ray *ray)
{
    if (!world->has_alpha && !world->has_sheets) {
        return vec3_splat(ppmi_accel_occluded(world->accel, ray) ? 0.0f : 1.0f);
    }
    shadow_filter filter = {.base = {dims}, .world = world, .direction = ray->direction};
    if (ppmi_accel_occluded_filtered(world->accel, ray, &filter.base)) return vec3_splat(0.0f);
    return vec3(product(filter.depth[0]), product(filter.depth[1]), product(filter.depth[2]));
}
