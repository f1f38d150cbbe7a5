/* importers/gltf/gltf_lines.c, and what gltf_mesh.c makes of it */
#include <stdio.h>
#include <string.h>

#include "gltf/gltf_geometry.h"
#include "gltf_fixture.h"

static void check_mode(gltf_fixture *f, int32_t mode, size_t count, const uint32_t *expected,
                       size_t expected_elements, size_t sides)
{
    static const uint32_t list[5] = {7, 3, 9, 3, 4};
    uint32_t *indices = NULL;
    size_t elements = 99;
    assert_int_equal(ppmi_gltf_points_and_lines(f->context, mode, list, count, &indices, &elements),
                     PPM_STATUS_OK);
    assert_int_equal(elements, expected_elements);
    if (elements > 0) assert_memory_equal(indices, expected, elements * sides * sizeof *indices);
    ppmi_free(f->context, indices);
}

static void too_few_indices_are_nothing(void **state)
{
    check_mode(*state, PPMI_GLTF_LINES, 1, NULL, 0, 2);
    check_mode(*state, PPMI_GLTF_LINE_LOOP, 1, NULL, 0, 2);
    check_mode(*state, PPMI_GLTF_LINE_STRIP, 1, NULL, 0, 2);
    check_mode(*state, PPMI_GLTF_LINE_STRIP, 0, NULL, 0, 2);
    check_mode(*state, PPMI_GLTF_POINTS, 0, NULL, 0, 1);
}

static void points_are_their_indices(void **state)
{
    static const uint32_t expected[] = {7, 3, 9, 3, 4};
    check_mode(*state, PPMI_GLTF_POINTS, 5, expected, 5, 1);
}

static void lines_are_pairs_and_a_rest_is_dropped(void **state)
{
    static const uint32_t expected[] = {7, 3, 9, 3};
    check_mode(*state, PPMI_GLTF_LINES, 5, expected, 2, 2);
}

static void strips_join_and_loops_close(void **state)
{
    static const uint32_t expected[] = {7, 3, 3, 9, 9, 3, 3, 4, 4, 7};
    check_mode(*state, PPMI_GLTF_LINE_STRIP, 5, expected, 4, 2);
    check_mode(*state, PPMI_GLTF_LINE_LOOP, 5, expected, 5, 2);
}

static void the_radius_is_a_share_of_the_diagonal(void **state)
{
    (void)state;
    float first[6] = {0, 0, 0, 3, 0, 0}, second[3] = {0, 4, 12}, one[3] = {5, 5, 5};
    const ppmi_gltf_geometry two[2] = {{.vertex_count = 2, .positions = first},
                                       {.vertex_count = 1, .positions = second}};
    const ppmi_gltf_geometry single = {.vertex_count = 1, .positions = one};
    assert_float_equal(ppmi_gltf_line_radius(two, 2), 13.0f * PPMI_GLTF_RADIUS_SHARE, 1e-6f);
    assert_float_equal(ppmi_gltf_line_radius(&single, 1), PPMI_GLTF_RADIUS_OF_A_POINT_M, 0.0f);
    assert_float_equal(ppmi_gltf_line_radius(NULL, 0), PPMI_GLTF_RADIUS_OF_A_POINT_M, 0.0f);
}

static void every_mode_makes_a_mesh_and_is_told(void **state)
{
    gltf_fixture *f = *state;
    static const float five[15] = {0, 0, 0, 1, 0, 0, 0, 1, 0, 1, 1, 0, 0, 2, 0};
    for (int mode = 0; mode < 4; ++mode) {
        char primitive[80];
        snprintf(primitive, sizeof primitive, "'attributes':{'POSITION':0},'mode':%d", mode);
        assert_gltf_status(
            f,
            gltf_import_primitive(f, primitive,
                                  "{'bufferView':0,'componentType':5126,'count':5,'type':'VEC3'}",
                                  "{'buffer':0,'byteLength':60}", five, 60),
            PPM_STATUS_OK);
        assert_int_equal(f->scene->mesh_count, 1);
        assert_int_equal(f->scene->instance_count, 1);
        assert_int_equal(f->scene->meshes[0].primitive_count, 1);
        assert_gltf_logged(f, 'I',
                           mode == 0 ? "approximated: points: 1 primitive: balls"
                                     : "approximated: lines: 1 primitive: round segments");
        gltf_reset(f);
    }
}

#define TEST(name) cmocka_unit_test_setup_teardown(name, gltf_setup, gltf_teardown)

int main(void)
{
    const struct CMUnitTest tests[] = {
        TEST(too_few_indices_are_nothing),           TEST(points_are_their_indices),
        TEST(lines_are_pairs_and_a_rest_is_dropped), TEST(strips_join_and_loops_close),
        TEST(the_radius_is_a_share_of_the_diagonal), TEST(every_mode_makes_a_mesh_and_is_told),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
