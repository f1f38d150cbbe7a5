/* A file of ppm-render's that is to be merged: what its header says, and its pixels. */
#ifndef PPMI_MERGE_SOURCE_H
#define PPMI_MERGE_SOURCE_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#include "imageio/layered_input.h"

typedef struct merge_source {
    const char *path;
    ppmi_layered_input *input;
    ppmi_layered_info info;
    uint64_t passes, photons;
    double seconds;
    uint64_t *seeds; /* seed_count, rising */
    size_t seed_count;
    double weight;
} merge_source;

/* Opens path and reads the header. Returns OK, INPUT_NOT_FOUND, INPUT_INVALID (no OpenEXR file, not
 * by ppm-render), INPUT_UNSUPPORTED, OUT_OF_MEMORY; close is due in every case. */
ppm_status merge_source_open(ppm_context *context, const char *path, merge_source *source);
void merge_source_close(ppm_context *context, merge_source *source);

/* The text of an attribute, "" where there is none; numbers are written into buffer. */
const char *merge_source_text(const merge_source *source, const char *name, char *buffer,
                              size_t size);

/* The index of a channel by its name, or UINT32_MAX. */
uint32_t merge_source_channel(const merge_source *source, const char *name);

/* Puts the one with the smallest seed first, and so on: the order on the command line does not
 * matter. Sets the weights: photons where photons make the picture, else passes. */
void merge_sources_prepare(merge_source *sources, size_t count);

#endif
