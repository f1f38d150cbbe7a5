/* One material on one triangle, imported, and what the scene got of it. */
#ifndef PPM_TESTS_GLTF_MATERIAL_FIXTURE_H
#define PPM_TESTS_GLTF_MATERIAL_FIXTURE_H

#include "gltf_fixture.h"

/* Imports a triangle with one material; texture 0 has an image of one pixel, and a sampler.
 * material is the inside of its object, JSON with '. Valid until the next import. */
const ppm_material_desc *import_material(gltf_fixture *f, const char *generator,
                                         const char *material);

void assert_values(const float *got, size_t count, const float *expected);

#endif
