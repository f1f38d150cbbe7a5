/* The lobes of layered materials: clearcoat over sheen over a base with film, two widths, diffuse
 * transmission and retroreflection. Used by bsdf.c alone; bsdf->is_layered throughout.
 *
 * Directions are local. docs/materials.md has the formulas. */
#ifndef PPMI_SHADING_LAYERS_H
#define PPMI_SHADING_LAYERS_H

#include "shading/bsdf.h"

/* Albedos by lobe, in the lobes' order, for the choice among them. */
typedef struct ppmi_lobe_albedos {
    float of[PPMI_LOBE_COUNT];
} ppmi_lobe_albedos;

/* What a dielectric base reflects and how much of the surface is what, from the material. */
typedef struct ppmi_base_shares {
    ppmi_vec3 dielectric_f0;
    float opaque, metallic; /* share of what is not glass; metal's share of that */
} ppmi_base_shares;

/* Completes a BSDF whose frame, wo, speculars and glass are set: layers, colours of the diffuse
 * base, lobes that are delta or gather. coat_normal: world, on wo's side, seen by wo. */
void ppmi_layers_make(ppmi_bsdf *bsdf, const ppmi_albedo_table *albedo,
                      const ppmi_material_point *point, const ppmi_base_shares *shares,
                      ppmi_vec3 coat_normal, ppmi_lobe_albedos *out_albedos);

/* Albedo for light that goes to wo, of the lobes in mask but GLASS, by channel. */
ppmi_vec3 ppmi_layers_albedo(const ppmi_bsdf *bsdf, const ppmi_albedo_table *albedo, uint32_t mask);

/* f of the base's lobes in mask but GLASS, for wi whose side is clear; none of them delta. */
ppmi_vec3 ppmi_layers_eval_base(const ppmi_bsdf *bsdf, const ppmi_albedo_table *albedo,
                                ppmi_vec3 wi, uint32_t mask);
float ppmi_layers_pdf_base(const ppmi_bsdf *bsdf, ppmi_vec3 wi, uint32_t mask);

/* f of the rough coat times its normal's cosine by the base's, so that callers find the coat's
 * cosine in the product (see ppmi_transport for which direction's). */
ppmi_vec3 ppmi_layers_eval_coat(const ppmi_bsdf *bsdf, const ppmi_albedo_table *albedo,
                                ppmi_vec3 wi, ppmi_transport transport);
float ppmi_layers_pdf_coat(const ppmi_bsdf *bsdf, ppmi_vec3 wi);

/* Draws from one lobe that is not delta. False when nothing leaves. */
bool ppmi_layers_draw(const ppmi_bsdf *bsdf, uint32_t lobe, float u, float v, ppmi_vec3 *out_wi);

/* The direction and weight of a delta lobe: COAT, SPEC or RETRO. False for a coat that reflects
 * nothing. */
bool ppmi_layers_mirror(const ppmi_bsdf *bsdf, const ppmi_albedo_table *albedo, uint32_t lobe,
                        ppmi_transport transport, ppmi_vec3 *out_wi, ppmi_vec3 *out_weight);

/* Reflectance of the glass lobe under a film, by channel; plain: without it. cos_outside: on the
 * side of the lower index. */
ppmi_vec3 ppmi_layers_glass(const ppmi_bsdf *bsdf, float plain, float cos_outside);

static inline bool ppmi_layers_have_film(const ppmi_bsdf *bsdf)
{
    return bsdf->is_layered && bsdf->layers.film > 0.0f;
}

#endif
