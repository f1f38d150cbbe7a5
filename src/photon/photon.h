/* Photons that landed, and the order in which they are kept. */
#ifndef PPMI_PHOTON_H
#define PPMI_PHOTON_H

#include <stdint.h>

#include "base/context.h"
#include "math/vec.h"

/* A photon at a surface that can gather. power is unnormalised: divide by the photons emitted. */
typedef struct ppmi_photon {
    ppmi_vec3 position;
    ppmi_vec3 wi; /* where it came from, unit */
    ppmi_vec3 power;
    ppmi_vec3 ng; /* geometric normal there, on wi's side */
} ppmi_photon;

/* A list that grows by doubling and keeps its memory from pass to pass. */
typedef struct ppmi_photon_list {
    ppmi_photon *photons;
    size_t count, capacity;
} ppmi_photon_list;

/* False when memory is out; the photon is then dropped. */
bool ppmi_photon_list_push(ppm_context *context, ppmi_photon_list *list, const ppmi_photon *photon);
bool ppmi_photon_list_reserve(ppm_context *context, ppmi_photon_list *list, size_t capacity);
void ppmi_photon_list_deinit(ppm_context *context, ppmi_photon_list *list);

#endif
