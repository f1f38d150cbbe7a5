/* Materials, the frozen state, facts and bounds. */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#include "support/near.h"
#include "support/scenes.h"

static test_scene test;

static int open_scene(void **state)
{
    (void)state;
    scene_open(&test);
    return 0;
}

static int close_scene(void **state)
{
    (void)state;
    scene_close(&test);
    return 0;
}

static ppm_material_desc desc;

static void assert_material_refused(void)
{
    ppm_material_id id = 77;
    assert_int_equal(ppm_scene_add_material(test.scene, &desc, &id), PPM_STATUS_INVALID_ARGUMENT);
    assert_int_equal(id, 77);
    ppm_material_desc_init(&desc);
}

static ppm_image_id add_pixels(const void *pixels, int32_t type, uint32_t channels, int32_t role)
{
    const ppm_image_desc image = {.size = sizeof image,
                                  .role = role,
                                  .pixels = pixels,
                                  .pixel_type = type,
                                  .width = 2,
                                  .height = 1,
                                  .channels = channels};
    ppm_image_id id = 0;
    assert_int_equal(ppm_scene_add_image(test.scene, &image, &id), PPM_STATUS_OK);
    return id;
}

static void assert_mean(ppm_image_id id, double r, double g, double b, double a)
{
    float mean[4];
    assert_int_equal(ppm_scene_image_mean(test.scene, id, mean), PPM_STATUS_OK);
    assert_near(mean[0], r, 1e-4);
    assert_near(mean[1], g, 1e-4);
    assert_near(mean[2], b, 1e-4);
    assert_near(mean[3], a, 1e-4);
}

static void the_mean_of_an_image_is_linear_and_alpha_is_1_without(void **state)
{
    (void)state;
    static const uint8_t bytes[8] = {255, 0, 188, 255, 0, 188, 188, 51};
    static const float floats[8] = {1, 2, 3, 4, 3, 2, 1, 0};
    float mean[4];
    assert_int_equal(ppm_scene_image_mean(test.scene, 1, mean), PPM_STATUS_INVALID_ARGUMENT);
    assert_int_equal(ppm_scene_image_mean(test.scene, 0, mean), PPM_STATUS_INVALID_ARGUMENT);
    const double half = 0.50289, low = 188.0 / 255.0; /* sRGB 188, decoded and not */
    assert_mean(add_pixels(bytes, PPM_PIXELS_U8, 4, PPM_IMAGE_COLOR), 0.5, half / 2, half, 0.6);
    assert_mean(add_pixels(bytes, PPM_PIXELS_U8, 4, PPM_IMAGE_DATA), 0.5, low / 2, low, 0.6);
    assert_mean(add_pixels(bytes, PPM_PIXELS_U8, 3, PPM_IMAGE_DATA), 1.0, 0.0, low, 1.0);
    assert_mean(add_pixels(bytes, PPM_PIXELS_U8, 1, PPM_IMAGE_DATA), 0.5, 0.5, 0.5, 1.0);
    assert_mean(add_pixels(floats, PPM_PIXELS_F32, 2, PPM_IMAGE_COLOR), 2.0, 2.0, 2.0, 3.0);
    assert_mean(add_pixels(floats, PPM_PIXELS_F32, 4, PPM_IMAGE_COLOR), 2.0, 2.0, 2.0, 2.0);
}

static void the_pixels_of_an_image_can_be_read_row_by_row(void **state)
{
    (void)state;
    static const uint8_t bytes[8] = {255, 0, 188, 255, 0, 188, 188, 51};
    float row[8];
    ppm_image_info info = {.size = sizeof info};
    assert_int_equal(ppm_scene_get_image_info(test.scene, 1, &info), PPM_STATUS_INVALID_ARGUMENT);
    assert_int_equal(ppm_scene_read_image_row(test.scene, 1, 0, row), PPM_STATUS_INVALID_ARGUMENT);
    const ppm_image_id id = add_pixels(bytes, PPM_PIXELS_U8, 4, PPM_IMAGE_COLOR);
    assert_int_equal(ppm_scene_get_image_info(test.scene, id, &info), PPM_STATUS_OK);
    assert_int_equal(info.width * info.height, 2);
    assert_int_equal(info.channels, 4);
    assert_int_equal(info.pixel_type, PPM_PIXELS_U8);
    assert_int_equal(ppm_scene_read_image_row(test.scene, id, info.height, row),
                     PPM_STATUS_INVALID_ARGUMENT);
    assert_int_equal(ppm_scene_read_image_row(test.scene, id, 0, NULL),
                     PPM_STATUS_INVALID_ARGUMENT);
    info.size = 4;
    assert_int_equal(ppm_scene_get_image_info(test.scene, id, &info), PPM_STATUS_INVALID_ARGUMENT);
    assert_int_equal(ppm_scene_read_image_row(test.scene, id, 0, row), PPM_STATUS_OK);
    assert_near(row[0], 1.0, 1e-6);
    assert_near(row[2], 0.50289, 1e-4); /* sRGB 188, decoded */
    assert_near(row[3], 1.0, 1e-6);
}

static void factors_out_of_range_are_refused(void **state)
{
    (void)state;
    ppm_material_desc_init(&desc);
    const float bad[] = {-0.1f, 1.1f, NAN, INFINITY};
    float *const unit_factors[] = {&desc.base_color[0],
                                   &desc.base_color[1],
                                   &desc.base_color[2],
                                   &desc.base_color[3],
                                   &desc.metallic,
                                   &desc.roughness,
                                   &desc.specular,
                                   &desc.transmission,
                                   &desc.attenuation_color[0],
                                   &desc.clearcoat,
                                   &desc.clearcoat_roughness,
                                   &desc.sheen_color[1],
                                   &desc.sheen_roughness,
                                   &desc.iridescence,
                                   &desc.anisotropy,
                                   &desc.diffuse_transmission,
                                   &desc.diffuse_transmission_color[2],
                                   &desc.multiscatter_color[0],
                                   &desc.retroreflection,
                                   &desc.diffuse_roughness,
                                   &desc.coat_color[1],
                                   &desc.coat_darkening,
                                   &desc.coat_anisotropy,
                                   &desc.fuzz};
    for (size_t f = 0; f < sizeof unit_factors / sizeof unit_factors[0]; f++) {
        for (size_t b = 0; b < 4; b++) {
            *unit_factors[f] = bad[b];
            assert_material_refused();
        }
    }
    float *const factors[] = {&desc.emission[0],
                              &desc.ior,
                              &desc.specular_color[2],
                              &desc.attenuation_distance_m,
                              &desc.alpha_cutoff,
                              &desc.iridescence_ior,
                              &desc.iridescence_thickness_min_nm,
                              &desc.iridescence_thickness_max_nm,
                              &desc.scatter_anisotropy_g};
    for (size_t f = 0; f < sizeof factors / sizeof factors[0]; f++) {
        *factors[f] = -1.0f;
        assert_material_refused();
        *factors[f] = NAN;
        assert_material_refused();
    }
    desc.normal_scale = NAN;
    assert_material_refused();
    assert_int_equal(test.scene->material_count, 0);
}

static void choices_out_of_range_are_refused(void **state)
{
    (void)state;
    ppm_material_desc_init(&desc);
    const float pixel[3] = {1.0f, 1.0f, 1.0f};
    const ppm_image_id image = image_rgb(test.scene, 1, 1, pixel);
    desc.alpha_mode = 3;
    assert_material_refused();
    desc.alpha_mode = -1;
    assert_material_refused();
    desc.transmission_kind = 2;
    assert_material_refused();
    desc.base_color_texture = (ppm_texture){.image = image, .wrap_u = 3};
    assert_material_refused();
    desc.base_color_texture = (ppm_texture){.image = image, .wrap_v = -1};
    assert_material_refused();
    desc.base_color_texture = (ppm_texture){.image = image, .filter = 2};
    assert_material_refused();
}

static void textures_must_exist(void **state)
{
    (void)state;
    ppm_material_desc_init(&desc);
    ppm_texture *const slots[] = {&desc.base_color_texture,
                                  &desc.metallic_roughness_texture,
                                  &desc.normal_texture,
                                  &desc.emission_texture,
                                  &desc.specular_texture,
                                  &desc.specular_color_texture,
                                  &desc.transmission_texture,
                                  &desc.clearcoat_texture,
                                  &desc.clearcoat_roughness_texture,
                                  &desc.clearcoat_normal_texture,
                                  &desc.sheen_color_texture,
                                  &desc.sheen_roughness_texture,
                                  &desc.iridescence_texture,
                                  &desc.iridescence_thickness_texture,
                                  &desc.anisotropy_texture,
                                  &desc.diffuse_transmission_texture,
                                  &desc.diffuse_transmission_color_texture,
                                  &desc.retroreflection_texture,
                                  &desc.diffuse_roughness_texture,
                                  &desc.coat_color_texture,
                                  &desc.coat_anisotropy_texture,
                                  &desc.fuzz_texture};
    const float pixel[3] = {1.0f, 1.0f, 1.0f};
    const ppm_image_id image = image_rgb(test.scene, 1, 1, pixel);
    for (size_t i = 0; i < sizeof slots / sizeof slots[0]; i++) {
        slots[i]->image = image + 1;
        assert_material_refused();
        *slots[i] = (ppm_texture){.image = image, .uv_set = PPM_MAX_UV_SETS};
        assert_material_refused();
        *slots[i] = (ppm_texture){.image = image, .has_transform = 1, .uv_transform = {NAN}};
        assert_material_refused();
    }
    desc.normal_texture = (ppm_texture){.image = image};
    material_add(test.scene, &desc);
}

/* What is inside of the material that was added last. */
static const ppmi_material *add(void)
{
    material_add(test.scene, &desc);
    return &test.scene->materials[test.scene->material_count - 1];
}

/* Extinction is -ln(colour) / distance, whatever part of it scatters. */
static void a_medium_scatters_by_its_colour_after_all_scattering(void **state)
{
    (void)state;
    ppm_material_desc_init(&desc);
    desc.transmission = 1.0f;
    desc.attenuation_distance_m = 0.5f;
    const float colors[3] = {0.0f, 0.5f, 1.0f};
    for (int i = 0; i < 3; i++) {
        desc.attenuation_color[i] = 0.25f;
        desc.multiscatter_color[i] = colors[i];
    }
    desc.scatter_anisotropy_g = 0.3f;
    const ppmi_medium *inside = &add()->inside;
    const double sigma_t = -log(0.25) / 0.5;
    const double s = 4.09712 + 4.20863 * 0.5 - sqrt(9.59217 + 41.6808 * 0.5 + 17.7126 * 0.25);
    assert_near(inside->sigma_s.x, 0.0, 0.0); /* nothing scatters that was not said to */
    assert_near(inside->sigma_s.y, sigma_t * (1.0 - s * s), 1e-5);
    assert_near(inside->sigma_s.z, sigma_t, 1e-4);
    assert_near(inside->sigma_s.x + inside->sigma_a.x, sigma_t, 1e-5);
    assert_near(inside->sigma_s.y + inside->sigma_a.y, sigma_t, 1e-5);
    assert_near(inside->asymmetry_g, 0.3, 1e-6);
}

/* A leaf is no border of anything; wax is, and so is glass without anything in it. */
static void diffuse_transmission_bounds_a_solid_that_has_something_inside(void **state)
{
    (void)state;
    ppm_material_desc_init(&desc);
    desc.diffuse_transmission = 0.5f;
    assert_false(add()->is_solid_glass);
    desc.attenuation_distance_m = 0.01f;
    desc.attenuation_color[1] = 0.5f;
    assert_true(add()->is_solid_glass);
    desc.transmission_kind = PPM_TRANSMISSION_THIN;
    assert_false(add()->is_solid_glass);
    assert_near(add()->inside.sigma_a.y, 0.0, 0.0);
    ppm_material_desc_init(&desc);
    desc.transmission = 1.0f;
    assert_true(add()->is_solid_glass);
}

static void defaults_are_those_of_the_header(void **state)
{
    (void)state;
    ppm_material_desc_init(&desc);
    assert_int_equal(desc.size, sizeof desc);
    assert_near(desc.base_color[3], 1.0, 0.0);
    assert_near(desc.metallic, 0.0, 0.0);
    assert_near(desc.roughness, 0.5, 0.0);
    assert_near(desc.ior, 1.5, 0.0);
    assert_near(desc.specular, 1.0, 0.0);
    assert_near(desc.alpha_cutoff, 0.5, 0.0);
    assert_near(desc.normal_scale, 1.0, 0.0);
    assert_int_equal(desc.double_sided, 1);
    desc.size = 8;
    assert_material_refused();
}

static void environments_are_checked(void **state)
{
    (void)state;
    const ppm_environment_desc good = {.size = sizeof good, .radiance = {1.0f, 1.0f, 1.0f}};
    ppm_environment_desc bad = good;
    bad.radiance[1] = NAN;
    assert_int_equal(ppm_scene_set_environment(test.scene, &bad), PPM_STATUS_INVALID_ARGUMENT);
    bad = good;
    bad.radiance[2] = -1.0f;
    assert_int_equal(ppm_scene_set_environment(test.scene, &bad), PPM_STATUS_INVALID_ARGUMENT);
    bad = good;
    bad.image = 1;
    assert_int_equal(ppm_scene_set_environment(test.scene, &bad), PPM_STATUS_INVALID_ARGUMENT);
    bad = good;
    bad.rotation_rad = INFINITY;
    assert_int_equal(ppm_scene_set_environment(test.scene, &bad), PPM_STATUS_INVALID_ARGUMENT);
    assert_false(ppmi_scene_has_light(test.scene));
    assert_int_equal(ppm_scene_set_environment(test.scene, &good), PPM_STATUS_OK);
    assert_true(ppmi_scene_has_light(test.scene));
}

static void a_frozen_scene_takes_nothing(void **state)
{
    (void)state;
    const ppm_material_id grey = material_lambert(test.scene, 0.5f);
    const ppm_mesh_id mesh =
        shape_box(test.scene, grey, vec3_splat(0.0f), vec3_splat(1.0f), 1, false);
    shape_place(test.scene, mesh);
    test.scene->is_frozen = true;
    uint32_t id = 77;
    ppm_material_desc_init(&desc);
    assert_int_equal(ppm_scene_add_material(test.scene, &desc, &id), PPM_STATUS_WRONG_STATE);
    const ppm_mesh_desc mesh_desc = {.size = sizeof mesh_desc};
    assert_int_equal(ppm_scene_add_mesh(test.scene, &mesh_desc, &id), PPM_STATUS_WRONG_STATE);
    const ppm_instance_desc instance = {.size = sizeof instance, .mesh = mesh};
    assert_int_equal(ppm_scene_add_instance(test.scene, &instance, &id), PPM_STATUS_WRONG_STATE);
    const ppm_camera_desc camera = {.size = sizeof camera};
    assert_int_equal(ppm_scene_add_camera(test.scene, &camera, &id), PPM_STATUS_WRONG_STATE);
    assert_int_equal(ppm_scene_add_framing_camera(test.scene, 1.0f, &id), PPM_STATUS_WRONG_STATE);
    const ppm_light_desc light = {.size = sizeof light};
    assert_int_equal(ppm_scene_add_light(test.scene, &light, &id), PPM_STATUS_WRONG_STATE);
    const ppm_environment_desc environment = {.size = sizeof environment};
    assert_int_equal(ppm_scene_set_environment(test.scene, &environment), PPM_STATUS_WRONG_STATE);
    const ppm_image_desc image = {.size = sizeof image};
    assert_int_equal(ppm_scene_add_image(test.scene, &image, &id), PPM_STATUS_WRONG_STATE);
    assert_int_equal(id, 77);
}

static void facts_count_what_there_is(void **state)
{
    (void)state;
    const ppm_material_id lamp = material_emitter(test.scene, 1.0f, 0.0f, false);
    const ppm_material_id grey = material_lambert(test.scene, 0.5f);
    const ppm_mesh_id quad =
        shape_quad(test.scene, lamp, vec3_splat(0.0f), vec3(1, 0, 0), vec3(0, 1, 0));
    const ppm_mesh_id box =
        shape_box(test.scene, grey, vec3_splat(-1.0f), vec3_splat(0.0f), 2, false);
    shape_place(test.scene, quad);
    shape_place_at(test.scene, quad, vec3(0.0f, 5.0f, 0.0f));
    shape_place(test.scene, box);
    light_point(test.scene, vec3_splat(0.0f), vec3_splat(1.0f));
    light_environment(test.scene, vec3_splat(1.0f), 0, 0.0f);
    ppm_scene_info info = {.size = sizeof info};
    assert_int_equal(ppm_scene_get_info(test.scene, &info), PPM_STATUS_OK);
    assert_int_equal(info.triangles, 2 + 48);
    assert_int_equal(info.instances, 3);
    assert_int_equal(info.meshes, 2);
    assert_int_equal(info.materials, 2);
    assert_int_equal(info.lights, 2 * 2 + 1 + 1);
    assert_int_equal(info.has_light, 1);
    assert_near(info.bounds_min[0], -1.0, 0.0);
    assert_near(info.bounds_max[1], 6.0, 0.0);
    info.size = 3;
    assert_int_equal(ppm_scene_get_info(test.scene, &info), PPM_STATUS_INVALID_ARGUMENT);
}

static void bounds_of_turned_and_mirrored_instances_are_tight(void **state)
{
    (void)state;
    const ppm_material_id grey = material_lambert(test.scene, 0.5f);
    const ppm_mesh_id ball = shape_sphere(test.scene, grey, 1.0f, 64, true);
    const float c = cosf(0.7f), s = sinf(0.7f);
    /* turned about z, mirrored in x, and moved: a ball keeps its extent */
    const float turned[16] = {-c, -s, 0.0f, 0.0f, -s,   c,    0.0f, 0.0f,
                              0,  0,  1.0f, 0.0f, 2.0f, 3.0f, 4.0f, 1.0f};
    shape_place_by(test.scene, ball, turned);
    ppmi_vec3 low, high;
    assert_true(ppmi_scene_bounds(test.scene, &low, &high));
    const float facets = 2e-3f; /* 1 - cos(pi / 128), and a quarter turn between columns */
    assert_near(low.x, 1.0, facets);
    assert_near(high.x, 3.0, facets);
    assert_near(low.y, 2.0, facets);
    assert_near(high.z, 5.0, facets);
}

/* A box, a lamp and a camera around a place. */
static void build_around(ppmi_vec3 place)
{
    const ppm_material_id grey = material_lambert(test.scene, 0.5f);
    shape_place_at(test.scene,
                   shape_box(test.scene, grey, vec3_splat(-1.0f), vec3_splat(1.0f), 1, false),
                   place);
    light_point(test.scene, vec3_add(place, vec3(0, 2, 0)), vec3_splat(1.0f));
    camera_perspective(test.scene, vec3_add(place, vec3(0, 0, 4)), place, 0.5f);
}

static void a_far_scene_is_moved_to_the_origin_as_a_whole(void **state)
{
    (void)state;
    const ppmi_vec3 place = vec3(65536.0f, -1024.0f, 4096.0f); /* exact in floats */
    build_around(place);
    ppmi_scene_freeze(test.scene);
    ppmi_vec3 low, high;
    assert_true(ppmi_scene_bounds(test.scene, &low, &high));
    assert_near(low.x, -1.0, 0.0);
    assert_near(high.y, 1.0, 0.0);
    assert_near(test.scene->punctuals[0].position.y, 2.0, 0.0);
    assert_near(test.scene->punctuals[0].position.x, 0.0, 0.0);
    assert_near(test.scene->cameras[0].origin.z, 4.0, 0.0);
    ppm_scene_info info = {.size = sizeof info};
    assert_int_equal(ppm_scene_get_info(test.scene, &info), PPM_STATUS_OK);
    assert_near(info.bounds_min[0], 65535.0, 0.0);
    assert_near(info.bounds_max[2], 4097.0, 0.0);
}

static void a_near_scene_stays_where_it_is(void **state)
{
    (void)state;
    build_around(vec3(3.0f, 0.0f, 0.0f));
    ppmi_scene_freeze(test.scene);
    assert_near(test.scene->cameras[0].origin.x, 3.0, 0.0);
    assert_near(vec3_length(test.scene->shift), 0.0, 0.0);
}

/* Also once it has been moved to the origin. */
static void instances_tell_name_and_box(void **state)
{
    (void)state;
    float low[3] = {7, 7, 7}, high[3];
    const ppm_mesh_id box = shape_box(test.scene, 0, vec3_splat(-1), vec3_splat(1), 1, false);
    const ppm_instance_desc named = {
        .size = sizeof named,
        .name = "Crate",
        .mesh = box,
        .transform = {2, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 4096, 0, 0, 1}};
    ppm_instance_id id = 0;
    assert_int_equal(ppm_scene_instance_count(test.scene), 0);
    assert_int_equal(ppm_scene_add_instance(test.scene, &named, &id), PPM_STATUS_OK);
    shape_place_at(test.scene, box, vec3(4096, 5, 0));
    assert_int_equal(ppm_scene_instance_count(test.scene), 2);
    for (int i = 0; i < 2; i++) {
        assert_string_equal(ppm_scene_instance_name(test.scene, id), "Crate");
        assert_string_equal(ppm_scene_instance_name(test.scene, 2), "shape");
        assert_null(ppm_scene_instance_name(test.scene, 0));
        assert_null(ppm_scene_instance_name(test.scene, 3));
        assert_int_equal(ppm_scene_instance_bounds(test.scene, 3, low, high),
                         PPM_STATUS_INVALID_ARGUMENT);
        assert_int_equal(ppm_scene_instance_bounds(test.scene, id, low, high), PPM_STATUS_OK);
        assert_near(low[0], 4094.0, 0.0);
        assert_near(high[0], 4098.0, 0.0);
        assert_near(low[1], -1.0, 0.0);
        assert_near(high[2], 1.0, 0.0);
        ppmi_scene_freeze(test.scene);
    }
    assert_true(vec3_length(test.scene->shift) > 1000.0f);
}

int main(void)
{
#define WITH_SCENE(f) cmocka_unit_test_setup_teardown(f, open_scene, close_scene)
    const struct CMUnitTest tests[] = {
        WITH_SCENE(factors_out_of_range_are_refused),
        WITH_SCENE(the_mean_of_an_image_is_linear_and_alpha_is_1_without),
        WITH_SCENE(the_pixels_of_an_image_can_be_read_row_by_row),
        WITH_SCENE(choices_out_of_range_are_refused),
        WITH_SCENE(textures_must_exist),
        WITH_SCENE(a_medium_scatters_by_its_colour_after_all_scattering),
        WITH_SCENE(diffuse_transmission_bounds_a_solid_that_has_something_inside),
        WITH_SCENE(defaults_are_those_of_the_header),
        WITH_SCENE(environments_are_checked),
        WITH_SCENE(a_frozen_scene_takes_nothing),
        WITH_SCENE(facts_count_what_there_is),
        WITH_SCENE(bounds_of_turned_and_mirrored_instances_are_tight),
        WITH_SCENE(a_far_scene_is_moved_to_the_origin_as_a_whole),
        WITH_SCENE(a_near_scene_stays_where_it_is),
        WITH_SCENE(instances_tell_name_and_box),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
