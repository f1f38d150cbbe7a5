/* What the light tree knows of each near light. */
#ifndef PPMI_LIGHT_LIGHT_BOUNDS_H
#define PPMI_LIGHT_LIGHT_BOUNDS_H

#include "light/tables.h"

/* power: of the tables. False for a light that shines nowhere. */
bool ppmi_light_bounds_of(const ppmi_lights *lights, uint32_t emitter, float power,
                          ppmi_light_bounds *out_bounds);

#endif
