/* Colours whose places in the colour spaces are published. */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

#include "compare/opponent.h"
#include "support/near.h"

static void lab_of(const float rgb[3], float lab[3])
{
    float xyz[3];
    ppmi_compare_rgb_to_xyz(rgb, xyz);
    ppmi_compare_xyz_to_lab(xyz, lab);
}

static void white_is_one_in_xyz_over_white(void **state)
{
    (void)state;
    const float white[3] = {1, 1, 1};
    float xyz[3];
    ppmi_compare_rgb_to_xyz(white, xyz);
    for (int i = 0; i < 3; i++)
        assert_near(xyz[i], 1, 1e-6);
}

static void matrices_are_inverse_to_each_other(void **state)
{
    (void)state;
    for (int primary = 0; primary < 3; primary++) {
        float rgb[3] = {0.25f, 0.25f, 0.25f}, xyz[3], back[3];
        rgb[primary] = 0.75f;
        ppmi_compare_rgb_to_xyz(rgb, xyz);
        ppmi_compare_xyz_to_rgb(xyz, back);
        for (int i = 0; i < 3; i++)
            assert_near(back[i], rgb[i], 1e-6);
    }
}

/* Lindbloom's calculator and others, D65, to two places */
static void primaries_have_their_known_lab(void **state)
{
    (void)state;
    static const float cases[][6] = {
        {1, 1, 1, 100.0f, 0.0f, 0.0f},       {0, 0, 0, 0.0f, 0.0f, 0.0f},
        {1, 0, 0, 53.24f, 80.09f, 67.20f},   {0, 1, 0, 87.73f, -86.18f, 83.18f},
        {0, 0, 1, 32.30f, 79.19f, -107.86f}, {1, 1, 0, 97.14f, -21.55f, 94.48f},
    };
    for (size_t i = 0; i < sizeof cases / sizeof cases[0]; i++) {
        float lab[3];
        lab_of(cases[i], lab);
        for (int c = 0; c < 3; c++)
            assert_near(lab[c], cases[i][3 + c], 0.05);
    }
}

static void lab_curve_is_continuous_at_its_joint(void **state)
{
    (void)state;
    const float joint = 216.0f / 24389.0f;
    float below[3], above[3];
    ppmi_compare_xyz_to_lab((const float[3]){joint * 0.9999f, joint, joint}, below);
    ppmi_compare_xyz_to_lab((const float[3]){joint * 1.0001f, joint, joint}, above);
    assert_near(below[0], 8, 1e-4); /* by definition of the joint */
    assert_near(above[1] - below[1], 500 * 0.0002 * (double)joint * 7.787, 2e-4);
}

static void ycxcz_is_linear_and_goes_back(void **state)
{
    (void)state;
    const float xyz[3] = {0.3f, 0.5f, 0.2f};
    float ycxcz[3], back[3];
    ppmi_compare_xyz_to_ycxcz(xyz, ycxcz);
    assert_near(ycxcz[0], 116 * 0.5 - 16, 1e-5);
    assert_near(ycxcz[1], 500 * -0.2, 1e-4);
    assert_near(ycxcz[2], 200 * 0.3, 1e-4);
    ppmi_compare_ycxcz_to_xyz(ycxcz, back);
    for (int i = 0; i < 3; i++)
        assert_near(back[i], xyz[i], 1e-6);
}

static void hunt_and_hyab_follow_their_formulas(void **state)
{
    (void)state;
    const float lab[3] = {50, 20, -40}, other[3] = {80, 13, -16};
    float adjusted[3];
    ppmi_compare_hunt(lab, adjusted);
    assert_near(adjusted[0], 50, 0);
    assert_near(adjusted[1], 10, 1e-5);
    assert_near(adjusted[2], -20, 1e-5);
    assert_near(ppmi_compare_hyab(adjusted, other), 30 + 5, 1e-5); /* 3, 4, 5 */
}

static void srgb_codes_decode_to_their_light(void **state)
{
    (void)state;
    assert_near(ppmi_compare_srgb_decode(0), 0, 0);
    assert_near(ppmi_compare_srgb_decode(1), 1, 1e-6);
    assert_near(ppmi_compare_srgb_decode(0.5f), 0.2140411, 1e-6);
    assert_near(ppmi_compare_srgb_decode(0.04f), 0.04 / 12.92, 1e-8);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(white_is_one_in_xyz_over_white),
        cmocka_unit_test(matrices_are_inverse_to_each_other),
        cmocka_unit_test(primaries_have_their_known_lab),
        cmocka_unit_test(lab_curve_is_continuous_at_its_joint),
        cmocka_unit_test(ycxcz_is_linear_and_goes_back),
        cmocka_unit_test(hunt_and_hyab_follow_their_formulas),
        cmocka_unit_test(srgb_codes_decode_to_their_light),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
