/* A square of 2 m, once as a floor and once, smaller and upside down, as a lamp. */
#include "cli/tiny_scene.h"

#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <string.h>

/* Four corners as float[3], then two triangles as uint16_t[3], counter-clockwise from above. */
typedef struct square {
    float corners[4][3];
    uint16_t triangles[2][3];
} square;

static const square unit_square = {
    .corners = {{-1.0f, 0.0f, -1.0f}, {-1.0f, 0.0f, 1.0f}, {1.0f, 0.0f, 1.0f}, {1.0f, 0.0f, -1.0f}},
    .triangles = {{0, 1, 2}, {0, 2, 3}}};

static void put_base64(FILE *file, const unsigned char *bytes, size_t count)
{
    static const char digits[] = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    for (size_t i = 0; i < count; i += 3) { /* count is a multiple of three */
        const unsigned three =
            (unsigned)bytes[i] << 16 | (unsigned)bytes[i + 1] << 8 | bytes[i + 2];
        for (int shift = 18; shift >= 0; shift -= 6)
            fputc(digits[three >> shift & 63], file);
    }
}

static const char head[] =
    "{\"asset\": {\"version\": \"2.0\", \"generator\": \"ppm tests\"},\n"
    " \"scene\": 0, \"scenes\": [{\"nodes\": [0, 1, 2, 3]}],\n"
    " \"nodes\": [\n"
    "  {\"name\": \"Floor\", \"mesh\": 0},\n"
    "  {\"name\": \"Lamp\", \"mesh\": 1, \"translation\": [0, 1.5, 0], \"rotation\": [1, 0, 0, "
    "0],\n"
    "   \"scale\": [0.3, 0.3, 0.3]},\n"
    "  {\"name\": \"Front\", \"camera\": 0, \"translation\": [0, 1, 3],\n"
    "   \"rotation\": [-0.1305262, 0, 0, 0.9914449]},\n"
    "  {\"name\": \"Side\", \"camera\": 1, \"translation\": [3, 1, 0],\n"
    "   \"rotation\": [0, 0.7071068, 0, 0.7071068]}],\n"
    " \"cameras\": [\n"
    "  {\"name\": \"Front\", \"type\": \"perspective\",\n"
    "   \"perspective\": {\"yfov\": 0.8, \"aspectRatio\": 2, \"znear\": 0.1}},\n"
    "  {\"name\": \"Side\", \"type\": \"perspective\", \"perspective\": {\"yfov\": 0.8, \"znear\": "
    "0.1}}],\n"
    " \"materials\": [\n"
    "  {\"name\": \"Grey\", \"pbrMetallicRoughness\": {\"baseColorFactor\": [0.5, 0.5, 0.5, 1],\n"
    "   \"metallicFactor\": 0}},\n"
    "  {\"name\": \"Light\", \"emissiveFactor\": [1, 1, 1]}],\n"
    " \"meshes\": [\n"
    "  {\"primitives\": [{\"attributes\": {\"POSITION\": 0}, \"indices\": 1, \"material\": 0}]},\n"
    "  {\"primitives\": [{\"attributes\": {\"POSITION\": 0}, \"indices\": 1, \"material\": 1}]}],\n"
    " \"accessors\": [\n"
    "  {\"bufferView\": 0, \"componentType\": 5126, \"count\": 4, \"type\": \"VEC3\",\n"
    "   \"min\": [-1, 0, -1], \"max\": [1, 0, 1]},\n"
    "  {\"bufferView\": 1, \"componentType\": 5123, \"count\": 6, \"type\": \"SCALAR\"}],\n"
    " \"bufferViews\": [{\"buffer\": 0, \"byteLength\": 48},\n"
    "  {\"buffer\": 0, \"byteOffset\": 48, \"byteLength\": 12}],\n"
    " \"buffers\": [{\"byteLength\": 60, \"uri\": \"data:application/octet-stream;base64,";

bool tiny_scene_write(const char *path)
{
    unsigned char bytes[sizeof unit_square];
    _Static_assert(sizeof unit_square == 60, "the buffer views say so");
    memcpy(bytes, &unit_square, sizeof bytes);
    FILE *const file = fopen(path, "w");
    if (!file) return false;
    fputs(head, file);
    put_base64(file, bytes, sizeof bytes);
    fputs("\"}]}\n", file);
    return fclose(file) == 0;
}
