/* Textures and images. An image is decoded at its first use in a role; what is missing, broken or
 * of an unknown format is left out with a warning, and the material's factor alone is used. */
#include <math.h>
#include <stdio.h>
#include <string.h>
#include <sys/stat.h>

#include "gltf/gltf_reader.h"
#include "gltf/gltf_uri.h"

/* OpenGL's numbers in samplers */
enum { GL_NEAREST = 9728, GL_CLAMP_TO_EDGE = 33071, GL_MIRRORED_REPEAT = 33648 };

/* ---- images ---------------------------------------------------------------------------------- */

/* Statuses after which the import goes on without the image. */
static bool is_about_input(ppm_status status)
{
    return status == PPM_STATUS_INPUT_NOT_FOUND || status == PPM_STATUS_INPUT_INVALID ||
           status == PPM_STATUS_INPUT_UNSUPPORTED;
}

static bool is_regular_file(const char *path)
{
    struct stat info;
    return stat(path, &info) == 0 && S_ISREG(info.st_mode);
}

/* Fills bytes or path of desc from a URI. NULL when it went well. What is allocated goes to
 * *owned. */
static const char *locate_uri(ppmi_gltf_reader *reader, ppmi_gltf_span span, ppm_image_desc *desc,
                              void **owned, char *shown, size_t shown_size)
{
    const size_t raw = span.end - span.begin;
    const char *uri = reader->json + span.begin, *reason;
    char *unescaped = NULL;
    size_t length = raw;
    if (raw > 0 && memchr(uri, '\\', raw)) {
        unescaped = ppmi_alloc(reader->context, raw, 1);
        if (!unescaped) return "out of memory";
        length = ppmi_gltf_json_unescape(reader->json, span, unescaped);
        uri = unescaped;
    }
    ppmi_gltf_printable(uri, length < 60 ? length : 60, shown, shown_size);
    if (ppmi_gltf_uri_is_data(uri, length)) {
        unsigned char *bytes = NULL;
        reason = ppmi_gltf_uri_decode_data(reader->context, uri, length, &bytes, &desc->byte_count);
        if (!reason && !bytes) reason = "the data URI is empty";
        desc->bytes = *owned = bytes;
    } else {
        char *path = NULL;
        reason = ppmi_gltf_uri_path(reader->context, reader->path, uri, length, &path);
        if (!reason && !is_regular_file(path)) reason = "the file cannot be opened";
        desc->path = *owned = path;
    }
    ppmi_free(reader->context, unescaped);
    return reason;
}

static ppm_status add_image(ppmi_gltf_reader *reader, int32_t index, int32_t role,
                            ppm_image_id *out_id)
{
    const ppmi_gltf_source *source = &reader->outline.images.items[index];
    char place[PPMI_GLTF_PLACE], name[2 * PPMI_GLTF_PLACE], shown[96] = "";
    void *owned = NULL;
    const char *reason = NULL;
    ppm_status status = PPM_STATUS_OK;
    snprintf(place, sizeof place, "images[%d]", (int)index);
    snprintf(name, sizeof name, "%s: %s", reader->path, place);
    ppm_image_desc desc = {.size = sizeof desc, .name = name, .role = role};
    if (source->has_uri) {
        reason = locate_uri(reader, source->uri, &desc, &owned, shown, sizeof shown);
    } else if (source->buffer_view < 0) {
        reason = "it has neither uri nor bufferView";
    } else {
        const unsigned char *bytes = NULL;
        status = ppmi_gltf_view_bytes(reader, source->buffer_view, place, &bytes, &desc.byte_count);
        desc.bytes = bytes;
    }
    if (!reason && status == PPM_STATUS_OK) {
        status = ppm_scene_add_image(reader->scene, &desc, out_id);
    }
    ppmi_free(reader->context, owned);
    if (!reason && is_about_input(status)) {
        reason = "see the message above";
        status = PPM_STATUS_OK;
    }
    if (reason) {
        ppmi_gltf_warn(reader, place, "left out%s%s%s: %s", shown[0] ? " (\"" : "", shown,
                       shown[0] ? "\")" : "", reason);
    }
    return status;
}

/* 0 when the image cannot be had. */
static ppm_status use_image(ppmi_gltf_reader *reader, int32_t index, int32_t role,
                            const char *place, ppm_image_id *out_id)
{
    *out_id = 0;
    if (!ppmi_gltf_accept(reader, PPMI_GLTF_IMAGES, index, place)) return PPM_STATUS_OK;
    ppmi_gltf_image_use *use = &reader->images[2 * index + (role == PPM_IMAGE_DATA)];
    ppm_status status = PPM_STATUS_OK;
    if (!use->is_tried) {
        use->is_tried = true;
        status = add_image(reader, index, role, &use->id);
    }
    *out_id = use->id;
    return status;
}

/* ---- textures -------------------------------------------------------------------------------- */

static int32_t wrap_mode(int32_t gl)
{
    if (gl == GL_CLAMP_TO_EDGE) return PPM_WRAP_CLAMP;
    return gl == GL_MIRRORED_REPEAT ? PPM_WRAP_MIRROR : PPM_WRAP_REPEAT;
}

static void apply_sampler(ppmi_gltf_reader *reader, int32_t sampler, const char *place,
                          ppm_texture *out)
{
    if (sampler < 0 || !ppmi_gltf_accept(reader, PPMI_GLTF_SAMPLERS, sampler, place)) return;
    const ppmi_gltf_sampler *from = &reader->document->samplers[sampler];
    out->wrap_u = wrap_mode(from->wrap_s);
    out->wrap_v = wrap_mode(from->wrap_t);
    out->filter = from->mag_filter == GL_NEAREST ? PPM_FILTER_NEAREST : PPM_FILTER_LINEAR;
}

/* KHR_texture_transform: translation * rotation * scale. Positive angles turn the coordinates
 * counter-clockwise as one sees them; v points down, hence the signs. They are those with which the
 * extension's example (offset 0 1, a quarter turn, scale 0.5) shows the lower left quarter. */
static void apply_transform(const ppmi_gltf_texture_info *info, ppm_texture *out)
{
    if (!info->has_transform) return;
    const double s = sin(info->rotation_rad), c = cos(info->rotation_rad);
    const double m[6] = {c * info->uv_scale[0],  s * info->uv_scale[1], info->offset[0],
                         -s * info->uv_scale[0], c * info->uv_scale[1], info->offset[1]};
    out->has_transform = 1;
    for (int i = 0; i < 6; ++i) {
        out->uv_transform[i] = (float)fmin(fmax(m[i], -1e15), 1e15);
    }
}

/* The sources of a texture, best first. A KTX2 image comes last: if there is another one, it shows
 * the same and can be read. */
static ppm_status use_sources(ppmi_gltf_reader *reader, const ppmi_gltf_texture *texture,
                              int32_t role, const char *place, ppm_image_id *out_id)
{
    const int32_t sources[] = {texture->webp_source, texture->source, texture->basisu_source};
    ppm_status status = PPM_STATUS_OK;
    bool is_any = false;
    *out_id = 0;
    for (size_t i = 0; i < 3 && *out_id == 0 && status == PPM_STATUS_OK; ++i) {
        if (sources[i] < 0) continue;
        is_any = true;
        status = use_image(reader, sources[i], role, place, out_id);
    }
    if (!is_any) ppmi_gltf_warn(reader, place, "left out: the texture names no image");
    return status;
}

ppm_status ppmi_gltf_use_texture(ppmi_gltf_reader *reader, const ppmi_gltf_texture_info *info,
                                 int32_t role, const char *place, ppm_texture *out_texture)
{
    char inner[PPMI_GLTF_PLACE];
    *out_texture = (ppm_texture){0};
    if (!ppmi_gltf_accept(reader, PPMI_GLTF_TEXTURES, info->texture, place)) return PPM_STATUS_OK;
    if (info->uv_set < 0 || info->uv_set >= PPM_MAX_UV_SETS) {
        ppmi_gltf_warn(reader, place, "left out: TEXCOORD_%d; the last that is read is TEXCOORD_%d",
                       (int)info->uv_set, PPM_MAX_UV_SETS - 1);
        return PPM_STATUS_OK;
    }
    const ppmi_gltf_texture *texture = &reader->document->textures[info->texture];
    ppm_image_id image;
    snprintf(inner, sizeof inner, "textures[%d]", (int)info->texture);
    const ppm_status status = use_sources(reader, texture, role, inner, &image);
    if (status != PPM_STATUS_OK || image == 0) return status;
    out_texture->image = image;
    out_texture->uv_set = (uint32_t)info->uv_set;
    apply_sampler(reader, texture->sampler, inner, out_texture);
    apply_transform(info, out_texture);
    return PPM_STATUS_OK;
}
