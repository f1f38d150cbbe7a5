/* Attribute streams of version 1, which meshoptimizer reads only from 0.23 on: after
 * KHR_meshopt_compression (draft of 2025), appendix A, "Mode 0: attributes".
 *
 * A stream is a header byte, blocks, padding and a tail. The tail holds the element before the
 * first one and, for every four bytes of an element (a channel), how deltas are added to the
 * element before. A block holds the deltas of up to 256 elements, byte position by byte position;
 * its first bytes say, in two bits for each position (its control), how. */
#include <string.h>

#include "gltf/gltf_meshopt.h"

enum {
    HEADER = 0xa1,
    GROUP = 16, /* deltas that share a bit length */
    MAX_ELEMENTS = 256,
    MAX_STRIDE = 256,
    BLOCK_BYTES = 8192,
    MIN_TAIL = 24
};

enum { CONTROL_ZERO = 2, CONTROL_LITERAL = 3 };
enum { CHANNEL_BYTES = 0, CHANNEL_WORDS = 1, CHANNEL_XOR = 2 };

typedef struct input {
    const unsigned char *at, *end;
} input;

/* The next count bytes, or NULL. */
static const unsigned char *take(input *in, size_t count)
{
    if ((size_t)(in->end - in->at) < count) return NULL;
    const unsigned char *bytes = in->at;
    in->at += count;
    return bytes;
}

/* The i-th of packed values: the first in the lowest bit for single bits, else in the highest. */
static unsigned unpack(const unsigned char *packed, unsigned bits, unsigned i)
{
    const unsigned bit = i * bits % 8, byte = packed[i * bits / 8];
    const unsigned shift = bits == 1 ? bit : 8 - bits - bit;
    return byte >> shift & ((1u << bits) - 1);
}

/* 16 deltas of some bit length; those with all bits set stand behind them as bytes. */
static bool read_group(input *in, unsigned bits, unsigned char out[GROUP])
{
    if (bits == 0) {
        memset(out, 0, GROUP);
        return true;
    }
    const unsigned char *packed = take(in, GROUP * bits / 8);
    if (!packed) return false;
    if (bits == 8) {
        memcpy(out, packed, GROUP);
        return true;
    }
    const unsigned sentinel = (1u << bits) - 1;
    for (unsigned i = 0; i < GROUP; ++i) {
        const unsigned value = unpack(packed, bits, i);
        const unsigned char *whole = value == sentinel ? take(in, 1) : NULL;
        if (value == sentinel && !whole) return false;
        out[i] = whole ? *whole : (unsigned char)value;
    }
    return true;
}

/* The deltas of one byte position; out has room for whole groups. */
static bool read_deltas(input *in, unsigned control, size_t count, unsigned char *out)
{
    static const unsigned char lengths[2][4] = {{0, 1, 2, 4}, {1, 2, 4, 8}};
    if (control == CONTROL_ZERO) {
        memset(out, 0, count);
        return true;
    }
    if (control == CONTROL_LITERAL) {
        const unsigned char *bytes = take(in, count);
        if (bytes) memcpy(out, bytes, count);
        return bytes != NULL;
    }
    const size_t groups = (count + GROUP - 1) / GROUP;
    const unsigned char *header = take(in, (groups + 3) / 4);
    for (size_t i = 0; header && i < groups; ++i) {
        const unsigned mode = header[i / 4] >> 2 * (i % 4) & 3u;
        if (!read_group(in, lengths[control][mode], out + GROUP * i)) return false;
    }
    return header != NULL;
}

static uint32_t load(const unsigned char *bytes, size_t step, size_t size)
{
    uint32_t value = 0;
    for (size_t k = 0; k < size; ++k) {
        value |= (uint32_t)bytes[k * step] << 8 * k;
    }
    return value;
}

static void store(uint32_t value, size_t size, unsigned char *out)
{
    for (size_t k = 0; k < size; ++k) {
        out[k] = (unsigned char)(value >> 8 * k);
    }
}

static uint32_t unzigzag(uint32_t value)
{
    return value & 1 ? ~(value >> 1) : value >> 1;
}

static uint32_t rotate_left(uint32_t value, unsigned by)
{
    return value << by | value >> ((32 - by) & 31);
}

/* Adds the deltas of values of size bytes to the element before; deltas of one byte position are
 * MAX_ELEMENTS apart from those of the next. */
static void add_deltas(const unsigned char *deltas, size_t count, size_t size, size_t stride,
                       unsigned channel, unsigned char *before, unsigned char *out)
{
    const bool is_xor = (channel & 15) == CHANNEL_XOR;
    uint32_t value = load(before, 1, size);
    for (size_t i = 0; i < count; ++i) {
        const uint32_t delta = load(deltas + i, MAX_ELEMENTS, size);
        value = is_xor ? value ^ rotate_left(delta, channel >> 4) : value + unzigzag(delta);
        store(value, size, out + i * stride);
        value = load(out + i * stride, 1, size); /* without carry */
    }
    store(value, size, before);
}

static size_t value_size(unsigned channel)
{
    return (channel & 15) == CHANNEL_BYTES ? 1 : (channel & 15) == CHANNEL_WORDS ? 2 : 4;
}

static bool read_block(input *in, size_t count, size_t stride, const unsigned char *channels,
                       unsigned char *before, unsigned char *out)
{
    unsigned char deltas[4 * MAX_ELEMENTS];
    const unsigned char *controls = take(in, stride / 4);
    if (!controls) return false;
    for (size_t k = 0; k < stride; k += 4) {
        for (size_t j = 0; j < 4; ++j) {
            const unsigned control = controls[k / 4] >> 2 * j & 3u;
            if (!read_deltas(in, control, count, deltas + j * MAX_ELEMENTS)) return false;
        }
        const unsigned channel = channels[k / 4];
        const size_t size = value_size(channel);
        for (size_t j = 0; j < 4; j += size) {
            add_deltas(deltas + j * MAX_ELEMENTS, count, size, stride, channel, before + k + j,
                       out + k + j);
        }
    }
    return true;
}

static bool are_channels_known(const unsigned char *channels, size_t count)
{
    for (size_t i = 0; i < count; ++i) {
        const bool is_known = channels[i] <= CHANNEL_WORDS || (channels[i] & 15) == CHANNEL_XOR;
        if (!is_known) return false;
    }
    return true;
}

bool ppmi_gltf_meshopt_decode_v1(unsigned char *out, size_t count, size_t stride,
                                 const unsigned char *stream, size_t length)
{
    const size_t tail = stride + stride / 4, padded = tail < MIN_TAIL ? MIN_TAIL : tail;
    const size_t whole_groups = BLOCK_BYTES / stride / GROUP * GROUP;
    const size_t block = whole_groups < MAX_ELEMENTS ? whole_groups : MAX_ELEMENTS;
    unsigned char before[MAX_STRIDE];
    if (length < 1 + padded || stream[0] != HEADER) return false;
    const unsigned char *channels = stream + length - stride / 4;
    if (!are_channels_known(channels, stride / 4)) return false;
    memcpy(before, stream + length - tail, stride);
    input in = {stream + 1, stream + length - padded};
    while (count > 0) {
        const size_t now = count < block ? count : block;
        if (!read_block(&in, now, stride, channels, before, out)) return false;
        out += now * stride;
        count -= now;
    }
    return in.at == in.end;
}
