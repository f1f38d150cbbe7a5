/* Two pictures of the same place, ready to be compared. */
#ifndef PPMI_COMPARE_PAIR_H
#define PPMI_COMPARE_PAIR_H

#include <stdbool.h>
#include <stdint.h>

#include "base/context.h"

/* width * height pixels that both files store: a window at (x, y) of pictures of picture_width *
 * picture_height. */
typedef struct ppmi_compare_pair {
    uint32_t x, y, width, height;
    uint32_t picture_width, picture_height;
    /* width * height * 3 values of linear Rec.709, row 0 on top, multiplied by alpha; finite: where
     * one is broken both hold the reference's pixel, or black if that is the broken one */
    float *test, *reference;
    uint8_t *is_broken; /* width * height: not finite in test or reference; not to be counted */
    uint64_t test_broken, reference_broken; /* pixels */
    uint64_t measured;                      /* pixels that are not broken, at least 1 */
    bool is_linear; /* one of the files holds light; else both hold a display's values */
} ppmi_compare_pair;

/* Reads both. Returns OK, INPUT_NOT_FOUND, INPUT_INVALID (sizes that differ, windows without a
 * common pixel, no pixel that is whole), INPUT_UNSUPPORTED, OUT_OF_MEMORY; *out_pair is to be
 * freed with ppmi_compare_pair_free on success only. */
ppm_status ppmi_compare_pair_read(ppm_context *context, const char *test_path,
                                  const char *reference_path, ppmi_compare_pair *out_pair);
void ppmi_compare_pair_free(ppm_context *context, ppmi_compare_pair *pair);

#endif
