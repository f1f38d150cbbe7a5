/* Tables for layered materials: how a lobe spreads over the directions that it reflects to, so that
 * what a layer above it lets through can be integrated at any point; the albedo of the sheen; the
 * albedo of GGX with two widths. */
#ifndef PPMI_SHADING_LOBE_TABLE_H
#define PPMI_SHADING_LOBE_TABLE_H

#include "math/vec.h"

typedef struct ppmi_albedo_pair {
    float a, b; /* factors of F0 and F90 */
} ppmi_albedo_pair;

static inline float ppmi_albedo_value(ppmi_albedo_pair pair, float f0, float f90)
{
    return pair.a * f0 + pair.b * f90;
}

enum {
    PPMI_LOBE_NODES = 6,
    PPMI_LOBE_ROUGHNESSES = 16,
    PPMI_LOBE_COSINES = 24,
    PPMI_WIDE_ROUGHNESSES = 12,
    PPMI_WIDE_STRENGTHS = 8,
    PPMI_WIDE_COSINES = 12,
    PPMI_WIDE_ANGLES = 5
};

/* A lobe in parts of equal weight by what it reflects: the mean cosines to the normal, rising, and
 * in other parts to the half vector. */
typedef struct ppmi_lobe_nodes {
    float cos_i[PPMI_LOBE_NODES], cos_h[PPMI_LOBE_NODES];
} ppmi_lobe_nodes;

typedef struct ppmi_lobe_table {
    /* [roughness][cosine], GGX, roughness and cosine in even steps from 0 to 1 */
    ppmi_lobe_nodes ggx[PPMI_LOBE_ROUGHNESSES][PPMI_LOBE_COSINES];
    /* [roughness][cosine], sheen, roughness from PPMI_SHEEN_LEAST_ROUGHNESS to 1, steps even in the
     * root of the cosine */
    float sheen[PPMI_LOBE_ROUGHNESSES][PPMI_LOBE_COSINES][PPMI_LOBE_NODES]; /* cos_i */
    float sheen_albedo[PPMI_LOBE_ROUGHNESSES][PPMI_LOBE_COSINES];
    float sheen_raw[PPMI_LOBE_ROUGHNESSES][PPMI_LOBE_COSINES]; /* before it is bounded */
    /* [roughness][strength of anisotropy][cosine][azimuth from the wide axis, 0 to 90 degrees] */
    ppmi_albedo_pair wide[PPMI_WIDE_ROUGHNESSES][PPMI_WIDE_STRENGTHS][PPMI_WIDE_COSINES]
                         [PPMI_WIDE_ANGLES];
} ppmi_lobe_table;

/* Integrates the tables: some 10^6 samples. */
void ppmi_lobe_table_init(ppmi_lobe_table *table);

void ppmi_lobe_ggx_nodes(const ppmi_lobe_table *table, float roughness, float cosine,
                         ppmi_lobe_nodes *out_nodes);
void ppmi_lobe_sheen_nodes(const ppmi_lobe_table *table, float roughness, float cosine,
                           float out_cos_i[PPMI_LOBE_NODES]);
/* What keeps the sheen of one direction within what falls on it: times f, the lesser of both
 * directions' bounds. 1 but for low roughness at the horizon, where the published form makes up to
 * four times the energy. */
float ppmi_lobe_sheen_bound(const ppmi_lobe_table *table, float roughness, float cosine);
/* Directional albedo of a white sheen, bounded. */
float ppmi_lobe_sheen_albedo(const ppmi_lobe_table *table, float roughness, float cosine);

/* Albedo of GGX with the widths of KHR_materials_anisotropy, seen from wo (local). */
ppmi_albedo_pair ppmi_lobe_wide_albedo(const ppmi_lobe_table *table, float roughness,
                                       float strength, ppmi_vec3 wo);

/* Widths along the direction of anisotropy and across it: the extension's formula. */
static inline float ppmi_wide_alpha(float alpha, float strength)
{
    return alpha + (1.0f - alpha) * strength * strength;
}

#endif
