/* A square of 2 m, once as a floor and once, smaller and upside down, as a lamp. In the moving
 * scene the lamp goes sideways, once along x, from beyond the floor to beyond it, and once along z.
 */
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
    "{\"asset\": {\"version\": \"2.0\", \"generator\": \"ppm tests\",\n"
    "  \"copyright\": \"2026 nobody\",\n"
    "  \"extensions\": {\"KHR_xmp_json_ld\": {\"packet\": 0}}},\n"
    " \"extensionsUsed\": [\"KHR_xmp_json_ld\"],\n"
    " \"extensions\": {\"KHR_xmp_json_ld\": {\"packets\": [{\"dc:title\": \"Tiny\"}]}},\n"
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
    "  {\"bufferView\": 1, \"componentType\": 5123, \"count\": 6, \"type\": \"SCALAR\"}";

/* What the moving scene has besides: names that a table, a terminal or a file's name would suffer
 * from are part of it. */
static const char moving_accessors[] =
    ",\n  {\"bufferView\": 2, \"componentType\": 5126, \"count\": 2, \"type\": \"SCALAR\",\n"
    "   \"min\": [0], \"max\": [1]},\n"
    "  {\"bufferView\": 3, \"componentType\": 5126, \"count\": 2, \"type\": \"VEC3\"},\n"
    "  {\"bufferView\": 4, \"componentType\": 5126, \"count\": 2, \"type\": \"VEC3\"}";
static const char moving_views[] = ",\n  {\"buffer\": 0, \"byteOffset\": 60, \"byteLength\": 8},\n"
                                   "  {\"buffer\": 0, \"byteOffset\": 68, \"byteLength\": 24},\n"
                                   "  {\"buffer\": 0, \"byteOffset\": 92, \"byteLength\": 24}";
static const char moving_lists[] =
    " \"animations\": [\n"
    "  {\"name\": \"Slide\", \"samplers\": [{\"input\": 2, \"output\": 3}],\n"
    "   \"channels\": [{\"sampler\": 0, \"target\": {\"node\": 1, \"path\": \"translation\"}}]},\n"
    "  {\"name\": \"Bell\\u0007\\u001b[2J\", \"samplers\": [{\"input\": 2, \"output\": 4}],\n"
    "   \"channels\": [{\"sampler\": 0, \"target\": {\"node\": 1, \"path\": \"translation\"}}]}],\n"
    " \"images\": [{\"name\": \"Wood\", \"uri\": \"wood%20floor.png\"}],\n";

static const float moving_keys[] = {0.0f,  1.0f,                           /* seconds */
                                    -1.5f, 1.5f, 0.0f,  1.5f, 1.5f, 0.0f,  /* along x */
                                    0.0f,  1.5f, -0.5f, 0.0f, 1.5f, 0.5f}; /* along z */

static bool write_scene(const char *path, bool is_moving)
{
    unsigned char bytes[sizeof unit_square + sizeof moving_keys + 1] = {0};
    const size_t count = is_moving ? sizeof unit_square + sizeof moving_keys : sizeof unit_square;
    _Static_assert(sizeof unit_square == 60, "the buffer views say so");
    _Static_assert((sizeof unit_square + sizeof moving_keys) % 3 == 2, "one byte is missing");
    memcpy(bytes, &unit_square, sizeof unit_square);
    memcpy(bytes + sizeof unit_square, moving_keys, sizeof moving_keys);
    FILE *const file = fopen(path, "w");
    if (!file) return false;
    fprintf(file, "%s%s],\n", head, is_moving ? moving_accessors : "");
    fprintf(file, "%s%s", is_moving ? moving_lists : "",
            " \"bufferViews\": [{\"buffer\": 0, \"byteLength\": 48},\n"
            "  {\"buffer\": 0, \"byteOffset\": 48, \"byteLength\": 12}");
    fprintf(file,
            "%s],\n \"buffers\": [{\"byteLength\": %zu, \"uri\": "
            "\"data:application/octet-stream;base64,",
            is_moving ? moving_views : "", count);
    put_base64(file, bytes, is_moving ? count + 1 : count);
    fputs("\"}]}\n", file);
    return fclose(file) == 0;
}

bool tiny_scene_write(const char *path)
{
    return write_scene(path, false);
}

bool tiny_scene_write_moving(const char *path)
{
    return write_scene(path, true);
}
