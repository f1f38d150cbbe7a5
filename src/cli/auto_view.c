/* The exporter's version is Blender's from 3.2 on; before, it was below 2, as Blender's default was
 * Filmic. */
#include "auto_view.h"

#include <stdbool.h>
#include <stdlib.h>
#include <string.h>
#include <strings.h>

const char *auto_view_of_generator(const char *generator)
{
    static const char exporter[] = "Khronos glTF Blender I/O v";
    if (strncmp(generator, exporter, sizeof exporter - 1) != 0) return NULL;
    const char *const version = generator + sizeof exporter - 1;
    char *end = NULL;
    const long major = strtol(version, &end, 10);
    if (end == version || major < 0) return NULL;
    return major >= 4 ? "AgX" : "Filmic";
}

static bool has_view(const ppm_color *color, const char *display, const char *view)
{
    if (!display) display = ppm_color_default_display(color);
    const uint32_t count = ppm_color_view_count(color, display);
    for (uint32_t i = 0; i < count; i++) {
        if (strcasecmp(ppm_color_view_name(color, display, i), view) == 0) return true;
    }
    return false;
}

const char *auto_view_choose(cli_console *console, ppm_context *context, const ppm_color *color,
                             const cli_options *options, const char *generator)
{
    const char *const view = auto_view_of_generator(generator);
    if (!view) {
        console_message(console, PPM_LOG_INFO,
                        "--view auto: the file was not written by Blender%s%s%s; the default view "
                        "is used",
                        *generator ? " (but by " : "", generator, *generator ? ")" : "");
        return NULL;
    }
    if (!has_view(color, options->display, view) ||
        ppm_color_check_look(context, color, options->display, view, options->look) !=
            PPM_STATUS_OK) {
        console_message(console, PPM_LOG_WARNING,
                        "--view auto: %s shows by %s, which the colour configuration %s does not "
                        "have for this display; the default view is used",
                        generator, view, ppm_color_source(color));
        return NULL;
    }
    console_message(console, PPM_LOG_INFO, "--view auto: %s, as the Blender that wrote the file",
                    view);
    return view;
}
