/* What of a file is understood: one line for each extension, and for each part of the core format
 * that not every file uses. */
#ifndef PPMI_GLTF_REPORT_H
#define PPMI_GLTF_REPORT_H

#include "base/context.h"
#include "ppm/asset.h"

typedef struct ppmi_gltf_reader ppmi_gltf_reader;

/* One line. The strings belong to the report. */
typedef struct ppmi_gltf_feature {
    char *name;
    char *note; /* how it is approximated, or what is missing; "" */
    int32_t verdict;
} ppmi_gltf_feature;

typedef struct ppmi_gltf_report {
    ppmi_gltf_feature *items; /* in the order of their first notes */
    size_t count, capacity;
    bool out_of_memory; /* a note was lost; ppmi_gltf_report_finish tells */
} ppmi_gltf_report;

/* Notes a feature that the file uses: name and note are copied, verdict is PPM_FEATURE_. A name has
 * one line: of two notes the worse verdict stays, of equal ones the later. */
void ppmi_gltf_note_feature(ppmi_gltf_reader *reader, const char *name, int32_t verdict,
                            const char *note);

/* The line of a name, or NULL. */
const ppmi_gltf_feature *ppmi_gltf_find_feature(const ppmi_gltf_reader *reader, const char *name);

/* Once everything has been noted: logs a line for each feature, WARNING for what is ignored, INFO
 * for what is approximated, DEBUG for the rest. Returns OK; INPUT_UNSUPPORTED when something is
 * ignored and the options are strict; OUT_OF_MEMORY when a note was lost. */
ppm_status ppmi_gltf_report_finish(ppmi_gltf_reader *reader);

void ppmi_gltf_report_deinit(ppm_context *context, ppmi_gltf_report *report);

#endif
