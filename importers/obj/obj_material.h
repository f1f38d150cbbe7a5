/* One material on its way to the scene, for the files that convert its parts. */
#ifndef PPMI_OBJ_MATERIAL_H
#define PPMI_OBJ_MATERIAL_H

#include <math.h>

#include "obj/obj_reader.h"

#define PPMI_OBJ_HUGE 1e18f

typedef struct ppmi_obj_conversion {
    ppmi_obj_reader *reader;
    const ppmi_obj_material *material;
    const ppmi_obj_mtl *from;
    const char *name;
    ppm_material_desc desc;
    ppm_status status; /* the first failure */
} ppmi_obj_conversion;

static inline bool ppmi_obj_has(const ppmi_obj_conversion *c, uint32_t statement)
{
    return (c->material->given & statement) != 0;
}

static inline bool ppmi_obj_has_map(const ppmi_obj_conversion *c, int32_t map)
{
    return ppmi_obj_map_is_named(&c->material->maps[map]);
}

static inline float ppmi_obj_limit(float value, float low, float high)
{
    return fminf(fmaxf(value, low), high);
}

/* obj_material.c: a warning with file, line and material. */
void ppmi_obj_material_warn(const ppmi_obj_conversion *c, const char *text);

/* ---- obj_material_maps.c: from maps to textures ---------------------------------------------- */

/* A map of colours, or of one number in all channels. */
void ppmi_obj_use_color(ppmi_obj_conversion *c, int32_t map, ppm_texture *out);
void ppmi_obj_use_scalar(ppmi_obj_conversion *c, int32_t map, ppm_texture *out);
/* map_Kd and map_d in one image. */
void ppmi_obj_use_color_and_alpha(ppmi_obj_conversion *c, ppm_texture *out);
/* map_Pr or, where takes_shininess, map_Ns; and map_Pm. desc holds the values of a material
 * without maps; roughness and metalness become factors. */
void ppmi_obj_use_roughness_and_metal(ppmi_obj_conversion *c, bool takes_shininess);
/* map_aniso and map_anisor, likewise. */
void ppmi_obj_use_anisotropy(ppmi_obj_conversion *c);
/* norm, bump or disp. */
void ppmi_obj_use_relief(ppmi_obj_conversion *c);

/* The roughness of a Phong exponent (obj_material.c). */
float ppmi_obj_roughness_of(float shininess);

#endif
