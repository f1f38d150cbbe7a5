/* Learning and drawing. */
#include "photon/guide.h"

static uint32_t bin_of(double x, uint32_t count)
{
    const uint32_t bin = (uint32_t)(x * (double)count);
    return bin < count ? bin : count - 1;
}

static uint32_t group_of(const ppmi_lights *lights, double pick)
{
    return ppmi_lights_group(lights, pick, PPMI_GUIDE_GROUPS);
}

/* ---- learning -------------------------------------------------------------------------------- */

void ppmi_guide_count(ppmi_guide_counts *counts, const ppmi_lights *lights,
                      const ppmi_emission_sample *sample)
{
    const uint32_t group = group_of(lights, sample->pick);
    counts->picks[bin_of(sample->pick, PPMI_GUIDE_PICKS)]++;
    for (uint32_t plane = 0; plane < 2; plane++) {
        const uint32_t row = bin_of((double)sample->u[2 * plane], PPMI_GUIDE_SIDE);
        const uint32_t column = bin_of((double)sample->u[2 * plane + 1], PPMI_GUIDE_SIDE);
        counts->planes[group][plane][row][column]++;
    }
}

/* Sums of the counts, each with one more: a bin that the pilot missed is not ruled out. */
static void accumulate(const uint32_t *counts, uint32_t count, float *cumulative)
{
    double total = 0.0, sum = 0.0;
    for (uint32_t i = 0; i < count; i++)
        total += (double)counts[i] + 1.0;
    for (uint32_t i = 0; i < count; i++) {
        cumulative[i] = (float)(sum / total);
        sum += (double)counts[i] + 1.0;
    }
    cumulative[count] = 1.0f;
}

static void learn_plane(ppmi_guide_plane *plane,
                        const uint32_t counts[PPMI_GUIDE_SIDE][PPMI_GUIDE_SIDE])
{
    uint32_t rows[PPMI_GUIDE_SIDE];
    for (uint32_t row = 0; row < PPMI_GUIDE_SIDE; row++) {
        rows[row] = 0;
        for (uint32_t column = 0; column < PPMI_GUIDE_SIDE; column++)
            rows[row] += counts[row][column];
        accumulate(counts[row], PPMI_GUIDE_SIDE, plane->columns[row]);
    }
    accumulate(rows, PPMI_GUIDE_SIDE, plane->rows);
}

void ppmi_guide_learn(ppmi_photon_guide *guide, const ppmi_guide_counts *counts)
{
    accumulate(counts->picks, PPMI_GUIDE_PICKS, guide->picks);
    for (uint32_t group = 0; group < PPMI_GUIDE_GROUPS; group++) {
        for (uint32_t plane = 0; plane < 2; plane++) {
            learn_plane(&guide->planes[group][plane], counts->planes[group][plane]);
        }
    }
}

/* ---- drawing --------------------------------------------------------------------------------- */

/* The bin of a cumulative table that u falls to. */
static uint32_t find(const float *cumulative, uint32_t count, double u)
{
    uint32_t low = 0, high = count;
    while (high - low > 1) {
        const uint32_t middle = (low + high) / 2;
        if ((double)cumulative[middle] <= u) {
            low = middle;
        } else {
            high = middle;
        }
    }
    return low;
}

/* Moves u to where the density of the table takes it. */
static double warp(const float *cumulative, uint32_t count, double u)
{
    const uint32_t bin = find(cumulative, count, u);
    const double width = (double)cumulative[bin + 1] - (double)cumulative[bin];
    const double within = (u - (double)cumulative[bin]) / width;
    const double moved = ((double)bin + (within < 1.0 ? within : 0.5)) / (double)count;
    return moved < 1.0 ? moved : 0x1.fffffffffffffp-1;
}

static float density(const float *cumulative, uint32_t count, uint32_t bin)
{
    return (cumulative[bin + 1] - cumulative[bin]) * (float)count;
}

static float unit_float(double x)
{
    const float value = (float)x;
    return value < 1.0f ? value : 0x1.fffffep-1f;
}

static void warp_plane(const ppmi_guide_plane *plane, float *u, float *v)
{
    const double row = warp(plane->rows, PPMI_GUIDE_SIDE, (double)*u);
    *u = unit_float(row);
    const uint32_t bin = bin_of((double)*u, PPMI_GUIDE_SIDE);
    *v = unit_float(warp(plane->columns[bin], PPMI_GUIDE_SIDE, (double)*v));
}

static float plane_density(const ppmi_guide_plane *plane, float u, float v)
{
    const uint32_t row = bin_of((double)u, PPMI_GUIDE_SIDE);
    const uint32_t column = bin_of((double)v, PPMI_GUIDE_SIDE);
    return density(plane->rows, PPMI_GUIDE_SIDE, row) *
           density(plane->columns[row], PPMI_GUIDE_SIDE, column);
}

static float guided_density(const ppmi_photon_guide *guide, const ppmi_lights *lights,
                            const ppmi_emission_sample *sample)
{
    const ppmi_guide_plane *planes = guide->planes[group_of(lights, sample->pick)];
    const uint32_t pick = bin_of(sample->pick, PPMI_GUIDE_PICKS);
    return density(guide->picks, PPMI_GUIDE_PICKS, pick) *
           plane_density(&planes[0], sample->u[0], sample->u[1]) *
           plane_density(&planes[1], sample->u[2], sample->u[3]);
}

float ppmi_guide_density(const ppmi_photon_guide *guide, const ppmi_lights *lights,
                         const ppmi_emission_sample *sample)
{
    return PPMI_GUIDE_EVEN_SHARE +
           (1.0f - PPMI_GUIDE_EVEN_SHARE) * guided_density(guide, lights, sample);
}

/* The choice between the guide and an even sample is made by the pick, whose rest stays even. */
float ppmi_guide_warp(const ppmi_photon_guide *guide, const ppmi_lights *lights,
                      ppmi_emission_sample *sample)
{
    const double even = (double)PPMI_GUIDE_EVEN_SHARE;
    if (sample->pick < even) {
        sample->pick /= even;
    } else {
        const double pick = (sample->pick - even) / (1.0 - even);
        sample->pick = warp(guide->picks, PPMI_GUIDE_PICKS, pick);
        const ppmi_guide_plane *planes = guide->planes[group_of(lights, sample->pick)];
        warp_plane(&planes[0], &sample->u[0], &sample->u[1]);
        warp_plane(&planes[1], &sample->u[2], &sample->u[3]);
    }
    return ppmi_guide_density(guide, lights, sample);
}
