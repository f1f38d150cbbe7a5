/* Tone maps that are published as formulas, on linear Rec.709; exact, where a table would not be.
 */
#ifndef PPMI_COLOR_TONE_H
#define PPMI_COLOR_TONE_H

#include <stddef.h>

/* RGBA in place, to display-linear values of 0..1; alpha is left alone. */
typedef void ppmi_tone_map(float *rgba, size_t pixel_count);

ppmi_tone_map ppmi_tone_neutral, ppmi_tone_agx;

/* The one that a view of the built-in configuration is called after, or NULL. */
ppmi_tone_map *ppmi_tone_of_view(const char *view);

#endif
