/* What is done with each channel. */
#ifndef PPMI_MERGE_PLAN_H
#define PPMI_MERGE_PLAN_H

#include "merge/source.h"

enum {
    MERGE_MEAN,     /* the weighted mean */
    MERGE_SUM,      /* counts of what all of them gathered */
    MERGE_VARIANCE, /* variances of means: weights count squared */
    MERGE_FIRST,    /* that of the first file: a mean of places or numbers is none of them */
    MERGE_RANKS     /* an id or a coverage of a Cryptomatte */
};

enum { MERGE_RANKS_MAX = 64 };

/* A Cryptomatte's channels, by rank. */
typedef struct merge_matte {
    uint32_t rank_count;
    uint32_t ids[MERGE_RANKS_MAX], coverages[MERGE_RANKS_MAX]; /* channels of the plan */
} merge_matte;

typedef struct merge_plan {
    uint32_t channel_count; /* those of the first source, in its order */
    int32_t *rules;         /* MERGE_ of each */
    uint32_t **places;      /* of each source: where it has them */
    size_t source_count;
    merge_matte *mattes;
    uint32_t matte_count;
} merge_plan;

/* Returns OK, INPUT_INVALID (a Cryptomatte that is not whole), OUT_OF_MEMORY; deinit is due in
 * every case. */
ppm_status merge_plan_init(ppm_context *context, const merge_source *sources, size_t count,
                           merge_plan *plan);
void merge_plan_deinit(ppm_context *context, merge_plan *plan);

#endif
