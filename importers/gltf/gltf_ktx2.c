/* From the source of an image, which may be a KTX file, to pictures. */
#include "gltf/gltf_ktx2.h"

#include <stdio.h>

#include "gltf/gltf_map.h"

enum { BEGINNING = 12 };

bool ppmi_gltf_is_ktx2(const ppm_image_desc *source)
{
    unsigned char begin[BEGINNING];
    if (source->bytes) return ppmi_ktx2_is(source->bytes, source->byte_count);
    FILE *file = source->path ? fopen(source->path, "rb") : NULL;
    if (!file) return false;
    const size_t count = fread(begin, 1, sizeof begin, file);
    fclose(file);
    return ppmi_ktx2_is(begin, count);
}

/* The whole file: the bytes of the source, or those of its path, in map. */
static ppm_status get_bytes(ppm_context *context, const ppm_image_desc *source, ppmi_gltf_map *map,
                            const unsigned char **out_bytes, size_t *out_count, const char **reason)
{
    *out_bytes = source->bytes;
    *out_count = source->byte_count;
    if (source->bytes) return PPM_STATUS_OK;
    const ppm_status status = ppmi_gltf_map_open(context, source->path, 0, map, reason);
    *out_bytes = map->bytes;
    *out_count = map->count;
    return status;
}

const char *ppmi_gltf_unread_ktx2(ppm_context *context, const ppm_image_desc *source)
{
    ppmi_gltf_map map = {0};
    const unsigned char *bytes;
    const char *reason, *encoding = NULL;
    size_t count;
    if (!ppmi_gltf_is_ktx2(source)) return NULL;
    if (get_bytes(context, source, &map, &bytes, &count, &reason) == PPM_STATUS_OK) {
        encoding = ppmi_ktx2_unread_encoding(bytes, count);
    }
    ppmi_gltf_map_close(context, &map);
    return encoding;
}

/* Faces first, first + 1, ... of a layer. */
static ppm_status read_pictures(ppm_context *context, const ppm_image_desc *source,
                                uint32_t wanted_faces, uint32_t layer, ppm_image_desc *pictures,
                                void **owned, const char **note, char reason[PPMI_KTX2_REASON])
{
    ppmi_gltf_map map = {0};
    ppmi_ktx2 file = {0};
    const unsigned char *bytes;
    const char *why = "";
    size_t count;
    ppm_status status = get_bytes(context, source, &map, &bytes, &count, &why);
    snprintf(file.reason, sizeof file.reason, "%s", why);
    if (status == PPM_STATUS_OK) status = ppmi_ktx2_open(context, bytes, count, &file);
    if (status == PPM_STATUS_OK && file.faces != wanted_faces) {
        snprintf(file.reason, sizeof file.reason, "it has %u faces, and %u are needed", file.faces,
                 wanted_faces);
        status = PPM_STATUS_INPUT_UNSUPPORTED;
    }
    for (uint32_t i = 0; i < wanted_faces && status == PPM_STATUS_OK; ++i) {
        pictures[i] = *source;
        status = ppmi_ktx2_picture(context, &file, layer, i, &pictures[i], &owned[i]);
    }
    if (file.colors_note) *note = file.colors_note;
    snprintf(reason, PPMI_KTX2_REASON, "%s", file.reason);
    ppmi_ktx2_close(context, &file);
    ppmi_gltf_map_close(context, &map);
    return status;
}

ppm_status ppmi_gltf_unwrap_picture(ppm_context *context, ppm_image_desc *source, void **owned,
                                    const char **note, char reason[PPMI_KTX2_REASON])
{
    ppm_image_desc picture;
    void *block = NULL;
    const ppm_status status = read_pictures(context, source, 1, 0, &picture, &block, note, reason);
    if (status != PPM_STATUS_OK) return status;
    ppmi_free(context, *owned);
    *owned = block;
    *source = picture;
    return status;
}

ppm_status ppmi_gltf_unwrap_cube(ppm_context *context, const ppm_image_desc *source, uint32_t layer,
                                 ppm_image_desc faces[6], void *owned[6], const char **note,
                                 char reason[PPMI_KTX2_REASON])
{
    for (int i = 0; i < 6; ++i)
        owned[i] = NULL;
    return read_pictures(context, source, 6, layer, faces, owned, note, reason);
}
