#include "merge/ranks.h"

#include <stdlib.h>

static int compare_ids(const void *a, const void *b)
{
    const merge_rank *const x = a, *const y = b;
    return x->id < y->id ? -1 : x->id > y->id;
}

static int compare_coverage(const void *a, const void *b)
{
    const merge_rank *const x = a, *const y = b;
    if (x->coverage != y->coverage) return x->coverage > y->coverage ? -1 : 1;
    return compare_ids(a, b);
}

/* Equal ids stand side by side. */
static size_t add_equal(merge_rank *ranks, size_t count)
{
    size_t kept = 0;
    for (size_t i = 0; i < count; i++) {
        if (kept > 0 && ranks[kept - 1].id == ranks[i].id) {
            ranks[kept - 1].coverage += ranks[i].coverage;
        } else {
            ranks[kept++] = ranks[i];
        }
    }
    return kept;
}

size_t merge_ranks(merge_rank *ranks, size_t count)
{
    size_t there = 0;
    for (size_t i = 0; i < count; i++) {
        if (ranks[i].coverage > 0) ranks[there++] = ranks[i];
    }
    if (there == 0) return 0;
    qsort(ranks, there, sizeof *ranks, compare_ids);
    there = add_equal(ranks, there);
    qsort(ranks, there, sizeof *ranks, compare_coverage);
    return there;
}
