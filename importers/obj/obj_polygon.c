/* Polygons to triangles: a fan where that is right, else ear clipping (Meisters 1975, "Polygons
 * have ears"; Eberly, "Triangulation by Ear Clipping", for the rules about reflex corners only and
 * about corners that coincide, which polygons with a bridge to a hole have). */
#include "obj/obj_polygon.h"

#include <math.h>
#include <string.h>

/* Ear clipping looks at about the square of the corners, at worst at their cube. Beyond this sum
 * over a file, some seconds, ears are cut without looking. */
static const uint64_t max_tests = 4000000000u;

void ppmi_obj_polygon_deinit(ppm_context *context, ppmi_obj_polygon_workspace *w)
{
    ppmi_free(context, w->xy);
    ppmi_free(context, w->next);
    ppmi_free(context, w->prev);
    *w = (ppmi_obj_polygon_workspace){0};
}

static bool reserve(ppm_context *context, ppmi_obj_polygon_workspace *w, uint32_t count)
{
    if (count <= w->capacity) return true;
    const ppmi_obj_polygon_workspace old = *w;
    ppmi_obj_polygon_deinit(context, w);
    w->tests = old.tests;
    w->forced = old.forced;
    const size_t capacity = 2 * (size_t)count;
    w->xy = ppmi_alloc(context, capacity, 2 * sizeof *w->xy);
    w->next = ppmi_alloc(context, capacity, sizeof *w->next);
    w->prev = ppmi_alloc(context, capacity, sizeof *w->prev);
    if (!w->xy || !w->next || !w->prev) return false;
    w->capacity = capacity;
    return true;
}

/* Drops the axis along which the normal is longest; what is left keeps the winding. */
static void project(ppmi_obj_polygon_workspace *w, const float *positions,
                    const ppmi_obj_corner *corners, uint32_t count, const double normal[3])
{
    int axis = 2;
    for (int i = 0; i < 2; ++i) {
        if (fabs(normal[i]) > fabs(normal[axis])) axis = i;
    }
    const bool is_flipped = normal[axis] < 0.0;
    const int x = (axis + (is_flipped ? 2 : 1)) % 3, y = (axis + (is_flipped ? 1 : 2)) % 3;
    for (uint32_t i = 0; i < count; ++i) {
        const float *p = positions + 3 * (size_t)corners[i].position;
        w->xy[2 * i] = (double)p[x];
        w->xy[2 * i + 1] = (double)p[y];
    }
}

/* Twice the signed area: positive when a, b, c turn left. */
static double area2(const ppmi_obj_polygon_workspace *w, uint32_t a, uint32_t b, uint32_t c)
{
    const double *p = w->xy + 2 * (size_t)a, *q = w->xy + 2 * (size_t)b, *r = w->xy + 2 * (size_t)c;
    return (q[0] - p[0]) * (r[1] - p[1]) - (q[1] - p[1]) * (r[0] - p[0]);
}

/* For a polygon that does not cross itself, a fan without a reversed triangle covers it once: the
 * triangles' signed areas are the winding number, which is 1 inside. */
static bool is_fan(const ppmi_obj_polygon_workspace *w, uint32_t count)
{
    for (uint32_t i = 1; i + 1 < count; ++i) {
        if (!(area2(w, 0, i, i + 1) >= 0.0)) return false;
    }
    return true;
}

static void write_fan(uint32_t count, uint32_t *out)
{
    for (uint32_t i = 1; i + 1 < count; ++i) {
        *out++ = 0;
        *out++ = i;
        *out++ = i + 1;
    }
}

/* ---- ear clipping ---------------------------------------------------------------------------- */

static bool is_same_place(const ppmi_obj_polygon_workspace *w, uint32_t a, uint32_t b)
{
    return memcmp(w->xy + 2 * (size_t)a, w->xy + 2 * (size_t)b, 2 * sizeof *w->xy) == 0;
}

static bool is_reflex(const ppmi_obj_polygon_workspace *w, uint32_t i)
{
    return area2(w, w->prev[i], i, w->next[i]) < 0.0;
}

/* Whether the corner can be cut off: convex, and no reflex corner in the triangle. */
static bool is_ear(ppmi_obj_polygon_workspace *w, uint32_t b)
{
    const uint32_t a = w->prev[b], c = w->next[b];
    const double area = area2(w, a, b, c);
    if (area == 0.0) return true; /* a straight corner: a triangle of no area */
    if (area < 0.0) return false;
    for (uint32_t p = w->next[c]; p != a; p = w->next[p]) {
        w->tests++;
        const bool is_inside =
            area2(w, a, b, p) >= 0.0 && area2(w, b, c, p) >= 0.0 && area2(w, c, a, p) >= 0.0;
        if (is_inside && is_reflex(w, p) && !is_same_place(w, p, a) && !is_same_place(w, p, b) &&
            !is_same_place(w, p, c)) {
            return false;
        }
    }
    return true;
}

static void make_ring(ppmi_obj_polygon_workspace *w, uint32_t count)
{
    for (uint32_t i = 0; i < count; ++i) {
        w->next[i] = i + 1 < count ? i + 1 : 0;
        w->prev[i] = i > 0 ? i - 1 : count - 1;
    }
}

/* A polygon that crosses itself may have no ear: then the next convex corner is cut all the same,
 * else any. */
static void clip_ears(ppmi_obj_polygon_workspace *w, uint32_t count, uint32_t *out)
{
    uint32_t at = 0, misses = 0;
    bool is_forced = false;
    make_ring(w, count);
    for (uint32_t left = count; left >= 3;) {
        const bool is_cut = misses < left && w->tests < max_tests
                                ? is_ear(w, at)
                                : !is_reflex(w, at) || misses >= 2 * left;
        is_forced = is_forced || (is_cut && (misses >= left || w->tests >= max_tests));
        if (is_cut) {
            *out++ = w->prev[at];
            *out++ = at;
            *out++ = w->next[at];
            w->next[w->prev[at]] = w->next[at];
            w->prev[w->next[at]] = w->prev[at];
            --left;
        }
        misses = is_cut ? 0 : misses + 1;
        at = w->next[at];
    }
    w->forced += is_forced;
}

bool ppmi_obj_triangulate(ppm_context *context, ppmi_obj_polygon_workspace *w,
                          const float *positions, const ppmi_obj_corner *corners, uint32_t count,
                          const double normal[3], uint32_t *out)
{
    const bool has_plane = normal[0] != 0.0 || normal[1] != 0.0 || normal[2] != 0.0;
    if (count > 3 && has_plane && isfinite(normal[0] + normal[1] + normal[2])) {
        if (!reserve(context, w, count)) return false;
        project(w, positions, corners, count, normal);
        if (!is_fan(w, count)) {
            clip_ears(w, count, out);
            return true;
        }
    }
    write_fan(count, out);
    return true;
}
