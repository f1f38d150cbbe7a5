/* Vertices that are the same but for their number. */
#ifndef PPMI_TANGENT_WELD_H
#define PPMI_TANGENT_WELD_H

#include "tangent/tangent.h"

/* out[v] becomes the first vertex with the position, normal and coordinates of v. False when memory
 * is out. */
bool ppmi_tangent_weld(ppm_context *context, const ppmi_tangent_mesh *mesh, uint32_t *out);

#endif
