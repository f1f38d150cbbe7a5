/* Rays towards targets. */
#include "light/target.h"

typedef struct double3 {
    double x, y, z;
} double3;

static inline double3 to_double(ppmi_vec3 v)
{
    return (double3){(double)v.x, (double)v.y, (double)v.z};
}

static inline double3 scaled_down(double3 v, ppmi_vec3 half)
{
    return (double3){v.x / (double)half.x, v.y / (double)half.y, v.z / (double)half.z};
}

static inline double3 scaled_up(double3 v, ppmi_vec3 half)
{
    return (double3){v.x * (double)half.x, v.y * (double)half.y, v.z * (double)half.z};
}

static inline double3 difference(ppmi_vec3 a, ppmi_vec3 b)
{
    return (double3){(double)a.x - (double)b.x, (double)a.y - (double)b.y,
                     (double)a.z - (double)b.z};
}

static inline double dot(double3 a, double3 b)
{
    return a.x * b.x + a.y * b.y + a.z * b.z;
}

static inline double3 mad(double3 a, double3 b, double s)
{
    return (double3){a.x + b.x * s, a.y + b.y * s, a.z + b.z * s};
}

static inline ppmi_vec3 to_float(double3 v)
{
    return vec3((float)v.x, (float)v.y, (float)v.z);
}

static inline ppmi_vec3 unit_float(double3 v)
{
    const double scale = 1.0 / sqrt(dot(v, v));
    return to_float((double3){v.x * scale, v.y * scale, v.z * scale});
}

static inline double volume_of(const ppmi_target *target)
{
    return (double)target->half.x * (double)target->half.y * (double)target->half.z;
}

bool ppmi_target_is_met(const ppmi_target *target, ppmi_vec3 origin, ppmi_vec3 direction)
{
    const double3 o = scaled_down(difference(origin, target->center), target->half);
    const double3 d = scaled_down(to_double(direction), target->half);
    const double along = dot(o, d), past = dot(o, o);
    if (past <= 1.0) return true;
    if (along >= 0.0) return false;
    const double3 foot = mad(o, d, -along / dot(d, d)); /* no difference of large squares */
    return dot(foot, foot) <= 1.0;
}

/* The shadow of the unit ball is pi; scaling changes areas across lines by the volume's factor over
 * that of lengths along them. */
double ppmi_target_shadow(const ppmi_target *target, ppmi_vec3 direction)
{
    const double3 d = scaled_down(to_double(direction), target->half);
    return (double)PPMI_PI * volume_of(target) * sqrt(dot(d, d));
}

/* Where a line enters the box or ball of the extent: *out_t from o, which is relative to its
 * centre. */
static bool enter(const ppmi_light_extent *extent, double3 o, double3 d, double *out_t)
{
    if (extent->is_ball) {
        const double along = dot(o, d);
        const double3 foot = mad(o, d, -along);
        const double left = (double)extent->radius * (double)extent->radius - dot(foot, foot);
        *out_t = -along - sqrt(left > 0.0 ? left : 0.0);
        return left > 0.0;
    }
    const double from[3] = {o.x, o.y, o.z}, along[3] = {d.x, d.y, d.z};
    const double half[3] = {(double)extent->half.x, (double)extent->half.y, (double)extent->half.z};
    double first = -INFINITY, last = INFINITY;
    for (int k = 0; k < 3; k++) {
        if (along[k] == 0.0) {
            if (fabs(from[k]) > half[k]) return false;
            continue;
        }
        const double a = (-half[k] - from[k]) / along[k], b = (half[k] - from[k]) / along[k];
        first = fmax(first, fmin(a, b));
        last = fmin(last, fmax(a, b));
    }
    *out_t = first;
    return first < last;
}

bool ppmi_target_far_ray(const ppmi_target *target, const ppmi_light_extent *extent,
                         ppmi_vec3 direction, float u, float v, ppmi_ray *out_ray)
{
    const double3 d = to_double(direction);
    const ppmi_frame frame = ppmi_frame_from_normal(unit_float(scaled_down(d, target->half)));
    const ppmi_vec2 disk = ppmi_sample_disk(u, v);
    const ppmi_vec3 across = ppmi_frame_to_world(&frame, vec3(disk.x, disk.y, 0.0f));
    const double3 offset = scaled_up(to_double(across), target->half);
    const double3 from_middle = mad(difference(target->center, extent->center), offset, 1.0);
    double t;
    if (!enter(extent, from_middle, d, &t)) return false;
    const double3 start = mad(mad(to_double(target->center), offset, 1.0), d, t);
    *out_ray = (ppmi_ray){.origin = to_float(start), .t_max = INFINITY, .direction = direction};
    return true;
}

ppmi_target_cone ppmi_target_cone_from(const ppmi_target *target, ppmi_vec3 position)
{
    const double margin = 1.05;
    const double3 o = scaled_down(difference(target->center, position), target->half);
    const double distance2 = dot(o, o);
    ppmi_target_cone cone = {.volume = volume_of(target), .solid_angle = 4.0 * (double)PPMI_PI};
    if (!(distance2 > margin)) return cone;
    const double sine2 = 1.0 / distance2;
    cone.height = sine2 / (1.0 + sqrt(1.0 - sine2));
    cone.axis = unit_float(o);
    const double3 axis = scaled_up(to_double(cone.axis), target->half);
    const double length2 = dot(axis, axis);
    cone.solid_angle = fmin(cone.solid_angle, 2.0 * (double)PPMI_PI * cone.height * cone.volume /
                                                  (length2 * sqrt(length2)));
    return cone;
}

ppmi_vec3 ppmi_target_cone_sample(const ppmi_target *target, const ppmi_target_cone *cone, float u,
                                  float v, float *out_inverse_pdf)
{
    const ppmi_frame frame = ppmi_frame_from_normal(cone->axis);
    const ppmi_vec3 local = ppmi_sample_cap((float)cone->height, u, v);
    const double3 way =
        scaled_up(to_double(vec3_normalize(ppmi_frame_to_world(&frame, local))), target->half);
    const double length2 = dot(way, way);
    *out_inverse_pdf =
        (float)(2.0 * (double)PPMI_PI * cone->height * cone->volume / (length2 * sqrt(length2)));
    return unit_float(way);
}

/* How far b reaches at most in a space where a target around center with semi-axes half is the unit
 * ball: as the ball or as the box around it there, whichever is smaller. */
static double reach(const ppmi_target *b, ppmi_vec3 center, ppmi_vec3 half)
{
    const double3 o = scaled_down(difference(b->center, center), half);
    const double3 size = scaled_down(to_double(b->half), half);
    const double as_ball = sqrt(dot(o, o)) + fmax(size.x, fmax(size.y, size.z));
    const double3 corner = {fabs(o.x) + size.x, fabs(o.y) + size.y, fabs(o.z) + size.z};
    return fmin(as_ball, sqrt(dot(corner, corner)));
}

/* Their box's ellipsoid, enlarged until it holds them. No axis is so short that the scaled space
 * would have no digits left. */
ppmi_target ppmi_target_around(const ppmi_target *targets, uint32_t count)
{
    const float flattest = 0.02f;
    ppmi_vec3 low = vec3_splat(INFINITY), high = vec3_splat(-INFINITY);
    for (uint32_t i = 0; i < count; i++) {
        low = vec3_lower(low, vec3_sub(targets[i].center, targets[i].half));
        high = vec3_upper(high, vec3_add(targets[i].center, targets[i].half));
    }
    ppmi_target all = {.center = vec3_scale(vec3_add(low, high), 0.5f),
                       .half = vec3_scale(vec3_sub(high, low), 0.5f)};
    all.half = vec3_upper(all.half, vec3_splat(flattest * vec3_max_component(all.half)));
    double scale = 0.0;
    for (uint32_t i = 0; i < count; i++)
        scale = fmax(scale, reach(&targets[i], all.center, all.half));
    all.half = vec3_scale(all.half, (float)scale);
    return all;
}
