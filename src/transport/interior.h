/* The solids that a path is inside of: nested dielectrics.
 *
 * Surfaces say by their geometric normal whether a path enters or leaves; the list only adds what
 * else is there. Of the solids that overlap at a place the one with the highest nested_priority
 * counts (Schmidt and Budge 2002, "Simple Nested Dielectrics in Ray Traced Images"), among equals
 * the one that was entered last: a bubble in ice in water needs no priorities, nor does water that
 * overlaps its glass a little. A material is in the list once: overlapping parts of one material
 * are taken as Cycles takes them, each surface by itself. */
#ifndef PPMI_TRANSPORT_INTERIOR_H
#define PPMI_TRANSPORT_INTERIOR_H

#include "scene/scene.h"

enum { PPMI_INTERIOR_MAX = 6 };

#define PPMI_OUTSIDE UINT32_MAX

typedef struct ppmi_interior {
    uint32_t count;
    uint32_t materials[PPMI_INTERIOR_MAX]; /* indices, the latest last */
} ppmi_interior;

static inline void ppmi_interior_leave(ppmi_interior *interior, uint32_t material)
{
    uint32_t kept = 0;
    for (uint32_t i = 0; i < interior->count; i++) {
        if (interior->materials[i] != material) {
            interior->materials[kept++] = interior->materials[i];
        }
    }
    interior->count = kept;
}

/* When the list is full the oldest is forgotten. */
static inline void ppmi_interior_enter(ppmi_interior *interior, uint32_t material)
{
    ppmi_interior_leave(interior, material);
    if (interior->count == PPMI_INTERIOR_MAX) {
        ppmi_interior_leave(interior, interior->materials[0]);
    }
    interior->materials[interior->count++] = material;
}

static inline bool ppmi_interior_has(const ppmi_interior *interior, uint32_t material)
{
    for (uint32_t i = 0; i < interior->count; i++) {
        if (interior->materials[i] == material) return true;
    }
    return false;
}

/* The material that counts, or PPMI_OUTSIDE. */
static inline uint32_t ppmi_interior_material(const ppmi_interior *interior, const ppm_scene *scene)
{
    uint32_t best = PPMI_OUTSIDE;
    for (uint32_t i = 0; i < interior->count; i++) {
        const uint32_t material = interior->materials[i];
        if (best == PPMI_OUTSIDE || scene->materials[material].desc.nested_priority >=
                                        scene->materials[best].desc.nested_priority) {
            best = material;
        }
    }
    return best;
}

#endif
