/* The header, the index of levels and the descriptions of a KTX file (KTX 2.0, chapter 3). Every
 * offset and size is a claim until it has been held against the length of the file. */
#include "gltf/ktx2.h"

#include <stdio.h>
#include <string.h>

enum { HEADER = 80, LEVEL = 24, MODEL_AT = 12, TRANSFER_AT = 14, FLAGS_AT = 15, CHANNEL_AT = 31 };
enum { BASIS_LZ = 1, MOST_LEVELS = 32, TRANSFER_SRGB = 2, ALPHA_PREMULTIPLIED = 1 };

static const unsigned char mark[12] = {0xab, 'K',  'T',  'X',  ' ',  '2',
                                       '0',  0xbb, '\r', '\n', 0x1a, '\n'};

static uint32_t u32(const unsigned char *p)
{
    return (uint32_t)p[0] | (uint32_t)p[1] << 8 | (uint32_t)p[2] << 16 | (uint32_t)p[3] << 24;
}

static uint64_t u64(const unsigned char *p)
{
    return u32(p) | (uint64_t)u32(p + 4) << 32;
}

/* The members of the header, and of the index its first entry. */
typedef struct header {
    uint32_t format, width, height, depth, layers, faces, levels, scheme;
    uint64_t descriptor, descriptor_length, pairs, pairs_length, global, global_length;
    uint64_t level, level_length, level_unpacked;
} header;

static bool read_header(const unsigned char *bytes, size_t count, header *out)
{
    if (count < HEADER + LEVEL) return false;
    *out = (header){.format = u32(bytes + 12),
                    .width = u32(bytes + 20),
                    .height = u32(bytes + 24),
                    .depth = u32(bytes + 28),
                    .layers = u32(bytes + 32),
                    .faces = u32(bytes + 36),
                    .levels = u32(bytes + 40),
                    .scheme = u32(bytes + 44),
                    .descriptor = u32(bytes + 48),
                    .descriptor_length = u32(bytes + 52),
                    .pairs = u32(bytes + 56),
                    .pairs_length = u32(bytes + 60),
                    .global = u64(bytes + 64),
                    .global_length = u64(bytes + 72),
                    .level = u64(bytes + HEADER),
                    .level_length = u64(bytes + HEADER + 8),
                    .level_unpacked = u64(bytes + HEADER + 16)};
    return true;
}

static bool is_inside(uint64_t offset, uint64_t length, size_t count)
{
    return offset <= count && length <= count - offset;
}

static ppm_status fail(ppmi_ktx2 *out, ppm_status status, const char *reason)
{
    snprintf(out->reason, sizeof out->reason, "%s", reason);
    return status;
}

/* ---- descriptions ---------------------------------------------------------------------------- */

/* A byte of the basic descriptor (Khronos Data Format, 5); 0 where there is none. */
static uint32_t described(const header *h, const unsigned char *bytes, size_t count, size_t at)
{
    if (h->descriptor_length <= at || !is_inside(h->descriptor, h->descriptor_length, count))
        return 0;
    return bytes[h->descriptor + at];
}

static bool is_swizzle(const unsigned char *value, size_t length)
{
    if (length < 4) return false;
    for (int i = 0; i < 4; ++i) {
        if (value[i] == 0 || !strchr("rgba01", value[i])) return false;
    }
    return true;
}

static void take_pair(ppmi_ktx2 *out, const unsigned char *pair, size_t length)
{
    const unsigned char *zero = memchr(pair, 0, length);
    if (!zero) return;
    const char *key = (const char *)pair;
    const unsigned char *value = zero + 1;
    const size_t left = length - (size_t)(value - pair);
    if (strcmp(key, "KTXswizzle") == 0 && is_swizzle(value, left)) memcpy(out->swizzle, value, 4);
    if (strcmp(key, "KTXorientation") == 0 && left >= 2) {
        out->is_flipped[0] = value[0] == 'l';
        out->is_flipped[1] = value[1] == 'u';
    }
}

/* Each: its length, a key, 0, a value, and what fills up to four bytes. */
static void read_pairs(const header *h, const unsigned char *bytes, size_t count, ppmi_ktx2 *out)
{
    memcpy(out->swizzle, "rgba", 4);
    if (!is_inside(h->pairs, h->pairs_length, count)) return;
    const unsigned char *at = bytes + h->pairs;
    size_t left = (size_t)h->pairs_length;
    while (left > 4) {
        const size_t length = u32(at);
        if (length > left - 4) return;
        take_pair(out, at + 4, length);
        const size_t padded = (length + 3) / 4 * 4;
        if (padded >= left - 4) return;
        at += 4 + padded;
        left -= 4 + padded;
    }
}

/* ---- the level ------------------------------------------------------------------------------- */

static ppm_status check_shape(const header *h, ppmi_ktx2 *out)
{
    const uint64_t most = UINT64_C(1) << 28;
    if (h->width == 0 || h->faces == 0) {
        return fail(out, PPM_STATUS_INPUT_INVALID, "it has no width or no faces");
    }
    if (h->height == 0 || h->depth > 0 || (h->faces != 1 && h->faces != 6)) {
        return fail(out, PPM_STATUS_INPUT_UNSUPPORTED, "it is neither a flat picture nor a cube");
    }
    if (h->faces == 6 && h->width != h->height) {
        return fail(out, PPM_STATUS_INPUT_INVALID, "its cube has faces that are not square");
    }
    out->width = h->width;
    out->height = h->height;
    out->layers = h->layers > 0 ? h->layers : 1;
    out->faces = h->faces;
    const uint64_t pixels = (uint64_t)h->width * h->height;
    if (pixels > most || out->layers > most || pixels * out->faces * out->layers > most) {
        snprintf(out->reason, sizeof out->reason,
                 "%u x %u pixels, %u layers of %u faces, are more than 2^28 pixels", h->width,
                 h->height, out->layers, h->faces);
        return PPM_STATUS_INPUT_UNSUPPORTED;
    }
    return PPM_STATUS_OK;
}

/* Bytes of one picture; check_shape keeps it below 2^32. */
static size_t picture_size(const ppmi_ktx2 *file)
{
    const size_t edge = file->format.kind == PPMI_KTX2_BLOCKS ? 4 : 1;
    const size_t x = file->format.block[0] ? file->format.block[0] : edge;
    const size_t y = file->format.block[1] ? file->format.block[1] : edge;
    const size_t across = ((size_t)file->width + x - 1) / x;
    const size_t down = ((size_t)file->height + y - 1) / y;
    return across * down * file->format.bytes;
}

/* A picture that is even packs well; but a few bytes that claim gigabytes are a lie. */
static bool is_likely(uint64_t packed, uint64_t unpacked)
{
    const uint64_t free_bytes = UINT64_C(1) << 28, bound = 1032 * 8;
    return unpacked <= free_bytes || unpacked / bound <= packed;
}

/* Slices of any length, and what they have in common. */
static ppm_status find_etc1s(const header *h, const unsigned char *bytes, size_t count,
                             ppmi_ktx2 *out)
{
    const uint64_t pictures = (uint64_t)out->layers * out->faces;
    const uint64_t images = pictures * (h->levels > 0 ? h->levels : 1);
    if (h->scheme != BASIS_LZ) {
        return fail(out, PPM_STATUS_INPUT_INVALID, "its ETC1S is not packed by BasisLZ");
    }
    if (!is_inside(h->global, h->global_length, count)) {
        return fail(out, PPM_STATUS_INPUT_INVALID, "its global data is not within the file");
    }
    if (h->levels > MOST_LEVELS || images > UINT32_MAX) {
        return fail(out, PPM_STATUS_INPUT_INVALID, "it has more levels than its size allows");
    }
    if (!is_likely(h->level_length, 4 * (uint64_t)h->width * h->height * pictures)) {
        return fail(out, PPM_STATUS_INPUT_INVALID, "it claims more pixels than it can hold");
    }
    out->global = bytes + h->global;
    out->global_bytes = (size_t)h->global_length;
    out->images = (uint32_t)images;
    return PPM_STATUS_OK;
}

/* Of Basis Universal, where what is stored as alpha is not alpha: how many channels there are
 * (Khronos Data Format 1.3, "ETC1S model": RRR, and GGG beside it; "UASTC model": RRR and RRRG). */
static void take_channels(const header *h, const unsigned char *bytes, size_t count,
                          ppmi_ktx2_format *format)
{
    enum { RED = 3, GREEN = 4, SAMPLE = 16, KIND = 15, UASTC_RRR = 4, UASTC_RRRG = 5 };
    const uint32_t first = described(h, bytes, count, CHANNEL_AT) & KIND;
    const uint32_t second = described(h, bytes, count, CHANNEL_AT + SAMPLE) & KIND;
    if (format->kind == PPMI_KTX2_UASTC && first == UASTC_RRR) format->channels = 1;
    if (format->kind == PPMI_KTX2_UASTC && first == UASTC_RRRG) format->channels = 2;
    if (format->kind == PPMI_KTX2_ETC1S && first == RED) format->channels = second == GREEN ? 2 : 1;
}

static ppm_status find_level(ppm_context *context, const header *h, const unsigned char *bytes,
                             size_t count, ppmi_ktx2 *out)
{
    out->picture_bytes = picture_size(out);
    const uint64_t size = (uint64_t)out->picture_bytes * out->layers * out->faces;
    const uint64_t claimed = h->scheme == 0 ? h->level_length : h->level_unpacked;
    const char *reason = NULL;
    if (!is_inside(h->level, h->level_length, count)) {
        snprintf(out->reason, sizeof out->reason,
                 "its picture is bytes %llu to %llu, and the file has %zu",
                 (unsigned long long)h->level, (unsigned long long)(h->level + h->level_length),
                 count);
        return PPM_STATUS_INPUT_INVALID;
    }
    out->level = bytes + h->level;
    out->level_bytes = (size_t)h->level_length;
    if (out->format.kind == PPMI_KTX2_ETC1S) return find_etc1s(h, bytes, count, out);
    if (claimed != size) {
        snprintf(out->reason, sizeof out->reason,
                 "%u x %u pixels of its format need %llu bytes, and it has %llu", out->width,
                 out->height, (unsigned long long)size, (unsigned long long)claimed);
        return PPM_STATUS_INPUT_INVALID;
    }
    if (h->scheme == 0) return PPM_STATUS_OK;
    if (!is_likely(h->level_length, size)) {
        return fail(out, PPM_STATUS_INPUT_INVALID, "it claims more pixels than it can hold");
    }
    out->level = out->owned = ppmi_alloc(context, (size_t)size, 1);
    if (!out->owned) return fail(out, PPM_STATUS_OUT_OF_MEMORY, "out of memory");
    const ppm_status status = ppmi_ktx2_unpack(h->scheme, bytes + h->level, (size_t)h->level_length,
                                               out->owned, (size_t)size, &reason);
    return status == PPM_STATUS_OK ? status : fail(out, status, reason);
}

/* ---- the file -------------------------------------------------------------------------------- */

bool ppmi_ktx2_is(const unsigned char *bytes, size_t count)
{
    return count >= sizeof mark && memcmp(bytes, mark, sizeof mark) == 0;
}

const char *ppmi_ktx2_unread_encoding(const unsigned char *bytes, size_t count)
{
    header h;
    ppmi_ktx2_format format;
    if (!ppmi_ktx2_is(bytes, count) || !read_header(bytes, count, &h)) return NULL;
    const uint32_t model = described(&h, bytes, count, MODEL_AT);
    if (ppmi_ktx2_find_format(h.format, model, &format)) return NULL;
    const char *name = ppmi_ktx2_format_name(h.format, model);
    return name ? name : "of a format without a name here";
}

ppm_status ppmi_ktx2_open(ppm_context *context, const unsigned char *bytes, size_t count,
                          ppmi_ktx2 *out)
{
    header h;
    *out = (ppmi_ktx2){0};
    if (!ppmi_ktx2_is(bytes, count)) return fail(out, PPM_STATUS_INPUT_INVALID, "it is no KTX2");
    if (!read_header(bytes, count, &h)) {
        return fail(out, PPM_STATUS_INPUT_INVALID, "it ends within its header");
    }
    const char *unread = ppmi_ktx2_unread_encoding(bytes, count);
    const uint32_t model = described(&h, bytes, count, MODEL_AT);
    if (unread || !ppmi_ktx2_find_format(h.format, model, &out->format)) {
        snprintf(out->reason, sizeof out->reason,
                 "a KTX2 file that is %s cannot be read (VkFormat "
                 "%u)",
                 unread, h.format);
        return PPM_STATUS_INPUT_UNSUPPORTED;
    }
    if (described(&h, bytes, count, FLAGS_AT) & ALPHA_PREMULTIPLIED) {
        return fail(out, PPM_STATUS_INPUT_UNSUPPORTED, "its colours are multiplied by alpha");
    }
    if (described(&h, bytes, count, TRANSFER_AT) == TRANSFER_SRGB) out->format.is_srgb = true;
    take_channels(&h, bytes, count, &out->format);
    read_pairs(&h, bytes, count, out);
    const ppm_status status = check_shape(&h, out);
    return status == PPM_STATUS_OK ? find_level(context, &h, bytes, count, out) : status;
}

void ppmi_ktx2_close(ppm_context *context, ppmi_ktx2 *file)
{
    ppmi_free(context, file->owned);
    file->owned = NULL;
    file->level = NULL;
}
