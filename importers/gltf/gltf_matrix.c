#include "gltf/gltf_matrix.h"

#include <math.h>
#include <string.h>

void ppmi_gltf_matrix_multiply(const double a[16], const double b[16], double out[16])
{
    for (int column = 0; column < 4; ++column) {
        for (int row = 0; row < 4; ++row) {
            double sum = 0.0;
            for (int k = 0; k < 4; ++k) {
                sum += a[4 * k + row] * b[4 * column + k];
            }
            out[4 * column + row] = sum;
        }
    }
}

void ppmi_gltf_matrix_apply(const double m[16], const double point[3], double out[3])
{
    double sum[3];
    for (int i = 0; i < 3; ++i)
        sum[i] = m[i] * point[0] + m[4 + i] * point[1] + m[8 + i] * point[2] + m[12 + i];
    for (int i = 0; i < 3; ++i)
        out[i] = sum[i];
}

void ppmi_gltf_matrix_compose(const double t[3], const double r[4], const double s[3],
                              double out[16])
{
    const double length = sqrt(r[0] * r[0] + r[1] * r[1] + r[2] * r[2] + r[3] * r[3]);
    const bool is_rotation = length > 0.0 && isfinite(length);
    const double x = is_rotation ? r[0] / length : 0.0, y = is_rotation ? r[1] / length : 0.0;
    const double z = is_rotation ? r[2] / length : 0.0, w = is_rotation ? r[3] / length : 1.0;
    const double m[16] = {s[0] * (1.0 - 2.0 * (y * y + z * z)),
                          s[0] * 2.0 * (x * y + z * w),
                          s[0] * 2.0 * (x * z - y * w),
                          0.0,
                          s[1] * 2.0 * (x * y - z * w),
                          s[1] * (1.0 - 2.0 * (x * x + z * z)),
                          s[1] * 2.0 * (y * z + x * w),
                          0.0,
                          s[2] * 2.0 * (x * z + y * w),
                          s[2] * 2.0 * (y * z - x * w),
                          s[2] * (1.0 - 2.0 * (x * x + y * y)),
                          0.0,
                          t[0],
                          t[1],
                          t[2],
                          1.0};
    memcpy(out, m, sizeof m);
}

double ppmi_gltf_matrix_determinant(const double m[16])
{
    return m[0] * (m[5] * m[10] - m[6] * m[9]) - m[1] * (m[4] * m[10] - m[6] * m[8]) +
           m[2] * (m[4] * m[9] - m[5] * m[8]);
}

bool ppmi_gltf_matrix_to_floats(const double m[16], float out[16])
{
    for (int i = 0; i < 16; ++i) {
        if (!(fabs(m[i]) < 1e30)) return false;
        out[i] = (float)m[i];
    }
    return true;
}

/* Of a matrix whose columns are orthonormal: Shepperd, "Quaternion from rotation matrix", Journal
 * of Guidance and Control 1 (3), 1978. The largest component is found first, for accuracy. */
static void to_quaternion(const double c[3][3], double q[4])
{
    const double trace = c[0][0] + c[1][1] + c[2][2];
    int largest = 3;
    double most = trace;
    for (int i = 0; i < 3; ++i) {
        if (c[i][i] > most) {
            most = c[i][i];
            largest = i;
        }
    }
    if (largest == 3) {
        q[0] = c[1][2] - c[2][1];
        q[1] = c[2][0] - c[0][2];
        q[2] = c[0][1] - c[1][0];
        q[3] = 1.0 + trace;
    } else {
        const int i = largest, j = (i + 1) % 3, k = (i + 2) % 3;
        q[i] = 1.0 + c[i][i] - c[j][j] - c[k][k];
        q[j] = c[i][j] + c[j][i];
        q[k] = c[i][k] + c[k][i];
        q[3] = c[j][k] - c[k][j];
    }
    const double length = sqrt(q[0] * q[0] + q[1] * q[1] + q[2] * q[2] + q[3] * q[3]);
    for (int i = 0; i < 4; ++i) {
        q[i] /= length;
    }
}

void ppmi_gltf_matrix_decompose(const double m[16], double t[3], double r[4], double s[3])
{
    double columns[3][3];
    bool is_regular = true;
    for (int i = 0; i < 3; ++i) {
        t[i] = m[12 + i];
        s[i] =
            sqrt(m[4 * i] * m[4 * i] + m[4 * i + 1] * m[4 * i + 1] + m[4 * i + 2] * m[4 * i + 2]);
        is_regular = is_regular && s[i] > 0.0;
    }
    if (ppmi_gltf_matrix_determinant(m) < 0.0) s[0] = -s[0];
    r[0] = r[1] = r[2] = 0.0;
    r[3] = 1.0;
    if (!is_regular) return;
    for (int i = 0; i < 3; ++i) {
        for (int k = 0; k < 3; ++k) {
            columns[i][k] = m[4 * i + k] / s[i];
        }
    }
    to_quaternion(columns, r);
}
