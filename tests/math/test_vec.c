/* Vectors, frames and transforms. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#include "math/sampler.h"
#include "math/sampling.h"
#include "math/transform.h"
#include "support/near.h"

static ppmi_rng rng;

static float random_signed(void)
{
    return 2.0f * ppmi_rng_float(&rng) - 1.0f;
}

static ppmi_vec3 random_vector(void)
{
    const float x = random_signed(), y = random_signed();
    return vec3(x, y, random_signed());
}

static void assert_close(ppmi_vec3 a, ppmi_vec3 b, float tolerance)
{
    assert_near(a.x, b.x, tolerance);
    assert_near(a.y, b.y, tolerance);
    assert_near(a.z, b.z, tolerance);
}

static void assert_orthonormal(ppmi_vec3 n)
{
    const ppmi_frame f = ppmi_frame_from_normal(n);
    const float rounding = 4e-7f;
    assert_near(vec3_length(f.s), 1.0f, rounding);
    assert_near(vec3_length(f.t), 1.0f, rounding);
    assert_near(vec3_dot(f.s, f.t), 0.0f, rounding);
    assert_near(vec3_dot(f.s, f.n), 0.0f, rounding);
    assert_near(vec3_dot(f.t, f.n), 0.0f, rounding);
    assert_close(vec3_cross(f.s, f.t), f.n, 2.0f * rounding);
}

static void frames_are_orthonormal_and_right_handed(void **state)
{
    (void)state;
    for (int i = 0; i < 100000; i++) {
        const float u = ppmi_rng_float(&rng), v = ppmi_rng_float(&rng);
        assert_orthonormal(vec3_normalize(ppmi_sample_sphere(u, v)));
    }
    /* the construction divides by 1 + |z| and changes sign at z = 0 */
    const ppmi_vec3 hard[] = {{0.0f, 0.0f, 1.0f},   {0.0f, 0.0f, -1.0f}, {1.0f, 0.0f, 0.0f},
                              {1.0f, 0.0f, -0.0f},  {0.0f, -1.0f, 0.0f}, {1e-4f, 0.0f, -1.0f},
                              {1e-8f, 1e-8f, -1.0f}};
    for (size_t i = 0; i < sizeof hard / sizeof hard[0]; i++)
        assert_orthonormal(vec3_normalize(hard[i]));
}

static void frames_take_vectors_there_and_back(void **state)
{
    (void)state;
    for (int i = 0; i < 1000; i++) {
        const ppmi_frame f = ppmi_frame_from_normal(vec3_normalize(random_vector()));
        const ppmi_vec3 v = random_vector();
        assert_close(ppmi_frame_to_world(&f, ppmi_frame_to_local(&f, v)), v, 1e-6f);
    }
}

static ppmi_transform random_transform(void)
{
    return (ppmi_transform){random_vector(), random_vector(), random_vector(), random_vector()};
}

static void cofactors_keep_normals_at_right_angles_to_the_surface(void **state)
{
    (void)state;
    int mirrored = 0;
    for (int i = 0; i < 10000; i++) {
        const ppmi_transform m = random_transform(); /* sheared, unevenly scaled, often mirrored */
        const float determinant = ppmi_transform_determinant(&m);
        mirrored += determinant < 0.0f;
        const ppmi_transform c = ppmi_transform_cofactors(&m);
        const ppmi_vec3 a = random_vector(), b = random_vector();
        const ppmi_vec3 n = vec3_cross(a, b);
        const ppmi_vec3 world = ppmi_transform_vector(&c, n);
        assert_near(vec3_dot(world, ppmi_transform_vector(&m, a)), 0.0f, 2e-5f);
        assert_near(vec3_dot(world, ppmi_transform_vector(&m, b)), 0.0f, 2e-5f);
        /* what lies in front stays in front, or goes behind where the transform mirrors */
        assert_near(vec3_dot(world, ppmi_transform_vector(&m, n)), determinant * vec3_length2(n),
                    2e-4f);
    }
    assert_in_range(mirrored, 4000, 6000);
}

static void points_are_moved_and_vectors_are_not(void **state)
{
    (void)state;
    const float columns[16] = {2.0f, 0.0f, 0.0f, 0.0f, 0.0f, 3.0f, 0.0f, 0.0f,
                               0.0f, 0.0f, 4.0f, 0.0f, 5.0f, 6.0f, 7.0f, 1.0f};
    const ppmi_transform m = ppmi_transform_load(columns);
    assert_close(ppmi_transform_point(&m, vec3(1.0f, 1.0f, 1.0f)), vec3(7.0f, 9.0f, 11.0f), 0.0f);
    assert_close(ppmi_transform_vector(&m, vec3(1.0f, 1.0f, 1.0f)), vec3(2.0f, 3.0f, 4.0f), 0.0f);
    assert_near(ppmi_transform_determinant(&m), 24.0f, 0.0f);
}

static void what_is_not_finite_is_seen(void **state)
{
    (void)state;
    for (int i = 0; i < 3; i++) {
        float p[3] = {1.0f, 2.0f, 3.0f};
        p[i] = NAN;
        assert_false(vec3_is_finite(vec3_load(p)));
        p[i] = -INFINITY;
        assert_false(vec3_is_finite(vec3_load(p)));
        assert_false(vec3_max_abs(vec3_load(p)) < 1e15f);
    }
}

static void the_zero_vector_stays_zero(void **state)
{
    (void)state;
    assert_close(vec3_normalize(vec3_splat(0.0f)), vec3_splat(0.0f), 0.0f);
}

static int start(void **state)
{
    (void)state;
    rng = ppmi_rng_start(0, PPMI_STREAM_EYE, 0);
    return 0;
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(frames_are_orthonormal_and_right_handed),
        cmocka_unit_test(frames_take_vectors_there_and_back),
        cmocka_unit_test(cofactors_keep_normals_at_right_angles_to_the_surface),
        cmocka_unit_test(points_are_moved_and_vectors_are_not),
        cmocka_unit_test(what_is_not_finite_is_seen),
        cmocka_unit_test(the_zero_vector_stays_zero),
    };
    return cmocka_run_group_tests(tests, start, NULL);
}
