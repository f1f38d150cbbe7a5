/* Discrete distributions in constant time: the alias method (Vose 1991). */
#ifndef PPMI_MATH_ALIAS_H
#define PPMI_MATH_ALIAS_H

#include <stdint.h>

#include "base/context.h"

typedef struct ppmi_alias_bin {
    float keep;        /* probability of staying in this bin */
    uint32_t alias;    /* where to go else */
    float probability; /* of this entry */
} ppmi_alias_bin;

typedef struct ppmi_alias {
    uint32_t count;
    ppmi_alias_bin *bins;
} ppmi_alias;

/* weights: count values >= 0, finite; all zero gives the uniform distribution. Returns OK,
 * INVALID_ARGUMENT (count 0), OUT_OF_MEMORY. */
ppm_status ppmi_alias_init(ppm_context *context, ppmi_alias *table, const float *weights,
                           uint32_t count);
void ppmi_alias_deinit(ppm_context *context, ppmi_alias *table);

/* Draws an entry with u in [0, 1), in double precision: a float has too few steps to be even over
 * a million entries. What is left of u is uniform again: *out_rest, in [0, 1), may be NULL. */
static inline uint32_t ppmi_alias_sample(const ppmi_alias *table, double u, double *out_rest)
{
    const double scaled = u * (double)table->count;
    uint32_t i = (uint32_t)scaled;
    if (i >= table->count) i = table->count - 1;
    double rest = scaled - (double)i;
    const double keep = (double)table->bins[i].keep;
    if (rest < keep) {
        rest /= keep;
    } else {
        rest = (rest - keep) / (1.0 - keep);
        i = table->bins[i].alias;
    }
    if (out_rest) *out_rest = rest < 1.0 ? rest : 0x1.fffffffffffffp-1;
    return i;
}

static inline float ppmi_alias_probability(const ppmi_alias *table, uint32_t i)
{
    return table->bins[i].probability;
}

#endif
