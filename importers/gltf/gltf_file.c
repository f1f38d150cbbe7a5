/* Files: the .gltf or .glb itself, its chunks (glTF 2.0 specification, section 4.4), and buffers.
 * A .glb is there once; its BIN chunk is used where it lies. Buffers are read when something uses
 * them first, so that an unused one may be missing. */
#include <stdio.h>
#include <string.h>

#include "gltf/gltf_decoded.h"
#include "gltf/gltf_reader.h"
#include "gltf/gltf_uri.h"

enum { HEADER_SIZE = 12, CHUNK_HEADER_SIZE = 8 };
#define CHUNK_JSON 0x4e4f534au
#define CHUNK_BIN 0x004e4942u

static uint32_t load_u32(const unsigned char *bytes)
{
    return (uint32_t)bytes[0] | (uint32_t)bytes[1] << 8 | (uint32_t)bytes[2] << 16 |
           (uint32_t)bytes[3] << 24;
}

/* The chunk at *at: its type and bytes. False when it does not fit in end. */
static bool next_chunk(const unsigned char *file, size_t end, size_t *at, uint32_t *type,
                       const unsigned char **bytes, size_t *length)
{
    if (end - *at < CHUNK_HEADER_SIZE) return false;
    *length = load_u32(file + *at);
    *type = load_u32(file + *at + 4);
    *bytes = file + *at + CHUNK_HEADER_SIZE;
    if (*length > end - *at - CHUNK_HEADER_SIZE) return false;
    *at += CHUNK_HEADER_SIZE + *length;
    return true;
}

static const char byte_order_mark[] = "\xef\xbb\xbf";

/* What some writers put around the JSON of a GLB, though it has to begin with '{' and be padded
 * with spaces, and what other viewers read. */
static void trim_json(ppmi_gltf_reader *reader)
{
    if (reader->json_length >= 3 && memcmp(reader->json, byte_order_mark, 3) == 0) {
        reader->json += 3;
        reader->json_length -= 3;
        ppmi_gltf_note_feature(reader, "byte order mark in chunk 0", PPM_FEATURE_IGNORED,
                               "the specification forbids it");
    }
    const size_t length = reader->json_length;
    while (reader->json_length > 0 && reader->json[reader->json_length - 1] == '\0')
        reader->json_length--;
    if (reader->json_length == length) return;
    ppmi_gltf_note_feature(reader, "NUL bytes behind the JSON of chunk 0", PPM_FEATURE_IGNORED,
                           "the specification asks for spaces");
}

static ppm_status split_glb(ppmi_gltf_reader *reader)
{
    const unsigned char *file = reader->file;
    if (reader->file_size < HEADER_SIZE) {
        return ppmi_gltf_invalid(reader, "header", "the file ends in it");
    }
    const uint32_t version = load_u32(file + 4);
    if (version != 2) {
        return ppmi_fail(reader->context, PPM_STATUS_INPUT_UNSUPPORTED,
                         "%s: header: binary glTF %u.0 is not supported, only 2.0", reader->path,
                         (unsigned)version);
    }
    const size_t length = load_u32(file + 8);
    if (length > reader->file_size || length < HEADER_SIZE) {
        return ppmi_gltf_invalid(reader, "header",
                                 "it promises %zu bytes and the file has %zu: truncated or broken",
                                 length, reader->file_size);
    }
    size_t at = HEADER_SIZE, bytes_length;
    const unsigned char *bytes;
    uint32_t type;
    if (!next_chunk(file, length, &at, &type, &bytes, &bytes_length) || type != CHUNK_JSON) {
        return ppmi_gltf_invalid(reader, "chunk 0", "not a complete JSON chunk");
    }
    reader->json = (const char *)bytes;
    reader->json_length = bytes_length;
    trim_json(reader);
    if (at == length) return PPM_STATUS_OK;
    if (!next_chunk(file, length, &at, &type, &bytes, &bytes_length)) {
        return ppmi_gltf_invalid(reader, "chunk 1", "it is longer than the file");
    }
    if (type == CHUNK_BIN) { /* clients must ignore chunks of other types */
        reader->chunk = bytes;
        reader->chunk_length = bytes_length;
    }
    return PPM_STATUS_OK;
}

ppm_status ppmi_gltf_read_file(ppmi_gltf_reader *reader)
{
    const char *reason;
    const ppm_status status =
        ppmi_gltf_map_open(reader->context, reader->path, 0, &reader->file_map, &reason);
    if (status != PPM_STATUS_OK) {
        return ppmi_fail(reader->context, status, "%s: %s", reader->path, reason);
    }
    reader->file = reader->file_map.bytes;
    reader->file_size = reader->file_map.count;
    if (reader->file_size >= 4 && memcmp(reader->file, "glTF", 4) == 0) return split_glb(reader);
    reader->json = (const char *)reader->file;
    reader->json_length = reader->file_size;
    if (reader->json_length >= 3 && memcmp(reader->json, byte_order_mark, 3) == 0) {
        reader->json += 3; /* not allowed by the specification, but harmless */
        reader->json_length -= 3;
    }
    return PPM_STATUS_OK;
}

/* ---- buffers --------------------------------------------------------------------------------- */

const char *ppmi_gltf_unescape_uri(ppmi_gltf_reader *reader, ppmi_gltf_span span,
                                   size_t *out_length, char **out_owned)
{
    const char *inside = reader->json + span.begin;
    *out_length = span.end - span.begin;
    *out_owned = NULL;
    if (*out_length == 0 || !memchr(inside, '\\', *out_length)) return inside;
    *out_owned = ppmi_alloc(reader->context, *out_length, 1);
    if (!*out_owned) return NULL;
    *out_length = ppmi_gltf_json_unescape(reader->json, span, *out_owned);
    return *out_owned;
}

static ppm_status read_copy(ppm_context *context, const char *path, unsigned char **out_bytes,
                            size_t *out_count, const char **reason)
{
    ppmi_gltf_map map;
    ppm_status status = ppmi_gltf_map_open(context, path, 0, &map, reason);
    if (status != PPM_STATUS_OK) return status;
    *out_bytes = ppmi_alloc(context, map.count, 1);
    if (*out_bytes) {
        memcpy(*out_bytes, map.bytes, map.count);
        *out_count = map.count;
    } else {
        *reason = "out of memory";
        status = PPM_STATUS_OUT_OF_MEMORY;
    }
    ppmi_gltf_map_close(context, &map);
    return status;
}

ppm_status ppmi_gltf_read_uri(ppmi_gltf_reader *reader, const char *uri, size_t length,
                              unsigned char **out_bytes, size_t *out_count, const char **reason)
{
    ppm_context *context = reader->context;
    char *path = NULL;
    *out_bytes = NULL;
    *out_count = 0;
    if (ppmi_gltf_uri_is_data(uri, length)) {
        return ppmi_gltf_uri_decode_data(context, uri, length, out_bytes, out_count, reason);
    }
    ppm_status status = ppmi_gltf_uri_path(
        context, reader->path, reader->options->allow_outside != 0, uri, length, &path, reason);
    if (status == PPM_STATUS_OK) status = read_copy(context, path, out_bytes, out_count, reason);
    ppmi_free(context, path);
    return status;
}

static ppm_status load_from_uri(ppmi_gltf_reader *reader, const char *uri, size_t length,
                                size_t wanted, const char *place, ppmi_gltf_bytes *out)
{
    ppm_context *context = reader->context;
    char shown[80], *path = NULL;
    const char *reason = "out of memory";
    ppm_status status;
    if (ppmi_gltf_uri_is_data(uri, length)) {
        status = ppmi_gltf_uri_decode_data(context, uri, length, &out->owned, &out->count, &reason);
        if (status == PPM_STATUS_OK && out->count < wanted) {
            status = PPM_STATUS_INPUT_INVALID;
            reason = "the data URI is shorter than byteLength";
        }
    } else {
        status = ppmi_gltf_uri_path(context, reader->path, reader->options->allow_outside != 0, uri,
                                    length, &path, &reason);
        if (status == PPM_STATUS_OK) {
            status = ppmi_gltf_map_open(context, path, wanted, &out->map, &reason);
            out->count = out->map.count;
        }
    }
    ppmi_free(context, path);
    if (status == PPM_STATUS_OK) {
        out->data = out->owned ? out->owned : out->map.bytes;
        return status;
    }
    ppmi_free(context, out->owned);
    out->owned = NULL;
    return ppmi_fail(context, status, "%s: %s.uri (\"%s\"): %s", reader->path, place,
                     ppmi_gltf_printable(uri, length, shown, sizeof shown), reason);
}

static ppm_status load_buffer(ppmi_gltf_reader *reader, int32_t index, ppmi_gltf_bytes *out)
{
    const ppmi_gltf_source *source = &reader->outline.buffers.items[index];
    char place[PPMI_GLTF_PLACE], *owned;
    size_t length;
    ppmi_gltf_place(place, "buffers[%d]", (int)index);
    if (source->has_uri) {
        const char *uri = ppmi_gltf_unescape_uri(reader, source->uri, &length, &owned);
        if (!uri) return ppmi_gltf_out_of_memory(reader, place);
        const ppm_status status =
            load_from_uri(reader, uri, length, source->byte_length, place, out);
        ppmi_free(reader->context, owned);
        return status;
    }
    if (index != 0 || !reader->chunk) return ppmi_gltf_invalid(reader, place, "it has no bytes");
    if (source->byte_length > reader->chunk_length) {
        return ppmi_gltf_invalid(reader, place, "byteLength is %zu, the BIN chunk has %zu bytes",
                                 (size_t)source->byte_length, reader->chunk_length);
    }
    out->data = reader->chunk;
    out->count = source->byte_length;
    return PPM_STATUS_OK;
}

void ppmi_gltf_forget_files(ppmi_gltf_reader *reader)
{
    ppmi_gltf_map_forget(&reader->file_map);
    for (size_t i = 0; reader->buffers && i < reader->outline.buffers.count; ++i) {
        ppmi_gltf_map_forget(&reader->buffers[i].map);
    }
}

void ppmi_gltf_close_files(ppmi_gltf_reader *reader)
{
    for (size_t i = 0; reader->buffers && i < reader->outline.buffers.count; ++i) {
        ppmi_free(reader->context, reader->buffers[i].owned);
        ppmi_gltf_map_close(reader->context, &reader->buffers[i].map);
    }
    ppmi_gltf_map_close(reader->context, &reader->file_map);
}

ppm_status ppmi_gltf_buffer_bytes(ppmi_gltf_reader *reader, int32_t buffer, size_t byte_offset,
                                  size_t byte_length, const char *place,
                                  const unsigned char **out_bytes)
{
    ppm_status status = ppmi_gltf_require(reader, PPMI_GLTF_BUFFERS, buffer, place);
    if (status != PPM_STATUS_OK) return status;
    const size_t length = reader->outline.buffers.items[buffer].byte_length;
    if (byte_offset > length || byte_length > length - byte_offset) {
        return ppmi_gltf_invalid(reader, place,
                                 "%zu bytes from %zu do not fit in %zu of buffers[%d]", byte_length,
                                 byte_offset, length, (int)buffer);
    }
    ppmi_gltf_bytes *loaded = &reader->buffers[buffer];
    if (!loaded->data) status = load_buffer(reader, buffer, loaded);
    if (status == PPM_STATUS_OK) *out_bytes = loaded->data + byte_offset;
    return status;
}

ppm_status ppmi_gltf_view_bytes(ppmi_gltf_reader *reader, int32_t view, const char *place,
                                const unsigned char **out_bytes, size_t *out_count)
{
    char inner[PPMI_GLTF_PLACE];
    ppm_status status = ppmi_gltf_require(reader, PPMI_GLTF_BUFFER_VIEWS, view, place);
    if (status != PPM_STATUS_OK) return status;
    const ppmi_gltf_buffer_view *item = &reader->document->buffer_views[view];
    if (item->meshopt.is_given) {
        status = ppmi_gltf_decoded_view(reader, view, out_bytes, out_count);
        if (status != PPM_STATUS_OK || *out_bytes) return status;
    }
    ppmi_gltf_place(inner, "bufferViews[%d]", (int)view);
    status = ppmi_gltf_buffer_bytes(reader, item->buffer, item->byte_offset, item->byte_length,
                                    inner, out_bytes);
    if (status == PPM_STATUS_OK) *out_count = item->byte_length;
    return status;
}
