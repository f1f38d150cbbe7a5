/* Sets that grow together: union-find (Tarjan 1975) with path halving, which takes a time in
 * proportion to the unions, however large the sets become. */
#ifndef PPMI_BASE_UNION_FIND_H
#define PPMI_BASE_UNION_FIND_H

#include <stdint.h>

/* The least member of i's set. parents: one entry a member, which is itself at first; owned by the
 * caller, and shortened on the way. One thread. */
static inline uint32_t ppmi_union_find_root(uint32_t *parents, uint32_t i)
{
    while (parents[i] != i) {
        parents[i] = parents[parents[i]];
        i = parents[i];
    }
    return i;
}

/* Makes one set of those of a and b. The lower root stays, so that roots do not depend on the order
 * of unions. */
static inline void ppmi_union_find_join(uint32_t *parents, uint32_t a, uint32_t b)
{
    a = ppmi_union_find_root(parents, a);
    b = ppmi_union_find_root(parents, b);
    if (a < b) parents[b] = a;
    if (b < a) parents[a] = b;
}

#endif
