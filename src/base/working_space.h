/* The space that colours are carried in from the scene to the picture, as numbers: scene-linear,
 * with primaries of its own. All zero: linear Rec.709, which is what the public API takes.
 *
 * Matrices are 3x3, row by row. */
#ifndef PPMI_WORKING_SPACE_H
#define PPMI_WORKING_SPACE_H

#include <stdbool.h>

#ifdef __cplusplus
extern "C" {
#endif

typedef struct ppmi_working_space {
    bool differs;        /* from linear Rec.709: else nothing below but names is used */
    char name[128];      /* as the configuration has it */
    char interop_id[32]; /* of the Color Interop Forum; "": it has none */
    float from_rec709[9], to_rec709[9];
    float from_xyz[9];       /* of D65 */
    float chromaticities[8]; /* red, green, blue, white */
} ppmi_working_space;

/* Linear Rec.709. */
extern const ppmi_working_space ppmi_working_space_rec709;

/* out may be in. */
void ppmi_matrix_apply(const float matrix[9], const float in[3], float out[3]);

/* A colour of the public API. Nothing becomes negative; a reflectance stays one. */
void ppmi_working_light(const ppmi_working_space *space, const float rec709[3], float out[3]);
void ppmi_working_reflectance(const ppmi_working_space *space, const float rec709[3], float out[3]);

/* Coefficients by channel of a medium, 1/m. They are no colours; what they leave of a beam, and
 * what they scatter of the rest, is: both are converted after a mean free path. */
void ppmi_working_medium(const ppmi_working_space *space, const float sigma_s[3],
                         const float sigma_a[3], float out_sigma_s[3], float out_sigma_a[3]);

#ifdef __cplusplus
}
#endif

#endif
