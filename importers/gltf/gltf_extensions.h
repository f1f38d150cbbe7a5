/* Which glTF extensions the importer reads. */
#ifndef PPMI_GLTF_EXTENSIONS_H
#define PPMI_GLTF_EXTENSIONS_H

#include "gltf/gltf_reader.h"

/* INPUT_UNSUPPORTED for a required extension that is not read; a warning for each that is used and
 * not read. */
ppm_status ppmi_gltf_check_extensions(ppmi_gltf_reader *reader);

#endif
