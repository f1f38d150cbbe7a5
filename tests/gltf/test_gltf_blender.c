/* A bent, swollen and turned export of Blender's is at every frame where Blender has it itself:
 * tests/blender/poses.py writes the animation, and each frame's vertices as plain meshes. Skipped
 * where there is no Blender. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "gltf_motion.h"

static const int frames[] = {1, 7, 13, 25};
static const double frames_a_second = 24.0;

typedef struct cloud {
    size_t count;
    ppmi_vec3 *points;
} cloud;

/* All vertices of a scene, in the world. */
static cloud take_points(const ppm_scene *scene)
{
    cloud c = {0, NULL};
    for (uint32_t i = 0; i < scene->instance_count; ++i) {
        const ppmi_mesh *mesh = &scene->meshes[scene->instances[i].mesh];
        for (uint32_t k = 0; k < mesh->primitive_count; ++k) {
            const ppmi_primitive *p = &mesh->primitives[k];
            c.points = realloc(c.points, (c.count + p->vertex_count) * sizeof *c.points);
            assert_non_null(c.points);
            for (uint32_t v = 0; v < p->vertex_count; ++v) {
                c.points[c.count++] = ppmi_transform_point(&scene->instances[i].to_world,
                                                           vec3_load(p->positions + 3 * (size_t)v));
            }
        }
    }
    return c;
}

/* How far the point of from that is farthest from all of to is. */
static float largest_distance(const cloud *from, const cloud *to)
{
    float most = 0.0f;
    for (size_t i = 0; i < from->count; ++i) {
        float nearest = INFINITY;
        for (size_t k = 0; k < to->count; ++k) {
            nearest = fminf(nearest, vec3_length(vec3_sub(from->points[i], to->points[k])));
        }
        most = fmaxf(most, nearest);
    }
    return most;
}

static void poses_are_where_blender_has_them(void **state)
{
    gltf_fixture *f = *state;
    char command[512], animated[160];
    ppmi_gltf_asset *asset;
    snprintf(command, sizeof command,
             "blender -b --factory-startup --python '" PPM_SOURCE_DIR
             "/tests/blender/poses.py' -- '%s' > '%s/log' 2>&1",
             f->folder, f->folder);
    assert_int_equal(system(command), 0);
    snprintf(animated, sizeof animated, "%s", gltf_path(f, "animated.glb"));
    for (size_t i = 0; i < sizeof frames / sizeof frames[0]; ++i) {
        char name[32];
        snprintf(name, sizeof name, "baked_%d.glb", frames[i]);
        f->options.pose = (ppm_pose){0};
        gltf_reset(f);
        assert_gltf_status(f, gltf_import_file(f, name), PPM_STATUS_OK);
        cloud expected = take_points(f->scene);
        f->options.pose = gltf_at(frames[i] / frames_a_second);
        gltf_reset(f);
        assert_gltf_status(f, gltf_open_path(f, animated, &asset), PPM_STATUS_OK);
        cloud got = take_points(f->scene);
        assert_true(expected.count > 300);
        /* Blender's file has single precision, and its matrices of joints have been inverted in
         * it; the scene is 10 m across */
        assert_true(largest_distance(&expected, &got) < 1e-4f);
        assert_true(largest_distance(&got, &expected) < 1e-4f);
        free(expected.points);
        free(got.points);
        ppmi_gltf_asset_close(asset);
    }
}

int main(void)
{
    if (system("command -v blender > /dev/null 2>&1") != 0) {
        printf("skipped: no Blender\n");
        return 77;
    }
    const struct CMUnitTest tests[] = {
        cmocka_unit_test_setup_teardown(poses_are_where_blender_has_them, gltf_setup,
                                        gltf_teardown),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
