/* Photons at leaning normals. */
#include "photon/adjoint.h"

enum { MAX_SPLIT = 64 };

/* Lobes that are drawn around the geometric normal, by whose cosine photons leave. */
enum { DIFFUSE_LOBES = PPMI_LOBE_WIDE | PPMI_LOBE_SHEEN };

/* Directions are drawn around the geometric normal, around its back, from those above the surface
 * but below the shading normal's horizon, or by the other lobes. */
typedef struct techniques {
    float front, back, below, other; /* probabilities */
    uint32_t others;                 /* lobes */
    float lean;                      /* 1 - the cosine between the normals */
} techniques;

static float of_arrival(ppmi_vec3 n, ppmi_vec3 ng, ppmi_vec3 wi)
{
    return ppmi_adjoint_arrival(vec3_dot(n, wi), vec3_dot(ng, wi));
}

uint32_t ppmi_adjoint_split(const ppmi_bsdf *bsdf, ppmi_vec3 wi)
{
    if (!ppmi_adjoint_leans(bsdf)) return 1;
    const float factor = of_arrival(bsdf->frame.n, bsdf->ng, wi);
    return (uint32_t)ppmi_clampf(factor, 1.0f, (float)MAX_SPLIT);
}

/* Wide reflections are seen from below their normal's horizon too. */
static techniques techniques_of(const ppmi_bsdf *bsdf)
{
    techniques t = {.others = bsdf->lobes & ~(uint32_t)(DIFFUSE_LOBES | PPMI_LOBE_THROUGH),
                    .lean = 1.0f - vec3_dot(bsdf->frame.n, bsdf->ng)};
    const uint32_t wide = t.others & bsdf->gather_lobes;
    t.front = ppmi_bsdf_probability(bsdf, DIFFUSE_LOBES);
    t.back = ppmi_bsdf_probability(bsdf, PPMI_LOBE_THROUGH);
    t.below = ppmi_min(4.0f * t.lean, 0.25f) * ppmi_bsdf_probability(bsdf, wide);
    t.other = ppmi_bsdf_probability(bsdf, t.others) - t.below;
    return t;
}

static bool is_below(const ppmi_bsdf *bsdf, ppmi_vec3 wo)
{
    return vec3_dot(wo, bsdf->ng) > 0.0f && vec3_dot(wo, bsdf->frame.n) <= 0.0f;
}

static float density(const ppmi_bsdf *bsdf, const techniques *t, ppmi_vec3 wo)
{
    const float cosine = vec3_dot(wo, bsdf->ng);
    float around_normal = cosine > 0.0f ? t->front : t->back;
    if (is_below(bsdf, wo)) around_normal += t->below * 2.0f / t->lean;
    return around_normal * fabsf(cosine) * PPMI_INV_PI +
           t->other * ppmi_bsdf_pdf(bsdf, wo, t->others);
}

/* From those below the shading normal's horizon, by the geometric cosine: evenly from where they
 * lie on the unit disk, between its rim and half an ellipse (Malley's method). */
static ppmi_vec3 draw_below(const ppmi_bsdf *bsdf, float lean, float u, float v)
{
    const ppmi_vec3 along =
        vec3_normalize(vec3_mad(bsdf->frame.n, bsdf->ng, lean - 1.0f)); /* n without its ng */
    const ppmi_vec3 local = ppmi_sample_cosine_hemisphere(u, v);
    const float rim = sqrtf(ppmi_max(1.0f - local.y * local.y, 0.0f));
    const float x = -(rim * (1.0f - lean) + lean * fabsf(local.x));
    const float z = sqrtf(ppmi_max(rim * rim - x * x, 0.0f));
    const ppmi_vec3 flat = vec3_mad(vec3_scale(along, x), vec3_cross(bsdf->ng, along), local.y);
    return vec3_normalize(vec3_mad(flat, bsdf->ng, z));
}

/* Mirrors and smooth glass: Veach's factor, whose cosines to the shading normal are finite. */
static void weigh_delta(const ppmi_bsdf *bsdf, const techniques *t, ppmi_vec3 wi,
                        ppmi_bsdf_sample *sample)
{
    const float numerator = fabsf(vec3_dot(wi, bsdf->frame.n) * vec3_dot(sample->wi, bsdf->ng));
    const float denominator = fabsf(vec3_dot(wi, bsdf->ng) * vec3_dot(sample->wi, bsdf->frame.n));
    const float factor = denominator > 1e-8f ? ppmi_min(numerator / denominator, 1e2f) : 1.0f;
    sample->weight = vec3_scale(sample->weight, factor / t->other);
}

/* What an eye along the drawn direction sees of light from wi. Narrow lobes are left out where
 * their own draw does not reach: from below their horizon they would be seen in rare bright spots.
 */
static bool weigh(const ppmi_walker *walker, const ppmi_vertex *vertex, const ppmi_bsdf *bsdf,
                  const techniques *t, ppmi_vec3 wi, ppmi_bsdf_sample *sample)
{
    const ppmi_vec3 wo = sample->wi;
    ppmi_bsdf seen;
    ppmi_walk_bsdf_from(walker, vertex, bsdf, wo, &seen);
    const bool is_reached = vec3_dot(wo, bsdf->frame.n) * vec3_dot(wo, bsdf->ng) > 0.0f;
    const uint32_t mask = is_reached ? PPMI_LOBE_ALL : seen.gather_lobes;
    const ppmi_vec3 f =
        ppmi_bsdf_eval(&seen, walker->world->albedo, wi, mask, PPMI_TRANSPORT_RADIANCE);
    sample->pdf = density(bsdf, t, wo);
    if (!(sample->pdf > 0.0f)) return false;
    const float cosines = of_arrival(seen.frame.n, bsdf->ng, wi) * fabsf(vec3_dot(wo, bsdf->ng));
    sample->weight = vec3_scale(f, cosines / sample->pdf);
    sample->is_transmission = vec3_dot(wo, bsdf->ng) < 0.0f;
    sample->eta_scale = 1.0f;
    return !vec3_is_black(sample->weight);
}

bool ppmi_adjoint_draw(ppmi_walker *walker, const ppmi_vertex *vertex, const ppmi_bsdf *bsdf,
                       ppmi_vec3 wi, ppmi_bsdf_sample *out_sample)
{
    float u_lobe = ppmi_walker_float(walker);
    const float u = ppmi_walker_float(walker), v = ppmi_walker_float(walker);
    const techniques t = techniques_of(bsdf);
    const float normals = t.front + t.back + t.below;
    if (u_lobe < t.front + t.back) {
        const ppmi_vec3 n = u_lobe < t.front ? bsdf->ng : vec3_neg(bsdf->ng);
        const ppmi_frame frame = ppmi_frame_from_normal(n);
        const ppmi_vec3 wo = ppmi_frame_to_world(&frame, ppmi_sample_cosine_hemisphere(u, v));
        *out_sample = (ppmi_bsdf_sample){.wi = vec3_normalize(wo)};
        return weigh(walker, vertex, bsdf, &t, wi, out_sample);
    }
    if (u_lobe < normals) {
        *out_sample = (ppmi_bsdf_sample){.wi = draw_below(bsdf, t.lean, u, v)};
        return weigh(walker, vertex, bsdf, &t, wi, out_sample);
    }
    u_lobe = ppmi_min((u_lobe - normals) / (1.0f - normals), 0x1.fffffep-1f);
    if (!ppmi_bsdf_draw(bsdf, walker->world->albedo, t.others, PPMI_TRANSPORT_POWER, u_lobe, u, v,
                        out_sample)) {
        return false;
    }
    if (!out_sample->is_delta) return weigh(walker, vertex, bsdf, &t, wi, out_sample);
    weigh_delta(bsdf, &t, wi, out_sample);
    return true;
}
