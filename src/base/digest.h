/* A digest of many bytes, to tell whether two things are the same: MurmurHash3_x64_128 (Appleby,
 * 2011). Not for secrets. */
#ifndef PPMI_BASE_DIGEST_H
#define PPMI_BASE_DIGEST_H

#include <stddef.h>
#include <stdint.h>

enum { PPMI_DIGEST_TEXT_SIZE = 33 };

typedef struct ppmi_digest {
    uint64_t h1, h2;
    uint64_t byte_count;
    uint8_t tail[16]; /* bytes that do not fill a block yet: byte_count modulo 16 */
} ppmi_digest;

/* Starts with nothing: ppmi_digest d = {0}. Bytes that come in pieces count as one. */
void ppmi_digest_add(ppmi_digest *digest, const void *bytes, size_t byte_count);
/* A text with its end, so that "ab", "c" is not "a", "bc". NULL counts as one that is empty. */
void ppmi_digest_add_text(ppmi_digest *digest, const char *text);
/* 32 hexadecimal digits. */
void ppmi_digest_write(const ppmi_digest *digest, char text[PPMI_DIGEST_TEXT_SIZE]);

#endif
