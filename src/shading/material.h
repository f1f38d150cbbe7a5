/* A material's textures and factors at one point, in the terms of the metallic-roughness model. */
#ifndef PPMI_SHADING_MATERIAL_H
#define PPMI_SHADING_MATERIAL_H

#include "shading/surface.h"

/* What lies on the base, and what the base does beside reflecting and refracting. */
typedef struct ppmi_layer_point {
    float coat, coat_roughness;
    ppmi_vec3 coat_normal; /* front side */
    ppmi_vec3 coat_tint;   /* of light that has gone through it twice, straight */
    float coat_ior, coat_darkening;
    float coat_anisotropy;
    ppmi_vec3 coat_tangent; /* direction of its anisotropy; 0: none */
    ppmi_vec3 sheen_color;  /* what the fibres reflect: colour times share */
    float sheen_share;      /* of the surface that the fibres cover, whatever their colour */
    float sheen_roughness;
    bool sheen_is_on_top;            /* of the coat: fuzz */
    float film, film_ior, film_nm;   /* iridescence: share, index, thickness */
    const ppmi_working_space *space; /* whose channels a film's colours are; NULL: Rec.709 */
    float anisotropy;
    ppmi_vec3 tangent; /* direction of anisotropy; 0: none */
    float through;     /* diffuse transmission: share of the diffuse base */
    ppmi_vec3 through_color;
    float retro; /* share of the specular reflection */
} ppmi_layer_point;

typedef struct ppmi_material_point {
    ppmi_vec3 base_color;
    float metallic;
    float roughness; /* perceptual: GGX alpha is its square */
    float ior;
    float specular;           /* F90 of the dielectric */
    ppmi_vec3 specular_color; /* scales its F0, or as edge_color says */
    bool edge_color;          /* EXT_materials_specular_edge_color */
    float diffuse_roughness;
    float transmission;
    bool is_thin;
    float relative_index; /* of refraction, beyond the surface by this side; 0: from ior, with
                             nothing outside */
    ppmi_vec3 ns;         /* shading normal after the normal map, front side */
    bool is_layered;
    ppmi_layer_point layers; /* set if it is */
} ppmi_material_point;

void ppmi_material_evaluate(const ppm_scene *scene, const ppmi_surface *surface,
                            ppmi_material_point *out_point);

/* What a clearcoat leaves of the emission below it in direction wo (unit, away from the surface):
 * 1 - clearcoat * F(N.wo) with the coat's normal (KHR_materials_clearcoat). Emission lies above a
 * coat of KHR_materials_coat. */
float ppmi_material_coat_passing(const ppm_scene *scene, const ppmi_surface *surface, ppmi_vec3 wo);

#endif
