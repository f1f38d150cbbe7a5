#include "merge/source.h"

#include <errno.h>
#include <inttypes.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

const char *merge_source_text(const merge_source *source, const char *name, char *buffer,
                              size_t size)
{
    const ppmi_image_attribute *const attribute = ppmi_layered_input_find(source->input, name);
    if (!attribute) return "";
    switch (attribute->type) {
    case PPMI_ATTRIBUTE_STRING:
        return attribute->text ? attribute->text : "";
    case PPMI_ATTRIBUTE_INT:
        snprintf(buffer, size, "%" PRId64, attribute->integer);
        return buffer;
    case PPMI_ATTRIBUTE_FLOAT:
        snprintf(buffer, size, "%.9g", (double)attribute->floats[0]);
        return buffer;
    }
    return "";
}

/* ---- numbers in the header ------------------------------------------------------------------- */

/* A whole number that text begins with; *out_end is behind it. */
static bool take_number(const char *text, uint64_t *out_number, const char **out_end)
{
    char *end = NULL;
    if (*text < '0' || *text > '9') return false;
    errno = 0;
    *out_number = strtoull(text, &end, 10);
    *out_end = end;
    return errno == 0;
}

static ppm_status read_count(ppm_context *context, const merge_source *source, const char *name,
                             uint64_t *out_count)
{
    char buffer[32];
    const char *const text = merge_source_text(source, name, buffer, sizeof buffer), *end = NULL;
    if (take_number(text, out_count, &end) && *end == '\0') return PPM_STATUS_OK;
    return ppmi_fail(context, PPM_STATUS_INPUT_INVALID,
                     "%s: %s in its header is '%s', not a whole number", source->path, name, text);
}

static int compare_numbers(const void *a, const void *b)
{
    const uint64_t x = *(const uint64_t *)a, y = *(const uint64_t *)b;
    return x < y ? -1 : x > y;
}

/* Of a render one, of a merged file several: "3 7 12". */
static ppm_status read_seeds(ppm_context *context, merge_source *source)
{
    char buffer[32];
    const char *text = merge_source_text(source, "ppm:seeds", buffer, sizeof buffer);
    const char *const name = *text ? "ppm:seeds" : "ppm:seed";
    if (!*text) text = merge_source_text(source, name, buffer, sizeof buffer);
    source->seeds = ppmi_alloc(context, strlen(text) / 2 + 1, sizeof *source->seeds);
    if (!source->seeds) {
        return ppmi_fail(context, PPM_STATUS_OUT_OF_MEMORY, "%s: no memory to read it",
                         source->path);
    }
    const char *rest = text;
    while (take_number(rest, &source->seeds[source->seed_count], &rest)) {
        source->seed_count++;
        if (*rest == '\0') break;
        if (*rest == ' ') rest++;
    }
    if (source->seed_count == 0 || *rest) {
        return ppmi_fail(context, PPM_STATUS_INPUT_INVALID,
                         "%s: %s in its header is '%s', not whole numbers", source->path, name,
                         text);
    }
    qsort(source->seeds, source->seed_count, sizeof *source->seeds, compare_numbers);
    return PPM_STATUS_OK;
}

static ppm_status read_header(ppm_context *context, merge_source *source)
{
    static const char *const needed[] = {"ppm:integrator", "ppm:options", "ppm:sceneDigest",
                                         "ppm:cameraDigest"};
    char buffer[32];
    for (size_t i = 0; i < sizeof needed / sizeof needed[0]; i++) {
        if (*merge_source_text(source, needed[i], buffer, sizeof buffer)) continue;
        return ppmi_fail(context, PPM_STATUS_INPUT_INVALID,
                         "%s: not a picture of ppm-render's that can be merged: its header has no "
                         "%s",
                         source->path, needed[i]);
    }
    ppm_status status = read_count(context, source, "ppm:passes", &source->passes);
    if (status == PPM_STATUS_OK) {
        status = read_count(context, source, "ppm:photons", &source->photons);
    }
    if (status == PPM_STATUS_OK && source->passes == 0) {
        status =
            ppmi_fail(context, PPM_STATUS_INPUT_INVALID, "%s: a picture of no pass", source->path);
    }
    if (status == PPM_STATUS_OK) status = read_seeds(context, source);
    const ppmi_image_attribute *const seconds =
        ppmi_layered_input_find(source->input, "ppm:seconds");
    if (seconds && seconds->type == PPMI_ATTRIBUTE_FLOAT) {
        source->seconds = (double)seconds->floats[0];
    }
    return status;
}

ppm_status merge_source_open(ppm_context *context, const char *path, merge_source *source)
{
    *source = (merge_source){.path = path};
    const ppm_status status = ppmi_layered_input_open(context, path, &source->input, &source->info);
    return status == PPM_STATUS_OK ? read_header(context, source) : status;
}

void merge_source_close(ppm_context *context, merge_source *source)
{
    ppmi_layered_input_close(context, source->input);
    ppmi_free(context, source->seeds);
    *source = (merge_source){0};
}

uint32_t merge_source_channel(const merge_source *source, const char *name)
{
    for (uint32_t i = 0; i < source->info.channel_count; i++) {
        if (strcmp(ppmi_layered_input_channel(source->input, i), name) == 0) return i;
    }
    return UINT32_MAX;
}

/* ---- all of them ----------------------------------------------------------------------------- */

static int compare_sources(const void *a, const void *b)
{
    const merge_source *const x = a, *const y = b;
    return compare_numbers(&x->seeds[0], &y->seeds[0]);
}

/* A path tracer sends no photons, and neither does a scene whose lights reach nothing. */
static bool photons_count(const merge_source *sources, size_t count)
{
    for (size_t i = 0; i < count; i++) {
        if (sources[i].photons == 0) return false;
    }
    return true;
}

void merge_sources_prepare(merge_source *sources, size_t count)
{
    char buffer[32];
    const char *const integrator =
        merge_source_text(&sources[0], "ppm:integrator", buffer, sizeof buffer);
    const bool by_photons = strcmp(integrator, "path") != 0 && photons_count(sources, count);
    qsort(sources, count, sizeof *sources, compare_sources);
    for (size_t i = 0; i < count; i++)
        sources[i].weight = (double)(by_photons ? sources[i].photons : sources[i].passes);
}
