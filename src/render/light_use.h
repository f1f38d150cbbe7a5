/* Which lights' photons the picture has light of. */
#ifndef PPMI_RENDER_LIGHT_USE_H
#define PPMI_RENDER_LIGHT_USE_H

#include "photon/walk.h"
#include "render/integrator.h"

/* Counts the photons of a walk by light; sums: of each photon, what it brought. *out_uses is
 * allocated (and what it held freed), the names are the scene's. False when memory is out. */
bool ppmi_light_uses_count(const ppmi_job *job, const ppmi_aim *aim, const ppmi_photon_walk *walk,
                           const uint64_t *sums, ppm_light_use **out_uses, uint32_t *out_count);

#endif
