/* Files, mapped or read. */
#include "gltf/gltf_map.h"

#include <stdio.h>
#include <sys/mman.h>
#include <sys/stat.h>

#define MIN_MAPPED ((size_t)4 << 20) /* below, reading is as fast */

/* Opens a regular file (no folder, pipe or device) and finds its size; NULL when that fails. */
static FILE *open_regular(const char *path, size_t *out_size)
{
    struct stat info;
    FILE *file = fopen(path, "rb");
    if (!file) return NULL;
    if (fstat(fileno(file), &info) != 0 || !S_ISREG(info.st_mode)) {
        fclose(file);
        return NULL;
    }
    *out_size = (size_t)info.st_size;
    return file;
}

/* False when the system cannot: the file is then read. */
static bool map(FILE *file, ppmi_gltf_map *out)
{
    void *bytes = mmap(NULL, out->count, PROT_READ, MAP_PRIVATE, fileno(file), 0);
    if (bytes == MAP_FAILED) return false;
    out->bytes = bytes;
    out->mapped_size = out->count;
    return true;
}

static ppm_status read_all(ppm_context *context, FILE *file, ppmi_gltf_map *out,
                           const char **reason)
{
    *reason = "out of memory";
    out->bytes = ppmi_alloc(context, out->count, 1);
    if (!out->bytes) return PPM_STATUS_OUT_OF_MEMORY;
    *reason = "the file cannot be read";
    if (fread(out->bytes, 1, out->count, file) == out->count) return PPM_STATUS_OK;
    ppmi_free(context, out->bytes);
    out->bytes = NULL;
    return PPM_STATUS_INPUT_INVALID;
}

ppm_status ppmi_gltf_map_open(ppm_context *context, const char *path, size_t wanted,
                              ppmi_gltf_map *out, const char **reason)
{
    size_t size = 0;
    ppm_status status = PPM_STATUS_INPUT_INVALID;
    FILE *file = open_regular(path, &size);
    *out = (ppmi_gltf_map){0};
    *reason = "the file cannot be opened";
    if (!file) return PPM_STATUS_INPUT_NOT_FOUND;
    out->count = wanted > 0 ? wanted : size;
    if (size == 0) {
        *reason = "the file is empty";
    } else if (size < out->count) {
        *reason = "the file is shorter than byteLength";
    } else if (out->count >= MIN_MAPPED && map(file, out)) {
        status = PPM_STATUS_OK;
    } else {
        status = read_all(context, file, out, reason);
    }
    fclose(file);
    return status;
}

void ppmi_gltf_map_close(ppm_context *context, ppmi_gltf_map *map)
{
    if (map->mapped_size > 0) {
        munmap(map->bytes, map->mapped_size);
    } else {
        ppmi_free(context, map->bytes);
    }
    *map = (ppmi_gltf_map){0};
}

void ppmi_gltf_map_forget(const ppmi_gltf_map *map)
{
    if (map->mapped_size > 0) madvise(map->bytes, map->mapped_size, MADV_DONTNEED);
}
