/* Choosing one of a list by its name. */
#ifndef PPMI_GLTF_CHOICE_H
#define PPMI_GLTF_CHOICE_H

#include "gltf/gltf_reader.h"

/* The first of count names that is wanted, or else, if numbers are allowed, the one that wanted
 * counts from 0. what is the kind, "scene", for the message. Returns OK, INVALID_ARGUMENT with the
 * names that there are and the nearest one, OUT_OF_MEMORY. */
ppm_status ppmi_gltf_choose(ppmi_gltf_reader *reader, const char *what, const char *wanted,
                            const char *const *names, size_t count, bool allow_number,
                            int32_t *out_index);

#endif
