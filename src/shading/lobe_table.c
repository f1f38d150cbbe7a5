/* The tables of layered materials, over fixed point sets. */
#include "shading/lobe_table.h"

#include "math/sampler.h"
#include "shading/anisotropic.h"
#include "shading/sheen.h"

/* ---- nodes ----------------------------------------------------------------------------------- */

typedef struct lobe_sample {
    float cos_i, cos_h, weight;
} lobe_sample;

/* Shell's sort, by cos_i: the C library's may allocate. */
static void sort_samples(lobe_sample *samples, int count)
{
    for (int gap = count / 2; gap > 0; gap /= 2) {
        for (int i = gap; i < count; i++) {
            const lobe_sample sample = samples[i];
            int k = i;
            for (; k >= gap && samples[k - gap].cos_i > sample.cos_i; k -= gap)
                samples[k] = samples[k - gap];
            samples[k] = sample;
        }
    }
}

/* The samples in groups of equal weight, each as its means; a sample may be shared by groups. */
static void make_nodes(lobe_sample *samples, int count, ppmi_lobe_nodes *nodes)
{
    double total = 0.0;
    sort_samples(samples, count);
    for (int i = 0; i < count; i++)
        total += (double)samples[i].weight;
    const double share = total / PPMI_LOBE_NODES;
    int at = 0;
    double left = count > 0 ? (double)samples[0].weight : 0.0;
    for (int n = 0; n < PPMI_LOBE_NODES; n++) {
        double wanted = share, cos_i = 0.0, cos_h = 0.0, taken = 0.0;
        while (wanted > 0.0 && at < count) {
            const double part = left < wanted ? left : wanted;
            cos_i += part * (double)samples[at].cos_i;
            cos_h += part * (double)samples[at].cos_h;
            taken += part;
            wanted -= part;
            left -= part;
            if (left > 0.0) break;
            if (++at < count) left = (double)samples[at].weight;
        }
        nodes->cos_i[n] = taken > 0.0 ? (float)(cos_i / taken) : 0.0f;
        nodes->cos_h[n] = taken > 0.0 ? (float)(cos_h / taken) : 0.0f;
    }
}

static ppmi_vec3 at_cosine(float cosine)
{
    return vec3(sqrtf(ppmi_max(0.0f, 1.0f - cosine * cosine)), 0.0f, cosine);
}

enum { POINTS = 256 };

static void init_ggx(ppmi_lobe_table *table, const ppmi_vec2 points[POINTS])
{
    for (int r = 0; r < PPMI_LOBE_ROUGHNESSES; r++) {
        const float roughness = (float)r / (PPMI_LOBE_ROUGHNESSES - 1);
        const float alpha = ppmi_max(roughness * roughness, 1e-6f);
        for (int c = 0; c < PPMI_LOBE_COSINES; c++) {
            const float cosine = ppmi_max((float)c / (PPMI_LOBE_COSINES - 1), 1e-3f);
            const ppmi_vec3 wo = at_cosine(cosine);
            lobe_sample samples[POINTS];
            int count = 0;
            for (int i = 0; i < POINTS; i++) {
                const ppmi_vec3 h = ppmi_ggx_sample_visible(alpha, wo, points[i].x, points[i].y);
                const float cos_h = vec3_dot(wo, h), cos_i = 2.0f * cos_h * h.z - wo.z;
                if (cos_i <= 0.0f || cos_h <= 0.0f) continue;
                const float weight = ppmi_ggx_g2(alpha, cosine, cos_i) / ppmi_ggx_g1(alpha, cosine);
                samples[count++] = (lobe_sample){cos_i, cos_h, weight};
            }
            make_nodes(samples, count, &table->ggx[r][c]);
        }
    }
}

/* ---- sheen ----------------------------------------------------------------------------------- */

static float sheen_roughness(int r)
{
    const float t = (float)r / (PPMI_LOBE_ROUGHNESSES - 1);
    return PPMI_SHEEN_LEAST_ROUGHNESS + t * (1.0f - PPMI_SHEEN_LEAST_ROUGHNESS);
}

/* Midpoint rule over directions, finer towards the horizon. */
static float integrate_sheen(float alpha, float cosine, ppmi_lobe_nodes *nodes)
{
    enum { RINGS = 48, SECTORS = 16 };
    const ppmi_vec3 wo = at_cosine(cosine);
    const float lambda_o = ppmi_sheen_lambda(cosine, alpha);
    lobe_sample samples[RINGS * SECTORS];
    double albedo = 0.0;
    for (int i = 0; i < RINGS; i++) {
        const float t = ((float)i + 0.5f) / RINGS, cos_i = t * t;
        const float lambda_i = ppmi_sheen_lambda(cos_i, alpha);
        const float sin_i = sqrtf(1.0f - cos_i * cos_i);
        for (int k = 0; k < SECTORS; k++) {
            const float phi = PPMI_PI * ((float)k + 0.5f) / SECTORS;
            const ppmi_vec3 wi = vec3(sin_i * cosf(phi), sin_i * sinf(phi), cos_i);
            const float f = ppmi_sheen_value(alpha, wo, lambda_o, wi, lambda_i);
            /* both halves of the circle; d cos = 2 t dt */
            const float weight = f * cos_i * 2.0f * PPMI_PI / SECTORS * 2.0f * t / RINGS;
            samples[i * SECTORS + k] = (lobe_sample){cos_i, 1.0f, weight};
            albedo += (double)weight;
        }
    }
    make_nodes(samples, RINGS * SECTORS, nodes);
    return (float)albedo;
}

static void init_sheen(ppmi_lobe_table *table)
{
    for (int r = 0; r < PPMI_LOBE_ROUGHNESSES; r++) {
        const float roughness = sheen_roughness(r);
        for (int c = 0; c < PPMI_LOBE_COSINES; c++) {
            const float root = ppmi_max((float)c / (PPMI_LOBE_COSINES - 1), 0.02f);
            table->sheen_albedo[r][c] =
                integrate_sheen(roughness * roughness, root * root, &table->sheen[r][c]);
        }
    }
}

/* ---- two widths ------------------------------------------------------------------------------ */

static ppmi_albedo_pair integrate_wide(ppmi_vec2 alpha, ppmi_vec3 wo,
                                       const ppmi_vec2 points[POINTS])
{
    double a = 0.0, b = 0.0;
    const float lambda_o = ppmi_ggx2_lambda(alpha, wo);
    for (int i = 0; i < POINTS; i++) {
        const ppmi_vec3 h = ppmi_ggx2_sample_visible(alpha, wo, points[i].x, points[i].y);
        const float cos_h = vec3_dot(wo, h);
        const ppmi_vec3 wi = vec3_sub(vec3_scale(h, 2.0f * cos_h), wo);
        if (wi.z <= 0.0f || cos_h <= 0.0f) continue;
        const float weight = (1.0f + lambda_o) * ppmi_ggx2_g2(alpha, wo, wi);
        const float schlick = ppmi_schlick_weight(cos_h);
        a += (double)(weight * (1.0f - schlick));
        b += (double)(weight * schlick);
    }
    return (ppmi_albedo_pair){(float)(a / POINTS), (float)(b / POINTS)};
}

static void init_wide(ppmi_lobe_table *table, const ppmi_vec2 points[POINTS])
{
    for (int r = 0; r < PPMI_WIDE_ROUGHNESSES; r++) {
        const float roughness = (float)r / (PPMI_WIDE_ROUGHNESSES - 1);
        const float narrow = ppmi_max(roughness * roughness, PPMI_SMOOTH_ALPHA);
        for (int s = 0; s < PPMI_WIDE_STRENGTHS; s++) {
            const float strength = (float)s / (PPMI_WIDE_STRENGTHS - 1);
            const ppmi_vec2 alpha = {ppmi_wide_alpha(narrow, strength), narrow};
            for (int c = 0; c < PPMI_WIDE_COSINES; c++) {
                const float cosine = ppmi_max((float)c / (PPMI_WIDE_COSINES - 1), 1e-2f);
                const float sine = sqrtf(1.0f - cosine * cosine);
                for (int p = 0; p < PPMI_WIDE_ANGLES; p++) {
                    const float phi = 0.5f * PPMI_PI * (float)p / (PPMI_WIDE_ANGLES - 1);
                    const ppmi_vec3 wo = vec3(sine * cosf(phi), sine * sinf(phi), cosine);
                    table->wide[r][s][c][p] = integrate_wide(alpha, wo, points);
                }
            }
        }
    }
}

void ppmi_lobe_table_init(ppmi_lobe_table *table)
{
    ppmi_vec2 points[POINTS];
    for (uint32_t i = 0; i < POINTS; i++) {
        const ppmi_sample4 sample = ppmi_sobol4(i, 0, 0);
        points[i] = (ppmi_vec2){ppmi_unit_float(sample.bits[0]), ppmi_unit_float(sample.bits[1])};
    }
    init_ggx(table, points);
    init_sheen(table);
    init_wide(table, points);
}

/* ---- lookup ---------------------------------------------------------------------------------- */

/* Position in a table of count entries over 0..1. */
static int cell(float x, int count, float *out_fraction)
{
    const float scaled = ppmi_clampf(x, 0.0f, 1.0f) * (float)(count - 1);
    int i = (int)scaled;
    if (i > count - 2) i = count - 2;
    *out_fraction = scaled - (float)i;
    return i;
}

static void mix_nodes(const ppmi_lobe_nodes table[PPMI_LOBE_ROUGHNESSES][PPMI_LOBE_COSINES],
                      float x, float y, ppmi_lobe_nodes *out_nodes)
{
    float tx, ty;
    const int r = cell(x, PPMI_LOBE_ROUGHNESSES, &tx), c = cell(y, PPMI_LOBE_COSINES, &ty);
    const ppmi_lobe_nodes *low = table[r], *high = table[r + 1];
    const float w00 = (1.0f - tx) * (1.0f - ty), w01 = (1.0f - tx) * ty;
    const float w10 = tx * (1.0f - ty), w11 = tx * ty;
    for (int n = 0; n < PPMI_LOBE_NODES; n++) {
        out_nodes->cos_i[n] = w00 * low[c].cos_i[n] + w01 * low[c + 1].cos_i[n] +
                              w10 * high[c].cos_i[n] + w11 * high[c + 1].cos_i[n];
        out_nodes->cos_h[n] = w00 * low[c].cos_h[n] + w01 * low[c + 1].cos_h[n] +
                              w10 * high[c].cos_h[n] + w11 * high[c + 1].cos_h[n];
    }
}

static float sheen_position(float roughness)
{
    return (roughness - PPMI_SHEEN_LEAST_ROUGHNESS) / (1.0f - PPMI_SHEEN_LEAST_ROUGHNESS);
}

void ppmi_lobe_ggx_nodes(const ppmi_lobe_table *table, float roughness, float cosine,
                         ppmi_lobe_nodes *out_nodes)
{
    mix_nodes(table->ggx, roughness, cosine, out_nodes);
}

void ppmi_lobe_sheen_nodes(const ppmi_lobe_table *table, float roughness, float cosine,
                           ppmi_lobe_nodes *out_nodes)
{
    mix_nodes(table->sheen, sheen_position(roughness), sqrtf(ppmi_max(cosine, 0.0f)), out_nodes);
}

float ppmi_lobe_sheen_albedo(const ppmi_lobe_table *table, float roughness, float cosine)
{
    float tr, tc;
    const int r = cell(sheen_position(roughness), PPMI_LOBE_ROUGHNESSES, &tr);
    const int c = cell(sqrtf(ppmi_max(cosine, 0.0f)), PPMI_LOBE_COSINES, &tc);
    const float *low = table->sheen_albedo[r], *high = table->sheen_albedo[r + 1];
    const float at_low = low[c] + (low[c + 1] - low[c]) * tc;
    const float at_high = high[c] + (high[c + 1] - high[c]) * tc;
    return at_low + (at_high - at_low) * tr;
}

ppmi_albedo_pair ppmi_lobe_wide_albedo(const ppmi_lobe_table *table, float roughness,
                                       float strength, ppmi_vec3 wo)
{
    float t[4];
    const int at[4] = {
        cell(roughness, PPMI_WIDE_ROUGHNESSES, &t[0]),
        cell(strength, PPMI_WIDE_STRENGTHS, &t[1]),
        cell(wo.z, PPMI_WIDE_COSINES, &t[2]),
        cell(atan2f(fabsf(wo.y), fabsf(wo.x)) * 2.0f * PPMI_INV_PI, PPMI_WIDE_ANGLES, &t[3]),
    };
    ppmi_albedo_pair sum = {0.0f, 0.0f};
    for (int i = 0; i < 16; i++) {
        float weight = 1.0f;
        for (int k = 0; k < 4; k++)
            weight *= i >> k & 1 ? t[k] : 1.0f - t[k];
        const ppmi_albedo_pair *entry = &table->wide[at[0] + (i & 1)][at[1] + (i >> 1 & 1)]
                                                    [at[2] + (i >> 2 & 1)][at[3] + (i >> 3 & 1)];
        sum.a += weight * entry->a;
        sum.b += weight * entry->b;
    }
    return sum;
}
