/* A material's textures and factors at one point, in the terms of the metallic-roughness model. */
#ifndef PPMI_SHADING_MATERIAL_H
#define PPMI_SHADING_MATERIAL_H

#include "shading/surface.h"

typedef struct ppmi_material_point {
    ppmi_vec3 base_color;
    float metallic;
    float roughness; /* perceptual: GGX alpha is its square */
    float ior;
    float specular;           /* F90 of the dielectric */
    ppmi_vec3 specular_color; /* scales its F0 */
    float transmission;
    bool is_thin;
    float relative_index; /* of refraction, beyond the surface by this side; 0: from ior, with
                             nothing outside */
    ppmi_vec3 ns;         /* shading normal after the normal map, front side */
} ppmi_material_point;

void ppmi_material_evaluate(const ppm_scene *scene, const ppmi_surface *surface,
                            ppmi_material_point *out_point);

#endif
