/* Colour management: which configuration, display and view, and the conversions that the renderer
 * needs of it. OpenColorIO does the arithmetic (ocio_shim.cpp). */
#include "color/color.h"

#include <errno.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <strings.h>

#include "base/suggest.h"
#include "color/ocio_shim.h"
#include "color/spaces.h"

static const char builtin_source[] = "built-in";

struct ppm_color {
    ppm_context *context;
    char *source;
    ppmi_ocio_config *config;
    ppmi_working_space working;
};

/* ---- opening --------------------------------------------------------------------------------- */

static ppm_status open_config(ppm_context *context, ppm_color *color, const char *path)
{
    if (!path) {
        return ppmi_ocio_open_text(context, ppmi_color_builtin_config(), builtin_source,
                                   &color->config);
    }
    FILE *const file = fopen(path, "rb");
    if (!file) {
        return ppmi_fail(context, PPM_STATUS_INPUT_NOT_FOUND,
                         "%s: the colour configuration cannot be opened: %s", path,
                         strerror(errno));
    }
    fclose(file);
    return ppmi_ocio_open_file(context, path, &color->config);
}

static ppm_status choose_working_space(ppm_context *context, ppm_color *color)
{
    if (!ppmi_color_find_working_space(color->config, &color->working)) {
        return ppmi_fail(context, PPM_STATUS_INPUT_INVALID,
                         "%s: the colour configuration has no linear Rec.709 or ACES2065-1 space "
                         "and no scene_linear role",
                         color->source);
    }
    const char *const name = color->working.name;
    switch (color->working.kind) {
    case PPMI_WORKING_REC709:
        ppmi_log(context, PPM_LOG_DEBUG, "%s: linear Rec.709 is \"%s\"", color->source, name);
        break;
    case PPMI_WORKING_ACES:
        ppmi_log(context, PPM_LOG_DEBUG, "%s: linear Rec.709 goes through \"%s\"", color->source,
                 name);
        break;
    case PPMI_WORKING_GUESS:
        ppmi_log(context, PPM_LOG_WARNING,
                 "%s: the colour configuration has no space known as linear Rec.709 and no "
                 "aces_interchange role; \"%s\" is taken for it, so colours may be off",
                 color->source, name);
        break;
    }
    return PPM_STATUS_OK;
}

/* path NULL: built in. */
static ppm_status create_from(ppm_context *context, const char *path, ppm_color **out_color)
{
    ppm_color *const color = ppmi_alloc_zeroed(context, 1, sizeof *color);
    ppm_status status = PPM_STATUS_OUT_OF_MEMORY;
    if (!color) goto fail_memory;
    color->context = context;
    color->source = ppmi_string_copy(context, path ? path : builtin_source);
    if (!color->source) goto fail_memory;
    status = open_config(context, color, path);
    if (status != PPM_STATUS_OK) goto fail;
    status = choose_working_space(context, color);
    if (status != PPM_STATUS_OK) goto fail;
    *out_color = color;
    return PPM_STATUS_OK;

fail_memory:
    ppmi_fail(context, status, "no memory for a colour configuration");
fail:
    ppm_color_destroy(color);
    return status;
}

ppm_status ppm_color_create(ppm_context *context, const char *config_path, ppm_color **out_color)
{
    if (!context || !out_color) return PPM_STATUS_INVALID_ARGUMENT;
    const char *path = config_path;
    if (!path) path = getenv("OCIO");
    return create_from(context, path && *path ? path : NULL, out_color);
}

void ppm_color_destroy(ppm_color *color)
{
    if (!color) return;
    ppm_context *const context = color->context;
    ppmi_ocio_close(color->config);
    ppmi_free(context, color->source);
    ppmi_free(context, color);
}

/* ---- names ----------------------------------------------------------------------------------- */

const char *ppm_color_source(const ppm_color *color)
{
    return color ? color->source : NULL;
}

uint32_t ppm_color_display_count(const ppm_color *color)
{
    return color ? ppmi_ocio_display_count(color->config) : 0;
}

const char *ppm_color_display_name(const ppm_color *color, uint32_t index)
{
    if (index >= ppm_color_display_count(color)) return NULL;
    return ppmi_ocio_display_name(color->config, index);
}

const char *ppm_color_default_display(const ppm_color *color)
{
    return color ? ppmi_ocio_default_display(color->config) : NULL;
}

uint32_t ppm_color_view_count(const ppm_color *color, const char *display)
{
    return color && display ? ppmi_ocio_view_count(color->config, display) : 0;
}

const char *ppm_color_view_name(const ppm_color *color, const char *display, uint32_t index)
{
    if (index >= ppm_color_view_count(color, display)) return NULL;
    return ppmi_ocio_view_name(color->config, display, index);
}

const char *ppm_color_default_view(const ppm_color *color, const char *display)
{
    return color && display ? ppmi_ocio_default_view(color->config, display) : NULL;
}

uint32_t ppm_color_space_count(const ppm_color *color)
{
    return color ? ppmi_ocio_space_count(color->config) : 0;
}

const char *ppm_color_space_name(const ppm_color *color, uint32_t index)
{
    if (index >= ppm_color_space_count(color)) return NULL;
    return ppmi_ocio_space_name(color->config, index);
}

/* ---- choice of display and view -------------------------------------------------------------- */

/* The names of one list: the displays, or the views of a display. */
static uint32_t list_count(const ppm_color *color, const char *display)
{
    return display ? ppm_color_view_count(color, display) : ppm_color_display_count(color);
}

static const char *list_name(const ppm_color *color, const char *display, uint32_t index)
{
    return display ? ppm_color_view_name(color, display, index)
                   : ppm_color_display_name(color, index);
}

/* Fails with the nearest name and all that there are. */
static ppm_status fail_not_found(ppm_context *context, const ppm_color *color, const char *display,
                                 const char *word)
{
    enum { NAMES_MAX = 256 };
    const char *names[NAMES_MAX] = {NULL};
    char listing[1024] = "";
    size_t length = 0;
    const uint32_t found = list_count(color, display);
    const uint32_t count = found < NAMES_MAX ? found : NAMES_MAX;
    for (uint32_t i = 0; i < count; i++) {
        names[i] = list_name(color, display, i);
        if (length >= sizeof listing) continue;
        const int written = snprintf(listing + length, sizeof listing - length, "%s\"%s\"",
                                     i > 0 ? ", " : "", names[i] ? names[i] : "");
        length += written > 0 ? (size_t)written : 0;
    }
    const char *const nearest = ppmi_suggest(word, names, count);
    return ppmi_fail(context, PPM_STATUS_NOT_FOUND, "%s: no %s \"%s\"%s%s%s%s%s%s; there %s %s",
                     color->source, display ? "view" : "display", word,
                     display ? " for display \"" : "", display ? display : "", display ? "\"" : "",
                     nearest ? " (did you mean \"" : "", nearest ? nearest : "",
                     nearest ? "\"?)" : "", count == 1 ? "is" : "are", count ? listing : "none");
}

/* word, in any letter case, or the default for NULL and "". */
static ppm_status choose_name(ppm_context *context, const ppm_color *color, const char *display,
                              const char *word, const char **out_name)
{
    if (!word || !*word) {
        *out_name =
            display ? ppm_color_default_view(color, display) : ppm_color_default_display(color);
        if (*out_name) return PPM_STATUS_OK;
        return ppmi_fail(context, PPM_STATUS_INPUT_INVALID,
                         "%s: the colour configuration has no %s", color->source,
                         display ? "view" : "display");
    }
    const uint32_t count = list_count(color, display);
    for (uint32_t i = 0; i < count; i++) {
        const char *const name = list_name(color, display, i);
        if (!name || strcasecmp(name, word) != 0) continue;
        *out_name = name;
        return PPM_STATUS_OK;
    }
    return fail_not_found(context, color, display, word);
}

static ppm_status make_view(ppm_context *context, const ppm_color *color, const char *display,
                            const char *view, ppmi_ocio_conversion **out_conversion)
{
    const char *display_name = NULL, *view_name = NULL;
    ppm_status status = choose_name(context, color, NULL, display, &display_name);
    if (status != PPM_STATUS_OK) return status;
    status = choose_name(context, color, display_name, view, &view_name);
    if (status != PPM_STATUS_OK) return status;
    return ppmi_ocio_make_view(context, color->config, color->source, color->working.name,
                               color->working.kind == PPMI_WORKING_ACES, display_name, view_name,
                               out_conversion);
}

ppm_status ppm_color_check_view(ppm_context *context, const ppm_color *color, const char *display,
                                const char *view)
{
    if (!context || !color) return PPM_STATUS_INVALID_ARGUMENT;
    ppmi_ocio_conversion *conversion = NULL;
    const ppm_status status = make_view(context, color, display, view, &conversion);
    ppmi_ocio_conversion_destroy(conversion);
    return status;
}

/* ---- conversions ----------------------------------------------------------------------------- */

static void expose(float exposure_ev, float *rgba, size_t pixel_count)
{
    if (exposure_ev == 0) return;
    const float factor = exp2f(exposure_ev);
    for (size_t i = 0; i < pixel_count; i++) {
        for (int c = 0; c < 3; c++)
            rgba[4 * i + c] *= factor;
    }
}

ppm_status ppmi_color_to_display(ppm_context *context, const ppm_color *color, const char *display,
                                 const char *view, float exposure_ev, float *rgba,
                                 size_t pixel_count)
{
    ppmi_ocio_conversion *conversion = NULL;
    ppm_status status = make_view(context, color, display, view, &conversion);
    if (status != PPM_STATUS_OK) return status;
    expose(exposure_ev, rgba, pixel_count);
    status = ppmi_ocio_apply(context, conversion, color->source, rgba, pixel_count, 4);
    ppmi_ocio_conversion_destroy(conversion);
    return status;
}

/* Whether color can say what sRGB is: it has the space, and knows where linear Rec.709 is. */
static bool knows_srgb(const ppm_color *color)
{
    return color && color->working.kind != PPMI_WORKING_GUESS &&
           ppmi_color_find_srgb_texture(color->config) != NULL;
}

ppm_status ppmi_color_srgb_decode(ppm_context *context, const ppm_color *color, float *pixels,
                                  size_t pixel_count, uint32_t channels)
{
    ppm_color *builtin = NULL;
    ppm_status status = PPM_STATUS_OK;
    if (!knows_srgb(color)) status = create_from(context, NULL, &builtin);
    if (status != PPM_STATUS_OK) return status;
    const ppm_color *const used = builtin ? builtin : color;
    const char *const srgb = ppmi_color_find_srgb_texture(used->config);
    ppmi_ocio_conversion *conversion = NULL;
    status = ppmi_ocio_make_input(context, used->config, used->source, srgb, used->working.name,
                                  used->working.kind == PPMI_WORKING_ACES, &conversion);
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

const char *ppmi_color_version(void)
{
    return ppmi_ocio_version();
}
