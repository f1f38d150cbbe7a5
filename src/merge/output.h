/* The merged file. */
#ifndef PPMI_MERGE_OUTPUT_H
#define PPMI_MERGE_OUTPUT_H

#include "merge/mix.h"
#include "merge/options.h"

typedef struct merge_totals {
    uint64_t passes, photons;
    double seconds;
    char *seeds; /* "3 7 12"; freed with ppmi_free */
} merge_totals;

/* Adds up what the sources say. Returns OK, OUT_OF_MEMORY. */
ppm_status merge_totals_init(ppm_context *context, const merge_source *sources, size_t count,
                             merge_totals *totals);

/* Writes options->output. Returns as ppmi_imageio_write_layered. */
ppm_status merge_write(merge_mixer *mixer, const merge_options *options, const char *command,
                       const merge_totals *totals);

#endif
