/* Wavelengths for dispersion: an index of refraction by wavelength, and the share of a wavelength
 * in the channels of the working space.
 *
 * A path is carried in RGB until its first dispersive refraction; it then draws one wavelength and
 * keeps it. The weights have mean 1 in every channel, so that all wavelengths together are white.
 */
#ifndef PPMI_SHADING_SPECTRUM_H
#define PPMI_SHADING_SPECTRUM_H

#include "base/working_space.h"
#include "math/vec.h"

enum { PPMI_SPECTRUM_FIRST_NM = 385, PPMI_SPECTRUM_LAST_NM = 725, PPMI_SPECTRUM_BINS = 340 };

typedef struct ppmi_spectrum {
    ppmi_vec3 weight[PPMI_SPECTRUM_BINS]; /* of the bin's nanometre */
    float cumulative[PPMI_SPECTRUM_BINS + 1];
} ppmi_spectrum;

void ppmi_spectrum_init(ppmi_spectrum *spectrum, const ppmi_working_space *space);

/* Draws a wavelength, nm, in proportion to its share in the three channels together. */
float ppmi_spectrum_sample(const ppmi_spectrum *spectrum, float u);

/* Weight of a drawn wavelength by channel: its channels' mean is 1, none is negative. */
ppmi_vec3 ppmi_spectrum_weight(const ppmi_spectrum *spectrum, float wavelength_nm);

/* Cauchy's n = A + B / lambda^2 through index at 587.6 nm, with n_F - n_C = (index - 1) / V_d;
 * dispersion is 20 / V_d (KHR_materials_dispersion). */
float ppmi_cauchy_index(float index, float dispersion, float wavelength_nm);

#endif
