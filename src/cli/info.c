/* Help, version, and the contents of a colour configuration. */
#include "info.h"

#include <stdio.h>
#include <string.h>

#include "base/printable.h"
#include "options.h"

static int finish(void)
{
    if (fflush(stdout) == 0 && !ferror(stdout)) return EXIT_DONE;
    perror("ppm-render: error: standard output");
    return EXIT_OUTPUT;
}

int info_print_help(void)
{
    cli_options_print_help(stdout);
    return finish();
}

int info_print_version(void)
{
    printf("ppm-render %s\n%s\n", ppm_version(), ppm_build_info());
    return finish();
}

static const char *mark(const char *name, const char *default_name)
{
    return default_name && strcmp(name, default_name) == 0 ? " (default)" : "";
}

static void print_display(const ppm_color *color, const char *display)
{
    ppmi_print(stdout, "  %s%s\n", display, mark(display, ppm_color_default_display(color)));
    const uint32_t count = ppm_color_view_count(color, display);
    for (uint32_t i = 0; i < count; i++) {
        const char *const view = ppm_color_view_name(color, display, i);
        ppmi_print(stdout, "    %s%s\n", view, mark(view, ppm_color_default_view(color, display)));
    }
}

int info_print_views(const ppm_color *color)
{
    ppmi_print(stdout, "Configuration: %s\n", ppm_color_source(color));
    fputs("\nDisplays (--display) and their views (--view):\n", stdout);
    const uint32_t display_count = ppm_color_display_count(color);
    for (uint32_t i = 0; i < display_count; i++) {
        print_display(color, ppm_color_display_name(color, i));
    }
    const uint32_t look_count = ppm_color_look_count(color);
    ppmi_print(stdout, "\nLooks (--look):%s\n", look_count == 0 ? " none" : "");
    for (uint32_t i = 0; i < look_count; i++)
        ppmi_print(stdout, "  %s\n", ppm_color_look_name(color, i));
    ppmi_print(stdout, "\nColour spaces (--working-space, --texture-space):\n");
    const uint32_t space_count = ppm_color_space_count(color);
    for (uint32_t i = 0; i < space_count; i++) {
        const char *const name = ppm_color_space_name(color, i);
        const bool is_working = strcmp(name, ppm_color_working_space(color)) == 0;
        ppmi_print(stdout, "  %s%s\n", name, is_working ? " (working space)" : "");
    }
    return finish();
}
