/* Three-component vectors, also used for RGB triples. Values, not pointers: compilers keep them in
 * registers. */
#ifndef PPMI_MATH_VEC_H
#define PPMI_MATH_VEC_H

#include <math.h>
#include <stdbool.h>

#define PPMI_PI 3.14159265358979323846f
#define PPMI_INV_PI 0.31830988618379067154f

/* One instruction each, where fminf and fmaxf are calls because of what they promise for NaN: here
 * the second argument wins when one is not a number. */
static inline float ppmi_min(float a, float b)
{
    return a < b ? a : b;
}

static inline float ppmi_max(float a, float b)
{
    return a > b ? a : b;
}

typedef struct ppmi_vec3 {
    float x, y, z;
} ppmi_vec3;

static inline ppmi_vec3 vec3(float x, float y, float z)
{
    return (ppmi_vec3){x, y, z};
}

static inline ppmi_vec3 vec3_splat(float s)
{
    return (ppmi_vec3){s, s, s};
}

static inline ppmi_vec3 vec3_load(const float *p)
{
    return (ppmi_vec3){p[0], p[1], p[2]};
}

static inline void vec3_store(float *p, ppmi_vec3 v)
{
    p[0] = v.x;
    p[1] = v.y;
    p[2] = v.z;
}

static inline ppmi_vec3 vec3_add(ppmi_vec3 a, ppmi_vec3 b)
{
    return (ppmi_vec3){a.x + b.x, a.y + b.y, a.z + b.z};
}

static inline ppmi_vec3 vec3_sub(ppmi_vec3 a, ppmi_vec3 b)
{
    return (ppmi_vec3){a.x - b.x, a.y - b.y, a.z - b.z};
}

static inline ppmi_vec3 vec3_mul(ppmi_vec3 a, ppmi_vec3 b)
{
    return (ppmi_vec3){a.x * b.x, a.y * b.y, a.z * b.z};
}

static inline ppmi_vec3 vec3_scale(ppmi_vec3 a, float s)
{
    return (ppmi_vec3){a.x * s, a.y * s, a.z * s};
}

/* a + b * s */
static inline ppmi_vec3 vec3_mad(ppmi_vec3 a, ppmi_vec3 b, float s)
{
    return (ppmi_vec3){a.x + b.x * s, a.y + b.y * s, a.z + b.z * s};
}

static inline ppmi_vec3 vec3_neg(ppmi_vec3 a)
{
    return (ppmi_vec3){-a.x, -a.y, -a.z};
}

static inline ppmi_vec3 vec3_lerp(ppmi_vec3 a, ppmi_vec3 b, float t)
{
    return vec3_mad(vec3_scale(a, 1.0f - t), b, t);
}

static inline float vec3_dot(ppmi_vec3 a, ppmi_vec3 b)
{
    return a.x * b.x + a.y * b.y + a.z * b.z;
}

static inline ppmi_vec3 vec3_cross(ppmi_vec3 a, ppmi_vec3 b)
{
    return (ppmi_vec3){a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}

static inline float vec3_length2(ppmi_vec3 a)
{
    return vec3_dot(a, a);
}

static inline float vec3_length(ppmi_vec3 a)
{
    return sqrtf(vec3_length2(a));
}

/* The zero vector stays zero. */
static inline ppmi_vec3 vec3_normalize(ppmi_vec3 a)
{
    const float length = vec3_length(a);
    return length > 0.0f ? vec3_scale(a, 1.0f / length) : a;
}

static inline float vec3_max_component(ppmi_vec3 a)
{
    return ppmi_max(a.x, ppmi_max(a.y, a.z));
}

static inline float vec3_mean(ppmi_vec3 a)
{
    return (a.x + a.y + a.z) * (1.0f / 3.0f);
}

/* Largest absolute value of the components, none of which is NaN. */
static inline float vec3_max_abs(ppmi_vec3 a)
{
    return ppmi_max(fabsf(a.x), ppmi_max(fabsf(a.y), fabsf(a.z)));
}

static inline bool vec3_is_finite(ppmi_vec3 a)
{
    return isfinite(a.x) && isfinite(a.y) && isfinite(a.z);
}

static inline bool vec3_is_black(ppmi_vec3 a)
{
    return !(a.x > 0.0f || a.y > 0.0f || a.z > 0.0f);
}

/* Relative luminance of linear Rec.709. */
static inline float vec3_luminance(ppmi_vec3 c)
{
    return 0.2126f * c.x + 0.7152f * c.y + 0.0722f * c.z;
}

static inline float ppmi_clampf(float x, float low, float high)
{
    return ppmi_min(ppmi_max(x, low), high);
}

static inline float ppmi_sqr(float x)
{
    return x * x;
}

/* An orthonormal basis with n as third axis. */
typedef struct ppmi_frame {
    ppmi_vec3 s, t, n;
} ppmi_frame;

/* The least and the greatest of each component. */
static inline ppmi_vec3 vec3_lower(ppmi_vec3 a, ppmi_vec3 b)
{
    return vec3(ppmi_min(a.x, b.x), ppmi_min(a.y, b.y), ppmi_min(a.z, b.z));
}

static inline ppmi_vec3 vec3_upper(ppmi_vec3 a, ppmi_vec3 b)
{
    return vec3(ppmi_max(a.x, b.x), ppmi_max(a.y, b.y), ppmi_max(a.z, b.z));
}

static inline float vec3_component(ppmi_vec3 v, int axis)
{
    return axis == 0 ? v.x : axis == 1 ? v.y : v.z;
}

/* Duff et al., "Building an Orthonormal Basis, Revisited", JCGT 2017. */
static inline ppmi_frame ppmi_frame_from_normal(ppmi_vec3 n)
{
    const float sign = copysignf(1.0f, n.z);
    const float a = -1.0f / (sign + n.z);
    const float b = n.x * n.y * a;
    return (ppmi_frame){
        .s = {1.0f + sign * n.x * n.x * a, sign * b, -sign * n.x},
        .t = {b, sign + n.y * n.y * a, -n.y},
        .n = n,
    };
}

static inline ppmi_vec3 ppmi_frame_to_local(const ppmi_frame *f, ppmi_vec3 v)
{
    return vec3(vec3_dot(v, f->s), vec3_dot(v, f->t), vec3_dot(v, f->n));
}

static inline ppmi_vec3 ppmi_frame_to_world(const ppmi_frame *f, ppmi_vec3 v)
{
    return vec3_mad(vec3_mad(vec3_scale(f->s, v.x), f->t, v.y), f->n, v.z);
}

#endif
