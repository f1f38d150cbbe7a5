/* Layers that must not be filtered: what one ray meets, through the pixel's centre, of a pinhole,
 * in the middle of the shutter. A mean of distances or ids would be that of nothing. */
#ifndef PPMI_RENDER_FACTS_H
#define PPMI_RENDER_FACTS_H

#include "render/integrator.h"

enum { PPMI_FACT_FIRST = PPM_LAYER_POSITION, PPMI_FACT_LAST = PPM_LAYER_MOTION };
enum { PPMI_FACT_COUNT = PPMI_FACT_LAST - PPMI_FACT_FIRST + 1 };

/* Depth where nothing is met: what Blender writes. An infinity would spoil what is computed from
 * it. */
#define PPMI_FAR_DEPTH_M 1e10f

/* By kind from PPMI_FACT_FIRST on: channels side by side, a pixel after the other; NULL where the
 * layer is not wanted. */
typedef struct ppmi_facts {
    float *values[PPMI_FACT_COUNT];
} ppmi_facts;

/* Floats a pixel. */
uint32_t ppmi_fact_channels(int32_t kind);

/* Fills in one pixel of the film; returns the rays that it took. Alpha counts from one half on. */
uint64_t ppmi_facts_find(const ppmi_job *job, const ppmi_facts *facts, uint32_t x, uint32_t y);

#endif
