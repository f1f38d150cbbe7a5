/* OpenImageIO 2.4 and libpng 1.6 do not write the chunk. */
#include "imageio/png_cicp.h"

#include <string.h>

/* CRC-32 of the chunk's type and data, bit by bit: they are few. */
static uint32_t crc32_of(const uint8_t *bytes, size_t count)
{
    uint32_t crc = 0xffffffff;
    for (size_t i = 0; i < count; i++) {
        crc ^= bytes[i];
        for (int k = 0; k < 8; k++)
            crc = crc & 1 ? 0xedb88320u ^ crc >> 1 : crc >> 1;
    }
    return ~crc;
}

void ppmi_png_add_cicp(const uint8_t *png, size_t byte_count, const uint8_t cicp[4], uint8_t *out)
{
    const size_t header = 8 + 25; /* signature and IHDR */
    uint8_t chunk[PPMI_PNG_CICP_BYTES] = {0, 0, 0, 4, 'c', 'I', 'C', 'P'};
    memcpy(chunk + 8, cicp, 4);
    const uint32_t crc = crc32_of(chunk + 4, 8);
    for (int i = 0; i < 4; i++)
        chunk[12 + i] = (uint8_t)(crc >> (24 - 8 * i));
    memcpy(out, png, header);
    memcpy(out + header, chunk, sizeof chunk);
    memcpy(out + header + sizeof chunk, png + header, byte_count - header);
}
