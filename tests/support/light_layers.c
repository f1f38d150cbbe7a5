/* Layers of whole renders. */
#include "support/light_layers.h"

#include <setjmp.h>
#include <stdarg.h>
#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>
#include <stdlib.h>

#include <cmocka.h>

layered_picture layered_open(ppm_scene *scene, const ppm_render_options *options, uint32_t passes)
{
    layered_picture picture = {0};
    assert_int_equal(ppm_render_create(scene, options, &picture.render), PPM_STATUS_OK);
    for (uint32_t i = 0; i < passes; i++)
        assert_int_equal(ppm_render_advance(picture.render), PPM_STATUS_OK);
    const uint32_t *crop = ppm_render_get_options(picture.render)->crop;
    picture.pixels = (size_t)(crop[2] - crop[0]) * (crop[3] - crop[1]);
    return picture;
}

void layered_close(layered_picture *picture)
{
    ppm_render_destroy(picture->render);
}

float *layered_read(const layered_picture *picture, int32_t kind, uint32_t number)
{
    const uint32_t count = ppm_render_layer_count(picture->render);
    for (uint32_t i = 0; i < count; i++) {
        ppm_layer_info info = {.size = sizeof info};
        assert_int_equal(ppm_render_get_layer(picture->render, i, &info), PPM_STATUS_OK);
        if (info.kind != kind || number-- > 0) continue;
        const size_t floats = info.channel_count * picture->pixels;
        float *values = malloc(floats * sizeof *values);
        assert_non_null(values);
        assert_int_equal(ppm_render_read_layer(picture->render, i, values, floats), PPM_STATUS_OK);
        return values;
    }
    return NULL;
}

float *layered_sum(const layered_picture *picture, int32_t first, int32_t last)
{
    float *sum = calloc(3 * picture->pixels, sizeof *sum);
    assert_non_null(sum);
    for (int32_t kind = first; kind <= last; kind++) {
        float *values;
        for (uint32_t number = 0; (values = layered_read(picture, kind, number)); number++) {
            for (size_t i = 0; i < 3 * picture->pixels; i++)
                sum[i] += values[i];
            free(values);
        }
    }
    return sum;
}

double layered_mean(const layered_picture *picture, int32_t kind, uint32_t number, uint32_t channel)
{
    float *values = layered_read(picture, kind, number);
    const bool is_single = kind == PPM_LAYER_PHOTON_DENSITY || kind == PPM_LAYER_RADIUS;
    const size_t stride = kind == PPM_LAYER_COMBINED ? 4 : is_single ? 1 : 3;
    double sum = 0.0;
    for (size_t i = 0; values && i < picture->pixels; i++)
        sum += (double)values[stride * i + channel];
    free(values);
    return sum / (double)picture->pixels;
}
