/* Draco behind a C interface: a compressed mesh in, indices and attributes out. C interface of a
 * C++ shim: no exception leaves it. */
#ifndef PPMI_GLTF_DRACO_SHIM_H
#define PPMI_GLTF_DRACO_SHIM_H

#include <stdint.h>

#include "base/context.h"

#ifdef __cplusplus
extern "C" {
#endif

typedef struct ppmi_gltf_draco ppmi_gltf_draco;

/* Decodes a stream, once its header has been found to promise no more than max_faces triangles:
 * the decoder makes room for as many as the stream claims. *out_reason says what is wrong after
 * INPUT_INVALID (and lives as long as the program). Returns OK, INPUT_INVALID, OUT_OF_MEMORY, all
 * unreported. */
ppm_status ppmi_gltf_draco_create(const unsigned char *stream, size_t length, uint32_t max_faces,
                                  const char **out_reason, ppmi_gltf_draco **out_draco);
/* NULL is fine. */
void ppmi_gltf_draco_destroy(ppmi_gltf_draco *draco);

uint32_t ppmi_gltf_draco_point_count(const ppmi_gltf_draco *draco);
uint32_t ppmi_gltf_draco_face_count(const ppmi_gltf_draco *draco);

/* 3 * face_count indices, each below point_count. */
void ppmi_gltf_draco_indices(const ppmi_gltf_draco *draco, uint32_t *out_indices);

/* Attribute id as numbers, integers as they are: point_count * components of them. False when there
 * is none of that id, or it has fewer components. */
bool ppmi_gltf_draco_values(const ppmi_gltf_draco *draco, int32_t id, uint32_t components,
                            double *out_values);

#ifdef __cplusplus
}
#endif

#endif
