/* URIs of buffers and images: data, or a file in the asset's folder and nowhere else. */
#ifndef PPMI_GLTF_URI_H
#define PPMI_GLTF_URI_H

#include "base/context.h"

/* Whether it is a data: URI. */
bool ppmi_gltf_uri_is_data(const char *uri, size_t length);

/* Decodes a data: URI (base64 or percent-encoded). NULL when it went well, else what is wrong.
 * *out_bytes is the caller's; it may be NULL for no bytes. */
const char *ppmi_gltf_uri_decode_data(ppm_context *context, const char *uri, size_t length,
                                      unsigned char **out_bytes, size_t *out_count);

/* The file that a relative URI names, percent-decoded, in the folder of asset_path. NULL when it
 * went well, else what is wrong: another scheme, an absolute path, a path that leaves the folder.
 * *out_path is the caller's. */
const char *ppmi_gltf_uri_path(ppm_context *context, const char *asset_path, const char *uri,
                               size_t length, char **out_path);

#endif
