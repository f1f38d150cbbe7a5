/* The outside of a solid is where its author meant it, whichever way it is wound.
 *
 * Vertices at one place are one; shells are what hangs together by them. A shell is closed where
 * each edge is passed as often in one direction as in the other: the sum of a random number for
 * each edge, with the sign of its direction, is then 0, and else almost never. Which shell is
 * inside of which is told by parity along a slanted line, whose crossings are looked up in a grid
 * across the line. The sign of an edge is asked with its ends in one order, so that no line slips
 * between two triangles or meets both. */
#include "scene/orient.h"

#include "base/union_find.h"
#include "math/sampler.h"

#define NONE UINT32_MAX

typedef struct shell {
    uint64_t edges;  /* 0: they fit */
    double volume6;  /* six times, signed */
    double area2;    /* twice */
    uint32_t sample; /* one of its triangles */
    bool is_closed;  /* around a volume: no two sheets face to face */
    bool is_turned;
    uint32_t outermost; /* of those it is inside of; itself if there is none */
} shell;

/* A triangle of any primitive, by welded vertices. */
typedef struct face {
    uint32_t v[3];
    uint32_t shell;
} face;

typedef struct orientation {
    ppm_context *context;
    const ppmi_mesh *mesh;
    uint32_t vertex_count, face_count, shell_count;
    uint32_t *welded;     /* by vertex, all primitives in a row: the first at its place */
    uint32_t *parent;     /* union-find over welded vertices */
    const float **places; /* by welded vertex */
    face *faces;
    shell *shells;

    double (*flat)[3]; /* by vertex: across the line, and along */
    double low[2], to_cell[2];
    uint32_t side;               /* cells */
    uint32_t *starts, *in_cells; /* faces of each cell */
} orientation;

static bool is_solid(const ppm_scene *scene, const ppmi_primitive *primitive)
{
    return primitive->kind == PPM_PRIMITIVE_TRIANGLES && primitive->triangle_count > 0 &&
           scene->materials[primitive->material].is_solid_glass;
}

/* All triangles that were given: those without an area close a surface too. */
static uint32_t given(const ppmi_primitive *primitive, const uint32_t **out_indices)
{
    *out_indices = primitive->given_indices ? primitive->given_indices : primitive->indices;
    if (primitive->kind != PPM_PRIMITIVE_TRIANGLES) return 0;
    return primitive->given_indices ? primitive->given_count : primitive->triangle_count;
}

/* ---- shells ---------------------------------------------------------------------------------- */

static bool is_same_place(const float *a, const float *b)
{
    return a[0] == b[0] && a[1] == b[1] && a[2] == b[2];
}

static uint64_t hash_of_place(const float *p)
{
    uint64_t hash = 0;
    for (int i = 0; i < 3; i++) {
        union {
            float f;
            uint32_t bits;
        } value = {p[i] + 0.0f}; /* no negative zero */
        hash = ppmi_hash64(hash ^ value.bits);
    }
    return hash;
}

static void weld(orientation *o, uint32_t *table, uint32_t mask)
{
    uint32_t vertex = 0;
    for (uint32_t k = 0; k < o->mesh->primitive_count; k++) {
        const ppmi_primitive *primitive = &o->mesh->primitives[k];
        if (primitive->kind != PPM_PRIMITIVE_TRIANGLES) continue;
        for (uint32_t i = 0; i < primitive->vertex_count; i++, vertex++) {
            const float *p = primitive->positions + 3 * (size_t)i;
            uint32_t slot = (uint32_t)hash_of_place(p) & mask;
            while (table[slot] != NONE && !is_same_place(o->places[table[slot]], p))
                slot = (slot + 1) & mask;
            if (table[slot] == NONE) table[slot] = vertex;
            o->places[vertex] = p;
            o->welded[vertex] = table[slot];
            o->parent[vertex] = vertex;
        }
    }
}

static void list_faces(orientation *o)
{
    uint32_t first = 0, count = 0;
    for (uint32_t k = 0; k < o->mesh->primitive_count; k++) {
        const uint32_t *indices;
        const uint32_t triangles = given(&o->mesh->primitives[k], &indices);
        for (size_t i = 0; i < triangles; i++) {
            face *added = &o->faces[count++];
            for (int j = 0; j < 3; j++)
                added->v[j] = o->welded[first + indices[3 * i + (size_t)j]];
            ppmi_union_find_join(o->parent, added->v[0], added->v[1]);
            ppmi_union_find_join(o->parent, added->v[0], added->v[2]);
        }
        if (o->mesh->primitives[k].kind == PPM_PRIMITIVE_TRIANGLES) {
            first += o->mesh->primitives[k].vertex_count;
        }
    }
}

/* numbers: by vertex, all NONE. */
static void number_shells(orientation *o, uint32_t *numbers)
{
    for (uint32_t i = 0; i < o->face_count; i++) {
        uint32_t *number = &numbers[ppmi_union_find_root(o->parent, o->faces[i].v[0])];
        if (*number == NONE) *number = o->shell_count++;
        o->faces[i].shell = *number;
    }
}

static void place(const orientation *o, uint32_t vertex, double out_p[3])
{
    const ppmi_vec3 low = o->mesh->bounds_min;
    out_p[0] = (double)o->places[vertex][0] - (double)low.x;
    out_p[1] = (double)o->places[vertex][1] - (double)low.y;
    out_p[2] = (double)o->places[vertex][2] - (double)low.z;
}

static uint64_t edges_of(const face *f)
{
    uint64_t sum = 0;
    for (int k = 0; k < 3; k++) {
        const uint64_t from = f->v[k], to = f->v[(k + 1) % 3];
        if (from < to) sum += ppmi_hash64((from << 32) + to);
        if (from > to) sum -= ppmi_hash64((to << 32) + from);
    }
    return sum;
}

static void measure(orientation *o)
{
    for (uint32_t i = 0; i < o->face_count; i++) {
        const face *f = &o->faces[i];
        shell *of = &o->shells[f->shell];
        double a[3], b[3], c[3], n[3];
        place(o, f->v[0], a);
        place(o, f->v[1], b);
        place(o, f->v[2], c);
        for (int k = 0; k < 3; k++) {
            const int l = (k + 1) % 3, m = (k + 2) % 3;
            n[k] = (b[l] - a[l]) * (c[m] - a[m]) - (b[m] - a[m]) * (c[l] - a[l]);
        }
        const double area2 = sqrt(n[0] * n[0] + n[1] * n[1] + n[2] * n[2]);
        of->edges += edges_of(f);
        of->volume6 += a[0] * n[0] + a[1] * n[1] + a[2] * n[2];
        of->area2 += area2;
        if (area2 > 0.0) of->sample = i;
    }
    for (uint32_t i = 0; i < o->shell_count; i++) {
        shell *of = &o->shells[i];
        of->is_closed = of->edges == 0 && fabs(of->volume6) > 1e-6 * pow(of->area2, 1.5);
    }
}

/* ---- which is inside of which ---------------------------------------------------------------- */

/* Along a line of no simple slope. */
static void flatten(const double p[3], double out_flat[3])
{
    out_flat[0] = p[0] - 0.1732050807 * p[2];
    out_flat[1] = p[1] - 0.2645751311 * p[2];
    out_flat[2] = p[2];
}

static void flatten_all(orientation *o)
{
    double high[2] = {-INFINITY, -INFINITY};
    o->low[0] = o->low[1] = INFINITY;
    for (uint32_t i = 0; i < 3 * o->face_count; i++) {
        const face *f = &o->faces[i / 3];
        const uint32_t vertex = f->v[i % 3];
        double p[3];
        if (!o->shells[f->shell].is_closed) continue;
        place(o, vertex, p);
        flatten(p, o->flat[vertex]);
        for (int k = 0; k < 2; k++) {
            o->low[k] = fmin(o->low[k], o->flat[vertex][k]);
            high[k] = fmax(high[k], o->flat[vertex][k]);
        }
    }
    for (int k = 0; k < 2; k++) {
        const double width = high[k] - o->low[k];
        o->to_cell[k] = width > 0.0 ? 0.9999 / width : 0.0;
    }
}

static uint32_t cell_along(const orientation *o, double at, int k)
{
    const double cell = (at - o->low[k]) * o->to_cell[k] * (double)o->side;
    return cell > 0.0 ? cell < (double)o->side ? (uint32_t)cell : o->side - 1 : 0;
}

/* The cells that a face may lie over: columns [0] .. [1], rows [2] .. [3]. */
static void cells_of(const orientation *o, const face *f, uint32_t out_cells[4])
{
    for (int k = 0; k < 2; k++) {
        const double a = o->flat[f->v[0]][k], b = o->flat[f->v[1]][k], c = o->flat[f->v[2]][k];
        out_cells[2 * k] = cell_along(o, fmin(a, fmin(b, c)), k);
        out_cells[2 * k + 1] = cell_along(o, fmax(a, fmax(b, c)), k);
    }
}

static uint64_t count_entries(const orientation *o)
{
    uint64_t count = 0;
    for (uint32_t i = 0; i < o->face_count; i++) {
        uint32_t cells[4];
        if (!o->shells[o->faces[i].shell].is_closed) continue;
        cells_of(o, &o->faces[i], cells);
        count += (uint64_t)(cells[1] - cells[0] + 1) * (cells[3] - cells[2] + 1);
    }
    return count;
}

/* As fine as large faces let it be. */
static uint64_t choose_side(orientation *o)
{
    const uint64_t most = 16 * (uint64_t)o->face_count + 4096;
    o->side = (uint32_t)ppmi_clampf(sqrtf((float)o->face_count), 1.0f, 2048.0f);
    uint64_t entries = count_entries(o);
    while (entries > most && o->side > 1) {
        o->side = (o->side + 1) / 2;
        entries = count_entries(o);
    }
    return entries;
}

/* Counts the faces of each cell, two places behind it, or puts them in: begins are then one place
 * behind, and where they belong at the end. */
static void enter_all(orientation *o, bool puts_in)
{
    for (uint32_t i = 0; i < o->face_count; i++) {
        uint32_t cells[4];
        if (!o->shells[o->faces[i].shell].is_closed) continue;
        cells_of(o, &o->faces[i], cells);
        for (uint32_t y = cells[2]; y <= cells[3]; y++) {
            uint32_t *row = o->starts + (size_t)y * o->side;
            for (uint32_t x = cells[0]; x <= cells[1]; x++) {
                if (puts_in) o->in_cells[row[x + 1]] = i;
                row[x + (puts_in ? 1 : 2)]++;
            }
        }
    }
}

static bool fill_grid(orientation *o)
{
    flatten_all(o);
    const uint64_t entries = choose_side(o);
    const size_t cell_count = (size_t)o->side * o->side;
    if (entries >= NONE) return false;
    o->starts = ppmi_alloc_zeroed(o->context, cell_count + 2, sizeof *o->starts);
    o->in_cells = ppmi_alloc(o->context, (size_t)entries + 1, sizeof *o->in_cells);
    if (!o->starts || !o->in_cells) return false;
    enter_all(o, false);
    for (size_t i = 0; i < cell_count; i++)
        o->starts[i + 2] += o->starts[i + 1];
    enter_all(o, true);
    return true;
}

/* On which side of an edge p is: the same answer, but for its sign, from both of its faces. */
static bool is_left(const orientation *o, uint32_t from, uint32_t to, const double p[3])
{
    const double *a = o->flat[from < to ? from : to], *b = o->flat[from < to ? to : from];
    const double side = (b[0] - a[0]) * (p[1] - a[1]) - (b[1] - a[1]) * (p[0] - a[0]);
    return from < to ? side > 0.0 : !(side > 0.0);
}

/* Whether the line upwards from p meets the face. */
static bool is_crossed(const orientation *o, const face *f, const double p[3])
{
    const bool left = is_left(o, f->v[0], f->v[1], p);
    if (is_left(o, f->v[1], f->v[2], p) != left || is_left(o, f->v[2], f->v[0], p) != left) {
        return false;
    }
    const double *a = o->flat[f->v[0]], *b = o->flat[f->v[1]], *c = o->flat[f->v[2]];
    const double area = (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0]);
    if (area == 0.0) return false;
    const double u = ((p[0] - a[0]) * (c[1] - a[1]) - (p[1] - a[1]) * (c[0] - a[0])) / area;
    const double v = ((b[0] - a[0]) * (p[1] - a[1]) - (b[1] - a[1]) * (p[0] - a[0])) / area;
    return a[2] + u * (b[2] - a[2]) + v * (c[2] - a[2]) > p[2];
}

/* Somewhere on a face. */
static void point_on(const orientation *o, const face *f, double out_p[3])
{
    for (int k = 0; k < 3; k++) {
        out_p[k] = 0.4142135 * o->flat[f->v[0]][k] + 0.3027756 * o->flat[f->v[1]][k] +
                   0.2830109 * o->flat[f->v[2]][k];
    }
}

/* Parities by shell are all 0 before and after. */
static void find_outermost(orientation *o, uint32_t index, uint8_t *parities)
{
    double p[3];
    shell *of = &o->shells[index];
    point_on(o, &o->faces[of->sample], p);
    const size_t cell = (size_t)cell_along(o, p[1], 1) * o->side + cell_along(o, p[0], 0);
    const uint32_t *begin = o->in_cells + o->starts[cell], *end = o->in_cells + o->starts[cell + 1];
    for (const uint32_t *at = begin; at < end; at++) {
        const face *f = &o->faces[*at];
        if (f->shell != index && is_crossed(o, f, p)) parities[f->shell] ^= 1;
    }
    for (const uint32_t *at = begin; at < end; at++) {
        const uint32_t other = o->faces[*at].shell;
        if (!parities[other]) continue;
        parities[other] = 0;
        const bool is_larger =
            fabs(o->shells[other].volume6) > fabs(o->shells[of->outermost].volume6);
        if (of->outermost == index || is_larger) of->outermost = other;
    }
}

/* ---- inside of other meshes ------------------------------------------------------------------ */

/* Tests of triangles against lines, of a scene: what is left after them stays as it is. */
enum { MOST_TESTS = 1 << 28 };

/* About upwards: an open sheet of water has its inside below, as in transport/solid.c. */
static const ppmi_vec3 upwards = {0.0137f, 1.0f, 0.0071f};

static ppmi_vec3 middle_of(const orientation *o, const face *f)
{
    const ppmi_vec3 a = vec3_load(o->places[f->v[0]]), b = vec3_load(o->places[f->v[1]]),
                    c = vec3_load(o->places[f->v[2]]);
    return vec3_scale(vec3_add(vec3_add(a, b), c), 1.0f / 3.0f);
}

/* Moller and Trumbore 1997. */
static bool is_met_upwards(ppmi_vec3 p, ppmi_vec3 a, ppmi_vec3 b, ppmi_vec3 c)
{
    const ppmi_vec3 ab = vec3_sub(b, a), ac = vec3_sub(c, a), ap = vec3_sub(p, a);
    const ppmi_vec3 across = vec3_cross(upwards, ac), along = vec3_cross(ap, ab);
    const float determinant = vec3_dot(ab, across);
    if (determinant == 0.0f) return false;
    const float u = vec3_dot(ap, across) / determinant, v = vec3_dot(upwards, along) / determinant;
    return u >= 0.0f && v >= 0.0f && u + v <= 1.0f && vec3_dot(ac, along) / determinant > 0.0f;
}

static uint32_t count_above(const ppmi_instance *instance, const ppmi_primitive *primitive,
                            ppmi_vec3 p)
{
    uint32_t count = 0;
    for (size_t i = 0; i < primitive->triangle_count; i++) {
        ppmi_vec3 corners[3];
        for (size_t k = 0; k < 3; k++) {
            const uint32_t vertex = primitive->indices[3 * i + k];
            corners[k] = ppmi_transform_point(&instance->to_world,
                                              vec3_load(primitive->positions + 3 * (size_t)vertex));
        }
        count += is_met_upwards(p, corners[0], corners[1], corners[2]);
    }
    return count;
}

/* Whether p may be in the box of the mesh, as it is placed. */
static bool is_near(const ppmi_instance *instance, const ppmi_mesh *mesh, ppmi_vec3 p)
{
    const ppmi_vec3 middle = vec3_scale(vec3_add(mesh->bounds_min, mesh->bounds_max), 0.5f);
    const float reach = 0.5f * vec3_length(vec3_sub(mesh->bounds_max, mesh->bounds_min));
    const ppmi_vec3 center = ppmi_transform_point(&instance->to_world, middle);
    return vec3_length(vec3_sub(p, center)) <= 1.7321f * instance->scale * reach;
}

/* Whether a place of a mesh, where it stands first, is in a solid of another mesh: it is then a
 * cavity that was modelled as a mesh of its own. */
static bool is_in_glass(const ppm_scene *scene, uint32_t mesh, ppmi_vec3 place, uint64_t *budget)
{
    uint32_t own = 0;
    while (own < scene->instance_count && scene->instances[own].mesh != mesh)
        own++;
    if (own == scene->instance_count) return false;
    const ppmi_vec3 p = ppmi_transform_point(&scene->instances[own].to_world, place);
    for (uint32_t i = 0; i < scene->instance_count; i++) {
        const ppmi_instance *instance = &scene->instances[i];
        const ppmi_mesh *other = &scene->meshes[instance->mesh];
        if (instance->mesh == mesh || !ppmi_instance_is_there(instance)) continue;
        if (!is_near(instance, other, p)) continue;
        uint32_t above = 0;
        for (uint32_t k = 0; k < other->primitive_count; k++) {
            const ppmi_primitive *primitive = &other->primitives[k];
            if (!is_solid(scene, primitive)) continue;
            if (primitive->triangle_count > *budget) return true;
            *budget -= primitive->triangle_count;
            above += count_above(instance, primitive, p);
        }
        if (above % 2 == 1) return true;
    }
    return false;
}

/* ---- turning --------------------------------------------------------------------------------- */

static bool has_inside_out(const orientation *o)
{
    for (uint32_t i = 0; i < o->shell_count; i++) {
        if (o->shells[i].is_closed && o->shells[i].volume6 < 0.0) return true;
    }
    return false;
}

/* False when memory is out. */
static bool find_all_outermost(orientation *o)
{
    for (uint32_t i = 0; i < o->shell_count; i++)
        o->shells[i].outermost = i;
    if (o->shell_count > 1) {
        uint8_t *parities = ppmi_alloc_zeroed(o->context, o->shell_count, sizeof *parities);
        o->flat = ppmi_alloc(o->context, o->vertex_count, sizeof *o->flat);
        const bool is_filled = parities && o->flat && fill_grid(o);
        for (uint32_t i = 0; is_filled && i < o->shell_count; i++) {
            if (o->shells[i].is_closed) find_outermost(o, i, parities);
        }
        ppmi_free(o->context, parities);
        if (!is_filled) return false;
    }
    return true;
}

static void choose_turned(orientation *o, const ppm_scene *scene, uint32_t mesh, uint64_t *budget)
{
    for (uint32_t i = 0; i < o->shell_count; i++) {
        shell *of = &o->shells[i];
        of->is_turned = of->is_closed && of->outermost == i && of->volume6 < 0.0 &&
                        !is_in_glass(scene, mesh, middle_of(o, &o->faces[of->sample]), budget);
    }
    for (uint32_t i = 0; i < o->shell_count; i++) {
        shell *of = &o->shells[i];
        if (of->is_closed) of->is_turned = o->shells[of->outermost].is_turned;
    }
}

static void turn(uint32_t *triangle)
{
    const uint32_t second = triangle[1];
    triangle[1] = triangle[2];
    triangle[2] = second;
}

/* Those that can be hit are some of the given, in their order. */
static void turn_primitive(const orientation *o, ppmi_primitive *primitive, const face *faces,
                           ppmi_mesh *mesh)
{
    const uint32_t *all;
    const uint32_t count = given(primitive, &all);
    uint32_t kept = 0;
    for (size_t i = 0; i < count; i++) {
        uint32_t *hit = primitive->indices + 3 * (size_t)kept;
        const bool is_kept = kept < primitive->triangle_count && hit[0] == all[3 * i] &&
                             hit[1] == all[3 * i + 1] && hit[2] == all[3 * i + 2];
        if (is_kept) kept++;
        if (!o->shells[faces[i].shell].is_turned) continue;
        if (primitive->given_indices) turn(primitive->given_indices + 3 * i);
        if (!is_kept) continue;
        turn(hit);
        mesh->turned_count++;
    }
}

static void turn_mesh(const orientation *o, const ppm_scene *scene, ppmi_mesh *mesh)
{
    const face *faces = o->faces;
    for (uint32_t k = 0; k < mesh->primitive_count; k++) {
        const uint32_t *all;
        const uint32_t count = given(&mesh->primitives[k], &all);
        if (is_solid(scene, &mesh->primitives[k])) {
            turn_primitive(o, &mesh->primitives[k], faces, mesh);
        }
        faces += count;
    }
}

/* ---- a mesh ---------------------------------------------------------------------------------- */

/* False where there is nothing to look at, or more than 32 bits count. */
static bool count_parts(const ppm_scene *scene, const ppmi_mesh *mesh, orientation *o)
{
    bool has_solid = false;
    uint64_t vertices = 0, faces = 0;
    for (uint32_t k = 0; k < mesh->primitive_count; k++) {
        const ppmi_primitive *primitive = &mesh->primitives[k];
        const uint32_t *indices;
        if (primitive->kind != PPM_PRIMITIVE_TRIANGLES) continue;
        has_solid = has_solid || is_solid(scene, primitive);
        vertices += primitive->vertex_count;
        faces += given(primitive, &indices);
    }
    if (!has_solid || vertices >= (uint64_t)1 << 30 || faces >= (uint64_t)1 << 31) return false;
    o->vertex_count = (uint32_t)vertices;
    o->face_count = (uint32_t)faces;
    return true;
}

static uint32_t *filled_with_none(ppm_context *context, size_t count)
{
    uint32_t *values = ppmi_alloc(context, count, sizeof *values);
    for (size_t i = 0; values && i < count; i++)
        values[i] = NONE;
    return values;
}

/* False when memory is out. */
static bool find_shells(orientation *o)
{
    uint32_t slots = 1;
    while (slots < 2 * o->vertex_count)
        slots *= 2;
    o->welded = ppmi_alloc(o->context, o->vertex_count, sizeof *o->welded);
    o->parent = ppmi_alloc(o->context, o->vertex_count, sizeof *o->parent);
    o->places = ppmi_alloc(o->context, o->vertex_count, sizeof *o->places);
    o->faces = ppmi_alloc(o->context, o->face_count, sizeof *o->faces);
    uint32_t *table = filled_with_none(o->context, slots);
    const bool is_there = o->welded && o->parent && o->places && o->faces && table;
    if (is_there) weld(o, table, slots - 1);
    ppmi_free(o->context, table);
    if (!is_there) return false;
    list_faces(o);
    uint32_t *numbers = filled_with_none(o->context, o->vertex_count);
    if (numbers) number_shells(o, numbers);
    ppmi_free(o->context, numbers);
    if (!numbers) return false;
    o->shells = ppmi_alloc_zeroed(o->context, o->shell_count + 1u, sizeof *o->shells);
    if (o->shells) measure(o);
    return o->shells != NULL;
}

static ppm_status orient(const ppm_scene *scene, uint32_t index, uint64_t *budget)
{
    ppmi_mesh *mesh = &scene->meshes[index];
    orientation o = {.context = scene->context, .mesh = mesh};
    mesh->turned_count = 0;
    mesh->oriented_version = mesh->shape_version;
    if (!count_parts(scene, mesh, &o)) return PPM_STATUS_OK;
    bool is_done = find_shells(&o);
    if (is_done && has_inside_out(&o)) {
        is_done = find_all_outermost(&o);
        if (is_done) choose_turned(&o, scene, index, budget);
        if (is_done) turn_mesh(&o, scene, mesh);
    }
    ppmi_free(o.context, o.welded);
    ppmi_free(o.context, o.parent);
    ppmi_free(o.context, (void *)o.places);
    ppmi_free(o.context, o.faces);
    ppmi_free(o.context, o.shells);
    ppmi_free(o.context, o.flat);
    ppmi_free(o.context, o.starts);
    ppmi_free(o.context, o.in_cells);
    if (is_done) return PPM_STATUS_OK;
    return ppmi_fail(scene->context, PPM_STATUS_OUT_OF_MEMORY, "mesh '%s': out of memory",
                     mesh->name);
}

ppm_status ppmi_scene_orient(ppm_scene *scene, uint32_t *out_meshes)
{
    ppm_status status = PPM_STATUS_OK;
    uint64_t budget = MOST_TESTS;
    *out_meshes = 0;
    for (uint32_t i = 0; i < scene->mesh_count && status == PPM_STATUS_OK; i++) {
        ppmi_mesh *mesh = &scene->meshes[i];
        if (mesh->oriented_version == mesh->shape_version) continue;
        status = orient(scene, i, &budget);
        *out_meshes += mesh->turned_count > 0;
    }
    return status;
}

ppm_status ppm_scene_turn_solids(ppm_scene *scene, uint32_t *out_meshes)
{
    if (!scene || !out_meshes) return PPM_STATUS_INVALID_ARGUMENT;
    const ppm_status status = ppmi_scene_check_open(scene);
    return status == PPM_STATUS_OK ? ppmi_scene_orient(scene, out_meshes) : status;
}
