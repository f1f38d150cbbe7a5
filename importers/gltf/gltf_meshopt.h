/* EXT_meshopt_compression and KHR_meshopt_compression: buffer views that are kept in a smaller
 * form. meshoptimizer reads the streams that it knows; gltf_meshopt_v1.c the newer attributes. */
#ifndef PPMI_GLTF_MESHOPT_H
#define PPMI_GLTF_MESHOPT_H

#include "gltf/gltf_shim.h"

/* NULL when what the extension says of a view is possible; otherwise why not. available is the
 * length of the stream: what is claimed to be in it cannot be more than its densest form holds, so
 * that a small file cannot ask for any amount of memory. */
const char *ppmi_gltf_meshopt_fault(const ppmi_gltf_meshopt *view, const unsigned char *stream);

/* Decodes byte_length bytes of a stream without such faults into count * byte_stride bytes. False
 * when the stream is broken. */
bool ppmi_gltf_meshopt_decode(const ppmi_gltf_meshopt *view, const unsigned char *stream,
                              unsigned char *out);

/* gltf_meshopt_v1.c: an attribute stream of version 1. stride is a multiple of 4, at most 256. */
bool ppmi_gltf_meshopt_decode_v1(unsigned char *out, size_t count, size_t stride,
                                 const unsigned char *stream, size_t length);

#endif
