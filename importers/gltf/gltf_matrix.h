/* Transforms of nodes: 4x4 matrices by columns, in double precision. */
#ifndef PPMI_GLTF_MATRIX_H
#define PPMI_GLTF_MATRIX_H

#include <stdbool.h>

void ppmi_gltf_matrix_multiply(const double a[16], const double b[16], double out[16]);

/* m applied to a point; out may be a part of m. */
void ppmi_gltf_matrix_apply(const double m[16], const double point[3], double out[3]);

/* translation * rotation * scale. A quaternion need not have unit length; zero is no rotation. */
void ppmi_gltf_matrix_compose(const double translation[3], const double rotation[4],
                              const double scale[3], double out[16]);

/* The other way; what is sheared is lost. A mirrored matrix gets a negative scale in x. */
void ppmi_gltf_matrix_decompose(const double m[16], double translation[3], double rotation[4],
                                double scale[3]);

/* Of the upper left 3x3. */
double ppmi_gltf_matrix_determinant(const double m[16]);

/* False when a value is too large for a float. */
bool ppmi_gltf_matrix_to_floats(const double m[16], float out[16]);

#endif
