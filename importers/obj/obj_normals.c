/* Normals of smoothing groups: the mean of the faces of one group that meet at a vertex, weighted
 * with their angles there (Thuermer, Wuethrich 1998, "Computing vertex normals from polygonal
 * facets"), which does not depend on how the faces are split. */
#include <math.h>

#include "obj/obj_reader.h"

static const float *position_of(const ppmi_obj_reader *r, const ppmi_obj_corner *corner)
{
    return (const float *)r->positions.items + 3 * (size_t)corner->position;
}

void ppmi_obj_face_normal(const ppmi_obj_reader *r, const ppmi_obj_corner *corners, size_t count,
                          double out[3])
{
    const float *origin = position_of(r, &corners[0]); /* keeps the products small */
    out[0] = out[1] = out[2] = 0.0;
    for (size_t i = 1; i + 1 < count; ++i) {
        const float *p = position_of(r, &corners[i]), *q = position_of(r, &corners[i + 1]);
        double a[3], b[3];
        for (int k = 0; k < 3; ++k) {
            a[k] = (double)p[k] - (double)origin[k];
            b[k] = (double)q[k] - (double)origin[k];
        }
        out[0] += a[1] * b[2] - a[2] * b[1];
        out[1] += a[2] * b[0] - a[0] * b[2];
        out[2] += a[0] * b[1] - a[1] * b[0];
    }
}

static double length(const double v[3])
{
    return sqrt(v[0] * v[0] + v[1] * v[1] + v[2] * v[2]);
}

double ppmi_obj_corner_angle(const ppmi_obj_reader *r, const ppmi_obj_corner *corners, size_t count,
                             size_t i)
{
    const float *p = position_of(r, &corners[i]);
    const float *q[2] = {position_of(r, &corners[(i + 1) % count]),
                         position_of(r, &corners[(i + count - 1) % count])};
    double edges[2][3], dot = 0.0;
    for (int k = 0; k < 3; ++k) {
        edges[0][k] = (double)q[0][k] - (double)p[k];
        edges[1][k] = (double)q[1][k] - (double)p[k];
        dot += edges[0][k] * edges[1][k];
    }
    const double lengths = length(edges[0]) * length(edges[1]);
    return lengths > 0.0 ? acos(fmin(fmax(dot / lengths, -1.0), 1.0)) : 0.0;
}

/* Sums at (vertex, group), which become normals behind the file's. */
typedef struct sums {
    ppmi_obj_triples keys;
    ppmi_obj_array vectors; /* 3 doubles each */
} sums;

static bool needs_normal(const ppmi_obj_corner *corners, size_t count)
{
    for (size_t i = 0; i < count; ++i) {
        if (corners[i].normal < 0) return true;
    }
    return false;
}

/* Adds a face to the sums of its corners without a normal. */
static bool add_face(ppmi_obj_reader *r, sums *s, ppmi_obj_corner *corners, size_t count,
                     uint32_t group)
{
    double normal[3];
    ppmi_obj_face_normal(r, corners, count, normal);
    const double size = length(normal);
    for (size_t i = 0; i < count; ++i) {
        uint32_t index;
        if (corners[i].normal >= 0) continue;
        const ppmi_obj_triple key = {corners[i].position, (int32_t)group, 0};
        if (!ppmi_obj_triples_add(r->context, &s->keys, key, &index)) return false;
        if (index == s->vectors.count) {
            double *zero = ppmi_obj_push(r->context, &s->vectors, 1, 3 * sizeof *zero);
            if (!zero) return false;
            zero[0] = zero[1] = zero[2] = 0.0;
        }
        if (index >= INT32_MAX - r->normals.count) return false;
        corners[i].normal = (int32_t)(r->normals.count + index);
        const double weight = size > 0.0 ? ppmi_obj_corner_angle(r, corners, count, i) / size : 0.0;
        double *sum = (double *)s->vectors.items + 3 * (size_t)index;
        for (int k = 0; k < 3 && isfinite(weight * size); ++k) {
            sum[k] += weight * normal[k];
        }
    }
    return true;
}

static bool add_run(ppmi_obj_reader *r, sums *s, const ppmi_obj_run *run)
{
    const uint32_t *faces = r->faces.items;
    ppmi_obj_corner *corners = (ppmi_obj_corner *)r->corners.items + run->first_corner;
    for (size_t i = run->first_face; i < run->end_face; ++i) {
        if (needs_normal(corners, faces[i]) && !add_face(r, s, corners, faces[i], run->smoothing)) {
            return false;
        }
        corners += faces[i];
    }
    return true;
}

bool ppmi_obj_append_normals(ppmi_obj_reader *r, const double *vectors, size_t count)
{
    if (count == 0) return true;
    float *normals = ppmi_obj_push(r->context, &r->normals, count, 3 * sizeof *normals);
    if (!normals) return false;
    for (size_t i = 0; i < count; ++i) {
        const double size = length(vectors + 3 * i);
        for (size_t k = 0; k < 3; ++k) {
            normals[3 * i + k] = (float)(size > 0.0 ? vectors[3 * i + k] / size : 0.0);
        }
    }
    return true;
}

ppm_status ppmi_obj_smooth_normals(ppmi_obj_reader *r)
{
    sums s = {0};
    bool ok = true;
    const ppmi_obj_run *runs = r->runs.items;
    for (size_t i = 0; i < r->runs.count && ok; ++i) {
        const bool is_smooth = runs[i].kind == PPM_PRIMITIVE_TRIANGLES && runs[i].smoothing != 0;
        if (is_smooth) ok = add_run(r, &s, &runs[i]);
    }
    ok = ok && ppmi_obj_append_normals(r, s.vectors.items, s.vectors.count);
    ppmi_obj_triples_deinit(r->context, &s.keys);
    ppmi_obj_array_deinit(r->context, &s.vectors);
    return ok ? PPM_STATUS_OK : ppmi_obj_out_of_memory(r);
}
