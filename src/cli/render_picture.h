/* One picture: from a scene at its moment to files. */
#ifndef PPM_CLI_RENDER_PICTURE_H
#define PPM_CLI_RENDER_PICTURE_H

#include "console.h"
#include "options.h"
#include "outputs.h"
#include "pictures.h"
#include "ppm/ppm.h"
#include "progress.h"

/* What is rendered, and how it is told. */
typedef struct picture_task {
    cli_console *console;
    const cli_options *options;
    const cli_picture *picture;
    ppm_scene *scene;
    cli_outputs *outputs;       /* turned to the picture */
    bool is_whole_or_nothing;   /* files appear when all passes are done, or not at all */
    bool is_first;              /* of those that are rendered */
    const char *label;          /* of a picture in a sequence; NULL for one alone */
    uint64_t pictures_after;    /* that are still to be rendered */
    double seconds_per_picture; /* of those before; 0: none */
    const float *plate;         /* of its catchers alone; NULL: there are none */
    size_t plate_count;         /* values */
    uint64_t plate_passes;      /* that it took */
    bool is_plate;              /* this is that */
    float focus_distance_m;     /* found with all things there; 0: as the options say */
} picture_task;

typedef struct picture_result {
    uint64_t passes; /* finished */
    bool is_stopped; /* by a signal, before all of its passes */
    bool is_dropped; /* not to be written, since it is not whole */
    bool is_written; /* all files are */
} picture_result;

/* Makes the session of a picture. Returns an exit status; what is wrong has been said. */
int picture_prepare(const picture_task *task, ppm_render **out_render);

/* Renders the scene's catchers alone for a picture: *out_plate is to be freed, and NULL where a
 * signal stopped it; task has its numbers afterwards. Returns an exit status; what is wrong has
 * been said. */
int picture_render_plate(picture_task *task, float **out_plate);

/* Renders and writes. The session stays with the caller, who leaves the step of the signals before
 * destroying it. Returns an exit status; what is wrong has been said. */
int picture_render(const picture_task *task, ppm_render *render, picture_result *out_result);

#endif
