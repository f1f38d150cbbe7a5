/* Which medium fills a segment of a path, and how far it reaches. */
#ifndef PPMI_TRANSPORT_MEDIA_H
#define PPMI_TRANSPORT_MEDIA_H

#include "transport/world.h"

/* A part of a ray that lies in one medium: begin .. end, in lengths of its unit direction. */
typedef struct ppmi_medium_span {
    const ppmi_medium *medium; /* NULL: nothing is in the way */
    float begin, end;
} ppmi_medium_span;

/* The part of the ray, up to t_max (may be infinite), that lies in the medium of interior: that of
 * the solid, or the fog outside of all solids. A solid without an end is open, and taken as empty.
 * Further media (heterogeneous ones, several around the scene) come in here. */
ppmi_medium_span ppmi_media_span(const ppmi_world *world, const ppmi_interior *interior,
                                 const ppmi_ray *ray, float t_max);

#endif
