/* Colour conversions, through OpenColorIO. C interface of a C++ shim: no exception leaves it.
 * The public calls of ppm/color.h are implemented here too. */
#ifndef PPMI_COLOR_H
#define PPMI_COLOR_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#include "base/context.h"
#include "base/working_space.h"
#include "ppm/color.h"

#ifdef __cplusplus
extern "C" {
#endif

/* The text of the configuration that is built in. */
const char *ppmi_color_builtin_config(void);

/* The working space of color; linear Rec.709 for NULL. */
const ppmi_working_space *ppmi_color_working_space(const ppm_color *color);

/* What a picture is shown by. NULL or "" for a name means its default, for the look the view's own;
 * "none" for the look means none. gamma 0 is 1. */
typedef struct ppmi_view_choice {
    const char *display, *view, *look;
    float exposure_ev, gamma;
} ppmi_view_choice;

/* The same, as the configuration writes it; valid as long as the choice and the configuration. look
 * NULL: the view's own; "": none. */
typedef struct ppmi_view_names {
    const char *display, *view, *look;
} ppmi_view_names;

/* Returns OK, NOT_FOUND, INPUT_INVALID (there is no display or view at all). */
ppm_status ppmi_color_choose_view(ppm_context *context, const ppm_color *color,
                                  const ppmi_view_choice *choice, ppmi_view_names *out_names);

/* Scene-linear values of from to a display and view, in place, on pixel_count RGBA pixels (alpha is
 * not touched, colours not premultiplied): times 2^exposure_ev, the look, the view, and to the
 * power of 1 / gamma. Returns OK, NOT_FOUND, INPUT_INVALID, OUT_OF_MEMORY. */
ppm_status ppmi_color_show(ppm_context *context, const ppm_color *color,
                           const ppmi_view_choice *choice, const ppmi_working_space *from,
                           float *rgba, size_t pixel_count);

/* What the values of a picture of colours are. */
enum {
    PPMI_INPUT_SRGB,      /* sRGB-encoded */
    PPMI_INPUT_REC709,    /* linear Rec.709 */
    PPMI_INPUT_PRIMARIES, /* linear, of the file's own primaries */
    PPMI_INPUT_NUMBERS,   /* no colours: taken as they are */
    PPMI_INPUT_SPACE      /* a space of the configuration */
};

typedef struct ppmi_color_input {
    int32_t kind;      /* PPMI_INPUT_ */
    const char *space; /* of SPACE */
} ppmi_color_input;

/* By the rules that color was made with, what the file says itself (a space, or primaries), the
 * rules of the configuration, else as is usual for a file that is_linear or not. path (or another
 * name of the picture), space_in_file and chromaticities may be NULL. */
ppmi_color_input ppmi_color_choose_input(const ppm_color *color, const char *path, bool is_linear,
                                         const char *space_in_file, const float chromaticities[8]);

/* To the working space, in place, on pixel_count pixels of 3 or 4 channels. What the working space
 * does not hold becomes negative. The first returns OK, INPUT_INVALID, OUT_OF_MEMORY; the last
 * false for primaries that span no space, with nothing done. */
ppm_status ppmi_color_from_space(ppm_context *context, const ppm_color *color, const char *space,
                                 float *pixels, size_t pixel_count, uint32_t channels);
void ppmi_color_from_rec709(const ppm_color *color, float *pixels, size_t pixel_count,
                            uint32_t channels);
bool ppmi_color_from_primaries(const ppm_color *color, const float chromaticities[8], float *pixels,
                               size_t pixel_count, uint32_t channels);

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
