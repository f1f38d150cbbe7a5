#include "gltf/gltf_choice.h"

#include <stdio.h>
#include <string.h>

#include "base/suggest.h"

/* "'a', 'b', ..." */
static void list_names(const char *const *names, size_t count, char *text, size_t size)
{
    size_t used = 0;
    char shown[64];
    text[0] = 0;
    for (size_t i = 0; i < count && used + 80 < size; ++i) {
        ppmi_gltf_printable(names[i], strlen(names[i]), shown, sizeof shown);
        used += (size_t)snprintf(text + used, size - used, "%s'%s'", i > 0 ? ", " : "", shown);
        if (i + 1 < count && used + 80 >= size) snprintf(text + used, size - used, ", ...");
    }
}

static ppm_status refuse(ppmi_gltf_reader *reader, const char *what, const char *wanted,
                         const char *const *names, size_t count)
{
    char list[400], near_by[64], shown[64];
    const char *nearest = ppmi_suggest(wanted, names, count);
    ppmi_gltf_printable(wanted, strlen(wanted), shown, sizeof shown);
    if (count == 0) {
        return ppmi_fail(reader->context, PPM_STATUS_INVALID_ARGUMENT,
                         "%s: no %s '%s': the file has none", reader->path, what, shown);
    }
    list_names(names, count, list, sizeof list);
    if (nearest) ppmi_gltf_printable(nearest, strlen(nearest), near_by, sizeof near_by);
    return ppmi_fail(reader->context, PPM_STATUS_INVALID_ARGUMENT,
                     "%s: no %s '%s'%s%s%s; there are %zu: %s", reader->path, what, shown,
                     nearest ? "; did you mean '" : "", nearest ? near_by : "", nearest ? "'?" : "",
                     count, list);
}

ppm_status ppmi_gltf_choose(ppmi_gltf_reader *reader, const char *what, const char *wanted,
                            const char *const *names, size_t count, bool allow_number,
                            int32_t *out_index)
{
    unsigned number;
    char end;
    for (size_t i = 0; i < count; ++i) {
        if (strcmp(names[i], wanted) != 0) continue;
        *out_index = (int32_t)i;
        return PPM_STATUS_OK;
    }
    const bool is_number = allow_number && wanted[0] >= '0' && wanted[0] <= '9' &&
                           sscanf(wanted, "%9u%c", &number, &end) == 1;
    if (!is_number || number >= count) return refuse(reader, what, wanted, names, count);
    *out_index = (int32_t)number;
    return PPM_STATUS_OK;
}
