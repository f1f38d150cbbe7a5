/* Decoded buffer views and accessors. Everything that reads an accessor goes through here, so that
 * meshes, skins and animations need not know how their bytes are stored. */
#include "gltf/gltf_decoded.h"

#include <stdarg.h>
#include <stdio.h>
#include <string.h>

#include "gltf/gltf_draco_shim.h"
#include "gltf/gltf_meshopt.h"

/* More triangles than this for each byte of a Draco stream are not believed (a plane that is a
 * regular grid comes to about a tenth of that), beyond what a small file may have anyway. */
enum { MAX_FACES_PER_BYTE = 64, MAX_SMALL_FACES = 65536 };

/* Where the elements of an accessor are, and those elements once decoded. */
typedef struct draco_source {
    const ppmi_gltf_primitive *primitive; /* NULL: in no stream */
    size_t stream;                        /* of the primitive */
    int32_t id;                           /* of the attribute, or DRACO_INDICES */
    unsigned char *bytes;
    size_t count; /* elements */
} draco_source;

enum { DRACO_INDICES = -1 };

/* A primitive's stream, perhaps decoded ahead of its use. */
typedef struct draco_stream {
    const ppmi_gltf_primitive *primitive;
    ppmi_gltf_draco *draco; /* NULL: not decoded, or broken */
    bool is_tried;
    bool is_told; /* that its counts are not the accessors' */
} draco_stream;

/* Streams that are decoded together, each by a thread. What they hold is in memory at once. */
enum { STREAMS_AT_ONCE = 16 };

struct ppmi_gltf_decoded {
    unsigned char **views; /* by buffer view; NULL: not decoded */
    bool *is_given_up;     /* by buffer view: the plain data are used */
    draco_source *sources; /* by accessor */
    draco_stream *streams;
    size_t stream_count;
};

/* ---- tables ---------------------------------------------------------------------------------- */

static bool has_no_view(const ppmi_gltf_document *document, int32_t accessor)
{
    return accessor >= 0 && (size_t)accessor < document->accessor_count &&
           document->accessors[accessor].buffer_view < 0;
}

static void add_source(const ppmi_gltf_document *document, ppmi_gltf_decoded *decoded,
                       int32_t accessor, const ppmi_gltf_primitive *primitive, int32_t id)
{
    if (!has_no_view(document, accessor) || decoded->sources[accessor].primitive) return;
    decoded->sources[accessor] =
        (draco_source){.primitive = primitive, .stream = decoded->stream_count, .id = id};
}

/* Attributes are found by their names, in the primitive and in the extension. */
static void add_primitive(const ppmi_gltf_document *document, ppmi_gltf_decoded *decoded,
                          const ppmi_gltf_primitive *primitive)
{
    if (!primitive->is_draco) return;
    add_source(document, decoded, primitive->indices, primitive, DRACO_INDICES);
    for (uint32_t i = 0; i < primitive->draco_attribute_count; ++i) {
        const ppmi_gltf_attribute *inside = &primitive->draco_attributes[i];
        for (uint32_t k = 0; k < primitive->attribute_count; ++k) {
            const ppmi_gltf_attribute *outside = &primitive->attributes[k];
            if (inside->accessor < 0 || strcmp(inside->name, outside->name) != 0) continue;
            add_source(document, decoded, outside->accessor, primitive, inside->accessor);
        }
    }
    decoded->streams[decoded->stream_count++] = (draco_stream){.primitive = primitive};
}

static size_t count_streams(const ppmi_gltf_document *document)
{
    size_t count = 0;
    for (size_t i = 0; i < document->mesh_count; ++i) {
        for (uint32_t k = 0; k < document->meshes[i].primitive_count; ++k) {
            count += document->meshes[i].primitives[k].is_draco;
        }
    }
    return count;
}

/* The tables, made when they are first asked for; NULL when memory is out. */
static ppmi_gltf_decoded *get_tables(ppmi_gltf_reader *reader)
{
    const ppmi_gltf_document *document = reader->document;
    if (reader->decoded) return reader->decoded;
    ppmi_gltf_decoded *decoded = ppmi_alloc_zeroed(reader->context, 1, sizeof *decoded);
    if (!decoded) return NULL;
    reader->decoded = decoded;
    /* one more each: an empty list is no case of its own */
    decoded->views =
        ppmi_alloc_zeroed(reader->context, document->buffer_view_count + 1, sizeof *decoded->views);
    decoded->is_given_up = ppmi_alloc_zeroed(reader->context, document->buffer_view_count + 1,
                                             sizeof *decoded->is_given_up);
    decoded->sources =
        ppmi_alloc_zeroed(reader->context, document->accessor_count + 1, sizeof *decoded->sources);
    decoded->streams =
        ppmi_alloc_zeroed(reader->context, count_streams(document) + 1, sizeof *decoded->streams);
    if (!decoded->views || !decoded->is_given_up || !decoded->sources || !decoded->streams) {
        ppmi_gltf_decoded_deinit(reader);
        return NULL;
    }
    for (size_t i = 0; i < document->mesh_count; ++i) {
        for (uint32_t k = 0; k < document->meshes[i].primitive_count; ++k) {
            add_primitive(document, decoded, &document->meshes[i].primitives[k]);
        }
    }
    return decoded;
}

void ppmi_gltf_decoded_deinit(ppmi_gltf_reader *reader)
{
    ppmi_gltf_decoded *decoded = reader->decoded;
    if (!decoded) return;
    for (size_t i = 0; decoded->views && i < reader->document->buffer_view_count; ++i) {
        ppmi_free(reader->context, decoded->views[i]);
    }
    for (size_t i = 0; decoded->sources && i < reader->document->accessor_count; ++i) {
        ppmi_free(reader->context, decoded->sources[i].bytes);
    }
    for (size_t i = 0; decoded->streams && i < decoded->stream_count; ++i) {
        ppmi_gltf_draco_destroy(decoded->streams[i].draco);
    }
    ppmi_free(reader->context, decoded->streams);
    ppmi_free(reader->context, decoded->views);
    ppmi_free(reader->context, decoded->is_given_up);
    ppmi_free(reader->context, decoded->sources);
    ppmi_free(reader->context, decoded);
    reader->decoded = NULL;
}

/* ---- buffer views ---------------------------------------------------------------------------- */

/* Whether the view's own buffer has bytes in the file. */
static bool has_plain_data(const ppmi_gltf_reader *reader, const ppmi_gltf_buffer_view *view)
{
    const ppmi_gltf_sources *buffers = &reader->outline.buffers;
    if (view->buffer < 0 || (size_t)view->buffer >= buffers->count) return false;
    if (view->buffer == view->meshopt.buffer) return false;
    return buffers->items[view->buffer].has_uri || (view->buffer == 0 && reader->chunk);
}

/* Sets *out_fault where the stream cannot be what it claims; it is then NULL. */
static ppm_status decode_view(ppmi_gltf_reader *reader, const ppmi_gltf_buffer_view *view,
                              const char *place, unsigned char **out, const char **out_fault)
{
    const ppmi_gltf_meshopt *meshopt = &view->meshopt;
    const unsigned char *stream;
    ppm_status status = ppmi_gltf_buffer_bytes(reader, meshopt->buffer, meshopt->byte_offset,
                                               meshopt->byte_length, place, &stream);
    if (status != PPM_STATUS_OK) return status;
    *out_fault =
        meshopt->byte_length > 0 ? ppmi_gltf_meshopt_fault(meshopt, stream) : "it is empty";
    if (!*out_fault && meshopt->count * meshopt->byte_stride != view->byte_length) {
        *out_fault = "count * byteStride is not the buffer view's byteLength";
    }
    if (*out_fault) return PPM_STATUS_OK;
    *out = ppmi_alloc(reader->context, view->byte_length, 1);
    if (!*out) return ppmi_gltf_out_of_memory(reader, place);
    if (ppmi_gltf_meshopt_decode(meshopt, stream, *out)) return PPM_STATUS_OK;
    ppmi_free(reader->context, *out);
    *out = NULL;
    *out_fault = "the compressed stream is broken";
    return PPM_STATUS_OK;
}

ppm_status ppmi_gltf_decoded_view(ppmi_gltf_reader *reader, int32_t view,
                                  const unsigned char **out_bytes, size_t *out_count)
{
    const ppmi_gltf_buffer_view *item = &reader->document->buffer_views[view];
    const char *fault = NULL;
    char place[PPMI_GLTF_PLACE];
    ppmi_gltf_place(place, "bufferViews[%d].extensions.%s", (int)view, item->meshopt.name);
    ppmi_gltf_decoded *decoded = get_tables(reader);
    *out_bytes = NULL;
    if (!decoded) return ppmi_gltf_out_of_memory(reader, place);
    if (!decoded->views[view] && !decoded->is_given_up[view]) {
        const ppm_status status = decode_view(reader, item, place, &decoded->views[view], &fault);
        if (status != PPM_STATUS_OK) return status;
        if (fault && !has_plain_data(reader, item)) {
            return ppmi_gltf_invalid(reader, place, "%s", fault);
        }
        if (fault) ppmi_gltf_warn(reader, place, "%s: the plain data are used", fault);
        decoded->is_given_up[view] = fault != NULL;
    }
    *out_bytes = decoded->views[view];
    *out_count = item->byte_length;
    return PPM_STATUS_OK;
}

/* ---- Draco ----------------------------------------------------------------------------------- */

static size_t type_size(int32_t type)
{
    return type == PPMI_GLTF_BYTE || type == PPMI_GLTF_UNSIGNED_BYTE     ? 1
           : type == PPMI_GLTF_SHORT || type == PPMI_GLTF_UNSIGNED_SHORT ? 2
                                                                         : 4;
}

/* Writes a number as a component; false when the type does not hold it. */
static bool put_component(double value, int32_t type, unsigned char *out)
{
    static const double low[] = {-128.0, 0.0, -32768.0, 0.0, 0.0, 0.0};
    static const double high[] = {127.0, 255.0, 32767.0, 65535.0, 0.0, 4294967295.0};
    if (type == PPMI_GLTF_FLOAT) {
        const float single = (float)value;
        memcpy(out, &single, sizeof single);
        return true;
    }
    const int k = type - PPMI_GLTF_BYTE;
    if (k < 0 || k > 5 || !(value >= low[k] && value <= high[k])) return false;
    const int64_t whole = (int64_t)value;
    memcpy(out, &whole, type_size(type)); /* little-endian, as glTF is */
    return true;
}

/* One accessor that is taken out of a stream. */
typedef struct extraction {
    ppmi_gltf_reader *reader;
    const ppmi_gltf_draco *draco;
    const ppmi_gltf_accessor *accessor;
    bool is_asked_for; /* and not only beside the one that is */
    char place[PPMI_GLTF_PLACE];
} extraction;

/* INPUT_INVALID; what nobody has asked for may be wrong without a message, since it may never be
 * used. */
static PPMI_PRINTF(2, 3) ppm_status decline(const extraction *e, const char *format, ...)
{
    char reason[160];
    va_list arguments;
    if (!e->is_asked_for) return PPM_STATUS_INPUT_INVALID;
    va_start(arguments, format);
    vsnprintf(reason, sizeof reason, format, arguments);
    va_end(arguments);
    return ppmi_gltf_invalid(e->reader, e->place, "%s", reason);
}

static ppm_status store_values(const extraction *e, const double *values, size_t count,
                               draco_source *source)
{
    const int32_t type = e->accessor->component_type;
    const size_t size = type_size(type), total = count * e->accessor->component_count;
    source->bytes = ppmi_alloc(e->reader->context, total, size);
    source->count = count;
    if (!source->bytes) return ppmi_gltf_out_of_memory(e->reader, e->place);
    for (size_t i = 0; i < total; ++i) {
        if (put_component(values[i], type, source->bytes + i * size)) continue;
        ppmi_free(e->reader->context, source->bytes);
        source->bytes = NULL;
        return decline(e, "%g in the Draco stream does not fit componentType %d", values[i],
                       (int)type);
    }
    return PPM_STATUS_OK;
}

static ppm_status read_draco_indices(const extraction *e, size_t count, double *values)
{
    uint32_t *indices = ppmi_alloc(e->reader->context, count, sizeof *indices);
    if (!indices) return ppmi_gltf_out_of_memory(e->reader, e->place);
    ppmi_gltf_draco_indices(e->draco, indices);
    for (size_t i = 0; i < count; ++i) {
        values[i] = indices[i];
    }
    ppmi_free(e->reader->context, indices);
    return PPM_STATUS_OK;
}

static ppm_status extract(const extraction *e, draco_source *source)
{
    const uint32_t components = e->accessor->component_count;
    if (e->accessor->column_count != 1 || components > 4) {
        return decline(e, "matrices cannot be in a Draco stream");
    }
    const bool is_index = source->id == DRACO_INDICES;
    if (is_index && components != 1) return decline(e, "indices must be unsigned scalars");
    const size_t count = is_index ? 3 * (size_t)ppmi_gltf_draco_face_count(e->draco)
                                  : ppmi_gltf_draco_point_count(e->draco);
    if (count == 0) return decline(e, "the Draco stream is empty");
    double *values = ppmi_alloc(e->reader->context, count * components, sizeof *values);
    if (!values) return ppmi_gltf_out_of_memory(e->reader, e->place);
    ppm_status status = PPM_STATUS_OK;
    if (is_index) {
        status = read_draco_indices(e, count, values);
    } else if (!ppmi_gltf_draco_values(e->draco, source->id, components, values)) {
        status = decline(e, "attribute %d of the Draco stream does not suit it", (int)source->id);
    }
    if (status == PPM_STATUS_OK) status = store_values(e, values, count, source);
    ppmi_free(e->reader->context, values);
    return status;
}

/* The most triangles that a stream may hold. The accessors have no say: early encoders wrote the
 * counts of the mesh that they had compressed. */
static uint32_t most_faces(size_t stream_length)
{
    const size_t most = MAX_SMALL_FACES + MAX_FACES_PER_BYTE * stream_length;
    return most < UINT32_MAX / 3 ? (uint32_t)most : UINT32_MAX / 3;
}

static bool can_be_draco(const ppmi_gltf_primitive *primitive)
{
    return primitive->mode == PPMI_GLTF_TRIANGLES || primitive->mode == PPMI_GLTF_TRIANGLE_STRIP;
}

static ppm_status decode_stream(ppmi_gltf_reader *reader, const ppmi_gltf_primitive *primitive,
                                const char *place, ppmi_gltf_draco **out)
{
    const unsigned char *stream;
    size_t length;
    const char *reason;
    ppm_status status =
        ppmi_gltf_view_bytes(reader, primitive->draco_view, place, &stream, &length);
    if (status != PPM_STATUS_OK) return status;
    if (!can_be_draco(primitive)) {
        return ppmi_gltf_invalid(reader, place,
                                 "mode %d: Draco streams hold triangles or strips of them",
                                 (int)primitive->mode);
    }
    status = ppmi_gltf_draco_create(stream, length, most_faces(length), &reason, out);
    if (status == PPM_STATUS_OUT_OF_MEMORY) return ppmi_gltf_out_of_memory(reader, place);
    if (status == PPM_STATUS_OK) return status;
    return ppmi_fail(reader->context, status, "%s: %s: %s", reader->path, place, reason);
}

/* Whether the bytes of a stream are there without reading, decoding or a message. */
static bool find_stream(const ppmi_gltf_reader *reader, const ppmi_gltf_primitive *primitive,
                        const unsigned char **out_bytes, size_t *out_length)
{
    char reason[PPMI_GLTF_PLACE];
    if (!ppmi_gltf_is_usable(reader, PPMI_GLTF_BUFFER_VIEWS, primitive->draco_view, reason,
                             sizeof reason)) {
        return false;
    }
    const ppmi_gltf_buffer_view *view = &reader->document->buffer_views[primitive->draco_view];
    if (view->meshopt.is_given || view->buffer < 0 ||
        (size_t)view->buffer >= reader->outline.buffers.count) {
        return false;
    }
    const ppmi_gltf_bytes *buffer = &reader->buffers[view->buffer];
    const size_t length = reader->outline.buffers.items[view->buffer].byte_length;
    if (!buffer->data || view->byte_offset > length ||
        view->byte_length > length - view->byte_offset) {
        return false;
    }
    *out_bytes = buffer->data + view->byte_offset;
    *out_length = view->byte_length;
    return true;
}

static void try_stream(const ppmi_gltf_reader *reader, draco_stream *stream)
{
    const unsigned char *bytes;
    size_t length;
    const char *reason;
    const ppmi_gltf_primitive *primitive = stream->primitive;
    if (stream->is_tried) return;
    stream->is_tried = true;
    if (!can_be_draco(primitive) || !find_stream(reader, primitive, &bytes, &length)) return;
    const ppm_status status =
        ppmi_gltf_draco_create(bytes, length, most_faces(length), &reason, &stream->draco);
    if (status != PPM_STATUS_OK) stream->draco = NULL;
}

/* Decodes a stream and those after it in the file, which are likely to be asked for next. Without
 * messages: a broken one is decoded again where it is used, and told there. */
static void decode_ahead(const ppmi_gltf_reader *reader, size_t first)
{
    const ppmi_gltf_decoded *decoded = reader->decoded;
    const size_t left = decoded->stream_count - first;
    const int64_t count = (int64_t)(left < STREAMS_AT_ONCE ? left : STREAMS_AT_ONCE);
    if (decoded->streams[first].is_tried) return;
#pragma omp parallel for schedule(dynamic, 1)
    for (int64_t i = 0; i < count; ++i) {
        try_stream(reader, &decoded->streams[first + (size_t)i]);
    }
}

/* The decoded stream, which is the caller's. */
static ppm_status take_stream(ppmi_gltf_reader *reader, size_t index, const char *place,
                              ppmi_gltf_draco **out)
{
    draco_stream *stream = &reader->decoded->streams[index];
    const unsigned char *bytes;
    size_t length;
    /* loads the buffer, which the others are in as a rule */
    const ppm_status status =
        ppmi_gltf_view_bytes(reader, stream->primitive->draco_view, place, &bytes, &length);
    if (status != PPM_STATUS_OK) return status;
    decode_ahead(reader, index);
    if (!stream->draco) return decode_stream(reader, stream->primitive, place, out);
    *out = stream->draco;
    stream->draco = NULL;
    return PPM_STATUS_OK;
}

/* The accessor of an attribute, or behind these of the indices; -1 where it is not in the stream.
 */
static int32_t accessor_in_stream(const ppmi_gltf_reader *reader,
                                  const ppmi_gltf_primitive *primitive, uint32_t i)
{
    const int32_t accessor =
        i < primitive->attribute_count ? primitive->attributes[i].accessor : primitive->indices;
    if (!has_no_view(reader->document, accessor)) return -1;
    return reader->decoded->sources[accessor].primitive == primitive ? accessor : -1;
}

/* Says once for a stream that it holds another number of elements than an accessor tells. */
static void tell_counts(ppmi_gltf_reader *reader, draco_stream *stream,
                        const ppmi_gltf_draco *draco, const char *place)
{
    const ppmi_gltf_primitive *primitive = stream->primitive;
    for (uint32_t i = 0; i <= primitive->attribute_count && !stream->is_told; ++i) {
        const int32_t index = accessor_in_stream(reader, primitive, i);
        const bool is_index = i == primitive->attribute_count;
        /* the indices of a strip, of which the stream has a list, are of another number */
        if (index < 0 || (is_index && primitive->mode != PPMI_GLTF_TRIANGLES)) continue;
        const size_t told = reader->document->accessors[index].count;
        const size_t count = is_index ? 3 * (size_t)ppmi_gltf_draco_face_count(draco)
                                      : ppmi_gltf_draco_point_count(draco);
        if (count == told) continue;
        stream->is_told = true;
        ppmi_gltf_warn(reader, place, "%zu %s in the Draco stream are used, accessors[%d] has %zu",
                       count, is_index ? "indices" : "vertices", (int)index, told);
        ppmi_gltf_note_feature(reader, "counts of accessors with Draco streams",
                               PPM_FEATURE_IGNORED, "the streams hold other numbers of elements");
    }
}

/* All accessors of the stream at once: decoding it is what takes time. */
static ppm_status extract_all(ppmi_gltf_reader *reader, draco_stream *stream,
                              const ppmi_gltf_draco *draco, int32_t asked_for, const char *place)
{
    const ppmi_gltf_primitive *primitive = stream->primitive;
    ppm_status status = PPM_STATUS_OK;
    tell_counts(reader, stream, draco, place);
    for (uint32_t i = 0; i <= primitive->attribute_count && status == PPM_STATUS_OK; ++i) {
        const int32_t index = accessor_in_stream(reader, primitive, i);
        if (index < 0 || reader->decoded->sources[index].bytes) continue;
        extraction e = {.reader = reader,
                        .draco = draco,
                        .accessor = &reader->document->accessors[index],
                        .is_asked_for = index == asked_for};
        ppmi_gltf_place(e.place, "%s (accessors[%d])", place, (int)index);
        status = extract(&e, &reader->decoded->sources[index]);
        if (status == PPM_STATUS_INPUT_INVALID && !e.is_asked_for) status = PPM_STATUS_OK;
    }
    return status;
}

ppm_status ppmi_gltf_decoded_accessor(ppmi_gltf_reader *reader, int32_t accessor, const char *place,
                                      const unsigned char **out_bytes, size_t *out_count)
{
    char inner[PPMI_GLTF_PLACE];
    ppmi_gltf_place(inner, "%s: KHR_draco_mesh_compression", place);
    *out_bytes = NULL;
    if (!get_tables(reader)) return ppmi_gltf_out_of_memory(reader, inner);
    draco_source *source = &reader->decoded->sources[accessor];
    if (!source->primitive) return PPM_STATUS_OK;
    ppm_status status = PPM_STATUS_OK;
    if (!source->bytes) {
        ppmi_gltf_draco *draco = NULL;
        status = take_stream(reader, source->stream, inner, &draco);
        if (status == PPM_STATUS_OK) {
            status = extract_all(reader, &reader->decoded->streams[source->stream], draco, accessor,
                                 inner);
        }
        ppmi_gltf_draco_destroy(draco);
    }
    if (status != PPM_STATUS_OK) return status;
    *out_bytes = source->bytes;
    *out_count = source->count;
    return status;
}

static void release(ppmi_gltf_reader *reader, const ppmi_gltf_primitive *primitive,
                    int32_t accessor)
{
    if (!has_no_view(reader->document, accessor)) return;
    draco_source *source = &reader->decoded->sources[accessor];
    if (source->primitive != primitive) return;
    ppmi_free(reader->context, source->bytes);
    source->bytes = NULL;
}

void ppmi_gltf_decoded_release(ppmi_gltf_reader *reader, const ppmi_gltf_primitive *primitive)
{
    if (!reader->decoded || !primitive->is_draco) return;
    release(reader, primitive, primitive->indices);
    for (uint32_t i = 0; i < primitive->attribute_count; ++i) {
        release(reader, primitive, primitive->attributes[i].accessor);
    }
}
