/* Values of ppm-render's options that are more than a number, a name or a text. */
#ifndef PPM_CLI_OPTION_VALUES_H
#define PPM_CLI_OPTION_VALUES_H

#include "option_table.h"

enum {
    VALUE_OUTPUT = OPTION_OWN, /* one more of the cli_outputs */
    VALUE_SIZE,                /* image_size; least and most of each side */
    VALUE_SUN,                 /* sun_choice */
    VALUE_BACKGROUND,          /* background_choice */
    VALUE_FOG,                 /* fog_values */
    VALUE_SPLIT,               /* int32_t: a number, 0 stored as -1 */
    VALUE_SHUTTER,             /* shutter_times */
    VALUE_RATE,                /* double, also as a fraction; low and high */
    VALUE_CROP,                /* crop_window */
    VALUE_FILTER,              /* filter_choice, from a list of names; low and high of the width */
    VALUE_FRAME,               /* frame_choice: one */
    VALUE_FRAMES,              /* frame_choice: several */
    VALUE_TEXTURE_FOLDER,      /* one more of the texture_folders */
    VALUE_CATCHER,             /* one more of the catchers */
    VALUE_TEXTURE_SPACE,       /* one more of the texture spaces */
    VALUE_LIST,                /* int32_t, from a list of names, may be missing; and the action */
    VALUE_LAYERS,              /* uint64_t: bits of the layers that a list names */
    VALUE_GROUPS,              /* int32_t, from a list of names, may be missing */
    VALUE_PACKING,             /* packing_choice, from a list of names */
    VALUE_TILES,               /* uint32_t, may be missing */
    VALUE_RANKS                /* uint64_t, even */
};

/* The table's store_own; options is a cli_options. */
int option_store_own(const option_table *table, const option_row *row, const char *text,
                     void *options);

#endif
