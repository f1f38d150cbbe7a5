/* Colour management: a configuration and its names. OpenColorIO does the arithmetic
 * (ocio_shim.cpp); the ways in and out are in inputs.c and views.c. */
#include "color/color.h"

#include <errno.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "color/handle.h"

static const char builtin_source[] = "built-in";

static const char no_memory[] = "no memory for a colour configuration";

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

static ppm_status take_rules(ppm_context *context, ppm_color *color,
                             const ppm_color_options *options)
{
    const uint32_t count = options->texture_space_count;
    if (count == 0) return PPM_STATUS_OK;
    color->rules = ppmi_alloc_zeroed(context, count, sizeof *color->rules);
    if (!color->rules) return ppmi_fail(context, PPM_STATUS_OUT_OF_MEMORY, "%s", no_memory);
    for (; color->rule_count < count; color->rule_count++) {
        const ppm_texture_space *const from = &options->texture_spaces[color->rule_count];
        ppmi_texture_rule *const rule = &color->rules[color->rule_count];
        if (!from->pattern || !from->space) return PPM_STATUS_INVALID_ARGUMENT;
        const ppm_status status = ppmi_color_find_space(context, color, from->space, &rule->space);
        if (status != PPM_STATUS_OK) return status;
        rule->pattern = ppmi_string_copy(context, from->pattern);
        if (!rule->pattern) return ppmi_fail(context, PPM_STATUS_OUT_OF_MEMORY, "%s", no_memory);
    }
    return PPM_STATUS_OK;
}

static ppm_status open_with(ppm_context *context, ppm_color *color, const char *path,
                            const ppm_color_options *options)
{
    color->context = context;
    color->is_builtin = !path;
    color->source = ppmi_string_copy(context, path ? path : builtin_source);
    if (!color->source) return ppmi_fail(context, PPM_STATUS_OUT_OF_MEMORY, "%s", no_memory);
    ppm_status status = open_config(context, color, path);
    if (status == PPM_STATUS_OK) {
        status = ppmi_color_choose_working_space(context, color, options->working_space);
    }
    return status == PPM_STATUS_OK ? take_rules(context, color, options) : status;
}

ppm_status ppm_color_create_with(ppm_context *context, const ppm_color_options *options,
                                 ppm_color **out_color)
{
    if (!context || !out_color || !options || options->size < sizeof *options ||
        (options->texture_space_count > 0 && !options->texture_spaces)) {
        return PPM_STATUS_INVALID_ARGUMENT;
    }
    const char *path = options->config_path;
    if (!path) path = getenv("OCIO");
    ppm_color *const color = ppmi_alloc_zeroed(context, 1, sizeof *color);
    if (!color) return ppmi_fail(context, PPM_STATUS_OUT_OF_MEMORY, "%s", no_memory);
    const ppm_status status = open_with(context, color, path && *path ? path : NULL, options);
    if (status == PPM_STATUS_OK) {
        *out_color = color;
    } else {
        ppm_color_destroy(color);
    }
    return status;
}

ppm_status ppm_color_create(ppm_context *context, const char *config_path, ppm_color **out_color)
{
    const ppm_color_options options = {.size = sizeof options, .config_path = config_path};
    return ppm_color_create_with(context, &options, out_color);
}

void ppm_color_destroy(ppm_color *color)
{
    if (!color) return;
    ppm_context *const context = color->context;
    for (uint32_t i = 0; i < color->rule_count; i++)
        ppmi_free(context, color->rules[i].pattern);
    ppmi_free(context, color->rules);
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

uint32_t ppm_color_look_count(const ppm_color *color)
{
    return color ? ppmi_ocio_look_count(color->config) : 0;
}

const char *ppm_color_look_name(const ppm_color *color, uint32_t index)
{
    if (index >= ppm_color_look_count(color)) return NULL;
    return ppmi_ocio_look_name(color->config, index);
}

const char *ppmi_color_version(void)
{
    return ppmi_ocio_version();
}
