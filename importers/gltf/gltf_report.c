/* The import report: a small table, searched from its beginning. A file has some dozens of lines at
 * most (gltf_extensions.c bounds the extensions). */
#include "gltf/gltf_report.h"

#include <stdio.h>
#include <string.h>

#include "gltf/gltf_patch.h"
#include "gltf/gltf_reader.h"

static ppmi_gltf_feature *find(const ppmi_gltf_report *report, const char *name)
{
    for (size_t i = 0; i < report->count; ++i) {
        if (strcmp(report->items[i].name, name) == 0) return &report->items[i];
    }
    return NULL;
}

const ppmi_gltf_feature *ppmi_gltf_find_feature(const ppmi_gltf_reader *reader, const char *name)
{
    return find(&reader->report, name);
}

/* A new line, without note. NULL when memory is out. */
static ppmi_gltf_feature *add(ppm_context *context, ppmi_gltf_report *report, const char *name)
{
    ppmi_gltf_feature *items =
        ppmi_gltf_grow(context, report->items, report->count, &report->capacity, sizeof *items);
    if (!items) return NULL;
    report->items = items;
    char *copy = ppmi_string_copy(context, name);
    if (!copy) return NULL;
    ppmi_gltf_feature *added = &items[report->count++];
    *added = (ppmi_gltf_feature){.name = copy, .verdict = PPM_FEATURE_HONOURED};
    return added;
}

void ppmi_gltf_note_feature(ppmi_gltf_reader *reader, const char *name, int32_t verdict,
                            const char *note)
{
    ppmi_gltf_report *report = &reader->report;
    ppmi_gltf_feature *feature = find(report, name);
    if (feature && feature->verdict > verdict) return;
    if (!feature) feature = add(reader->context, report, name);
    char *copy = feature ? ppmi_string_copy(reader->context, note) : NULL;
    if (!copy) {
        report->out_of_memory = true;
        return;
    }
    ppmi_free(reader->context, feature->note);
    feature->note = copy;
    feature->verdict = verdict;
}

/* ---- the end --------------------------------------------------------------------------------- */

static void log_feature(const ppmi_gltf_reader *reader, const ppmi_gltf_feature *feature)
{
    static const struct {
        const char *word;
        ppm_log_level level;
    } verdicts[] = {[PPM_FEATURE_HONOURED] = {"honoured", PPM_LOG_DEBUG},
                    [PPM_FEATURE_APPROXIMATED] = {"approximated", PPM_LOG_INFO},
                    [PPM_FEATURE_IGNORED] = {"ignored", PPM_LOG_WARNING}};
    ppmi_log(reader->context, verdicts[feature->verdict].level, "%s: %s: %s%s%s", reader->path,
             verdicts[feature->verdict].word, feature->name, feature->note[0] ? ": " : "",
             feature->note);
}

/* "a, b and 3 more" of what is ignored. */
static void list_ignored(const ppmi_gltf_report *report, char *text, size_t size)
{
    const size_t room = size - 24; /* for the end */
    size_t length = 0, left_out = 0;
    text[0] = 0;
    for (size_t i = 0; i < report->count; ++i) {
        const ppmi_gltf_feature *feature = &report->items[i];
        if (feature->verdict != PPM_FEATURE_IGNORED) continue;
        if (left_out > 0 || length + strlen(feature->name) + 3 > room) {
            ++left_out;
            continue;
        }
        length += (size_t)snprintf(text + length, room - length, "%s%s", length > 0 ? ", " : "",
                                   feature->name);
    }
    if (left_out > 0) snprintf(text + length, size - length, " and %zu more", left_out);
}

ppm_status ppmi_gltf_report_finish(ppmi_gltf_reader *reader)
{
    const ppmi_gltf_report *report = &reader->report;
    char ignored[400];
    if (report->out_of_memory) return ppmi_gltf_out_of_memory(reader, "the import report");
    for (size_t i = 0; i < report->count; ++i) {
        log_feature(reader, &report->items[i]);
    }
    list_ignored(report, ignored, sizeof ignored);
    if (!reader->options->strict || !ignored[0]) return PPM_STATUS_OK;
    return ppmi_fail(reader->context, PPM_STATUS_INPUT_UNSUPPORTED,
                     "%s: strict: the file uses what is ignored: %s", reader->path, ignored);
}

void ppmi_gltf_report_deinit(ppm_context *context, ppmi_gltf_report *report)
{
    for (size_t i = 0; i < report->count; ++i) {
        ppmi_free(context, report->items[i].name);
        ppmi_free(context, report->items[i].note);
    }
    ppmi_free(context, report->items);
    *report = (ppmi_gltf_report){0};
}
