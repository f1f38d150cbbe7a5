/* The digest of a scene changes with all that is seen, and with nothing else. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <string.h>

#include <cmocka.h>

#include "scene/digest.h"
#include "support/scenes.h"

/* What is different in a scene. */
typedef enum change {
    NOTHING,
    A_CORNER,
    A_COLOUR,
    A_LAST_VALUE, /* of the material's description */
    A_PLACE,
    A_LAMP,
    A_SKY,
    A_FOG,
    A_PIXEL,
    ANOTHER_CAMERA,
    CHANGES
} change;

static void build(ppm_scene *scene, change what)
{
    const float pixels[6] = {1, 1, 1, 1, what == A_PIXEL ? 0.5f : 1, 1};
    ppm_material_desc desc;
    ppm_material_desc_init(&desc);
    desc.name = "Grey";
    desc.base_color[1] = what == A_COLOUR ? 0.5f : 0.25f;
    desc.base_color_texture.image = image_rgb(scene, 2, 1, pixels);
    desc.emission_takes_vertex_color = what == A_LAST_VALUE;
    const ppm_material_id grey = material_add(scene, &desc);
    const ppm_mesh_id quad = shape_quad(scene, grey, vec3(what == A_CORNER ? 0.5f : 0, 0, 0),
                                        vec3(1, 0, 0), vec3(0, 1, 0));
    shape_place_at(scene, quad, vec3(0, what == A_PLACE ? 1e-3f : 0, 0));
    camera_perspective(scene, vec3(0, 0, what == ANOTHER_CAMERA ? 4 : 3), vec3(0, 0, 0), 0.8f);
    light_point(scene, vec3(1, 1, 1), vec3(what == A_LAMP ? 2 : 1, 1, 1));
    light_environment(scene, vec3(what == A_SKY ? 0.2f : 0.1f, 0, 0), 0, 0);
    scene_fog(scene, vec3(0.1f, 0.1f, 0.1f), vec3(0, 0, 0), what == A_FOG ? 0.5f : 0.0f);
}

static void digests_of(change what, char scene_text[PPMI_DIGEST_TEXT_SIZE],
                       char camera_text[PPMI_DIGEST_TEXT_SIZE])
{
    test_scene test;
    ppmi_digest scene = {0}, camera = {0};
    scene_open(&test);
    build(test.scene, what);
    ppmi_scene_freeze(test.scene);
    ppmi_scene_digest(test.scene, &scene);
    ppmi_camera_digest(&test.scene->cameras[0], &camera);
    ppmi_scene_thaw(test.scene);
    ppmi_digest_write(&scene, scene_text);
    ppmi_digest_write(&camera, camera_text);
    scene_close(&test);
}

static void equal_scenes_have_equal_digests(void **state)
{
    (void)state;
    char scene[2][PPMI_DIGEST_TEXT_SIZE], camera[2][PPMI_DIGEST_TEXT_SIZE];
    for (int i = 0; i < 2; i++)
        digests_of(NOTHING, scene[i], camera[i]);
    assert_string_equal(scene[0], scene[1]);
    assert_string_equal(camera[0], camera[1]);
}

static void each_change_changes_the_digest(void **state)
{
    (void)state;
    char scene[CHANGES][PPMI_DIGEST_TEXT_SIZE], camera[CHANGES][PPMI_DIGEST_TEXT_SIZE];
    for (int i = 0; i < CHANGES; i++)
        digests_of((change)i, scene[i], camera[i]);
    for (int i = A_CORNER; i < ANOTHER_CAMERA; i++) {
        if (strcmp(scene[i], scene[NOTHING]) == 0) fail_msg("change %d is not seen", i);
        assert_string_equal(camera[i], camera[NOTHING]);
    }
}

static void a_camera_has_its_own(void **state)
{
    (void)state;
    char scene[2][PPMI_DIGEST_TEXT_SIZE], camera[2][PPMI_DIGEST_TEXT_SIZE];
    digests_of(NOTHING, scene[0], camera[0]);
    digests_of(ANOTHER_CAMERA, scene[1], camera[1]);
    assert_string_equal(scene[0], scene[1]);
    assert_string_not_equal(camera[0], camera[1]);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(equal_scenes_have_equal_digests),
        cmocka_unit_test(each_change_changes_the_digest),
        cmocka_unit_test(a_camera_has_its_own),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
