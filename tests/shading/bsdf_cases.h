/* The grid of BSDFs that the tests go through: kinds of material by roughness by angle. */
#ifndef TEST_SHADING_BSDF_CASES_H
#define TEST_SHADING_BSDF_CASES_H

#include "math/sampler.h"
#include "shading/bsdf.h"

typedef struct bsdf_case {
    char name[96];
    ppmi_material_point point;
    float roughness, cosine;
    bool from_back; /* wo is on the back of the surface: inside a solid */
} bsdf_case;

enum {
    KIND_LAMBERT,
    KIND_PLASTIC,
    KIND_WHITE_PLASTIC,
    KIND_METAL,
    KIND_WHITE_METAL,
    KIND_HALF_METAL,
    KIND_GLASS,
    KIND_GLASS_INSIDE,
    KIND_THIN_GLASS,
    KIND_HALF_GLASS,
    KIND_HALF_GLASS_INSIDE,
    KIND_WATER_TO_GLASS, /* nested solids: the index before the surface is not 1 */
    KIND_GLASS_TO_WATER,
    KIND_DENSE_GLASS,
    KIND_DENSE_GLASS_INSIDE,
    KIND_ROUGH_LAMBERT,
    KIND_WHITE_ROUGH_LAMBERT,
    KIND_WHITE_ROUGH_PLASTIC,
    KIND_EDGE_COLORED_PLASTIC,
    KIND_COATED_LAMBERT, /* layered, from here on */
    KIND_WHITE_COATED_PLASTIC,
    KIND_WHITE_COATED_METAL,
    KIND_WHITE_ROUGH_COATED_METAL, /* of a coat as rough as the base */
    KIND_WHITE_SHEEN,
    KIND_WHITE_SMOOTH_SHEEN,
    KIND_WHITE_COATED_SHEEN_METAL,
    KIND_WHITE_BRUSHED_METAL,
    KIND_BRUSHED_PLASTIC,
    KIND_FILM_METAL,
    KIND_FILM_PLASTIC,
    KIND_FILM_GLASS,
    KIND_FILM_THIN_GLASS,
    KIND_WHITE_LEAF,
    KIND_COATED_LEAF,
    KIND_WHITE_RETRO_METAL,
    KIND_RETRO_PLASTIC,
    KIND_COATED_GLASS,
    KIND_WHITE_EVERYTHING,
    KIND_ROUGH_LEAF,
    KIND_TINTED_COAT,
    KIND_DARKENED_METAL,
    KIND_TINTED_GLASS,
    KIND_WHITE_BRUSHED_COAT,
    KIND_WHITE_FUZZ,
    KIND_WHITE_FUZZ_ON_COAT,
    KIND_DARK_FUZZ,
    KIND_EDGE_COLORED_METAL,
    KINDS
};
enum { ROUGHNESSES = 7, COSINES = 4 };

typedef void (*bsdf_check)(const bsdf_case *item, const ppmi_bsdf *bsdf, void *user);

/* The table that all tests share. */
const ppmi_albedo_table *bsdf_albedo(void);

/* The BSDF of a kind; wo lies in the plane of x and z, the surface faces +z. */
void bsdf_make_case(int kind, float roughness, float cosine, bsdf_case *item, ppmi_bsdf *bsdf);

/* Calls check with every combination. */
void bsdf_for_all(bsdf_check check, void *user);

/* Direction of wo in the world. */
ppmi_vec3 bsdf_wo(const ppmi_bsdf *bsdf);

/* A direction evenly over the sphere. */
ppmi_vec3 bsdf_random_direction(ppmi_rng *rng);

/* Draws with all lobes. */
bool bsdf_draw(const ppmi_bsdf *bsdf, ppmi_rng *rng, ppmi_transport transport,
               ppmi_bsdf_sample *sample);

#endif
