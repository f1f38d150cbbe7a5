/* The geometric mean is what a photographer's eye averages: a lamp in the picture or a black
 * backdrop hardly moves it. */
#include "brightness.h"

#include <math.h>
#include <stdlib.h>

static const double STOPS_TOLERATED = 4.0;
static const double MIDDLE_GREY = 0.18;

static double luminance(const float *rgb)
{
    return 0.2126 * (double)rgb[0] + 0.7152 * (double)rgb[1] + 0.0722 * (double)rgb[2];
}

double brightness_stops_over_grey(const float *rgba, size_t pixel_count)
{
    double sum = 0.0;
    size_t count = 0;
    for (size_t i = 0; i < pixel_count; i++) {
        const float *const pixel = &rgba[4 * i];
        const double value = luminance(pixel);
        if (!(pixel[3] > 0.0f) || !(value > 0.0) || !isfinite(value)) continue;
        sum += log2(value / MIDDLE_GREY);
        count++;
    }
    return count > 0 ? sum / (double)count : NAN;
}

void brightness_advise(cli_console *console, const ppm_render *render, double exposure_ev)
{
    const uint32_t *const crop = ppm_render_get_options(render)->crop;
    const size_t pixel_count = (size_t)(crop[2] - crop[0]) * (crop[3] - crop[1]);
    float *const rgba = calloc(pixel_count, 4 * sizeof *rgba);
    /* without memory for it there is no advice; the pictures are written already */
    if (rgba && ppm_render_read_image(render, rgba, 4 * pixel_count) == PPM_STATUS_OK) {
        const double stops = brightness_stops_over_grey(rgba, pixel_count) + exposure_ev;
        if (fabs(stops) > STOPS_TOLERATED) {
            console_message(console, PPM_LOG_INFO,
                            "the picture is about %.0f stops %s middle grey; try --exposure %.0f",
                            fabs(stops), stops > 0.0 ? "above" : "below", exposure_ev - stops);
        }
    }
    free(rgba);
}
