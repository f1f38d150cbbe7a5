/* The part of a disk that lies on the surface around a visible point and is open to it.
 *
 * A photon counts at a point if it lies in this region, and what the photons bring is divided by
 * the region's measure: both by the same rules, so that even light gives its right value on thin
 * wires, in corners and at edges with any radius.
 *
 * Seen along the point's normal, the region is the part of the disk that is nearer, sector by
 * sector, than anything that rises through a low plane above the point (a wall); and in it all
 * triangles near the tangent plane that face the same way. Distances are those in the tangent
 * plane. */
#ifndef PPMI_PHOTON_REGION_H
#define PPMI_PHOTON_REGION_H

#include "accel/accel.h"
#include "photon/point.h"

/* Walls are what rises through this height, and nothing above it counts; in radii. */
#define PPMI_REGION_ABOVE 0.1f
/* Nothing further below the tangent plane counts; in radii. */
#define PPMI_REGION_BELOW 0.3f
/* Cosine between normals that face the same way. */
#define PPMI_REGION_COSINE 0.7f

enum { PPMI_REGION_SECTORS = 16, PPMI_REGION_TRIANGLES = 256 };

/* In the frame of the point, in radii. */
typedef struct ppmi_region_triangle {
    double x[3], y[3], z[3];
    uint64_t key;  /* where it stands in the scene */
    bool is_front; /* its winding's front faces up */
    bool counts;   /* photons on it do */
} ppmi_region_triangle;

typedef struct ppmi_gather_region {
    float radius;    /* of the disk: less than what was asked for in a crowd of triangles */
    float share;     /* kernel-weighted measure of the region by that of a whole disk */
    bool is_whole;   /* every photon of the disk near the plane is in the region */
    bool is_bounded; /* some limit is below 1 */
    bool is_known;   /* the surface that the point is on was found */
    bool is_layered; /* photons have to be told by the triangles that they lie on */
    ppmi_vec3 center;
    ppmi_vec3 s, t, n;                 /* frame: n is the point's geometric normal */
    float limits[PPMI_REGION_SECTORS]; /* in radii, by angle from s */
    uint32_t count;
    ppmi_region_triangle triangles[PPMI_REGION_TRIANGLES];
} ppmi_gather_region;

/* A disk in which one plane lies and nothing else is near: disks within it need no search. Zero it
 * to begin with. It serves one scene, in which nothing moves. */
typedef struct ppmi_plain_disk {
    ppmi_vec3 center, normal;
    float radius; /* 0: none is known */
    float failed; /* radius of one that was not plain; 0: none yet */
} ppmi_plain_disk;

/* The region around a point on a surface, at a time within the shutter. known: what was learnt at
 * points close by before, or NULL; it changes nothing but the time this takes. */
void ppmi_region_find(const ppmi_accel *accel, const ppmi_visible_point *point, float radius,
                      float time, ppmi_plain_disk *known, ppmi_gather_region *region);

/* Whether a place that is in the disk and near the tangent plane is in the region. */
bool ppmi_region_holds(const ppmi_gather_region *region, ppmi_vec3 place);

#endif
