/* The coat and the sheen of layered materials: what they reflect, leave over and tint. Used by
 * layers.c and bsdf.c. Directions are local, but w_coat, which are in the coat's frame. */
#ifndef PPMI_SHADING_LAYERS_TOP_H
#define PPMI_SHADING_LAYERS_TOP_H

#include "shading/bsdf.h"

bool ppmi_has_top(const ppmi_bsdf_layers *layers);

/* ---- the coat -------------------------------------------------------------------------------- */

bool ppmi_coat_is_mirror(const ppmi_bsdf_layers *layers);
ppmi_frame ppmi_coat_frame(const ppmi_bsdf_layers *layers);

/* A direction in the coat's frame, on its upper side; along its normal where there is no coat. Only
 * a coat of two widths asks for more than the cosine. */
ppmi_vec3 ppmi_coat_direction(const ppmi_bsdf_layers *layers, ppmi_vec3 w);

/* One that stands for all of a cosine: between along and across. */
ppmi_vec3 ppmi_coat_at_cosine(float cosine);

float ppmi_coat_albedo(const ppmi_bsdf_layers *layers, const ppmi_albedo_table *albedo,
                       ppmi_vec3 w_coat);

/* ---- both ------------------------------------------------------------------------------------ */

/* What the fibres stop; they may absorb a part of it. */
float ppmi_sheen_albedo(const ppmi_bsdf_layers *layers, const ppmi_albedo_table *albedo,
                        float cosine);

/* Albedos of coat and sheen; the one that lies below has only what the other leaves it. */
typedef struct ppmi_top_albedos {
    float coat, sheen;
} ppmi_top_albedos;

ppmi_top_albedos ppmi_top_albedos_at(const ppmi_bsdf_layers *layers,
                                     const ppmi_albedo_table *albedo, ppmi_vec3 w_coat,
                                     float cosine);

/* T: what coat and sheen leave over of light from one direction, by its cosine to the base's normal
 * too. */
float ppmi_top_left_over(const ppmi_bsdf_layers *layers, const ppmi_albedo_table *albedo,
                         ppmi_vec3 w_coat, float cosine);

/* What they leave of light between wo and wi, for what lies below; and what fuzz leaves to a coat
 * below it. */
float ppmi_top_passing(const ppmi_bsdf *bsdf, const ppmi_albedo_table *albedo, ppmi_vec3 wi);
float ppmi_fuzz_passing(const ppmi_bsdf *bsdf, const ppmi_albedo_table *albedo, float cos_i);

/* Roughness of a lobe of one width that spreads as far on average as two: by their mean square. */
float ppmi_mean_roughness(ppmi_vec2 alpha);

/* ---- the coat's colour ----------------------------------------------------------------------- */

/* What it leaves of light that goes from wo to the base and on to wi or back; path_in: the length
 * of the way through the coat on wi's side. And of light by way of the sheen. */
ppmi_vec3 ppmi_base_tint(const ppmi_bsdf *bsdf, float path_in);
ppmi_vec3 ppmi_base_tint_to(const ppmi_bsdf *bsdf, ppmi_vec3 wi);
ppmi_vec3 ppmi_sheen_tint_to(const ppmi_bsdf *bsdf, ppmi_vec3 wi);

/* What coat and sheen leave of light that goes from wo to wi or back by way of the glass. */
ppmi_vec3 ppmi_layers_glass_passing(const ppmi_bsdf *bsdf, const ppmi_albedo_table *albedo,
                                    ppmi_vec3 wi);

#endif
