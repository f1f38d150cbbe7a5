/* The colour spaces of FLIP: linear Rec.709, YCxCz, and CIELAB under the Hunt effect. */
#ifndef PPMI_COMPARE_OPPONENT_H
#define PPMI_COMPARE_OPPONENT_H

/* Linear Rec.709 to CIE XYZ over that of the white (D65), so that white is (1, 1, 1). */
void ppmi_compare_rgb_to_xyz(const float rgb[3], float xyz[3]);
/* The inverse; not clamped. */
void ppmi_compare_xyz_to_rgb(const float xyz[3], float rgb[3]);

/* XYZ over white to YCxCz and back: achromatic 0 (white: 100), red-green, blue-yellow; linear. */
void ppmi_compare_xyz_to_ycxcz(const float xyz[3], float ycxcz[3]);
void ppmi_compare_ycxcz_to_xyz(const float ycxcz[3], float xyz[3]);

/* XYZ over white to CIELAB. */
void ppmi_compare_xyz_to_lab(const float xyz[3], float lab[3]);
/* CIELAB to the same with a and b times 0.01 L: colours look the less colourful the darker they
 * are. */
void ppmi_compare_hunt(const float lab[3], float adjusted[3]);
/* The HyAB distance: city-block in lightness, Euclidean in a and b. */
float ppmi_compare_hyab(const float first[3], const float second[3]);

/* A display's code value, 0..1, to linear light. */
float ppmi_compare_srgb_decode(float code);

#endif
