/* Images of a glTF file that are KTX files: unpacked here, and handed to the scene as pixels. */
#ifndef PPMI_GLTF_KTX2_IMAGE_H
#define PPMI_GLTF_KTX2_IMAGE_H

#include "gltf/ktx2.h"

/* Whether the bytes, or the file at the path, of an image begin like a KTX file. */
bool ppmi_gltf_is_ktx2(const ppm_image_desc *source);

/* The encoding of a KTX file that is not read; NULL for all other images. */
const char *ppmi_gltf_unread_ktx2(ppm_context *context, const ppm_image_desc *source);

/* The flat picture of a KTX file instead of the file: source becomes what the picture is, and
 * *owned, which the caller frees, what that points to; what it was before is freed. *note, for a
 * warning, is left alone where there is none. Returns OK, INPUT_NOT_FOUND, INPUT_INVALID,
 * INPUT_UNSUPPORTED, OUT_OF_MEMORY, unreported, with the reason; source is as it was then. */
ppm_status ppmi_gltf_unwrap_picture(ppm_context *context, ppm_image_desc *source, void **owned,
                                    const char **note, char reason[PPMI_KTX2_REASON]);

/* The six faces of the cube in a layer, as images of source's role. owned has six entries, which
 * the caller frees, also after a failure. Returns as above. */
ppm_status ppmi_gltf_unwrap_cube(ppm_context *context, const ppm_image_desc *source, uint32_t layer,
                                 ppm_image_desc faces[6], void *owned[6], const char **note,
                                 char reason[PPMI_KTX2_REASON]);

#endif
