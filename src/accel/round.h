/* Places on balls and round segments by two numbers.
 *
 * A ball is a segment without a length, along z. u runs along the surface from end to end: on the
 * first cap it is minus the angle from the cap's edge, on the body 0 .. 1, on the last cap 1 plus
 * the angle. v is the angle around the axis, -pi .. pi. In these the normal is exact and the place
 * is on the surface, whatever the length of the ray that found it. Of a ball u is 0 .. at the
 * equator, and the caps are its halves. */
#ifndef PPMI_ACCEL_ROUND_H
#define PPMI_ACCEL_ROUND_H

#include "accel/accel.h"
#include "scene/scene.h"

/* Object space. */
typedef struct ppmi_round_point {
    ppmi_vec3 normal;   /* unit */
    ppmi_vec3 position; /* at the element's radius */
    float along;        /* share of the last end, 0 .. 1 */
} ppmi_round_point;

/* The shape of an element at a time: its ends are the same for points. */
typedef struct ppmi_round {
    ppmi_vec3 first, last;
    ppmi_vec3 axis; /* unit */
    float length, radius;
} ppmi_round;

ppmi_round ppmi_round_of(const ppmi_primitive *primitive, uint32_t element, float time);
float ppmi_round_area(const ppmi_round *round);
ppmi_round_point ppmi_round_at(const ppmi_round *round, float u, float v);

/* A place that is even over the area. */
void ppmi_round_sample(const ppmi_round *round, float u, float v, float *out_u, float *out_v);

/* Replaces hit's u and v by the place; nothing for triangles. normal: Embree's, object space. */
void ppmi_round_place(const ppm_scene *scene, ppmi_vec3 normal, ppmi_hit *hit);

#endif
