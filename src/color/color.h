/* Colour conversions, through OpenColorIO. C interface of a C++ shim: no exception leaves it.
 * The public calls of ppm/color.h are implemented here too. */
#ifndef PPMI_COLOR_H
#define PPMI_COLOR_H

#include <stddef.h>
#include <stdint.h>

#include "base/context.h"
#include "ppm/color.h"

#ifdef __cplusplus
extern "C" {
#endif

/* The text of the configuration that is built in. */
const char *ppmi_color_builtin_config(void);

/* Scene-linear Rec.709 to a display and view, in place, on pixel_count RGBA pixels (alpha is not
 * touched, colours not premultiplied), after a factor of 2^exposure_ev. NULL or "" for display or
 * view means the default. Returns OK, NOT_FOUND, INPUT_INVALID, OUT_OF_MEMORY. */
ppm_status ppmi_color_to_display(ppm_context *context, const ppm_color *color, const char *display,
                                 const char *view, float exposure_ev, float *rgba,
                                 size_t pixel_count);

/* Table of the 256 8-bit code values of sRGB-encoded textures as linear values. color may be NULL
 * (built in). Rec.709 primaries on both sides, so one table serves the three channels. */
ppm_status ppmi_color_srgb_decode_table(ppm_context *context, const ppm_color *color,
                                        float out_linear[256]);

/* sRGB-encoded floats to linear Rec.709, in place, on pixel_count pixels of 3 or 4 channels (the
 * fourth is left alone). */
ppm_status ppmi_color_srgb_decode(ppm_context *context, const ppm_color *color, float *pixels,
                                  size_t pixel_count, uint32_t channels);

/* "OpenColorIO 2.1.2". Static. */
const char *ppmi_color_version(void);

#ifdef __cplusplus
}
#endif

#endif
