/* What has been added, read back by its ids, and the material of a primitive exchanged. */
#include "scene/scene.h"

uint32_t ppm_scene_material_count(const ppm_scene *scene)
{
    return scene ? scene->material_count : 0;
}

ppm_status ppm_scene_get_material(const ppm_scene *scene, ppm_material_id id,
                                  ppm_material_desc *desc)
{
    if (!scene || !desc || desc->size < sizeof *desc || id == 0 || id > scene->material_count) {
        return PPM_STATUS_INVALID_ARGUMENT;
    }
    *desc = scene->materials[id - 1].desc;
    desc->size = sizeof *desc;
    desc->name = scene->materials[id - 1].name;
    return PPM_STATUS_OK;
}

ppm_mesh_id ppm_scene_instance_mesh(const ppm_scene *scene, ppm_instance_id id)
{
    if (!scene || id == 0 || id > scene->instance_count) return 0;
    return scene->instances[id - 1].mesh + 1;
}

uint32_t ppm_scene_primitive_count(const ppm_scene *scene, ppm_mesh_id id)
{
    return scene && id > 0 && id <= scene->mesh_count ? scene->meshes[id - 1].primitive_count : 0;
}

ppm_material_id ppm_scene_primitive_material(const ppm_scene *scene, ppm_mesh_id id,
                                             uint32_t primitive)
{
    if (primitive >= ppm_scene_primitive_count(scene, id)) return 0;
    return scene->meshes[id - 1].primitives[primitive].material + 1;
}

ppm_status ppm_scene_set_primitive_material(ppm_scene *scene, ppm_mesh_id id, uint32_t primitive,
                                            ppm_material_id material)
{
    const ppm_status status = ppmi_scene_check_open(scene);
    if (status != PPM_STATUS_OK) return status;
    if (primitive >= ppm_scene_primitive_count(scene, id) || material == 0 ||
        material > scene->material_count) {
        return ppmi_fail(scene->context, PPM_STATUS_INVALID_ARGUMENT,
                         "primitive %u of mesh %u: no such primitive, or no material %u", primitive,
                         id, material);
    }
    scene->meshes[id - 1].primitives[primitive].material = material - 1;
    return PPM_STATUS_OK;
}

ppm_status ppm_scene_get_environment(const ppm_scene *scene, ppm_environment_desc *desc)
{
    if (!scene || !desc || desc->size < sizeof *desc) return PPM_STATUS_INVALID_ARGUMENT;
    const ppmi_environment *environment = &scene->environment;
    *desc = (ppm_environment_desc){.size = sizeof *desc};
    if (!environment->is_set || scene->environment_is_assumed) return PPM_STATUS_OK;
    vec3_store(desc->radiance, environment->radiance);
    desc->image = environment->image;
    desc->rotation_rad = environment->rotation_rad;
    desc->has_backdrop = environment->has_backdrop;
    vec3_store(desc->backdrop, environment->backdrop);
    return PPM_STATUS_OK;
}
