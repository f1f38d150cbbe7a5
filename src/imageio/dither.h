/* Noise that turns the banding of few bits into grain. */
#ifndef PPMI_IMAGEIO_DITHER_H
#define PPMI_IMAGEIO_DITHER_H

#include <stdint.h>

/* What to add to a value, both in steps of the file, before it is rounded to one of 0 .. top. x and
 * y are the pixel's place in the whole picture: a crop has the same noise, and so has a pixel of
 * any number of threads. A pixel's channels share it: greys stay grey. */
float ppmi_dither(uint32_t x, uint32_t y, float value, float top);

#endif
