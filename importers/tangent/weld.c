/* Welding by a hash table with open addressing, in the order of the vertices. Values are compared
 * as numbers, so that 0 and -0 are the same. */
#include "tangent/weld.h"

#include <string.h>

#define EMPTY UINT32_MAX

typedef struct vertex_key {
    float values[8];
} vertex_key;

static vertex_key key_of(const ppmi_tangent_mesh *mesh, uint32_t vertex)
{
    vertex_key key;
    memcpy(key.values, mesh->positions + 3 * (size_t)vertex, 3 * sizeof(float));
    memcpy(key.values + 3, mesh->normals + 3 * (size_t)vertex, 3 * sizeof(float));
    memcpy(key.values + 6, mesh->uvs + 2 * (size_t)vertex, 2 * sizeof(float));
    for (int i = 0; i < 8; ++i) {
        key.values[i] += 0.0f; /* -0 becomes 0 */
    }
    return key;
}

/* A multiplicative mix of the bits, finished as in MurmurHash3. */
static uint64_t hash(const vertex_key *key)
{
    uint64_t h = 0;
    for (int i = 0; i < 8; i += 2) {
        uint64_t pair;
        memcpy(&pair, key->values + i, sizeof pair);
        h = (h ^ pair) * 0x9e3779b97f4a7c15u;
        h ^= h >> 32;
    }
    h *= 0xff51afd7ed558ccdu;
    return h ^ h >> 33;
}

bool ppmi_tangent_weld(ppm_context *context, const ppmi_tangent_mesh *mesh, uint32_t *out)
{
    size_t size = 16;
    while (size < 2 * (size_t)mesh->vertex_count) {
        size *= 2;
    }
    uint32_t *table = ppmi_alloc(context, size, sizeof *table);
    if (!table) return false;
    memset(table, 0xff, size * sizeof *table); /* EMPTY */
    for (uint32_t v = 0; v < mesh->vertex_count; ++v) {
        const vertex_key key = key_of(mesh, v);
        size_t slot = hash(&key) & (size - 1);
        for (; table[slot] != EMPTY; slot = (slot + 1) & (size - 1)) {
            const vertex_key other = key_of(mesh, table[slot]);
            if (memcmp(&key, &other, sizeof key) == 0) break;
        }
        if (table[slot] == EMPTY) table[slot] = v;
        out[v] = table[slot];
    }
    ppmi_free(context, table);
    return true;
}
