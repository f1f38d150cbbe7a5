/* Primaries of RGB spaces as chromaticities and as matrices (SMPTE RP 177), and the spaces that are
 * known by them. Matrices are 3x3, row by row. */
#ifndef PPMI_COLOR_PRIMARIES_H
#define PPMI_COLOR_PRIMARIES_H

#include <stdbool.h>

/* x and y of red, green, blue and white. */
typedef struct ppmi_primaries {
    double xy[8];
} ppmi_primaries;

typedef struct ppmi_known_primaries {
    const char *interop_id; /* of scene-linear values (ASWF Color Interop Forum) */
    ppmi_primaries primaries;
} ppmi_known_primaries;

extern const ppmi_primaries ppmi_primaries_rec709, ppmi_primaries_p3_d65, ppmi_primaries_rec2020;

/* The known spaces; NULL past the end. */
const ppmi_known_primaries *ppmi_primaries_known(int index);

/* RGB to XYZ, white at Y = 1. False where they span no space. */
bool ppmi_primaries_to_xyz(const ppmi_primaries *primaries, double out[9]);

/* XYZ under one white to XYZ under another, whites as x and y: Bradford (Lam 1985; ICC.1, Annex E).
 */
void ppmi_white_adaptation(const double from_xy[2], const double to_xy[2], double out[9]);

/* RGB of from to RGB of to, by Bradford adaptation. False where either spans no space. */
bool ppmi_primaries_between(const ppmi_primaries *from, const ppmi_primaries *to, double out[9]);

void ppmi_matrix_multiply(const double a[9], const double b[9], double out[9]);
bool ppmi_matrix_invert(const double m[9], double out[9]);

#endif
