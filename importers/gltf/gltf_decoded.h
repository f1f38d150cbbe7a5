/* What compressed parts of a file hold, decoded at its first use and kept by the reader: buffer
 * views of meshoptimizer's, and accessors that have no bytes but those in a Draco stream. */
#ifndef PPMI_GLTF_DECODED_H
#define PPMI_GLTF_DECODED_H

#include "gltf/gltf_reader.h"

/* The bytes of a view that has a meshopt extension. Where its stream cannot be read, and its buffer
 * has the plain data, *out_bytes is NULL after OK and after a warning. */
ppm_status ppmi_gltf_decoded_view(ppmi_gltf_reader *reader, int32_t view,
                                  const unsigned char **out_bytes, size_t *out_count);

/* The elements of an accessor without a buffer view that are in a Draco stream, packed, as the
 * accessor's type; *out_bytes is NULL after OK where there is no such stream. Their number is the
 * accessor's, but for the indices of strips: they come as those of a triangle list. place is for
 * messages. */
ppm_status ppmi_gltf_decoded_accessor(ppmi_gltf_reader *reader, int32_t accessor, const char *place,
                                      const unsigned char **out_bytes, size_t *out_count);

/* Frees what the primitive's Draco stream held; it would be decoded again. */
void ppmi_gltf_decoded_release(ppmi_gltf_reader *reader, const ppmi_gltf_primitive *primitive);

/* Frees everything. */
void ppmi_gltf_decoded_deinit(ppmi_gltf_reader *reader);

#endif
