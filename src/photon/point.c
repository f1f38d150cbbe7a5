/* Lists of visible points. */
#include "photon/point.h"

#include <string.h>

bool ppmi_visible_points_reserve(ppm_context *context, ppmi_visible_points *list, size_t capacity)
{
    if (capacity <= list->capacity) return true;
    ppmi_visible_point *larger = ppmi_alloc(context, capacity, sizeof *larger);
    if (!larger) return false;
    if (list->count > 0) memcpy(larger, list->points, list->count * sizeof *larger);
    ppmi_free(context, list->points);
    list->points = larger;
    list->capacity = capacity;
    return true;
}

bool ppmi_visible_points_push(ppm_context *context, ppmi_visible_points *list,
                              const ppmi_visible_point *point)
{
    enum { FIRST_CAPACITY = 256 };
    if (list->count == list->capacity) {
        const size_t doubled = list->capacity > 0 ? 2 * list->capacity : FIRST_CAPACITY;
        if (!ppmi_visible_points_reserve(context, list, doubled)) return false;
    }
    list->points[list->count++] = *point;
    return true;
}

void ppmi_visible_points_deinit(ppm_context *context, ppmi_visible_points *list)
{
    ppmi_free(context, list->points);
    *list = (ppmi_visible_points){0};
}
