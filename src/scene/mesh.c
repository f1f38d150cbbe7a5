/* Meshes and instances: checked and copied. */
#include <string.h>

#include "scene/scene.h"

typedef struct mesh_faults {
    uint64_t not_finite; /* triangles with a NaN or infinite position */
    uint64_t no_area;
    uint64_t bad_normals;
} mesh_faults;

static ppm_status out_of_memory(ppm_scene *scene, const char *name)
{
    return ppmi_fail(scene->context, PPM_STATUS_OUT_OF_MEMORY, "mesh '%s': out of memory", name);
}

static float *copy_floats(ppm_scene *scene, const float *values, size_t count, size_t padding)
{
    float *copy = ppmi_alloc(scene->context, count + padding, sizeof *copy);
    if (!copy) return NULL;
    memcpy(copy, values, count * sizeof *copy);
    memset(copy + count, 0, padding * sizeof *copy);
    return copy;
}

/* Copies an optional array; false when memory is out. */
/* Whom to tell of an array that has been copied. */
typedef struct releaser {
    void (*release)(void *user, const void *array);
    void *user;
} releaser;

static void let_go(const releaser *to, const void *array)
{
    if (to->release && array) to->release(to->user, array);
}

static bool copy_optional(ppm_scene *scene, const float *values, size_t count, const releaser *to,
                          float **out_copy)
{
    if (!values) return true;
    *out_copy = copy_floats(scene, values, count, 0);
    if (*out_copy) let_go(to, values);
    return *out_copy != NULL;
}

/* What moves with the vertices: one block a motion step. */
static bool copy_vertices(ppm_scene *scene, const ppm_primitive_desc *desc, uint32_t steps,
                          const releaser *to, ppmi_primitive *primitive)
{
    const size_t count = (size_t)steps * desc->vertex_count;
    primitive->motion_steps = steps;
    primitive->positions = copy_floats(scene, desc->positions, 3 * count, 4);
    if (!primitive->positions) return false;
    let_go(to, desc->positions);
    return copy_optional(scene, desc->normals, 3 * count, to, &primitive->normals) &&
           copy_optional(scene, desc->tangents, 4 * count, to, &primitive->tangents);
}

static bool copy_attributes(ppm_scene *scene, const ppm_primitive_desc *desc, const releaser *to,
                            ppmi_primitive *primitive)
{
    const size_t count = desc->vertex_count;
    for (uint32_t i = 0; i < PPM_MAX_UV_SETS; i++) {
        if (!copy_optional(scene, desc->uvs[i], 2 * count, to, &primitive->uvs[i])) return false;
    }
    return copy_optional(scene, desc->colors, 4 * count, to, &primitive->colors);
}

static uint32_t vertices_per_element(int32_t kind)
{
    return kind == PPM_PRIMITIVE_POINTS ? 1 : kind == PPM_PRIMITIVE_LINES ? 2 : 3;
}

/* ---- which elements there are ---------------------------------------------------------------- */

static ppmi_vec3 position_at(const ppmi_primitive *primitive, uint32_t step, uint32_t vertex)
{
    const size_t index = (size_t)step * primitive->vertex_count + vertex;
    return vec3_load(primitive->positions + 3 * index);
}

/* Finite, and no square overflows. */
static bool is_usable(ppmi_vec3 p)
{
    const float most = 1e15f;
    return fabsf(p.x) < most && fabsf(p.y) < most && fabsf(p.z) < most;
}

/* A triangle with an area, a line with a length. */
static bool has_size(const ppmi_vec3 p[3], int32_t kind)
{
    if (kind == PPM_PRIMITIVE_POINTS) return true;
    const ppmi_vec3 edge = vec3_sub(p[1], p[0]);
    if (kind == PPM_PRIMITIVE_LINES) return vec3_length2(edge) > 0.0f;
    return vec3_max_abs(vec3_cross(edge, vec3_sub(p[2], p[0]))) != 0.0f;
}

/* Whether an element can be hit: it is finite at all steps, and of some size at one. Grows the
 * primitive's bounds by those that can. */
static bool keep_element(ppmi_primitive *primitive, const uint32_t *element, mesh_faults *faults)
{
    const uint32_t sides = vertices_per_element(primitive->kind);
    const ppmi_vec3 room = vec3_splat(primitive->radius_m);
    ppmi_vec3 low = primitive->bounds_min, high = primitive->bounds_max;
    bool is_sized = false;
    for (uint32_t step = 0; step < primitive->motion_steps; step++) {
        ppmi_vec3 p[3];
        for (uint32_t k = 0; k < sides; k++) {
            p[k] = position_at(primitive, step, element[k]);
            if (!is_usable(p[k])) {
                faults->not_finite++;
                return false;
            }
            const ppmi_vec3 from = vec3_sub(p[k], room), to = vec3_add(p[k], room);
            low = vec3(ppmi_min(low.x, from.x), ppmi_min(low.y, from.y), ppmi_min(low.z, from.z));
            high = vec3(ppmi_max(high.x, to.x), ppmi_max(high.y, to.y), ppmi_max(high.z, to.z));
        }
        is_sized = is_sized || has_size(p, primitive->kind);
    }
    if (!is_sized) {
        faults->no_area++;
        return false;
    }
    primitive->bounds_min = low;
    primitive->bounds_max = high;
    return true;
}

/* Copies the elements that can be hit. */
static void keep_elements(const uint32_t *given, uint32_t given_count, ppmi_primitive *primitive,
                          mesh_faults *faults)
{
    const size_t sides = vertices_per_element(primitive->kind);
    uint32_t kept = 0;
    primitive->bounds_min = vec3_splat(INFINITY);
    primitive->bounds_max = vec3_splat(-INFINITY);
    for (size_t i = 0; i < given_count; i++) {
        const uint32_t *element = given + sides * i;
        if (!keep_element(primitive, element, faults)) continue;
        memmove(primitive->indices + sides * kept++, element, sides * sizeof *element);
    }
    primitive->element_count = kept;
    primitive->triangle_count = primitive->kind == PPM_PRIMITIVE_TRIANGLES ? kept : 0;
}

static void update_bounds(ppmi_mesh *mesh)
{
    mesh->bounds_min = vec3_splat(INFINITY);
    mesh->bounds_max = vec3_splat(-INFINITY);
    for (uint32_t i = 0; i < mesh->primitive_count; i++) {
        const ppmi_primitive *primitive = &mesh->primitives[i];
        if (primitive->element_count == 0) continue;
        const ppmi_vec3 low = primitive->bounds_min, high = primitive->bounds_max;
        mesh->bounds_min =
            vec3(ppmi_min(mesh->bounds_min.x, low.x), ppmi_min(mesh->bounds_min.y, low.y),
                 ppmi_min(mesh->bounds_min.z, low.z));
        mesh->bounds_max =
            vec3(ppmi_max(mesh->bounds_max.x, high.x), ppmi_max(mesh->bounds_max.y, high.y),
                 ppmi_max(mesh->bounds_max.z, high.z));
    }
}

/* ---- values ---------------------------------------------------------------------------------- */

/* Unit normals; those that cannot be normalised become zero, which shading reads as "the face's".
 */
static void normalize_normals(ppmi_primitive *primitive, mesh_faults *faults)
{
    if (!primitive->normals) return;
    const size_t count = (size_t)primitive->motion_steps * primitive->vertex_count;
    for (size_t i = 0; i < count; i++) {
        float *normal = primitive->normals + 3 * i;
        const ppmi_vec3 n = vec3_load(normal);
        const float length = vec3_length(n);
        const bool is_good = isfinite(length) && length > 1e-12f;
        if (!is_good) faults->bad_normals++;
        vec3_store(normal, is_good ? vec3_scale(n, 1.0f / length) : vec3_splat(0.0f));
    }
}

static void replace_not_finite(float *values, size_t count, float by)
{
    for (size_t i = 0; values && i < count; i++) {
        if (!isfinite(values[i])) values[i] = by;
    }
}

static void clean_vertices(ppmi_primitive *primitive, mesh_faults *faults)
{
    normalize_normals(primitive, faults);
    replace_not_finite(primitive->tangents,
                       4 * (size_t)primitive->motion_steps * primitive->vertex_count, 0.0f);
}

static ppm_status check_steps(ppm_scene *scene, uint32_t steps, uint32_t index, const char *name)
{
    if (steps <= PPM_MAX_MOTION_STEPS) return PPM_STATUS_OK;
    return ppmi_fail(scene->context, PPM_STATUS_INVALID_ARGUMENT,
                     "mesh '%s', primitive %u: %u motion steps, at most %d", name, index, steps,
                     PPM_MAX_MOTION_STEPS);
}

/* Elements of a desc, by its kind. */
static uint32_t given_elements(const ppm_primitive_desc *desc)
{
    return desc->kind == PPM_PRIMITIVE_TRIANGLES ? desc->triangle_count : desc->element_count;
}

static ppm_status check_kind(ppm_scene *scene, const ppm_primitive_desc *desc, uint32_t index,
                             const char *name)
{
    if (desc->kind < PPM_PRIMITIVE_TRIANGLES || desc->kind > PPM_PRIMITIVE_LINES) {
        return ppmi_fail(scene->context, PPM_STATUS_INVALID_ARGUMENT,
                         "mesh '%s', primitive %u: no kind of number %d", name, index,
                         (int)desc->kind);
    }
    if (desc->kind == PPM_PRIMITIVE_TRIANGLES) return PPM_STATUS_OK;
    if (desc->triangle_count > 0 || !(desc->radius_m > 0.0f && desc->radius_m < 1e15f)) {
        return ppmi_fail(scene->context, PPM_STATUS_INVALID_ARGUMENT,
                         "mesh '%s', primitive %u: points and lines have a radius above 0, not %g, "
                         "and no triangles, not %u",
                         name, index, (double)desc->radius_m, desc->triangle_count);
    }
    return PPM_STATUS_OK;
}

static ppm_status check_primitive(ppm_scene *scene, const ppm_primitive_desc *desc, uint32_t index,
                                  const char *name)
{
    if (desc->material > scene->material_count) {
        return ppmi_fail(scene->context, PPM_STATUS_INVALID_ARGUMENT,
                         "mesh '%s', primitive %u: material %u of %u", name, index, desc->material,
                         scene->material_count);
    }
    ppm_status status = check_kind(scene, desc, index, name);
    if (status == PPM_STATUS_OK) status = check_steps(scene, desc->motion_steps, index, name);
    if (status != PPM_STATUS_OK) return status;
    const uint32_t count = given_elements(desc);
    if (count > 0 && (!desc->positions || !desc->indices)) {
        return ppmi_fail(scene->context, PPM_STATUS_INVALID_ARGUMENT,
                         "mesh '%s', primitive %u: no positions or indices", name, index);
    }
    for (size_t i = 0; i < (size_t)vertices_per_element(desc->kind) * count; i++) {
        if (desc->indices[i] >= desc->vertex_count) {
            return ppmi_fail(scene->context, PPM_STATUS_INVALID_ARGUMENT,
                             "mesh '%s', primitive %u: index %zu is %u, of %u vertices", name,
                             index, i, desc->indices[i], desc->vertex_count);
        }
    }
    return PPM_STATUS_OK;
}

/* Blocks that are all alike are no motion. */
static bool blocks_are_alike(const float *values, size_t count, uint32_t steps)
{
    for (uint32_t i = 1; values && i < steps; i++) {
        if (memcmp(values, values + i * count, count * sizeof *values) != 0) return false;
    }
    return true;
}

static uint32_t steps_of(const ppm_primitive_desc *desc)
{
    const size_t count = desc->vertex_count;
    const uint32_t steps = desc->motion_steps > 1 ? desc->motion_steps : 1;
    return blocks_are_alike(desc->positions, 3 * count, steps) &&
                   blocks_are_alike(desc->normals, 3 * count, steps) &&
                   blocks_are_alike(desc->tangents, 4 * count, steps)
               ? 1
               : steps;
}

/* Keeps the given elements beside those that can be hit, where these are fewer: other vertices may
 * bring others. */
static bool keep_given(ppm_scene *scene, const uint32_t *given, uint32_t count,
                       ppmi_primitive *primitive)
{
    if (primitive->element_count == count) return true;
    const size_t size = vertices_per_element(primitive->kind) * sizeof *given;
    primitive->given_indices = ppmi_alloc(scene->context, count, size);
    if (!primitive->given_indices) return false;
    memcpy(primitive->given_indices, given, count * size);
    primitive->given_count = count;
    return true;
}

/* They multiply a reflectance, but may be above 1. */
static void colors_to_working_space(const ppmi_working_space *space, ppmi_primitive *primitive)
{
    if (!primitive->colors || !space->differs) return;
    for (size_t i = 0; i < primitive->vertex_count; i++)
        ppmi_working_light(space, primitive->colors + 4 * i, primitive->colors + 4 * i);
}

static ppm_status fill_primitive(ppm_scene *scene, const ppm_primitive_desc *desc, uint32_t index,
                                 uint32_t default_material, const releaser *to, ppmi_mesh *mesh,
                                 mesh_faults *faults)
{
    ppmi_primitive *primitive = &mesh->primitives[index];
    const uint32_t count = given_elements(desc);
    primitive->material = desc->material > 0 ? desc->material - 1 : default_material;
    primitive->motion_steps = 1;
    primitive->kind = desc->kind;
    primitive->radius_m = desc->kind == PPM_PRIMITIVE_TRIANGLES ? 0.0f : desc->radius_m;
    if (count == 0) return PPM_STATUS_OK;
    primitive->vertex_count = desc->vertex_count;
    primitive->indices = ppmi_alloc(scene->context, count,
                                    vertices_per_element(desc->kind) * sizeof *primitive->indices);
    if (!primitive->indices || !copy_vertices(scene, desc, steps_of(desc), to, primitive) ||
        !copy_attributes(scene, desc, to, primitive)) {
        return out_of_memory(scene, mesh->name);
    }
    keep_elements(desc->indices, count, primitive, faults);
    if (!keep_given(scene, desc->indices, count, primitive)) {
        return out_of_memory(scene, mesh->name);
    }
    let_go(to, desc->indices);
    clean_vertices(primitive, faults);
    replace_not_finite(primitive->colors, 4 * (size_t)primitive->vertex_count, 1.0f);
    colors_to_working_space(&scene->working, primitive);
    for (uint32_t i = 0; i < PPM_MAX_UV_SETS; i++) {
        replace_not_finite(primitive->uvs[i], 2 * (size_t)primitive->vertex_count, 0.0f);
    }
    return PPM_STATUS_OK;
}

static void report_faults(ppm_scene *scene, const char *name, const mesh_faults *faults)
{
    if (faults->not_finite > 0) {
        ppmi_log(scene->context, PPM_LOG_WARNING,
                 "mesh '%s': %llu triangles with a position that is not a finite number left out",
                 name, (unsigned long long)faults->not_finite);
    }
    if (faults->no_area > 0) {
        ppmi_log(scene->context, PPM_LOG_DEBUG, "mesh '%s': %llu triangles of no area left out",
                 name, (unsigned long long)faults->no_area);
    }
    if (faults->bad_normals > 0) {
        ppmi_log(scene->context, PPM_LOG_WARNING,
                 "mesh '%s': %llu normals that have no direction: the face's are used", name,
                 (unsigned long long)faults->bad_normals);
    }
}

/* The material of primitives that name none: a plain grey, made when first needed. */
static ppm_status find_default_material(ppm_scene *scene, const ppm_mesh_desc *desc,
                                        uint32_t *out_index)
{
    *out_index = 0;
    bool is_needed = false;
    for (uint32_t i = 0; i < desc->primitive_count; i++) {
        is_needed = is_needed || desc->primitives[i].material == 0;
    }
    if (!is_needed) return PPM_STATUS_OK;
    if (scene->default_material > 0) {
        *out_index = scene->default_material - 1;
        return PPM_STATUS_OK;
    }
    ppm_material_desc material;
    ppm_material_desc_init(&material);
    material.name = "(default)";
    material.base_color[0] = material.base_color[1] = material.base_color[2] = 0.8f;
    ppm_material_id id;
    const ppm_status status = ppm_scene_add_material(scene, &material, &id);
    if (status != PPM_STATUS_OK) return status;
    scene->default_material = id;
    *out_index = id - 1;
    return PPM_STATUS_OK;
}

ppm_status ppm_scene_add_mesh(ppm_scene *scene, const ppm_mesh_desc *desc, ppm_mesh_id *out_id)
{
    ppm_status status = ppmi_scene_check_open(scene);
    if (status != PPM_STATUS_OK) return status;
    if (!desc || !out_id || desc->size < offsetof(ppm_mesh_desc, release) ||
        (desc->primitive_count > 0 && !desc->primitives)) {
        return PPM_STATUS_INVALID_ARGUMENT;
    }
    const bool has_release = desc->size >= sizeof *desc;
    const char *name = desc->name ? desc->name : "";
    for (uint32_t i = 0; i < desc->primitive_count && status == PPM_STATUS_OK; i++) {
        status = check_primitive(scene, &desc->primitives[i], i, name);
    }
    if (status != PPM_STATUS_OK) return status;
    uint32_t default_material;
    status = find_default_material(scene, desc, &default_material);
    if (status != PPM_STATUS_OK) return status;

    ppmi_mesh *meshes =
        ppmi_scene_grow(scene->context, scene->meshes, scene->mesh_count, sizeof *meshes);
    if (!meshes) return PPM_STATUS_OUT_OF_MEMORY;
    scene->meshes = meshes;
    ppmi_mesh *mesh = &meshes[scene->mesh_count];
    scene->mesh_count++; /* from here ppm_scene_destroy frees what there is */
    mesh->bounds_min = vec3_splat(INFINITY);
    mesh->bounds_max = vec3_splat(-INFINITY);
    mesh->shape_version = 1;
    mesh->name = ppmi_string_copy(scene->context, name);
    mesh->primitives =
        ppmi_alloc_zeroed(scene->context, desc->primitive_count, sizeof *mesh->primitives);
    if (!mesh->name || (desc->primitive_count > 0 && !mesh->primitives)) {
        return out_of_memory(scene, name);
    }
    mesh->primitive_count = desc->primitive_count;
    mesh_faults faults = {0};
    const releaser to = has_release ? (releaser){desc->release, desc->release_user} : (releaser){0};
    for (uint32_t i = 0; i < desc->primitive_count && status == PPM_STATUS_OK; i++) {
        status =
            fill_primitive(scene, &desc->primitives[i], i, default_material, &to, mesh, &faults);
    }
    if (status != PPM_STATUS_OK) return status;
    update_bounds(mesh);
    report_faults(scene, name, &faults);
    *out_id = scene->mesh_count;
    return PPM_STATUS_OK;
}

/* ---- new vertices ---------------------------------------------------------------------------- */

static ppm_status check_vertices(ppm_scene *scene, ppm_mesh_id id, uint32_t primitive,
                                 const ppm_primitive_desc *desc)
{
    if (!desc || id == 0 || id > scene->mesh_count ||
        primitive >= scene->meshes[id - 1].primitive_count) {
        return ppmi_fail(scene->context, PPM_STATUS_INVALID_ARGUMENT,
                         "new vertices: no primitive %u in mesh %u, of %u meshes", primitive, id,
                         scene->mesh_count);
    }
    const ppmi_mesh *mesh = &scene->meshes[id - 1];
    const uint32_t count = mesh->primitives[primitive].vertex_count;
    if (desc->vertex_count != count || (count > 0 && !desc->positions)) {
        return ppmi_fail(scene->context, PPM_STATUS_INVALID_ARGUMENT,
                         "mesh '%s', primitive %u: %u new vertices %s, expected %u", mesh->name,
                         primitive, desc->vertex_count,
                         desc->positions ? "given" : "without positions", count);
    }
    return check_steps(scene, desc->motion_steps, primitive, mesh->name);
}

static void free_vertices(ppm_context *context, ppmi_primitive *primitive)
{
    ppmi_free(context, primitive->positions);
    ppmi_free(context, primitive->normals);
    ppmi_free(context, primitive->tangents);
}

/* Which elements can be hit with the new vertices, among all that were given. False when memory is
 * out. */
static bool choose_again(ppm_scene *scene, ppmi_primitive *primitive, mesh_faults *faults)
{
    if (primitive->given_indices) {
        keep_elements(primitive->given_indices, primitive->given_count, primitive, faults);
        return true;
    }
    const uint32_t count = primitive->element_count;
    const size_t size = vertices_per_element(primitive->kind) * sizeof *primitive->indices;
    if (count == 0) return true;
    uint32_t *given = ppmi_alloc(scene->context, count, size);
    if (!given) return false;
    memcpy(given, primitive->indices, count * size);
    keep_elements(given, count, primitive, faults);
    if (primitive->element_count == count) {
        ppmi_free(scene->context, given);
        return true;
    }
    primitive->given_indices = given;
    primitive->given_count = count;
    return true;
}

static void replace(const float *from, size_t count, float by, float *to)
{
    if (!from || !to) return;
    memcpy(to, from, count * sizeof *to);
    replace_not_finite(to, count, by);
}

/* As many as there were, so in place. */
static void replace_colors_and_uvs(const ppmi_working_space *space, const ppm_primitive_desc *desc,
                                   ppmi_primitive *target)
{
    const size_t count = target->vertex_count;
    replace(desc->colors, 4 * count, 1.0f, target->colors);
    if (desc->colors) colors_to_working_space(space, target);
    for (uint32_t i = 0; i < PPM_MAX_UV_SETS; i++)
        replace(desc->uvs[i], 2 * count, 0.0f, target->uvs[i]);
}

ppm_status ppm_scene_set_mesh_vertices(ppm_scene *scene, ppm_mesh_id id, uint32_t primitive,
                                       const ppm_primitive_desc *desc)
{
    ppm_status status = ppmi_scene_check_open(scene);
    if (status != PPM_STATUS_OK) return status;
    status = check_vertices(scene, id, primitive, desc);
    if (status != PPM_STATUS_OK) return status;
    ppmi_mesh *mesh = &scene->meshes[id - 1];
    ppmi_primitive *target = &mesh->primitives[primitive];
    if (target->vertex_count == 0) return PPM_STATUS_OK;
    const uint32_t steps = steps_of(desc);
    ppmi_primitive changed = *target;
    changed.positions = changed.normals = changed.tangents = NULL;
    mesh_faults faults = {0};
    const releaser nobody = {0};
    if (!copy_vertices(scene, desc, steps, &nobody, &changed) ||
        !choose_again(scene, &changed, &faults)) {
        free_vertices(scene->context, &changed);
        return out_of_memory(scene, mesh->name);
    }
    clean_vertices(&changed, &faults);
    free_vertices(scene->context, target);
    mesh->shape_version++;
    *target = changed;
    replace_colors_and_uvs(&scene->working, desc, target);
    update_bounds(mesh);
    report_faults(scene, mesh->name, &faults);
    return PPM_STATUS_OK;
}
