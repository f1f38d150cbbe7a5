/* All integrators agree on a scene in which what is known apart comes together: motion blur, lamps
 * with an extent and a profile, points and lines, textures with mipmaps, alpha and layers. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <string.h>

#include <cmocka.h>

#include "statistical/methods.h"
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

/* A pattern of texels: colour, with alpha that is 1 in half of them, or normals that lean a little.
 */
static ppm_image_id pattern(int32_t role)
{
    enum { SIDE = 16 };
    static uint8_t pixels[4 * SIDE * SIDE];
    for (uint32_t i = 0; i < SIDE * SIDE; i++) {
        const bool is_odd = (i % SIDE / 2 + i / SIDE / 2) % 2 != 0;
        const uint8_t color[4] = {is_odd ? 230 : 90, 128, is_odd ? 100 : 240, is_odd ? 255 : 100};
        const uint8_t normal[4] = {is_odd ? 150 : 106, 128, 252, 255};
        memcpy(pixels + 4 * (size_t)i, role == PPM_IMAGE_COLOR ? color : normal, 4);
    }
    const ppm_image_desc desc = {.size = sizeof desc,
                                 .role = role,
                                 .pixels = pixels,
                                 .pixel_type = PPM_PIXELS_U8,
                                 .width = SIDE,
                                 .height = SIDE,
                                 .channels = 4};
    ppm_image_id id = 0;
    assert_int_equal(ppm_scene_add_image(test.scene, &desc, &id), PPM_STATUS_OK);
    return id;
}

/* From one place to another, and turned by a quarter, while the shutter is open. */
static void place_moving(ppm_mesh_id mesh, ppmi_vec3 from, ppmi_vec3 to)
{
    const float motion[32] = {1, 0,  0, 0, 0, 1, 0, 0, 0, 0, 1, 0, from.x, from.y, from.z, 1,
                              0, -1, 0, 0, 1, 0, 0, 0, 0, 0, 1, 0, to.x,   to.y,   to.z,   1};
    const ppm_instance_desc desc = {
        .size = sizeof desc, .mesh = mesh, .motion_steps = 2, .motion = motion};
    ppm_instance_id id = 0;
    assert_int_equal(ppm_scene_add_instance(test.scene, &desc, &id), PPM_STATUS_OK);
}

static void add_box(void)
{
    const ppm_material_id grey = material_lambert_rgb(test.scene, vec3(0.6f, 0.5f, 0.4f));
    shape_place(test.scene, shape_box(test.scene, grey, vec3_splat(-1), vec3_splat(1), 1, true));
    camera_perspective(test.scene, vec3(0, 0, 0.95f), vec3(0, -0.1f, -1), 1.2f);
}

/* Light of the given intensity, radius and profile that shines downwards from p. */
static void add_lamp(int32_t kind, ppmi_vec3 p, float intensity, ppm_light_profile_id profile)
{
    const ppm_light_desc desc = {
        .size = sizeof desc,
        .kind = kind,
        .transform = {1, 0, 0, 0, 0, 0, -1, 0, 0, 1, 0, 0, p.x, p.y, p.z, 1},
        .intensity = {intensity, intensity, intensity},
        .radius_m = 0.1f,
        .width_m = 0.4f,
        .height_m = 0.3f,
        .profile = profile};
    ppm_light_id id = 0;
    assert_int_equal(ppm_scene_add_light(test.scene, &desc, &id), PPM_STATUS_OK);
}

static ppm_light_profile_id add_profile(void)
{
    static const float polar[3] = {0.0f, 1.2f, 3.1f}, azimuth[1] = {0.0f},
                       candela[3] = {1.0f, 0.6f, 0.2f};
    const ppm_light_profile_desc desc = {.size = sizeof desc,
                                         .polar_count = 3,
                                         .azimuth_count = 1,
                                         .polar_rad = polar,
                                         .azimuth_rad = azimuth,
                                         .candela = candela};
    ppm_light_profile_id id = 0;
    assert_int_equal(ppm_scene_add_light_profile(test.scene, &desc, &id), PPM_STATUS_OK);
    return id;
}

/* Lines or points with colours, texture coordinates and a given material, in motion. */
static void add_round(int32_t kind, const ppm_material_desc *material, ppmi_vec3 from, ppmi_vec3 to)
{
    static const float positions[12] = {-0.3f, 0, 0, 0.3f, 0, 0, 0, -0.3f, 0.1f, 0, 0.3f, 0.1f};
    static const float uvs[8] = {0, 0, 1, 0, 0, 1, 1, 1};
    static const float colors[16] = {1, 1, 1, 1, 0.5f, 1, 1, 0.7f, 1, 1, 1, 0.4f, 1, 1, 0, 1};
    static const uint32_t indices[4] = {0, 1, 2, 3};
    const ppm_primitive_desc desc = {.vertex_count = 4,
                                     .positions = positions,
                                     .uvs = {uvs},
                                     .colors = colors,
                                     .indices = indices,
                                     .material = material_add(test.scene, material),
                                     .kind = kind,
                                     .element_count = kind == PPM_PRIMITIVE_LINES ? 2 : 4,
                                     .radius_m = 0.12f};
    place_moving(shape_mesh(test.scene, &desc), from, to);
}

/* A sheet with texture coordinates, tangents from them, in motion. */
static void add_sheet(const ppm_material_desc *material, ppmi_vec3 from, ppmi_vec3 to)
{
    static const float positions[12] = {-0.4f, -0.4f, 0, 0.4f, -0.4f, 0,
                                        -0.4f, 0.4f,  0, 0.4f, 0.4f,  0};
    static const float uvs[8] = {0, 3, 3, 3, 0, 0, 3, 0};
    static const uint32_t indices[6] = {0, 1, 2, 2, 1, 3};
    const ppm_primitive_desc desc = {.vertex_count = 4,
                                     .triangle_count = 2,
                                     .positions = positions,
                                     .uvs = {uvs},
                                     .indices = indices,
                                     .material = material_add(test.scene, material)};
    place_moving(shape_mesh(test.scene, &desc), from, to);
}

static const method_comparison how = {.width = 48,
                                      .path_passes = 30,
                                      .passes = 8,
                                      .photons = 16000,
                                      .radius_m = 0.02f,
                                      .bias = 0.01,
                                      .resolution = 0.06,
                                      .seeds = 5,
                                      .left_out = METHODS_OF_OTHER_RADII,
                                      .shutter_frames = 0.5f};

static void a_box_of_layered_things_in_motion_under_lamps(void **state)
{
    (void)state;
    const ppm_image_id color = pattern(PPM_IMAGE_COLOR), data = pattern(PPM_IMAGE_DATA);
    add_box();
    add_lamp(PPM_LIGHT_POINT, vec3(-0.5f, 0.6f, 0.0f), 1.5f, add_profile());
    add_lamp(PPM_LIGHT_RECTANGLE, vec3(0.4f, 0.8f, -0.2f), 8.0f, 0);
    add_lamp(PPM_LIGHT_DISK, vec3(0.0f, 0.7f, -0.7f), 8.0f, 0);
    ppm_material_desc velvet = material_desc_rgb(vec3(0.6f, 0.3f, 0.4f), 0.0f, 0.5f);
    velvet.sheen_color[0] = velvet.sheen_color[1] = 0.7f;
    velvet.sheen_roughness = 0.6f;
    velvet.base_color_texture.image = color;
    velvet.normal_texture.image = velvet.clearcoat_normal_texture.image = data;
    velvet.clearcoat = 0.6f;
    velvet.clearcoat_roughness = 0.7f;
    velvet.alpha_mode = PPM_ALPHA_BLEND;
    add_round(PPM_PRIMITIVE_LINES, &velvet, vec3(-0.5f, -0.5f, -0.5f), vec3(-0.3f, -0.4f, -0.5f));
    add_sheet(&velvet, vec3(0.3f, -0.4f, -0.6f), vec3(0.4f, -0.3f, -0.6f));
    ppm_material_desc leaf = material_desc_rgb(vec3(0.4f, 0.7f, 0.3f), 0.0f, 0.5f);
    leaf.diffuse_transmission = 0.6f;
    leaf.transmission_kind = PPM_TRANSMISSION_THIN;
    leaf.anisotropy = 0.5f;
    leaf.roughness = 0.7f;
    leaf.emission[0] = 0.1f;
    add_round(PPM_PRIMITIVE_POINTS, &leaf, vec3(-0.3f, 0.1f, -0.3f), vec3(-0.3f, 0.3f, -0.4f));
    add_sheet(&leaf, vec3(-0.2f, 0.2f, -0.8f), vec3(-0.3f, 0.1f, -0.7f));
    methods_agree(test.scene, &how);
}

/* Half of their light begins inside, and comes out through the leaf. */
static void round_leaves_that_shine_to_both_sides(void **state)
{
    (void)state;
    add_box();
    ppm_material_desc leaf = material_desc_rgb(vec3(0.4f, 0.7f, 0.3f), 0.0f, 0.5f);
    leaf.diffuse_transmission = 0.6f;
    leaf.transmission_kind = PPM_TRANSMISSION_THIN;
    leaf.roughness = 0.7f;
    leaf.double_sided = 1;
    vec3_store(leaf.emission, vec3_splat(1.0f));
    add_round(PPM_PRIMITIVE_POINTS, &leaf, vec3(-0.3f, 0.1f, -0.3f), vec3(-0.3f, 0.3f, -0.4f));
    methods_agree(test.scene, &how);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test_setup_teardown(round_leaves_that_shine_to_both_sides, open_scene,
                                        close_scene),
        cmocka_unit_test_setup_teardown(a_box_of_layered_things_in_motion_under_lamps, open_scene,
                                        close_scene),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
