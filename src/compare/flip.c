/* LDR-FLIP: Andersson, Nilsson, Akenine-Moller, Oskarsson, Astrom and Fairchild, "FLIP: A
 * Difference Evaluator for Alternating Images" (HPG 2020), section 4.
 *
 * Two pipelines. Colour: what the eye cannot resolve is filtered away in YCxCz, the rest compared
 * by HyAB in CIELAB (4.1). Features: edges and points that only one of the pictures has (4.2). The
 * feature error raises the colour error (4.3, equation 17). hdr_flip.c builds upon this. */
#include "compare/flip.h"

#include <math.h>

#include "compare/filter.h"
#include "compare/flip_planes.h"
#include "compare/opponent.h"

/* ---- planes ---------------------------------------------------------------------------------- */

ppm_status ppmi_compare_flip_create(ppm_context *context, uint32_t width, uint32_t height,
                                    double pixels_per_degree, ppmi_compare_flip **out_flip)
{
    ppmi_compare_flip *const flip = ppmi_alloc_zeroed(context, 1, sizeof *flip);
    if (!flip) goto fail;
    flip->context = context;
    flip->width = width;
    flip->height = height;
    flip->pixel_count = (size_t)width * height;
    flip->memory = ppmi_alloc(context, flip->pixel_count, PLANES * sizeof(float));
    if (!flip->memory) goto fail;
    for (int i = 0; i < PLANES; i++)
        flip->planes[i] = flip->memory + (size_t)i * flip->pixel_count;
    for (int channel = 0; channel < 3; channel++)
        ppmi_compare_csf_make(channel, pixels_per_degree, &flip->csf[channel]);
    ppmi_compare_detector_make(pixels_per_degree, &flip->detector);
    *out_flip = flip;
    return PPM_STATUS_OK;

fail:
    ppmi_compare_flip_destroy(flip);
    return ppmi_fail(context, PPM_STATUS_OUT_OF_MEMORY, "no memory for FLIP of %u x %u pixels",
                     width, height);
}

void ppmi_compare_flip_destroy(ppmi_compare_flip *flip)
{
    if (!flip) return;
    ppm_context *const context = flip->context;
    ppmi_free(context, flip->memory);
    ppmi_free(context, flip);
}

/* ---- colour ---------------------------------------------------------------------------------- */

/* The picture as three planes of YCxCz. */
static void split(const ppmi_compare_flip *flip, const float *rgb, float *const ycxcz[3])
{
#pragma omp parallel for schedule(static) if (flip->pixel_count >= PPMI_COMPARE_PARALLEL_MIN)
    for (int64_t i = 0; i < (int64_t)flip->pixel_count; i++) {
        float shown[3], xyz[3], opponent[3];
        for (int c = 0; c < 3; c++)
            shown[c] = fminf(fmaxf(rgb[3 * i + c], 0), 1);
        ppmi_compare_rgb_to_xyz(shown, xyz);
        ppmi_compare_xyz_to_ycxcz(xyz, opponent);
        for (int c = 0; c < 3; c++)
            ycxcz[c][i] = opponent[c];
    }
}

static void add_scaled(const ppmi_compare_flip *flip, float *sum, const float *plane, float weight,
                       bool is_first)
{
#pragma omp parallel for schedule(static) if (flip->pixel_count >= PPMI_COMPARE_PARALLEL_MIN)
    for (int64_t i = 0; i < (int64_t)flip->pixel_count; i++)
        sum[i] = weight * plane[i] + (is_first ? 0 : sum[i]);
}

static void apply_csf(const ppmi_compare_flip *flip, const ppmi_compare_csf *csf, const float *in,
                      float *out)
{
    float *const across = flip->planes[PLANE_SCRATCH], *const down = flip->planes[PLANE_SCRATCH_2];
    for (int32_t i = 0; i < csf->term_count; i++) {
        const ppmi_compare_kernel *const kernel = &csf->kernels[i];
        ppmi_compare_filter_rows(in, across, flip->width, flip->height, kernel);
        ppmi_compare_filter_columns(across, down, flip->width, flip->height, kernel);
        add_scaled(flip, out, down, csf->weights[i], i == 0);
    }
}

/* YCxCz after filtering to Hunt-adjusted CIELAB, in place. What filtering put outside the display's
 * colours is clamped. */
static void to_hunt_lab(const ppmi_compare_flip *flip, float *const planes[3])
{
#pragma omp parallel for schedule(static) if (flip->pixel_count >= PPMI_COMPARE_PARALLEL_MIN)
    for (int64_t i = 0; i < (int64_t)flip->pixel_count; i++) {
        const float ycxcz[3] = {planes[0][i], planes[1][i], planes[2][i]};
        float xyz[3], rgb[3], lab[3], adjusted[3];
        ppmi_compare_ycxcz_to_xyz(ycxcz, xyz);
        ppmi_compare_xyz_to_rgb(xyz, rgb);
        for (int c = 0; c < 3; c++)
            rgb[c] = fminf(fmaxf(rgb[c], 0), 1);
        ppmi_compare_rgb_to_xyz(rgb, xyz);
        ppmi_compare_xyz_to_lab(xyz, lab);
        ppmi_compare_hunt(lab, adjusted);
        for (int c = 0; c < 3; c++)
            planes[c][i] = adjusted[c];
    }
}

/* ---- features -------------------------------------------------------------------------------- */

/* strength[i] = the length of the gradient (edges) or of the second derivatives (points): kernel
 * one way with the Gaussian the other way, and turned. */
static void detect(const ppmi_compare_flip *flip, const float *luminance,
                   const ppmi_compare_kernel *kernel, float *strength)
{
    const uint32_t width = flip->width, height = flip->height;
    const ppmi_compare_kernel *const gaussian = &flip->detector.gaussian;
    float *const half = flip->planes[PLANE_SCRATCH], *const vertical =
                                                         flip->planes[PLANE_SCRATCH_2];
    ppmi_compare_filter_rows(luminance, half, width, height, gaussian);
    ppmi_compare_filter_columns(half, vertical, width, height, kernel);
    ppmi_compare_filter_rows(luminance, half, width, height, kernel);
    ppmi_compare_filter_columns(half, strength, width, height, gaussian);
#pragma omp parallel for schedule(static) if (flip->pixel_count >= PPMI_COMPARE_PARALLEL_MIN)
    for (int64_t i = 0; i < (int64_t)flip->pixel_count; i++)
        strength[i] = sqrtf(strength[i] * strength[i] + vertical[i] * vertical[i]);
}

/* ---- both ------------------------------------------------------------------------------------ */

/* All that FLIP takes from one picture: planes[0..2] Hunt-adjusted CIELAB, [3] edges, [4] points.
 */
static void look_at(const ppmi_compare_flip *flip, const float *rgb, float *const planes[5])
{
    float *const ycxcz[3] = {flip->planes[PLANE_Y], flip->planes[PLANE_CX], flip->planes[PLANE_CZ]};
    split(flip, rgb, ycxcz);
    for (int channel = 0; channel < 3; channel++)
        apply_csf(flip, &flip->csf[channel], ycxcz[channel], planes[channel]);
    to_hunt_lab(flip, planes);

    /* features are looked for in luminance 0..1, (Y + 16) / 116, before the contrast filters */
    float *const luminance = ycxcz[0];
#pragma omp parallel for schedule(static) if (flip->pixel_count >= PPMI_COMPARE_PARALLEL_MIN)
    for (int64_t i = 0; i < (int64_t)flip->pixel_count; i++)
        luminance[i] = (luminance[i] + 16) / 116;
    detect(flip, luminance, &flip->detector.edge, planes[3]);
    detect(flip, luminance, &flip->detector.point, planes[4]);
}

static const float colour_exponent = 0.7f, feature_exponent = 0.5f;

/* The largest colour error that a display can show, blue against green (section 4.1.3). */
static float largest_colour_error(void)
{
    static const float colours[2][3] = {{0, 1, 0}, {0, 0, 1}};
    float adjusted[2][3];
    for (int i = 0; i < 2; i++) {
        float xyz[3], lab[3];
        ppmi_compare_rgb_to_xyz(colours[i], xyz);
        ppmi_compare_xyz_to_lab(xyz, lab);
        ppmi_compare_hunt(lab, adjusted[i]);
    }
    return powf(ppmi_compare_hyab(adjusted[0], adjusted[1]), colour_exponent);
}

/* Equation 14: errors up to 0.4 of the largest take 0..0.95, the rest is pressed into what is left,
 * since large differences all look large. */
static float redistributed(float error, float largest)
{
    const float knee = 0.4f * largest, knee_height = 0.95f;
    if (error < knee) return error * knee_height / knee;
    return knee_height + (error - knee) / (largest - knee) * (1 - knee_height);
}

static float pixel_error(float *const test[5], float *const reference[5], int64_t i, float largest)
{
    const float test_lab[3] = {test[0][i], test[1][i], test[2][i]};
    const float reference_lab[3] = {reference[0][i], reference[1][i], reference[2][i]};
    const float distance = powf(ppmi_compare_hyab(test_lab, reference_lab), colour_exponent);
    const float colour = fminf(redistributed(distance, largest), 1);
    const float edges = fabsf(test[3][i] - reference[3][i]);
    const float points = fabsf(test[4][i] - reference[4][i]);
    const float feature = powf(fminf(fmaxf(edges, points) / sqrtf(2), 1), feature_exponent);
    return powf(colour, 1 - feature);
}

void ppmi_compare_flip_ldr(ppmi_compare_flip *flip, const float *test, const float *reference,
                           float *errors)
{
    float *const *const seen_test = &flip->planes[PLANE_TEST];
    float *const *const seen_reference = &flip->planes[PLANE_REFERENCE];
    look_at(flip, test, seen_test);
    look_at(flip, reference, seen_reference);
    const float largest = largest_colour_error();
#pragma omp parallel for schedule(static) if (flip->pixel_count >= PPMI_COMPARE_PARALLEL_MIN)
    for (int64_t i = 0; i < (int64_t)flip->pixel_count; i++)
        errors[i] = pixel_error(seen_test, seen_reference, i, largest);
}
