/* Normals by crease angle, for files that say nothing about what is smooth: faces that share an
 * edge are smooth across it if their normals differ by no more than the angle. Around a vertex, the
 * corners that such edges connect get one normal, the mean of their faces weighted by angle
 * (obj_normals.c). Vertices at the same place count as one, since many programs write each face
 * with its own. */
#include <math.h>
#include <string.h>

#include "base/union_find.h"
#include "obj/obj_reader.h"

/* A face without a normal at some corner. */
typedef struct side {
    double normal[3]; /* unit length, or zero */
    size_t first_corner;
    uint32_t count;
} side;

typedef struct crease {
    ppmi_obj_reader *reader;
    double least_cosine;
    uint32_t *parents;       /* by corner */
    ppmi_obj_triples places; /* of vertices, by the bits of their coordinates */
    ppmi_obj_triples edges;  /* of places, the lower one first */
    ppmi_obj_array owners;   /* side and corner of each edge's latest face */
    ppmi_obj_array sides;
} crease;

/* The latest face at an edge: its corners at the lower and at the higher place. */
typedef struct owner {
    size_t side;
    uint32_t corners[2];
} owner;

/* The number of a corner's place. -0 is 0. */
static bool find_place(crease *c, size_t corner, uint32_t *out)
{
    const ppmi_obj_reader *r = c->reader;
    const ppmi_obj_corner *corners = r->corners.items;
    const float *p = (const float *)r->positions.items + 3 * (size_t)corners[corner].position;
    const float xyz[3] = {p[0] + 0.0f, p[1] + 0.0f, p[2] + 0.0f};
    ppmi_obj_triple key;
    memcpy(&key, xyz, sizeof key);
    return ppmi_obj_triples_add(r->context, &c->places, key, out);
}

static bool is_smooth(const crease *c, size_t a, size_t b)
{
    const side *sides = c->sides.items;
    const double *p = sides[a].normal, *q = sides[b].normal;
    return p[0] * q[0] + p[1] * q[1] + p[2] * q[2] >= c->least_cosine;
}

/* The edge from corner a to corner b of the latest side. */
static bool add_edge(crease *c, uint32_t a, uint32_t b)
{
    uint32_t from, to, index;
    if (!find_place(c, a, &from) || !find_place(c, b, &to)) return false;
    const bool is_turned = from > to;
    const ppmi_obj_triple key = {(int32_t)(is_turned ? to : from), (int32_t)(is_turned ? from : to),
                                 0};
    if (!ppmi_obj_triples_add(c->reader->context, &c->edges, key, &index)) return false;
    const owner mine = {c->sides.count - 1, {is_turned ? b : a, is_turned ? a : b}};
    owner *owners = c->owners.items;
    if (index == c->owners.count) {
        owner *added = ppmi_obj_push(c->reader->context, &c->owners, 1, sizeof *added);
        if (!added) return false;
        *added = mine;
        return true;
    }
    if (is_smooth(c, owners[index].side, mine.side)) {
        ppmi_union_find_join(c->parents, owners[index].corners[0], mine.corners[0]);
        ppmi_union_find_join(c->parents, owners[index].corners[1], mine.corners[1]);
    }
    owners[index] = mine;
    return true;
}

static bool add_side(crease *c, size_t first_corner, uint32_t count)
{
    ppmi_obj_reader *r = c->reader;
    const ppmi_obj_corner *corners = (const ppmi_obj_corner *)r->corners.items + first_corner;
    bool is_bare = false;
    for (uint32_t i = 0; i < count; ++i) {
        is_bare = is_bare || corners[i].normal < 0;
    }
    if (!is_bare) return true;
    side *added = ppmi_obj_push(r->context, &c->sides, 1, sizeof *added);
    if (!added) return false;
    *added = (side){.first_corner = first_corner, .count = count};
    ppmi_obj_face_normal(r, corners, count, added->normal);
    const double *n = added->normal;
    const double size = sqrt(n[0] * n[0] + n[1] * n[1] + n[2] * n[2]);
    for (int k = 0; k < 3; ++k) {
        added->normal[k] = size > 0.0 && isfinite(size) ? added->normal[k] / size : 0.0;
    }
    for (uint32_t i = 0; i < count; ++i) {
        const uint32_t next = i + 1 < count ? i + 1 : 0;
        if (!add_edge(c, (uint32_t)first_corner + i, (uint32_t)first_corner + next)) return false;
    }
    return true;
}

static bool add_sides(crease *c)
{
    const ppmi_obj_reader *r = c->reader;
    const ppmi_obj_run *runs = r->runs.items;
    const uint32_t *faces = r->faces.items;
    for (size_t i = 0; i < r->runs.count; ++i) {
        size_t corner = runs[i].first_corner;
        if (runs[i].kind != PPM_PRIMITIVE_TRIANGLES) continue;
        for (size_t k = runs[i].first_face; k < runs[i].end_face; ++k) {
            if (!add_side(c, corner, faces[k])) return false;
            corner += faces[k];
        }
    }
    return true;
}

/* Sums of the sides at each root, and their numbers in place of the corners' missing normals. */
static bool sum_normals(crease *c)
{
    ppmi_obj_reader *r = c->reader;
    ppmi_obj_corner *corners = r->corners.items;
    const side *sides = c->sides.items;
    double(*sums)[3] = ppmi_alloc_zeroed(r->context, r->corners.count, sizeof *sums);
    uint32_t *numbers = ppmi_alloc_zeroed(r->context, r->corners.count, sizeof *numbers);
    size_t count = 0;
    bool ok = sums && numbers;
    for (size_t i = 0; ok && i < c->sides.count; ++i) {
        for (uint32_t k = 0; k < sides[i].count; ++k) {
            const size_t corner = sides[i].first_corner + k;
            const uint32_t root = ppmi_union_find_root(c->parents, (uint32_t)corner);
            if (numbers[root] == 0) numbers[root] = (uint32_t)++count;
            const double weight =
                ppmi_obj_corner_angle(r, corners + sides[i].first_corner, sides[i].count, k);
            for (int d = 0; d < 3 && isfinite(weight); ++d) {
                sums[numbers[root] - 1][d] += weight * sides[i].normal[d];
            }
            if (corners[corner].normal >= 0) continue;
            corners[corner].normal = (int32_t)(r->normals.count + numbers[root] - 1);
        }
    }
    ok = ok && r->normals.count + count <= INT32_MAX &&
         ppmi_obj_append_normals(r, &sums[0][0], count);
    ppmi_free(r->context, sums);
    ppmi_free(r->context, numbers);
    return ok;
}

static bool compute(crease *c)
{
    const size_t count = c->reader->corners.count;
    if (count == 0) return true;
    if (count > UINT32_MAX) return false;
    c->parents = ppmi_alloc(c->reader->context, count, sizeof *c->parents);
    if (!c->parents) return false;
    for (size_t i = 0; i < count; ++i) {
        c->parents[i] = (uint32_t)i;
    }
    if (!add_sides(c)) return false;
    /* no longer needed, and most of the memory */
    ppmi_obj_triples_deinit(c->reader->context, &c->places);
    ppmi_obj_triples_deinit(c->reader->context, &c->edges);
    ppmi_obj_array_deinit(c->reader->context, &c->owners);
    return sum_normals(c);
}

ppm_status ppmi_obj_crease_normals(ppmi_obj_reader *r)
{
    const double angle = (double)r->options->crease_rad;
    if (!(angle > 0.0) || r->has_smoothing) return PPM_STATUS_OK;
    /* a flat plane whose normals are not quite the same has no creases */
    crease c = {.reader = r, .least_cosine = cos(angle) - 1e-9};
    const bool ok = compute(&c);
    ppmi_free(r->context, c.parents);
    ppmi_obj_triples_deinit(r->context, &c.places);
    ppmi_obj_triples_deinit(r->context, &c.edges);
    ppmi_obj_array_deinit(r->context, &c.owners);
    ppmi_obj_array_deinit(r->context, &c.sides);
    return ok ? PPM_STATUS_OK : ppmi_obj_out_of_memory(r);
}
