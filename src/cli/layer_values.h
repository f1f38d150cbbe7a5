/* Values of the options about layers and about how they are stored. */
#ifndef PPM_CLI_LAYER_VALUES_H
#define PPM_CLI_LAYER_VALUES_H

#include "option_table.h"

/* What the word "all" stands for: each kind's bit but that of what takes long, denoised. */
uint64_t layer_bits_of_all(void);

/* row->kind is one of VALUE_LAYERS, GROUPS, PACKING, TILES, RANKS. Returns an exit status. */
int option_store_layer_value(const option_table *table, const option_row *row, const char *text,
                             void *field);

#endif
