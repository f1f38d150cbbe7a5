/* Draco streams for tests. */
#ifndef PPM_TESTS_DRACO_ENCODER_H
#define PPM_TESTS_DRACO_ENCODER_H

#include <stddef.h>
#include <stdint.h>

#ifdef __cplusplus
extern "C" {
#endif

enum { DRACO_EDGEBREAKER, DRACO_SEQUENTIAL };

/* A mesh whose attributes are positions (float, id 0), colours (four normalised bytes, id 1) and
 * joints (four 16-bit integers, id 2). Nothing is quantised. Returns the stream's length; 0 when
 * it does not fit in size. */
size_t draco_encode(int method, const float *positions, const uint8_t *colors,
                    const uint16_t *joints, size_t vertex_count, const uint32_t *indices,
                    size_t triangle_count, unsigned char *out, size_t size);

/* An attribute; its values are packed, or three of four shorts or bytes. */
typedef struct draco_column {
    const void *values;
    int component, components; /* glTF's number of the type: 5120 .. 5126 */
    int is_normalized, is_position;
} draco_column;

/* The same for attributes of any kind; each one's id is its place. */
size_t draco_encode_columns(int method, const draco_column *columns, size_t count,
                            size_t vertex_count, const uint32_t *indices, size_t triangle_count,
                            unsigned char *out, size_t size);

#ifdef __cplusplus
}
#endif

#endif
