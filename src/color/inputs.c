/* Pictures into the working space: what space a file's values are in, and the way from there. */
#include <fnmatch.h>
#include <stddef.h>
#include <string.h>

#include "color/handle.h"
#include "color/primaries.h"
#include "color/spaces.h"

/* A pattern without a slash is about the last part of a name. */
static bool matches(const char *pattern, const char *name)
{
    const char *const slash = strrchr(name, '/');
    if (!strchr(pattern, '/') && slash) name = slash + 1;
    return fnmatch(pattern, name, 0) == 0;
}

static const char *space_by_rule(const ppm_color *color, const char *path)
{
    for (uint32_t i = 0; path && i < color->rule_count; i++) {
        if (matches(color->rules[i].pattern, path)) return color->rules[i].space;
    }
    return NULL;
}

static bool is_rec709(const float chromaticities[8])
{
    for (int i = 0; i < 8; i++) {
        const double difference = (double)chromaticities[i] - ppmi_primaries_rec709.xy[i];
        if (!(difference < 1e-3 && difference > -1e-3)) return false;
    }
    return true;
}

ppmi_color_input ppmi_color_choose_input(const ppm_color *color, const char *path, bool is_linear,
                                         const char *space_in_file, const float chromaticities[8])
{
    const ppmi_color_input usual = {.kind = is_linear ? PPMI_INPUT_REC709 : PPMI_INPUT_SRGB};
    const char *space = color ? space_by_rule(color, path) : NULL;
    if (!space && color && space_in_file)
        space = ppmi_ocio_find_space(color->config, space_in_file);
    if (!space && chromaticities) {
        return (ppmi_color_input){.kind = is_rec709(chromaticities) ? PPMI_INPUT_REC709
                                                                    : PPMI_INPUT_PRIMARIES};
    }
    if (!color) return usual;
    if (!space && path) space = ppmi_ocio_file_space(color->config, path);
    if (!space) return usual;
    if (ppmi_ocio_space_is_data(color->config, space)) {
        return (ppmi_color_input){.kind = PPMI_INPUT_NUMBERS};
    }
    const char *const srgb = ppmi_color_find_srgb_texture(color->config);
    if (srgb && strcmp(space, srgb) == 0) return (ppmi_color_input){.kind = PPMI_INPUT_SRGB};
    return (ppmi_color_input){.kind = PPMI_INPUT_SPACE, .space = space};
}

ppm_status ppmi_color_from_space(ppm_context *context, const ppm_color *color, const char *space,
                                 float *pixels, size_t pixel_count, uint32_t channels)
{
    ppmi_ocio_conversion *conversion = NULL;
    ppm_status status = ppmi_ocio_make_conversion(context, color->config, color->source,
                                                  (ppmi_ocio_space){space, false},
                                                  color->working_space, &conversion);
    if (status != PPM_STATUS_OK) return status;
    status = ppmi_ocio_apply(context, conversion, color->source, pixels, pixel_count, channels);
    ppmi_ocio_conversion_destroy(conversion);
    return status;
}

static void apply_to_all(const float matrix[9], float *pixels, size_t pixel_count,
                         uint32_t channels)
{
    for (size_t i = 0; i < pixel_count; i++)
        ppmi_matrix_apply(matrix, pixels + i * channels, pixels + i * channels);
}

void ppmi_color_from_rec709(const ppm_color *color, float *pixels, size_t pixel_count,
                            uint32_t channels)
{
    const ppmi_working_space *const working = ppmi_color_working_space(color);
    if (working->differs) apply_to_all(working->from_rec709, pixels, pixel_count, channels);
}

bool ppmi_color_from_primaries(const ppm_color *color, const float chromaticities[8], float *pixels,
                               size_t pixel_count, uint32_t channels)
{
    ppmi_primaries from;
    double matrix[9];
    float to_rec709[9];
    for (int i = 0; i < 8; i++)
        from.xy[i] = (double)chromaticities[i];
    if (!ppmi_primaries_between(&from, &ppmi_primaries_rec709, matrix)) return false;
    for (int i = 0; i < 9; i++)
        to_rec709[i] = (float)matrix[i];
    apply_to_all(to_rec709, pixels, pixel_count, channels);
    ppmi_color_from_rec709(color, pixels, pixel_count, channels);
    return true;
}

/* ---- sRGB ------------------------------------------------------------------------------------ */

ppm_status ppmi_color_srgb_decode(ppm_context *context, const ppm_color *color, float *pixels,
                                  size_t pixel_count, uint32_t channels)
{
    ppm_color *builtin = NULL;
    ppm_status status = PPM_STATUS_OK;
    if (!color || !ppmi_color_find_srgb_texture(color->config)) {
        const ppm_color_options options = {.size = sizeof options, .config_path = ""};
        status = ppm_color_create_with(context, &options, &builtin);
    }
    if (status != PPM_STATUS_OK) return status;
    const ppm_color *const used = builtin ? builtin : color;
    const ppmi_ocio_space srgb = {ppmi_color_find_srgb_texture(used->config), false};
    ppmi_ocio_conversion *conversion = NULL;
    status = ppmi_ocio_make_conversion(context, used->config, used->source, srgb, used->rec709,
                                       &conversion);
    if (status == PPM_STATUS_OK) {
        status = ppmi_ocio_apply(context, conversion, used->source, pixels, pixel_count, channels);
    }
    ppmi_ocio_conversion_destroy(conversion);
    ppm_color_destroy(builtin);
    return status;
}

ppm_status ppmi_color_srgb_decode_table(ppm_context *context, const ppm_color *color,
                                        float out_linear[256])
{
    float ramp[256 * 3];
    for (int i = 0; i < 256 * 3; i++)
        ramp[i] = (float)(i / 3) / 255;
    const ppm_status status = ppmi_color_srgb_decode(context, color, ramp, 256, 3);
    if (status != PPM_STATUS_OK) return status;
    for (int i = 0; i < 256; i++)
        out_linear[i] = ramp[3 * i];
    return PPM_STATUS_OK;
}
