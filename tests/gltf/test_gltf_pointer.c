/* importers/gltf/gltf_property.c: KHR_animation_pointer, property by property. */
#include <math.h>
#include <stdio.h>
#include <string.h>

#include "gltf_motion.h"

#define CLOSE(a, b) assert_float_equal((double)(a), (double)(b), 1e-5)

/* A scene with one of everything: node 0 with a textured mesh, node 1 with a camera, node 2 with a
 * spot light, node 3 hidden with the same mesh. */
static const char one_of_everything[] =
    "'extensionsUsed':['KHR_animation_pointer','KHR_lights_punctual','KHR_node_visibility'],"
    "'extensions':{'KHR_lights_punctual':{'lights':[{'type':'spot','color':[1,1,1],"
    "'intensity':2,'spot':{'innerConeAngle':0.1,'outerConeAngle':0.5}}]},"
    "'EXT_lights_area':{'lights':[{'type':'rect','intensity':2,'size':1}]},"
    "'EXT_lights_ies':{'lights':[{'uri':'data:;base64,"
    "SUVTTkE6TE0tNjMtMjAwMgpUSUxUPU5PTkUKMSAxMDAwIDEgMiAxIDEgMiAwIDAgMAoxIDEgMTAwCjAg"
    "OTAKMAoxMDAgMTAwCg=="
    "'}]}},"
    "'cameras':[{'type':'perspective','perspective':{'yfov':0.5,'znear':0.1}},"
    "{'type':'orthographic','orthographic':{'xmag':2,'ymag':3,'znear':0.1,'zfar':9}}],"
    "'images':[{'uri':'data:image/png;base64,"
    "iVBORw0KGgoAAAANSUhEUgAAAAEAAAABCAIAAACQd1PeAAAADElEQVR4nGP4"
    "//8/AAX+Av4N70a4AAAAAElFTkSuQmCC'}],'textures':[{'source':0}],"
    "'materials':[{'pbrMetallicRoughness':{'baseColorFactor':[0.5,0.5,0.5,1],"
    "'baseColorTexture':{'index':0}},'extensions':{'KHR_materials_ior':{'ior':1.4},"
    "'KHR_materials_transmission':{'transmissionFactor':0.5},"
    "'KHR_materials_clearcoat':{'clearcoatFactor':1,'clearcoatTexture':{'index':0}},"
    "'KHR_materials_sheen':{'sheenColorFactor':[0,0,0]},"
    "'KHR_materials_anisotropy':{'anisotropyStrength':0.5},"
    "'KHR_materials_iridescence':{'iridescenceFactor':1},"
    "'KHR_materials_diffuse_transmission':{'diffuseTransmissionFactor':0.1}}}],"
    "'nodes':[{'children':[1,2,3,4,5,6],'mesh':0},{'camera':0},"
    "{'extensions':{'KHR_lights_punctual':{'light':0}}},"
    "{'mesh':0,'extensions':{'KHR_node_visibility':{'visible':false}}},{'camera':1},"
    "{'extensions':{'EXT_lights_area':{'light':0}}},"
    "{'extensions':{'EXT_lights_ies':{'light':0}}}],";

/* Animates one pointer from its first to its second value within a second. */
static ppm_status open_pointer(gltf_fixture *f, const char *pointer, const char *type,
                               const float *values, size_t width, ppmi_gltf_asset **asset)
{
    static const float times[2] = {0, 1};
    const gltf_keys keys = {"LINEAR", type, times, 2, values, 2, width};
    char middle[4096];
    snprintf(middle, sizeof middle,
             "%s'animations':[{'channels':[{'sampler':0,'target':{'path':'pointer',"
             "'extensions':{'KHR_animation_pointer':{'pointer':'%s'}}}}],"
             "'samplers':[{'input':1,'output':2}]}]",
             one_of_everything, pointer);
    return gltf_open_keys(f, &keys, middle, asset);
}

static const ppm_material_desc *material(const gltf_fixture *f)
{
    assert_int_equal(f->scene->material_count, 1);
    return &f->scene->materials[0].desc;
}

/* ---- what a pointer reaches ------------------------------------------------------------------ */

typedef float (*look_fn)(const gltf_fixture *f);

static float base_color(const gltf_fixture *f)
{
    return material(f)->base_color[1];
}
static float roughness(const gltf_fixture *f)
{
    return material(f)->roughness;
}
static float emission(const gltf_fixture *f)
{
    return material(f)->emission[2];
}
static float refraction(const gltf_fixture *f)
{
    return material(f)->ior;
}
static float transmission(const gltf_fixture *f)
{
    return material(f)->transmission;
}
static float u_offset(const gltf_fixture *f)
{
    assert_int_not_equal(material(f)->base_color_texture.has_transform, 0);
    return material(f)->base_color_texture.uv_transform[2];
}
static float u_from_v(const gltf_fixture *f)
{
    return material(f)->base_color_texture.uv_transform[1];
}
static float clearcoat(const gltf_fixture *f)
{
    return material(f)->clearcoat;
}
static float clearcoat_u(const gltf_fixture *f)
{
    return material(f)->clearcoat_texture.uv_transform[2];
}
static float sheen(const gltf_fixture *f)
{
    return material(f)->sheen_color[0];
}
static float anisotropy_rotation(const gltf_fixture *f)
{
    return material(f)->anisotropy_rotation_rad;
}
static float film_thickness(const gltf_fixture *f)
{
    return material(f)->iridescence_thickness_max_nm;
}
static float diffuse_transmission(const gltf_fixture *f)
{
    return material(f)->diffuse_transmission;
}
static float light_intensity(const gltf_fixture *f)
{
    return f->scene->punctuals[0].intensity.x;
}
static float light_cone(const gltf_fixture *f)
{
    return acosf(f->scene->punctuals[0].cos_outer);
}
static float area_intensity(const gltf_fixture *f)
{
    return f->scene->punctuals[1].intensity.y;
}
static float area_width(const gltf_fixture *f)
{
    return 2.0f * f->scene->punctuals[1].half_width_m;
}
static float area_height(const gltf_fixture *f)
{
    return 2.0f * f->scene->punctuals[1].half_height_m;
}
static float profile_intensity(const gltf_fixture *f)
{
    return f->scene->punctuals[2].intensity.y;
}
static float camera_angle(const gltf_fixture *f)
{
    return f->scene->cameras[0].y_fov_rad;
}
static float camera_height(const gltf_fixture *f)
{
    return f->scene->cameras[1].half_height_m;
}
static float node_y(const gltf_fixture *f)
{
    return f->scene->instances[0].to_world.origin.y;
}
static float camera_y(const gltf_fixture *f)
{
    return f->scene->cameras[0].origin.y;
}

static const struct {
    const char *pointer, *type;
    size_t width;
    float from[4], to[4];
    look_fn look;
    float begin, middle;
} cases[] = {
    {"/materials/0/pbrMetallicRoughness/baseColorFactor",
     "VEC4",
     4,
     {0, 0, 0, 1},
     {1, 0.5f, 1, 1},
     base_color,
     0,
     0.25f},
    {"/materials/0/pbrMetallicRoughness/roughnessFactor",
     "SCALAR",
     1,
     {0.2f},
     {0.6f},
     roughness,
     0.2f,
     0.4f},
    {"/materials/0/emissiveFactor", "VEC3", 3, {0, 0, 0}, {0, 0, 1}, emission, 0, 0.5f},
    {"/materials/0/extensions/KHR_materials_ior/ior", "SCALAR", 1, {1}, {2}, refraction, 1, 1.5f},
    {"/materials/0/extensions/KHR_materials_transmission/transmissionFactor",
     "SCALAR",
     1,
     {0.2f},
     {1},
     transmission,
     0.2f,
     0.6f},
    {"/materials/0/pbrMetallicRoughness/baseColorTexture/extensions/KHR_texture_transform/offset",
     "VEC2",
     2,
     {0, 0},
     {4, 0},
     u_offset,
     0,
     2},
    {"/materials/0/pbrMetallicRoughness/baseColorTexture/extensions/KHR_texture_transform/rotation",
     "SCALAR",
     1,
     {0},
     {3.14159265f},
     u_from_v,
     0,
     1},
    {"/materials/0/extensions/KHR_materials_clearcoat/clearcoatFactor",
     "SCALAR",
     1,
     {0},
     {1},
     clearcoat,
     0,
     0.5f},
    {"/materials/0/extensions/KHR_materials_clearcoat/clearcoatTexture/extensions/"
     "KHR_texture_transform/offset",
     "VEC2",
     2,
     {0, 0},
     {4, 0},
     clearcoat_u,
     0,
     2},
    {"/materials/0/extensions/KHR_materials_sheen/sheenColorFactor",
     "VEC3",
     3,
     {0, 0, 0},
     {1, 0, 0},
     sheen,
     0,
     0.5f},
    {"/materials/0/extensions/KHR_materials_anisotropy/anisotropyRotation",
     "SCALAR",
     1,
     {0},
     {1},
     anisotropy_rotation,
     0,
     0.5f},
    {"/materials/0/extensions/KHR_materials_iridescence/iridescenceThicknessMaximum",
     "SCALAR",
     1,
     {200},
     {400},
     film_thickness,
     200,
     300},
    {"/materials/0/extensions/KHR_materials_diffuse_transmission/diffuseTransmissionFactor",
     "SCALAR",
     1,
     {0},
     {1},
     diffuse_transmission,
     0,
     0.5f},
    {"/extensions/KHR_lights_punctual/lights/0/intensity",
     "SCALAR",
     1,
     {0},
     {10},
     light_intensity,
     0,
     5},
    {"/extensions/KHR_lights_punctual/lights/0/spot/outerConeAngle",
     "SCALAR",
     1,
     {0.2f},
     {0.6f},
     light_cone,
     0.2f,
     0.4f},
    {"/extensions/EXT_lights_area/lights/0/intensity",
     "SCALAR",
     1,
     {0},
     {10},
     area_intensity,
     0,
     5},
    {"/extensions/EXT_lights_area/lights/0/color",
     "VEC3",
     3,
     {0, 0, 0},
     {1, 1, 1},
     area_intensity,
     0,
     1},
    {"/extensions/EXT_lights_area/lights/0/size", "SCALAR", 1, {1}, {3}, area_height, 1, 2},
    {"/extensions/EXT_lights_area/lights/0/rect/aspect", "SCALAR", 1, {1}, {3}, area_width, 1, 2},
    {"/nodes/6/extensions/EXT_lights_ies/multiplier",
     "SCALAR",
     1,
     {0},
     {4},
     profile_intensity,
     0,
     2},
    {"/nodes/6/extensions/EXT_lights_ies/color",
     "VEC3",
     3,
     {1, 0, 1},
     {1, 0.5f, 1},
     profile_intensity,
     0,
     0.25f},
    {"/cameras/0/perspective/yfov", "SCALAR", 1, {0.5f}, {1.5f}, camera_angle, 0.5f, 1},
    {"/cameras/1/orthographic/ymag", "SCALAR", 1, {1}, {3}, camera_height, 1, 2},
    {"/nodes/0/translation", "VEC3", 3, {0, 0, 0}, {0, 8, 0}, node_y, 0, 4},
    {"/nodes/0/translation", "VEC3", 3, {0, 0, 0}, {0, 8, 0}, camera_y, 0, 4},
};

static void every_property_follows_its_pointer(void **state)
{
    gltf_fixture *f = *state;
    for (size_t i = 0; i < sizeof cases / sizeof cases[0]; ++i) {
        ppmi_gltf_asset *asset;
        float values[8];
        memcpy(values, cases[i].from, cases[i].width * sizeof(float));
        memcpy(values + cases[i].width, cases[i].to, cases[i].width * sizeof(float));
        gltf_reset(f);
        assert_gltf_status(
            f, open_pointer(f, cases[i].pointer, cases[i].type, values, cases[i].width, &asset),
            PPM_STATUS_OK);
        const uint64_t rest = gltf_scene_hash(f->scene);
        ppm_pose when = gltf_at(0.0);
        assert_int_equal(ppmi_gltf_asset_set_pose(asset, &when), PPM_STATUS_OK);
        CLOSE(cases[i].look(f), cases[i].begin);
        when = gltf_at(0.5);
        assert_int_equal(ppmi_gltf_asset_set_pose(asset, &when), PPM_STATUS_OK);
        CLOSE(cases[i].look(f), cases[i].middle);
        const ppm_pose still = {0};
        assert_int_equal(ppmi_gltf_asset_set_pose(asset, &still), PPM_STATUS_OK);
        assert_true(gltf_scene_hash(f->scene) == rest);
        assert_false(gltf_logged(f, 'W', "left out"));
        ppmi_gltf_asset_close(asset);
    }
}

/* What is one value for a whole picture is that of the middle of the shutter. */
static void values_are_those_of_the_middle_of_the_shutter(void **state)
{
    gltf_fixture *f = *state;
    static const float values[2] = {0, 1};
    ppmi_gltf_asset *asset;
    f->options.pose = gltf_between(0.2, 0.6);
    assert_gltf_status(f,
                       open_pointer(f, "/materials/0/pbrMetallicRoughness/roughnessFactor",
                                    "SCALAR", values, 1, &asset),
                       PPM_STATUS_OK);
    CLOSE(roughness(f), 0.4f);
    ppmi_gltf_asset_close(asset);
}

static void visibility_switches_meshes_and_lights(void **state)
{
    gltf_fixture *f = *state;
    static const struct {
        float position[9], times[2];
        uint8_t visible[4];
    } data = {{0, 0, 0, 1, 0, 0, 0, 1, 0}, {0, 1}, {0, 1, 0, 0}};
    ppmi_gltf_asset *asset;
    char text[4096];
    snprintf(text, sizeof text,
             "{" GLTF_HEAD "'extensionsUsed':['KHR_lights_punctual'],"
             "'extensions':{'KHR_lights_punctual':{'lights':[{'type':'point','intensity':3}]}},"
             "'nodes':[{'children':[1],'extensions':{'KHR_node_visibility':{}}},"
             "{'mesh':0,'extensions':{'KHR_lights_punctual':{'light':0}}}],"
             "'animations':[{'channels':[{'sampler':0,'target':{'path':'pointer','extensions':{"
             "'KHR_animation_pointer':{'pointer':"
             "'/nodes/0/extensions/KHR_node_visibility/visible'}}}}],"
             "'samplers':[{'input':1,'output':2,'interpolation':'STEP'}]}],"
             "'meshes':[{'primitives':[{'attributes':{'POSITION':0}}]}],"
             "'accessors':[{'bufferView':0,'componentType':5126,'count':3,'type':'VEC3'},"
             "{'bufferView':0,'byteOffset':36,'componentType':5126,'count':2,'type':'SCALAR'},"
             "{'bufferView':0,'byteOffset':44,'componentType':5121,'count':2,'type':'SCALAR'}],"
             "'bufferViews':[{'buffer':0,'byteLength':48}],"
             "'buffers':[{'byteLength':48,'uri':'%s'}]}",
             gltf_data_uri(&data, sizeof data));
    f->options.pose = gltf_at(0.5);
    assert_gltf_status(f, gltf_open_text(f, text, &asset), PPM_STATUS_OK);
    assert_true(f->scene->instances[0].is_hidden);
    CLOSE(f->scene->punctuals[0].intensity.x, 0.0);
    ppm_pose when = gltf_at(1.0);
    assert_int_equal(ppmi_gltf_asset_set_pose(asset, &when), PPM_STATUS_OK);
    assert_false(f->scene->instances[0].is_hidden);
    CLOSE(f->scene->punctuals[0].intensity.x, 3.0);
    ppmi_gltf_asset_close(asset);
}

/* A negative intensity, for one: it is not what the pose before has left. */
static void a_light_that_cannot_be_is_dark(void **state)
{
    gltf_fixture *f = *state;
    static const float values[2] = {4, -4};
    ppmi_gltf_asset *asset;
    f->options.pose = gltf_at(0.0);
    assert_gltf_status(f,
                       open_pointer(f, "/extensions/KHR_lights_punctual/lights/0/intensity",
                                    "SCALAR", values, 1, &asset),
                       PPM_STATUS_OK);
    CLOSE(light_intensity(f), 4.0);
    ppm_pose when = gltf_at(1.0);
    assert_int_equal(ppmi_gltf_asset_set_pose(asset, &when), PPM_STATUS_OK);
    CLOSE(light_intensity(f), 0.0);
    when = gltf_at(0.25);
    assert_int_equal(ppmi_gltf_asset_set_pose(asset, &when), PPM_STATUS_OK);
    CLOSE(light_intensity(f), 2.0);
    ppmi_gltf_asset_close(asset);
}

static void pointers_to_what_is_not_shown_are_named(void **state)
{
    gltf_fixture *f = *state;
    static const float values[2] = {0, 1};
    static const char *const pointers[] = {"/materials/0/occlusionTexture/strength",
                                           "/meshes/0/name", "/extras/mine"};
    for (size_t i = 0; i < sizeof pointers / sizeof pointers[0]; ++i) {
        ppmi_gltf_asset *asset;
        gltf_reset(f);
        f->options.pose = (ppm_pose){0};
        assert_gltf_status(f, open_pointer(f, pointers[i], "SCALAR", values, 1, &asset),
                           PPM_STATUS_OK);
        assert_false(gltf_logged(f, 'W', pointers[i]));
        const ppm_pose when = gltf_at(0.0); /* only when it is played */
        assert_int_equal(ppmi_gltf_asset_set_pose(asset, &when), PPM_STATUS_OK);
        assert_gltf_logged(f, 'W', pointers[i]);
        ppmi_gltf_asset_close(asset);
    }
}

static void pointers_that_lead_nowhere_are_refused(void **state)
{
    gltf_fixture *f = *state;
    static const float values[2] = {0, 1};
    static const char *const pointers[] = {"/materials/1/alphaCutoff", "materials/0/alphaCutoff",
                                           ""};
    for (size_t i = 0; i < sizeof pointers / sizeof pointers[0]; ++i) {
        ppmi_gltf_asset *asset;
        gltf_reset(f);
        f->options.pose = gltf_at(0.0);
        assert_gltf_status(f, open_pointer(f, pointers[i], "SCALAR", values, 1, &asset),
                           PPM_STATUS_INPUT_INVALID);
        assert_gltf_logged(f, 'E', "animations[0].channels[0]: the pointer leads nowhere");
    }
}

#define TEST(name) cmocka_unit_test_setup_teardown(name, gltf_setup, gltf_teardown)

int main(void)
{
    const struct CMUnitTest tests[] = {
        TEST(every_property_follows_its_pointer),
        TEST(values_are_those_of_the_middle_of_the_shutter),
        TEST(visibility_switches_meshes_and_lights),
        TEST(a_light_that_cannot_be_is_dark),
        TEST(pointers_to_what_is_not_shown_are_named),
        TEST(pointers_that_lead_nowhere_are_refused),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
