/* What a scene-linear file needs is the picture alone: neither a view nor a table can be missing.
 */
#include "rescue.h"

#include <stdlib.h>
#include <string.h>
#include <strings.h>
#include <unistd.h>

static const char *ending_of(const char *path)
{
    const char *const slash = strrchr(path, '/');
    const char *const dot = strrchr(slash ? slash : path, '.');
    return dot ? dot : path + strlen(path);
}

bool rescue_is_exr(const char *path)
{
    return strcasecmp(ending_of(path), ".exr") == 0;
}

/* A name that no file has. NULL when memory is out, or both have been taken. */
static char *free_name(const char *path)
{
    const size_t stem = (size_t)(ending_of(path) - path), length = strlen(path);
    char *const name = malloc(length + sizeof ".exr");
    if (!name) return NULL;
    memcpy(name, path, length + 1);
    strcpy(name + stem, ".exr");
    if (access(name, F_OK) != 0) return name;
    memcpy(name, path, length + 1);
    strcpy(name + length, ".exr");
    if (access(name, F_OK) != 0) return name;
    free(name);
    return NULL;
}

void rescue_picture(cli_console *console, const ppm_render *render, const ppm_color *color,
                    const char *path, const ppm_output_options *options)
{
    ppm_output_options plain = *options;
    char *const name = free_name(path);
    ppm_status status = PPM_STATUS_OUTPUT_NOT_WRITABLE;
    if (name) {
        plain.depth = PPM_DEPTH_FLOAT;
        status = ppm_render_write(render, color, name, &plain);
    }
    if (name && status != PPM_STATUS_OK) {
        plain.depth = PPM_DEPTH_HALF;
        status = ppm_render_write(render, color, name, &plain);
    }
    if (status == PPM_STATUS_OK) {
        console_message(console, PPM_LOG_ERROR, "%s: not written; the picture is saved as %s", path,
                        name);
    } else {
        console_message(console, PPM_LOG_ERROR,
                        "%s: not written, and the picture could not be saved beside it either",
                        path);
    }
    free(name);
}
