/* What is in a file, by kind, as ppm_asset_get_item gives it out. Filled by the importers. */
#ifndef PPMI_BASE_CATALOG_H
#define PPMI_BASE_CATALOG_H

#include <stdbool.h>

#include "base/context.h"
#include "ppm/asset.h"

#ifdef __cplusplus
extern "C" {
#endif

typedef struct ppmi_catalog_item {
    char *name, *detail; /* never NULL */
    double begin_s, end_s;
} ppmi_catalog_item;

typedef struct ppmi_catalog_list {
    ppmi_catalog_item *items;
    size_t count, capacity;
} ppmi_catalog_list;

typedef struct ppmi_catalog {
    ppm_context *context;
    ppmi_catalog_list lists[PPM_ASSET_KINDS];
    char *generator, *light_units; /* or NULL for none */
    bool is_out_of_memory;         /* something is missing */
} ppmi_catalog;

/* Adds an item at the end of the list of kind (PPM_ASSET_) and returns it; NULL when memory is out,
 * which the catalog remembers. name and detail are copied, safe for messages: each control
 * character and each byte that is not part of UTF-8 becomes '?'. */
ppmi_catalog_item *ppmi_catalog_add(ppmi_catalog *catalog, int32_t kind, const char *name,
                                    const char *detail);

/* A copy of text that is safe for messages; NULL when memory is out, which the catalog remembers.
 */
char *ppmi_catalog_text(ppmi_catalog *catalog, const char *text);

void ppmi_catalog_deinit(ppmi_catalog *catalog);

#ifdef __cplusplus
}
#endif

#endif
