/* Names to ids, as Cryptomatte 1.2 has them (Friedman and Jones 2015, "Fully Automatic ID Mattes
 * with Support for Motion Blur and Transparency"; Psyop's specification). */
#ifndef PPMI_RENDER_CRYPTO_NAME_H
#define PPMI_RENDER_CRYPTO_NAME_H

#include <stddef.h>
#include <stdint.h>

/* MurmurHash3_x86_32 (Appleby) of any bytes. */
uint32_t ppmi_murmur3(const void *bytes, size_t count, uint32_t seed);

/* The bits of the float that stands for a name (UTF-8): its hash with seed 0, with an exponent that
 * makes it a normal number. Never 0. */
uint32_t ppmi_crypto_id(const char *name);

/* Bytes of a name as a JSON string between quotes, at most, with the terminating zero. */
size_t ppmi_crypto_json_room(const char *name);

/* Writes it; returns the bytes written without the zero. What is not UTF-8 is taken for Latin-1. */
size_t ppmi_crypto_json_write(const char *name, char *out);

#endif
