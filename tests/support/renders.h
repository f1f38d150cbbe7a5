/* Whole renders through the public interface, repeated with several seeds. */
#ifndef TEST_SUPPORT_RENDERS_H
#define TEST_SUPPORT_RENDERS_H

#include "ppm/render.h"
#include "support/statistics.h"

/* The options that most tests want: a small square picture whose pixels are means over their areas
 * (the box filter), one thread (short passes gain nothing by more). */
ppm_render_options render_options(int32_t integrator, uint32_t width, uint64_t photons_per_pass);

/* A finished picture: 4 * width * height floats (of the crop), to be freed by free(). */
float *render_picture(ppm_scene *scene, const ppm_render_options *options, uint32_t passes);

/* The mean of one value a seed (seed_count seeds, from 1; fewer where the build is slow): what
 * measure makes of the picture. */
typedef double (*render_measure)(const float *rgba, const ppm_render_options *options, void *user);
test_mean render_means(ppm_scene *scene, const ppm_render_options *options, uint32_t passes,
                       uint32_t seed_count, render_measure measure, void *user);

/* A measure: the mean of the green channel over the picture. user is not used. */
double measure_green(const float *rgba, const ppm_render_options *options, void *user);

/* The mean of green over the picture, seed by seed. */
test_mean render_green(ppm_scene *scene, const ppm_render_options *options, uint32_t passes,
                       uint32_t seed_count);

#endif
