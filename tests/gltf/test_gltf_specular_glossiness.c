/* importers/gltf/gltf_specular_glossiness.c, and its part in src/shading/material.c */
#include <math.h>

#include "imageio/imageio.h"
#include "material_fixture.h"
#include "shading/material.h"

#define GLOSSY(members) "'extensions':{'KHR_materials_pbrSpecularGlossiness':{" members "}}"

static void its_values_become_those_of_a_dielectric(void **state)
{
    gltf_fixture *f = *state;
    const ppm_material_desc *m =
        import_material(f, "x",
                        GLOSSY("'diffuseFactor':[0.1,0.2,0.3,0.4],"
                               "'specularFactor':[0.5,0.6,0.7],'glossinessFactor':0.75"));
    assert_values(m->base_color, 4, (const float[]){0.1f, 0.2f, 0.3f, 0.4f});
    assert_values(&m->metallic, 1, (const float[]){0});
    assert_values(&m->ior, 1, (const float[]){0}); /* reflectance 1, times the specular colour */
    assert_values(&m->specular, 1, (const float[]){1});
    assert_values(m->specular_color, 3, (const float[]){0.5f, 0.6f, 0.7f});
    assert_values(&m->roughness, 1, (const float[]){0.75f});
    assert_int_not_equal(m->roughness_is_glossiness, 0);
}

static void its_defaults_are_white_and_smooth(void **state)
{
    const ppm_material_desc *m = import_material(*state, "x", GLOSSY(""));
    assert_values(m->base_color, 4, (const float[]){1, 1, 1, 1});
    assert_values(m->specular_color, 3, (const float[]){1, 1, 1});
    assert_values(&m->roughness, 1, (const float[]){1});
    assert_int_not_equal(m->roughness_is_glossiness, 0);
}

static void it_is_preferred_to_the_core_model(void **state)
{
    const ppm_material_desc *m = import_material(
        *state, "x",
        "'pbrMetallicRoughness':{'baseColorFactor':[1,0,0,1],'roughnessFactor':0.1},"
        "'emissiveFactor':[1,1,1],'alphaMode':'BLEND','normalTexture':{'index':0}," GLOSSY(
            "'diffuseFactor':[0,1,0,1],'glossinessFactor':0.25"));
    assert_values(m->base_color, 4, (const float[]){0, 1, 0, 1});
    assert_values(&m->roughness, 1, (const float[]){0.25f});
    /* what both models share stays */
    assert_values(m->emission, 3, (const float[]){1, 1, 1});
    assert_int_equal(m->alpha_mode, PPM_ALPHA_BLEND);
    assert_int_not_equal(m->normal_texture.image, 0);
}

static void bad_values_are_told_and_brought_into_range(void **state)
{
    gltf_fixture *f = *state;
    const ppm_material_desc *m =
        import_material(f, "x",
                        GLOSSY("'diffuseFactor':[2,0,0,1],'specularFactor':[-1,0,0],"
                               "'glossinessFactor':'x'"));
    assert_values(m->base_color, 1, (const float[]){1});
    assert_values(m->specular_color, 1, (const float[]){0});
    assert_values(&m->roughness, 1, (const float[]){1});
    assert_gltf_logged(f, 'W', "materials[0]: KHR_materials_pbrSpecularGlossiness.diffuseFactor");
    assert_gltf_logged(f, 'W', "materials[0]: KHR_materials_pbrSpecularGlossiness.specularFactor");
    assert_gltf_logged(f, 'W', "KHR_materials_pbrSpecularGlossiness.glossinessFactor: expected a");
}

/* ---- textures -------------------------------------------------------------------------------- */

static void write_png(gltf_fixture *f, const char *name, const unsigned char bytes[16])
{
    float pixels[16];
    for (int i = 0; i < 16; ++i) {
        pixels[i] = (float)bytes[i] / 255.0f;
    }
    const ppmi_image_file file = {
        .width = 2, .height = 2, .channels = 4, .pixels = pixels, .store = PPMI_STORE_U8};
    assert_int_equal(ppmi_imageio_write_file(f->context, gltf_path(f, name), &file), PPM_STATUS_OK);
}

static const char two_materials[] =
    "{'asset':{'version':'2.0'},'scenes':[{'nodes':[0,1]}],'nodes':[{'mesh':0},{'mesh':1}],"
    "'meshes':[{'primitives':[{'attributes':{'POSITION':0,'TEXCOORD_0':1},'material':0}]},"
    "{'primitives':[{'attributes':{'POSITION':0,'TEXCOORD_0':1},'material':1}]}],"
    "'materials':["
    "{'extensions':{'KHR_materials_pbrSpecularGlossiness':{'diffuseTexture':{'index':0},"
    "'specularFactor':[0.5,0.75,1],'glossinessFactor':0.75,"
    "'specularGlossinessTexture':{'index':1}}}},"
    "{'pbrMetallicRoughness':{'baseColorTexture':{'index':0},'metallicFactor':0,"
    "'metallicRoughnessTexture':{'index':2}},'extensions':{'KHR_materials_ior':{'ior':0},"
    "'KHR_materials_specular':{'specularColorFactor':[0.5,0.75,1],"
    "'specularColorTexture':{'index':1}}}}],"
    "'textures':[{'source':0},{'source':1},{'source':2}],'images':[{'uri':'diffuse.png'},"
    "{'uri':'glossy.png'},{'uri':'rough.png'}],"
    "'accessors':[{'bufferView':0,'componentType':5126,'count':3,'type':'VEC3'},"
    "{'bufferView':1,'componentType':5126,'count':3,'type':'VEC2'}],"
    "'bufferViews':[{'buffer':0,'byteLength':36},{'buffer':0,'byteOffset':36,'byteLength':24}],"
    "'buffers':[{'byteLength':60,'uri':'%s'}]}";

static void import_twins(gltf_fixture *f)
{
    static const unsigned char diffuse[16] = {10,  200, 40, 255, 90, 30,  250, 128,
                                              255, 0,   60, 64,  7,  120, 130, 200};
    /* 255 - 0.75 * alpha is a whole number, so that the twin's texture holds it exactly */
    static const unsigned char glossy[16] = {200, 100, 50, 0,   20, 220, 90,  100,
                                             255, 130, 10, 200, 60, 70,  180, 252};
    static const float vertices[15] = {0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 2, 0, 0, 2};
    unsigned char rough[16];
    for (int i = 0; i < 16; ++i) {
        rough[i] = (unsigned char)(255 - glossy[i / 4 * 4 + 3] / 4 * 3);
    }
    write_png(f, "sub/diffuse.png", diffuse);
    write_png(f, "sub/glossy.png", glossy);
    write_png(f, "sub/rough.png", rough);
    assert_gltf_status(f, gltf_importf(f, two_materials, gltf_data_uri(vertices, sizeof vertices)),
                       PPM_STATUS_OK);
}

static ppmi_material_point evaluate(gltf_fixture *f, uint32_t instance, float u, float v)
{
    const ppmi_hit hit = {.instance = instance, .u = u, .v = v};
    ppmi_surface surface;
    ppmi_material_point point;
    ppmi_surface_from_hit(f->scene, &hit, &surface);
    ppmi_material_evaluate(f->scene, &surface, &point);
    return point;
}

/* By hand: what Khronos writes in KHR_materials_specular about converting one into the other. */
static void it_equals_its_twin_in_the_core_model_at_every_point(void **state)
{
    gltf_fixture *f = *state;
    float least = 1.0f, most = 0.0f;
    import_twins(f);
    for (int i = 0; i < 100; ++i) {
        const float u = (float)(i % 10) / 20.0f, v = (float)i / 210.0f;
        const ppmi_material_point a = evaluate(f, 0, u, v), b = evaluate(f, 1, u, v);
        assert_true(fabsf(a.roughness - b.roughness) < 2e-6f);
        assert_values(&a.base_color.x, 3, &b.base_color.x);
        assert_values(&a.specular_color.x, 3, &b.specular_color.x);
        assert_true(a.metallic == 0.0f && b.metallic == 0.0f);
        assert_true(a.ior == b.ior && a.specular == b.specular);
        least = fminf(least, a.roughness);
        most = fmaxf(most, a.roughness);
    }
    assert_true(least < 0.5f && most > 0.7f); /* the texture is seen at all */
}

/* Colour and glossiness stand in one image, which is not copied. */
static void its_texture_is_kept_once(void **state)
{
    gltf_fixture *f = *state;
    import_twins(f);
    const ppm_material_desc *m = &f->scene->materials[0].desc;
    assert_int_equal(m->specular_color_texture.image, m->metallic_roughness_texture.image);
    assert_int_equal(f->scene->image_count, 3);
}

#define TEST(name) cmocka_unit_test_setup_teardown(name, gltf_setup, gltf_teardown)

int main(void)
{
    const struct CMUnitTest tests[] = {
        TEST(bad_values_are_told_and_brought_into_range),
        TEST(its_values_become_those_of_a_dielectric),
        TEST(its_defaults_are_white_and_smooth),
        TEST(it_is_preferred_to_the_core_model),
        TEST(it_equals_its_twin_in_the_core_model_at_every_point),
        TEST(its_texture_is_kept_once),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
