/* Where the surfaces of solids may touch other surfaces.
 *
 * transport/solid.c looks for surfaces at one place with a short ray at each hit of a solid. Few
 * hits need it: for each solid this keeps boxes around the other surfaces near it, and a hit
 * outside of all boxes has no neighbour. */
#ifndef PPMI_TRANSPORT_CONTACT_H
#define PPMI_TRANSPORT_CONTACT_H

#include "base/context.h"
#include "scene/scene.h"

typedef struct ppmi_box {
    ppmi_vec3 low, high;
} ppmi_box;

/* Of one part: a primitive of an instance. */
typedef struct ppmi_contact_range {
    uint32_t first, count; /* of the boxes */
} ppmi_contact_range;

typedef struct ppmi_contacts {
    uint32_t *first_slot;       /* per instance: where its primitives start in ranges */
    ppmi_contact_range *ranges; /* empty for what is no solid */
    ppmi_box *boxes;
    uint32_t box_count;
} ppmi_contacts;

/* For a frozen scene. Returns OK, OUT_OF_MEMORY. */
ppm_status ppmi_contacts_create(ppm_context *context, const ppm_scene *scene,
                                ppmi_contacts **out_contacts);
void ppmi_contacts_destroy(ppm_context *context, ppmi_contacts *contacts);

/* Whether another surface than the part's own may lie within distance of p. */
bool ppmi_contacts_may_touch(const ppmi_contacts *contacts, uint32_t instance, uint32_t primitive,
                             ppmi_vec3 p, float distance);

#endif
