/* Ray tracing: one Embree scene per mesh, instanced. The only folder that sees Embree. */
#ifndef PPMI_ACCEL_H
#define PPMI_ACCEL_H

#include <stdint.h>

#include "base/context.h"
#include "math/vec.h"
#include "ppm/scene.h"

typedef struct ppmi_accel ppmi_accel;

typedef struct ppmi_ray {
    ppmi_vec3 origin;
    float t_max; /* in lengths of direction; INFINITY is fine */
    ppmi_vec3 direction;
    float time; /* within the shutter, 0 .. 1 */
} ppmi_ray;

typedef struct ppmi_hit {
    uint32_t instance, primitive, triangle; /* indices into scene, its mesh, its triangles or other
                                               elements */
    float u, v; /* weights of the triangle's second and third vertex; of points and lines: the
                   place (accel/round.h) */
    float t;
    float time; /* the ray's */
} ppmi_hit;

/* Builds the acceleration structures of a frozen scene, which must outlive the result. Those of
 * meshes stay with the scene, and serve until their vertices change. The build uses all cores; what
 * it gives does not depend on the threads of a render. Returns OK, OUT_OF_MEMORY, INTERNAL. */
ppm_status ppmi_accel_create(ppm_context *context, ppm_scene *scene, ppmi_accel **out_accel);
void ppmi_accel_destroy(ppmi_accel *accel);

/* Structures of meshes that have been built for this scene so far. */
uint64_t ppmi_accel_builds(const ppm_scene *scene);

/* The closest hit in (0, t_max); false when there is none. Any thread. */
bool ppmi_accel_intersect(const ppmi_accel *accel, const ppmi_ray *ray, ppmi_hit *out_hit);

/* Which hits a ray passes. It is asked of hits in any order, of some that lie behind the closest
 * one, and perhaps of one twice; what it answers must depend on the hit only. All within one
 * search: no ray is begun anew behind what it passed, so that nothing is jumped over however close,
 * and any number is passed. Base of what the caller needs beside it. */
typedef struct ppmi_hit_filter {
    bool (*passes)(struct ppmi_hit_filter *filter, const ppmi_hit *hit);
} ppmi_hit_filter;

/* The closest hit that the filter does not pass, in (0, t_max); false when there is none. */
bool ppmi_accel_intersect_filtered(const ppmi_accel *accel, const ppmi_ray *ray,
                                   ppmi_hit_filter *filter, ppmi_hit *out_hit);

/* Whether there is any hit in (0, t_max) that the filter does not pass. If not it has been asked of
 * all that are in the way. */
bool ppmi_accel_occluded_filtered(const ppmi_accel *accel, const ppmi_ray *ray,
                                  ppmi_hit_filter *filter);

/* All hits in (0, t_max), at most max of them, nearest first; a triangle may be among them twice.
 * Returns their number. Where more are in the way, which of them are found is not said. Any thread.
 */
uint32_t ppmi_accel_intersect_all(const ppmi_accel *accel, const ppmi_ray *ray, ppmi_hit *out_hits,
                                  uint32_t max);

/* Whether anything is in (0, t_max). Any thread. */
bool ppmi_accel_occluded(const ppmi_accel *accel, const ppmi_ray *ray);

/* A triangle that lies near a place: world space, counter-clockwise from its front. */
typedef struct ppmi_near_triangle {
    ppmi_vec3 corners[3];
    uint32_t instance, primitive, element;
} ppmi_near_triangle;

/* Is shown one triangle after the other, in no order that is said; false ends the search. */
typedef bool (*ppmi_near_visit)(void *user, const ppmi_near_triangle *triangle);

/* Shows all triangles that a ball around p touches at a time within the shutter, and some that it
 * nearly does; not those of clear glass, and no balls and round segments. Any thread. */
void ppmi_accel_nearby(const ppmi_accel *accel, ppmi_vec3 p, float radius, float time,
                       ppmi_near_visit visit, void *user);

/* "Embree 3.13.5": the version compiled against. Static. */
const char *ppmi_accel_version(void);

#endif
