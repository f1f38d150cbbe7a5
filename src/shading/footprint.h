/* Ray differentials: how a ray changes from one pixel to the next, through mirrors and glass, and
 * so how much of a surface one sample of the picture stands for (Igehy 1999, "Tracing Ray
 * Differentials"). */
#ifndef PPMI_SHADING_FOOTPRINT_H
#define PPMI_SHADING_FOOTPRINT_H

#include "shading/surface.h"

/* Of a ray along direction: change of its position and direction by one step in x and in y of the
 * picture. */
typedef struct ppmi_differential {
    bool is_known;     /* false: a path of no pixel (photons), or nothing that needs it; the rest is
                          not read then */
    bool is_scattered; /* the path had a rough bounce: its footprint is a lobe's, not the pixel's */
    ppmi_vec3 direction;
    ppmi_vec3 position_dx, position_dy;   /* metres */
    ppmi_vec3 direction_dx, direction_dy; /* of the unit direction */
} ppmi_differential;

/* Copies what there is: most scenes have no use for the rest. */
static inline void ppmi_differential_copy(ppmi_differential *to, const ppmi_differential *from)
{
    to->is_known = from->is_known;
    if (from->is_known) *to = *from;
}

/* Moves on along the ray. */
void ppmi_differential_advance(ppmi_differential *differential, float distance);

/* Moves on along the ray to a surface at that distance: positions come to lie in its plane, and the
 * surface learns its footprint. */
void ppmi_differential_meet(ppmi_differential *differential, float distance, ppmi_surface *surface);

/* What leaves in direction wi off a mirror or through smooth glass: relative_index is that beyond
 * the surface by this side; 1 for a sheet. */
void ppmi_differential_reflect(ppmi_differential *differential, const ppmi_surface *surface,
                               ppmi_vec3 wi);
void ppmi_differential_refract(ppmi_differential *differential, const ppmi_surface *surface,
                               float relative_index, ppmi_vec3 wi);

/* What leaves by a rough bounce that draws wi with density pdf by solid angle. */
void ppmi_differential_scatter(ppmi_differential *differential, ppmi_vec3 wi, float pdf);

#endif
