/* Meshes: the faces of one node, by material, with vertices that are shared where position, texture
 * coordinate and normal are the same. */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "obj/obj_geometry.h"

/* ---- order ----------------------------------------------------------------------------------- */

static int compare_runs(const void *a, const void *b)
{
    const ppmi_obj_run *x = a, *y = b;
    if (x->object != y->object) return x->object < y->object ? -1 : 1;
    if (x->material != y->material) return x->material < y->material ? -1 : 1;
    if (x->kind != y->kind) return x->kind < y->kind ? -1 : 1;
    return x->first_face < y->first_face ? -1 : x->first_face > y->first_face;
}

/* Runs of one node, one material and one kind. */
typedef struct slice {
    const ppmi_obj_run *runs;
    size_t count;
} slice;

static ppmi_obj_corner *corners_of(const ppmi_obj_reader *r, const ppmi_obj_run *run)
{
    return (ppmi_obj_corner *)r->corners.items + run->first_corner;
}

static size_t corner_count(const ppmi_obj_reader *r, const ppmi_obj_run *run)
{
    const uint32_t *faces = r->faces.items;
    size_t count = 0;
    for (size_t i = run->first_face; i < run->end_face; ++i) {
        count += faces[i];
    }
    return count;
}

/* ---- a primitive ----------------------------------------------------------------------------- */

static void geometry_deinit(ppm_context *context, ppmi_obj_geometry *g)
{
    ppmi_obj_triples_deinit(context, &g->vertices);
    ppmi_free(context, g->indices);
    ppmi_free(context, g->positions);
    ppmi_free(context, g->uvs);
    ppmi_free(context, g->normals);
    ppmi_free(context, g->tangents);
    ppmi_free(context, g->colors);
}

static void survey(const ppmi_obj_reader *r, const slice *s, ppmi_obj_geometry *g)
{
    const uint32_t *faces = r->faces.items;
    g->kind = s->runs[0].kind;
    for (size_t i = 0; i < s->count; ++i) {
        const ppmi_obj_corner *corners = corners_of(r, &s->runs[i]);
        const size_t count = corner_count(r, &s->runs[i]);
        for (size_t k = s->runs[i].first_face; k < s->runs[i].end_face; ++k) {
            g->element_count += ppmi_obj_element_count(g->kind, faces[k]);
        }
        for (size_t k = 0; k < count; ++k) {
            g->has_uvs = g->has_uvs || corners[k].uv >= 0;
            g->has_normals = g->has_normals || corners[k].normal >= 0;
            g->lacks_normals = g->lacks_normals || corners[k].normal < 0;
        }
    }
}

/* Gives corners without a normal the face's, where others have one. False when memory is out. */
static bool add_flat_normal(ppmi_obj_reader *r, ppmi_obj_corner *corners, uint32_t count,
                            const double normal[3])
{
    const double size = sqrt(normal[0] * normal[0] + normal[1] * normal[1] + normal[2] * normal[2]);
    float *added = NULL;
    for (uint32_t i = 0; i < count; ++i) {
        if (corners[i].normal >= 0) continue;
        if (!added) {
            if (r->normals.count >= INT32_MAX) return false;
            added = ppmi_obj_push(r->context, &r->normals, 1, 3 * sizeof *added);
            if (!added) return false;
            for (int k = 0; k < 3; ++k) {
                added[k] = (float)(size > 0.0 ? normal[k] / size : 0.0);
            }
        }
        corners[i].normal = (int32_t)(r->normals.count - 1);
    }
    return true;
}

/* Replaces indices of corners by those of vertices. */
static bool number_vertices(ppmi_obj_reader *r, ppmi_obj_geometry *g,
                            const ppmi_obj_corner *corners, uint32_t *indices, size_t count)
{
    for (size_t i = 0; i < count; ++i) {
        const ppmi_obj_corner *corner = &corners[indices[i]];
        const ppmi_obj_triple key = {corner->position, corner->uv, corner->normal};
        if (!ppmi_obj_triples_add(r->context, &g->vertices, key, &indices[i])) return false;
    }
    return true;
}

static size_t indices_per_element(int32_t kind)
{
    return kind == PPM_PRIMITIVE_POINTS ? 1 : kind == PPM_PRIMITIVE_LINES ? 2 : 3;
}

/* Triangulates a face and numbers its vertices. */
static bool add_face(ppmi_obj_reader *r, ppmi_obj_geometry *g, ppmi_obj_corner *corners,
                     uint32_t count, uint32_t *out)
{
    double normal[3] = {0.0, 0.0, 0.0};
    const bool is_mixed = g->has_normals && g->lacks_normals;
    if (count > 3 || is_mixed) ppmi_obj_face_normal(r, corners, count, normal);
    r->tally.flat_faces += corners[0].normal < 0;
    if (is_mixed && !add_flat_normal(r, corners, count, normal)) return false;
    if (!ppmi_obj_triangulate(r->context, &r->polygons, r->positions.items, corners, count, normal,
                              out)) {
        return false;
    }
    return number_vertices(r, g, corners, out, 3 * ((size_t)count - 2));
}

/* Points, or segments from each corner to the next. */
static bool add_stroke(ppmi_obj_reader *r, ppmi_obj_geometry *g, const ppmi_obj_corner *corners,
                       uint32_t count, uint32_t *out)
{
    const size_t sides = g->kind == PPM_PRIMITIVE_LINES ? 2 : 1;
    const size_t elements = ppmi_obj_element_count(g->kind, count);
    for (size_t i = 0; i < elements; ++i) {
        for (size_t k = 0; k < sides; ++k) {
            out[sides * i + k] = (uint32_t)(i + k);
        }
    }
    return number_vertices(r, g, corners, out, sides * elements);
}

static bool add_faces(ppmi_obj_reader *r, const slice *s, ppmi_obj_geometry *g)
{
    const uint32_t *faces = r->faces.items;
    uint32_t *out = g->indices;
    for (size_t i = 0; i < s->count; ++i) {
        ppmi_obj_corner *corners = corners_of(r, &s->runs[i]);
        for (size_t k = s->runs[i].first_face; k < s->runs[i].end_face; ++k) {
            const bool ok = g->kind == PPM_PRIMITIVE_TRIANGLES
                                ? add_face(r, g, corners, faces[k], out)
                                : add_stroke(r, g, corners, faces[k], out);
            if (!ok) return false;
            corners += faces[k];
            out += indices_per_element(g->kind) * ppmi_obj_element_count(g->kind, faces[k]);
        }
    }
    return true;
}

static float srgb_to_linear(float x)
{
    x = fminf(fmaxf(x, 0.0f), 1.0f);
    return x <= 0.04045f ? x / 12.92f : powf((x + 0.055f) / 1.055f, 2.4f);
}

static void write_vertex(const ppmi_obj_reader *r, ppmi_obj_triple t, size_t i,
                         ppmi_obj_geometry *g)
{
    const float *positions = r->positions.items, *uvs = r->uvs.items, *normals = r->normals.items;
    memcpy(g->positions + 3 * i, positions + 3 * (size_t)t.a, 3 * sizeof *positions);
    if (g->uvs) {
        g->uvs[2 * i] = t.b >= 0 ? uvs[2 * (size_t)t.b] : 0.0f;
        g->uvs[2 * i + 1] = t.b >= 0 ? 1.0f - uvs[2 * (size_t)t.b + 1] : 0.0f;
    }
    if (g->normals) {
        memcpy(g->normals + 3 * i, normals + 3 * (size_t)t.c, 3 * sizeof *normals);
    }
    for (size_t k = 0; g->colors && k < 3; ++k) {
        const float color = ((const float *)r->colors.items)[3 * (size_t)t.a + k];
        g->colors[4 * i + k] = srgb_to_linear(color * r->color_scale);
    }
    if (g->colors) g->colors[4 * i + 3] = 1.0f;
}

static bool write_vertices(ppmi_obj_reader *r, ppmi_obj_geometry *g)
{
    const size_t count = g->vertex_count;
    const bool has_colors = r->colors.count > 0;
    g->positions = ppmi_alloc(r->context, count, 3 * sizeof *g->positions);
    if (g->has_uvs) g->uvs = ppmi_alloc(r->context, count, 2 * sizeof *g->uvs);
    if (g->has_normals) g->normals = ppmi_alloc(r->context, count, 3 * sizeof *g->normals);
    if (has_colors) g->colors = ppmi_alloc(r->context, count, 4 * sizeof *g->colors);
    if (!g->positions || (g->has_uvs && !g->uvs) || (g->has_normals && !g->normals) ||
        (has_colors && !g->colors)) {
        return false;
    }
    for (size_t i = 0; i < count; ++i) {
        write_vertex(r, ((const ppmi_obj_triple *)g->vertices.items.items)[i], i, g);
    }
    return true;
}

static void describe(ppmi_obj_reader *r, const ppmi_obj_geometry *g, ppm_material_id material,
                     ppm_primitive_desc *out)
{
    const bool is_stroke = g->kind != PPM_PRIMITIVE_TRIANGLES;
    *out = (ppm_primitive_desc){.vertex_count = (uint32_t)g->vertex_count,
                                .triangle_count = is_stroke ? 0 : (uint32_t)g->element_count,
                                .positions = g->positions,
                                .normals = g->normals,
                                .tangents = g->tangents,
                                .uvs = {g->uvs},
                                .colors = g->colors,
                                .indices = g->indices,
                                .material = material,
                                .kind = g->kind,
                                .element_count = is_stroke ? (uint32_t)g->element_count : 0,
                                .radius_m = is_stroke ? ppmi_obj_line_radius(r) : 0.0f};
}

static ppm_status make_arrays(ppmi_obj_reader *r, const slice *s, bool needs_tangents,
                              ppmi_obj_geometry *g)
{
    g->indices =
        ppmi_alloc(r->context, g->element_count, indices_per_element(g->kind) * sizeof *g->indices);
    if (!g->indices || !add_faces(r, s, g)) return ppmi_obj_out_of_memory(r);
    g->vertex_count = g->vertices.items.count;
    if (!write_vertices(r, g)) return ppmi_obj_out_of_memory(r);
    /* no longer needed, and as large as what is */
    ppmi_obj_triples_deinit(r->context, &g->vertices);
    if (needs_tangents && g->normals && g->uvs && !ppmi_obj_add_tangents(r->context, g)) {
        return ppmi_obj_out_of_memory(r);
    }
    return PPM_STATUS_OK;
}

static ppm_status make_primitive(ppmi_obj_reader *r, const slice *s, ppmi_obj_geometry *g,
                                 ppm_primitive_desc *out)
{
    ppm_material_id material = 0;
    bool needs_tangents = false;
    const uint32_t used = s->runs[0].material;
    ppm_status status =
        used > 0 ? ppmi_obj_use_material(r, used - 1, &material, &needs_tangents) : PPM_STATUS_OK;
    if (status != PPM_STATUS_OK) return status;
    survey(r, s, g);
    if (g->element_count > UINT32_MAX / 3) {
        return ppmi_fail(r->context, PPM_STATUS_INPUT_UNSUPPORTED,
                         "%s: '%s' has more than 2^32 corners of one material", r->path,
                         ppmi_obj_names_get(&r->objects, s->runs[0].object));
    }
    status = make_arrays(r, s, needs_tangents && g->kind == PPM_PRIMITIVE_TRIANGLES, g);
    if (status == PPM_STATUS_OK) describe(r, g, material, out);
    return status;
}

/* ---- the transform --------------------------------------------------------------------------- */

/* To metres with +Y up: (x, y, z) of a file with +Z up becomes (x, z, -y). */
static void write_transform(const ppm_import_options *options, float out[16])
{
    const float unit = options->unit_scale > 0.0f ? options->unit_scale : 1.0f;
    const bool is_z_up = options->up == PPM_UP_Z;
    memset(out, 0, 16 * sizeof *out);
    out[0] = unit;
    out[is_z_up ? 6 : 5] = is_z_up ? -unit : unit;
    out[is_z_up ? 9 : 10] = unit;
    out[15] = 1.0f;
}

/* ---- a node ---------------------------------------------------------------------------------- */

/* What a node is a part of: its o, else the file. A new string; NULL when memory is out. */
static char *make_asset(const ppmi_obj_reader *r, uint32_t object)
{
    const size_t *lengths = r->object_lengths.items;
    if (lengths[object] == 0) return ppmi_string_copy(r->context, r->stem);
    char *asset = ppmi_string_copy(r->context, ppmi_obj_names_get(&r->objects, object));
    if (asset) asset[lengths[object]] = '\0';
    return asset;
}

/* Nodes of faces without o or g have the file's name. */
static ppm_status add_node(ppmi_obj_reader *r, uint32_t object, const ppm_primitive_desc *descs,
                           size_t count)
{
    const char *name = ppmi_obj_names_get(&r->objects, object);
    const ppm_mesh_desc mesh = {.size = sizeof mesh,
                                .name = *name ? name : r->stem,
                                .primitive_count = (uint32_t)count,
                                .primitives = descs};
    char *asset = make_asset(r, object);
    if (!asset) return ppmi_obj_out_of_memory(r);
    ppm_instance_desc instance = {.size = sizeof instance, .name = mesh.name, .asset = asset};
    ppm_instance_id id;
    write_transform(r->options, instance.transform);
    ppm_status status = ppm_scene_add_mesh(r->scene, &mesh, &instance.mesh);
    if (status == PPM_STATUS_OK) status = ppm_scene_add_instance(r->scene, &instance, &id);
    ppmi_free(r->context, asset);
    return status;
}

static size_t same_part(const ppmi_obj_run *runs, size_t count)
{
    size_t i = 1;
    while (i < count && runs[i].material == runs[0].material && runs[i].kind == runs[0].kind) {
        ++i;
    }
    return i;
}

static size_t count_parts(const ppmi_obj_run *runs, size_t count)
{
    size_t parts = 0;
    for (size_t i = 0; i < count; i += same_part(runs + i, count - i)) {
        ++parts;
    }
    return parts;
}

static ppm_status emit_object(ppmi_obj_reader *r, const ppmi_obj_run *runs, size_t count)
{
    const size_t most = count_parts(runs, count);
    ppmi_obj_geometry *all = ppmi_alloc_zeroed(r->context, most, sizeof *all);
    ppm_primitive_desc *descs = ppmi_alloc(r->context, most, sizeof *descs);
    ppm_status status = all && descs ? PPM_STATUS_OK : ppmi_obj_out_of_memory(r);
    size_t done = 0;
    for (size_t i = 0; i < count && status == PPM_STATUS_OK; ++done) {
        const slice s = {runs + i, same_part(runs + i, count - i)};
        status = make_primitive(r, &s, &all[done], &descs[done]);
        i += s.count;
    }
    if (status == PPM_STATUS_OK) status = add_node(r, runs[0].object, descs, done);
    for (size_t i = 0; all && i < most; ++i) {
        geometry_deinit(r->context, &all[i]);
    }
    ppmi_free(r->context, all);
    ppmi_free(r->context, descs);
    return status;
}

/* What all vertex colours are like. */
typedef struct color_facts {
    float most;
    bool are_whole;  /* numbers without a fraction */
    size_t count;    /* of colours that are finite */
    size_t far_over; /* those of them with a channel that is well beyond 1 */
} color_facts;

static color_facts look_at_colors(const ppmi_obj_reader *r)
{
    const float *colors = r->colors.items, well_beyond = 2.0f;
    color_facts facts = {.are_whole = true};
    for (size_t i = 0; i < r->colors.count; ++i) {
        const float *c = colors + 3 * i;
        const float most = fmaxf(c[0], fmaxf(c[1], c[2]));
        if (!isfinite(c[0] + c[1] + c[2])) continue;
        facts.count++;
        facts.most = fmaxf(facts.most, most);
        facts.far_over += most > well_beyond;
        for (int k = 0; k < 3; ++k) {
            facts.are_whole = facts.are_whole && c[k] == floorf(c[k]);
        }
    }
    return facts;
}

/* Some programs write 0 .. 255. They are known by whole numbers, of which one is more than any
 * light colour of 0 .. 1 that rounding or a bright pixel made, or by most of the colours being far
 * beyond
 * 1. Else what is beyond 1 is cut: nothing is so dark as a model whose 1.001 is read as of 255. */
static void find_color_scale(ppmi_obj_reader *r)
{
    const color_facts facts = look_at_colors(r);
    const float least_byte = 8.0f, rounding = 1.0f + 0.5f / 255.0f;
    const bool are_bytes = facts.are_whole
                               ? facts.most >= least_byte
                               : 2 * facts.far_over > facts.count && facts.most >= least_byte;
    r->color_scale = are_bytes ? 1.0f / 255.0f : 1.0f;
    if (are_bytes) {
        ppmi_log(r->context, PPM_LOG_WARNING,
                 "%s: vertex colours go up to %g: they are read as 0 .. 255", r->path,
                 (double)facts.most);
    } else if (facts.most > rounding) {
        ppmi_log(r->context, PPM_LOG_WARNING,
                 "%s: vertex colours go up to %g: what is beyond 1 is cut", r->path,
                 (double)facts.most);
    }
}

ppm_status ppmi_obj_emit(ppmi_obj_reader *r)
{
    ppmi_obj_run *runs = r->runs.items;
    ppm_status status = PPM_STATUS_OK;
    if (r->runs.count > 1) qsort(runs, r->runs.count, sizeof *runs, compare_runs);
    find_color_scale(r);
    for (size_t i = 0; i < r->runs.count && status == PPM_STATUS_OK;) {
        size_t end = i + 1;
        while (end < r->runs.count && runs[end].object == runs[i].object) {
            ++end;
        }
        status = emit_object(r, runs + i, end - i);
        i = end;
    }
    return status;
}
