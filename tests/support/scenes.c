/* Scenes for tests. */
#include "support/scenes.h"

#include <setjmp.h>
#include <stdarg.h>
#include <string.h>

#include <cmocka.h>

static void count_warnings(void *user, ppm_log_level level, const char *message)
{
    (void)message;
    test_scene *test = user;
    if (level == PPM_LOG_WARNING) test->warnings++;
}

void scene_open(test_scene *test)
{
    *test = (test_scene){0};
    const ppm_context_desc desc = {.size = sizeof desc, .log = count_warnings, .log_user = test};
    assert_int_equal(ppm_context_create(&desc, &test->context), PPM_STATUS_OK);
    assert_int_equal(ppm_scene_create(test->context, NULL, &test->scene), PPM_STATUS_OK);
}

void scene_close(test_scene *test)
{
    ppm_scene_destroy(test->scene);
    assert_int_equal(ppmi_alloc_live(test->context), 0);
    ppm_context_destroy(test->context);
}

/* ---- materials ------------------------------------------------------------------------------- */

ppm_material_desc material_desc_rgb(ppmi_vec3 base_color, float metallic, float roughness)
{
    ppm_material_desc desc;
    ppm_material_desc_init(&desc);
    vec3_store(desc.base_color, base_color);
    desc.metallic = metallic;
    desc.roughness = roughness;
    return desc;
}

ppm_material_id material_add(ppm_scene *scene, const ppm_material_desc *desc)
{
    ppm_material_id id = 0;
    assert_int_equal(ppm_scene_add_material(scene, desc, &id), PPM_STATUS_OK);
    return id;
}

static ppm_material_desc lambert_desc(ppmi_vec3 reflectance)
{
    ppm_material_desc desc;
    ppm_material_desc_init(&desc);
    vec3_store(desc.base_color, reflectance);
    desc.specular = 0.0f;
    desc.roughness = 1.0f;
    return desc;
}

ppm_material_id material_lambert_rgb(ppm_scene *scene, ppmi_vec3 reflectance)
{
    const ppm_material_desc desc = lambert_desc(reflectance);
    return material_add(scene, &desc);
}

ppm_material_id material_lambert(ppm_scene *scene, float reflectance)
{
    return material_lambert_rgb(scene, vec3_splat(reflectance));
}

ppm_material_id material_emitter(ppm_scene *scene, float radiance, float reflectance,
                                 bool double_sided)
{
    ppm_material_desc desc = lambert_desc(vec3_splat(reflectance));
    vec3_store(desc.emission, vec3_splat(radiance));
    desc.double_sided = double_sided;
    return material_add(scene, &desc);
}

ppm_material_id material_glass(ppm_scene *scene, float ior, float roughness)
{
    ppm_material_desc desc;
    ppm_material_desc_init(&desc);
    desc.transmission = 1.0f;
    desc.roughness = roughness;
    desc.ior = ior;
    return material_add(scene, &desc);
}

/* ---- cameras and lights ---------------------------------------------------------------------- */

/* Local -Z points along direction. */
static void aim(float transform[16], ppmi_vec3 position, ppmi_vec3 direction)
{
    const ppmi_vec3 back = vec3_neg(vec3_normalize(direction));
    const ppmi_vec3 hint = fabsf(back.y) > 0.9f ? vec3(0.0f, 0.0f, -1.0f) : vec3(0.0f, 1.0f, 0.0f);
    const ppmi_vec3 right = vec3_normalize(vec3_cross(hint, back));
    memset(transform, 0, 16 * sizeof *transform);
    vec3_store(transform, right);
    vec3_store(transform + 4, vec3_cross(back, right));
    vec3_store(transform + 8, back);
    vec3_store(transform + 12, position);
    transform[15] = 1.0f;
}

static ppm_camera_id add_camera(ppm_scene *scene, ppm_camera_desc desc, ppmi_vec3 eye,
                                ppmi_vec3 target)
{
    desc.size = sizeof desc;
    aim(desc.transform, eye, vec3_sub(target, eye));
    ppm_camera_id id = 0;
    assert_int_equal(ppm_scene_add_camera(scene, &desc, &id), PPM_STATUS_OK);
    return id;
}

ppm_camera_id camera_perspective(ppm_scene *scene, ppmi_vec3 eye, ppmi_vec3 target, float y_fov_rad)
{
    const ppm_camera_desc desc = {.kind = PPM_CAMERA_PERSPECTIVE, .y_fov_rad = y_fov_rad};
    return add_camera(scene, desc, eye, target);
}

ppm_camera_id camera_orthographic(ppm_scene *scene, ppmi_vec3 eye, ppmi_vec3 target,
                                  float half_width_m)
{
    const ppm_camera_desc desc = {.kind = PPM_CAMERA_ORTHOGRAPHIC,
                                  .half_width_m = half_width_m,
                                  .half_height_m = half_width_m};
    return add_camera(scene, desc, eye, target);
}

static ppm_light_id add_light(ppm_scene *scene, ppm_light_desc desc, ppmi_vec3 position,
                              ppmi_vec3 direction)
{
    desc.size = sizeof desc;
    aim(desc.transform, position, direction);
    ppm_light_id id = 0;
    assert_int_equal(ppm_scene_add_light(scene, &desc, &id), PPM_STATUS_OK);
    return id;
}

ppm_light_id light_point(ppm_scene *scene, ppmi_vec3 position, ppmi_vec3 intensity)
{
    ppm_light_desc desc = {.kind = PPM_LIGHT_POINT};
    vec3_store(desc.intensity, intensity);
    return add_light(scene, desc, position, vec3(0.0f, 0.0f, -1.0f));
}

ppm_light_id light_spot(ppm_scene *scene, ppmi_vec3 position, ppmi_vec3 target, ppmi_vec3 intensity,
                        float inner_rad, float outer_rad)
{
    ppm_light_desc desc = {
        .kind = PPM_LIGHT_SPOT, .inner_cone_rad = inner_rad, .outer_cone_rad = outer_rad};
    vec3_store(desc.intensity, intensity);
    return add_light(scene, desc, position, vec3_sub(target, position));
}

ppm_light_id light_directional(ppm_scene *scene, ppmi_vec3 direction, ppmi_vec3 illuminance)
{
    return light_sun(scene, direction, illuminance, 0.0f);
}

ppm_light_id light_sun(ppm_scene *scene, ppmi_vec3 direction, ppmi_vec3 illuminance,
                       float angular_radius_rad)
{
    ppm_light_desc desc = {.kind = PPM_LIGHT_DIRECTIONAL, .angular_radius_rad = angular_radius_rad};
    vec3_store(desc.intensity, illuminance);
    return add_light(scene, desc, vec3(0.0f, 0.0f, 0.0f), direction);
}

void light_environment(ppm_scene *scene, ppmi_vec3 radiance, ppm_image_id image, float rotation_rad)
{
    ppm_environment_desc desc = {.size = sizeof desc, .image = image, .rotation_rad = rotation_rad};
    vec3_store(desc.radiance, radiance);
    assert_int_equal(ppm_scene_set_environment(scene, &desc), PPM_STATUS_OK);
}

void scene_fog(ppm_scene *scene, ppmi_vec3 sigma_s, ppmi_vec3 sigma_a, float asymmetry_g)
{
    ppm_fog_desc desc = {.size = sizeof desc, .asymmetry_g = asymmetry_g};
    vec3_store(desc.sigma_s, sigma_s);
    vec3_store(desc.sigma_a, sigma_a);
    assert_int_equal(ppm_scene_set_fog(scene, &desc), PPM_STATUS_OK);
}

ppm_image_id image_rgb(ppm_scene *scene, uint32_t width, uint32_t height, const float *pixels)
{
    const ppm_image_desc desc = {.size = sizeof desc,
                                 .role = PPM_IMAGE_COLOR,
                                 .pixels = pixels,
                                 .pixel_type = PPM_PIXELS_F32,
                                 .width = width,
                                 .height = height,
                                 .channels = 3};
    ppm_image_id id = 0;
    assert_int_equal(ppm_scene_add_image(scene, &desc, &id), PPM_STATUS_OK);
    return id;
}

/* ---- worlds ---------------------------------------------------------------------------------- */

/* Made once: it takes longer than most tests. */
static const ppmi_albedo_table *shared_albedo(void)
{
    static ppmi_albedo_table table;
    static ppmi_lobe_table lobes;
    static ppmi_glass_table glass;
    if (table.lobes) return &table;
    ppmi_albedo_table_init(&table);
    ppmi_lobe_table_init(&lobes);
    ppmi_glass_table_init(&glass);
    table.lobes = &lobes;
    table.glass = &glass;
    return &table;
}

static const ppmi_spectrum *shared_spectrum(void)
{
    static ppmi_spectrum spectrum;
    static bool is_made;
    if (!is_made) ppmi_spectrum_init(&spectrum, &ppmi_working_space_rec709);
    is_made = true;
    return &spectrum;
}

void world_open(test_world *test, const test_scene *scene)
{
    *test = (test_world){0};
    scene->scene->is_frozen = true;
    assert_int_equal(ppmi_accel_create(scene->context, scene->scene, &test->accel), PPM_STATUS_OK);
    assert_int_equal(ppmi_lights_create(scene->context, scene->scene, &test->lights),
                     PPM_STATUS_OK);
    assert_int_equal(ppmi_contacts_create(scene->context, scene->scene, &test->contacts),
                     PPM_STATUS_OK);
    test->context = scene->context;
    test->albedo = shared_albedo();
    ppmi_world_init(&test->world, scene->scene, test->accel, test->lights, test->albedo,
                    shared_spectrum(), test->contacts);
}

void world_close(test_world *test)
{
    ppmi_contacts_destroy(test->context, test->contacts);
    ppmi_lights_destroy(test->lights);
    ppmi_accel_destroy(test->accel);
}

ppmi_surface world_hit(const test_world *test, ppmi_vec3 origin, ppmi_vec3 direction)
{
    const ppmi_ray ray = {.origin = origin, .t_max = INFINITY, .direction = direction};
    ppmi_hit hit;
    assert_true(ppmi_accel_intersect(test->accel, &ray, &hit));
    ppmi_surface surface;
    ppmi_surface_from_hit(test->world.scene, &hit, &surface);
    return surface;
}
