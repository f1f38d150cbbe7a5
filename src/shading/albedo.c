/* The albedo table: visible-normal sampling over a fixed, stratified point set. */
#include "shading/albedo.h"

#include "math/sampler.h"
#include "shading/microfacet.h"

enum { SAMPLE_COUNT = 1024 };

static ppmi_albedo_pair integrate(const ppmi_vec2 samples[SAMPLE_COUNT], float alpha, float cosine)
{
    const ppmi_vec3 wo = vec3(sqrtf(ppmi_max(0.0f, 1.0f - cosine * cosine)), 0.0f, cosine);
    double a = 0.0, b = 0.0;
    for (uint32_t i = 0; i < SAMPLE_COUNT; i++) {
        const ppmi_vec3 h = ppmi_ggx_sample_visible(alpha, wo, samples[i].x, samples[i].y);
        const float cos_oh = vec3_dot(wo, h);
        const float cos_i = 2.0f * cos_oh * h.z - wo.z;
        if (cos_i <= 0.0f || cos_oh <= 0.0f) continue;
        const float weight = ppmi_ggx_g2(alpha, cosine, cos_i) / ppmi_ggx_g1(alpha, cosine);
        const float schlick = ppmi_schlick_weight(cos_oh);
        a += (double)(weight * (1.0f - schlick));
        b += (double)(weight * schlick);
    }
    return (ppmi_albedo_pair){(float)(a / SAMPLE_COUNT), (float)(b / SAMPLE_COUNT)};
}

static ppmi_albedo_pair mirror(float cosine)
{
    const float schlick = ppmi_schlick_weight(cosine);
    return (ppmi_albedo_pair){1.0f - schlick, schlick};
}

/* 2 * integral of albedo(c) c dc, exact for the piecewise linear table. */
static ppmi_albedo_pair average_of(const ppmi_albedo_pair *row)
{
    const double step = 1.0 / (PPMI_ALBEDO_COSINES - 1);
    double a = 0.0, b = 0.0;
    for (int i = 0; i + 1 < PPMI_ALBEDO_COSINES; i++) {
        /* integral over a cell of (linear albedo) * (linear cosine) */
        const double c0 = i * step, c1 = (i + 1) * step;
        const double w0 = step * (2.0 * c0 + c1) / 6.0, w1 = step * (c0 + 2.0 * c1) / 6.0;
        a += 2.0 * (w0 * (double)row[i].a + w1 * (double)row[i + 1].a);
        b += 2.0 * (w0 * (double)row[i].b + w1 * (double)row[i + 1].b);
    }
    return (ppmi_albedo_pair){(float)a, (float)b};
}

void ppmi_albedo_table_init(ppmi_albedo_table *table)
{
    ppmi_vec2 samples[SAMPLE_COUNT];
    for (uint32_t i = 0; i < SAMPLE_COUNT; i++) {
        const ppmi_sample4 sample = ppmi_sobol4(i, 0, 0);
        samples[i] = (ppmi_vec2){ppmi_unit_float(sample.bits[0]), ppmi_unit_float(sample.bits[1])};
    }
    for (int r = 0; r < PPMI_ALBEDO_ROUGHNESSES; r++) {
        const float roughness = (float)r / (PPMI_ALBEDO_ROUGHNESSES - 1);
        const float alpha = roughness * roughness;
        for (int c = 0; c < PPMI_ALBEDO_COSINES; c++) {
            /* at exactly 0 nothing is visible: the limit is taken close by */
            const float cosine = ppmi_max((float)c / (PPMI_ALBEDO_COSINES - 1), 1e-3f);
            table->directional[r][c] =
                alpha < PPMI_SMOOTH_ALPHA ? mirror(cosine) : integrate(samples, alpha, cosine);
        }
        table->average[r] = average_of(table->directional[r]);
    }
    table->lobes = NULL;
    table->glass = NULL;
}

static ppmi_albedo_pair mix(ppmi_albedo_pair p, ppmi_albedo_pair q, float t)
{
    return (ppmi_albedo_pair){p.a + (q.a - p.a) * t, p.b + (q.b - p.b) * t};
}

/* Position in a table of count entries over 0..1. */
static int cell(float x, int count, float *out_fraction)
{
    const float scaled = ppmi_clampf(x, 0.0f, 1.0f) * (float)(count - 1);
    int i = (int)scaled;
    if (i > count - 2) i = count - 2;
    *out_fraction = scaled - (float)i;
    return i;
}

ppmi_albedo_pair ppmi_albedo_directional(const ppmi_albedo_table *table, float roughness,
                                         float cosine)
{
    float tr, tc;
    const int r = cell(roughness, PPMI_ALBEDO_ROUGHNESSES, &tr);
    const int c = cell(cosine, PPMI_ALBEDO_COSINES, &tc);
    const ppmi_albedo_pair *low = table->directional[r], *high = table->directional[r + 1];
    return mix(mix(low[c], low[c + 1], tc), mix(high[c], high[c + 1], tc), tr);
}

ppmi_albedo_pair ppmi_albedo_average(const ppmi_albedo_table *table, float roughness)
{
    float t;
    const int r = cell(roughness, PPMI_ALBEDO_ROUGHNESSES, &t);
    return mix(table->average[r], table->average[r + 1], t);
}
