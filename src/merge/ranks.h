/* Cryptomattes of several files as one (Friedman, Jones 2015, "Fully automatic ID mattes with
 * support for motion blur and transparency"; specification 1.2). */
#ifndef PPMI_MERGE_RANKS_H
#define PPMI_MERGE_RANKS_H

#include <stddef.h>
#include <stdint.h>

/* One id in a pixel. An id is the bits of a float. */
typedef struct merge_rank {
    uint32_t id;
    double coverage;
} merge_rank;

/* Adds up the coverage of equal ids and ranks them: most coverage first, equal ones by their id.
 * Those of no coverage are left out. Returns how many there are. */
size_t merge_ranks(merge_rank *ranks, size_t count);

#endif
