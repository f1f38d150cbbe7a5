/* The table of rough glass, over a fixed point set: a Fibonacci lattice. */
#include "shading/glass_table.h"

#include "shading/microfacet.h"

enum { POINTS = 233, LATTICE_STEP = 144, COSINES = PPMI_GLASS_COSINES };

/* ---- the axes -------------------------------------------------------------------------------- */

/* Position in a table of count entries over 0..1. */
static int cell(float x, int count, float *out_fraction)
{
    const float scaled = ppmi_clampf(x, 0.0f, 1.0f) * (float)(count - 1);
    int i = (int)scaled;
    if (i > count - 2) i = count - 2;
    *out_fraction = scaled - (float)i;
    return i;
}

/* The index at an entry of count; huge for the last. */
static float index_at(int i, int count)
{
    const float x = ppmi_sqr((float)i / (float)(count - 1));
    return (1.0f + x) / ppmi_max(1.0f - x, 1e-4f);
}

static float index_position(float eta)
{
    return sqrtf(fabsf(eta - 1.0f) / (eta + 1.0f));
}

/* ---- single scattering ----------------------------------------------------------------------- */

/* A facet that a direction sees, and what it reflects: nothing that depends on the index. */
typedef struct facet {
    float cos_n, cos_h; /* to the normal, to the direction */
    float reflected;    /* G2 / G1 of what it reflects; 0: caught */
} facet;

typedef struct facets {
    facet of[COSINES][POINTS];
    float cosine[COSINES], lambda[COSINES]; /* of the direction */
    float alpha;
} facets;

/* What leaves at a cosine, by what is seen: G2 / G1. */
static float passing(float alpha, float lambda_o, float cosine)
{
    if (!(cosine > 0.0f)) return 0.0f;
    return (1.0f + lambda_o) / (1.0f + lambda_o + ppmi_ggx_lambda(alpha, cosine));
}

static void init_facets(facets *all, float alpha, const ppmi_vec2 points[POINTS])
{
    all->alpha = alpha;
    for (int c = 0; c < COSINES; c++) {
        /* at exactly 0 nothing is visible: the limit is taken close by */
        const float cosine = ppmi_max(ppmi_sqr((float)c / (COSINES - 1)), 1e-4f);
        const ppmi_vec3 wo = vec3(sqrtf(ppmi_max(0.0f, 1.0f - cosine * cosine)), 0.0f, cosine);
        const float lambda = ppmi_ggx_lambda(alpha, cosine);
        all->cosine[c] = cosine;
        all->lambda[c] = lambda;
        for (int i = 0; i < POINTS; i++) {
            const ppmi_vec3 h = ppmi_ggx_sample_visible(alpha, wo, points[i].x, points[i].y);
            const float cos_h = ppmi_max(vec3_dot(wo, h), 1e-6f);
            all->of[c][i] =
                (facet){h.z, cos_h, passing(alpha, lambda, 2.0f * cos_h * h.z - cosine)};
        }
    }
}

/* 1 - E by one cosine: reflection and transmission together. */
static float integrate(const facets *all, int c, float eta)
{
    double leaves = 0.0;
    for (int i = 0; i < POINTS; i++) {
        const facet *seen = &all->of[c][i];
        float cos_t;
        const float reflectance = ppmi_fresnel_dielectric(seen->cos_h, eta, &cos_t);
        leaves += (double)(reflectance * seen->reflected);
        if (!(cos_t > 0.0f)) continue;
        const float refracted = seen->cos_n * (cos_t - seen->cos_h / eta) + all->cosine[c] / eta;
        leaves += (double)((1.0f - reflectance) * passing(all->alpha, all->lambda[c], refracted));
    }
    return ppmi_max(1.0f - (float)(leaves / POINTS), 0.0f);
}

/* 2 * integral of lost(c) c dc for lost linear in t between the entries, c = t^2: of 4 t^3 (p + q
 * t) exactly. */
static float average_of(const float lost[COSINES])
{
    const double step = 1.0 / (COSINES - 1);
    double sum = 0.0;
    for (int i = 0; i + 1 < COSINES; i++) {
        const double a = i * step, b = (i + 1) * step;
        const double a4 = a * a * a * a, b4 = b * b * b * b;
        const double q = ((double)lost[i + 1] - (double)lost[i]) / step;
        const double p = (double)lost[i] - q * a;
        sum += p * (b4 - a4) + 0.8 * q * (b4 * b - a4 * a);
    }
    return (float)sum;
}

/* ---- means of the Fresnel term --------------------------------------------------------------- */

static void init_reflected(ppmi_glass_table *table)
{
    enum { STEPS = 64 };
    for (int i = 0; i < PPMI_GLASS_SHEETS; i++) {
        const float eta = index_at(i, PPMI_GLASS_SHEETS);
        double face = 0.0, sheet = 0.0;
        for (int k = 0; k < STEPS; k++) {
            const float t = ((float)k + 0.5f) / STEPS;
            float cos_t;
            const float r = ppmi_fresnel_dielectric(t * t, eta, &cos_t), weight = 4.0f * t * t * t;
            face += (double)(weight * r);
            sheet += (double)(weight * 2.0f * r / (1.0f + r));
        }
        table->reflected[i] = (float)(face / STEPS);
        table->sheet_reflected[i] = (float)(sheet / STEPS);
    }
}

void ppmi_glass_table_init(ppmi_glass_table *table)
{
    ppmi_vec2 points[POINTS];
    for (int i = 0; i < POINTS; i++) {
        /* half a turn is enough: the other half is its mirror image */
        const float turn = ((float)(i * LATTICE_STEP % POINTS) + 0.5f) / POINTS;
        points[i] = (ppmi_vec2){0.5f * turn, ((float)i + 0.5f) / POINTS};
    }
    for (int r = 0; r < PPMI_GLASS_ROUGHNESSES; r++) {
        const float roughness = (float)r / (PPMI_GLASS_ROUGHNESSES - 1);
        facets all;
        init_facets(&all, ppmi_max(roughness * roughness, PPMI_SMOOTH_ALPHA), points);
        for (int i = 0; i < PPMI_GLASS_INDICES; i++) {
            const float index = index_at(i, PPMI_GLASS_INDICES);
            for (int s = 0; s < 2; s++) {
                ppmi_glass_side *side = &table->sides[r][i][s];
                for (int c = 0; c < COSINES; c++)
                    side->lost[c] = integrate(&all, c, s == 0 ? index : 1.0f / index);
                side->average = average_of(side->lost);
            }
        }
    }
    init_reflected(table);
}

/* ---- lookup ---------------------------------------------------------------------------------- */

static float mix(float a, float b, float t)
{
    return a + (b - a) * t;
}

float ppmi_glass_lost(const ppmi_glass_table *table, float roughness, float eta, float cosine)
{
    float tr, ti, tc;
    const int s = eta < 1.0f ? 1 : 0;
    const int r = cell(roughness, PPMI_GLASS_ROUGHNESSES, &tr);
    const int i = cell(index_position(eta), PPMI_GLASS_INDICES, &ti);
    const int c = cell(sqrtf(ppmi_max(cosine, 0.0f)), COSINES, &tc);
    float at[2];
    for (int k = 0; k < 2; k++) {
        const float *low = table->sides[r + k][i][s].lost + c;
        const float *high = table->sides[r + k][i + 1][s].lost + c;
        at[k] = mix(mix(low[0], low[1], tc), mix(high[0], high[1], tc), ti);
    }
    return mix(at[0], at[1], tr);
}

float ppmi_glass_lost_average(const ppmi_glass_table *table, float roughness, float eta)
{
    float tr, ti;
    const int s = eta < 1.0f ? 1 : 0;
    const int r = cell(roughness, PPMI_GLASS_ROUGHNESSES, &tr);
    const int i = cell(index_position(eta), PPMI_GLASS_INDICES, &ti);
    return mix(mix(table->sides[r][i][s].average, table->sides[r][i + 1][s].average, ti),
               mix(table->sides[r + 1][i][s].average, table->sides[r + 1][i + 1][s].average, ti),
               tr);
}

static float at_index(const float table[PPMI_GLASS_SHEETS], float eta)
{
    float t;
    const int i = cell(index_position(eta), PPMI_GLASS_SHEETS, &t);
    return mix(table[i], table[i + 1], t);
}

float ppmi_glass_transmitted_average(const ppmi_glass_table *table, float eta)
{
    const float outside = 1.0f - at_index(table->reflected, eta);
    return eta < 1.0f ? outside * eta * eta : outside;
}

float ppmi_glass_sheet_transmitted_average(const ppmi_glass_table *table, float eta)
{
    return 1.0f - at_index(table->sheet_reflected, eta);
}
