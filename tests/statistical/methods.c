/* Block means of several integrators. */
#include "statistical/methods.h"

#include <math.h>
#include <setjmp.h>
#include <stdarg.h>

#include <cmocka.h>

#include "support/scenes.h"

const render_method photon_methods[PHOTON_METHODS] = {
    {"sppm", PPM_INTEGRATOR_SPPM, PPM_SCHEDULE_PROGRESSIVE, PPM_DIRECT_SAMPLE, false},
    {"sppm, memoryless", PPM_INTEGRATOR_SPPM, PPM_SCHEDULE_MEMORYLESS, PPM_DIRECT_SAMPLE, false},
    {"sppm, photons", PPM_INTEGRATOR_SPPM, PPM_SCHEDULE_PROGRESSIVE, PPM_DIRECT_PHOTONS, false},
    {"sppm, memoryless, photons", PPM_INTEGRATOR_SPPM, PPM_SCHEDULE_MEMORYLESS, PPM_DIRECT_PHOTONS,
     false},
    {"ppm", PPM_INTEGRATOR_PPM, PPM_SCHEDULE_PROGRESSIVE, PPM_DIRECT_SAMPLE, false},
    {"ppm, epochs", PPM_INTEGRATOR_PPM, PPM_SCHEDULE_PROGRESSIVE, PPM_DIRECT_SAMPLE, true},
    {"ppm, photons", PPM_INTEGRATOR_PPM, PPM_SCHEDULE_PROGRESSIVE, PPM_DIRECT_PHOTONS, true},
};

const render_method path_method = {.name = "path", .integrator = PPM_INTEGRATOR_PATH};

ppm_render_options method_options(const render_method *method, uint32_t width,
                                  uint64_t photons_per_pass)
{
    ppm_render_options options = render_options(method->integrator, width, photons_per_pass);
    options.schedule = method->schedule;
    options.direct = method->direct;
    if (method->has_epochs) options.photons_per_epoch = 2 * photons_per_pass;
    return options;
}

void add_lit_box(ppm_scene *scene, ppmi_vec3 reflectance, ppmi_vec3 target)
{
    const ppm_material_id wall = material_lambert_rgb(scene, reflectance);
    shape_place(scene, shape_box(scene, wall, vec3_splat(-1), vec3_splat(1), 1, true));
    add_quad(scene, material_emitter(scene, 10.0f, 0.0f, false), vec3(-0.5f, 0.99f, -0.5f),
             vec3(1.0f, 0, 0), vec3(0, 0, 1.0f));
    camera_perspective(scene, vec3(0, 0, 0.95f), target, 1.2f);
}

/* Adds each block's mean to its own statistics. */
static double measure_blocks(const float *rgba, const ppm_render_options *options, void *user)
{
    test_mean *means = user;
    const uint32_t side = options->width / METHOD_SIDE;
    for (uint32_t value = 0; value < METHOD_VALUES; value++) {
        const uint32_t block = value / 3, channel = value % 3;
        double sum = 0.0;
        for (uint32_t i = 0; i < side * side; i++) {
            const uint32_t x = block % METHOD_SIDE * side + i % side;
            const uint32_t y = block / METHOD_SIDE * side + i / side;
            sum += (double)rgba[4 * (y * options->width + x) + channel];
        }
        mean_add(&means[value], sum / (side * side));
    }
    return 0.0;
}

void method_blocks(ppm_scene *scene, const ppm_render_options *options, uint32_t passes,
                   uint32_t seeds, test_mean out_means[METHOD_VALUES])
{
    for (uint32_t i = 0; i < METHOD_VALUES; i++)
        out_means[i] = (test_mean){0};
    render_means(scene, options, passes, seeds, measure_blocks, out_means);
}

static void compare_block(test_family *family, const test_mean *path, const test_mean *photons,
                          double bias, const char *name, uint32_t value)
{
    const double error = hypot(mean_error(path), mean_error(photons));
    const double off = fabs(path->mean - photons->mean);
    family_add(family,
               p_student(fmax(0.0, off - bias * path->mean) / error, (double)path->count - 1.0),
               "%s, block %u, channel %u: paths %.5g, photons %.5g, error %.2g", name, value / 3,
               value % 3, path->mean, photons->mean, error);
    /* a standard error by the few seeds of a slow build is too uncertain for a rule of its own */
    const bool is_certain = TEST_EFFORT_PERCENT >= 100;
    if (is_certain && !(off <= 0.02 * path->mean + 3.0 * error)) {
        fail_msg("%s, block %u, channel %u: paths %.5g, photons %.5g are more than 2 %% apart "
                 "(error %.2g)",
                 name, value / 3, value % 3, path->mean, photons->mean, error);
    }
}

void methods_agree(ppm_scene *scene, const method_comparison *how)
{
    test_family family = {0};
    test_mean paths[METHOD_VALUES], photons[METHOD_VALUES];
    ppm_render_options options = method_options(&path_method, how->width, 0);
    options.shutter_close = how->shutter_frames;
    method_blocks(scene, &options, how->path_passes, how->seeds, paths);
    for (uint32_t i = 0; i < METHOD_VALUES; i++)
        mean_check_power(&paths[i], how->resolution);
    for (uint32_t m = 0; m < PHOTON_METHODS; m++) {
        if (how->left_out >> m & 1) continue;
        ppm_render_options with = method_options(&photon_methods[m], how->width, how->photons);
        with.radius_m = how->radius_m;
        with.shutter_close = how->shutter_frames;
        method_blocks(scene, &with, how->passes, how->seeds, photons);
        for (uint32_t i = 0; i < METHOD_VALUES; i++) {
            mean_check_power(&photons[i], how->resolution);
            compare_block(&family, &paths[i], &photons[i], how->bias, photon_methods[m].name, i);
        }
    }
    family_check(&family);
}
