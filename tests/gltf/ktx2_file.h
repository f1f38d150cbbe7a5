/* KTX files that a test makes itself. */
#ifndef PPM_TESTS_KTX2_FILE_H
#define PPM_TESTS_KTX2_FILE_H

#include <stdint.h>
#include <string.h>

typedef struct ktx2_spec {
    uint32_t format; /* VkFormat */
    uint32_t width, height, layers, faces, scheme;
    uint32_t color_model, transfer, flags; /* of the descriptor */
    const char *swizzle, *orientation;     /* or NULL */
    const void *data;                      /* as it stands in the file */
    size_t count, unpacked;                /* 0: as count */
} ktx2_spec;

static inline void ktx2_put(unsigned char *at, uint64_t value, int bytes)
{
    for (int i = 0; i < bytes; ++i)
        at[i] = (unsigned char)(value >> (8 * i));
}

static inline size_t ktx2_put_pair(unsigned char *at, const char *key, const char *value)
{
    const size_t length = strlen(key) + strlen(value) + 2;
    ktx2_put(at, length, 4);
    memcpy(at + 4, key, strlen(key) + 1);
    memcpy(at + 4 + strlen(key) + 1, value, strlen(value) + 1);
    return 4 + (length + 3) / 4 * 4;
}

/* Writes the file to out, which has room for 300 bytes more than count; returns its length. */
static inline size_t ktx2_make(const ktx2_spec *spec, unsigned char *out)
{
    enum { DESCRIPTOR = 104, DESCRIPTOR_SIZE = 28 };
    const uint32_t words[] = {spec->format,
                              1,
                              spec->width,
                              spec->height,
                              0,
                              spec->layers,
                              spec->faces ? spec->faces : 1,
                              1,
                              spec->scheme};
    size_t at = DESCRIPTOR + DESCRIPTOR_SIZE;
    memset(out, 0, 300);
    memcpy(out, "\xabKTX 20\xbb\r\n\x1a\n", 12);
    for (int i = 0; i < 9; ++i)
        ktx2_put(out + 12 + 4 * i, words[i], 4);
    ktx2_put(out + 48, DESCRIPTOR, 4);
    ktx2_put(out + 52, DESCRIPTOR_SIZE, 4);
    ktx2_put(out + DESCRIPTOR, DESCRIPTOR_SIZE, 4);
    out[DESCRIPTOR + 12] = (unsigned char)spec->color_model;
    out[DESCRIPTOR + 14] = (unsigned char)spec->transfer;
    out[DESCRIPTOR + 15] = (unsigned char)spec->flags;
    ktx2_put(out + 56, at, 4);
    if (spec->orientation) at += ktx2_put_pair(out + at, "KTXorientation", spec->orientation);
    if (spec->swizzle) at += ktx2_put_pair(out + at, "KTXswizzle", spec->swizzle);
    ktx2_put(out + 60, at - DESCRIPTOR - DESCRIPTOR_SIZE, 4);
    at = (at + 15) / 16 * 16;
    ktx2_put(out + 80, at, 8);
    ktx2_put(out + 88, spec->count, 8);
    ktx2_put(out + 96, spec->unpacked ? spec->unpacked : spec->count, 8);
    memcpy(out + at, spec->data, spec->count);
    return at + spec->count;
}

#endif
