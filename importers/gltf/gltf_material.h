/* A material on its way from the file to the scene, and the groups of values that it is made of.
 * Textures are added to the scene on the way. */
#ifndef PPMI_GLTF_MATERIAL_H
#define PPMI_GLTF_MATERIAL_H

#include "gltf/gltf_reader.h"

#define PPMI_GLTF_HUGE 1e18 /* what the scene accepts at most */

typedef struct ppmi_gltf_conversion {
    ppmi_gltf_reader *reader;
    const ppmi_gltf_material *from;
    char place[PPMI_GLTF_PLACE]; /* materials[i] */
    ppm_material_desc desc;
    ppm_status status; /* the first failure */
} ppmi_gltf_conversion;

/* Fills in a desc, except for its name, from the values of material number index, which may differ
 * from those of the document (animations). Values out of range are brought into it and textures
 * that cannot be had are left out, with warnings. Returns OK, OUT_OF_MEMORY, WRONG_STATE. */
ppm_status ppmi_gltf_convert_material(ppmi_gltf_reader *reader, int32_t index,
                                      const ppmi_gltf_material *from, ppm_material_desc *out_desc);

/* Brings count values into low .. high, with one warning for all of them. name: "KHR_x.member". */
void ppmi_gltf_set(ppmi_gltf_conversion *c, const char *name, const double *from, int count,
                   double low, double high, float *out);

/* role: PPM_IMAGE_ */
void ppmi_gltf_set_texture(ppmi_gltf_conversion *c, const char *name,
                           const ppmi_gltf_texture_info *info, int32_t role, ppm_texture *out);

/* The role for a slot that reads alpha alone, which is a number in either role: COLOR if a colour
 * slot beside it has the same image, which is then kept once. */
int32_t ppmi_gltf_alpha_role(const ppmi_gltf_conversion *c, const ppmi_gltf_texture_info *alpha,
                             const ppmi_gltf_texture_info *color);

/* gltf_material_layers.c: clearcoat, sheen, iridescence, anisotropy, retroreflection. */
void ppmi_gltf_convert_layers(ppmi_gltf_conversion *c);

/* gltf_material_coat.c: the drafts that are to replace clearcoat and sheen. */
void ppmi_gltf_convert_coat(ppmi_gltf_conversion *c);
void ppmi_gltf_convert_fuzz(ppmi_gltf_conversion *c);

/* gltf_material_inside.c: transmission, diffuse transmission, and the volume behind them. */
void ppmi_gltf_convert_inside(ppmi_gltf_conversion *c);

/* gltf_material_scatter.c: KHR_materials_scatter on a sheet, whose transmission has been set. */
void ppmi_gltf_convert_sheet_scatter(ppmi_gltf_conversion *c);

/* gltf_specular_glossiness.c: in place of the core values and of ior and specular. */
void ppmi_gltf_convert_specular_glossiness(ppmi_gltf_conversion *c);

#endif
