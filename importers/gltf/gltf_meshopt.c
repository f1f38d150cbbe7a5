/* Buffer views in meshoptimizer's formats (KHR_meshopt_compression, draft of 2025, and the older
 * EXT_meshopt_compression, which is a part of it). */
#include "gltf/gltf_meshopt.h"

#include <math.h>
#include <meshoptimizer.h>
#include <string.h>

enum {
    ATTRIBUTES_V0 = 0xa0, /* first bytes of a stream */
    ATTRIBUTES_V1 = 0xa1,
    MAX_STRIDE = 256
};

static bool is_word(const char *word, const char *other)
{
    return strcmp(word, other) == 0;
}

/* ---- what can be ----------------------------------------------------------------------------- */

/* Bytes that one byte of a stream can stand for. Version 0 spends two bits on 16 deltas. Version 1
 * spends two bits on all deltas of a byte in a block, which has 8192 bytes and 256 elements at
 * most. Of indices each takes a byte, of triangles each. */
static size_t densest(const ppmi_gltf_meshopt *view, unsigned char version)
{
    if (is_word(view->mode, "TRIANGLES")) return 3 * view->byte_stride;
    if (is_word(view->mode, "INDICES")) return view->byte_stride;
    return version == ATTRIBUTES_V0 ? 64 : 1024;
}

static const char *filter_fault(const ppmi_gltf_meshopt *view)
{
    const size_t stride = view->byte_stride;
    const bool is_quad = stride == 4 || stride == 8;
    if (is_word(view->filter, "") || is_word(view->filter, "NONE")) return NULL;
    if (!is_word(view->mode, "ATTRIBUTES")) return "filter: only ATTRIBUTES may have one";
    if (is_word(view->filter, "QUATERNION") && stride != 8) {
        return "filter QUATERNION needs a byteStride of 8";
    }
    if (is_word(view->filter, "OCTAHEDRAL") && !is_quad) {
        return "filter OCTAHEDRAL needs a byteStride of 4 or 8";
    }
    if (is_word(view->filter, "COLOR") && !is_quad) {
        return "filter COLOR needs a byteStride of 4 or 8";
    }
    return NULL;
}

static const char *layout_fault(const ppmi_gltf_meshopt *view)
{
    const size_t stride = view->byte_stride;
    if (is_word(view->mode, "ATTRIBUTES")) {
        const bool is_fine = stride >= 4 && stride <= MAX_STRIDE && stride % 4 == 0;
        return is_fine ? NULL : "byteStride of ATTRIBUTES must be a multiple of 4 up to 256";
    }
    if (stride != 2 && stride != 4) return "byteStride of indices must be 2 or 4";
    if (is_word(view->mode, "TRIANGLES") && view->count % 3 != 0) {
        return "count of TRIANGLES must be a multiple of 3";
    }
    return NULL;
}

const char *ppmi_gltf_meshopt_fault(const ppmi_gltf_meshopt *view, const unsigned char *stream)
{
    const char *fault = layout_fault(view);
    if (!fault) fault = filter_fault(view);
    if (fault) return fault;
    if (view->byte_length == 0 || view->count == 0) return "an empty stream";
    /* count * stride <= byte_length * densest, without overflow: lengths are below 2^53 */
    const size_t most = view->byte_length * densest(view, stream[0]) / view->byte_stride;
    if (view->count > most) return "count: more than a stream of byteLength can hold";
    const bool is_attributes = is_word(view->mode, "ATTRIBUTES");
    if (is_attributes && stream[0] != ATTRIBUTES_V0 && stream[0] != ATTRIBUTES_V1) {
        return "the stream is of an unknown version";
    }
    return NULL;
}

/* ---- colours --------------------------------------------------------------------------------- */

/* Filter 4: luma, two chromas and alpha of K bits to normalised red, green, blue and alpha. The
 * highest set bit of alpha tells K. */
static void decode_color(const int32_t in[4], float most, float out[4])
{
    const uint32_t alpha = (uint32_t)in[3];
    uint32_t full = 1; /* 2^K - 1 */
    while (full < alpha) {
        full = 2 * full + 1;
    }
    const uint32_t kept = alpha & full >> 1;
    const int32_t luma = in[0], orange = in[1], green = in[2];
    const float scale = most / (float)full;
    const float values[4] = {(float)(luma + orange - green), (float)(luma + green),
                             (float)(luma - orange - green), (float)(kept << 1 | (kept & 1))};
    for (int k = 0; k < 4; ++k) {
        out[k] = fminf(fmaxf(roundf(values[k] * scale), 0.0f), most);
    }
}

static void decode_colors_8(unsigned char *bytes, size_t count)
{
    for (size_t i = 0; i < count; ++i) {
        unsigned char *c = bytes + 4 * i;
        const int32_t in[4] = {c[0], (int8_t)c[1], (int8_t)c[2], c[3]};
        float out[4];
        decode_color(in, 255.0f, out);
        for (int k = 0; k < 4; ++k) {
            c[k] = (unsigned char)out[k];
        }
    }
}

static void decode_colors_16(unsigned char *bytes, size_t count)
{
    for (size_t i = 0; i < count; ++i) {
        uint16_t c[4];
        float out[4];
        memcpy(c, bytes + 8 * i, sizeof c);
        const int32_t in[4] = {c[0], (int16_t)c[1], (int16_t)c[2], c[3]};
        decode_color(in, 65535.0f, out);
        for (int k = 0; k < 4; ++k) {
            c[k] = (uint16_t)out[k];
        }
        memcpy(bytes + 8 * i, c, sizeof c);
    }
}

/* ---- decoding -------------------------------------------------------------------------------- */

static void apply_filter(const ppmi_gltf_meshopt *view, unsigned char *out)
{
    if (is_word(view->filter, "OCTAHEDRAL")) {
        meshopt_decodeFilterOct(out, view->count, view->byte_stride);
    } else if (is_word(view->filter, "QUATERNION")) {
        meshopt_decodeFilterQuat(out, view->count, view->byte_stride);
    } else if (is_word(view->filter, "EXPONENTIAL")) {
        meshopt_decodeFilterExp(out, view->count, view->byte_stride);
    } else if (is_word(view->filter, "COLOR") && view->byte_stride == 4) {
        decode_colors_8(out, view->count);
    } else if (is_word(view->filter, "COLOR")) {
        decode_colors_16(out, view->count);
    }
}

bool ppmi_gltf_meshopt_decode(const ppmi_gltf_meshopt *view, const unsigned char *stream,
                              unsigned char *out)
{
    const size_t count = view->count, stride = view->byte_stride, length = view->byte_length;
    if (is_word(view->mode, "TRIANGLES")) {
        return meshopt_decodeIndexBuffer(out, count, stride, stream, length) == 0;
    }
    if (is_word(view->mode, "INDICES")) {
        return meshopt_decodeIndexSequence(out, count, stride, stream, length) == 0;
    }
    const bool is_decoded =
        stream[0] == ATTRIBUTES_V1
            ? ppmi_gltf_meshopt_decode_v1(out, count, stride, stream, length)
            : meshopt_decodeVertexBuffer(out, count, stride, stream, length) == 0;
    if (is_decoded) apply_filter(view, out);
    return is_decoded;
}
