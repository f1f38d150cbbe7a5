/* Light profiles in IESNA LM-63 files (1986, 1991, 1995, 2002, 2019). */
#ifndef PPMI_IES_H
#define PPMI_IES_H

#include "base/context.h"

/* As ppm_light_profile_desc wants it. */
typedef struct ppmi_ies_profile {
    uint32_t polar_count, azimuth_count;
    float *polar_rad, *azimuth_rad, *candela;
    float turn_rad; /* azimuth 0 lies this far from +X towards +Y */
} ppmi_ies_profile;

/* Parses a file of count bytes. Returns OK, INPUT_INVALID or OUT_OF_MEMORY, unreported; *out_reason
 * then says what is wrong. Free with ppmi_ies_deinit, after a failure too. */
ppm_status ppmi_ies_parse(ppm_context *context, const char *text, size_t count,
                          ppmi_ies_profile *out_profile, const char **out_reason);
void ppmi_ies_deinit(ppm_context *context, ppmi_ies_profile *profile);

#endif
