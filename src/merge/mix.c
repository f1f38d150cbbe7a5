/* A render is a mean over its photons or passes, so the mean over several is theirs, weighted by
 * how many each has; and the variance of a mean of independent ones is the sum of their variances
 * times their squared shares. */
#include "merge/mix.h"

#include <math.h>
#include <string.h>

#include "merge/ranks.h"

static const size_t VALUES_AT_ONCE = (size_t)1 << 26; /* 256 MiB */

/* ---- memory ---------------------------------------------------------------------------------- */

static size_t ranks_most(const merge_plan *plan)
{
    return plan->source_count * MERGE_RANKS_MAX;
}

ppm_status merge_mixer_init(ppm_context *context, merge_source *sources, const merge_plan *plan,
                            merge_mixer *mixer)
{
    const size_t row_values = (size_t)sources[0].info.width * plan->channel_count;
    const size_t rows = VALUES_AT_ONCE / (row_values * plan->source_count);
    *mixer = (merge_mixer){.context = context, .sources = sources, .plan = plan};
    mixer->rows_max = rows < 1                        ? 1
                      : rows < sources[0].info.height ? (uint32_t)rows
                                                      : sources[0].info.height;
    mixer->rows = ppmi_alloc_zeroed(context, plan->source_count, sizeof *mixer->rows);
    mixer->ranks = ppmi_alloc(context, ranks_most(plan), sizeof *mixer->ranks);
    bool has_memory = mixer->rows && mixer->ranks;
    for (size_t s = 0; s < plan->source_count && has_memory; s++) {
        mixer->total_weight += sources[s].weight;
        mixer->rows[s] = ppmi_alloc(context, row_values, mixer->rows_max * sizeof(float));
        has_memory = mixer->rows[s] != NULL;
    }
    if (has_memory) return PPM_STATUS_OK;
    return ppmi_fail(context, PPM_STATUS_OUT_OF_MEMORY, "out of memory: %u rows of %zu files",
                     mixer->rows_max, plan->source_count);
}

void merge_mixer_deinit(merge_mixer *mixer)
{
    for (size_t s = 0; mixer->rows && s < mixer->plan->source_count; s++)
        ppmi_free(mixer->context, mixer->rows[s]);
    ppmi_free(mixer->context, mixer->rows);
    ppmi_free(mixer->context, mixer->ranks);
}

/* ---- one pixel ------------------------------------------------------------------------------- */

/* A source's value of a channel of the plan. */
static float value_of(const merge_mixer *mixer, size_t source, size_t pixel, uint32_t channel)
{
    const merge_plan *const plan = mixer->plan;
    return mixer->rows[source][pixel * plan->channel_count + plan->places[source][channel]];
}

static double mix_mean(const merge_mixer *mixer, size_t pixel, uint32_t channel)
{
    double sum = 0;
    for (size_t s = 0; s < mixer->plan->source_count; s++)
        sum += mixer->sources[s].weight * (double)value_of(mixer, s, pixel, channel);
    return sum / mixer->total_weight;
}

static double mix_sum(const merge_mixer *mixer, size_t pixel, uint32_t channel)
{
    double sum = 0;
    for (size_t s = 0; s < mixer->plan->source_count; s++)
        sum += (double)value_of(mixer, s, pixel, channel);
    return sum;
}

static double mix_variance(const merge_mixer *mixer, size_t pixel, uint32_t channel)
{
    double sum = 0;
    for (size_t s = 0; s < mixer->plan->source_count; s++) {
        const double share = mixer->sources[s].weight / mixer->total_weight;
        sum += share * share * (double)value_of(mixer, s, pixel, channel);
    }
    return sum;
}

static void mix_matte(const merge_mixer *mixer, const merge_matte *matte, size_t pixel, float *out)
{
    size_t count = 0;
    for (size_t s = 0; s < mixer->plan->source_count; s++) {
        const double share = mixer->sources[s].weight / mixer->total_weight;
        for (uint32_t i = 0; i < matte->rank_count; i++) {
            const float id = value_of(mixer, s, pixel, matte->ids[i]);
            merge_rank *const rank = &mixer->ranks[count++];
            memcpy(&rank->id, &id, sizeof rank->id);
            rank->coverage = share * (double)value_of(mixer, s, pixel, matte->coverages[i]);
        }
    }
    count = merge_ranks(mixer->ranks, count);
    for (uint32_t i = 0; i < matte->rank_count; i++) {
        const merge_rank rank = i < count ? mixer->ranks[i] : (merge_rank){0};
        memcpy(&out[matte->ids[i]], &rank.id, sizeof rank.id);
        out[matte->coverages[i]] = (float)rank.coverage;
    }
}

static void mix_pixel(const merge_mixer *mixer, size_t pixel, float *out)
{
    const merge_plan *const plan = mixer->plan;
    for (uint32_t c = 0; c < plan->channel_count; c++) {
        switch (plan->rules[c]) {
        case MERGE_MEAN:
            out[c] = (float)mix_mean(mixer, pixel, c);
            break;
        case MERGE_SUM:
            out[c] = (float)mix_sum(mixer, pixel, c);
            break;
        case MERGE_VARIANCE:
            out[c] = (float)mix_variance(mixer, pixel, c);
            break;
        case MERGE_FIRST:
            out[c] = value_of(mixer, 0, pixel, c);
            break;
        }
    }
    for (uint32_t i = 0; i < plan->matte_count; i++)
        mix_matte(mixer, &plan->mattes[i], pixel, out);
}

/* ---- rows ------------------------------------------------------------------------------------ */

/* ppm-render writes numbers only: what is none would spoil the mean, and tells of a damaged file.
 */
static ppm_status check_numbers(const merge_mixer *mixer, size_t source, uint32_t y,
                                size_t pixel_count)
{
    const merge_plan *const plan = mixer->plan;
    const ppmi_layered_info *const info = &mixer->sources[source].info;
    for (size_t i = 0; i < pixel_count; i++) {
        for (uint32_t c = 0; c < plan->channel_count; c++) {
            const bool is_mean = plan->rules[c] != MERGE_FIRST && plan->rules[c] != MERGE_RANKS;
            const float value = value_of(mixer, source, i, c);
            if (!is_mean || isfinite(value)) continue;
            return ppmi_fail(mixer->context, PPM_STATUS_INPUT_INVALID,
                             "%s: channel '%s' is %g at pixel %u,%u: not a number to merge",
                             mixer->sources[source].path,
                             ppmi_layered_input_channel(mixer->sources[0].input, c), (double)value,
                             (uint32_t)(i % info->width), y + (uint32_t)(i / info->width));
        }
    }
    return PPM_STATUS_OK;
}

static ppm_status mix_some_rows(merge_mixer *mixer, uint32_t y, uint32_t row_count, float *values)
{
    const merge_plan *const plan = mixer->plan;
    const size_t pixel_count = (size_t)mixer->sources[0].info.width * row_count;
    for (size_t s = 0; s < plan->source_count; s++) {
        ppm_status status = ppmi_layered_input_read(mixer->context, mixer->sources[s].input, y,
                                                    row_count, mixer->rows[s]);
        if (status == PPM_STATUS_OK) status = check_numbers(mixer, s, y, pixel_count);
        if (status != PPM_STATUS_OK) return status;
    }
    for (size_t i = 0; i < pixel_count; i++)
        mix_pixel(mixer, i, values + i * plan->channel_count);
    return PPM_STATUS_OK;
}

ppm_status merge_mix_rows(void *user, uint32_t part, uint32_t y, uint32_t row_count, float *values)
{
    merge_mixer *const mixer = user;
    const size_t row_values = (size_t)mixer->sources[0].info.width * mixer->plan->channel_count;
    (void)part;
    for (uint32_t done = 0; done < row_count;) {
        const uint32_t left = row_count - done;
        const uint32_t rows = left < mixer->rows_max ? left : mixer->rows_max;
        const ppm_status status = mix_some_rows(mixer, y + done, rows, values + done * row_values);
        if (status != PPM_STATUS_OK) return status;
        done += rows;
    }
    return PPM_STATUS_OK;
}
