/* What is in an OBJ file, by name. */
#ifndef PPMI_OBJ_LIST_H
#define PPMI_OBJ_LIST_H

#include "base/catalog.h"
#include "obj/obj_import.h"

#ifdef __cplusplus
extern "C" {
#endif

/* Fills the catalog of a file that has been opened: objects and groups as nodes, and the materials
 * that they use. */
void ppmi_obj_fill_catalog(const ppmi_obj_asset *asset, ppmi_catalog *catalog);

#ifdef __cplusplus
}
#endif

#endif
