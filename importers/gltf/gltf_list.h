/* What is in a glTF file, by name. */
#ifndef PPMI_GLTF_LIST_H
#define PPMI_GLTF_LIST_H

#include "base/catalog.h"
#include "gltf/gltf_reader.h"

#ifdef __cplusplus
extern "C" {
#endif

/* Fills the catalog of a file that has been opened. Cameras and lights are those of the chosen
 * scene, in the order in which they are imported; everything else is in the file's order. */
void ppmi_gltf_fill_catalog(const ppmi_gltf_reader *reader, ppmi_catalog *catalog);

#ifdef __cplusplus
}
#endif

#endif
