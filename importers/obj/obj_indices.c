/* Indices that point to nothing. An element may come behind the face that names it, so that this is
 * known only once the file is read: a face, line or point whose vertex is not there is left out;
 * one whose texture vertex or normal is not there goes without. */
#include "obj/obj_reader.h"

const char *ppmi_obj_kind_name(int32_t kind)
{
    return kind == PPM_PRIMITIVE_TRIANGLES ? "face"
           : kind == PPM_PRIMITIVE_LINES   ? "line"
                                           : "point";
}

/* What the indices of one sort point to. */
typedef struct target {
    const char *name;
    size_t count; /* elements */
    const ppmi_obj_reach *reach;
    const ppmi_obj_fault *fault;
    size_t elements; /* faces, lines and points with an index that points to nothing */
} target;

static bool is_nowhere(const target *t, int32_t index)
{
    return index == PPMI_OBJ_NOWHERE || (index >= 0 && (size_t)index >= t->count);
}

static bool may_be_nowhere(const target *t)
{
    return t->fault->line > 0 || (t->reach->most > 0 && (size_t)t->reach->most > t->count);
}

/* Programs that strip texture vertices or normals may leave their indices behind: where there are
 * none at all, such indices mean nothing. */
static void drop_indices_of_nothing(ppmi_obj_reader *r)
{
    const bool drops_uvs = r->uvs.count == 0 && r->uv_reach.most > 0;
    const bool drops_normals = r->normals.count == 0 && r->normal_reach.most > 0;
    ppmi_obj_corner *corners = r->corners.items;
    for (size_t i = 0; (drops_uvs || drops_normals) && i < r->corners.count; ++i) {
        if (drops_uvs) corners[i].uv = -1;
        if (drops_normals) corners[i].normal = -1;
    }
    if (drops_uvs) {
        r->uv_reach.most = 0;
        ppmi_log(r->context, PPM_LOG_WARNING,
                 "%s: faces have texture vertices, of which there are none", r->path);
    }
    if (drops_normals) {
        r->normal_reach.most = 0;
        ppmi_log(r->context, PPM_LOG_WARNING,
                 "%s: faces have vertex normals, of which there are none", r->path);
    }
}

/* ---- one element ----------------------------------------------------------------------------- */

/* Takes what is not there from all corners: half of a face's texture would be a smear. */
static void strip_corners(target *uvs, target *normals, ppmi_obj_corner *corners, uint32_t count)
{
    bool lacks_uvs = false, lacks_normals = false;
    for (uint32_t i = 0; i < count; ++i) {
        lacks_uvs = lacks_uvs || is_nowhere(uvs, corners[i].uv);
        lacks_normals = lacks_normals || is_nowhere(normals, corners[i].normal);
    }
    for (uint32_t i = 0; i < count; ++i) {
        if (lacks_uvs) corners[i].uv = -1;
        if (lacks_normals) corners[i].normal = -1;
    }
    uvs->elements += lacks_uvs;
    normals->elements += lacks_normals;
}

static bool has_vertices(const target *positions, const ppmi_obj_corner *corners, uint32_t count)
{
    for (uint32_t i = 0; i < count; ++i) {
        if (corners[i].position < 0 || is_nowhere(positions, corners[i].position)) return false;
    }
    return true;
}

/* ---- all of them ----------------------------------------------------------------------------- */

/* Where what is kept is moved to. */
typedef struct packing {
    size_t face, corner;
} packing;

/* Keeps the elements of a run that have their vertices. False when there are none. */
static bool pack_run(ppmi_obj_reader *r, target targets[3], ppmi_obj_run *run, packing *to)
{
    uint32_t *faces = r->faces.items;
    ppmi_obj_corner *corners = r->corners.items;
    const packing begin = *to;
    size_t from = run->first_corner;
    for (size_t i = run->first_face; i < run->end_face; ++i) {
        const uint32_t count = faces[i];
        ppmi_obj_corner *const face = corners + from;
        from += count;
        if (!has_vertices(&targets[0], face, count)) {
            targets[0].elements++;
            continue;
        }
        strip_corners(&targets[1], &targets[2], face, count);
        for (uint32_t k = 0; k < count; ++k) {
            corners[to->corner++] = face[k];
        }
        faces[to->face++] = count;
    }
    run->first_face = begin.face;
    run->first_corner = begin.corner;
    run->end_face = to->face;
    return to->face > begin.face;
}

static void pack_runs(ppmi_obj_reader *r, target targets[3])
{
    ppmi_obj_run *runs = r->runs.items;
    packing to = {0, 0};
    size_t kept = 0;
    for (size_t i = 0; i < r->runs.count; ++i) {
        ppmi_obj_run run = runs[i];
        if (pack_run(r, targets, &run, &to)) runs[kept++] = run;
    }
    r->runs.count = kept;
    r->faces.count = to.face;
    r->corners.count = to.corner;
}

/* ---- what is told ---------------------------------------------------------------------------- */

/* "a face has vertex 4, of 3", and its line. */
static void describe(const target *t, char *out, size_t size, size_t *out_line)
{
    const bool is_far = t->reach->most > 0 && (size_t)t->reach->most > t->count;
    if (is_far && (t->fault->line == 0 || t->reach->line < t->fault->line)) {
        snprintf(out, size, "a %s has %s %d, of %zu in the file",
                 ppmi_obj_kind_name(t->reach->kind), t->name, (int)t->reach->most, t->count);
        *out_line = t->reach->line;
    } else {
        snprintf(out, size, "a %s has %s", ppmi_obj_kind_name(t->fault->kind), t->fault->what);
        *out_line = t->fault->line;
    }
}

static void warn(const ppmi_obj_reader *r, const target *t, const char *consequence)
{
    char reason[160];
    size_t line;
    if (t->elements == 0) return;
    describe(t, reason, sizeof reason, &line);
    ppmi_log(r->context, PPM_LOG_WARNING,
             "%s: line %zu: %s; %zu faces, lines and points with such a %s are %s", r->path, line,
             reason, t->elements, t->name, consequence);
}

static ppm_status refuse(const ppmi_obj_reader *r, const target *t, const char *why)
{
    char reason[160];
    size_t line;
    describe(t, reason, sizeof reason, &line);
    return ppmi_fail(r->context, PPM_STATUS_INPUT_INVALID, "%s: line %zu: %s; %s", r->path, line,
                     reason, why);
}

ppm_status ppmi_obj_settle_indices(ppmi_obj_reader *r)
{
    const bool had_any = r->faces.count + r->tally.broken > 0;
    drop_indices_of_nothing(r);
    target targets[3] = {
        {"vertex", r->positions.count, &r->position_reach, &r->position_fault, r->tally.broken},
        {"texture vertex", r->uvs.count, &r->uv_reach, &r->uv_fault, 0},
        {"vertex normal", r->normals.count, &r->normal_reach, &r->normal_fault, 0}};
    if (!may_be_nowhere(&targets[0]) && !may_be_nowhere(&targets[1]) &&
        !may_be_nowhere(&targets[2])) {
        return PPM_STATUS_OK;
    }
    pack_runs(r, targets);
    if (had_any && r->faces.count == 0) return refuse(r, &targets[0], "nothing is left to render");
    for (int i = 0; i < 3; ++i) {
        if (r->options->strict && targets[i].elements > 0) return refuse(r, &targets[i], "strict");
    }
    warn(r, &targets[0], "left out");
    warn(r, &targets[1], "drawn without texture coordinates");
    warn(r, &targets[2], "drawn without the file's normals");
    return PPM_STATUS_OK;
}
