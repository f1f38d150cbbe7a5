/* --frame and --frames: which moments of an animation are rendered. */
#ifndef PPM_CLI_FRAMES_H
#define PPM_CLI_FRAMES_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

enum { FRAME_MOST = 10000000, FRAMES_COUNT_MOST = 1000000 };

/* first, first + step, ... up to last, or down to it with a step below 0. */
typedef struct frame_range {
    int32_t first, last; /* -FRAME_MOST .. FRAME_MOST */
    int32_t step;        /* never 0; towards last */
} frame_range;

/* "7", "1-24", "1-24/2", "24-1", "-5--1": a frame may be below 0. A last frame that the steps pass
 * over is not rendered. False for anything else, and for more than FRAMES_COUNT_MOST frames;
 * *out_range is then untouched. */
bool frames_parse(const char *text, frame_range *out_range);
/* "7" or "-7" alone. */
bool frames_parse_one(const char *text, int32_t *out_frame);

size_t frames_count(const frame_range *range);
int32_t frames_at(const frame_range *range, size_t index);

/* The seed of a frame: each has its own noise, whatever other frames are rendered with it. Fits a
 * signed 64-bit number. */
uint64_t frames_seed(uint64_t seed, int32_t frame);

#endif
