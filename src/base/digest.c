/* MurmurHash3_x64_128 with seed 0, for bytes that come in pieces. */
#include "base/digest.h"

#include <inttypes.h>
#include <stdio.h>
#include <string.h>

static const uint64_t c1 = UINT64_C(0x87c37b91114253d5), c2 = UINT64_C(0x4cf5ad432745937f);

static uint64_t rotated(uint64_t x, int bits)
{
    return x << bits | x >> (64 - bits);
}

static uint64_t mixed_first(uint64_t k)
{
    return rotated(k * c1, 31) * c2;
}

static uint64_t mixed_second(uint64_t k)
{
    return rotated(k * c2, 33) * c1;
}

static void add_block(ppmi_digest *digest, const uint8_t *block)
{
    uint64_t k1, k2;
    memcpy(&k1, block, sizeof k1);
    memcpy(&k2, block + sizeof k1, sizeof k2);
    digest->h1 = (rotated(digest->h1 ^ mixed_first(k1), 27) + digest->h2) * 5 + 0x52dce729;
    digest->h2 = (rotated(digest->h2 ^ mixed_second(k2), 31) + digest->h1) * 5 + 0x38495ab5;
}

void ppmi_digest_add(ppmi_digest *digest, const void *bytes, size_t byte_count)
{
    const size_t block = sizeof digest->tail;
    const uint8_t *next = bytes;
    size_t filled = (size_t)(digest->byte_count % block);
    digest->byte_count += byte_count;
    if (filled > 0) {
        const size_t room = block - filled, taken = byte_count < room ? byte_count : room;
        if (taken > 0) memcpy(digest->tail + filled, next, taken);
        if (taken < room) return;
        add_block(digest, digest->tail);
        next += taken;
        byte_count -= taken;
    }
    for (; byte_count >= block; byte_count -= block, next += block)
        add_block(digest, next);
    if (byte_count > 0) memcpy(digest->tail, next, byte_count);
}

void ppmi_digest_add_text(ppmi_digest *digest, const char *text)
{
    const char *const all = text ? text : "";
    ppmi_digest_add(digest, all, strlen(all) + 1);
}

static uint64_t finished(uint64_t k)
{
    k = (k ^ k >> 33) * UINT64_C(0xff51afd7ed558ccd);
    k = (k ^ k >> 33) * UINT64_C(0xc4ceb9fe1a85ec53);
    return k ^ k >> 33;
}

void ppmi_digest_write(const ppmi_digest *digest, char text[PPMI_DIGEST_TEXT_SIZE])
{
    uint8_t tail[16] = {0};
    uint64_t k1, k2, h1 = digest->h1, h2 = digest->h2;
    memcpy(tail, digest->tail, (size_t)(digest->byte_count % sizeof tail));
    memcpy(&k1, tail, sizeof k1);
    memcpy(&k2, tail + sizeof k1, sizeof k2);
    h1 ^= mixed_first(k1) ^ digest->byte_count;
    h2 ^= mixed_second(k2) ^ digest->byte_count;
    h1 += h2;
    h2 += h1;
    h1 = finished(h1);
    h2 = finished(h2);
    h1 += h2;
    h2 += h1;
    snprintf(text, PPMI_DIGEST_TEXT_SIZE, "%016" PRIx64 "%016" PRIx64, h1, h2);
}
