/* The spectrum's table.
 *
 * Colour matching functions of the 1931 observer by Wyman, Sloan, Shirley 2013, "Simple Analytic
 * Approximations to the CIE XYZ Color Matching Functions" (JCGT 2.2), the multi-lobe fit. Spectral
 * colours lie outside of all primaries in use; their negative channels are taken as 0 and the
 * channels are then scaled to equal sums, so that light stays positive and the whole spectrum
 * white. */
#include "shading/spectrum.h"

static float lobe(float wavelength, float mean, float below, float above)
{
    const float t = (wavelength - mean) / (wavelength < mean ? below : above);
    return expf(-0.5f * t * t);
}

static ppmi_vec3 observer_xyz(float w)
{
    return vec3(1.056f * lobe(w, 599.8f, 37.9f, 31.0f) + 0.362f * lobe(w, 442.0f, 16.0f, 26.7f) -
                    0.065f * lobe(w, 501.1f, 20.4f, 26.2f),
                0.821f * lobe(w, 568.8f, 46.9f, 40.5f) + 0.286f * lobe(w, 530.9f, 16.3f, 31.1f),
                1.217f * lobe(w, 437.0f, 11.8f, 36.0f) + 0.681f * lobe(w, 459.0f, 26.0f, 13.8f));
}

/* XYZ to the working space, without what is negative. */
static ppmi_vec3 positive_rgb(const float m[9], ppmi_vec3 xyz)
{
    return vec3(ppmi_max(m[0] * xyz.x + m[1] * xyz.y + m[2] * xyz.z, 0.0f),
                ppmi_max(m[3] * xyz.x + m[4] * xyz.y + m[5] * xyz.z, 0.0f),
                ppmi_max(m[6] * xyz.x + m[7] * xyz.y + m[8] * xyz.z, 0.0f));
}

void ppmi_spectrum_init(ppmi_spectrum *spectrum, const ppmi_working_space *space)
{
    const float *to_rgb = (space->differs ? space : &ppmi_working_space_rec709)->from_xyz;
    ppmi_vec3 sum = vec3_splat(0.0f);
    for (int i = 0; i < PPMI_SPECTRUM_BINS; i++) {
        spectrum->weight[i] =
            positive_rgb(to_rgb, observer_xyz((float)(PPMI_SPECTRUM_FIRST_NM + i) + 0.5f));
        sum = vec3_add(sum, spectrum->weight[i]);
    }
    const ppmi_vec3 scale = vec3(1.0f / sum.x, 1.0f / sum.y, 1.0f / sum.z);
    spectrum->cumulative[0] = 0.0f;
    for (int i = 0; i < PPMI_SPECTRUM_BINS; i++) {
        const ppmi_vec3 share = vec3_mul(spectrum->weight[i], scale);
        const float probability = vec3_mean(share);
        spectrum->cumulative[i + 1] = spectrum->cumulative[i] + probability;
        spectrum->weight[i] = vec3_scale(share, probability > 0.0f ? 1.0f / probability : 0.0f);
    }
    spectrum->cumulative[PPMI_SPECTRUM_BINS] = 1.0f;
}

float ppmi_spectrum_sample(const ppmi_spectrum *spectrum, float u)
{
    int low = 0, high = PPMI_SPECTRUM_BINS;
    while (high - low > 1) {
        const int middle = (low + high) / 2;
        if (spectrum->cumulative[middle] <= u) {
            low = middle;
        } else {
            high = middle;
        }
    }
    const float width = spectrum->cumulative[low + 1] - spectrum->cumulative[low];
    const float within = width > 0.0f ? (u - spectrum->cumulative[low]) / width : 0.5f;
    return (float)PPMI_SPECTRUM_FIRST_NM + (float)low + ppmi_clampf(within, 0.0f, 0.999f);
}

ppmi_vec3 ppmi_spectrum_weight(const ppmi_spectrum *spectrum, float wavelength_nm)
{
    const int bin = (int)(wavelength_nm - (float)PPMI_SPECTRUM_FIRST_NM);
    return bin >= 0 && bin < PPMI_SPECTRUM_BINS ? spectrum->weight[bin] : vec3_splat(0.0f);
}

float ppmi_cauchy_index(float index, float dispersion, float wavelength_nm)
{
    const float d = 587.6f, f = 486.1f, c = 656.3f;
    const float spread = (index - 1.0f) * dispersion / 20.0f; /* n_F - n_C */
    const float b = spread / (1.0f / (f * f) - 1.0f / (c * c));
    return index + b * (1.0f / (wavelength_nm * wavelength_nm) - 1.0f / (d * d));
}
