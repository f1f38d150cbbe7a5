/* Photon lists. */
#include "photon/photon.h"

#include <string.h>

bool ppmi_photon_list_reserve(ppm_context *context, ppmi_photon_list *list, size_t capacity)
{
    if (capacity <= list->capacity) return true;
    ppmi_photon *larger = ppmi_alloc(context, capacity, sizeof *larger);
    if (!larger) return false;
    if (list->count > 0) memcpy(larger, list->photons, list->count * sizeof *larger);
    ppmi_free(context, list->photons);
    list->photons = larger;
    list->capacity = capacity;
    return true;
}

bool ppmi_photon_list_push(ppm_context *context, ppmi_photon_list *list, const ppmi_photon *photon)
{
    enum { FIRST_CAPACITY = 1024 };
    if (list->count == list->capacity) {
        const size_t doubled = list->capacity > 0 ? 2 * list->capacity : FIRST_CAPACITY;
        if (!ppmi_photon_list_reserve(context, list, doubled)) return false;
    }
    list->photons[list->count++] = *photon;
    return true;
}

void ppmi_photon_list_deinit(ppm_context *context, ppmi_photon_list *list)
{
    ppmi_free(context, list->photons);
    *list = (ppmi_photon_list){0};
}
