/* Lights of all extensions and of extras. */
#ifndef PPMI_GLTF_LIGHT_H
#define PPMI_GLTF_LIGHT_H

#include "gltf/gltf_light_units.h"
#include "gltf/gltf_reader.h"

/* gltf_light.c: adds what a node carries of KHR_lights_punctual, EXT_lights_area, EXT_lights_ies
 * and extras.ppm_area. world is its column-major transform. */
ppm_status ppmi_gltf_add_lights(ppmi_gltf_reader *reader, int32_t node, const double world[16]);

/* gltf_area.c */
ppm_status ppmi_gltf_add_area_light(ppmi_gltf_reader *reader, int32_t node, const double world[16]);
ppm_status ppmi_gltf_add_area_extras(ppmi_gltf_reader *reader, int32_t node,
                                     const double world[16]);

/* gltf_blend.c: gives a spot the falloff of Blender's, extras.ppm_blend; below 0: not said. */
ppm_status ppmi_gltf_blend_spot(ppmi_gltf_reader *reader, const char *place, double blend,
                                ppm_light_desc *desc);
void ppmi_gltf_free_blends(ppmi_gltf_reader *reader);

/* gltf_ies.c */
ppm_status ppmi_gltf_add_ies_light(ppmi_gltf_reader *reader, int32_t node, const double world[16]);

/* gltf_environment.c: the image-based light of the scene that is imported, as the environment. */
ppm_status ppmi_gltf_import_environment(ppmi_gltf_reader *reader);
/* The same of spherical harmonics alone: those of light, which has them. */
ppm_status ppmi_gltf_set_harmonics(ppmi_gltf_reader *reader, const ppmi_gltf_image_light *light);
/* gltf_environment_map.c: the environment map (KHR_environment_map) of the scene that is imported.
 */
ppm_status ppmi_gltf_import_environment_map(ppmi_gltf_reader *reader);

/* color times factor as a light's intensity. NULL when it went well, else what is wrong. */
const char *ppmi_gltf_light_intensity(const double color[3], double factor, float out[3]);

/* What a light's own extras say, and where they are silent those of its node. */
ppmi_gltf_lamp_extras ppmi_gltf_merge_extras(const ppmi_gltf_lamp_extras *own,
                                             const ppmi_gltf_lamp_extras *node);

/* No tool that writes lamps shows them to its camera: nor do we, unless extras.ppm_visible. */
uint32_t ppmi_gltf_is_hidden(const ppmi_gltf_lamp_extras *extras);

/* The light units in effect, PPM_LIGHT_UNITS_ without AUTO. */
int32_t ppmi_gltf_light_units(const ppmi_gltf_reader *reader);

/* Tells which units were chosen and why, and what of lights was not looked at. */
void ppmi_gltf_report_lights(const ppmi_gltf_reader *reader);

#endif
