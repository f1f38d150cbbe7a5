/* Which glTF extensions the importer reads, and which parts of the core format. */
#ifndef PPMI_GLTF_EXTENSIONS_H
#define PPMI_GLTF_EXTENSIONS_H

#include "gltf/gltf_reader.h"

/* Notes every extension that is used in the report. INPUT_UNSUPPORTED for a required extension that
 * is not read. */
ppm_status ppmi_gltf_check_extensions(ppmi_gltf_reader *reader);

/* gltf_features.c: notes skins, animations, vertex colours and the like. */
void ppmi_gltf_note_core_features(ppmi_gltf_reader *reader);

#endif
