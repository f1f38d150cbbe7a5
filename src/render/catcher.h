/* Catchers: things of a photograph that show only what light all else adds to them or takes. */
#ifndef PPMI_RENDER_CATCHER_H
#define PPMI_RENDER_CATCHER_H

#include <stddef.h>

/* Takes out of a picture what a photograph of its catchers holds already.
 *
 * catchers  what the picture shows of them, alpha is their coverage c
 * plate     the same where they are alone
 * rgba      the picture, premultiplied, with catchers opaque; changed in place
 *
 * With C the catchers' colour, P the plate's at their coverage, and k the least C / P of the
 * channels, at most 1: the picture loses k (P, c). Over the plate, what is left is the picture as
 * it was, since alpha lets k c of the plate through. Shadows (k < 1) are alpha then, and light that
 * is added (C > P), or takes a colour away less than the others, is colour without alpha. */
void ppmi_catcher_take_plate(const float *catchers, const float *plate, size_t pixel_count,
                             float *rgba);

#endif
