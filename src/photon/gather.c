/* Density estimation at a visible point.
 *
 * Kernel: Epanechnikov's, 2 (1 - d^2/r^2), whose mean over the disk is 1 (docs/transport.md has the
 * comparison with the constant one). */
#include "photon/gather.h"

/* A photon further off the tangent plane than this share of the radius lies on something else:
 * a parallel wall, the far side of an edge. */
static const float plane_tolerance = 0.3f;
/* Cosine between the geometric normals of photon and point. */
static const float normal_tolerance = 0.7f;

enum { CANDIDATES = 64 };

ppm_status ppmi_visible_points_init(ppm_context *context, ppmi_visible_points *points,
                                    uint32_t capacity)
{
    *points = (ppmi_visible_points){
        .capacity = capacity,
        .is_valid = ppmi_alloc(context, capacity, sizeof *points->is_valid),
        .x = ppmi_alloc(context, capacity, sizeof *points->x),
        .y = ppmi_alloc(context, capacity, sizeof *points->y),
        .z = ppmi_alloc(context, capacity, sizeof *points->z),
        .footprint = ppmi_alloc(context, capacity, sizeof *points->footprint),
        .throughput = ppmi_alloc(context, capacity, sizeof *points->throughput),
        .bsdf = ppmi_alloc(context, capacity, sizeof *points->bsdf),
    };
    if (points->is_valid && points->x && points->y && points->z && points->footprint &&
        points->throughput && points->bsdf) {
        return PPM_STATUS_OK;
    }
    ppmi_visible_points_deinit(context, points);
    return ppmi_fail(context, PPM_STATUS_OUT_OF_MEMORY, "out of memory: visible points");
}

void ppmi_visible_points_deinit(ppm_context *context, ppmi_visible_points *points)
{
    ppmi_free(context, points->is_valid);
    ppmi_free(context, points->x);
    ppmi_free(context, points->y);
    ppmi_free(context, points->z);
    ppmi_free(context, points->footprint);
    ppmi_free(context, points->throughput);
    ppmi_free(context, points->bsdf);
    *points = (ppmi_visible_points){0};
}

/* Photons arrive by the geometric normal's cosine, the BSDF means the shading normal's. */
static float cosine_ratio(const ppmi_bsdf *bsdf, ppmi_vec3 wi)
{
    const float geometric = vec3_dot(wi, bsdf->ng);
    return geometric > 1e-4f ? ppmi_min(ppmi_bsdf_cosine(bsdf, wi) / geometric, 1e2f) : 0.0f;
}

static void add_photon(const ppmi_photon_payload *photon, const ppmi_bsdf *bsdf,
                       const ppmi_albedo_table *albedo, float kernel, ppmi_gathered *gathered)
{
    if (vec3_dot(photon->ng, bsdf->ng) < normal_tolerance) return;
    const ppmi_vec3 f =
        ppmi_bsdf_eval(bsdf, albedo, photon->wi, bsdf->gather_lobes, PPMI_TRANSPORT_RADIANCE);
    const ppmi_vec3 contribution =
        vec3_scale(vec3_mul(f, photon->power), kernel * cosine_ratio(bsdf, photon->wi));
    if (vec3_is_black(contribution)) return;
    gathered->flux = vec3_add(gathered->flux, contribution);
    gathered->count += 1.0f;
}

/* The photons of a block that lie within the disk: index and squared distance. The tests come
 * first, for all, so that they are vectorised; picking follows without a branch. */
static uint32_t select_block(const ppmi_photon_grid *grid, uint32_t begin, uint32_t count,
                             ppmi_vec3 p, ppmi_vec3 n, float radius2, float thickness,
                             uint32_t *indices, float *distances2)
{
    const float *x = grid->x + begin, *y = grid->y + begin, *z = grid->z + begin;
    float all_distances2[CANDIDATES];
    uint32_t is_inside[CANDIDATES];
    for (uint32_t i = 0; i < count; i++) {
        const float dx = x[i] - p.x, dy = y[i] - p.y, dz = z[i] - p.z;
        all_distances2[i] = dx * dx + dy * dy + dz * dz;
        const float off_plane = fabsf(dx * n.x + dy * n.y + dz * n.z);
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

ppmi_gathered ppmi_gather(const ppmi_photon_grid *grid, const ppmi_albedo_table *albedo,
                          const ppmi_visible_points *points, uint32_t i, float radius)
{
    const ppmi_vec3 p = vec3(points->x[i], points->y[i], points->z[i]);
    const ppmi_bsdf *bsdf = &points->bsdf[i];
    const float radius2 = radius * radius, thickness = radius * plane_tolerance;
    ppmi_photon_run runs[PPMI_GRID_MAX_RUNS];
    const uint32_t run_count = ppmi_photon_grid_lookup(grid, p, radius, bsdf->ng, thickness, runs);
    ppmi_gathered gathered = {0};
    for (uint32_t r = 0; r < run_count; r++) {
        for (uint32_t begin = runs[r].begin; begin < runs[r].end; begin += CANDIDATES) {
            const uint32_t left = runs[r].end - begin;
            const uint32_t count = left < CANDIDATES ? left : CANDIDATES;
            uint32_t indices[CANDIDATES];
            float distances2[CANDIDATES];
            const uint32_t selected = select_block(grid, begin, count, p, bsdf->ng, radius2,
                                                   thickness, indices, distances2);
            for (uint32_t k = 0; k < selected; k++) {
                const float kernel = 2.0f * (1.0f - distances2[k] / radius2);
                add_photon(&grid->payloads[indices[k]], bsdf, albedo, kernel, &gathered);
            }
        }
    }
    return gathered;
}
