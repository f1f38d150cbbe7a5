/* What a scene-linear file of the picture alone needs is little: neither a view nor a table can be
 * missing, and the layers, most of the bytes, can do without. */
#include "rescue.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <strings.h>
#include <unistd.h>

static const char *base_of(const char *path)
{
    const char *const slash = strrchr(path, '/');
    return slash ? slash + 1 : path;
}

static const char *ending_of(const char *path)
{
    const char *const dot = strrchr(base_of(path), '.');
    return dot ? dot : path + strlen(path);
}

bool rescue_is_exr(const char *path)
{
    return strcasecmp(ending_of(path), ".exr") == 0;
}

/* ---- names ----------------------------------------------------------------------------------- */

/* folder (ended by a slash, or empty), the first length bytes of base, ending. NULL when memory is
 * out, or such a file is there. */
static char *free_name(const char *folder, const char *base, size_t length, const char *ending)
{
    const size_t size = strlen(folder) + length + strlen(ending) + 1;
    char *const name = malloc(size);
    if (!name) return NULL;
    snprintf(name, size, "%s%.*s%s", folder, (int)length, base, ending);
    if (access(name, F_OK) != 0) return name;
    free(name);
    return NULL;
}

/* A name that no file has, and that is not the one that was asked for. */
static char *name_in(const char *folder, const char *path)
{
    const char *const base = base_of(path);
    const size_t stem = (size_t)(ending_of(path) - base);
    char *const name = free_name(folder, base, stem, rescue_is_exr(path) ? ".picture.exr" : ".exr");
    return name ? name : free_name(folder, base, strlen(base), ".exr");
}

/* ---- saving ---------------------------------------------------------------------------------- */

typedef struct rescue_job {
    const ppm_render *render;
    const ppm_color *color;
    const char *path; /* what could not be written */
    const ppm_output_options *options;
} rescue_job;

/* What takes less room comes later. An OpenEXR file was tried with its layers already. */
static bool save_as(const rescue_job *job, const char *name)
{
    static const struct {
        bool is_alone;
        int32_t depth;
    } ways[] = {{false, PPM_DEPTH_FLOAT},
                {false, PPM_DEPTH_HALF},
                {true, PPM_DEPTH_FLOAT},
                {true, PPM_DEPTH_HALF}};
    const bool has_layers = !rescue_is_exr(job->path) && ppm_render_layer_count(job->render) > 1;
    for (size_t i = has_layers ? 0 : 2; i < sizeof ways / sizeof ways[0]; i++) {
        ppm_output_options plain = *job->options;
        plain.is_picture_only = ways[i].is_alone;
        plain.depth = ways[i].depth;
        if (ppm_render_write(job->render, job->color, name, &plain) == PPM_STATUS_OK) return true;
    }
    return false;
}

/* The name under which it is saved now, to be freed; NULL: it is not. */
static char *save_in(const rescue_job *job, const char *folder)
{
    char *const name = name_in(folder, job->path);
    if (name && save_as(job, name)) return name;
    free(name);
    return NULL;
}

static char *save_beside(const rescue_job *job)
{
    const size_t length = (size_t)(base_of(job->path) - job->path);
    char *const folder = strndup(job->path, length);
    char *const name = folder ? save_in(job, folder) : NULL;
    free(folder);
    return name;
}

/* Another folder may be on another disk. */
static char *save_elsewhere(const rescue_job *job)
{
    const bool was_here = base_of(job->path) == job->path;
    char folder[4096];
    const char *const temporary = getenv("TMPDIR");
    char *const name = was_here ? NULL : save_in(job, "");
    if (name) return name;
    snprintf(folder, sizeof folder, "%s/", temporary && *temporary ? temporary : "/tmp");
    return save_in(job, folder);
}

void rescue_picture(cli_console *console, const ppm_render *render, const ppm_color *color,
                    const char *path, const ppm_output_options *options)
{
    const rescue_job job = {render, color, path, options};
    char *name = save_beside(&job);
    if (!name) name = save_elsewhere(&job);
    if (name) {
        console_message(console, PPM_LOG_ERROR, "%s: not written; the picture is saved as %s", path,
                        name);
    } else {
        console_message(console, PPM_LOG_ERROR,
                        "%s: not written, and the picture could not be saved beside it either, nor "
                        "in this folder, nor in that of temporary files",
                        path);
    }
    free(name);
}
