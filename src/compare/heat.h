/* Heat maps: an error for each pixel, as a picture. */
#ifndef PPMI_COMPARE_HEAT_H
#define PPMI_COMPARE_HEAT_H

#include <stdint.h>

#include "base/context.h"

/* The colour of a share 0..1 (clamped), as a display's values: black, violet, orange, pale yellow.
 */
void ppmi_compare_heat_colour(double share, float rgb[3]);

/* The value that 99 of 100 of the unbroken values do not exceed. sorted: room for count floats. */
double ppmi_compare_heat_top(const float *values, const uint8_t *is_broken, size_t count,
                             float *sorted);

/* Writes width * height values. For a display (.png, .jpg, .tif) as colours, top or more being the
 * brightest, and broken pixels green; .exr gets the values themselves as channel Y, broken ones
 * NaN. top: above 0. Returns as ppmi_imageio_write_file. */
ppm_status ppmi_compare_heat_write(ppm_context *context, const char *path, const float *values,
                                   const uint8_t *is_broken, uint32_t width, uint32_t height,
                                   double top);

#endif
