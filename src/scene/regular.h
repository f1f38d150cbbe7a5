/* Transforms that can be undone: rays are taken to where a mesh was modelled.
 *
 * A scale of 0 along one axis makes a flat shape, whose transform has no inverse. It is given a
 * thickness that single precision just tells from 0. */
#ifndef PPMI_SCENE_REGULAR_H
#define PPMI_SCENE_REGULAR_H

#include "math/transform.h"

#ifdef __cplusplus
extern "C" {
#endif

/* Gives a flat transform its thickness; others stay to the bit. False, with nothing changed, where
 * the rank is below 2: a line or a point, of which nothing is to be seen. */
bool ppmi_make_regular(ppmi_transform *m);

/* Least factor by which a regular transform stretches any direction. */
double ppmi_least_stretch(const ppmi_transform *m);

/* Whether all transforms on the straight way between two regular ones have an inverse: a half turn
 * and a mirroring pass through flat ones. */
bool ppmi_stays_regular(const ppmi_transform *a, const ppmi_transform *b);

#ifdef __cplusplus
}
#endif

#endif
