/* The light pilot: before the first pass, what lights do is tried where the camera's paths go. */
#ifndef PPMI_RENDER_LIGHT_PILOT_H
#define PPMI_RENDER_LIGHT_PILOT_H

#include "render/integrator.h"

/* Teaches lights, which the job's world reads, where there is something to choose; adds its rays to
 * stats. It does not depend on the crop or the threads. Returns OK, OUT_OF_MEMORY, CANCELLED. */
ppm_status ppmi_light_pilot(const ppmi_job *job, ppmi_lights *lights, ppm_render_stats *stats);

#endif
