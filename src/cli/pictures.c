/* Nothing is stored but the ranges: a million frames cost nothing. */
#include "pictures.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "file_pattern.h"

void pictures_init(cli_pictures *pictures, const cli_options *options)
{
    *pictures = (cli_pictures){.frames = options->frames, .fps = options->fps, .camera_count = 1};
}

void pictures_deinit(cli_pictures *pictures)
{
    for (uint32_t i = 0; pictures->camera_names && i < pictures->camera_count; i++)
        free(pictures->camera_names[i]);
    free(pictures->camera_names);
    pictures->camera_names = NULL;
}

static bool is_among(char *const *names, uint32_t count, const char *name)
{
    for (uint32_t i = 0; i < count; i++) {
        if (strcmp(names[i], name) == 0) return true;
    }
    return false;
}

/* Safe in a file's name; the number of a camera without a name. NULL when memory is out. */
static char *name_of(const ppm_scene *scene, ppm_camera_id id)
{
    char number[16];
    const char *const name = ppm_scene_camera_name(scene, id);
    snprintf(number, sizeof number, "%u", (unsigned)id);
    return pattern_safe_name(*name ? name : number);
}

/* name, or name-2, name-3, ..., whichever is new. NULL when memory is out. */
static char *new_name(char *const *names, uint32_t count, char *name)
{
    if (!name || !is_among(names, count, name)) return name;
    char *numbered = NULL;
    for (unsigned number = 2; number <= count + 1; number++) {
        free(numbered);
        if (asprintf(&numbered, "%s-%u", name, number) < 0) numbered = NULL;
        if (!numbered || !is_among(names, count, numbered)) break;
    }
    free(name);
    return numbered;
}

int pictures_take_cameras(cli_pictures *pictures, const ppm_scene *scene)
{
    const uint32_t count = ppm_scene_camera_count(scene);
    if (count == 0) return EXIT_DONE;
    pictures->camera_names = calloc(count, sizeof *pictures->camera_names);
    if (!pictures->camera_names) return EXIT_RESOURCES;
    pictures->camera_count = count;
    for (uint32_t i = 0; i < count; i++) {
        pictures->camera_names[i] = new_name(pictures->camera_names, i, name_of(scene, i + 1));
        if (!pictures->camera_names[i]) return EXIT_RESOURCES;
    }
    return EXIT_DONE;
}

size_t pictures_count(const cli_pictures *pictures)
{
    const size_t frames = pictures->frames.is_given ? frames_count(&pictures->frames.range) : 1;
    return frames * pictures->camera_count;
}

cli_picture pictures_at(const cli_pictures *pictures, size_t index)
{
    cli_picture picture = {.index = index, .has_frame = pictures->frames.is_given};
    if (picture.has_frame) {
        picture.frame = frames_at(&pictures->frames.range, index / pictures->camera_count);
        picture.time_s = picture.frame / pictures->fps;
    }
    if (pictures->camera_names) {
        const uint32_t camera = (uint32_t)(index % pictures->camera_count);
        picture.camera = camera + 1;
        picture.camera_name = pictures->camera_names[camera];
    }
    return picture;
}

const char *pictures_label(const cli_pictures *pictures, const cli_picture *picture, char *buffer,
                           size_t buffer_size)
{
    char frame[32] = "";
    if (picture->has_frame) snprintf(frame, sizeof frame, "frame %d", (int)picture->frame);
    snprintf(buffer, buffer_size, "%s%s%s%s (%zu of %zu)", frame,
             picture->has_frame && picture->camera_name ? ", " : "",
             picture->camera_name ? "camera " : "",
             picture->camera_name ? picture->camera_name : "", picture->index + 1,
             pictures_count(pictures));
    return buffer;
}
