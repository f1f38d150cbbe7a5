/* src/shading/surface.c: normals and tangents of meshes without them, and of mirrored instances */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>

#include <cmocka.h>

#include "shading/surface.h"
#include "support/scenes.h"

/* A roof of two squares that meet at x = 0, the left one in the plane z = 0, the right one falling;
 * counter-clockwise from above. u runs along x, v against y, as pictures have their rows. */
static const float positions[] = {-1, 0, 0, 0, 0, 0, 0, 1, 0, -1, 1, 0, 1, 0, -1, 1, 1, -1};
static const float uvs[] = {0, 1, 1, 1, 1, 0, 0, 0, 2, 1, 2, 0};
static const uint32_t indices[] = {0, 1, 2, 0, 2, 3, 1, 4, 5, 1, 5, 2};
/* those of the left square's plane, everywhere */
static const float smooth[] = {0, 0, 1, 0, 0, 1, 0, 0, 1, 0, 0, 1, 0, 0, 1, 0, 0, 1};
static const float tangents[] = {1, 0, 0, 1, 1, 0, 0, 1, 1, 0, 0, 1,
                                 1, 0, 0, 1, 1, 0, 0, 1, 1, 0, 0, 1};

typedef struct fixture {
    test_scene test;
    test_world world;
} fixture;

/* The roof, scaled along the axes. */
static void open_roof_with(fixture *f, const float *mesh_uvs, const float *mesh_normals,
                           const float *mesh_tangents, float scale_x, float scale_y)
{
    scene_open(&f->test);
    const ppm_primitive_desc primitive = {.vertex_count = 6,
                                          .triangle_count = 4,
                                          .positions = positions,
                                          .normals = mesh_normals,
                                          .tangents = mesh_tangents,
                                          .uvs = {mesh_uvs},
                                          .indices = indices};
    const ppm_mesh_desc mesh = {
        .size = sizeof mesh, .primitive_count = 1, .primitives = &primitive};
    ppm_instance_desc instance = {
        .size = sizeof instance,
        .transform = {scale_x, 0, 0, 0, 0, scale_y, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1}};
    ppm_instance_id id;
    assert_int_equal(ppm_scene_add_mesh(f->test.scene, &mesh, &instance.mesh), PPM_STATUS_OK);
    assert_int_equal(ppm_scene_add_instance(f->test.scene, &instance, &id), PPM_STATUS_OK);
    world_open(&f->world, &f->test);
}

static void open_roof(fixture *f, const float *mesh_normals, const float *mesh_tangents,
                      float scale_x, float scale_y)
{
    open_roof_with(f, uvs, mesh_normals, mesh_tangents, scale_x, scale_y);
}

static void close_roof(fixture *f)
{
    world_close(&f->world);
    scene_close(&f->test);
}

static ppmi_surface look_down(const fixture *f, float x, float y)
{
    return world_hit(&f->world, vec3(x, y, 5.0f), vec3(0.0f, 0.0f, -1.0f));
}

static void assert_near(ppmi_vec3 got, float x, float y, float z)
{
    const ppmi_vec3 error = vec3_sub(got, vec3(x, y, z));
    if (!(vec3_max_abs(error) < 1e-5f)) {
        fail_msg("%g %g %g, expected %g %g %g", (double)got.x, (double)got.y, (double)got.z,
                 (double)x, (double)y, (double)z);
    }
}

static void without_normals_faces_are_flat_up_to_their_edges(void **state)
{
    (void)state;
    const float r = sqrtf(0.5f);
    fixture f;
    open_roof(&f, NULL, NULL, 1.0f, 1.0f);
    assert_near(look_down(&f, -0.001f, 0.4f).ns, 0, 0, 1);
    assert_near(look_down(&f, 0.001f, 0.4f).ns, r, 0, r);
    close_roof(&f);
    open_roof(&f, smooth, NULL, 1.0f, 1.0f);
    assert_near(look_down(&f, 0.001f, 0.4f).ns, 0, 0, 1);
    assert_near(look_down(&f, 0.001f, 0.4f).ng, r, 0, r);
    close_roof(&f);
}

static void mirrors_keep_the_front_in_front(void **state)
{
    (void)state;
    static const float scales[][2] = {{-1, 1}, {1, -1}, {-1, -1}, {-2, 0.5f}};
    for (size_t i = 0; i < sizeof scales / sizeof scales[0]; ++i) {
        for (int is_smooth = 0; is_smooth < 2; ++is_smooth) {
            fixture f;
            open_roof(&f, is_smooth ? smooth : NULL, NULL, scales[i][0], scales[i][1]);
            const ppmi_surface s = look_down(&f, -0.5f * scales[i][0], 0.5f * scales[i][1]);
            assert_near(s.ng, 0, 0, 1);
            assert_near(s.ns, 0, 0, 1);
            close_roof(&f);
        }
    }
}

static void tangents_are_mirrored_with_their_mesh(void **state)
{
    (void)state;
    static const float scales[][2] = {{1, 1}, {-1, 1}, {1, -1}, {-1, -1}};
    for (size_t i = 0; i < sizeof scales / sizeof scales[0]; ++i) {
        const float sx = scales[i][0], sy = scales[i][1];
        for (int is_given = 0; is_given < 2; ++is_given) {
            const ppm_texture plain = {0};
            ppmi_vec3 tangent, bitangent;
            fixture f;
            open_roof(&f, smooth, is_given ? tangents : NULL, sx, sy);
            const ppmi_surface s = look_down(&f, -0.5f * sx, 0.5f * sy);
            assert_true(ppmi_surface_tangents(&s, &plain, &tangent, &bitangent));
            assert_near(tangent, sx, 0, 0);
            assert_near(bitangent, 0, sy, 0);
            close_roof(&f);
        }
    }
}

/* Turns and scales: the first four keep right angles, also on coordinates that are stretched. */
static const float transforms[][6] = {
    {0, 1, 0, -1, 0, 1},
    {-1, 0, 1, 0, -1, 1},
    {-1, 0, 0, 0, 1, 0},
    {0, 2, 0.5f, 3, 0, 0.25f},
    {0.6f, 0.8f, 0, -0.8f, 0.6f, 0},
    {2, 1, 0, 0, -0.5f, 0},
};

/* The tangents of the roof's left square, under a texture with the transform or, if it is NULL,
 * under a plain one. */
static void tangents_under(const float *mesh_uvs, const float *mesh_tangents,
                           const float *transform, ppmi_vec3 *tangent, ppmi_vec3 *bitangent)
{
    ppm_texture texture = {.has_transform = transform != NULL};
    fixture f;
    for (int i = 0; transform && i < 6; ++i) {
        texture.uv_transform[i] = transform[i];
    }
    open_roof_with(&f, mesh_uvs, smooth, mesh_tangents, 1.0f, 1.0f);
    const ppmi_surface s = look_down(&f, -0.4f, 0.3f);
    assert_true(ppmi_surface_tangents(&s, &texture, tangent, bitangent));
    close_roof(&f);
}

/* KHR_texture_transform: a picture that is turned in the file looks like one that is turned by
 * coordinates that have the transform in them. Those have no transform, and no tangents. */
static void tangents_turn_with_the_picture(void **state)
{
    (void)state;
    for (size_t i = 0; i < sizeof transforms / sizeof transforms[0]; ++i) {
        const float *m = transforms[i];
        for (int stretch = 1; stretch <= 3; stretch += 2) {
            float before[12], after[12];
            for (size_t v = 0; v < 6; ++v) {
                before[2 * v] = uvs[2 * v] * (float)stretch;
                before[2 * v + 1] = uvs[2 * v + 1];
                after[2 * v] = m[0] * before[2 * v] + m[1] * before[2 * v + 1] + m[2];
                after[2 * v + 1] = m[3] * before[2 * v] + m[4] * before[2 * v + 1] + m[5];
            }
            ppmi_vec3 right, top, tangent, bitangent;
            tangents_under(after, NULL, NULL, &right, &top);
            tangents_under(before, NULL, m, &tangent, &bitangent);
            assert_near(tangent, right.x, right.y, right.z);
            assert_near(bitangent, top.x, top.y, top.z);
            tangents_under(before, tangents, m, &tangent, &bitangent);
            assert_near(tangent, right.x, right.y, right.z);
            /* given tangents keep a right angle: on the side where the picture's top is */
            const ppmi_vec3 across = vec3_normalize(vec3_mad(top, right, -vec3_dot(top, right)));
            assert_near(bitangent, across.x, across.y, across.z);
        }
    }
}

static void transforms_that_only_stretch_or_are_singular_leave_tangents_alone(void **state)
{
    (void)state;
    static const float others[][6] = {
        {2, 0, 0.5f, 0, 3, 0.5f}, {0, 0, 0, 0, 0, 0}, {1, 1, 0, 1, 1, 0}};
    for (size_t i = 0; i < sizeof others / sizeof others[0]; ++i) {
        for (int is_given = 0; is_given < 2; ++is_given) {
            ppmi_vec3 tangent, bitangent;
            tangents_under(uvs, is_given ? tangents : NULL, others[i], &tangent, &bitangent);
            assert_near(tangent, 1, 0, 0);
            assert_near(bitangent, 0, 1, 0);
        }
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(without_normals_faces_are_flat_up_to_their_edges),
        cmocka_unit_test(mirrors_keep_the_front_in_front),
        cmocka_unit_test(tangents_are_mirrored_with_their_mesh),
        cmocka_unit_test(tangents_turn_with_the_picture),
        cmocka_unit_test(transforms_that_only_stretch_or_are_singular_leave_tangents_alone),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
