/* Rows of several files into those of one. */
#ifndef PPMI_MERGE_MIX_H
#define PPMI_MERGE_MIX_H

#include "merge/plan.h"

typedef struct merge_mixer {
    ppm_context *context;
    merge_source *sources;
    const merge_plan *plan;
    double total_weight;
    uint32_t rows_max; /* that are held of each source at once */
    float **rows;      /* of each source */
    struct merge_rank *ranks;
} merge_mixer;

/* Returns OK, OUT_OF_MEMORY; deinit is due in every case. */
ppm_status merge_mixer_init(ppm_context *context, merge_source *sources, const merge_plan *plan,
                            merge_mixer *mixer);
void merge_mixer_deinit(merge_mixer *mixer);

/* Fills rows as ppmi_layered_file.read_rows does; user is a merge_mixer. Returns OK, INPUT_INVALID
 * (damaged pixels; values that are no numbers). */
ppm_status merge_mix_rows(void *user, uint32_t part, uint32_t y, uint32_t row_count, float *values);

#endif
