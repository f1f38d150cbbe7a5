/* Which candidate each pixel takes. */
#ifndef PPMI_DENOISE_CHOICE_H
#define PPMI_DENOISE_CHOICE_H

#include "denoise/nl_means.h"

/* Mixes the candidates into light, 3 floats a pixel, where one of them has less risk than no
 * filter. is_blurred: as in ppmi_denoise_noise. Spoils their risks; scratch: one float a pixel. */
void ppmi_denoise_choose(uint32_t width, uint32_t height,
                         const ppmi_nl_output candidates[PPMI_DENOISE_CANDIDATES], bool is_blurred,
                         float *scratch, float *light);

/* A box of (2 radius + 1)^2 pixels, of those inside the picture. */
void ppmi_denoise_blur(uint32_t width, uint32_t height, int radius, float *values, float *scratch);

#endif
