#include "render/crypto_name.h"

#include <stdbool.h>
#include <stdio.h>
#include <string.h>

#include "ppm/render.h"

/* ---- the hash -------------------------------------------------------------------------------- */

static uint32_t turn_left(uint32_t x, int bits)
{
    return x << bits | x >> (32 - bits);
}

/* What a block adds to the hash, before it is mixed in. */
static uint32_t scramble(uint32_t block)
{
    return turn_left(block * 0xcc9e2d51u, 15) * 0x1b873593u;
}

/* Up to four bytes, the first one lowest, on any machine. */
static uint32_t load_bytes(const uint8_t *bytes, size_t count)
{
    uint32_t block = 0;
    for (size_t i = 0; i < count; i++)
        block |= (uint32_t)bytes[i] << (8 * i);
    return block;
}

static uint32_t finish(uint32_t hash)
{
    hash = (hash ^ hash >> 16) * 0x85ebca6bu;
    hash = (hash ^ hash >> 13) * 0xc2b2ae35u;
    return hash ^ hash >> 16;
}

uint32_t ppmi_murmur3(const void *bytes, size_t count, uint32_t seed)
{
    const uint8_t *at = bytes;
    uint32_t hash = seed;
    size_t left = count;
    for (; left >= 4; left -= 4, at += 4)
        hash = turn_left(hash ^ scramble(load_bytes(at, 4)), 13) * 5 + 0xe6546b64u;
    hash ^= scramble(load_bytes(at, left));
    return finish(hash ^ (uint32_t)count);
}

/* An exponent of all zeros or ones would be a denormal, an infinity or no number, which programs
 * change on the way: the specification flips its lowest bit. */
uint32_t ppmi_crypto_id(const char *name)
{
    const uint32_t hash = ppmi_murmur3(name, strlen(name), 0);
    const uint32_t exponent = hash >> 23 & 255;
    return exponent == 0 || exponent == 255 ? hash ^ UINT32_C(1) << 23 : hash;
}

void ppm_cryptomatte_key(const char *layer_name, char out_key[8])
{
    char digits[9];
    snprintf(digits, sizeof digits, "%08x", (unsigned)ppmi_crypto_id(layer_name));
    memcpy(out_key, digits, 7);
    out_key[7] = '\0';
}

/* ---- JSON ------------------------------------------------------------------------------------ */

static bool is_next(const uint8_t *at, size_t count)
{
    for (size_t i = 1; i <= count; i++) {
        if ((at[i] & 0xc0) != 0x80) return false;
    }
    return true;
}

/* The bytes of the letter at text (RFC 3629: no surrogates, no longer form than it needs, nothing
 * beyond U+10FFFF); 0 when it is none. */
static size_t letter_length(const char *text)
{
    const uint8_t *at = (const uint8_t *)text;
    if (at[0] < 0x80) return 1;
    if (at[0] >= 0xc2 && at[0] < 0xe0) return is_next(at, 1) ? 2 : 0;
    if (at[0] >= 0xe0 && at[0] < 0xf0) {
        if (!is_next(at, 2) || (at[0] == 0xe0 && at[1] < 0xa0)) return 0;
        return at[0] == 0xed && at[1] >= 0xa0 ? 0 : 3;
    }
    if (at[0] >= 0xf0 && at[0] < 0xf5) {
        if (!is_next(at, 3) || (at[0] == 0xf0 && at[1] < 0x90)) return 0;
        return at[0] == 0xf4 && at[1] >= 0x90 ? 0 : 4;
    }
    return 0;
}

size_t ppmi_crypto_json_room(const char *name)
{
    return 6 * strlen(name) + 3; /* \u0000 for each byte, quotes, zero */
}

size_t ppmi_crypto_json_write(const char *name, char *out)
{
    char *to = out;
    *to++ = '"';
    while (*name) {
        const size_t length = letter_length(name);
        const uint8_t byte = (uint8_t)*name;
        if (length == 0 || byte < 0x20 || byte == 0x7f) {
            to += snprintf(to, 7, "\\u%04x", (unsigned)byte);
            name++;
            continue;
        }
        if (byte == '"' || byte == '\\') *to++ = '\\';
        memcpy(to, name, length);
        to += length;
        name += length;
    }
    *to++ = '"';
    *to = '\0';
    return (size_t)(to - out);
}
