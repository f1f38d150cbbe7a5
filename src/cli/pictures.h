/* The pictures that one run renders: every frame, by every camera that is asked for. */
#ifndef PPM_CLI_PICTURES_H
#define PPM_CLI_PICTURES_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#include "options.h"
#include "ppm/scene.h"

typedef struct cli_picture {
    size_t index; /* from 0 */
    bool has_frame;
    int32_t frame;
    double time_s;        /* frame / fps */
    ppm_camera_id camera; /* 0: the one of the options */
    const char
        *camera_name; /* as it stands in files' names; NULL unless all cameras are asked for */
} cli_picture;

typedef struct cli_pictures {
    frame_choice frames;
    double fps;
    uint32_t camera_count; /* 1 unless all cameras are asked for */
    char **camera_names;   /* NULL: only the one of the options */
} cli_pictures;

/* The frames of options, by one camera. */
void pictures_init(cli_pictures *pictures, const cli_options *options);
void pictures_deinit(cli_pictures *pictures);

/* All cameras of the scene instead of one. Those whose names are the same in files get numbers.
 * A scene without cameras keeps the one. Returns EXIT_DONE or EXIT_RESOURCES. */
int pictures_take_cameras(cli_pictures *pictures, const ppm_scene *scene);

size_t pictures_count(const cli_pictures *pictures);
/* All cameras of a frame come before the next frame. */
cli_picture pictures_at(const cli_pictures *pictures, size_t index);

/* "frame 7, camera Front (13 of 48)". Returns buffer. */
const char *pictures_label(const cli_pictures *pictures, const cli_picture *picture, char *buffer,
                           size_t buffer_size);

#endif
