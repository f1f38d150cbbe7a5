/* Textures and images. An image is added once in each role, in a batch before the materials or at
 * its first use; what is missing, broken or of an unknown format is left out with a warning, and
 * the material's factor alone is used. */
#include <math.h>
#include <stdio.h>
#include <string.h>
#include <sys/stat.h>

#include "gltf/gltf_ktx2.h"
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

/* One image on its way to the scene. */
typedef struct source {
    ppm_image_desc desc;
    void *owned; /* what desc points to, if it was allocated for it */
    char place[PPMI_GLTF_PLACE], name[2 * PPMI_GLTF_PLACE]; /* desc.name */
    ppm_status status;
    char shown[64];              /* its URI, for messages */
    char label[PPMI_GLTF_PLACE]; /* desc.label */
    const char *reason;          /* why it cannot be had */
    char ktx2_reason[PPMI_KTX2_REASON];
} source;

/* Fills in bytes or path from a URI. */
static ppm_status locate_uri(ppmi_gltf_reader *reader, ppmi_gltf_span span, source *s)
{
    unsigned char *bytes = NULL;
    char *path = NULL, *unescaped;
    size_t length;
    ppm_status status;
    const char *uri = ppmi_gltf_unescape_uri(reader, span, &length, &unescaped);
    if (!uri) return PPM_STATUS_OUT_OF_MEMORY;
    ppmi_gltf_printable(uri, length, s->shown, sizeof s->shown);
    if (ppmi_gltf_uri_is_data(uri, length)) {
        status = ppmi_gltf_uri_decode_data(reader->context, uri, length, &bytes,
                                           &s->desc.byte_count, &s->reason);
        if (status == PPM_STATUS_OK && !bytes) s->reason = "the data URI is empty";
        s->desc.bytes = s->owned = bytes;
    } else {
        status =
            ppmi_gltf_uri_path(reader->context, reader->path, reader->options->allow_outside != 0,
                               uri, length, &path, &s->reason);
        if (status == PPM_STATUS_OK && !is_regular_file(path)) s->reason = "it cannot be opened";
        s->desc.path = s->owned = path;
    }
    ppmi_free(reader->context, unescaped);
    return s->reason ? PPM_STATUS_INPUT_INVALID : status;
}

static ppm_status locate(ppmi_gltf_reader *reader, const ppmi_gltf_source *from, const char *place,
                         source *s)
{
    const unsigned char *bytes = NULL;
    if (from->has_uri) return locate_uri(reader, from->uri, s);
    if (from->buffer_view < 0) {
        s->reason = "it has neither uri nor bufferView";
        return PPM_STATUS_INPUT_INVALID;
    }
    const ppm_status status =
        ppmi_gltf_view_bytes(reader, from->buffer_view, place, &bytes, &s->desc.byte_count);
    s->desc.bytes = bytes;
    return status;
}

/* The file's own name for it, or NULL where it has none that fits. */
static const char *label_of(const ppmi_gltf_reader *reader, ppmi_gltf_span name,
                            char label[PPMI_GLTF_PLACE])
{
    if (name.end == name.begin || name.end - name.begin >= PPMI_GLTF_PLACE) return NULL;
    label[ppmi_gltf_json_unescape(reader->json, name, label)] = '\0';
    return label;
}

/* Where the image is: its file, or the bytes of it. */
static void find(ppmi_gltf_reader *reader, size_t index, int32_t role, source *s)
{
    *s =
        (source){.desc = {.size = sizeof s->desc, .role = role, .strict = reader->options->strict}};
    ppmi_gltf_place(s->place, "images[%zu]", index);
    snprintf(s->name, sizeof s->name, "%s: %s", reader->path, s->place);
    s->desc.name = s->name;
    s->desc.label = label_of(reader, reader->outline.images.items[index].name, s->label);
    s->status = locate(reader, &reader->outline.images.items[index], s->place, s);
    if (s->status == PPM_STATUS_OUT_OF_MEMORY) ppmi_gltf_out_of_memory(reader, s->place);
}

/* After a KTX file has been opened: why that went wrong, or what is to be said about it. */
static void note_ktx2(ppmi_gltf_reader *reader, source *s, const char *note)
{
    if (note) ppmi_gltf_warn(reader, s->place, "%s", note);
    if (s->status != PPM_STATUS_OK) s->reason = s->ktx2_reason;
    if (s->status == PPM_STATUS_OUT_OF_MEMORY) ppmi_gltf_out_of_memory(reader, s->place);
}

static void prepare(ppmi_gltf_reader *reader, size_t use, source *s)
{
    const char *note = NULL;
    find(reader, use / 2, use % 2 == 1 ? PPM_IMAGE_DATA : PPM_IMAGE_COLOR, s);
    if (s->status != PPM_STATUS_OK || !ppmi_gltf_is_ktx2(&s->desc)) return;
    s->status =
        ppmi_gltf_unwrap_picture(reader->context, &s->desc, &s->owned, &note, s->ktx2_reason);
    note_ktx2(reader, s, note);
}

/* Adds those of the sources that have been located. */
static ppm_status add_located(ppmi_gltf_reader *reader, const size_t *uses, source *sources,
                              size_t count)
{
    ppm_context *context = reader->context;
    ppm_image_desc *descs = ppmi_alloc(context, count, sizeof *descs);
    ppm_image_id *ids = ppmi_alloc(context, count, sizeof *ids);
    ppm_status *statuses = ppmi_alloc(context, count, sizeof *statuses);
    ppm_status status = PPM_STATUS_OK;
    uint32_t located = 0;
    if (!descs || !ids || !statuses) status = ppmi_gltf_out_of_memory(reader, "images");
    for (size_t i = 0; i < count && status == PPM_STATUS_OK; ++i) {
        if (sources[i].status == PPM_STATUS_OK) descs[located++] = sources[i].desc;
    }
    if (status == PPM_STATUS_OK) {
        status = ppm_scene_add_images(reader->scene, descs, located, ids, statuses);
    }
    for (size_t i = 0, k = 0; i < count && status == PPM_STATUS_OK; ++i) {
        if (sources[i].status != PPM_STATUS_OK) continue;
        sources[i].status = statuses[k];
        reader->images[uses[i]].id = ids[k++];
    }
    ppmi_free(context, descs);
    ppmi_free(context, ids);
    ppmi_free(context, statuses);
    return status;
}

/* A failure that is about the input costs the image only. */
static ppm_status conclude(ppmi_gltf_reader *reader, const source *s)
{
    if (!is_about_input(s->status)) return s->status;
    ppmi_gltf_warn(reader, s->place, "left out%s%s%s: %s", s->shown[0] ? " (\"" : "", s->shown,
                   s->shown[0] ? "\")" : "", s->reason ? s->reason : "see the message above");
    return PPM_STATUS_OK;
}

ppm_status ppmi_gltf_add_images(ppmi_gltf_reader *reader, const size_t *uses, size_t count)
{
    if (count == 0) return PPM_STATUS_OK;
    source *sources = ppmi_alloc(reader->context, count, sizeof *sources);
    if (!sources) return ppmi_gltf_out_of_memory(reader, "images");
    for (size_t i = 0; i < count; ++i) {
        prepare(reader, uses[i], &sources[i]);
        reader->images[uses[i]].is_tried = true;
    }
    ppm_status status = add_located(reader, uses, sources, count);
    for (size_t i = 0; i < count; ++i) {
        if (status == PPM_STATUS_OK) status = conclude(reader, &sources[i]);
        ppmi_free(reader->context, sources[i].owned);
    }
    ppmi_free(reader->context, sources);
    return status;
}

ppm_status ppmi_gltf_use_image(ppmi_gltf_reader *reader, int32_t index, int32_t role,
                               const char *place, ppm_image_id *out_id)
{
    *out_id = 0;
    if (!ppmi_gltf_accept(reader, PPMI_GLTF_IMAGES, index, place)) return PPM_STATUS_OK;
    const size_t use = 2 * (size_t)index + (role == PPM_IMAGE_DATA);
    ppm_status status = PPM_STATUS_OK;
    if (reader->is_looking_at_textures) {
        reader->images[use].is_wanted = true;
    } else if (!reader->images[use].is_tried) {
        status = ppmi_gltf_add_images(reader, &use, 1);
    }
    *out_id = reader->images[use].id;
    return status;
}

ppm_status ppmi_gltf_use_cube(ppmi_gltf_reader *reader, int32_t index, uint32_t layer,
                              const char *place, ppm_image_id faces[6])
{
    ppm_image_desc descs[6];
    void *owned[6] = {0};
    ppm_status statuses[6];
    const char *note = NULL;
    source s;
    memset(faces, 0, 6 * sizeof *faces);
    if (!ppmi_gltf_accept(reader, PPMI_GLTF_IMAGES, index, place)) return PPM_STATUS_OK;
    find(reader, (size_t)index, PPM_IMAGE_COLOR, &s);
    if (s.status == PPM_STATUS_OK) {
        s.status = ppmi_gltf_unwrap_cube(reader->context, &s.desc, layer, descs, owned, &note,
                                         s.ktx2_reason);
        note_ktx2(reader, &s, note);
    }
    if (s.status == PPM_STATUS_OK) {
        s.status = ppm_scene_add_images(reader->scene, descs, 6, faces, statuses);
    }
    for (int i = 0; i < 6; ++i) {
        if (s.status == PPM_STATUS_OK) s.status = statuses[i];
        ppmi_free(reader->context, owned[i]);
    }
    if (s.status != PPM_STATUS_OK) memset(faces, 0, 6 * sizeof *faces);
    ppmi_free(reader->context, s.owned);
    return conclude(reader, &s);
}

bool ppmi_gltf_image_is_unread(ppmi_gltf_reader *reader, int32_t index, char shown[64])
{
    char reason[PPMI_GLTF_PLACE];
    source s;
    if (!ppmi_gltf_is_usable(reader, PPMI_GLTF_IMAGES, index, reason, sizeof reason)) return false;
    find(reader, (size_t)index, PPM_IMAGE_COLOR, &s);
    const char *encoding =
        s.status == PPM_STATUS_OK ? ppmi_gltf_unread_ktx2(reader->context, &s.desc) : NULL;
    if (encoding) snprintf(shown, 64, "%s", encoding);
    ppmi_free(reader->context, s.owned);
    return encoding != NULL;
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

/* The sources of a texture: those of extensions, which their writer thought the better ones, before
 * the plain one, which is the fallback. KTX2 images come last: if there is another one, it shows
 * the same and can be read. */
static ppm_status use_sources(ppmi_gltf_reader *reader, const ppmi_gltf_texture *texture,
                              int32_t role, const char *place, ppm_image_id *out_id)
{
    const int32_t sources[] = {texture->webp_source, texture->avif_source, texture->dds_source,
                               texture->source,      texture->astc_source, texture->basisu_source};
    const size_t count = sizeof sources / sizeof sources[0];
    ppm_status status = PPM_STATUS_OK;
    bool is_any = false;
    *out_id = 0;
    for (size_t i = 0; i < count && *out_id == 0 && status == PPM_STATUS_OK; ++i) {
        if (sources[i] < 0) continue;
        is_any = true;
        status = ppmi_gltf_use_image(reader, sources[i], role, place, out_id);
        if (reader->is_looking_at_textures) break; /* the others only if the first fails */
    }
    if (!is_any) ppmi_gltf_warn(reader, place, "left out: the texture names no image");
    if (*out_id == 0 && !reader->is_looking_at_textures && status == PPM_STATUS_OK) {
        ppmi_gltf_note_feature(reader, "textures without an image that can be read",
                               PPM_FEATURE_IGNORED, place);
    }
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
    ppmi_gltf_place(inner, "textures[%d]", (int)info->texture);
    if (reader->is_looking_at_textures) reader->uv_sets_seen |= UINT32_C(1) << info->uv_set;
    const ppm_status status = use_sources(reader, texture, role, inner, &image);
    if (status != PPM_STATUS_OK || image == 0) return status;
    out_texture->image = image;
    out_texture->uv_set = (uint32_t)info->uv_set;
    apply_sampler(reader, texture->sampler, inner, out_texture);
    apply_transform(info, out_texture);
    return PPM_STATUS_OK;
}
