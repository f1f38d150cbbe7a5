/* Photons that landed, and the order in which they are kept. */
#ifndef PPMI_PHOTON_H
#define PPMI_PHOTON_H

#include <stdint.h>

#include "base/context.h"
#include "math/vec.h"

/* What layers of light want to know of a photon (transport/light_layers.h). */
typedef struct ppmi_photon_tag {
    uint32_t group;      /* of its light */
    uint8_t is_straight; /* from the light */
    uint8_t caustic[3];  /* share of its light that is a caustic where it is gathered, of 255 */
} ppmi_photon_tag;

/* A photon at a surface that can gather, or where a medium scatters it. power is unnormalised:
 * divide by the photons emitted. In a medium it is power by extinction coefficient (power times
 * metres): the photons' density by volume times it is the fluence. */
typedef struct ppmi_photon {
    ppmi_vec3 position;
    ppmi_vec3 wi; /* where it came from, unit */
    ppmi_vec3 power;
    ppmi_vec3 ng;        /* geometric normal there, on wi's side; 0 in a medium */
    float crowding;      /* of a photon that came over mirrors and smooth glass only, its light's
                            (ppmi_lights_crowding); else 0 */
    uint32_t path;       /* of those of its walk */
    ppmi_photon_tag tag; /* where its walk tags them */
} ppmi_photon;

/* Photons at surfaces are found in disks, those in media in balls: kept apart. */
enum { PPMI_PHOTONS_SURFACE = 0, PPMI_PHOTONS_VOLUME = 1, PPMI_PHOTON_KINDS = 2 };

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
