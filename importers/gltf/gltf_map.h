/* Whole files in memory. Large ones are mapped, so that the system reads what is used, when it is,
 * and may take it back: a file is then never held twice. */
#ifndef PPMI_GLTF_MAP_H
#define PPMI_GLTF_MAP_H

#include "base/context.h"

/* count bytes; the file may be longer. */
typedef struct ppmi_gltf_map {
    unsigned char *bytes;
    size_t count;
    size_t mapped_size; /* 0: the bytes are a block of the context */
} ppmi_gltf_map;

/* The first wanted bytes of a file, all of it for 0. A file that another program shortens while it
 * is mapped ends this one. Returns OK, INPUT_NOT_FOUND, INPUT_INVALID, OUT_OF_MEMORY, unreported,
 * with the reason. */
ppm_status ppmi_gltf_map_open(ppm_context *context, const char *path, size_t wanted,
                              ppmi_gltf_map *out, const char **reason);
/* Zeros are fine. */
void ppmi_gltf_map_close(ppm_context *context, ppmi_gltf_map *map);

/* Gives back the memory of what has been read so far; reading it again costs time only. */
void ppmi_gltf_map_forget(const ppmi_gltf_map *map);

#endif
