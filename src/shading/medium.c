/* Homogeneous media. */
#include "shading/medium.h"

ppmi_vec3 ppmi_medium_transmittance(const ppmi_medium *medium, float distance)
{
    const ppmi_vec3 sigma_t = vec3_add(medium->sigma_s, medium->sigma_a);
    return vec3(expf(-sigma_t.x * distance), expf(-sigma_t.y * distance),
                expf(-sigma_t.z * distance));
}

static float channel(ppmi_vec3 v, uint32_t i)
{
    return i == 0 ? v.x : i == 1 ? v.y : v.z;
}

static uint32_t choose_channel(float u)
{
    return u < 1.0f / 3.0f ? 0 : u < 2.0f / 3.0f ? 1 : 2;
}

ppmi_medium_sample ppmi_medium_sample_distance(const ppmi_medium *medium, float length,
                                               float u_channel, float u)
{
    const ppmi_vec3 sigma_t = vec3_add(medium->sigma_s, medium->sigma_a);
    const float sigma = channel(sigma_t, choose_channel(u_channel));
    const float distance = sigma > 0.0f ? -log1pf(-u) / sigma : INFINITY;
    ppmi_medium_sample sample = {.is_scattered = distance < length,
                                 .distance = ppmi_min(distance, length)};
    if (isinf(sample.distance)) { /* what never ends lets nothing arrive but where it is clear */
        sample.weight = vec3(sigma_t.x > 0.0f ? 0.0f : 1.0f, sigma_t.y > 0.0f ? 0.0f : 1.0f,
                             sigma_t.z > 0.0f ? 0.0f : 1.0f);
        const float arriving = vec3_mean(sample.weight);
        sample.weight = vec3_scale(sample.weight, arriving > 0.0f ? 1.0f / arriving : 0.0f);
        return sample;
    }
    const ppmi_vec3 transmittance = ppmi_medium_transmittance(medium, sample.distance);
    const float density =
        vec3_mean(sample.is_scattered ? vec3_mul(sigma_t, transmittance) : transmittance);
    sample.weight = vec3_scale(transmittance, density > 0.0f ? 1.0f / density : 0.0f);
    return sample;
}

/* Density of a distance by one channel's extinction, given that it is below length; even where
 * there is none. */
static float density_within(float sigma, float length, float distance)
{
    if (sigma * length < 1e-4f) return 1.0f / length;
    return sigma * expf(-sigma * distance) / -expm1f(-sigma * length);
}

bool ppmi_medium_sample_within(const ppmi_medium *medium, float length, float u_channel, float u,
                               float *out_distance, ppmi_vec3 *out_weight)
{
    const ppmi_vec3 sigma_t = vec3_add(medium->sigma_s, medium->sigma_a);
    const float sigma = channel(sigma_t, choose_channel(u_channel));
    if (!(length > 0.0f) || isinf(length)) return false;
    const float distance =
        sigma * length < 1e-4f ? u * length : -log1pf(u * expm1f(-sigma * length)) / sigma;
    *out_distance = ppmi_clampf(distance, 0.0f, length);
    const float density = (density_within(sigma_t.x, length, *out_distance) +
                           density_within(sigma_t.y, length, *out_distance) +
                           density_within(sigma_t.z, length, *out_distance)) /
                          3.0f;
    const ppmi_vec3 transmittance = ppmi_medium_transmittance(medium, *out_distance);
    *out_weight = vec3_scale(transmittance, 1.0f / density);
    return true;
}

float ppmi_phase(float g, float cosine)
{
    const float base = ppmi_max(1.0f + g * g - 2.0f * g * cosine, 1e-12f);
    return (1.0f - g * g) / (4.0f * PPMI_PI * base * sqrtf(base));
}

ppmi_vec3 ppmi_phase_sample(float g, float u, float v)
{
    if (fabsf(g) < 1e-3f) return ppmi_direction_at(1.0f - 2.0f * u, v);
    const float term = (1.0f - g * g) / (1.0f + g - 2.0f * g * u);
    const float cosine = (1.0f + g * g - term * term) / (2.0f * g);
    return ppmi_direction_at(ppmi_clampf(cosine, -1.0f, 1.0f), v);
}
