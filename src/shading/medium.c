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

ppmi_medium_sample ppmi_medium_sample_distance(const ppmi_medium *medium, float length,
                                               float u_channel, float u)
{
    const ppmi_vec3 sigma_t = vec3_add(medium->sigma_s, medium->sigma_a);
    const uint32_t chosen = u_channel < 1.0f / 3.0f ? 0 : u_channel < 2.0f / 3.0f ? 1 : 2;
    const float sigma = channel(sigma_t, chosen);
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
