/* Ray differentials (Igehy 1999): transfer is its equation 10, reflection 14 to 16, refraction 17
 * to 19. The normal of a reflection or refraction is the one that fits the two directions, so that
 * normal maps and microfacets need no case of their own; its derivative is the mesh's.
 *
 * Where a footprint is not known well, the smaller one is taken: paths are drawn all over a pixel,
 * so that a texture that is looked up too finely is noise that goes away, but one that is looked up
 * too coarsely stays blurred. */
#include "shading/footprint.h"

/* After a rough bounce a ray stands for this part of the breadth of its lobe. The blur that this
 * adds to the lobe's own is of the order of its square. */
static const float rough_share = 0.1f;

static ppmi_vec3 finite_or_zero(ppmi_vec3 v)
{
    return vec3_is_finite(v) ? v : vec3_splat(0.0f);
}

void ppmi_differential_advance(ppmi_differential *d, float distance)
{
    if (!d->is_known) return;
    d->position_dx = vec3_mad(d->position_dx, d->direction_dx, distance);
    d->position_dy = vec3_mad(d->position_dy, d->direction_dy, distance);
}

/* ---- surfaces -------------------------------------------------------------------------------- */

/* Moves v into the plane of the normal, along direction. */
static ppmi_vec3 into_plane(ppmi_vec3 v, ppmi_vec3 direction, ppmi_vec3 normal)
{
    const float cosine = vec3_dot(direction, normal);
    return finite_or_zero(vec3_mad(v, direction, -vec3_dot(v, normal) / cosine));
}

void ppmi_differential_meet(ppmi_differential *d, float distance, ppmi_surface *surface)
{
    if (!d->is_known) return;
    ppmi_differential_advance(d, distance);
    d->position_dx = into_plane(d->position_dx, d->direction, surface->ng);
    d->position_dy = into_plane(d->position_dy, d->direction, surface->ng);
    ppmi_surface_set_footprint(surface, d->position_dx, d->position_dy);
}

/* Reflection: d(D - 2 (D.N) N). */
static ppmi_vec3 reflected(ppmi_vec3 direction, ppmi_vec3 d_direction, ppmi_vec3 n, ppmi_vec3 d_n)
{
    const float d_cosine = vec3_dot(d_direction, n) + vec3_dot(direction, d_n);
    const ppmi_vec3 turned = vec3_mad(vec3_scale(d_n, vec3_dot(direction, n)), n, d_cosine);
    return finite_or_zero(vec3_mad(d_direction, turned, -2.0f));
}

void ppmi_differential_reflect(ppmi_differential *d, const ppmi_surface *surface, ppmi_vec3 wi)
{
    if (!d->is_known) return;
    const ppmi_vec3 n = vec3_normalize(vec3_sub(wi, d->direction));
    ppmi_vec3 n_dx, n_dy;
    ppmi_surface_normal_derivatives(surface, n, &n_dx, &n_dy);
    d->direction_dx = reflected(d->direction, d->direction_dx, n, n_dx);
    d->direction_dy = reflected(d->direction, d->direction_dy, n, n_dy);
}

/* Refraction: d(eta D - mu N) with mu = eta D.N - T.N. */
static ppmi_vec3 refracted(ppmi_vec3 direction, ppmi_vec3 d_direction, ppmi_vec3 out, float eta,
                           ppmi_vec3 n, ppmi_vec3 d_n)
{
    const float d_cosine = vec3_dot(d_direction, n) + vec3_dot(direction, d_n);
    const float cos_in = vec3_dot(direction, n), cos_out = vec3_dot(out, n);
    const float mu = eta * cos_in - cos_out;
    const float d_mu = (eta - eta * eta * cos_in / cos_out) * d_cosine;
    const ppmi_vec3 bent = vec3_mad(vec3_scale(d_n, mu), n, d_mu);
    return finite_or_zero(vec3_sub(vec3_scale(d_direction, eta), bent));
}

void ppmi_differential_refract(ppmi_differential *d, const ppmi_surface *surface,
                               float relative_index, ppmi_vec3 wi)
{
    if (!d->is_known) return;
    const float eta = 1.0f / relative_index;
    const ppmi_vec3 bend = vec3_sub(vec3_scale(d->direction, eta), wi);
    if (!(vec3_length2(bend) > 1e-8f)) return; /* the same index on both sides */
    const ppmi_vec3 n = vec3_normalize(bend);
    ppmi_vec3 n_dx, n_dy;
    ppmi_surface_normal_derivatives(surface, n, &n_dx, &n_dy);
    d->direction_dx = refracted(d->direction, d->direction_dx, wi, eta, n, n_dx);
    d->direction_dy = refracted(d->direction, d->direction_dy, wi, eta, n, n_dy);
}

/* ---- rough bounces --------------------------------------------------------------------------- */

/* A lobe of density pdf covers 1 / pdf of solid angle around wi. A narrow one has at least the
 * spread that the ray came with. */
void ppmi_differential_scatter(ppmi_differential *d, ppmi_vec3 wi, float pdf)
{
    if (!d->is_known) return;
    d->is_scattered = true;
    const float before = ppmi_min(vec3_length2(d->direction_dx), vec3_length2(d->direction_dy));
    const float lobe = pdf > 0.0f ? rough_share * rough_share / pdf : 0.0f;
    const float spread = sqrtf(ppmi_min(ppmi_max(before, lobe), 1.0f));
    const ppmi_frame frame = ppmi_frame_from_normal(wi);
    d->direction_dx = vec3_scale(frame.s, spread);
    d->direction_dy = vec3_scale(frame.t, spread);
}
