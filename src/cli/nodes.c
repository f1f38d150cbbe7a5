#include "nodes.h"

#include <stdlib.h>

#include "base/suggest.h"
#include "exit_status.h"

int nodes_complain(cli_console *console, const ppm_scene *scene, const char *option,
                   const char *what_it_is, const char *text)
{
    const uint32_t count = ppm_scene_instance_count(scene);
    const char **names = calloc((size_t)count + 1, sizeof *names);
    if (!names) return EXIT_RESOURCES;
    for (uint32_t i = 0; i < count; i++)
        names[i] = ppm_scene_instance_name(scene, i + 1);
    const char *const nearest = ppmi_suggest(text, names, count);
    console_message(console, PPM_LOG_ERROR, "%s: '%s' is %s with a surface%s%s%s", option, text,
                    what_it_is, nearest ? "; did you mean '" : "", nearest ? nearest : "",
                    nearest ? "'?" : "");
    free(names);
    return EXIT_USAGE;
}
