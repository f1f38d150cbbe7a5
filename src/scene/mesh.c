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
static bool copy_optional(ppm_scene *scene, const float *values, size_t count, float **out_copy)
{
    if (!values) return true;
    *out_copy = copy_floats(scene, values, count, 0);
    return *out_copy != NULL;
}

static bool copy_attributes(ppm_scene *scene, const ppm_primitive_desc *desc,
                            ppmi_primitive *primitive)
{
    const size_t count = desc->vertex_count;
    primitive->positions = copy_floats(scene, desc->positions, 3 * count, 4);
    if (!primitive->positions) return false;
    for (uint32_t i = 0; i < PPM_MAX_UV_SETS; i++) {
        if (!copy_optional(scene, desc->uvs[i], 2 * count, &primitive->uvs[i])) return false;
    }
    return copy_optional(scene, desc->normals, 3 * count, &primitive->normals) &&
           copy_optional(scene, desc->tangents, 4 * count, &primitive->tangents) &&
           copy_optional(scene, desc->colors, 4 * count, &primitive->colors);
}

static ppmi_vec3 position_at(const ppmi_primitive *primitive, uint32_t vertex)
{
    return vec3_load(primitive->positions + 3 * (size_t)vertex);
}

/* Finite, and no square overflows. */
static bool is_usable(ppmi_vec3 p)
{
    const float most = 1e15f;
    return fabsf(p.x) < most && fabsf(p.y) < most && fabsf(p.z) < most;
}

/* Copies the triangles that can be hit, growing the mesh's bounds by them. */
static void keep_triangles(const ppm_primitive_desc *desc, ppmi_primitive *primitive,
                           ppmi_mesh *mesh, mesh_faults *faults)
{
    uint32_t kept = 0;
    for (size_t i = 0; i < desc->triangle_count; i++) {
        const uint32_t *triangle = desc->indices + 3 * i;
        const ppmi_vec3 p[3] = {position_at(primitive, triangle[0]),
                                position_at(primitive, triangle[1]),
                                position_at(primitive, triangle[2])};
        if (!is_usable(p[0]) || !is_usable(p[1]) || !is_usable(p[2])) {
            faults->not_finite++;
            continue;
        }
        const ppmi_vec3 normal = vec3_cross(vec3_sub(p[1], p[0]), vec3_sub(p[2], p[0]));
        if (vec3_max_abs(normal) == 0.0f) {
            faults->no_area++;
            continue;
        }
        memcpy(primitive->indices + 3 * (size_t)kept++, triangle, 3 * sizeof *triangle);
        for (uint32_t k = 0; k < 3; k++) {
            mesh->bounds_min =
                vec3(ppmi_min(mesh->bounds_min.x, p[k].x), ppmi_min(mesh->bounds_min.y, p[k].y),
                     ppmi_min(mesh->bounds_min.z, p[k].z));
            mesh->bounds_max =
                vec3(ppmi_max(mesh->bounds_max.x, p[k].x), ppmi_max(mesh->bounds_max.y, p[k].y),
                     ppmi_max(mesh->bounds_max.z, p[k].z));
        }
    }
    primitive->triangle_count = kept;
}

/* Unit normals; those that cannot be normalised become zero, which shading reads as "the face's".
 */
static void normalize_normals(ppmi_primitive *primitive, mesh_faults *faults)
{
    if (!primitive->normals) return;
    for (size_t i = 0; i < primitive->vertex_count; i++) {
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

static ppm_status check_primitive(ppm_scene *scene, const ppm_primitive_desc *desc, uint32_t index,
                                  const char *name)
{
    if (desc->material > scene->material_count) {
        return ppmi_fail(scene->context, PPM_STATUS_INVALID_ARGUMENT,
                         "mesh '%s', primitive %u: material %u of %u", name, index, desc->material,
                         scene->material_count);
    }
    if (desc->triangle_count > 0 && (!desc->positions || !desc->indices)) {
        return ppmi_fail(scene->context, PPM_STATUS_INVALID_ARGUMENT,
                         "mesh '%s', primitive %u: no positions or indices", name, index);
    }
    for (size_t i = 0; i < 3 * (size_t)desc->triangle_count; i++) {
        if (desc->indices[i] >= desc->vertex_count) {
            return ppmi_fail(scene->context, PPM_STATUS_INVALID_ARGUMENT,
                             "mesh '%s', primitive %u: index %zu is %u, of %u vertices", name,
                             index, i, desc->indices[i], desc->vertex_count);
        }
    }
    return PPM_STATUS_OK;
}

static ppm_status fill_primitive(ppm_scene *scene, const ppm_primitive_desc *desc, uint32_t index,
                                 uint32_t default_material, ppmi_mesh *mesh, mesh_faults *faults)
{
    ppmi_primitive *primitive = &mesh->primitives[index];
    primitive->material = desc->material > 0 ? desc->material - 1 : default_material;
    if (desc->triangle_count == 0) return PPM_STATUS_OK;
    primitive->vertex_count = desc->vertex_count;
    primitive->indices =
        ppmi_alloc(scene->context, desc->triangle_count, 3 * sizeof *primitive->indices);
    if (!primitive->indices || !copy_attributes(scene, desc, primitive)) {
        return out_of_memory(scene, mesh->name);
    }
    keep_triangles(desc, primitive, mesh, faults);
    normalize_normals(primitive, faults);
    replace_not_finite(primitive->tangents, 4 * (size_t)primitive->vertex_count, 0.0f);
    replace_not_finite(primitive->colors, 4 * (size_t)primitive->vertex_count, 1.0f);
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
    if (!desc || !out_id || desc->size < sizeof *desc ||
        (desc->primitive_count > 0 && !desc->primitives)) {
        return PPM_STATUS_INVALID_ARGUMENT;
    }
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
    mesh->name = ppmi_string_copy(scene->context, name);
    mesh->primitives =
        ppmi_alloc_zeroed(scene->context, desc->primitive_count, sizeof *mesh->primitives);
    if (!mesh->name || (desc->primitive_count > 0 && !mesh->primitives)) {
        return out_of_memory(scene, name);
    }
    mesh->primitive_count = desc->primitive_count;
    mesh_faults faults = {0};
    for (uint32_t i = 0; i < desc->primitive_count && status == PPM_STATUS_OK; i++) {
        status = fill_primitive(scene, &desc->primitives[i], i, default_material, mesh, &faults);
    }
    if (status != PPM_STATUS_OK) return status;
    report_faults(scene, name, &faults);
    *out_id = scene->mesh_count;
    return PPM_STATUS_OK;
}

/* Scaled to unit size, so that tiny and huge scales neither underflow nor overflow. */
static ppmi_transform normal_transform(const ppmi_transform *to_world, float determinant)
{
    ppmi_transform m = ppmi_transform_cofactors(to_world);
    const float size = ppmi_max(vec3_max_abs(m.x), ppmi_max(vec3_max_abs(m.y), vec3_max_abs(m.z)));
    const float scale = copysignf(1.0f / size, determinant);
    m.x = vec3_scale(m.x, scale);
    m.y = vec3_scale(m.y, scale);
    m.z = vec3_scale(m.z, scale);
    return m;
}

ppm_status ppm_scene_add_instance(ppm_scene *scene, const ppm_instance_desc *desc,
                                  ppm_instance_id *out_id)
{
    const ppm_status status = ppmi_scene_check_open(scene);
    if (status != PPM_STATUS_OK) return status;
    if (!desc || !out_id || desc->size < sizeof *desc) return PPM_STATUS_INVALID_ARGUMENT;
    const char *name = desc->name ? desc->name : "";
    const ppmi_transform to_world = ppmi_transform_load(desc->transform);
    if (desc->mesh == 0 || desc->mesh > scene->mesh_count || !ppmi_transform_is_finite(&to_world)) {
        return ppmi_fail(scene->context, PPM_STATUS_INVALID_ARGUMENT,
                         "instance '%s': mesh %u of %u, or a transform that is not finite", name,
                         desc->mesh, scene->mesh_count);
    }
    const float determinant = ppmi_transform_determinant(&to_world);
    if (!(fabsf(determinant) > 0.0f)) {
        ppmi_log(scene->context, PPM_LOG_WARNING,
                 "node '%s': its scale is zero along an axis; left out", name);
        *out_id = 0;
        return PPM_STATUS_OK;
    }
    ppmi_instance *instances =
        ppmi_scene_grow(scene->context, scene->instances, scene->instance_count, sizeof *instances);
    if (!instances) return PPM_STATUS_OUT_OF_MEMORY;
    scene->instances = instances;
    char *name_copy = ppmi_string_copy(scene->context, name);
    if (!name_copy) {
        return ppmi_fail(scene->context, PPM_STATUS_OUT_OF_MEMORY, "out of memory for an instance");
    }
    instances[scene->instance_count] = (ppmi_instance){
        .name = name_copy,
        .mesh = desc->mesh - 1,
        .to_world = to_world,
        .normals = normal_transform(&to_world, determinant),
        .scale = ppmi_max(vec3_length(to_world.x),
                          ppmi_max(vec3_length(to_world.y), vec3_length(to_world.z))),
        .is_mirrored = determinant < 0.0f,
    };
    *out_id = ++scene->instance_count;
    return PPM_STATUS_OK;
}
