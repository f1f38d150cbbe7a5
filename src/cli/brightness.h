/* A word of advice when a picture would come out black or white. */
#ifndef PPM_CLI_BRIGHTNESS_H
#define PPM_CLI_BRIGHTNESS_H

#include <stddef.h>

#include "console.h"
#include "ppm/render.h"

/* Says, at INFO, which --exposure would bring a picture that is far off into view. */
void brightness_advise(cli_console *console, const ppm_render *render, double exposure_ev);

/* log2 of the geometric mean luminance over middle grey (0.18), of the pixels that are neither
 * black nor transparent; NaN when there are none. rgba holds 4 * pixel_count floats. */
double brightness_stops_over_grey(const float *rgba, size_t pixel_count);

#endif
