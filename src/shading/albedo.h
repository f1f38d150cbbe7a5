/* Directional albedo of single-scattering GGX with Schlick's Fresnel, tabulated: what Kulla and
 * Conty ("Revisiting Physically Based Shading at Imageworks", SIGGRAPH course 2017) need to return
 * the energy that single scattering loses, and to put a diffuse base under a coat.
 *
 * Schlick's Fresnel is linear in F0 and F90, so the albedo is F0 * a + F90 * b. */
#ifndef PPMI_SHADING_ALBEDO_H
#define PPMI_SHADING_ALBEDO_H

#include "base/context.h"
#include "math/vec.h"
#include "shading/glass_table.h"
#include "shading/lobe_table.h"

enum { PPMI_ALBEDO_COSINES = 32, PPMI_ALBEDO_ROUGHNESSES = 32 };

typedef struct ppmi_albedo_table {
    /* [roughness][cosine], both from 0 to 1 in even steps; roughness is the root of GGX alpha */
    ppmi_albedo_pair directional[PPMI_ALBEDO_ROUGHNESSES][PPMI_ALBEDO_COSINES];
    ppmi_albedo_pair average[PPMI_ALBEDO_ROUGHNESSES]; /* cosine-weighted mean over directions */
    const ppmi_lobe_table *lobes;  /* of layered materials; NULL where there are none */
    const ppmi_glass_table *glass; /* of rough glass; NULL where there is none */
} ppmi_albedo_table;

/* Integrates the table: some 10^6 samples, once per render session. Lobes and glass are the
 * caller's. */
void ppmi_albedo_table_init(ppmi_albedo_table *table);

ppmi_albedo_pair ppmi_albedo_directional(const ppmi_albedo_table *table, float roughness,
                                         float cosine);
ppmi_albedo_pair ppmi_albedo_average(const ppmi_albedo_table *table, float roughness);

#endif
