#include "render/catcher.h"

#include <math.h>

/* The least C / P; P is the plate's colour at coverage. Channels in which the plate is black hide
 * nothing. */
static float kept_share(const float *catcher, const float at_coverage[3])
{
    float share = 1.0f;
    for (int c = 0; c < 3; c++) {
        if (at_coverage[c] > 0.0f) share = fminf(share, catcher[c] / at_coverage[c]);
    }
    return fmaxf(share, 0.0f);
}

void ppmi_catcher_take_plate(const float *catchers, const float *plate, size_t pixel_count,
                             float *rgba)
{
    for (size_t i = 0; i < pixel_count; i++) {
        const float *const catcher = catchers + 4 * i, *const alone = plate + 4 * i;
        const float coverage = catcher[3];
        if (!(coverage > 0.0f) || !(alone[3] > 0.0f)) continue;
        float at_coverage[3];
        for (int c = 0; c < 3; c++)
            at_coverage[c] = alone[c] * (coverage / alone[3]);
        const float share = kept_share(catcher, at_coverage);
        for (int c = 0; c < 3; c++)
            rgba[4 * i + c] -= share * at_coverage[c];
        rgba[4 * i + 3] -= share * coverage;
    }
}
