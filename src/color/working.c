/* The working space: found by name, measured by what becomes of linear Rec.709 in it.
 *
 * A scene-linear space is a matrix away from another. OpenColorIO is asked for the images of the
 * three primaries; a fourth colour tells whether it is a matrix at all. White goes to white, up to
 * rounding, in every configuration that adapts; where it does, rows are scaled to make it exact, so
 * that a white surface stays white after any number of reflections. */
#include <math.h>
#include <stdio.h>
#include <string.h>

#include "color/handle.h"
#include "color/primaries.h"
#include "color/spaces.h"

static ppm_status fail_rec709(ppm_context *context, const ppm_color *color)
{
    return ppmi_fail(context, PPM_STATUS_INPUT_INVALID,
                     "%s: nothing in the colour configuration says what linear Rec.709 is, which "
                     "files have their colours in; give it the role aces_interchange, or a space "
                     "called \"Linear Rec.709 (sRGB)\"",
                     color->source);
}

ppm_status ppmi_color_find_space(ppm_context *context, const ppm_color *color, const char *name,
                                 const char **out_name)
{
    enum { NAMES_MAX = 256 };
    const char *names[NAMES_MAX] = {NULL};
    *out_name = ppmi_ocio_find_space(color->config, name);
    if (*out_name) return PPM_STATUS_OK;
    const uint32_t found = ppmi_ocio_space_count(color->config);
    const uint32_t count = found < NAMES_MAX ? found : NAMES_MAX;
    for (uint32_t i = 0; i < count; i++)
        names[i] = ppmi_ocio_space_name(color->config, i);
    return ppmi_color_fail_not_found(context, color, "colour space or role", "", name, names,
                                     count);
}

static ppm_status fail_not_linear(ppm_context *context, const ppm_color *color, const char *name)
{
    return ppmi_fail(context, PPM_STATUS_INPUT_INVALID,
                     "%s: \"%s\" cannot be the working space: it is not scene-linear",
                     color->source, name);
}

/* The matrix from Rec.709; fails where there is none. */
static ppm_status measure(ppm_context *context, const ppm_color *color, double m[9])
{
    const float tests[4][3] = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}, {3, 0.25f, 0.01f}};
    float probes[12];
    memcpy(probes, tests, sizeof probes);
    const char *const name = color->working_space.name;
    if (ppmi_ocio_space_is_data(color->config, name)) return fail_not_linear(context, color, name);
    ppmi_ocio_conversion *conversion = NULL;
    ppm_status status = ppmi_ocio_make_conversion(context, color->config, color->source,
                                                  color->rec709, color->working_space, &conversion);
    if (status != PPM_STATUS_OK) return status;
    status = ppmi_ocio_apply(context, conversion, color->source, probes, 4, 3);
    ppmi_ocio_conversion_destroy(conversion);
    if (status != PPM_STATUS_OK) return status;
    for (int i = 0; i < 9; i++)
        m[i] = (double)probes[3 * (i % 3) + i / 3];
    for (int i = 0; i < 3; i++) {
        const double sum = 3 * m[3 * i] + 0.25 * m[3 * i + 1] + 0.01 * m[3 * i + 2];
        if (!(fabs(sum - (double)probes[9 + i]) < 1e-3)) {
            return fail_not_linear(context, color, name);
        }
    }
    return PPM_STATUS_OK;
}

static void keep_white(double m[9])
{
    for (int i = 0; i < 3; i++) {
        const double sum = m[3 * i] + m[3 * i + 1] + m[3 * i + 2];
        for (int k = 0; k < 3 && fabs(sum - 1) < 2e-4; k++)
            m[3 * i + k] /= sum;
    }
}

static bool is_near(const double a[9], const double b[9], double most)
{
    double worst = 0;
    for (int i = 0; i < 9; i++)
        worst = fmax(worst, fabs(a[i] - b[i]));
    return worst < most;
}

static void store(const double m[9], float out[9])
{
    for (int i = 0; i < 9; i++)
        out[i] = (float)m[i];
}

/* Chromaticities under D65: those of a space whose white is adapted, unless it is a known one. */
static void measure_chromaticities(const double to_xyz[9], float out[8])
{
    for (int i = 0; i < 4; i++) {
        double xyz[3], sum = 0;
        for (int k = 0; k < 3; k++) {
            const double *const row = to_xyz + 3 * k;
            xyz[k] = i < 3 ? row[i] : row[0] + row[1] + row[2];
            sum += xyz[k];
        }
        out[2 * i] = (float)(xyz[0] / sum);
        out[2 * i + 1] = (float)(xyz[1] / sum);
    }
}

/* Names and chromaticities of the known space that m leads to, if there is one. Configurations have
 * their matrices to four digits at times. */
static void recognise(const double m[9], ppmi_working_space *space)
{
    const ppmi_known_primaries *known;
    for (int i = 0; (known = ppmi_primaries_known(i)) != NULL; i++) {
        double matrix[9];
        if (!ppmi_primaries_between(&ppmi_primaries_rec709, &known->primaries, matrix) ||
            !is_near(m, matrix, 1e-3)) {
            continue;
        }
        snprintf(space->interop_id, sizeof space->interop_id, "%s", known->interop_id);
        for (int k = 0; k < 8; k++)
            space->chromaticities[k] = (float)known->primaries.xy[k];
        return;
    }
}

static ppm_status fill(ppm_context *context, ppm_color *color, double m[9])
{
    static const double identity[9] = {1, 0, 0, 0, 1, 0, 0, 0, 1};
    ppmi_working_space *const space = &color->working;
    const char *const name = color->working_space.name;
    double to_rec709[9], rec709_to_xyz[9], to_xyz[9], from_xyz[9];
    *space = ppmi_working_space_rec709;
    snprintf(space->name, sizeof space->name, "%s", name);
    if (is_near(m, identity, 1e-4)) return PPM_STATUS_OK;
    keep_white(m);
    if (!ppmi_matrix_invert(m, to_rec709)) return fail_not_linear(context, color, name);
    ppmi_primaries_to_xyz(&ppmi_primaries_rec709, rec709_to_xyz);
    ppmi_matrix_multiply(rec709_to_xyz, to_rec709, to_xyz);
    ppmi_matrix_invert(to_xyz, from_xyz);
    space->differs = true;
    store(m, space->from_rec709);
    store(to_rec709, space->to_rec709);
    store(from_xyz, space->from_xyz);
    space->interop_id[0] = '\0';
    measure_chromaticities(to_xyz, space->chromaticities);
    recognise(m, space);
    return PPM_STATUS_OK;
}

ppm_status ppmi_color_choose_working_space(ppm_context *context, ppm_color *color, const char *name)
{
    if (!ppmi_color_find_rec709(color->config, &color->rec709)) {
        return fail_rec709(context, color);
    }
    const char **const found = &color->working_space.name;
    ppm_status status = PPM_STATUS_OK;
    if (name && *name) {
        status = ppmi_color_find_space(context, color, name, found);
    } else {
        *found = ppmi_ocio_find_space(color->config, "scene_linear");
        if (!*found) *found = color->rec709.name;
    }
    double m[9];
    if (status == PPM_STATUS_OK) status = measure(context, color, m);
    if (status == PPM_STATUS_OK) status = fill(context, color, m);
    if (status != PPM_STATUS_OK) return status;
    ppmi_log(context, PPM_LOG_DEBUG, "%s: linear Rec.709 is %s\"%s\", the working space is \"%s\"",
             color->source, color->rec709.is_rec709_by_aces ? "found by way of " : "",
             color->rec709.name, color->working.name);
    return PPM_STATUS_OK;
}

const ppmi_working_space *ppmi_color_working_space(const ppm_color *color)
{
    return color ? &color->working : &ppmi_working_space_rec709;
}

const char *ppm_color_working_space(const ppm_color *color)
{
    return color ? color->working.name : NULL;
}
