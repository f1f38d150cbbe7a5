/* The colour of a black body: Planck's law, seen by the CIE 1931 observer in the fits of Wyman,
 * Sloan and Shirley 2013, "Simple Analytic Approximations to the CIE XYZ Color Matching Functions"
 * (JCGT 2(2), multi-lobe fit, equation 4), as linear Rec.709 (IEC 61966-2-1's matrix) with a
 * luminance of 1. Below 1900 K or so blue would be negative: the colour lies outside of Rec.709,
 * and is cut off at 0. */
#include <math.h>

#include "setup/setup_file.h"

static double lobe(double nm, double middle, double below, double above)
{
    const double t = (nm - middle) / (nm < middle ? below : above);
    return exp(-0.5 * t * t);
}

static void observer(double nm, double out[3])
{
    out[0] = 1.056 * lobe(nm, 599.8, 37.9, 31.0) + 0.362 * lobe(nm, 442.0, 16.0, 26.7) -
             0.065 * lobe(nm, 501.1, 20.4, 26.2);
    out[1] = 0.821 * lobe(nm, 568.8, 46.9, 40.5) + 0.286 * lobe(nm, 530.9, 16.3, 31.1);
    out[2] = 1.217 * lobe(nm, 437.0, 11.8, 36.0) + 0.681 * lobe(nm, 459.0, 26.0, 13.8);
}

/* Spectral radiance up to a factor that all wavelengths share; c2 = h c / k. */
static double planck(double nm, double kelvin)
{
    const double c2_nm_k = 1.438776877e7;
    const double x = 560.0 / nm;
    return x * x * x * x * x * expm1(c2_nm_k / (560.0 * kelvin)) / expm1(c2_nm_k / (nm * kelvin));
}

void ppmi_setup_black_body(double kelvin, double out_rgb[3])
{
    static const double to_rgb[3][3] = {{3.2406255, -1.5372080, -0.4986286},
                                        {-0.9689307, 1.8757561, 0.0415175},
                                        {0.0557101, -0.2040211, 1.0569959}};
    double xyz[3] = {0.0, 0.0, 0.0};
    for (int nm = 360; nm <= 830; nm++) {
        double weight[3];
        const double radiance = planck(nm, kelvin);
        observer(nm, weight);
        for (int i = 0; i < 3; i++)
            xyz[i] += radiance * weight[i];
    }
    for (int i = 0; i < 3; i++) {
        const double *row = to_rgb[i];
        out_rgb[i] = fmax(row[0] * xyz[0] + row[1] * xyz[1] + row[2] * xyz[2], 0.0);
    }
    const double luminance = 0.2126 * out_rgb[0] + 0.7152 * out_rgb[1] + 0.0722 * out_rgb[2];
    for (int i = 0; i < 3; i++)
        out_rgb[i] /= luminance;
}
