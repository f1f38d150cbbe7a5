/* Vose 1991, "A Linear Algorithm for Generating Random Numbers with a Given Distribution". */
#include "math/alias.h"

static double sum_of(const float *weights, uint32_t count)
{
    double sum = 0.0;
    for (uint32_t i = 0; i < count; i++)
        sum += weights[i];
    return sum;
}

/* Splits the entries into those below and above the mean; small grows from the front of stack,
 * large from its end. */
static void fill_bins(ppmi_alias *table, const float *weights, double sum, uint32_t *stack,
                      double *scaled)
{
    const uint32_t count = table->count;
    uint32_t small = 0, large = count;
    for (uint32_t i = 0; i < count; i++) {
        const double probability = sum > 0.0 ? weights[i] / sum : 1.0 / count;
        table->bins[i].probability = (float)probability;
        table->bins[i].keep = 1.0f;
        table->bins[i].alias = i;
        scaled[i] = probability * count;
        if (scaled[i] < 1.0) {
            stack[small++] = i;
        } else {
            stack[--large] = i;
        }
    }
    while (small > 0 && large < count) {
        const uint32_t poor = stack[--small];
        const uint32_t rich = stack[large];
        table->bins[poor].keep = (float)scaled[poor];
        table->bins[poor].alias = rich;
        scaled[rich] -= 1.0 - scaled[poor];
        if (scaled[rich] < 1.0) {
            large++;
            stack[small++] = rich;
        }
    }
}

ppm_status ppmi_alias_init(ppm_context *context, ppmi_alias *table, const float *weights,
                           uint32_t count)
{
    if (count == 0) return ppmi_fail(context, PPM_STATUS_INVALID_ARGUMENT, "empty distribution");
    ppm_status status = PPM_STATUS_OUT_OF_MEMORY;
    uint32_t *stack = ppmi_alloc(context, count, sizeof *stack);
    double *scaled = ppmi_alloc(context, count, sizeof *scaled);
    table->count = count;
    table->bins = ppmi_alloc(context, count, sizeof *table->bins);
    if (stack && scaled && table->bins) {
        fill_bins(table, weights, sum_of(weights, count), stack, scaled);
        status = PPM_STATUS_OK;
    } else {
        ppmi_alias_deinit(context, table);
        ppmi_fail(context, status, "out of memory for a distribution of %u entries", count);
    }
    ppmi_free(context, scaled);
    ppmi_free(context, stack);
    return status;
}

void ppmi_alias_deinit(ppm_context *context, ppmi_alias *table)
{
    ppmi_free(context, table->bins);
    table->bins = NULL;
    table->count = 0;
}
