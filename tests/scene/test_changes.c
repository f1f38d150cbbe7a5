/* Changes between frames: what they refuse, and that they leave what a new scene would have. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

#include "ppm/render.h"
#include "support/near.h"
#include "support/renders.h"
#include "support/scenes.h"

static test_scene test, other;

static int open_scenes(void **state)
{
    (void)state;
    scene_open(&test);
    scene_open(&other);
    return 0;
}

static int close_scenes(void **state)
{
    (void)state;
    scene_close(&other);
    scene_close(&test);
    return 0;
}

static ppm_instance_desc moved_to(ppmi_vec3 p)
{
    return (ppm_instance_desc){.size = sizeof(ppm_instance_desc),
                               .transform = {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, p.x, p.y, p.z, 1}};
}

static ppm_camera_desc camera_at(ppmi_vec3 p, float y_fov_rad)
{
    return (ppm_camera_desc){.size = sizeof(ppm_camera_desc),
                             .transform = {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, p.x, p.y, p.z, 1},
                             .y_fov_rad = y_fov_rad};
}

static ppm_light_desc lamp_at(ppmi_vec3 p, float intensity)
{
    return (ppm_light_desc){.size = sizeof(ppm_light_desc),
                            .kind = PPM_LIGHT_POINT,
                            .transform = {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, p.x, p.y, p.z, 1},
                            .intensity = {intensity, intensity, intensity}};
}

static ppm_material_desc grey(float reflectance)
{
    ppm_material_desc desc;
    ppm_material_desc_init(&desc);
    desc.roughness = 1.0f;
    for (int i = 0; i < 3; i++)
        desc.base_color[i] = reflectance;
    return desc;
}

/* A bent sheet of 3 vertices a row; bend lifts its middle. */
enum { SHEET_VERTICES = 6 };
static void sheet(float bend, float positions[3 * SHEET_VERTICES])
{
    for (int i = 0; i < SHEET_VERTICES; i++) {
        const int column = i % 3, row = i / 3;
        positions[3 * i] = (float)column - 1.0f;
        positions[3 * i + 1] = column == 1 ? bend : 0.0f;
        positions[3 * i + 2] = (float)row;
    }
}

static const uint32_t sheet_indices[12] = {0, 3, 1, 1, 3, 4, 1, 4, 2, 2, 4, 5};

static ppm_primitive_desc sheet_desc(const float *positions, ppm_material_id material)
{
    return (ppm_primitive_desc){.vertex_count = SHEET_VERTICES,
                                .triangle_count = 4,
                                .positions = positions,
                                .indices = sheet_indices,
                                .material = material};
}

/* What a film of two frames shows: a sheet that bends, a box that moves, far from the origin. */
typedef struct film_state {
    ppmi_vec3 box;
    float bend, lamp, reflectance, fov;
} film_state;

static const ppmi_vec3 place = {4096.0f, 0.0f, -8192.0f};
static const film_state first_frame = {{0.3f, 0.7f, 0.1f}, 0.0f, 900.0f, 0.4f, 0.6f};
static const film_state second_frame = {{-0.9f, 0.4f, 0.6f}, 0.5f, 500.0f, 0.7f, 0.5f};

static void build(ppm_scene *scene, const film_state *film)
{
    float positions[3 * SHEET_VERTICES];
    sheet(film->bend, positions);
    const ppm_material_desc desc = grey(film->reflectance);
    const ppm_material_id material = material_add(scene, &desc);
    const ppm_primitive_desc primitive = sheet_desc(positions, material);
    shape_place_at(scene, shape_mesh(scene, &primitive), place);
    shape_place_at(scene, shape_box(scene, material, vec3_splat(-0.2f), vec3_splat(0.2f), 1, false),
                   vec3_add(place, film->box));
    const ppm_light_desc lamp = lamp_at(vec3_add(place, vec3(0, 3, 0)), film->lamp);
    const ppm_camera_desc camera = camera_at(vec3_add(place, vec3(0, 1, 5)), film->fov);
    uint32_t id;
    assert_int_equal(ppm_scene_add_light(scene, &lamp, &id), PPM_STATUS_OK);
    assert_int_equal(ppm_scene_add_camera(scene, &camera, &id), PPM_STATUS_OK);
}

static void update(ppm_scene *scene, const film_state *film)
{
    float positions[3 * SHEET_VERTICES];
    sheet(film->bend, positions);
    const ppm_material_desc material = grey(film->reflectance);
    const ppm_primitive_desc vertices = sheet_desc(positions, 0);
    const ppm_instance_desc box = moved_to(vec3_add(place, film->box));
    const ppm_light_desc lamp = lamp_at(vec3_add(place, vec3(0, 3, 0)), film->lamp);
    const ppm_camera_desc camera = camera_at(vec3_add(place, vec3(0, 1, 5)), film->fov);
    assert_int_equal(ppm_scene_set_material(scene, 1, &material), PPM_STATUS_OK);
    assert_int_equal(ppm_scene_set_mesh_vertices(scene, 1, 0, &vertices), PPM_STATUS_OK);
    assert_int_equal(ppm_scene_set_instance(scene, 2, &box), PPM_STATUS_OK);
    assert_int_equal(ppm_scene_set_light(scene, 1, &lamp), PPM_STATUS_OK);
    assert_int_equal(ppm_scene_set_camera(scene, 1, &camera), PPM_STATUS_OK);
}

static void assert_same_picture(ppm_scene *a, ppm_scene *b)
{
    const ppm_render_options options = render_options(PPM_INTEGRATOR_PATH, 24, 0);
    float *picture = render_picture(a, &options, 2), *expected = render_picture(b, &options, 2);
    const size_t size = 4 * 24 * 24 * sizeof *picture;
    const int differs = memcmp(picture, expected, size);
    float sum = 0.0f;
    for (int i = 0; i < 24 * 24; i++)
        sum += expected[4 * i];
    free(picture);
    free(expected);
    assert_int_equal(differs, 0);
    assert_true(sum > 0.0f);
}

static void changes_that_adding_would_refuse_are_refused(void **state)
{
    (void)state;
    build(test.scene, &first_frame);
    build(other.scene, &first_frame);
    const ppm_instance_desc nowhere = moved_to(vec3(NAN, 0, 0));
    ppm_instance_desc without_steps = moved_to(vec3_splat(0.0f));
    without_steps.motion_steps = 2;
    ppm_material_desc material = grey(2.0f);
    const ppm_light_desc dark = lamp_at(vec3_splat(0.0f), -1.0f);
    const ppm_camera_desc flat = camera_at(vec3_splat(0.0f), 0.0f);
    float positions[3 * SHEET_VERTICES];
    sheet(0.0f, positions);
    ppm_primitive_desc vertices = sheet_desc(positions, 0);
    const ppm_status bad = PPM_STATUS_INVALID_ARGUMENT;
    assert_int_equal(ppm_scene_set_instance(test.scene, 1, &nowhere), bad);
    assert_int_equal(ppm_scene_set_instance(test.scene, 1, &without_steps), bad);
    assert_int_equal(ppm_scene_set_instance(test.scene, 1, NULL), bad);
    assert_int_equal(ppm_scene_set_material(test.scene, 1, &material), bad);
    assert_int_equal(ppm_scene_set_light(test.scene, 1, &dark), bad);
    assert_int_equal(ppm_scene_set_camera(test.scene, 1, &flat), bad);
    vertices.vertex_count = SHEET_VERTICES - 1;
    assert_int_equal(ppm_scene_set_mesh_vertices(test.scene, 1, 0, &vertices), bad);
    vertices = sheet_desc(NULL, 0);
    assert_int_equal(ppm_scene_set_mesh_vertices(test.scene, 1, 0, &vertices), bad);
    vertices = sheet_desc(positions, 0);
    vertices.motion_steps = PPM_MAX_MOTION_STEPS + 1;
    assert_int_equal(ppm_scene_set_mesh_vertices(test.scene, 1, 0, &vertices), bad);
    assert_same_picture(test.scene, other.scene);
}

static void ids_that_are_none_are_refused(void **state)
{
    (void)state;
    build(test.scene, &first_frame);
    const ppm_instance_desc instance = moved_to(vec3_splat(0.0f));
    const ppm_material_desc material = grey(0.5f);
    const ppm_light_desc lamp = lamp_at(vec3_splat(0.0f), 1.0f);
    const ppm_camera_desc camera = camera_at(vec3_splat(0.0f), 1.0f);
    float positions[3 * SHEET_VERTICES];
    sheet(0.0f, positions);
    const ppm_primitive_desc vertices = sheet_desc(positions, 0);
    const ppm_status bad = PPM_STATUS_INVALID_ARGUMENT;
    for (uint32_t id = 0; id < 4; id += 3) {
        assert_int_equal(ppm_scene_set_instance(test.scene, id, &instance), bad);
        assert_int_equal(ppm_scene_set_instance_visible(test.scene, id, 1), bad);
        assert_int_equal(ppm_scene_set_material(test.scene, id, &material), bad);
        assert_int_equal(ppm_scene_set_light(test.scene, id, &lamp), bad);
        assert_int_equal(ppm_scene_set_camera(test.scene, id, &camera), bad);
        assert_int_equal(ppm_scene_set_mesh_vertices(test.scene, id, 0, &vertices), bad);
    }
    assert_int_equal(ppm_scene_set_mesh_vertices(test.scene, 1, 1, &vertices), bad);
}

static void nothing_changes_while_a_session_is_alive(void **state)
{
    (void)state;
    build(test.scene, &first_frame);
    const ppm_instance_desc instance = moved_to(place);
    const ppm_material_desc material = grey(0.5f);
    const ppm_light_desc lamp = lamp_at(place, 1.0f);
    const ppm_camera_desc camera = camera_at(place, 1.0f);
    float positions[3 * SHEET_VERTICES];
    sheet(0.0f, positions);
    const ppm_primitive_desc vertices = sheet_desc(positions, 0);
    const ppm_render_options options = render_options(PPM_INTEGRATOR_PATH, 4, 0);
    ppm_render *renders[2];
    for (int i = 0; i < 2; i++)
        assert_int_equal(ppm_render_create(test.scene, &options, &renders[i]), PPM_STATUS_OK);
    for (int i = 0; i < 2; i++) { /* the last session counts */
        const ppm_status closed = PPM_STATUS_WRONG_STATE;
        assert_int_equal(ppm_scene_set_instance(test.scene, 1, &instance), closed);
        assert_int_equal(ppm_scene_set_instance_visible(test.scene, 1, 0), closed);
        assert_int_equal(ppm_scene_set_material(test.scene, 1, &material), closed);
        assert_int_equal(ppm_scene_set_light(test.scene, 1, &lamp), closed);
        assert_int_equal(ppm_scene_set_camera(test.scene, 1, &camera), closed);
        assert_int_equal(ppm_scene_set_mesh_vertices(test.scene, 1, 0, &vertices), closed);
        ppm_render_destroy(renders[i]);
    }
    assert_int_equal(ppm_scene_set_instance(test.scene, 1, &instance), PPM_STATUS_OK);
}

static void a_session_that_fails_leaves_the_scene_open(void **state)
{
    (void)state;
    build(test.scene, &first_frame);
    ppm_render_options options = render_options(PPM_INTEGRATOR_PATH, 4, 0);
    options.alpha = 3.0f;
    ppm_render *render;
    assert_int_equal(ppm_render_create(test.scene, &options, &render), PPM_STATUS_INVALID_ARGUMENT);
    assert_int_equal(ppm_scene_set_instance_visible(test.scene, 1, 1), PPM_STATUS_OK);
}

static void a_changed_scene_renders_as_a_new_one(void **state)
{
    (void)state;
    build(test.scene, &first_frame);
    const ppm_render_options options = render_options(PPM_INTEGRATOR_SPPM, 8, 1000);
    for (int i = 0; i < 3; i++) { /* frames before it leave no trace */
        free(render_picture(test.scene, &options, 1));
        update(test.scene, i % 2 == 0 ? &second_frame : &first_frame);
    }
    build(other.scene, &second_frame);
    assert_same_picture(test.scene, other.scene);
}

static void what_a_far_scene_tells_is_exact_after_many_sessions(void **state)
{
    (void)state;
    build(test.scene, &first_frame);
    ppm_scene_info before = {.size = sizeof before}, after = before;
    assert_int_equal(ppm_scene_get_info(test.scene, &before), PPM_STATUS_OK);
    float camera_before[16], camera_after[16];
    assert_int_equal(ppm_scene_camera_transform(test.scene, 1, camera_before), PPM_STATUS_OK);
    const ppm_render_options options = render_options(PPM_INTEGRATOR_PATH, 4, 0);
    for (int i = 0; i < 5; i++)
        free(render_picture(test.scene, &options, 1));
    assert_int_equal(ppm_scene_get_info(test.scene, &after), PPM_STATUS_OK);
    assert_int_equal(ppm_scene_camera_transform(test.scene, 1, camera_after), PPM_STATUS_OK);
    assert_memory_equal(before.bounds_min, after.bounds_min, sizeof before.bounds_min);
    assert_memory_equal(before.bounds_max, after.bounds_max, sizeof before.bounds_max);
    assert_memory_equal(camera_before, camera_after, sizeof camera_before);
}

static void hidden_instances_are_not_there(void **state)
{
    (void)state;
    build(test.scene, &first_frame);
    const ppm_material_id shining = material_emitter(test.scene, 5.0f, 0.0f, true);
    const ppm_instance_id lamp = shape_place(
        test.scene, shape_quad(test.scene, shining, vec3(-9, 9, 0), vec3(1, 0, 0), vec3(0, 0, 1)));
    assert_int_equal(ppm_scene_set_instance_visible(test.scene, lamp, 0), PPM_STATUS_OK);
    assert_int_equal(ppm_scene_set_instance_visible(test.scene, 2, 0), PPM_STATUS_OK);
    ppm_scene_info info = {.size = sizeof info};
    assert_int_equal(ppm_scene_get_info(test.scene, &info), PPM_STATUS_OK);
    assert_int_equal(info.lights, 1);
    assert_near(info.bounds_max[1], 0.0, 0.0);
    const ppm_render_options options = render_options(PPM_INTEGRATOR_PATH, 16, 0);
    float *hidden = render_picture(test.scene, &options, 1);
    assert_int_equal(ppm_scene_set_instance_visible(test.scene, 2, 1), PPM_STATUS_OK);
    float *shown = render_picture(test.scene, &options, 1);
    int differing = 0;
    for (int i = 0; i < 16 * 16; i++)
        differing += hidden[4 * i] != shown[4 * i];
    free(hidden);
    free(shown);
    assert_true(differing > 3);
}

static void an_instance_that_is_a_line_is_gone_until_it_has_an_area(void **state)
{
    (void)state;
    build(test.scene, &first_frame);
    build(other.scene, &first_frame);
    ppm_instance_desc line = moved_to(vec3_add(place, first_frame.box));
    line.transform[0] = line.transform[5] = 0.0f;
    assert_int_equal(ppm_scene_set_instance(test.scene, 2, &line), PPM_STATUS_OK);
    assert_int_equal(ppm_scene_set_instance_visible(other.scene, 2, 0), PPM_STATUS_OK);
    assert_same_picture(test.scene, other.scene);
    line.transform[0] = line.transform[5] = 1.0f;
    assert_int_equal(ppm_scene_set_instance(test.scene, 2, &line), PPM_STATUS_OK);
    assert_int_equal(ppm_scene_set_instance_visible(other.scene, 2, 1), PPM_STATUS_OK);
    assert_same_picture(test.scene, other.scene);
}

/* Triangles that were flat, or are, come and go with the vertices. */
static void triangles_without_area_come_back_with_new_vertices(void **state)
{
    (void)state;
    float folded[3 * SHEET_VERTICES], open[3 * SHEET_VERTICES];
    sheet(0.0f, open);
    memcpy(folded, open, sizeof folded);
    memcpy(folded + 3, folded, 3 * sizeof *folded); /* 1 on 0: the first triangle is flat */
    ppm_scene_info info = {.size = sizeof info};
    ppm_primitive_desc desc = sheet_desc(folded, 0);
    shape_place(test.scene, shape_mesh(test.scene, &desc));
    assert_int_equal(ppm_scene_get_info(test.scene, &info), PPM_STATUS_OK);
    assert_int_equal(info.triangles, 3);
    for (int i = 0; i < 2; i++) {
        desc.positions = open;
        assert_int_equal(ppm_scene_set_mesh_vertices(test.scene, 1, 0, &desc), PPM_STATUS_OK);
        assert_int_equal(ppm_scene_get_info(test.scene, &info), PPM_STATUS_OK);
        assert_int_equal(info.triangles, 4);
        assert_memory_equal(test.scene->meshes[0].primitives[0].indices, sheet_indices,
                            sizeof sheet_indices);
        desc.positions = folded;
        assert_int_equal(ppm_scene_set_mesh_vertices(test.scene, 1, 0, &desc), PPM_STATUS_OK);
        assert_int_equal(ppm_scene_get_info(test.scene, &info), PPM_STATUS_OK);
        assert_int_equal(info.triangles, 3);
    }
}

static void names_outlive_changes(void **state)
{
    (void)state;
    build(test.scene, &first_frame);
    const char *name = ppm_scene_camera_name(test.scene, 1);
    const ppm_camera_desc camera = camera_at(place, 1.0f);
    assert_int_equal(ppm_scene_set_camera(test.scene, 1, &camera), PPM_STATUS_OK);
    assert_ptr_equal(ppm_scene_camera_name(test.scene, 1), name);
    assert_int_equal(ppm_scene_camera_count(test.scene), 1);
}

/* Light that a session had to assume is not there for the next one, which may have its own. */
static void assumed_light_is_gone_with_the_session(void **state)
{
    (void)state;
    const ppm_material_desc material = grey(0.5f);
    shape_place(test.scene, shape_box(test.scene, material_add(test.scene, &material),
                                      vec3_splat(-1), vec3_splat(1), 1, false));
    const ppm_render_options options = render_options(PPM_INTEGRATOR_PATH, 4, 0);
    free(render_picture(test.scene, &options, 1));
    assert_false(ppmi_scene_has_light(test.scene));
    assert_false(test.scene->environment.is_set);
}

int main(void)
{
#define WITH_SCENES(f) cmocka_unit_test_setup_teardown(f, open_scenes, close_scenes)
    const struct CMUnitTest tests[] = {
        WITH_SCENES(changes_that_adding_would_refuse_are_refused),
        WITH_SCENES(ids_that_are_none_are_refused),
        WITH_SCENES(nothing_changes_while_a_session_is_alive),
        WITH_SCENES(a_session_that_fails_leaves_the_scene_open),
        WITH_SCENES(a_changed_scene_renders_as_a_new_one),
        WITH_SCENES(what_a_far_scene_tells_is_exact_after_many_sessions),
        WITH_SCENES(hidden_instances_are_not_there),
        WITH_SCENES(an_instance_that_is_a_line_is_gone_until_it_has_an_area),
        WITH_SCENES(triangles_without_area_come_back_with_new_vertices),
        WITH_SCENES(names_outlive_changes),
        WITH_SCENES(assumed_light_is_gone_with_the_session),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
