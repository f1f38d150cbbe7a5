/* Whole renders, repeated. */
#include "support/renders.h"

#include <setjmp.h>
#include <stdarg.h>
#include <stdlib.h>

#include <cmocka.h>

ppm_render_options render_options(int32_t integrator, uint32_t width, uint64_t photons_per_pass)
{
    return (ppm_render_options){.size = sizeof(ppm_render_options),
                                .integrator = integrator,
                                .width = width,
                                .height = width,
                                .photons_per_pass = photons_per_pass,
                                .pixel_filter = PPM_PIXEL_FILTER_BOX,
                                .threads = 1};
}

float *render_picture(ppm_scene *scene, const ppm_render_options *options, uint32_t passes)
{
    ppm_render *render = NULL;
    assert_int_equal(ppm_render_create(scene, options, &render), PPM_STATUS_OK);
    for (uint32_t i = 0; i < passes; i++) {
        assert_int_equal(ppm_render_advance(render), PPM_STATUS_OK);
    }
    const ppm_render_options *resolved = ppm_render_get_options(render);
    const uint32_t *crop = resolved->crop;
    const size_t count = 4 * (size_t)(crop[2] - crop[0]) * (crop[3] - crop[1]);
    float *rgba = malloc(count * sizeof *rgba);
    assert_non_null(rgba);
    assert_int_equal(ppm_render_read_image(render, rgba, count), PPM_STATUS_OK);
    ppm_render_destroy(render);
    return rgba;
}

test_mean render_means(ppm_scene *scene, const ppm_render_options *options, uint32_t passes,
                       uint32_t seed_count, render_measure measure, void *user)
{
    if (TEST_EFFORT_PERCENT < 100 && seed_count > 4) seed_count = 4;
    test_mean mean = {0};
    ppm_render_options with_seed = *options;
    for (uint32_t seed = 1; seed <= seed_count; seed++) {
        with_seed.seed = seed;
        float *rgba = render_picture(scene, &with_seed, passes);
        mean_add(&mean, measure(rgba, &with_seed, user));
        free(rgba);
    }
    return mean;
}

double measure_green(const float *rgba, const ppm_render_options *options, void *user)
{
    (void)user;
    const size_t pixels = (size_t)options->width * options->height;
    double sum = 0.0;
    for (size_t i = 0; i < pixels; i++)
        sum += (double)rgba[4 * i + 1];
    return sum / (double)pixels;
}

test_mean render_green(ppm_scene *scene, const ppm_render_options *options, uint32_t passes,
                       uint32_t seed_count)
{
    return render_means(scene, options, passes, seed_count, measure_green, NULL);
}
