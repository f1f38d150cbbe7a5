/* Affine transforms: a 3x4 matrix by columns. */
#ifndef PPMI_MATH_TRANSFORM_H
#define PPMI_MATH_TRANSFORM_H

#include "math/vec.h"

/* p -> x * p.x + y * p.y + z * p.z + origin */
typedef struct ppmi_transform {
    ppmi_vec3 x, y, z, origin;
} ppmi_transform;

/* From the public form: 16 floats, column-major. */
static inline ppmi_transform ppmi_transform_load(const float m[16])
{
    return (ppmi_transform){vec3_load(m), vec3_load(m + 4), vec3_load(m + 8), vec3_load(m + 12)};
}

static inline ppmi_vec3 ppmi_transform_vector(const ppmi_transform *m, ppmi_vec3 v)
{
    return vec3_mad(vec3_mad(vec3_scale(m->x, v.x), m->y, v.y), m->z, v.z);
}

static inline ppmi_vec3 ppmi_transform_point(const ppmi_transform *m, ppmi_vec3 p)
{
    return vec3_add(ppmi_transform_vector(m, p), m->origin);
}

/* Volume factor; negative for mirrored transforms. */
static inline float ppmi_transform_determinant(const ppmi_transform *m)
{
    return vec3_dot(m->x, vec3_cross(m->y, m->z));
}

/* The cofactor matrix, which is the inverse transpose times the determinant: takes normals to
 * normals up to length, and for mirrored transforms up to sign. */
static inline ppmi_transform ppmi_transform_cofactors(const ppmi_transform *m)
{
    return (ppmi_transform){
        vec3_cross(m->y, m->z), vec3_cross(m->z, m->x), vec3_cross(m->x, m->y), {0.0f, 0.0f, 0.0f}};
}

/* Takes normals to normals, up to length, on the side of the mesh's front for mirrored transforms
 * too. Scaled to unit size, so that tiny and huge scales neither underflow nor overflow. */
static inline ppmi_transform ppmi_transform_normals(const ppmi_transform *to_world)
{
    ppmi_transform m = ppmi_transform_cofactors(to_world);
    const float size = ppmi_max(vec3_max_abs(m.x), ppmi_max(vec3_max_abs(m.y), vec3_max_abs(m.z)));
    const float scale = copysignf(1.0f / size, ppmi_transform_determinant(to_world));
    m.x = vec3_scale(m.x, scale);
    m.y = vec3_scale(m.y, scale);
    m.z = vec3_scale(m.z, scale);
    return m;
}

/* a where share is 0, b where it is 1. */
static inline ppmi_transform ppmi_transform_lerp(const ppmi_transform *a, const ppmi_transform *b,
                                                 float share)
{
    return (ppmi_transform){vec3_lerp(a->x, b->x, share), vec3_lerp(a->y, b->y, share),
                            vec3_lerp(a->z, b->z, share), vec3_lerp(a->origin, b->origin, share)};
}

static inline bool ppmi_transform_is_finite(const ppmi_transform *m)
{
    return vec3_is_finite(m->x) && vec3_is_finite(m->y) && vec3_is_finite(m->z) &&
           vec3_is_finite(m->origin);
}

#endif
