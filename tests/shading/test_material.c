/* Materials at a point: factors times textures, normal maps, alpha, emission, attenuation. */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <string.h>

#include <cmocka.h>

#include "shading/material.h"
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

static ppm_image_id one_texel(float r, float g, float b, float a)
{
    const float pixel[4] = {r, g, b, a};
    const ppm_image_desc desc = {.size = sizeof desc,
                                 .role = PPM_IMAGE_DATA,
                                 .pixels = pixel,
                                 .pixel_type = PPM_PIXELS_F32,
                                 .width = 1,
                                 .height = 1,
                                 .channels = 4};
    ppm_image_id id = 0;
    assert_int_equal(ppm_scene_add_image(test.scene, &desc, &id), PPM_STATUS_OK);
    return id;
}

/* A unit quad in the xy plane, facing +z, v running down; optionally with vertex colours. */
static void place_quad(const ppm_material_desc *desc, const float *colors,
                       const float transform[16])
{
    static const float positions[12] = {0, 0, 0, 1, 0, 0, 1, 1, 0, 0, 1, 0};
    static const float uvs[8] = {0, 1, 1, 1, 1, 0, 0, 0};
    static const uint32_t indices[6] = {0, 1, 2, 0, 2, 3};
    static const float identity[16] = {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1};
    const ppm_primitive_desc primitive = {.vertex_count = 4,
                                          .triangle_count = 2,
                                          .positions = positions,
                                          .uvs = {uvs},
                                          .colors = colors,
                                          .indices = indices,
                                          .material = material_add(test.scene, desc)};
    shape_place_by(test.scene, shape_mesh(test.scene, &primitive),
                   transform ? transform : identity);
}

static ppmi_surface surface_at(uint32_t instance, uint32_t triangle, float u, float v)
{
    const ppmi_hit hit = {.instance = instance, .triangle = triangle, .u = u, .v = v};
    ppmi_surface surface;
    ppmi_surface_from_hit(test.scene, &hit, &surface);
    return surface;
}

static ppm_material_desc defaults(void)
{
    ppm_material_desc desc;
    ppm_material_desc_init(&desc);
    return desc;
}

static void textures_multiply_the_factors(void **state)
{
    (void)state;
    ppm_material_desc desc = defaults();
    desc.base_color[0] = 0.5f;
    desc.base_color_texture.image = one_texel(0.8f, 0.6f, 0.4f, 1.0f);
    desc.metallic = 0.5f;
    desc.roughness = 0.6f;
    desc.metallic_roughness_texture.image = one_texel(0.0f, 0.5f, 0.8f, 1.0f);
    desc.specular = 0.9f;
    desc.specular_texture.image = one_texel(0.0f, 0.0f, 0.0f, 0.5f);
    desc.specular_color[2] = 2.0f;
    desc.specular_color_texture.image = one_texel(0.3f, 0.4f, 0.5f, 0.0f);
    desc.transmission = 0.5f;
    desc.transmission_texture.image = one_texel(0.4f, 0.0f, 0.0f, 0.0f);
    const float colors[16] = {1, 0.5f, 1, 1, 1, 0.5f, 1, 1, 1, 0.5f, 1, 1, 1, 0.5f, 1, 1};
    place_quad(&desc, colors, NULL);
    const ppmi_surface surface = surface_at(0, 0, 0.2f, 0.3f);
    ppmi_material_point point;
    ppmi_material_evaluate(test.scene, &surface, &point);
    assert_near(point.base_color.x, 0.4, 1e-6);
    assert_near(point.base_color.y, 0.3, 1e-6);
    assert_near(point.roughness, 0.3, 1e-6);
    assert_near(point.metallic, 0.4, 1e-6);
    assert_near(point.specular, 0.45, 1e-6);
    assert_near(point.specular_color.z, 1.0, 1e-6);
    assert_near(point.transmission, 0.2, 1e-6);
}

static void vertex_colours_tint_emission_where_the_material_says_so(void **state)
{
    (void)state;
    const float colors[16] = {1, 0.5f, 0, 1, 1, 0.5f, 0, 1, 1, 0.5f, 0, 1, 1, 0.5f, 0, 1};
    ppm_material_desc desc = defaults();
    desc.emission[0] = desc.emission[1] = desc.emission[2] = 2.0f;
    place_quad(&desc, colors, NULL);
    desc.emission_takes_vertex_color = 1;
    place_quad(&desc, colors, NULL);
    for (uint32_t i = 0; i < 2; i++) {
        const ppmi_surface surface = surface_at(i, 0, 0.2f, 0.3f);
        const ppmi_vec3 radiance = ppmi_surface_emission(test.scene, &surface, surface.ng);
        assert_near(radiance.x, 2.0, 1e-6);
        assert_near(radiance.y, i == 0 ? 2.0 : 1.0, 1e-6);
        assert_near(radiance.z, i == 0 ? 2.0 : 0.0, 1e-6);
    }
}

static void glossiness_stands_in_alpha_and_is_one_less_roughness(void **state)
{
    (void)state;
    ppm_material_desc desc = defaults();
    desc.metallic = 0.5f;
    desc.roughness = 0.5f; /* glossiness */
    desc.roughness_is_glossiness = 1;
    desc.metallic_roughness_texture.image = one_texel(0.0f, 0.9f, 0.0f, 0.8f);
    place_quad(&desc, NULL, NULL);
    desc.metallic_roughness_texture.image = 0;
    place_quad(&desc, NULL, NULL);
    for (uint32_t i = 0; i < 2; i++) {
        const ppmi_surface surface = surface_at(i, 0, 0.2f, 0.3f);
        ppmi_material_point point;
        ppmi_material_evaluate(test.scene, &surface, &point);
        assert_near(point.roughness, i == 0 ? 0.6 : 0.5, 1e-6);
        assert_near(point.metallic, 0.5, 1e-6);
    }
}

static void a_normal_map_tilts_the_normal(void **state)
{
    (void)state;
    ppm_material_desc desc = defaults();
    /* x to the right of the picture, y to its top, which here is +y of the world */
    desc.normal_texture.image = one_texel(0.8f, 0.6f, 0.9f, 1.0f);
    place_quad(&desc, NULL, NULL);
    const float mirrored[16] = {-1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1};
    place_quad(&desc, NULL, mirrored);
    desc.normal_scale = 0.5f;
    place_quad(&desc, NULL, NULL);
    const ppmi_vec3 full = vec3_normalize(vec3(0.6f, 0.2f, 0.8f));
    const ppmi_vec3 half = vec3_normalize(vec3(0.3f, 0.1f, 0.8f));
    const ppmi_vec3 expected[3] = {full, {-full.x, full.y, full.z}, half};
    for (uint32_t instance = 0; instance < 3; instance++) {
        for (uint32_t triangle = 0; triangle < 2; triangle++) {
            const ppmi_surface surface = surface_at(instance, triangle, 0.3f, 0.3f);
            assert_near(surface.ng.z, 1.0, 1e-6);
            ppmi_material_point point;
            ppmi_material_evaluate(test.scene, &surface, &point);
            assert_near(vec3_length(vec3_sub(point.ns, expected[instance])), 0.0, 1e-5);
        }
    }
}

static void a_flat_normal_map_changes_nothing(void **state)
{
    (void)state;
    ppm_material_desc desc = defaults();
    desc.normal_texture.image = one_texel(0.5f, 0.5f, 1.0f, 1.0f);
    place_quad(&desc, NULL, NULL);
    const ppmi_surface surface = surface_at(0, 1, 0.2f, 0.2f);
    ppmi_material_point point;
    ppmi_material_evaluate(test.scene, &surface, &point);
    assert_near(point.ns.z, 1.0, 1e-6);
}

/* A picture of directions, each texel another one: no turn or mirroring of it is like another. */
static ppm_image_id many_directions(void)
{
    float pixels[4 * 4 * 3];
    for (int i = 0; i < 16; i++) {
        pixels[3 * i] = 0.5f + 0.4f * sinf(1.7f * (float)i + 0.3f);
        pixels[3 * i + 1] = 0.5f + 0.4f * sinf(2.9f * (float)i + 1.1f);
        pixels[3 * i + 2] = 0.9f;
    }
    const ppm_image_desc desc = {.size = sizeof desc,
                                 .role = PPM_IMAGE_DATA,
                                 .pixels = pixels,
                                 .pixel_type = PPM_PIXELS_F32,
                                 .width = 4,
                                 .height = 4,
                                 .channels = 3};
    ppm_image_id id = 0;
    assert_int_equal(ppm_scene_add_image(test.scene, &desc, &id), PPM_STATUS_OK);
    return id;
}

/* A board under a texture in all slots that hold directions. The transform m is the texture's, over
 * given tangents, or is in the coordinates, without any. */
static void place_directions(const float m[6], bool is_in_texture, ppm_image_id image)
{
    ppm_material_desc desc = defaults();
    ppm_texture texture = {.image = image, .has_transform = is_in_texture};
    memcpy(texture.uv_transform, m, sizeof texture.uv_transform);
    desc.clearcoat = 1.0f;
    desc.anisotropy = 1.0f;
    desc.anisotropy_rotation_rad = 0.4f;
    desc.normal_texture = desc.clearcoat_normal_texture = desc.anisotropy_texture = texture;
    shape_add_board(test.scene, &desc, is_in_texture ? NULL : m, is_in_texture);
}

static void turned_pictures_of_directions_are_like_turned_coordinates(void **state)
{
    (void)state;
    static const float turns[][6] = {
        {0, 1, 0, -1, 0, 1}, {0.6f, 0.8f, 0.1f, -0.8f, 0.6f, 0}, {-1, 0, 1, 0, 1, 0}};
    const ppm_image_id image = many_directions();
    for (uint32_t turn = 0; turn < 3; turn++) {
        place_directions(turns[turn], true, image);
        place_directions(turns[turn], false, image);
        for (uint32_t i = 0; i < 32; i++) {
            const float u = 0.03f + 0.11f * (float)(i % 4), v = 0.05f + 0.12f * (float)(i / 8);
            ppmi_material_point got, expected;
            ppmi_surface surface = surface_at(2 * turn, i / 4 % 2, u, v);
            ppmi_material_evaluate(test.scene, &surface, &got);
            surface = surface_at(2 * turn + 1, i / 4 % 2, u, v);
            ppmi_material_evaluate(test.scene, &surface, &expected);
            assert_near(vec3_length(vec3_sub(got.ns, expected.ns)), 0.0, 1e-4);
            assert_near(vec3_length(vec3_sub(got.layers.coat_normal, expected.layers.coat_normal)),
                        0.0, 1e-4);
            assert_near(vec3_length(vec3_sub(got.layers.tangent, expected.layers.tangent)), 0.0,
                        1e-4);
        }
    }
}

static void alpha_follows_its_mode(void **state)
{
    (void)state;
    const float colors[16] = {1, 1, 1, 0.9f, 1, 1, 1, 0.9f, 1, 1, 1, 0.9f, 1, 1, 1, 0.9f};
    ppm_material_desc desc = defaults();
    desc.base_color[3] = 0.8f;
    desc.base_color_texture.image = one_texel(1.0f, 1.0f, 1.0f, 0.5f); /* 0.36 in all */
    const struct {
        int32_t mode;
        float cutoff, opacity;
    } cases[] = {{PPM_ALPHA_OPAQUE, 0.5f, 1.0f},
                 {PPM_ALPHA_BLEND, 0.5f, 0.36f},
                 {PPM_ALPHA_MASK, 0.5f, 0.0f},
                 {PPM_ALPHA_MASK, 0.35f, 1.0f}};
    for (uint32_t i = 0; i < 4; i++) {
        desc.alpha_mode = cases[i].mode;
        desc.alpha_cutoff = cases[i].cutoff;
        place_quad(&desc, colors, NULL);
        const ppmi_surface surface = surface_at(i, 0, 0.3f, 0.3f);
        assert_near(ppmi_surface_opacity(test.scene, &surface), cases[i].opacity, 1e-6);
    }
}

static void emission_has_one_side_or_two(void **state)
{
    (void)state;
    const ppmi_vec3 front = vec3(0.6f, 0.0f, 0.8f), back = vec3(0.6f, 0.0f, -0.8f);
    ppm_material_desc desc = defaults();
    desc.emission[0] = 3.0f;
    desc.emission_texture.image = one_texel(0.5f, 1.0f, 1.0f, 1.0f);
    for (uint32_t sides = 0; sides < 2; sides++) {
        desc.double_sided = sides;
        place_quad(&desc, NULL, NULL);
        const ppmi_surface surface = surface_at(sides, 0, 0.3f, 0.3f);
        assert_near(ppmi_surface_emission(test.scene, &surface, front).x, 1.5, 1e-6);
        assert_near(ppmi_surface_emission(test.scene, &surface, front).y, 0.0, 0.0);
        assert_near(ppmi_surface_emission(test.scene, &surface, back).x, sides ? 1.5 : 0.0, 1e-6);
    }
}

static void a_mirrored_instance_emits_from_its_outside(void **state)
{
    (void)state;
    ppm_material_desc desc = defaults();
    desc.emission[0] = 1.0f;
    desc.double_sided = 0;
    const float mirrored[16] = {1, 0, 0, 0, 0, -1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1};
    place_quad(&desc, NULL, mirrored);
    const ppmi_surface surface = surface_at(0, 0, 0.3f, 0.3f);
    assert_near(surface.ng.z, 1.0, 1e-6);
    assert_near(ppmi_surface_emission(test.scene, &surface, vec3(0, 0, 1)).x, 1.0, 0.0);
    assert_near(ppmi_surface_emission(test.scene, &surface, vec3(0, 0, -1)).x, 0.0, 0.0);
}

/* KHR_materials_clearcoat: by 1 - clearcoat * Schlick's Fresnel term, index 1.5, on both sides. */
static void a_clearcoat_dims_the_emission_below_it(void **state)
{
    (void)state;
    static const double cosines[] = {1.0, 0.6, 0.1};
    ppm_material_desc desc = defaults();
    desc.emission[0] = 3.0f;
    desc.clearcoat = 0.8f;
    desc.clearcoat_roughness = 0.5f;
    desc.clearcoat_texture.image = one_texel(0.5f, 1.0f, 1.0f, 1.0f);
    desc.double_sided = 1;
    place_quad(&desc, NULL, NULL);
    const ppmi_surface surface = surface_at(0, 0, 0.3f, 0.3f);
    for (int i = 0; i < 3; i++) {
        const double c = cosines[i], fresnel = 0.04 + 0.96 * pow(1.0 - c, 5.0);
        const double expected = 3.0 * (1.0 - 0.8 * 0.5 * fresnel);
        const ppmi_vec3 front = vec3((float)sqrt(1.0 - c * c), 0.0f, (float)c);
        assert_near(ppmi_surface_emission(test.scene, &surface, front).x, expected, 1e-5);
        assert_near(ppmi_surface_emission(test.scene, &surface, vec3_neg(front)).x, expected, 1e-5);
    }
}

/* And the index is the coat's; KHR_materials_coat has the emission above it. */
static void emission_may_lie_above_the_coat(void **state)
{
    (void)state;
    ppm_material_desc desc = defaults();
    desc.emission[0] = 3.0f;
    desc.clearcoat = 1.0f;
    desc.coat_ior = 2.0f;
    place_quad(&desc, NULL, NULL);
    ppmi_surface surface = surface_at(0, 0, 0.3f, 0.3f);
    const ppmi_vec3 up = vec3(0, 0, 1);
    assert_near(ppmi_surface_emission(test.scene, &surface, up).x, 3.0 * (1.0 - 1.0 / 9.0), 1e-5);
    ppmi_material above = *surface.material;
    above.desc.emission_is_above_coat = 1;
    surface.material = &above;
    assert_near(ppmi_surface_emission(test.scene, &surface, up).x, 3.0, 1e-6);
}

static void attenuation_follows_beer_and_lambert(void **state)
{
    (void)state;
    ppm_material_desc desc = defaults();
    desc.transmission = 1.0f;
    desc.attenuation_color[0] = 0.5f;
    desc.attenuation_color[1] = 0.0f;
    desc.attenuation_distance_m = 2.0f;
    ppm_material_id id = material_add(test.scene, &desc);
    const ppmi_material *material = &test.scene->materials[id - 1];
    const ppmi_vec3 at_6 = ppmi_medium_transmittance(&material->inside, 6.0f);
    assert_near(at_6.x, 0.125, 1e-6);
    assert_near(at_6.y, 0.0, 0.0);
    assert_near(at_6.z, 1.0, 0.0);
    assert_near(ppmi_medium_transmittance(&material->inside, 0.0f).x, 1.0, 0.0);
    desc.attenuation_distance_m = 0.0f; /* none */
    id = material_add(test.scene, &desc);
    material = &test.scene->materials[id - 1];
    assert_near(ppmi_medium_transmittance(&material->inside, 6.0f).x, 1.0, 0.0);
}

int main(void)
{
#define WITH_SCENE(f) cmocka_unit_test_setup_teardown(f, open_scene, close_scene)
    const struct CMUnitTest tests[] = {
        WITH_SCENE(textures_multiply_the_factors),
        WITH_SCENE(vertex_colours_tint_emission_where_the_material_says_so),
        WITH_SCENE(glossiness_stands_in_alpha_and_is_one_less_roughness),
        WITH_SCENE(a_normal_map_tilts_the_normal),
        WITH_SCENE(a_flat_normal_map_changes_nothing),
        WITH_SCENE(turned_pictures_of_directions_are_like_turned_coordinates),
        WITH_SCENE(alpha_follows_its_mode),
        WITH_SCENE(emission_has_one_side_or_two),
        WITH_SCENE(a_mirrored_instance_emits_from_its_outside),
        WITH_SCENE(a_clearcoat_dims_the_emission_below_it),
        WITH_SCENE(emission_may_lie_above_the_coat),
        WITH_SCENE(attenuation_follows_beer_and_lambert),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
