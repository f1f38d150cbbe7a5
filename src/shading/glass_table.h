/* What single scattering in a rough dielectric interface loses: of both sides, the albedo of
 * reflection and transmission together, tabulated. bsdf.c returns the rest (Kulla and Conty 2017,
 * "Revisiting physically based shading at Imageworks"). */
#ifndef PPMI_SHADING_GLASS_TABLE_H
#define PPMI_SHADING_GLASS_TABLE_H

enum {
    PPMI_GLASS_ROUGHNESSES = 20,
    PPMI_GLASS_INDICES = 20,
    PPMI_GLASS_COSINES = 24,
    PPMI_GLASS_SHEETS = 64
};

/* One side of an interface: 1 - E. */
typedef struct ppmi_glass_side {
    float lost[PPMI_GLASS_COSINES]; /* by the cosine, in even steps of its root */
    float average; /* weighted by the cosine, of what lies between the entries too */
} ppmi_glass_side;

typedef struct ppmi_glass_table {
    /* [roughness][index][side]: roughness in even steps from 0 to 1; the index n of the denser side
     * by the other's in even steps of the root of (n - 1) / (n + 1), from 1 to infinity; the side
     * of the lower index first */
    ppmi_glass_side sides[PPMI_GLASS_ROUGHNESSES][PPMI_GLASS_INDICES][2];
    /* [index], as above: the Fresnel term's mean, weighted by the cosine, of the side of the lower
     * index; of thin sheets, both faces */
    float reflected[PPMI_GLASS_SHEETS], sheet_reflected[PPMI_GLASS_SHEETS];
} ppmi_glass_table;

/* Integrates the table: some 10^6 samples. */
void ppmi_glass_table_init(ppmi_glass_table *table);

/* 1 - E of a solid's interface at roughness 0..1. eta: index on the far side by the one on the
 * direction's own side; cosine: to the normal on that side, 0..1. */
float ppmi_glass_lost(const ppmi_glass_table *table, float roughness, float eta, float cosine);
/* Its mean over the directions of that side, weighted by the cosine. */
float ppmi_glass_lost_average(const ppmi_glass_table *table, float roughness, float eta);

/* Mean of 1 - Fresnel's term, weighted by the cosine; the way back has eta^2 times as much. */
float ppmi_glass_transmitted_average(const ppmi_glass_table *table, float eta);
/* The same of a thin sheet, with the light that goes to and fro in it. */
float ppmi_glass_sheet_transmitted_average(const ppmi_glass_table *table, float eta);

#endif
