/* Preetham, Shirley, Smits 1999, "A Practical Analytic Model for Daylight": appendix A.2 for the
 * sky (Perez' distribution, zenith luminance and chromaticity as fits in turbidity), A.1 for the
 * attenuation of the sun (Rayleigh, Angstrom's aerosols, ozone, water vapour; the mixed gases only
 * absorb at 760 nm, behind the end of the sun's table).
 *
 * Spectra become colours by the fit of Wyman, Sloan, Shirley 2013, "Simple Analytic Approximations
 * to the CIE XYZ Color Matching Functions". Colours outside of Rec.709 are clamped. */
#include "light/sky.h"

#include "math/sampling.h"

/* ---- the sun --------------------------------------------------------------------------------- */

enum { BANDS = 38 }; /* 380, 390, ... 750 nm */

/* The sun's radiance outside of the atmosphere, W / (m2 nm sr): table 2 of the paper, as are the
 * absorption coefficients of ozone and water vapour, 1/cm. */
static const float sun_radiance[BANDS] = {
    16559.0f, 16233.7f, 21127.5f, 25888.2f, 25829.1f, 24232.3f, 26760.5f, 29658.3f,
    30545.4f, 30057.5f, 30663.7f, 28830.4f, 28712.1f, 27825.0f, 27100.6f, 27233.6f,
    26361.3f, 25503.8f, 25060.2f, 25311.6f, 25355.9f, 25134.2f, 24631.5f, 24173.2f,
    23685.3f, 23212.1f, 22827.7f, 22339.8f, 21970.2f, 21526.7f, 21097.9f, 20728.3f,
    20240.4f, 19870.8f, 19427.2f, 19072.4f, 18628.9f, 18259.2f};
static const float ozone[BANDS] = {0.0f,   0.0f,   0.0f,   0.0f,   0.0f,   0.0f,   0.0f,   0.003f,
                                   0.006f, 0.009f, 0.014f, 0.021f, 0.03f,  0.04f,  0.048f, 0.063f,
                                   0.075f, 0.085f, 0.103f, 0.12f,  0.12f,  0.115f, 0.125f, 0.12f,
                                   0.105f, 0.09f,  0.079f, 0.067f, 0.057f, 0.048f, 0.036f, 0.028f,
                                   0.023f, 0.018f, 0.014f, 0.011f, 0.010f, 0.009f};
enum { FIRST_WATER_BAND = 31 }; /* 690 nm; none before */
static const float water[BANDS - FIRST_WATER_BAND] = {0.016f, 0.024f, 0.0125f, 1.0f,
                                                      0.87f,  0.061f, 0.001f};

/* Share of the sun's light that comes through, at a wavelength in um. */
static float transmittance(int band, float lambda_um, float air_mass, float turbidity)
{
    const float ozone_cm = 0.35f, water_cm = 2.0f;
    const float aerosols = 0.04608f * turbidity - 0.04586f;
    const float k = band < FIRST_WATER_BAND ? 0.0f : water[band - FIRST_WATER_BAND];
    const float wet = k * water_cm * air_mass;
    const float depth = 0.008735f * powf(lambda_um, -4.08f) * air_mass +
                        aerosols * powf(lambda_um, -1.3f) * air_mass +
                        ozone[band] * ozone_cm * air_mass +
                        0.2385f * wet / powf(1.0f + 20.07f * wet, 0.45f);
    return expf(-depth);
}

/* Gaussian with one width on each side. */
static float lobe(float x, float middle, float below, float above)
{
    return expf(-0.5f * ppmi_sqr((x - middle) / (x < middle ? below : above)));
}

static ppmi_vec3 matching_functions(float nm)
{
    return vec3(1.056f * lobe(nm, 599.8f, 37.9f, 31.0f) + 0.362f * lobe(nm, 442.0f, 16.0f, 26.7f) -
                    0.065f * lobe(nm, 501.1f, 20.4f, 26.2f),
                0.821f * lobe(nm, 568.8f, 46.9f, 40.5f) + 0.286f * lobe(nm, 530.9f, 16.3f, 31.1f),
                1.217f * lobe(nm, 437.0f, 11.8f, 36.0f) + 0.681f * lobe(nm, 459.0f, 26.0f, 13.8f));
}

/* IEC 61966-2-1; negative parts clamped. */
static ppmi_vec3 xyz_to_rec709(ppmi_vec3 c)
{
    return vec3(ppmi_max(3.2406f * c.x - 1.5372f * c.y - 0.4986f * c.z, 0.0f),
                ppmi_max(-0.9689f * c.x + 1.8758f * c.y + 0.0415f * c.z, 0.0f),
                ppmi_max(0.0557f * c.x - 0.2040f * c.y + 1.0570f * c.z, 0.0f));
}

static ppmi_vec3 sun_lux(float zenith_rad, float turbidity)
{
    const float degrees = zenith_rad * (180.0f * PPMI_INV_PI);
    const float air_mass = /* Kasten 1966 */
        1.0f / (cosf(zenith_rad) + 0.15f * powf(93.885f - degrees, -1.253f));
    const float lumens_per_watt = 683.0f, step_nm = 10.0f;
    ppmi_vec3 sum = vec3_splat(0.0f);
    for (int i = 0; i < BANDS; i++) {
        const float nm = 380.0f + step_nm * (float)i;
        const float radiance = sun_radiance[i] * transmittance(i, nm * 1e-3f, air_mass, turbidity);
        sum = vec3_mad(sum, matching_functions(nm), radiance * lumens_per_watt * step_nm);
    }
    const float disk = PPMI_PI * ppmi_sqr(sinf(PPMI_SUN_ANGULAR_RADIUS_RAD));
    return xyz_to_rec709(vec3_scale(sum, disk));
}

/* ---- the sky --------------------------------------------------------------------------------- */

/* Slope in turbidity and value at 0 of A .. E, for Y, x and y. */
static const float perez_fits[3][5][2] = {
    {{0.1787f, -1.4630f},
     {-0.3554f, 0.4275f},
     {-0.0227f, 5.3251f},
     {0.1206f, -2.5771f},
     {-0.0670f, 0.3703f}},
    {{-0.0193f, -0.2592f},
     {-0.0665f, 0.0008f},
     {-0.0004f, 0.2125f},
     {-0.0641f, -0.8989f},
     {-0.0033f, 0.0452f}},
    {{-0.0167f, -0.2608f},
     {-0.0950f, 0.0092f},
     {-0.0079f, 0.2102f},
     {-0.0441f, -1.6537f},
     {-0.0109f, 0.0529f}},
};

/* x and y at the zenith: rows by powers of turbidity from the second down, columns by powers of the
 * sun's zenith angle from the third down. */
static const float zenith_fits[2][3][4] = {
    {{0.00166f, -0.00375f, 0.00209f, 0.0f},
     {-0.02903f, 0.06377f, -0.03202f, 0.00394f},
     {0.11693f, -0.21196f, 0.06052f, 0.25886f}},
    {{0.00275f, -0.00610f, 0.00317f, 0.0f},
     {-0.04214f, 0.08970f, -0.04153f, 0.00516f},
     {0.15346f, -0.26756f, 0.06670f, 0.26688f}},
};

static float zenith_chromaticity(const float fit[3][4], float turbidity, float angle)
{
    float value = 0.0f;
    for (int i = 0; i < 3; i++) {
        const float cubic =
            ((fit[i][0] * angle + fit[i][1]) * angle + fit[i][2]) * angle + fit[i][3];
        value = value * turbidity + cubic;
    }
    return value;
}

static float zenith_luminance(float turbidity, float angle)
{
    const float chi = (4.0f / 9.0f - turbidity / 120.0f) * (PPMI_PI - 2.0f * angle);
    const float kilonit =
        (4.0453f * turbidity - 4.9710f) * tanf(chi) - 0.2155f * turbidity + 2.4192f;
    return 1000.0f * kilonit;
}

/* Perez' distribution; gamma: angle to the sun. */
static float distribution(const float p[5], float cos_zenith, float gamma)
{
    return (1.0f + p[0] * expf(p[1] / cos_zenith)) *
           (1.0f + p[2] * expf(p[3] * gamma) + p[4] * ppmi_sqr(cosf(gamma)));
}

ppmi_sky ppmi_sky_of(float elevation_rad, float azimuth_rad, float turbidity)
{
    const float across = cosf(elevation_rad), angle = 0.5f * PPMI_PI - elevation_rad;
    ppmi_sky sky = {
        .to_sun =
            vec3(across * sinf(azimuth_rad), sinf(elevation_rad), -across * cosf(azimuth_rad)),
        .normalized = {zenith_luminance(turbidity, angle),
                       zenith_chromaticity(zenith_fits[0], turbidity, angle),
                       zenith_chromaticity(zenith_fits[1], turbidity, angle)},
        .sun_lux = sun_lux(angle, turbidity),
    };
    for (int i = 0; i < 3; i++) {
        for (int k = 0; k < 5; k++)
            sky.perez[i][k] = perez_fits[i][k][0] * turbidity + perez_fits[i][k][1];
        sky.normalized[i] /= distribution(sky.perez[i], 1.0f, angle);
    }
    return sky;
}

ppmi_vec3 ppmi_sky_radiance(const ppmi_sky *sky, ppmi_vec3 direction)
{
    if (direction.y < 0.0f) return vec3_splat(0.0f);
    const float cos_zenith = ppmi_max(direction.y, 1e-4f);
    const float gamma = acosf(ppmi_clampf(vec3_dot(direction, sky->to_sun), -1.0f, 1.0f));
    float value[3];
    for (int i = 0; i < 3; i++)
        value[i] = sky->normalized[i] * distribution(sky->perez[i], cos_zenith, gamma);
    const float luminance = ppmi_max(value[0], 0.0f), x = value[1], y = value[2];
    return xyz_to_rec709(vec3(luminance * x / y, luminance, luminance * (1.0f - x - y) / y));
}

ppmi_vec3 ppmi_sky_ground_lux(const ppmi_sky *sky)
{
    enum { STEPS = 64 };
    ppmi_vec3 sum = vec3_splat(0.0f);
    for (int i = 0; i < STEPS * STEPS; i++) {
        const float u = ((float)(i / STEPS) + 0.5f) / STEPS,
                    v = ((float)(i % STEPS) + 0.5f) / STEPS;
        const ppmi_vec3 up = ppmi_sample_cosine_hemisphere(u, v); /* around z */
        sum = vec3_add(sum, ppmi_sky_radiance(sky, vec3(up.x, up.z, up.y)));
    }
    return vec3_scale(sum, PPMI_PI / (STEPS * STEPS));
}

ppmi_vec3 ppmi_sky_sun_ground_lux(const ppmi_sky *sky)
{
    return vec3_scale(sky->sun_lux, ppmi_max(sky->to_sun.y, 0.0f));
}

void ppmi_sky_fill(const ppmi_sky *sky, ppmi_vec3 ground, uint32_t width, uint32_t height,
                   float *pixels)
{
    for (uint32_t row = 0; row < height; row++) {
        const float theta = PPMI_PI * ((float)row + 0.5f) / (float)height;
        for (uint32_t column = 0; column < width; column++, pixels += 3) {
            const float phi = 2.0f * PPMI_PI * (((float)column + 0.5f) / (float)width - 0.5f);
            const ppmi_vec3 d =
                vec3(sinf(theta) * sinf(phi), cosf(theta), -sinf(theta) * cosf(phi));
            vec3_store(pixels, d.y < 0.0f ? ground : ppmi_sky_radiance(sky, d));
        }
    }
}
