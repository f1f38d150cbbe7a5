/* Instances: where meshes stand, and how they move while the shutter is open. */
#include "scene/instance.h"

#include <string.h>

#include "scene/regular.h"

static float longest_column(const ppmi_transform *m)
{
    return ppmi_max(vec3_length(m->x), ppmi_max(vec3_length(m->y), vec3_length(m->z)));
}

/* ---- what a desc says ------------------------------------------------------------------------ */

/* The matrices of a desc: its motion, or else its transform. */
static const float *matrices_of(const ppm_instance_desc *desc, uint32_t *out_steps)
{
    const bool has_motion = desc->motion && desc->motion_steps > 0;
    *out_steps = has_motion ? desc->motion_steps : 1;
    return has_motion ? desc->motion : desc->transform;
}

static ppm_status check_transforms(const ppm_scene *scene, const ppm_instance_desc *desc,
                                   const char *name)
{
    if (desc->motion_steps > PPM_MAX_MOTION_STEPS || (desc->motion_steps > 1 && !desc->motion)) {
        return ppmi_fail(scene->context, PPM_STATUS_INVALID_ARGUMENT,
                         "instance '%s': %u motion steps %s; at most %d, and a transform for each",
                         name, desc->motion_steps, desc->motion ? "given" : "without transforms",
                         PPM_MAX_MOTION_STEPS);
    }
    uint32_t steps;
    const float *matrices = matrices_of(desc, &steps);
    for (uint32_t i = 0; i < steps; i++) {
        const ppmi_transform m = ppmi_transform_load(matrices + 16 * (size_t)i);
        if (!ppmi_transform_is_finite(&m)) {
            return ppmi_fail(scene->context, PPM_STATUS_INVALID_ARGUMENT,
                             "instance '%s': a transform that is not finite", name);
        }
    }
    return PPM_STATUS_OK;
}

/* Steps that are all alike are none. */
static bool is_at_rest(const float *matrices, uint32_t steps)
{
    for (uint32_t i = 1; i < steps; i++) {
        if (memcmp(matrices, matrices + 16 * (size_t)i, 16 * sizeof *matrices) != 0) return false;
    }
    return true;
}

/* Steps at which there is nothing to see (a scale that grows from 0) get the nearest step's matrix,
 * as small as single precision can undo it. False where there is nothing to see at any. */
static bool make_all_regular(ppmi_transform *steps, bool *is_seen, uint32_t count)
{
    const float smallest = 1e-6f;
    uint32_t first = count;
    for (uint32_t i = 0; i < count; i++) {
        is_seen[i] = ppmi_make_regular(&steps[i]);
        if (is_seen[i] && first == count) first = i;
    }
    if (first == count) return false;
    for (uint32_t i = 0, nearest = first; i < count; i++) {
        if (is_seen[i]) nearest = i;
        if (is_seen[i]) continue;
        steps[i].x = vec3_scale(steps[nearest].x, smallest);
        steps[i].y = vec3_scale(steps[nearest].y, smallest);
        steps[i].z = vec3_scale(steps[nearest].z, smallest);
    }
    return true;
}

/* Between steps matrices are interpolated, and a ray is taken back by the inverse of what comes
 * out: a way through a flat matrix has none. */
static bool can_move(const ppmi_transform *steps, uint32_t count)
{
    for (uint32_t i = 1; i < count; i++) {
        if (!ppmi_stays_regular(&steps[i - 1], &steps[i])) return false;
    }
    return true;
}

static void say_no_motion(ppm_scene *scene, const char *name)
{
    ppmi_log(scene->context, PPM_LOG_WARNING,
             "node '%s': turns over or passes through a flat shape between two motion steps; it is "
             "shown without blur, as it is when the shutter opens (--motion-steps N)",
             name);
}

/* Fills in where the instance is, in place of where it was. Checked before; false when memory is
 * out, with nothing changed. */
static bool place(ppm_scene *scene, const ppm_instance_desc *desc, const char *name,
                  ppmi_instance *instance)
{
    uint32_t steps;
    bool is_seen[PPM_MAX_MOTION_STEPS];
    const float *matrices = matrices_of(desc, &steps);
    if (is_at_rest(matrices, steps)) steps = 1;
    ppmi_transform *motion = ppmi_alloc(scene->context, 2 * (size_t)steps, sizeof *motion);
    if (!motion) return false;
    for (uint32_t i = 0; i < steps; i++)
        motion[i] = ppmi_transform_load(matrices + 16 * (size_t)i);
    instance->is_singular = !make_all_regular(motion, is_seen, steps);
    if (!instance->is_singular && !can_move(motion, steps)) {
        say_no_motion(scene, name);
        steps = 1;
    }
    instance->scale = 0.0f;
    for (uint32_t i = 0; i < steps; i++) {
        instance->scale = ppmi_max(instance->scale, longest_column(&motion[i]));
        motion[steps + i] = motion[i];
    }
    ppmi_free(scene->context, instance->motion);
    instance->motion = steps > 1 ? motion : NULL;
    instance->motion_steps = steps;
    instance->to_world = motion[0];
    if (steps == 1) ppmi_free(scene->context, motion);
    instance->given_origin = instance->to_world.origin;
    instance->normals = ppmi_transform_normals(&instance->to_world);
    instance->is_mirrored = ppmi_transform_determinant(&instance->to_world) < 0.0f;
    return true;
}

void ppmi_instance_shift(ppmi_instance *instance, ppmi_vec3 shift)
{
    instance->to_world.origin = vec3_sub(instance->given_origin, shift);
    const uint32_t steps = instance->motion_steps;
    for (uint32_t i = 0; instance->motion && i < steps; i++) {
        instance->motion[i].origin = vec3_sub(instance->motion[steps + i].origin, shift);
    }
}

void ppmi_instance_deinit(ppm_context *context, ppmi_instance *instance)
{
    ppmi_free(context, instance->motion);
    ppmi_free(context, instance->asset);
    ppmi_free(context, instance->name);
    ppmi_free(context, instance->light_group);
}

/* ---- public calls ---------------------------------------------------------------------------- */

static ppm_status fail_memory(ppm_scene *scene)
{
    return ppmi_fail(scene->context, PPM_STATUS_OUT_OF_MEMORY, "out of memory for an instance");
}

ppm_status ppm_scene_add_instance(ppm_scene *scene, const ppm_instance_desc *desc,
                                  ppm_instance_id *out_id)
{
    ppm_status status = ppmi_scene_check_open(scene);
    if (status != PPM_STATUS_OK) return status;
    if (!desc || !out_id || desc->size < sizeof *desc) return PPM_STATUS_INVALID_ARGUMENT;
    const char *name = desc->name ? desc->name : "";
    if (desc->mesh == 0 || desc->mesh > scene->mesh_count) {
        return ppmi_fail(scene->context, PPM_STATUS_INVALID_ARGUMENT,
                         "instance '%s': mesh %u of %u", name, desc->mesh, scene->mesh_count);
    }
    status = check_transforms(scene, desc, name);
    if (status != PPM_STATUS_OK) return status;
    ppmi_instance *instances =
        ppmi_scene_grow(scene->context, scene->instances, scene->instance_count, sizeof *instances);
    if (!instances) return PPM_STATUS_OUT_OF_MEMORY;
    scene->instances = instances;
    ppmi_instance *instance = &instances[scene->instance_count];
    if (!place(scene, desc, name, instance)) return fail_memory(scene);
    if (instance->is_singular) {
        ppmi_free(scene->context, instance->motion);
        ppmi_log(scene->context, PPM_LOG_WARNING,
                 "node '%s': its scale is zero along two axes: there is nothing to see; left out",
                 name);
        *out_id = 0;
        return PPM_STATUS_OK;
    }
    instance->name = ppmi_string_copy(scene->context, name);
    instance->asset = ppmi_string_copy(scene->context, desc->asset ? desc->asset : name);
    if (!instance->name || !instance->asset ||
        !ppmi_light_group_copy(scene->context, desc->light_group, &instance->light_group)) {
        ppmi_instance_deinit(scene->context, instance);
        return fail_memory(scene);
    }
    instance->mesh = desc->mesh - 1;
    instance->is_catcher = desc->is_catcher != 0;
    *out_id = ++scene->instance_count;
    return PPM_STATUS_OK;
}

uint32_t ppm_scene_instance_count(const ppm_scene *scene)
{
    return scene ? scene->instance_count : 0;
}

const char *ppm_scene_instance_name(const ppm_scene *scene, ppm_instance_id id)
{
    if (!scene || id == 0 || id > scene->instance_count) return NULL;
    return scene->instances[id - 1].name;
}

static ppm_status find_instance(ppm_scene *scene, ppm_instance_id id, ppmi_instance **out_instance)
{
    const ppm_status status = ppmi_scene_check_open(scene);
    if (status != PPM_STATUS_OK) return status;
    if (id == 0 || id > scene->instance_count) {
        return ppmi_fail(scene->context, PPM_STATUS_INVALID_ARGUMENT, "instance %u of %u", id,
                         scene->instance_count);
    }
    *out_instance = &scene->instances[id - 1];
    return PPM_STATUS_OK;
}

ppm_status ppm_scene_set_instance(ppm_scene *scene, ppm_instance_id id,
                                  const ppm_instance_desc *desc)
{
    ppmi_instance *instance = NULL;
    ppm_status status = find_instance(scene, id, &instance);
    if (status != PPM_STATUS_OK) return status;
    if (!desc || desc->size < sizeof *desc) return PPM_STATUS_INVALID_ARGUMENT;
    status = check_transforms(scene, desc, instance->name);
    if (status != PPM_STATUS_OK) return status;
    return place(scene, desc, instance->name, instance) ? PPM_STATUS_OK : fail_memory(scene);
}

ppm_status ppm_scene_set_instance_visible(ppm_scene *scene, ppm_instance_id id, uint32_t is_visible)
{
    ppmi_instance *instance = NULL;
    const ppm_status status = find_instance(scene, id, &instance);
    if (status != PPM_STATUS_OK) return status;
    instance->is_hidden = is_visible == 0;
    return PPM_STATUS_OK;
}

ppm_status ppm_scene_set_instance_catcher(ppm_scene *scene, ppm_instance_id id, uint32_t is_catcher)
{
    ppmi_instance *instance = NULL;
    const ppm_status status = find_instance(scene, id, &instance);
    if (status != PPM_STATUS_OK) return status;
    instance->is_catcher = is_catcher != 0;
    return PPM_STATUS_OK;
}

uint32_t ppm_scene_catcher_count(const ppm_scene *scene)
{
    uint32_t count = 0;
    for (uint32_t i = 0; scene && i < scene->instance_count; i++) {
        const ppmi_instance *instance = &scene->instances[i];
        count += instance->is_catcher && ppmi_instance_is_there(instance);
    }
    return count;
}

static bool shines(const ppm_scene *scene, const ppmi_instance *instance)
{
    const ppmi_mesh *mesh = &scene->meshes[instance->mesh];
    for (uint32_t i = 0; i < mesh->primitive_count; i++) {
        if (scene->materials[mesh->primitives[i].material].emits) return true;
    }
    return false;
}

ppm_status ppm_scene_show_catchers_alone(ppm_scene *scene, uint32_t is_alone)
{
    const ppm_status status = ppmi_scene_check_open(scene);
    if (status != PPM_STATUS_OK) return status;
    for (uint32_t i = 0; i < scene->instance_count; i++) {
        ppmi_instance *instance = &scene->instances[i];
        instance->is_left_out = is_alone != 0 && !instance->is_catcher && !shines(scene, instance);
    }
    return PPM_STATUS_OK;
}
