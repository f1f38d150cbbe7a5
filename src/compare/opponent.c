/* Colour spaces of Andersson, Nilsson, Akenine-Moller, Oskarsson, Astrom and Fairchild, "FLIP: A
 * Difference Evaluator for Alternating Images" (HPG 2020), section 4.1.
 *
 * YCxCz is CIELAB without its cube root, so that filtering it mixes light (Flohr et al. 1993). The
 * Hunt effect is Hunt 1952, HyAB Abasi, Tehran and Fairchild 2020. Rec.709 to XYZ follows from the
 * primaries and the white (0.3127, 0.3290) of ITU-R BT.709. All XYZ here are over the white's. */
#include "compare/opponent.h"

#include <math.h>

static void multiply(const double matrix[3][3], const float in[3], float out[3])
{
    float result[3];
    for (int row = 0; row < 3; row++) {
        result[row] = (float)(matrix[row][0] * (double)in[0] + matrix[row][1] * (double)in[1] +
                              matrix[row][2] * (double)in[2]);
    }
    for (int row = 0; row < 3; row++)
        out[row] = result[row];
}

/* Rows of the matrix to XYZ over their sums, which are the white. */
static const double white[3] = {0.9504559270516716, 1.0, 1.0890577507598784};

void ppmi_compare_rgb_to_xyz(const float rgb[3], float xyz[3])
{
    static const double matrix[3][3] = {
        {0.4123907992659595 / 0.9504559270516716, 0.3575843393838780 / 0.9504559270516716,
         0.1804807884018343 / 0.9504559270516716},
        {0.2126390058715104, 0.7151686787677559, 0.0721923153607337},
        {0.0193308187155918 / 1.0890577507598784, 0.1191947797946259 / 1.0890577507598784,
         0.9505321522496608 / 1.0890577507598784},
    };
    multiply(matrix, rgb, xyz);
}

void ppmi_compare_xyz_to_rgb(const float xyz[3], float rgb[3])
{
    static const double matrix[3][3] = {
        {3.2409699419045213, -1.5373831775700935, -0.4986107602930033},
        {-0.9692436362808798, 1.8759675015077206, 0.0415550574071756},
        {0.0556300796969936, -0.2039769588889765, 1.0569715142428784},
    };
    const float absolute[3] = {(float)((double)xyz[0] * white[0]),
                               (float)((double)xyz[1] * white[1]),
                               (float)((double)xyz[2] * white[2])};
    multiply(matrix, absolute, rgb);
}

void ppmi_compare_xyz_to_ycxcz(const float xyz[3], float ycxcz[3])
{
    ycxcz[0] = 116 * xyz[1] - 16;
    ycxcz[1] = 500 * (xyz[0] - xyz[1]);
    ycxcz[2] = 200 * (xyz[1] - xyz[2]);
}

void ppmi_compare_ycxcz_to_xyz(const float ycxcz[3], float xyz[3])
{
    xyz[1] = (ycxcz[0] + 16) / 116;
    xyz[0] = xyz[1] + ycxcz[1] / 500;
    xyz[2] = xyz[1] - ycxcz[2] / 200;
}

/* CIE 15: the cube root, with a straight line near black. */
static float lab_curve(float value)
{
    const float delta = 6.0f / 29.0f;
    if (value > delta * delta * delta) return cbrtf(value);
    return value / (3 * delta * delta) + 4.0f / 29.0f;
}

void ppmi_compare_xyz_to_lab(const float xyz[3], float lab[3])
{
    const float x = lab_curve(xyz[0]), y = lab_curve(xyz[1]), z = lab_curve(xyz[2]);
    lab[0] = 116 * y - 16;
    lab[1] = 500 * (x - y);
    lab[2] = 200 * (y - z);
}

void ppmi_compare_hunt(const float lab[3], float adjusted[3])
{
    const float colourfulness = 0.01f * lab[0];
    adjusted[0] = lab[0];
    adjusted[1] = colourfulness * lab[1];
    adjusted[2] = colourfulness * lab[2];
}

float ppmi_compare_hyab(const float first[3], const float second[3])
{
    const float a = first[1] - second[1], b = first[2] - second[2];
    return fabsf(first[0] - second[0]) + sqrtf(a * a + b * b);
}

/* IEC 61966-2-1 */
float ppmi_compare_srgb_decode(float code)
{
    return code <= 0.04045f ? code / 12.92f : powf((code + 0.055f) / 1.055f, 2.4f);
}
