/* URIs of buffers and images: data, or a file in the asset's folder and nowhere else. */
#ifndef PPMI_GLTF_URI_H
#define PPMI_GLTF_URI_H

#include "base/context.h"

/* Whether it is a data: URI. */
bool ppmi_gltf_uri_is_data(const char *uri, size_t length);

/* Decodes a data: URI (base64 or percent-encoded). *out_bytes is the caller's; it may be NULL for
 * no bytes. Returns OK, INPUT_INVALID or OUT_OF_MEMORY, unreported; *out_reason then says what is
 * wrong. */
ppm_status ppmi_gltf_uri_decode_data(ppm_context *context, const char *uri, size_t length,
                                     unsigned char **out_bytes, size_t *out_count,
                                     const char **out_reason);

/* The file that a relative URI names, percent-decoded, in the folder of asset_path. *out_path is
 * the caller's. Refused are other schemes, absolute paths and paths that leave the folder; with
 * allow_outside only schemes other than file: on this machine. Returns as above. */
ppm_status ppmi_gltf_uri_path(ppm_context *context, const char *asset_path, bool allow_outside,
                              const char *uri, size_t length, char **out_path,
                              const char **out_reason);

#endif
