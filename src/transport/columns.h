/* Where there may be a solid around a light: what photons that begin there have to ask.
 *
 * A solid is looked for upwards (transport/solid.h), so whatever is in one lies in the box around
 * it or, where it is an open sheet, below. A few boxes that reach down without end hold all such
 * places; few lights have photons that begin in them. */
#ifndef PPMI_TRANSPORT_COLUMNS_H
#define PPMI_TRANSPORT_COLUMNS_H

#include "scene/scene.h"

enum { PPMI_COLUMNS_MAX = 16 };

typedef struct ppmi_columns {
    uint32_t count;
    ppmi_vec3 low[PPMI_COLUMNS_MAX], high[PPMI_COLUMNS_MAX]; /* low.y is not used */
} ppmi_columns;

/* Over the whole shutter. */
void ppmi_columns_init(ppmi_columns *columns, const ppm_scene *scene);

static inline bool ppmi_columns_hold(const ppmi_columns *columns, ppmi_vec3 p)
{
    for (uint32_t i = 0; i < columns->count; i++) {
        const ppmi_vec3 *low = &columns->low[i], *high = &columns->high[i];
        if (p.x >= low->x && p.x <= high->x && p.z >= low->z && p.z <= high->z && p.y <= high->y) {
            return true;
        }
    }
    return false;
}

#endif
