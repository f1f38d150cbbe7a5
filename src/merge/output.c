/* The header is that of the first file but for what has been added up. It says the seeds of all, so
 * that a merged file can be merged again, and not with what is in it. */
#include "merge/output.h"

#include <inttypes.h>
#include <limits.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "imageio/layered.h"

/* ---- totals ---------------------------------------------------------------------------------- */

static int compare_numbers(const void *a, const void *b)
{
    const uint64_t x = *(const uint64_t *)a, y = *(const uint64_t *)b;
    return x < y ? -1 : x > y;
}

/* All seeds, rising. */
static char *write_seeds(ppm_context *context, const merge_source *sources, size_t count)
{
    enum { DIGITS = 21 };
    size_t total = 0, at = 0;
    for (size_t s = 0; s < count; s++)
        total += sources[s].seed_count;
    uint64_t *const all = ppmi_alloc(context, total, sizeof *all);
    char *const text = ppmi_alloc(context, total, DIGITS);
    if (all && text) {
        for (size_t s = 0; s < count; s++) {
            memcpy(all + at, sources[s].seeds, sources[s].seed_count * sizeof *all);
            at += sources[s].seed_count;
        }
        qsort(all, total, sizeof *all, compare_numbers);
        char *end = text;
        for (size_t i = 0; i < total; i++)
            end += snprintf(end, DIGITS, "%s%" PRIu64, i ? " " : "", all[i]);
    }
    ppmi_free(context, all);
    if (all) return text;
    ppmi_free(context, text);
    return NULL;
}

ppm_status merge_totals_init(ppm_context *context, const merge_source *sources, size_t count,
                             merge_totals *totals)
{
    *totals = (merge_totals){0};
    for (size_t s = 0; s < count; s++) {
        totals->passes += sources[s].passes;
        totals->photons += sources[s].photons;
        totals->seconds += sources[s].seconds;
    }
    totals->seeds = write_seeds(context, sources, count);
    if (totals->seeds) return PPM_STATUS_OK;
    return ppmi_fail(context, PPM_STATUS_OUT_OF_MEMORY, "out of memory: seeds");
}

/* ---- header ---------------------------------------------------------------------------------- */

/* What the merged file says itself, or the writer. */
static bool is_replaced(const char *name)
{
    static const char *const names[] = {"ppm:passes",  "ppm:photons", "ppm:seed",   "ppm:seeds",
                                        "ppm:seconds", "ppm:options", "ppm:merge",  "compression",
                                        "DateTime",    "name",        "chunkCount", "type"};
    for (size_t i = 0; i < sizeof names / sizeof names[0]; i++) {
        if (strcmp(name, names[i]) == 0) return true;
    }
    return false;
}

/* The options without the seed of the first file. */
static void drop_seed(char *options)
{
    char *const begin = strstr(options, " seed=");
    if (!begin) return;
    char *const end = begin + 1 + strcspn(begin + 1, " ");
    memmove(begin, end, strlen(end) + 1);
}

static ppmi_image_attribute text_attribute(const char *name, const char *text)
{
    return (ppmi_image_attribute){.name = name, .type = PPMI_ATTRIBUTE_STRING, .text = text};
}

/* As ppm-render writes it: what is too large for a number is text. */
static ppmi_image_attribute count_attribute(const char *name, uint64_t value, char buffer[24])
{
    if (value <= INT64_MAX) {
        return (ppmi_image_attribute){
            .name = name, .type = PPMI_ATTRIBUTE_INT, .integer = (int64_t)value};
    }
    snprintf(buffer, 24, "%" PRIu64, value);
    return text_attribute(name, buffer);
}

/* ---- the file -------------------------------------------------------------------------------- */

static ppm_status write_with(merge_mixer *mixer, const merge_options *options,
                             const ppmi_image_attribute *attributes, uint32_t attribute_count,
                             ppmi_layered_channel *channels)
{
    const merge_plan *const plan = mixer->plan;
    const merge_source *const first = &mixer->sources[0];
    for (uint32_t i = 0; i < plan->channel_count; i++) {
        const bool is_half = options->is_half && plan->rules[i] == MERGE_MEAN;
        channels[i] = (ppmi_layered_channel){.name = ppmi_layered_input_channel(first->input, i),
                                             .store = is_half ? PPMI_STORE_HALF : PPMI_STORE_FLOAT};
    }
    const ppmi_layered_part part = {.channel_count = plan->channel_count, .channels = channels};
    const ppmi_layered_file file = {.width = first->info.width,
                                    .height = first->info.height,
                                    .full_width = first->info.full_width,
                                    .full_height = first->info.full_height,
                                    .x = (uint32_t)first->info.x,
                                    .y = (uint32_t)first->info.y,
                                    .compression = options->compression,
                                    .part_count = 1,
                                    .parts = &part,
                                    .attribute_count = attribute_count,
                                    .attributes = attributes,
                                    .read_rows = merge_mix_rows,
                                    .user = mixer};
    return ppmi_imageio_write_layered(mixer->context, options->output, &file);
}

/* Fills the attributes; there is room for OWN_ATTRIBUTES more than the source has. */
enum { OWN_ATTRIBUTES = 6 };
static uint32_t fill_attributes(const merge_source *first, const merge_totals *totals,
                                const char *options, const char *command, const float *seconds,
                                char texts[2][24], ppmi_image_attribute *out)
{
    const uint32_t count = ppmi_layered_input_attribute_count(first->input);
    uint32_t at = 0;
    for (uint32_t i = 0; i < count; i++) {
        const ppmi_image_attribute *const each = ppmi_layered_input_attribute(first->input, i);
        if (!is_replaced(each->name)) out[at++] = *each;
    }
    out[at++] = count_attribute("ppm:passes", totals->passes, texts[0]);
    out[at++] = count_attribute("ppm:photons", totals->photons, texts[1]);
    out[at++] = text_attribute("ppm:seeds", totals->seeds);
    out[at++] = text_attribute("ppm:options", options);
    out[at++] = text_attribute("ppm:merge", command);
    out[at++] = (ppmi_image_attribute){
        .name = "ppm:seconds", .type = PPMI_ATTRIBUTE_FLOAT, .floats = seconds};
    return at;
}

ppm_status merge_write(merge_mixer *mixer, const merge_options *options, const char *command,
                       const merge_totals *totals)
{
    ppm_context *const context = mixer->context;
    const merge_source *const first = &mixer->sources[0];
    char buffer[32], texts[2][24];
    const float seconds = (float)totals->seconds;
    const uint32_t most = ppmi_layered_input_attribute_count(first->input) + OWN_ATTRIBUTES;
    ppmi_image_attribute *const attributes = ppmi_alloc(context, most, sizeof *attributes);
    ppmi_layered_channel *const channels =
        ppmi_alloc(context, mixer->plan->channel_count, sizeof *channels);
    char *const rendered =
        ppmi_string_copy(context, merge_source_text(first, "ppm:options", buffer, sizeof buffer));
    ppm_status status;
    if (attributes && channels && rendered) {
        drop_seed(rendered);
        const uint32_t count =
            fill_attributes(first, totals, rendered, command, &seconds, texts, attributes);
        status = write_with(mixer, options, attributes, count, channels);
    } else {
        status = ppmi_fail(context, PPM_STATUS_OUT_OF_MEMORY, "%s: no memory to write it",
                           options->output);
    }
    ppmi_free(context, rendered);
    ppmi_free(context, channels);
    ppmi_free(context, attributes);
    return status;
}
