/* MikkTSpace: see tangent.h. The work is done vertex by vertex, since groups never reach beyond the
 * triangles around one; so it is parallel, and its result does not depend on the threads. */
#include "tangent/tangent.h"

#include <float.h>
#include <math.h>
#include <string.h>

#include "tangent/fan.h"
#include "tangent/weld.h"

#define NONE UINT32_MAX

typedef struct vec {
    float x, y, z;
} vec;

static vec load(const float *p)
{
    return (vec){p[0], p[1], p[2]};
}

static vec sub(vec a, vec b)
{
    return (vec){a.x - b.x, a.y - b.y, a.z - b.z};
}

static vec mad(vec a, vec b, float s) /* a + s b */
{
    return (vec){a.x + s * b.x, a.y + s * b.y, a.z + s * b.z};
}

static float dot(vec a, vec b)
{
    return a.x * b.x + a.y * b.y + a.z * b.z;
}

/* Zero for what has no direction. */
static vec normalize(vec a)
{
    const float length = sqrtf(dot(a, a));
    const vec zero = {0.0f, 0.0f, 0.0f};
    return length > FLT_MIN && isfinite(length) ? mad(zero, a, 1.0f / length) : zero;
}

/* The part of a in the plane of unit n, of unit length. */
static vec project(vec a, vec n)
{
    return normalize(mad(a, n, -dot(n, a)));
}

/* ---- the mesh by vertices -------------------------------------------------------------------- */

/* Corner 3 t + i is triangle t's i-th. Those of welded vertex v are corners[begin[v]] up to
 * corners[begin[v + 1]], in the order of their triangles. */
typedef struct topology {
    const ppmi_tangent_mesh *mesh;
    ppm_context *context;
    uint32_t *welded;      /* by vertex */
    size_t *begin;         /* by vertex, one more */
    uint32_t *corners;     /* without those of triangles that have no area */
    uint32_t *group;       /* by corner: first its number in the fan, then among all */
    uint32_t *first_group; /* by vertex, one more: of its fan */
    uint32_t largest;      /* fan, in corners */
} topology;

static uint32_t vertex_of(const topology *t, size_t corner)
{
    return t->welded[t->mesh->indices[corner]];
}

static bool is_same_place(const ppmi_tangent_mesh *mesh, uint32_t a, uint32_t b)
{
    const float *p = mesh->positions + 3 * (size_t)a, *q = mesh->positions + 3 * (size_t)b;
    return p[0] == q[0] && p[1] == q[1] && p[2] == q[2];
}

/* Two corners in one place: the triangle has no angles to weigh by, and no neighbours. */
static bool is_degenerate(const topology *t, size_t triangle)
{
    const uint32_t *i = t->mesh->indices + 3 * triangle;
    return is_same_place(t->mesh, i[0], i[1]) || is_same_place(t->mesh, i[1], i[2]) ||
           is_same_place(t->mesh, i[2], i[0]);
}

static void sort_corners(topology *t)
{
    const uint32_t vertices = t->mesh->vertex_count;
    for (size_t i = 0; i < t->mesh->triangle_count; ++i) {
        if (is_degenerate(t, i)) continue;
        for (size_t k = 0; k < 3; ++k) {
            t->begin[vertex_of(t, 3 * i + k) + 1]++;
        }
    }
    for (uint32_t v = 0; v < vertices; ++v) {
        const size_t count = t->begin[v + 1];
        if (count > t->largest) t->largest = (uint32_t)count;
        t->begin[v + 1] += t->begin[v];
    }
    /* begin[v] moves to its end while corners are filled in, and is the beginning of the next */
    for (size_t i = 0; i < t->mesh->triangle_count; ++i) {
        if (is_degenerate(t, i)) continue;
        for (size_t k = 0; k < 3; ++k) {
            t->corners[t->begin[vertex_of(t, 3 * i + k)]++] = (uint32_t)(3 * i + k);
        }
    }
    memmove(t->begin + 1, t->begin, vertices * sizeof *t->begin);
    t->begin[0] = 0;
}

/* ---- one triangle ---------------------------------------------------------------------------- */

/* Differences of positions and coordinates along two sides. */
typedef struct sides {
    vec d1, d2;
    float u1, u2, v1, v2;
    float area; /* twice that in the coordinates, with its sign */
} sides;

static sides find_sides(const ppmi_tangent_mesh *mesh, size_t triangle)
{
    const uint32_t *i = mesh->indices + 3 * triangle;
    const float *a = mesh->uvs + 2 * (size_t)i[0], *b = mesh->uvs + 2 * (size_t)i[1];
    const float *c = mesh->uvs + 2 * (size_t)i[2];
    const vec p = load(mesh->positions + 3 * (size_t)i[0]);
    const float up = mesh->v_runs_down ? -1.0f : 1.0f;
    sides s = {.d1 = sub(load(mesh->positions + 3 * (size_t)i[1]), p),
               .d2 = sub(load(mesh->positions + 3 * (size_t)i[2]), p),
               .u1 = b[0] - a[0],
               .u2 = c[0] - a[0],
               .v1 = up * (b[1] - a[1]),
               .v2 = up * (c[1] - a[1])};
    s.area = s.u1 * s.v2 - s.v1 * s.u2;
    return s;
}

/* The direction of growing u, of unit length (equation of chapter 2.1, without its factor). */
static vec u_direction(const sides *s)
{
    const vec zero = {0.0f, 0.0f, 0.0f};
    const float sign = s->area < 0.0f ? -1.0f : 1.0f;
    return normalize(mad(mad(zero, s->d1, sign * s->v2), s->d2, -sign * s->v1));
}

static uint8_t turn_of(const sides *s)
{
    const vec u = u_direction(s);
    if (!(fabsf(s->area) > FLT_MIN) || !isfinite(s->area) || !(dot(u, u) > 0.0f)) {
        return PPMI_TANGENT_ANY;
    }
    return s->area > 0.0f ? PPMI_TANGENT_POSITIVE : PPMI_TANGENT_NEGATIVE;
}

/* A corner's direction in the plane of its normal, weighted by its angle there. */
static vec weighted_direction(const ppmi_tangent_mesh *mesh, size_t corner, const sides *s)
{
    const size_t triangle = corner / 3, k = corner % 3;
    const uint32_t *i = mesh->indices + 3 * triangle;
    const vec n = normalize(load(mesh->normals + 3 * (size_t)i[k]));
    const vec p = load(mesh->positions + 3 * (size_t)i[k]);
    const vec to_next = sub(load(mesh->positions + 3 * (size_t)i[(k + 1) % 3]), p);
    const vec to_previous = sub(load(mesh->positions + 3 * (size_t)i[(k + 2) % 3]), p);
    const float cosine = dot(project(to_next, n), project(to_previous, n));
    const float angle = acosf(fminf(fmaxf(cosine, -1.0f), 1.0f));
    const vec zero = {0.0f, 0.0f, 0.0f};
    return mad(zero, project(u_direction(s), n), angle);
}

/* ---- groups ---------------------------------------------------------------------------------- */

static void load_fan(const topology *t, uint32_t vertex, ppmi_tangent_corner *out)
{
    for (size_t i = t->begin[vertex]; i < t->begin[vertex + 1]; ++i) {
        const size_t corner = t->corners[i], first = corner / 3 * 3, k = corner % 3;
        const sides s = find_sides(t->mesh, corner / 3);
        *out++ = (ppmi_tangent_corner){.next = vertex_of(t, first + (k + 1) % 3),
                                       .previous = vertex_of(t, first + (k + 2) % 3),
                                       .turn = turn_of(&s)};
    }
}

static void group_fan(topology *t, uint32_t vertex, ppmi_tangent_workspace *w)
{
    const uint32_t count = (uint32_t)(t->begin[vertex + 1] - t->begin[vertex]);
    if (count == 0) return;
    load_fan(t, vertex, w->corners);
    t->first_group[vertex + 1] = ppmi_tangent_group_fan(w, count);
    for (uint32_t i = 0; i < count; ++i) {
        t->group[t->corners[t->begin[vertex] + i]] = w->corners[i].group;
    }
}

static bool workspace_init(ppm_context *context, ppmi_tangent_workspace *w, size_t count)
{
    w->corners = ppmi_alloc(context, count, sizeof *w->corners);
    w->edges = ppmi_alloc(context, count, sizeof *w->edges);
    w->left = ppmi_alloc(context, count, 3 * sizeof *w->left);
    w->right = w->left + count;
    w->stack = w->right + count;
    return w->corners && w->edges && w->left;
}

static void workspace_deinit(ppm_context *context, ppmi_tangent_workspace *w)
{
    ppmi_free(context, w->corners);
    ppmi_free(context, w->edges);
    ppmi_free(context, w->left);
}

/* Numbers the groups of all fans one after the other. False when memory is out. */
static bool find_groups(topology *t)
{
    const int64_t vertices = t->mesh->vertex_count;
    bool ok = true;
#pragma omp parallel
    {
        ppmi_tangent_workspace w = {0};
        const bool has_room = workspace_init(t->context, &w, (size_t)t->largest + 1);
#pragma omp for schedule(dynamic, 1024)
        for (int64_t v = 0; v < vertices; ++v) {
            if (has_room) group_fan(t, (uint32_t)v, &w);
        }
        workspace_deinit(t->context, &w);
        if (!has_room) {
#pragma omp atomic write
            ok = false;
        }
    }
    for (int64_t v = 0; v < vertices; ++v) {
        t->first_group[v + 1] += t->first_group[v];
    }
    return ok;
}

/* The tangents of a fan's groups; its corners' groups get their final numbers. */
static void sum_fan(topology *t, uint32_t vertex, float *tangents)
{
    for (size_t i = t->begin[vertex]; i < t->begin[vertex + 1]; ++i) {
        const size_t corner = t->corners[i];
        if (t->group[corner] == PPMI_TANGENT_NO_GROUP) continue;
        t->group[corner] += t->first_group[vertex];
        const sides s = find_sides(t->mesh, corner / 3);
        const uint8_t turn = turn_of(&s);
        if (turn == PPMI_TANGENT_ANY) continue;
        float *tangent = tangents + 4 * (size_t)t->group[corner];
        const vec sum = mad(load(tangent), weighted_direction(t->mesh, corner, &s), 1.0f);
        memcpy(tangent, &sum, sizeof sum);
        tangent[3] = turn == PPMI_TANGENT_POSITIVE ? 1.0f : -1.0f;
    }
    for (size_t g = t->first_group[vertex]; g < t->first_group[vertex + 1]; ++g) {
        const vec unit = normalize(load(tangents + 4 * g));
        memcpy(tangents + 4 * g, &unit, sizeof unit);
    }
}

/* Triangles without area take any tangent of their vertices; none of it is seen. */
static void group_degenerate(topology *t)
{
    for (size_t i = 0; i < t->mesh->triangle_count; ++i) {
        if (!is_degenerate(t, i)) continue;
        for (size_t corner = 3 * i; corner < 3 * i + 3; ++corner) {
            const size_t begin = t->begin[vertex_of(t, corner)];
            const bool has_fan = begin < t->begin[vertex_of(t, corner) + 1];
            t->group[corner] = has_fan ? t->group[t->corners[begin]] : PPMI_TANGENT_NO_GROUP;
        }
    }
}

/* ---- splitting ------------------------------------------------------------------------------- */

/* The vertices of the result. Copies of one vertex are a list that begins with it. */
typedef struct splitter {
    ppm_context *context;
    uint32_t count, capacity;
    uint32_t *sources, *groups, *next_copy;
} splitter;

static bool grow(ppm_context *context, uint32_t **array, uint32_t count, uint32_t capacity)
{
    uint32_t *larger = ppmi_alloc(context, capacity, sizeof *larger);
    if (!larger) return false;
    if (count > 0) memcpy(larger, *array, count * sizeof *larger);
    ppmi_free(context, *array);
    *array = larger;
    return true;
}

static bool reserve(splitter *s, uint64_t capacity)
{
    if (capacity <= s->capacity) return true;
    if (capacity > UINT32_MAX) return false;
    if (!grow(s->context, &s->sources, s->count, (uint32_t)capacity) ||
        !grow(s->context, &s->groups, s->count, (uint32_t)capacity) ||
        !grow(s->context, &s->next_copy, s->count, (uint32_t)capacity)) {
        return false;
    }
    s->capacity = (uint32_t)capacity;
    return true;
}

static void add_vertex(splitter *s, uint32_t source)
{
    s->sources[s->count] = source;
    s->groups[s->count] = PPMI_TANGENT_NO_GROUP;
    s->next_copy[s->count++] = NONE;
}

/* The copy of a vertex for a group, or NONE when memory is out. */
static uint32_t find_copy(splitter *s, uint32_t vertex, uint32_t group)
{
    uint32_t last = vertex;
    if (group == PPMI_TANGENT_NO_GROUP) return vertex;
    for (uint32_t v = vertex; v != NONE; v = s->next_copy[v]) {
        if (s->groups[v] == PPMI_TANGENT_NO_GROUP) s->groups[v] = group; /* its first */
        if (s->groups[v] == group) return v;
        last = v;
    }
    if (s->count == s->capacity && !reserve(s, 2 * (uint64_t)s->capacity)) return NONE;
    s->next_copy[last] = s->count;
    add_vertex(s, vertex);
    s->groups[s->count - 1] = group;
    return s->count - 1;
}

/* Gives every corner the copy of its vertex with its tangent. False when memory is out. */
static bool split(const topology *t, splitter *s, uint32_t *indices)
{
    const ppmi_tangent_mesh *mesh = t->mesh;
    if (!reserve(s, (uint64_t)mesh->vertex_count + mesh->vertex_count / 8 + 16)) return false;
    for (uint32_t v = 0; v < mesh->vertex_count; ++v) {
        add_vertex(s, v);
    }
    for (size_t i = 0; i < 3 * (size_t)mesh->triangle_count; ++i) {
        indices[i] = find_copy(s, mesh->indices[i], t->group[i]);
        if (indices[i] == NONE) return false;
    }
    return true;
}

/* ---- all of it ------------------------------------------------------------------------------- */

static bool topology_init(ppm_context *context, const ppmi_tangent_mesh *mesh, topology *t)
{
    const size_t vertices = mesh->vertex_count, corners = 3 * (size_t)mesh->triangle_count;
    *t = (topology){.mesh = mesh, .context = context};
    t->welded = ppmi_alloc(context, vertices, sizeof *t->welded);
    t->begin = ppmi_alloc_zeroed(context, vertices + 1, sizeof *t->begin);
    t->first_group = ppmi_alloc_zeroed(context, vertices + 1, sizeof *t->first_group);
    t->corners = ppmi_alloc(context, corners, sizeof *t->corners);
    t->group = ppmi_alloc(context, corners, sizeof *t->group);
    if (!t->welded || !t->begin || !t->first_group || !t->corners || !t->group) return false;
    if (!ppmi_tangent_weld(context, mesh, t->welded)) return false;
    sort_corners(t);
    return true;
}

static void topology_deinit(topology *t)
{
    ppmi_free(t->context, t->welded);
    ppmi_free(t->context, t->begin);
    ppmi_free(t->context, t->first_group);
    ppmi_free(t->context, t->corners);
    ppmi_free(t->context, t->group);
}

/* The tangents of all groups; NULL when memory is out. */
static float *sum_groups(topology *t)
{
    const int64_t vertices = t->mesh->vertex_count;
    float *tangents =
        ppmi_alloc_zeroed(t->context, (size_t)t->first_group[vertices] + 1, 4 * sizeof *tangents);
    if (!tangents) return NULL;
#pragma omp parallel for schedule(dynamic, 1024)
    for (int64_t v = 0; v < vertices; ++v) {
        sum_fan(t, (uint32_t)v, tangents);
    }
    group_degenerate(t);
    return tangents;
}

/* The tangent of each vertex's group. False when memory is out. */
static bool spread(const splitter *s, const float *group_tangents, float **out)
{
    *out = ppmi_alloc_zeroed(s->context, s->count, 4 * sizeof **out);
    if (!*out) return false;
    for (size_t v = 0; v < s->count; ++v) {
        if (s->groups[v] == PPMI_TANGENT_NO_GROUP) continue;
        memcpy(*out + 4 * v, group_tangents + 4 * (size_t)s->groups[v], 4 * sizeof **out);
    }
    return true;
}

ppm_status ppmi_tangent_compute(ppm_context *context, const ppmi_tangent_mesh *mesh,
                                ppmi_tangent_result *out)
{
    topology t = {.context = context};
    splitter s = {.context = context};
    float *group_tangents = NULL;
    *out = (ppmi_tangent_result){0};
    if (mesh->vertex_count == 0 || mesh->triangle_count == 0) return PPM_STATUS_OK;
    bool ok = mesh->triangle_count <= UINT32_MAX / 3 && topology_init(context, mesh, &t);
    ok = ok && find_groups(&t);
    if (ok) group_tangents = sum_groups(&t);
    out->indices = ppmi_alloc(context, mesh->triangle_count, 3 * sizeof *out->indices);
    ok = group_tangents && out->indices && split(&t, &s, out->indices) &&
         spread(&s, group_tangents, &out->tangents);
    out->vertex_count = s.count;
    out->sources = s.sources;
    ppmi_free(context, s.groups);
    ppmi_free(context, s.next_copy);
    ppmi_free(context, group_tangents);
    topology_deinit(&t);
    return ok ? PPM_STATUS_OK : PPM_STATUS_OUT_OF_MEMORY;
}

void ppmi_tangent_result_deinit(ppm_context *context, ppmi_tangent_result *result)
{
    ppmi_free(context, result->tangents);
    ppmi_free(context, result->sources);
    ppmi_free(context, result->indices);
    *result = (ppmi_tangent_result){0};
}

bool ppmi_tangent_spread(ppm_context *context, float **values, size_t width,
                         const ppmi_tangent_result *result)
{
    if (!*values) return true;
    float *copies = ppmi_alloc(context, result->vertex_count, width * sizeof *copies);
    if (!copies) return false;
    for (size_t v = 0; v < result->vertex_count; ++v) {
        memcpy(copies + v * width, *values + result->sources[v] * width, width * sizeof *copies);
    }
    ppmi_free(context, *values);
    *values = copies;
    return true;
}
