/* Thin-film interference, integrated over the spectrum in closed form: Belcour and Barla 2017, "A
 * Practical Extension to Microfacet Theory for the Modeling of Varying Iridescence" (ACM TOG 36.4),
 * with the simplifications of KHR_materials_iridescence: Schlick's Fresnel at both interfaces,
 * no polarisation, real indices.
 *
 * It departs from the extension's sample code in two places. The spectral integrals are scaled to
 * the white of the working space: the sample's turn a reflectance of 1 at all wavelengths into
 * (1.20, 0.95, 0.91). And the series of reflections within the film runs until it has converged,
 * not for two terms: a film of no thickness then leaves the base as it is. */
#include "shading/iridescence.h"

#include "shading/microfacet.h"

enum { MOST_TERMS = 12 };

/* Luminous reflectance of light whose phase difference is 2 pi path / wavelength + shift: the
 * colour matching functions as Gaussians in the frequency domain (Belcour and Barla, section 4,
 * and its published constants). Each is scaled to 1 at no difference, so that the result is the
 * mean of the cosine under it. */
static ppmi_vec3 mean_cosine(const float m[9], float path_nm, float shift)
{
    const float phase = 2.0f * PPMI_PI * 1e-9f * path_nm;
    const float phase2 = phase * phase;
    /* x has two lobes, of 84.6 % and 15.4 % of its area */
    const float x = 0.8462f * cosf(1.6810e6f * phase + shift) * expf(-4.3278e9f * phase2) +
                    0.1538f * cosf(2.2399e6f * phase + shift) * expf(-4.5282e9f * phase2);
    const float y = cosf(1.7953e6f * phase + shift) * expf(-9.3046e9f * phase2);
    const float z = cosf(2.2084e6f * phase + shift) * expf(-6.6121e9f * phase2);
    /* XYZ of D65 times these, to the working space: the rows sum to 1 */
    const float wx = 0.95047f * x, wz = 1.08883f * z;
    return vec3(m[0] * wx + m[1] * y + m[2] * wz, m[3] * wx + m[4] * y + m[5] * wz,
                m[6] * wx + m[7] * y + m[8] * wz);
}

static float channel(ppmi_vec3 v, int i)
{
    return i == 0 ? v.x : i == 1 ? v.y : v.z;
}

/* (n - m)^2 / (n + m)^2 */
static float reflectance_between(float n, float m)
{
    return ppmi_sqr((n - m) / (n + m));
}

static float schlick(float f0, float cosine)
{
    return f0 + (1.0f - f0) * ppmi_schlick_weight(cosine);
}

/* What one channel's interference is made of. */
typedef struct film_series {
    float mean;          /* reflectance without interference */
    float first, factor; /* amplitude of term m: first * factor^m */
    float shift;         /* of a term's phase, at reflection: m times this */
} film_series;

static film_series make_series(float film_ior, float base_f0, float r12, float phase12,
                               float cos_film)
{
    const float root = sqrtf(ppmi_min(base_f0, 0.9999f));
    const float base_ior = (1.0f + root) / (1.0f - root);
    const float r23 = schlick(reflectance_between(base_ior, film_ior), cos_film);
    const float phase23 = base_ior < film_ior ? PPMI_PI : 0.0f;
    const float t = 1.0f - r12;
    const float r123 = ppmi_clampf(r12 * r23, 0.0f, 0.9999f);
    const float returned = t * t * r23 / (1.0f - r123);
    return (film_series){.mean = r12 + returned,
                         .first = 2.0f * (returned - t),
                         .factor = sqrtf(r123),
                         .shift = PPMI_PI - phase12 + phase23};
}

static float sum_series(const film_series *series, const float to_rgb[9], int which, float path_nm)
{
    float sum = series->mean, amplitude = series->first;
    for (int m = 1; m <= MOST_TERMS; m++) {
        amplitude *= series->factor;
        if (fabsf(amplitude) < 1e-4f) break;
        sum += amplitude *
               channel(mean_cosine(to_rgb, (float)m * path_nm, (float)m * series->shift), which);
    }
    return ppmi_clampf(sum, 0.0f, 1.0f);
}

ppmi_vec3 ppmi_film_reflectance(float film_ior, float thickness_nm, ppmi_vec3 base_f0, float cosine,
                                const ppmi_working_space *space)
{
    const float *to_rgb = (space->differs ? space : &ppmi_working_space_rec709)->from_xyz;
    const float cos2_film = 1.0f - (1.0f - cosine * cosine) / (film_ior * film_ior);
    if (cos2_film <= 0.0f) return vec3_splat(1.0f);
    const float cos_film = sqrtf(cos2_film);
    const float r12 = schlick(reflectance_between(film_ior, 1.0f), cosine);
    const float phase12 = film_ior < 1.0f ? PPMI_PI : 0.0f;
    const float path_nm = 2.0f * film_ior * thickness_nm * cos_film;
    float reflectance[3];
    for (int i = 0; i < 3; i++) {
        const film_series series =
            make_series(film_ior, channel(base_f0, i), r12, phase12, cos_film);
        reflectance[i] = sum_series(&series, to_rgb, i, path_nm);
    }
    return vec3_load(reflectance);
}
