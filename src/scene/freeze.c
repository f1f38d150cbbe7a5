/* The scene while render sessions are alive: nothing changes, and it lies near the origin.
 *
 * Everything keeps where it was given beside where it is: moving it to the origin and back, session
 * after session, rounds once and not once a session. */
#include "scene/instance.h"

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

void ppmi_scene_freeze(ppm_scene *scene)
{
    const float far_in_sizes = 8.0f;
    ppmi_vec3 low, high;
    if (scene->session_count++ > 0) return;
    scene->is_frozen = true;
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
    if (vec3_max_abs(scene->shift) > 0.0f) shift_all(scene, vec3_splat(0.0f));
    if (scene->environment_is_assumed) {
        ppmi_free(scene->context, scene->environment.light_group);
        scene->environment = (ppmi_environment){0};
    }
    scene->environment_is_assumed = false;
}
