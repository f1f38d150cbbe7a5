/* How far a render is, and when it has gone far enough. */
#ifndef PPM_CLI_PROGRESS_H
#define PPM_CLI_PROGRESS_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#include "console.h"
#include "ppm/render.h"

typedef struct cli_progress {
    uint64_t pass_limit;  /* 0: none */
    double seconds_limit; /* 0: none */
    double seconds_shown; /* elapsed when the last line was shown */
    uint64_t next_pass_shown;
    const char *label;          /* in front of the line: which picture of how many; "" for one */
    uint64_t pictures_after;    /* that follow this one */
    double seconds_per_picture; /* mean of those before; 0: none yet */
} cli_progress;

void progress_init(cli_progress *progress, uint64_t pass_limit, double seconds_limit);

/* Makes it that of a picture in a sequence: the time left is that of all pictures, and without a
 * terminal lines come every ten seconds only. label must outlive the progress. */
void progress_set_sequence(cli_progress *progress, const char *label, uint64_t pictures_after,
                           double seconds_per_picture);

/* Whether one of the stops is reached, elapsed seconds into rendering. A time is met at the
 * nearest end of a pass: no pass is begun that would be less than half done by then. */
bool progress_is_done(const cli_progress *progress, uint64_t passes, double elapsed);

/* "pass 12/256   5%   1.21 M photons/s   0:34 left". Returns buffer. */
const char *progress_line(const cli_progress *progress, const ppm_render_stats *stats,
                          double elapsed, char *buffer, size_t buffer_size);

/* "0:34", "1:02:03"; rounded up. Returns buffer. */
const char *progress_duration(double seconds, char *buffer, size_t buffer_size);

/* Shows the line: always on a terminal, else after 1, 2, 4, ... passes and every ten seconds. */
void progress_show(cli_progress *progress, cli_console *console, const ppm_render_stats *stats,
                   double elapsed);

#endif
