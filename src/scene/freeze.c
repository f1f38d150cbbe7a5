/* The scene while render sessions are alive: nothing changes, and it lies near the origin.
 *
 * Everything keeps where it was given beside where it is: moving it to the origin and back, session
 * after session, rounds once and not once a session. */
#include "scene/instance.h"
#include "scene/regular.h"

static void shift_all(ppm_scene *scene, ppmi_vec3 shift)
{
    for (uint32_t i = 0; i < scene->instance_count; i++)
        ppmi_instance_shift(&scene->instances[i], shift);
    for (uint32_t i = 0; i < scene->camera_count; i++) {
        ppmi_camera *camera = &scene->cameras[i];
        camera->origin = vec3_sub(camera->given_origin, shift);
        for (uint32_t k = 0; camera->motion && k < camera->motion_steps; k++)
            camera->motion[k].origin = vec3_sub(camera->motion[k].given_origin, shift);
    }
    for (uint32_t i = 0; i < scene->punctual_count; i++) {
        ppmi_punctual *light = &scene->punctuals[i];
        light->position = vec3_sub(light->given_position, shift);
    }
    scene->shift = shift;
}

static void leave_out(ppm_scene *scene, ppmi_instance *instance, const char *why)
{
    instance->is_beyond = true;
    ppmi_log(scene->context, PPM_LOG_WARNING, "node '%s': left out: %s", instance->name, why);
}

static void leave_out_the_far(ppm_scene *scene)
{
    for (uint32_t i = 0; i < scene->instance_count; i++) {
        ppmi_instance *instance = &scene->instances[i];
        ppmi_vec3 low, high;
        if (!ppmi_instance_is_there(instance) ||
            !ppmi_instance_bounds(scene, instance, &low, &high)) {
            continue;
        }
        if (ppmi_is_far(low) || ppmi_is_far(high)) {
            leave_out(scene, instance, "it reaches further than 1e15 m");
        }
    }
}

/* The farthest that a ray can begin. */
static double reach(const ppm_scene *scene)
{
    ppmi_vec3 low, high;
    double most = 1.0;
    if (ppmi_scene_bounds(scene, &low, &high)) {
        most = fmax(most, (double)ppmi_max(vec3_max_abs(low), vec3_max_abs(high)));
    }
    for (uint32_t i = 0; i < scene->camera_count; i++)
        most = fmax(most, (double)vec3_max_abs(scene->cameras[i].origin));
    for (uint32_t i = 0; i < scene->punctual_count; i++)
        most = fmax(most, (double)vec3_max_abs(scene->punctuals[i].position));
    return most;
}

/* A ray is taken back to where a mesh was modelled, and has to stay within what Embree takes. */
static void leave_out_the_tiny(ppm_scene *scene)
{
    const double most = 1e17, far = 4.0 * reach(scene);
    for (uint32_t i = 0; i < scene->instance_count; i++) {
        ppmi_instance *instance = &scene->instances[i];
        double least = ppmi_least_stretch(&instance->to_world);
        for (uint32_t k = 1; k < instance->motion_steps; k++)
            least = fmin(least, ppmi_least_stretch(&instance->motion[k]));
        if (!ppmi_instance_is_there(instance) || far < most * least) continue;
        leave_out(scene, instance, "its scale is too small for the size of the scene");
    }
}

void ppmi_scene_freeze(ppm_scene *scene)
{
    const float far_in_sizes = 8.0f;
    ppmi_vec3 low, high;
    if (scene->session_count++ > 0) return;
    scene->is_frozen = true;
    leave_out_the_far(scene);
    leave_out_the_tiny(scene);
    if (!ppmi_scene_bounds(scene, &low, &high)) return;
    const ppmi_vec3 center = vec3_scale(vec3_add(low, high), 0.5f);
    if (vec3_length(center) > far_in_sizes * vec3_length(vec3_sub(high, low))) {
        shift_all(scene, center);
    }
}

void ppmi_scene_thaw(ppm_scene *scene)
{
    if (--scene->session_count > 0) return;
    scene->is_frozen = false;
    for (uint32_t i = 0; i < scene->instance_count; i++)
        scene->instances[i].is_beyond = false;
    if (vec3_max_abs(scene->shift) > 0.0f) shift_all(scene, vec3_splat(0.0f));
    if (scene->environment_is_assumed) {
        ppmi_free(scene->context, scene->environment.light_group);
        scene->environment = (ppmi_environment){0};
    }
    scene->environment_is_assumed = false;
}
