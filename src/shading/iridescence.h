/* Reflectance of a thin film on a base. */
#ifndef PPMI_SHADING_IRIDESCENCE_H
#define PPMI_SHADING_IRIDESCENCE_H

#include "base/working_space.h"
#include "math/vec.h"

/* By channel, 0..1, of white light that falls from outside (index 1) at cosine onto a film of
 * the given index and thickness over a base whose reflectance without it, at normal incidence, is
 * base_f0. Beside total interference the film takes nothing away.
 * space: whose channels. */
ppmi_vec3 ppmi_film_reflectance(float film_ior, float thickness_nm, ppmi_vec3 base_f0, float cosine,
                                const ppmi_working_space *space);

#endif
