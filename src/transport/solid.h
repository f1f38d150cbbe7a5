/* Crossing the surface of a solid: which indices lie on its two sides. */
#ifndef PPMI_TRANSPORT_SOLID_H
#define PPMI_TRANSPORT_SOLID_H

#include "transport/world.h"

/* At a hit of a solid by a ray along direction: corrects walker->interior to what the surface says
 * lies before it, fills in vertex->behind, and takes in other surfaces at the same place. Returns
 * false where both sides are the same to light (inside of a solid that counts for more): the ray
 * goes on with vertex->behind. */
bool ppmi_solid_arrive(ppmi_walker *walker, ppmi_vec3 direction, ppmi_vertex *vertex);

/* The index ratio for the path, once it is known that the vertex stops it. Draws a wavelength where
 * the solids disperse. */
void ppmi_solid_refract(ppmi_walker *walker, ppmi_vec3 direction, ppmi_vertex *vertex);

/* The solids around a point, for what begins there: a camera under water. Looked for upwards, since
 * an open sheet of water has its inside below. */
ppmi_interior ppmi_solids_around_at(const ppmi_world *world, ppmi_vec3 position, float time);

/* The solids that a photon begins in; far: from infinitely far, where there is none. The last
 * answer is kept in memory: photons of a lamp without size ask once. */
typedef struct ppmi_solids_memory {
    bool is_known;
    ppmi_vec3 position;
    float time;
    ppmi_interior interior;
} ppmi_solids_memory;
ppmi_interior ppmi_solids_around_photon(const ppmi_world *world, const ppmi_ray *ray, bool is_far,
                                        ppmi_solids_memory *memory);

/* The same as the shutter opens. */
static inline ppmi_interior ppmi_solids_around(const ppmi_world *world, ppmi_vec3 position)
{
    return ppmi_solids_around_at(world, position, 0.0f);
}

#endif
