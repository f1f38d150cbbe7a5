/* Accessors: typed arrays over buffer views (glTF 2.0 specification, section 3.6.2). Every byte
 * that is read has been checked to lie in its buffer view. */
#include <math.h>
#include <stdio.h>
#include <string.h>

#include "gltf/gltf_decoded.h"
#include "gltf/gltf_extensions.h"
#include "gltf/gltf_reader.h"

/* An accessor without a buffer view is all zeros and costs no bytes in the file; so a small file
 * could ask for any amount of memory. This is far above what sparse morph targets need. */
#define MAX_ZERO_ELEMENTS ((size_t)1 << 24)

enum { LARGE_ACCESSOR = 1 << 20 }; /* elements */

/* Elements at a fixed distance, in bytes that are known to be there. */
typedef struct elements {
    const unsigned char *bytes; /* NULL: zeros */
    size_t stride, count;
} elements;

static size_t component_size(int32_t type)
{
    switch (type) {
    case PPMI_GLTF_BYTE:
    case PPMI_GLTF_UNSIGNED_BYTE:
        return 1;
    case PPMI_GLTF_SHORT:
    case PPMI_GLTF_UNSIGNED_SHORT:
    case PPMI_GLTF_HALF:
        return 2;
    case PPMI_GLTF_DOUBLE:
        return 8;
    case PPMI_GLTF_UNSIGNED_INT:
    case PPMI_GLTF_FLOAT:
        return 4;
    default:
        return 0;
    }
}

/* Bytes from one column of a matrix to the next: columns begin at multiples of four bytes (section
 * 3.6.2.4). Everything else is one column. */
static size_t column_size(const ppmi_gltf_accessor *accessor)
{
    if (accessor->column_count == 0) return 0;
    const size_t rows = accessor->component_count / accessor->column_count;
    const size_t size = rows * component_size(accessor->component_type);
    return accessor->column_count > 1 ? (size + 3) / 4 * 4 : size;
}

static size_t element_size(const ppmi_gltf_accessor *accessor)
{
    return accessor->column_count * column_size(accessor);
}

/* count elements of size bytes from offset on in a buffer view. stride 0: packed. */
static ppm_status find_elements(ppmi_gltf_reader *reader, int32_t view, size_t offset, size_t count,
                                size_t size, size_t stride, const char *place, elements *out)
{
    const unsigned char *bytes;
    size_t available;
    const ppm_status status = ppmi_gltf_view_bytes(reader, view, place, &bytes, &available);
    if (status != PPM_STATUS_OK) return status;
    if (stride == 0) stride = size;
    if (stride < size) {
        return ppmi_gltf_invalid(
            reader, place, "byteStride %zu is less than the element's %zu bytes", stride, size);
    }
    /* offset + (count - 1) * stride + size <= available, without overflow */
    const bool fits = offset <= available && size <= available - offset &&
                      (count - 1) <= (available - offset - size) / stride;
    if (!fits) {
        return ppmi_gltf_invalid(
            reader, place,
            "%zu elements of %zu bytes from %zu do not fit in bufferViews[%d] (%zu bytes)", count,
            size, offset, (int)view, available);
    }
    *out = (elements){bytes + offset, stride, count};
    return PPM_STATUS_OK;
}

static ppm_status find_base(ppmi_gltf_reader *reader, const ppmi_gltf_accessor *accessor,
                            const char *place, elements *out)
{
    const size_t size = element_size(accessor);
    if (accessor->buffer_view < 0) {
        const int32_t index = (int32_t)(accessor - reader->document->accessors);
        const ppm_status status =
            ppmi_gltf_decoded_accessor(reader, index, place, &out->bytes, &out->count);
        out->stride = size;
        if (status != PPM_STATUS_OK || out->bytes) return status;
    }
    if (accessor->buffer_view < 0) {
        const size_t vectors = accessor->column_count > 1 ? 4 : 1; /* of four values at most */
        if (accessor->count > (MAX_ZERO_ELEMENTS - reader->zero_elements) / vectors) {
            return ppmi_gltf_invalid(
                reader, place, "%zu elements without a buffer view are too many", accessor->count);
        }
        reader->zero_elements += accessor->count * vectors;
        *out = (elements){NULL, 0, accessor->count};
        return PPM_STATUS_OK;
    }
    size_t stride = 0;
    if ((size_t)accessor->buffer_view < reader->document->buffer_view_count) {
        stride = reader->document->buffer_views[accessor->buffer_view].byte_stride;
    }
    return find_elements(reader, accessor->buffer_view, accessor->byte_offset, accessor->count,
                         size, stride, place, out);
}

static uint32_t load_unsigned(const unsigned char *p, int32_t type)
{
    uint16_t u16;
    uint32_t u32;
    switch (type) {
    case PPMI_GLTF_UNSIGNED_BYTE:
        return p[0];
    case PPMI_GLTF_UNSIGNED_SHORT:
        memcpy(&u16, p, sizeof u16);
        return u16;
    default:
        memcpy(&u32, p, sizeof u32);
        return u32;
    }
}

/* IEEE 754 binary16: a sign, five bits of exponent, ten of mantissa. */
static double half_value(uint16_t bits)
{
    const int exponent = bits >> 10 & 31, mantissa = bits & 1023;
    double size = exponent == 0 ? ldexp(mantissa, -24) : ldexp(1024 + mantissa, exponent - 25);
    if (exponent == 31) size = mantissa == 0 ? HUGE_VAL : NAN;
    return bits & 0x8000 ? -size : size;
}

/* Section 3.11: the inverse of how normalised integers are made. */
static float load_float(const unsigned char *p, int32_t type, bool normalized)
{
    int8_t i8;
    int16_t i16;
    uint16_t u16;
    float value;
    switch (type) {
    case PPMI_GLTF_BYTE:
        memcpy(&i8, p, sizeof i8);
        return normalized ? fmaxf((float)i8 / 127.0f, -1.0f) : (float)i8;
    case PPMI_GLTF_UNSIGNED_BYTE:
        return normalized ? (float)p[0] / 255.0f : (float)p[0];
    case PPMI_GLTF_SHORT:
        memcpy(&i16, p, sizeof i16);
        return normalized ? fmaxf((float)i16 / 32767.0f, -1.0f) : (float)i16;
    case PPMI_GLTF_UNSIGNED_SHORT:
        memcpy(&u16, p, sizeof u16);
        return normalized ? (float)u16 / 65535.0f : (float)u16;
    default:
        memcpy(&value, p, sizeof value);
        return value;
    }
}

/* ---- conversion ------------------------------------------------------------------------------ */

static double load_double(const unsigned char *p, int32_t type, bool normalized)
{
    uint16_t u16;
    double value;
    switch (type) {
    case PPMI_GLTF_HALF:
        memcpy(&u16, p, sizeof u16);
        return half_value(u16);
    case PPMI_GLTF_DOUBLE:
        memcpy(&value, p, sizeof value);
        return value;
    default:
        return (double)load_float(p, type, normalized);
    }
}

/* How elements become values: floats, doubles or indices. */
typedef struct conversion {
    int32_t type;
    uint32_t components, out_components;
    uint32_t rows; /* of a column; components for all but matrices */
    size_t column; /* bytes from one column to the next */
    bool normalized;
    const double *base; /* subtracted from each vector, or NULL */
    float *floats;      /* one of the three is set */
    double *doubles;
    uint32_t *indices;
} conversion;

static void convert(const conversion *c, const unsigned char *element, size_t index)
{
    if (c->indices) {
        c->indices[index] = load_unsigned(element, c->type);
        return;
    }
    const size_t size = component_size(c->type), first = index * c->out_components;
    for (uint32_t k = 0; k < c->out_components; ++k) {
        const unsigned char *at = element + k / c->rows * c->column + k % c->rows * size;
        double value = k < c->components ? load_double(at, c->type, c->normalized) : 1.0;
        if (c->base) value -= c->base[k];
        if (c->doubles) {
            c->doubles[first + k] = value;
        } else {
            c->floats[first + k] = (float)value;
        }
    }
}

/* Whether the elements are, byte for byte, what comes out. */
static bool is_plain(const conversion *c, const elements *from)
{
    const bool is_same = c->indices
                             ? c->type == PPMI_GLTF_UNSIGNED_INT
                             : c->floats && !c->base && c->type == PPMI_GLTF_FLOAT &&
                                   c->rows == c->components && c->components == c->out_components;
    return is_same && from->bytes && from->stride == 4 * (size_t)c->out_components;
}

static void convert_all(const conversion *c, const elements *from)
{
    static const unsigned char zeros[16 * sizeof(double)];
    if (is_plain(c, from)) {
        void *to = c->indices ? (void *)c->indices : (void *)c->floats;
        memcpy(to, from->bytes, from->count * from->stride);
        return;
    }
    for (size_t i = 0; i < from->count; ++i) {
        convert(c, from->bytes ? from->bytes + i * from->stride : zeros, i);
    }
}

/* Replaces the elements that a sparse accessor lists (section 3.6.2.3). */
static ppm_status convert_sparse(ppmi_gltf_reader *reader, const ppmi_gltf_accessor *accessor,
                                 const conversion *c, size_t count, const char *place)
{
    elements indices, values;
    const int32_t type = accessor->sparse_indices_type;
    const bool is_unsigned = type == PPMI_GLTF_UNSIGNED_BYTE || type == PPMI_GLTF_UNSIGNED_SHORT ||
                             type == PPMI_GLTF_UNSIGNED_INT;
    if (!is_unsigned) {
        return ppmi_gltf_invalid(reader, place, "sparse.indices.componentType: not unsigned");
    }
    ppm_status status =
        find_elements(reader, accessor->sparse_indices_view, accessor->sparse_indices_offset,
                      accessor->sparse_count, component_size(type), 0, place, &indices);
    if (status != PPM_STATUS_OK) return status;
    status = find_elements(reader, accessor->sparse_values_view, accessor->sparse_values_offset,
                           accessor->sparse_count, element_size(accessor), 0, place, &values);
    if (status != PPM_STATUS_OK) return status;
    for (size_t i = 0; i < accessor->sparse_count; ++i) {
        const uint32_t index = load_unsigned(indices.bytes + i * indices.stride, type);
        if (index >= count) { /* of the Draco stream, where there is one */
            return ppmi_gltf_invalid(reader, place, "sparse index %u is not below %zu",
                                     (unsigned)index, count);
        }
        convert(c, values.bytes + i * values.stride, index);
    }
    return PPM_STATUS_OK;
}

/* place becomes "place (accessors[i])", so that both ends of the reference are named. */
static ppm_status name_accessor(ppmi_gltf_reader *reader, int32_t index, const char *place,
                                char *inner, const ppmi_gltf_accessor **out)
{
    const ppm_status status = ppmi_gltf_require(reader, PPMI_GLTF_ACCESSORS, index, place);
    if (status != PPM_STATUS_OK) return status;
    ppmi_gltf_place(inner, "%s (accessors[%d])", place, (int)index);
    *out = &reader->document->accessors[index];
    return PPM_STATUS_OK;
}

static ppm_status convert_accessor(ppmi_gltf_reader *reader, const ppmi_gltf_accessor *accessor,
                                   const elements *base, const conversion *c, const char *place)
{
    convert_all(c, base);
    if (accessor->sparse_count > 0) {
        return convert_sparse(reader, accessor, c, base->count, place);
    }
    /* the pages of the file that were read for it are not needed any more */
    if (base->count > LARGE_ACCESSOR) ppmi_gltf_forget_files(reader);
    return PPM_STATUS_OK;
}

bool ppmi_gltf_type_is_wrong(const ppmi_gltf_accessor *accessor, const ppmi_gltf_format *format,
                             char fault[PPMI_GLTF_FAULT])
{
    const uint32_t components = accessor->component_count;
    const int32_t type = accessor->component_type;
    /* MAT2 is nowhere asked for, and is no VEC4 */
    const bool is_shape_right = accessor->column_count == 1 || format->min_components > 4;
    if (!is_shape_right || components < format->min_components ||
        components > format->max_components) {
        snprintf(fault, PPMI_GLTF_FAULT, "type: %u components do not suit this attribute",
                 (unsigned)components);
        return true;
    }
    if (component_size(type) > 0 && type != PPMI_GLTF_UNSIGNED_INT) return false;
    snprintf(fault, PPMI_GLTF_FAULT, "componentType %d does not suit this attribute", (int)type);
    return true;
}

/* Extensions that a file uses, be they named in its list or not. */
static void note_type(ppmi_gltf_reader *reader, int32_t type)
{
    if (type == PPMI_GLTF_HALF) ppmi_gltf_note_extension(reader, "KHR_accessor_float16");
    if (type == PPMI_GLTF_DOUBLE) ppmi_gltf_note_extension(reader, "KHR_accessor_float64");
}

/* Reads an accessor as numbers of value_size bytes, floats or doubles. */
static ppm_status read_numbers(ppmi_gltf_reader *reader, int32_t index, const char *place,
                               const ppmi_gltf_format *format, const double *base,
                               size_t value_size, void **out_values, size_t *out_count)
{
    char inner[PPMI_GLTF_PLACE], fault[PPMI_GLTF_FAULT];
    const ppmi_gltf_accessor *accessor;
    elements found;
    *out_values = NULL;
    ppm_status status = name_accessor(reader, index, place, inner, &accessor);
    if (status != PPM_STATUS_OK) return status;
    if (ppmi_gltf_type_is_wrong(accessor, format, fault)) {
        return ppmi_gltf_invalid(reader, inner, "%s", fault);
    }
    status = find_base(reader, accessor, inner, &found);
    if (status != PPM_STATUS_OK) return status;
    note_type(reader, accessor->component_type);
    void *const values =
        ppmi_alloc(reader->context, found.count, format->out_components * value_size);
    if (!values) return ppmi_gltf_out_of_memory(reader, inner);
    const conversion c = {.type = accessor->component_type,
                          .components = accessor->component_count,
                          .out_components = format->out_components,
                          .rows = accessor->component_count / accessor->column_count,
                          .column = column_size(accessor),
                          .normalized = accessor->normalized || format->integers_are_normalized,
                          .base = base,
                          .floats = value_size == sizeof(float) ? values : NULL,
                          .doubles = value_size == sizeof(double) ? values : NULL};
    status = convert_accessor(reader, accessor, &found, &c, inner);
    if (status != PPM_STATUS_OK) {
        ppmi_free(reader->context, values);
        return status;
    }
    *out_values = values;
    *out_count = found.count;
    return PPM_STATUS_OK;
}

ppm_status ppmi_gltf_read_floats(ppmi_gltf_reader *reader, int32_t index, const char *place,
                                 const ppmi_gltf_format *format, float **out_values,
                                 size_t *out_count)
{
    void *values;
    const ppm_status status =
        read_numbers(reader, index, place, format, NULL, sizeof(float), &values, out_count);
    *out_values = values;
    return status;
}

ppm_status ppmi_gltf_read_doubles(ppmi_gltf_reader *reader, int32_t index, const char *place,
                                  const ppmi_gltf_format *format, double **out_values,
                                  size_t *out_count)
{
    void *values;
    const ppm_status status =
        read_numbers(reader, index, place, format, NULL, sizeof(double), &values, out_count);
    *out_values = values;
    return status;
}

ppm_status ppmi_gltf_read_positions(ppmi_gltf_reader *reader, int32_t index, const char *place,
                                    const double base[3], float **out_values, size_t *out_count)
{
    static const ppmi_gltf_format vec3 = {3, 3, 3, false};
    const bool has_base = base[0] != 0.0 || base[1] != 0.0 || base[2] != 0.0;
    void *values;
    const ppm_status status = read_numbers(reader, index, place, &vec3, has_base ? base : NULL,
                                           sizeof(float), &values, out_count);
    *out_values = values;
    return status;
}

ppm_status ppmi_gltf_mesh_base(ppmi_gltf_reader *reader, int32_t mesh, double base[3])
{
    char reason[PPMI_GLTF_PLACE], place[PPMI_GLTF_PLACE];
    memset(base, 0, 3 * sizeof *base);
    if (!ppmi_gltf_is_usable(reader, PPMI_GLTF_MESHES, mesh, reason, sizeof reason)) {
        return PPM_STATUS_OK; /* told where it is read */
    }
    const ppmi_gltf_mesh *from = &reader->document->meshes[mesh];
    for (uint32_t i = 0; i < from->primitive_count; ++i) {
        const int32_t position = ppmi_gltf_find_attribute(
            from->primitives[i].attributes, from->primitives[i].attribute_count, "POSITION");
        elements found;
        double first[3];
        if (!ppmi_gltf_is_usable(reader, PPMI_GLTF_ACCESSORS, position, reason, sizeof reason)) {
            continue;
        }
        const ppmi_gltf_accessor *accessor = &reader->document->accessors[position];
        if (accessor->component_type != PPMI_GLTF_DOUBLE || accessor->component_count != 3)
            continue;
        ppmi_gltf_place(place, "meshes[%d].primitives[%u].attributes.POSITION (accessors[%d])",
                        (int)mesh, (unsigned)i, (int)position);
        const ppm_status status = find_base(reader, accessor, place, &found);
        if (status != PPM_STATUS_OK || !found.bytes) return status;
        memcpy(first, found.bytes, sizeof first);
        for (int k = 0; k < 3; ++k)
            base[k] = fabs(first[k]) < 1e15 ? nearbyint(first[k]) : 0.0;
        return PPM_STATUS_OK;
    }
    return PPM_STATUS_OK;
}

ppm_status ppmi_gltf_read_indices(ppmi_gltf_reader *reader, int32_t index, const char *place,
                                  uint32_t **out_values, size_t *out_count)
{
    char inner[PPMI_GLTF_PLACE];
    const ppmi_gltf_accessor *accessor;
    elements base;
    *out_values = NULL;
    ppm_status status = name_accessor(reader, index, place, inner, &accessor);
    if (status != PPM_STATUS_OK) return status;
    const int32_t type = accessor->component_type;
    const bool is_unsigned = type == PPMI_GLTF_UNSIGNED_BYTE || type == PPMI_GLTF_UNSIGNED_SHORT ||
                             type == PPMI_GLTF_UNSIGNED_INT;
    if (accessor->component_count != 1 || !is_unsigned) {
        return ppmi_gltf_invalid(reader, inner, "indices must be unsigned scalars");
    }
    status = find_base(reader, accessor, inner, &base);
    if (status != PPM_STATUS_OK) return status;
    const conversion c = {.type = type,
                          .components = 1,
                          .out_components = 1,
                          .rows = 1,
                          .indices = ppmi_alloc(reader->context, base.count, sizeof(uint32_t))};
    if (!c.indices) return ppmi_gltf_out_of_memory(reader, inner);
    status = convert_accessor(reader, accessor, &base, &c, inner);
    if (status != PPM_STATUS_OK) {
        ppmi_free(reader->context, c.indices);
        return status;
    }
    *out_values = c.indices;
    *out_count = base.count;
    return PPM_STATUS_OK;
}
