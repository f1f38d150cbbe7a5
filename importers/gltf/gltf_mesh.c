/* Meshes: the attributes and indices of their primitives, read and handed to the scene. Anything
 * wrong with them is an error of the file: a guess would show wrong geometry. */
#include <math.h>
#include <stdio.h>
#include <string.h>

#include "gltf/gltf_decoded.h"
#include "gltf/gltf_deform.h"
#include "gltf/gltf_geometry.h"
#include "gltf/gltf_reader.h"

/* Arrays of smaller meshes are freed together: one by one they would leave holes in the heap. */
enum { LARGE_MESH_VERTICES = 1 << 12 };

static const ppmi_gltf_format vec2_format = {2, 2, 2, false};
static const ppmi_gltf_format vec3_format = {3, 3, 3, false};
static const ppmi_gltf_format vec4_format = {4, 4, 4, false};
static const ppmi_gltf_format color_format = {3, 4, 4, true};

static void free_geometry(ppm_context *context, ppmi_gltf_geometry *g)
{
    if (!g->is_taken) {
        ppmi_free(context, g->positions);
        ppmi_free(context, g->normals);
        ppmi_free(context, g->tangents);
    }
    ppmi_free(context, g->colors);
    for (size_t i = 0; i < PPM_MAX_UV_SETS; ++i) {
        ppmi_free(context, g->uvs[i]);
    }
    ppmi_free(context, g->indices);
    ppmi_free(context, g->sources);
}

/* An attribute that may be absent; it must have as many elements as POSITION. */
static ppm_status read_attribute(ppmi_gltf_reader *reader, const ppmi_gltf_primitive *primitive,
                                 const char *name, const ppmi_gltf_format *format,
                                 const char *place, size_t vertex_count, float **out)
{
    char inner[PPMI_GLTF_PLACE];
    size_t count;
    const int32_t accessor =
        ppmi_gltf_find_attribute(primitive->attributes, primitive->attribute_count, name);
    if (accessor < 0) return PPM_STATUS_OK;
    ppmi_gltf_place(inner, "%s.attributes.%s", place, name);
    const ppm_status status = ppmi_gltf_read_floats(reader, accessor, inner, format, out, &count);
    if (status != PPM_STATUS_OK || count == vertex_count) return status;
    return ppmi_gltf_invalid(reader, inner, "%zu elements, POSITION has %zu", count, vertex_count);
}

/* Whether the primitive's material has a use for TANGENT or TEXCOORD_n. */
static bool is_used(ppmi_gltf_reader *reader, const ppmi_gltf_primitive *primitive,
                    const char *name)
{
    int set;
    const int32_t material = ppmi_gltf_variant_material(reader, primitive);
    if (sscanf(name, "TEXCOORD_%1d", &set) != 1)
        return ppmi_gltf_tangent_set(reader, material) >= 0;
    return ppmi_gltf_material_uv_sets(reader, material) >> set & 1;
}

/* TANGENT or TEXCOORD_n. Where it is of a wrong type and nothing uses it, it is left out. */
static ppm_status read_useful(ppmi_gltf_reader *reader, const ppmi_gltf_primitive *primitive,
                              const char *name, const ppmi_gltf_format *format, const char *place,
                              size_t vertex_count, float **out)
{
    char inner[PPMI_GLTF_PLACE], fault[PPMI_GLTF_FAULT];
    const int32_t accessor =
        ppmi_gltf_find_attribute(primitive->attributes, primitive->attribute_count, name);
    if (ppmi_gltf_is_usable(reader, PPMI_GLTF_ACCESSORS, accessor, inner, sizeof inner) &&
        ppmi_gltf_type_is_wrong(&reader->document->accessors[accessor], format, fault) &&
        !is_used(reader, primitive, name)) {
        ppmi_gltf_place(inner, "%s.attributes.%s (accessors[%d])", place, name, (int)accessor);
        ppmi_gltf_warn(reader, inner, "%s: left out, since nothing uses it", fault);
        ppmi_gltf_note_feature(reader, "unused attributes of a wrong type", PPM_FEATURE_IGNORED,
                               "left out");
        return PPM_STATUS_OK;
    }
    return read_attribute(reader, primitive, name, format, place, vertex_count, out);
}

static ppm_status read_attributes(ppmi_gltf_reader *reader, const ppmi_gltf_primitive *primitive,
                                  const char *place, ppmi_gltf_geometry *g)
{
    char name[24];
    const size_t count = g->vertex_count;
    ppm_status status =
        read_attribute(reader, primitive, "NORMAL", &vec3_format, place, count, &g->normals);
    if (status == PPM_STATUS_OK && g->normals) { /* without normals tangents must be ignored */
        status =
            read_useful(reader, primitive, "TANGENT", &vec4_format, place, count, &g->tangents);
    }
    if (status == PPM_STATUS_OK) {
        status =
            read_attribute(reader, primitive, "COLOR_0", &color_format, place, count, &g->colors);
    }
    for (int i = 0; i < PPM_MAX_UV_SETS && status == PPM_STATUS_OK; ++i) {
        snprintf(name, sizeof name, "TEXCOORD_%d", i);
        status = read_useful(reader, primitive, name, &vec2_format, place, count, &g->uvs[i]);
    }
    return status;
}

/* Whether a value in the list of a strip, fan or loop is PPMI_GLTF_RESTART. */
static bool has_restarts(const ppmi_gltf_primitive *primitive, uint32_t index)
{
    const bool is_joined =
        primitive->mode == PPMI_GLTF_LINE_LOOP || primitive->mode == PPMI_GLTF_LINE_STRIP ||
        primitive->mode == PPMI_GLTF_TRIANGLE_STRIP || primitive->mode == PPMI_GLTF_TRIANGLE_FAN;
    return is_joined && index == PPMI_GLTF_RESTART;
}

/* KHR_mesh_primitive_restart: the largest value of the type that indices are stored in. Viewers in
 * browsers restart there whatever the file says (WebGL 2.0 specification, section 5.18). */
static void mark_restarts(ppmi_gltf_reader *reader, const ppmi_gltf_primitive *primitive,
                          const char *place, uint32_t *indices, size_t count)
{
    const int32_t type = reader->document->accessors[primitive->indices].component_type;
    const uint32_t largest = type == PPMI_GLTF_UNSIGNED_BYTE    ? UINT8_MAX
                             : type == PPMI_GLTF_UNSIGNED_SHORT ? UINT16_MAX
                                                                : UINT32_MAX;
    size_t restarts = 0;
    if (!has_restarts(primitive, PPMI_GLTF_RESTART)) return;
    for (size_t i = 0; i < count; ++i) {
        if (indices[i] != largest) continue;
        indices[i] = PPMI_GLTF_RESTART;
        ++restarts;
    }
    if (restarts == 0 || ppmi_gltf_find_feature(reader, "KHR_mesh_primitive_restart")) return;
    ppmi_gltf_warn(reader, place,
                   "%zu indices are %u: the primitive starts anew there, as by "
                   "KHR_mesh_primitive_restart, which the file does not name",
                   restarts, (unsigned)largest);
    ppmi_gltf_note_feature(reader, "restarts without KHR_mesh_primitive_restart",
                           PPM_FEATURE_IGNORED, "that the extension is not named");
}

/* The index list, or 0, 1, 2 ... without one. */
static ppm_status read_index_list(ppmi_gltf_reader *reader, const ppmi_gltf_primitive *primitive,
                                  const char *place, size_t vertex_count, uint32_t **out,
                                  size_t *out_count)
{
    char inner[PPMI_GLTF_PLACE];
    ppmi_gltf_place(inner, "%s.indices", place);
    if (primitive->indices < 0) {
        *out_count = vertex_count;
        *out = ppmi_alloc(reader->context, vertex_count, sizeof **out);
        if (!*out) return ppmi_gltf_out_of_memory(reader, inner);
        for (size_t i = 0; i < vertex_count; ++i) {
            (*out)[i] = (uint32_t)i;
        }
        return PPM_STATUS_OK;
    }
    const ppm_status status =
        ppmi_gltf_read_indices(reader, primitive->indices, inner, out, out_count);
    if (status != PPM_STATUS_OK) return status;
    mark_restarts(reader, primitive, inner, *out, *out_count);
    for (size_t i = 0; i < *out_count; ++i) {
        if ((*out)[i] < vertex_count || has_restarts(primitive, (*out)[i])) continue;
        return ppmi_gltf_invalid(reader, inner, "index %zu is %u, there are %zu vertices", i,
                                 (unsigned)(*out)[i], vertex_count);
    }
    return PPM_STATUS_OK;
}

/* Strips in a Draco stream come as lists. */
static int32_t mode_of(const ppmi_gltf_reader *reader, const ppmi_gltf_primitive *primitive)
{
    const bool is_draco = primitive->is_draco && primitive->indices >= 0 &&
                          (size_t)primitive->indices < reader->document->accessor_count &&
                          reader->document->accessors[primitive->indices].buffer_view < 0;
    return is_draco ? PPMI_GLTF_TRIANGLES : primitive->mode;
}

/* Takes the list where it is a triangle list already: *list is then NULL. */
static ppm_status make_elements(ppmi_gltf_reader *reader, int32_t mode, uint32_t **list,
                                size_t count, ppmi_gltf_geometry *g)
{
    if (mode == PPMI_GLTF_TRIANGLES) {
        if (count % 3 != 0) reader->tally.broken_counts++;
        g->triangle_count = count / 3;
        g->index_count = 3 * g->triangle_count;
        g->indices = *list;
        *list = NULL;
        return PPM_STATUS_OK;
    }
    if (mode >= PPMI_GLTF_TRIANGLES) {
        const ppm_status status = ppmi_gltf_triangles(reader->context, mode, *list, count,
                                                      &g->indices, &g->triangle_count);
        g->index_count = 3 * g->triangle_count;
        return status;
    }
    g->kind = mode == PPMI_GLTF_POINTS ? PPM_PRIMITIVE_POINTS : PPM_PRIMITIVE_LINES;
    const ppm_status status = ppmi_gltf_points_and_lines(reader->context, mode, *list, count,
                                                         &g->indices, &g->element_count);
    g->index_count = (mode == PPMI_GLTF_POINTS ? 1 : 2) * g->element_count;
    return status;
}

static ppm_status read_elements(ppmi_gltf_reader *reader, const ppmi_gltf_primitive *primitive,
                                const char *place, ppmi_gltf_geometry *g)
{
    uint32_t *list = NULL;
    size_t count = 0;
    ppm_status status = read_index_list(reader, primitive, place, g->vertex_count, &list, &count);
    if (status == PPM_STATUS_OK) {
        status = make_elements(reader, mode_of(reader, primitive), &list, count, g);
        if (status != PPM_STATUS_OK) ppmi_gltf_out_of_memory(reader, place);
    }
    ppmi_free(reader->context, list);
    if (status == PPM_STATUS_OK &&
        (g->triangle_count > UINT32_MAX || g->element_count > UINT32_MAX)) {
        return ppmi_gltf_invalid(reader, place, "more than 2^32 triangles");
    }
    return status;
}

/* Fills g, with positions from base on; g->index_count stays 0 for what cannot be drawn. */
static ppm_status read_primitive(ppmi_gltf_reader *reader, const ppmi_gltf_primitive *primitive,
                                 const char *place, const double base[3], ppmi_gltf_geometry *g)
{
    char inner[PPMI_GLTF_PLACE];
    const int32_t position =
        ppmi_gltf_find_attribute(primitive->attributes, primitive->attribute_count, "POSITION");
    if (position < 0) {
        reader->tally.no_positions++;
        return PPM_STATUS_OK;
    }
    ppmi_gltf_place(inner, "%s.attributes.POSITION", place);
    ppm_status status =
        ppmi_gltf_read_positions(reader, position, inner, base, &g->positions, &g->vertex_count);
    if (status != PPM_STATUS_OK) return status;
    g->source_count = g->vertex_count;
    if (g->vertex_count > UINT32_MAX) {
        return ppmi_gltf_invalid(reader, inner, "more than 2^32 vertices");
    }
    status = read_elements(reader, primitive, place, g);
    if (status != PPM_STATUS_OK || g->index_count == 0) return status;
    status = read_attributes(reader, primitive, place, g);
    if (status != PPM_STATUS_OK) return status;
    if (!ppmi_gltf_compact(reader->context, g)) return ppmi_gltf_out_of_memory(reader, place);
    status =
        ppmi_gltf_add_tangents(reader, ppmi_gltf_variant_material(reader, primitive), place, g);
    if (status != PPM_STATUS_OK) return status;
    ppmi_gltf_place(inner, "%s.material", place);
    return ppmi_gltf_use_material(reader, ppmi_gltf_variant_material(reader, primitive), inner,
                                  &g->material);
}

static void describe(const ppmi_gltf_geometry *g, float radius_m, ppm_primitive_desc *out)
{
    *out = (ppm_primitive_desc){.vertex_count = (uint32_t)g->vertex_count,
                                .triangle_count = (uint32_t)g->triangle_count,
                                .kind = g->kind,
                                .element_count = (uint32_t)g->element_count,
                                .radius_m = g->kind == PPM_PRIMITIVE_TRIANGLES ? 0.0f : radius_m,
                                .positions = g->positions,
                                .normals = g->normals,
                                .tangents = g->tangents,
                                .colors = g->colors,
                                .indices = g->indices,
                                .material = g->material};
    for (size_t i = 0; i < PPM_MAX_UV_SETS; ++i) {
        out->uvs[i] = g->uvs[i];
    }
}

/* The primitives of a mesh whose arrays the scene copies. */
typedef struct handover {
    ppm_context *context;
    ppmi_gltf_geometry *all;
    uint32_t count;
} handover;

/* Frees *values if they are the array. */
static void free_if(ppm_context *context, float **values, const void *array)
{
    if (*values != array) return;
    ppmi_free(context, *values);
    *values = NULL;
}

/* An array that the scene has copied: a large mesh is not held twice as a whole. */
static void release_array(void *user, const void *array)
{
    const handover *h = user;
    for (uint32_t i = 0; i < h->count; ++i) {
        ppmi_gltf_geometry *g = &h->all[i];
        if (!g->is_taken) {
            free_if(h->context, &g->positions, array);
            free_if(h->context, &g->normals, array);
            free_if(h->context, &g->tangents, array);
        }
        free_if(h->context, &g->colors, array);
        for (size_t k = 0; k < PPM_MAX_UV_SETS; ++k)
            free_if(h->context, &g->uvs[k], array);
        if (g->indices == array) {
            ppmi_free(h->context, g->indices);
            g->indices = NULL;
        }
    }
}

static bool is_large(const ppmi_gltf_geometry *all, size_t count)
{
    size_t vertices = 0;
    for (size_t i = 0; i < count; ++i)
        vertices += all[i].vertex_count;
    return vertices > LARGE_MESH_VERTICES;
}

/* Hands the drawable ones of a mesh's primitives to the scene; deform is NULL for one that keeps
 * its shape. */
static ppm_status emit(ppmi_gltf_reader *reader, const ppmi_gltf_mesh *mesh,
                       ppmi_gltf_geometry *all, ppm_primitive_desc *descs, ppmi_gltf_deform *deform,
                       ppm_mesh_id *out_id)
{
    char name[PPMI_GLTF_PLACE];
    uint32_t count = 0;
    const float wanted_m = reader->options->line_radius_m;
    const float radius_m =
        wanted_m > 0.0f ? wanted_m : ppmi_gltf_line_radius(all, mesh->primitive_count);
    *out_id = 0;
    for (uint32_t i = 0; i < mesh->primitive_count; ++i) {
        if (all[i].index_count == 0) continue;
        describe(&all[i], radius_m, &descs[count]);
        if (deform) {
            const ppm_status status = ppmi_gltf_deform_pose(reader, deform, count, &descs[count]);
            if (status != PPM_STATUS_OK) return status;
        }
        ++count;
    }
    if (count == 0) return PPM_STATUS_OK;
    handover h = {reader->context, all, mesh->primitive_count};
    const ppm_mesh_desc desc = {
        .size = sizeof desc,
        .name = ppmi_gltf_printable(mesh->name, strlen(mesh->name), name, sizeof name),
        .primitive_count = count,
        .primitives = descs,
        .release = is_large(all, mesh->primitive_count) ? release_array : NULL,
        .release_user = &h};
    return ppm_scene_add_mesh(reader->scene, &desc, out_id);
}

/* What deforms a mesh works on floats of its own coordinates. */
static ppm_status choose_base(ppmi_gltf_reader *reader, int32_t mesh,
                              const ppmi_gltf_deform *deform, double base[3])
{
    char place[PPMI_GLTF_PLACE];
    const ppm_status status = ppmi_gltf_mesh_base(reader, mesh, base);
    const double most = fmax(fabs(base[0]), fmax(fabs(base[1]), fabs(base[2])));
    if (!deform || status != PPM_STATUS_OK) return status;
    memset(base, 0, 3 * sizeof *base);
    if (most < 1000.0) return status;
    ppmi_gltf_place(place, "meshes[%d]", (int)mesh);
    ppmi_gltf_warn(reader, place,
                   "it is deformed %.0f m away from its point 0: its doubles are "
                   "rounded to floats, by %g m",
                   most, most * ldexp(1.0, -24));
    return status;
}

static ppm_status import_mesh(ppmi_gltf_reader *reader, int32_t index, ppmi_gltf_deform *deform,
                              ppm_mesh_id *out_id)
{
    const ppmi_gltf_mesh *mesh = &reader->document->meshes[index];
    char place[PPMI_GLTF_PLACE];
    *out_id = 0;
    if (mesh->primitive_count == 0) return PPM_STATUS_OK;
    ppmi_gltf_place(place, "meshes[%d]", (int)index);
    ppmi_gltf_geometry *all =
        ppmi_alloc_zeroed(reader->context, mesh->primitive_count, sizeof *all);
    ppm_primitive_desc *descs = ppmi_alloc(reader->context, mesh->primitive_count, sizeof *descs);
    ppm_status status = PPM_STATUS_OK;
    double base[3];
    if (!all || !descs) status = ppmi_gltf_out_of_memory(reader, place);
    if (status == PPM_STATUS_OK) status = choose_base(reader, index, deform, base);
    for (uint32_t i = 0; i < mesh->primitive_count && status == PPM_STATUS_OK; ++i) {
        ppmi_gltf_place(place, "meshes[%d].primitives[%u]", (int)index, (unsigned)i);
        status = read_primitive(reader, &mesh->primitives[i], place, base, &all[i]);
        if (status == PPM_STATUS_OK && deform && all[i].index_count > 0) {
            status = ppmi_gltf_deform_read(reader, deform, &mesh->primitives[i], place, &all[i]);
        }
    }
    if (status == PPM_STATUS_OK) {
        status = emit(reader, mesh, all, descs, deform, out_id);
    }
    if (deform) ppmi_gltf_deform_release(reader->context, deform);
    for (uint32_t i = 0; all && i < mesh->primitive_count; ++i) {
        free_geometry(reader->context, &all[i]);
        ppmi_gltf_decoded_release(reader, &mesh->primitives[i]);
    }
    ppmi_free(reader->context, all);
    ppmi_free(reader->context, descs);
    return status;
}

ppm_status ppmi_gltf_use_mesh(ppmi_gltf_reader *reader, int32_t mesh, const char *place,
                              ppm_mesh_id *out_id)
{
    ppm_status status = ppmi_gltf_require(reader, PPMI_GLTF_MESHES, mesh, place);
    if (status != PPM_STATUS_OK) return status;
    if (reader->meshes[mesh] == 0 && !reader->empty_meshes[mesh]) {
        status = import_mesh(reader, mesh, NULL, &reader->meshes[mesh]);
        reader->empty_meshes[mesh] = reader->meshes[mesh] == 0;
    }
    *out_id = reader->meshes[mesh];
    return status;
}

ppm_status ppmi_gltf_add_deformed_mesh(ppmi_gltf_reader *reader, ppmi_gltf_deform *deform)
{
    const int32_t mesh = reader->document->nodes[deform->node].mesh;
    return import_mesh(reader, mesh, deform, &deform->mesh);
}
