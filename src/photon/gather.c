/* Density estimation at a visible point.
 *
 * Kernel: Epanechnikov's, 1 - d^2/r^2 times what makes its mean 1 over the disk or the ball
 * (docs/transport.md has the comparison with the constant one). */
#include "photon/gather.h"

#include "photon/adjoint.h"

/* No photon of a disk is further from its centre than this, in radii: its distance counts in the
 * tangent plane. */
static const float disk_reach = 1.05f;

enum { CANDIDATES = 64 };

static const float disk_kernel = 2.0f, ball_kernel = 2.5f;

/* Photons arrive by the cosine of the facet that they land on, the BSDF means the shading normal's
 * (Veach 1997, section 5.3.2). It is the photon's own facet: on a coarse mesh that of the point
 * tells neither how many came there nor whether any could. */
static float cosine_ratio(const ppmi_bsdf *bsdf, ppmi_vec3 wi, ppmi_vec3 ng)
{
    return ppmi_adjoint_arrival(ppmi_bsdf_cosine(bsdf, wi), vec3_dot(wi, ng));
}

/* Whether a photon's normal says that it lies on the point's surface: on the same side of it, or
 * where light comes through diffusely on the other one. */
static bool is_on_surface(const ppmi_bsdf *bsdf, ppmi_vec3 ng)
{
    const float cosine = vec3_dot(ng, bsdf->ng);
    return cosine >= PPMI_REGION_COSINE ||
           (cosine <= -PPMI_REGION_COSINE &&
            bsdf->gather_lobes & (PPMI_LOBE_THROUGH | PPMI_LOBE_GLASS));
}

/* The share of a photon that narrow lobes take (the balance heuristic): what paths that go on by
 * them cannot find, all of it where they meet no such light. */
static float merge_share(const ppmi_visible_point *point, const ppmi_photon_payload *photon)
{
    if (photon->crowding == INFINITY) return 1.0f;
    const ppmi_bsdf *bsdf = &point->bsdf;
    const float merging = ppmi_merging(bsdf, bsdf->gather_lobes, point->merge_area_m2, photon->wi);
    return 1.0f - 1.0f / (1.0f + merging * photon->crowding);
}

/* Whether the photon counted. */
static bool add_photon(const ppmi_photon_payload *photon, const ppmi_visible_point *point,
                       const ppmi_albedo_table *albedo, float kernel, ppmi_gathered *gathered,
                       ppmi_vec3 *out_contribution)
{
    const ppmi_bsdf *bsdf = &point->bsdf;
    float share = 1.0f;
    if (point->merge_area_m2 > 0.0f) {
        if (!(photon->crowding > 0.0f)) return false;
        share = merge_share(point, photon);
        kernel *= share;
    }
    ppmi_vec3 ng = photon->ng;
    if (!ppmi_bsdf_is_phase(bsdf)) {
        if (!is_on_surface(bsdf, ng)) return false;
        if (vec3_dot(ng, bsdf->ng) < 0.0f) ng = vec3_neg(ng);
        kernel *= cosine_ratio(bsdf, photon->wi, ng);
    }
    const ppmi_vec3 f = ppmi_bsdf_eval_from(bsdf, albedo, photon->wi, ng, bsdf->gather_lobes,
                                            PPMI_TRANSPORT_RADIANCE);
    const ppmi_vec3 contribution = vec3_scale(vec3_mul(f, photon->power), kernel);
    if (vec3_is_black(contribution)) return false;
    *out_contribution = contribution;
    gathered->flux = vec3_add(gathered->flux, contribution);
    gathered->count += share;
    return true;
}

/* The photons of a block that lie within the disk or ball: index and squared distance, of a disk in
 * its plane: in_plane is 1. The tests come first, for all, so that they are vectorised; picking
 * follows without a branch. */
static uint32_t select_block(const ppmi_photon_grid *grid, uint32_t begin, uint32_t count,
                             ppmi_vec3 p, ppmi_vec3 n, float radius2, float thickness,
                             float in_plane, uint32_t *indices, float *distances2)
{
    const float *x = grid->x + begin, *y = grid->y + begin, *z = grid->z + begin;
    float all_distances2[CANDIDATES];
    uint32_t is_inside[CANDIDATES];
    for (uint32_t i = 0; i < count; i++) {
        const float dx = x[i] - p.x, dy = y[i] - p.y, dz = z[i] - p.z;
        const float off_plane = fabsf(dx * n.x + dy * n.y + dz * n.z);
        all_distances2[i] = dx * dx + dy * dy + dz * dz - in_plane * off_plane * off_plane;
        is_inside[i] = (all_distances2[i] < radius2) & (off_plane <= thickness);
    }
    uint32_t selected = 0;
    for (uint32_t i = 0; i < count; i++) {
        indices[selected] = begin + i;
        distances2[selected] = all_distances2[i];
        selected += is_inside[i];
    }
    return selected;
}

static ppmi_vec3 place_of(const ppmi_photon_grid *grid, uint32_t index)
{
    return vec3(grid->x[index], grid->y[index], grid->z[index]);
}

bool ppmi_gather_has_candidates(const ppmi_photon_grid *grid, const ppmi_visible_point *point,
                                float radius)
{
    const ppmi_bsdf *bsdf = &point->bsdf;
    const float thickness = radius * PPMI_REGION_BELOW;
    ppmi_photon_run runs[PPMI_GRID_MAX_RUNS];
    const uint32_t run_count = ppmi_photon_grid_lookup(grid, point->position, radius * disk_reach,
                                                       bsdf->ng, thickness, runs);
    for (uint32_t r = 0; r < run_count; r++) {
        for (uint32_t begin = runs[r].begin; begin < runs[r].end; begin += CANDIDATES) {
            const uint32_t left = runs[r].end - begin;
            uint32_t indices[CANDIDATES];
            float distances2[CANDIDATES];
            const uint32_t selected =
                select_block(grid, begin, left < CANDIDATES ? left : CANDIDATES, point->position,
                             bsdf->ng, radius * radius, thickness, 1.0f, indices, distances2);
            for (uint32_t k = 0; k < selected; k++) {
                if (is_on_surface(bsdf, grid->payloads[indices[k]].ng)) return true;
            }
        }
    }
    return false;
}

static ppmi_vec3 share_of_255(const uint8_t share[3])
{
    return vec3((float)share[0] / 255.0f, (float)share[1] / 255.0f, (float)share[2] / 255.0f);
}

static void add_to_layers(const ppmi_gather_layers *layers, const ppmi_visible_point *point,
                          const ppmi_albedo_table *albedo, uint32_t photon, ppmi_vec3 contribution)
{
    const ppmi_photon_tag *tag = &layers->photons[photon].tag;
    /* on lobes that the path goes on by, light is no caustic: it is seen mirrored */
    const bool is_narrow = point->merge_area_m2 > 0.0f;
    const ppmi_photon_light light = {.radiance = vec3_mul(contribution, layers->factor),
                                     .wi = layers->photons[photon].wi,
                                     .caustic =
                                         is_narrow ? vec3_splat(0.0f) : share_of_255(tag->caustic),
                                     .is_straight = tag->is_straight != 0,
                                     .group = tag->group};
    ppmi_light_sink_add_photon(layers->sink, point->eye_class, &point->bsdf, albedo, &light);
}

static void add_to_marks(const ppmi_gather_marks *marks, const ppmi_visible_point *point,
                         uint32_t photon, ppmi_vec3 contribution)
{
    const float most = 1e12f;
    const float share = vec3_mean(vec3_mul(contribution, point->throughput)) * marks->scale;
    const float rounded = share < most ? share + 0.5f : most;
    atomic_fetch_add_explicit(&marks->sums[photon], (uint64_t)rounded, memory_order_relaxed);
}

/* region, marks and layers may be NULL. */
static inline __attribute__((always_inline)) ppmi_gathered
gather(const ppmi_photon_grid *grid, const ppmi_albedo_table *albedo,
       const ppmi_visible_point *point, float radius, const ppmi_gather_region *region,
       const ppmi_gather_marks *marks, const ppmi_gather_layers *layers)
{
    const ppmi_bsdf *bsdf = &point->bsdf;
    const bool is_phase = ppmi_bsdf_is_phase(bsdf);
    const bool is_part = region && !region->is_whole;
    float kernel = is_phase ? ball_kernel : disk_kernel;
    ppmi_gathered gathered = {.share = 1.0f};
    if (region) {
        const float enlarged = radius / region->radius;
        gathered.is_crowded = enlarged > 1.5f;
        gathered.share = region->share / (enlarged * enlarged);
        kernel /= gathered.share;
        radius = region->radius;
    }
    const float radius2 = radius * radius;
    const float thickness = is_phase ? INFINITY : radius * PPMI_REGION_BELOW;
    ppmi_photon_run runs[PPMI_GRID_MAX_RUNS];
    const uint32_t run_count = ppmi_photon_grid_lookup(
        grid, point->position, is_phase ? radius : radius * disk_reach, bsdf->ng, thickness, runs);
    for (uint32_t r = 0; r < run_count; r++) {
        for (uint32_t begin = runs[r].begin; begin < runs[r].end; begin += CANDIDATES) {
            const uint32_t left = runs[r].end - begin;
            const uint32_t count = left < CANDIDATES ? left : CANDIDATES;
            uint32_t indices[CANDIDATES];
            float distances2[CANDIDATES];
            const uint32_t selected =
                select_block(grid, begin, count, point->position, bsdf->ng, radius2, thickness,
                             is_phase ? 0.0f : 1.0f, indices, distances2);
            for (uint32_t k = 0; k < selected; k++) {
                if (is_part && (!is_on_surface(bsdf, grid->payloads[indices[k]].ng) ||
                                !ppmi_region_holds(region, place_of(grid, indices[k])))) {
                    continue;
                }
                ppmi_vec3 contribution;
                const bool counts =
                    add_photon(&grid->payloads[indices[k]], point, albedo,
                               kernel * (1.0f - distances2[k] / radius2), &gathered, &contribution);
                if (layers && counts) {
                    add_to_layers(layers, point, albedo, grid->order[indices[k]], contribution);
                }
                if (marks && counts) {
                    add_to_marks(marks, point, grid->order[indices[k]], contribution);
                }
            }
        }
    }
    return gathered;
}

ppmi_gathered ppmi_gather(const ppmi_photon_grid *grid, const ppmi_albedo_table *albedo,
                          const ppmi_visible_point *point, float radius,
                          const ppmi_gather_region *region)
{
    return gather(grid, albedo, point, radius, region, NULL, NULL);
}

ppmi_gathered ppmi_gather_with_layers(const ppmi_photon_grid *grid, const ppmi_albedo_table *albedo,
                                      const ppmi_visible_point *point, float radius,
                                      const ppmi_gather_region *region,
                                      const ppmi_gather_layers *layers)
{
    return gather(grid, albedo, point, radius, region, NULL, layers);
}

void ppmi_gather_mark(const ppmi_photon_grid *grid, const ppmi_albedo_table *albedo,
                      const ppmi_visible_point *point, float radius,
                      const ppmi_gather_region *region, const ppmi_gather_marks *marks)
{
    gather(grid, albedo, point, radius, region, marks, NULL);
}
