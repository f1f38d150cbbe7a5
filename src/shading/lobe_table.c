/* The tables of layered materials, over fixed point sets. */
#include "shading/lobe_table.h"

#include <stddef.h>

#include "math/sampler.h"
#include "shading/anisotropic.h"
#include "shading/sheen.h"

/* ---- nodes ----------------------------------------------------------------------------------- */

typedef struct weighted {
    float value, weight;
} weighted;

/* Shell's sort: the C library's may allocate. */
static void sort_by_value(weighted *samples, int count)
{
    for (int gap = count / 2; gap > 0; gap /= 2) {
        for (int i = gap; i < count; i++) {
            const weighted sample = samples[i];
            int k = i;
            for (; k >= gap && samples[k - gap].value > sample.value; k -= gap)
                samples[k] = samples[k - gap];
            samples[k] = sample;
        }
    }
}

/* The means of the samples in groups of equal weight, rising; a sample may be shared by groups. */
static void make_nodes(weighted *samples, int count, float nodes[PPMI_LOBE_NODES])
{
    double total = 0.0;
    sort_by_value(samples, count);
    for (int i = 0; i < count; i++)
        total += (double)samples[i].weight;
    const double share = total / PPMI_LOBE_NODES;
    int at = 0;
    double left = count > 0 ? (double)samples[0].weight : 0.0;
    for (int n = 0; n < PPMI_LOBE_NODES; n++) {
        double wanted = share, sum = 0.0, taken = 0.0;
        while (wanted > 0.0 && at < count) {
            const double part = left < wanted ? left : wanted;
            sum += part * (double)samples[at].value;
            taken += part;
            wanted -= part;
            left -= part;
            if (left > 0.0) break;
            if (++at < count) left = (double)samples[at].weight;
        }
        nodes[n] = taken > 0.0 ? (float)(sum / taken) : 0.0f;
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
            weighted to_normal[POINTS], to_half[POINTS];
            int count = 0;
            for (int i = 0; i < POINTS; i++) {
                const ppmi_vec3 h = ppmi_ggx_sample_visible(alpha, wo, points[i].x, points[i].y);
                const float cos_h = vec3_dot(wo, h), cos_i = 2.0f * cos_h * h.z - wo.z;
                if (cos_i <= 0.0f || cos_h <= 0.0f) continue;
                const float weight = ppmi_ggx_g2(alpha, cosine, cos_i) / ppmi_ggx_g1(alpha, cosine);
                to_normal[count] = (weighted){cos_i, weight};
                to_half[count++] = (weighted){cos_h, weight};
            }
            make_nodes(to_normal, count, table->ggx[r][c].cos_i);
            make_nodes(to_half, count, table->ggx[r][c].cos_h);
        }
    }
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

/* A row of a table by the root of the cosine. */
static float row_at(const float row[PPMI_LOBE_COSINES], float cosine)
{
    float t;
    const int c = cell(sqrtf(ppmi_max(cosine, 0.0f)), PPMI_LOBE_COSINES, &t);
    return row[c] + (row[c + 1] - row[c]) * t;
}

/* ---- sheen ----------------------------------------------------------------------------------- */

static float sheen_roughness(int r)
{
    const float t = (float)r / (PPMI_LOBE_ROUGHNESSES - 1);
    return PPMI_SHEEN_LEAST_ROUGHNESS + t * (1.0f - PPMI_SHEEN_LEAST_ROUGHNESS);
}

enum { RINGS = 48, SECTORS = 16 };

/* Cosine in the middle of a ring: finer towards the horizon. */
static float ring_cosine(int ring)
{
    return ppmi_sqr(((float)ring + 0.5f) / RINGS);
}

static float bound_of(float albedo)
{
    return albedo > 1.0f ? 1.0f / albedo : 1.0f;
}

/* Midpoint rule over directions. raw: the albedos before they are bounded; NULL: these are sought.
 */
static float integrate_sheen(float alpha, float cosine, const float *raw,
                             float nodes[PPMI_LOBE_NODES])
{
    const ppmi_vec3 wo = at_cosine(cosine);
    const float lambda_o = ppmi_sheen_lambda(cosine, alpha);
    const float bound_o = raw ? bound_of(row_at(raw, cosine)) : 1.0f;
    weighted samples[RINGS * SECTORS];
    double albedo = 0.0;
    for (int i = 0; i < RINGS; i++) {
        const float cos_i = ring_cosine(i), lambda_i = ppmi_sheen_lambda(cos_i, alpha);
        const float bound_i = raw ? bound_of(row_at(raw, cos_i)) : 1.0f;
        const float sin_i = sqrtf(1.0f - cos_i * cos_i);
        /* both halves of the circle; d cos = 2 t dt */
        const float measure = 2.0f * PPMI_PI / SECTORS * 2.0f * sqrtf(cos_i) / RINGS;
        for (int k = 0; k < SECTORS; k++) {
            const float phi = PPMI_PI * ((float)k + 0.5f) / SECTORS;
            const ppmi_vec3 wi = vec3(sin_i * cosf(phi), sin_i * sinf(phi), cos_i);
            const float weight = ppmi_sheen_value(alpha, wo, lambda_o, wi, lambda_i) *
                                 ppmi_min(bound_o, bound_i) * cos_i * measure;
            samples[i * SECTORS + k] = (weighted){cos_i, weight};
            albedo += (double)weight;
        }
    }
    if (raw) make_nodes(samples, RINGS * SECTORS, nodes);
    return (float)albedo;
}

static void init_sheen(ppmi_lobe_table *table)
{
    for (int r = 0; r < PPMI_LOBE_ROUGHNESSES; r++) {
        const float alpha = ppmi_sqr(sheen_roughness(r));
        for (int pass = 0; pass < 2; pass++) {
            for (int c = 0; c < PPMI_LOBE_COSINES; c++) {
                const float root = ppmi_max((float)c / (PPMI_LOBE_COSINES - 1), 0.02f);
                float *albedo = pass == 0 ? table->sheen_raw[r] : table->sheen_albedo[r];
                albedo[c] = integrate_sheen(
                    alpha, root * root, pass == 0 ? NULL : table->sheen_raw[r], table->sheen[r][c]);
            }
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

/* Where four entries of a table meet, and their shares. */
typedef struct patch {
    int r, c;
    float w[4];
} patch;

static patch patch_at(float x, float y)
{
    float tx, ty;
    patch at = {.r = cell(x, PPMI_LOBE_ROUGHNESSES, &tx), .c = cell(y, PPMI_LOBE_COSINES, &ty)};
    at.w[0] = (1.0f - tx) * (1.0f - ty);
    at.w[1] = (1.0f - tx) * ty;
    at.w[2] = tx * (1.0f - ty);
    at.w[3] = tx * ty;
    return at;
}

static float blend(const patch *at, float v00, float v01, float v10, float v11)
{
    return at->w[0] * v00 + at->w[1] * v01 + at->w[2] * v10 + at->w[3] * v11;
}

static float sheen_position(float roughness)
{
    return (roughness - PPMI_SHEEN_LEAST_ROUGHNESS) / (1.0f - PPMI_SHEEN_LEAST_ROUGHNESS);
}

void ppmi_lobe_ggx_nodes(const ppmi_lobe_table *table, float roughness, float cosine,
                         ppmi_lobe_nodes *out_nodes)
{
    const patch at = patch_at(roughness, cosine);
    const ppmi_lobe_nodes *low = table->ggx[at.r] + at.c, *high = table->ggx[at.r + 1] + at.c;
    for (int n = 0; n < PPMI_LOBE_NODES; n++) {
        out_nodes->cos_i[n] =
            blend(&at, low[0].cos_i[n], low[1].cos_i[n], high[0].cos_i[n], high[1].cos_i[n]);
        out_nodes->cos_h[n] =
            blend(&at, low[0].cos_h[n], low[1].cos_h[n], high[0].cos_h[n], high[1].cos_h[n]);
    }
}

void ppmi_lobe_sheen_nodes(const ppmi_lobe_table *table, float roughness, float cosine,
                           float out_cos_i[PPMI_LOBE_NODES])
{
    const patch at = patch_at(sheen_position(roughness), sqrtf(ppmi_max(cosine, 0.0f)));
    const float(*low)[PPMI_LOBE_NODES] = table->sheen[at.r] + at.c;
    const float(*high)[PPMI_LOBE_NODES] = table->sheen[at.r + 1] + at.c;
    for (int n = 0; n < PPMI_LOBE_NODES; n++)
        out_cos_i[n] = blend(&at, low[0][n], low[1][n], high[0][n], high[1][n]);
}

static float sheen_at(const float table[PPMI_LOBE_ROUGHNESSES][PPMI_LOBE_COSINES], float roughness,
                      float cosine)
{
    const patch at = patch_at(sheen_position(roughness), sqrtf(ppmi_max(cosine, 0.0f)));
    const float *low = table[at.r] + at.c, *high = table[at.r + 1] + at.c;
    return blend(&at, low[0], low[1], high[0], high[1]);
}

float ppmi_lobe_sheen_bound(const ppmi_lobe_table *table, float roughness, float cosine)
{
    return bound_of(sheen_at(table->sheen_raw, roughness, cosine));
}

float ppmi_lobe_sheen_albedo(const ppmi_lobe_table *table, float roughness, float cosine)
{
    return sheen_at(table->sheen_albedo, roughness, cosine);
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
