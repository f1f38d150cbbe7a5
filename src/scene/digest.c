/* Field by field: what lies between fields in memory has no meaning, and neither have pointers. */
#include "scene/digest.h"

#define ADD(digest, value) ppmi_digest_add(digest, &(value), sizeof(value))

static void add_floats(ppmi_digest *digest, const float *values, size_t count)
{
    const uint8_t is_there = values != NULL;
    ADD(digest, is_there);
    if (values) ppmi_digest_add(digest, values, count * sizeof *values);
}

static void add_image(ppmi_digest *digest, const ppmi_image *image)
{
    const size_t count = (size_t)image->width * image->height * image->channels;
    const uint32_t facts[5] = {image->width, image->height, image->channels, image->is_srgb,
                               image->u8 != NULL};
    ADD(digest, facts);
    if (image->u8) ppmi_digest_add(digest, image->u8, count);
    if (image->f32) ppmi_digest_add(digest, image->f32, count * sizeof *image->f32);
}

/* All of the description from the first value to the last; each is of four bytes, so there is
 * nothing between them. */
static void add_material(ppmi_digest *digest, const ppmi_material *material)
{
    enum {
        BEGIN = offsetof(ppm_material_desc, base_color),
        END = offsetof(ppm_material_desc, fuzz_texture) + sizeof(ppm_texture)
    };
    _Static_assert(sizeof(ppm_material_desc) - END < 8, "a field was appended: take it in");
    ppmi_digest_add_text(digest, material->name);
    ppmi_digest_add(digest, (const char *)&material->desc + BEGIN, END - BEGIN);
}

static void add_primitive(ppmi_digest *digest, const ppmi_primitive *p)
{
    const size_t vertices = (size_t)p->vertex_count * p->motion_steps;
    const size_t per_element = p->kind == PPM_PRIMITIVE_TRIANGLES ? 3
                               : p->kind == PPM_PRIMITIVE_LINES   ? 2
                                                                  : 1;
    const uint32_t facts[5] = {p->vertex_count, p->element_count, p->material, p->motion_steps,
                               (uint32_t)p->kind};
    ADD(digest, facts);
    ADD(digest, p->radius_m);
    add_floats(digest, p->positions, 3 * vertices);
    add_floats(digest, p->normals, 3 * vertices);
    add_floats(digest, p->tangents, 4 * vertices);
    for (int i = 0; i < PPM_MAX_UV_SETS; i++)
        add_floats(digest, p->uvs[i], 2 * (size_t)p->vertex_count);
    add_floats(digest, p->colors, 4 * (size_t)p->vertex_count);
    ppmi_digest_add(digest, p->indices, per_element * p->element_count * sizeof *p->indices);
}

static void add_mesh(ppmi_digest *digest, const ppmi_mesh *mesh)
{
    ADD(digest, mesh->primitive_count);
    for (uint32_t i = 0; i < mesh->primitive_count; i++)
        add_primitive(digest, &mesh->primitives[i]);
}

static void add_instance(ppmi_digest *digest, const ppmi_instance *instance)
{
    const uint32_t facts[4] = {instance->mesh, instance->is_hidden, instance->motion_steps,
                               instance->is_catcher};
    ppmi_digest_add_text(digest, instance->name);
    ppmi_digest_add_text(digest, instance->asset);
    ppmi_digest_add_text(digest, instance->light_group);
    ADD(digest, facts);
    ADD(digest, instance->to_world);
    if (!instance->motion) return;
    ppmi_digest_add(digest, instance->motion, instance->motion_steps * sizeof *instance->motion);
}

static void add_light(ppmi_digest *digest, const ppmi_punctual *light)
{
    const uint32_t facts[3] = {(uint32_t)light->kind, light->is_hidden, light->profile};
    const float sizes[6] = {light->cos_inner, light->cos_outer,    light->angular_radius_rad,
                            light->radius_m,  light->half_width_m, light->half_height_m};
    const ppmi_vec3 vectors[5] = {light->position, light->direction, light->intensity, light->right,
                                  light->up};
    ppmi_digest_add_text(digest, light->name);
    ppmi_digest_add_text(digest, light->light_group);
    ADD(digest, facts);
    ADD(digest, sizes);
    ADD(digest, vectors);
}

static void add_profile(ppmi_digest *digest, const ppmi_light_profile *profile)
{
    const uint32_t counts[2] = {profile->polar_count, profile->azimuth_count};
    ADD(digest, counts);
    add_floats(digest, profile->polar_rad, profile->polar_count);
    add_floats(digest, profile->azimuth_rad, profile->azimuth_count);
    add_floats(digest, profile->candela, (size_t)profile->polar_count * profile->azimuth_count);
}

static void add_surroundings(ppmi_digest *digest, const ppm_scene *scene)
{
    const ppmi_environment *const environment = &scene->environment;
    const uint32_t facts[3] = {environment->is_set, environment->image, environment->has_backdrop};
    ADD(digest, facts);
    ADD(digest, environment->radiance);
    ADD(digest, environment->rotation_rad);
    ADD(digest, environment->backdrop);
    ppmi_digest_add_text(digest, environment->light_group);
    ADD(digest, scene->fog.sigma_s);
    ADD(digest, scene->fog.sigma_a);
    ADD(digest, scene->fog.asymmetry_g);
    ADD(digest, scene->shift);
    ADD(digest, scene->origin_m);
}

void ppmi_scene_digest(const ppm_scene *scene, ppmi_digest *digest)
{
    const uint32_t counts[6] = {scene->image_count,    scene->material_count, scene->mesh_count,
                                scene->instance_count, scene->punctual_count, scene->profile_count};
    ADD(digest, counts);
    for (uint32_t i = 0; i < scene->image_count; i++)
        add_image(digest, &scene->images[i]);
    for (uint32_t i = 0; i < scene->material_count; i++)
        add_material(digest, &scene->materials[i]);
    for (uint32_t i = 0; i < scene->mesh_count; i++)
        add_mesh(digest, &scene->meshes[i]);
    for (uint32_t i = 0; i < scene->instance_count; i++)
        add_instance(digest, &scene->instances[i]);
    for (uint32_t i = 0; i < scene->punctual_count; i++)
        add_light(digest, &scene->punctuals[i]);
    for (uint32_t i = 0; i < scene->profile_count; i++)
        add_profile(digest, &scene->profiles[i]);
    add_surroundings(digest, scene);
}

void ppmi_camera_digest(const ppmi_camera *camera, ppmi_digest *digest)
{
    const float facts[10] = {camera->y_fov_rad, camera->half_width_m, camera->half_height_m,
                             camera->aspect,    camera->f_number,     camera->focus_distance_m,
                             camera->shift[0],  camera->shift[1],     camera->near_m,
                             camera->far_m};
    const ppmi_vec3 place[4] = {camera->origin, camera->right, camera->up, camera->forward};
    ADD(digest, camera->kind);
    ADD(digest, facts);
    ADD(digest, place);
    ADD(digest, camera->motion_steps);
    for (uint32_t i = 0; camera->motion && i < camera->motion_steps; i++) {
        const ppmi_camera_pose *const pose = &camera->motion[i];
        const ppmi_vec3 at[4] = {pose->origin, pose->right, pose->up, pose->forward};
        ADD(digest, at);
    }
}
