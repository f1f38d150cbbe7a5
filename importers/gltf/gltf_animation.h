/* The file's animations, tied to the properties that they change. */
#ifndef PPMI_GLTF_ANIMATION_H
#define PPMI_GLTF_ANIMATION_H

#include "gltf/gltf_property.h"
#include "gltf/gltf_track.h"

/* One property over time. */
typedef struct ppmi_gltf_binding {
    ppmi_gltf_property property;
    ppmi_gltf_track track;
    double *rest;          /* the file's own values */
    bool has_matrix;       /* of a node that the file gives a matrix */
    bool has_no_transform; /* of a texture that the file gives none */
} ppmi_gltf_binding;

typedef struct ppmi_gltf_animations {
    bool is_bound;
    size_t count, capacity;
    ppmi_gltf_binding *bindings;
    bool *is_changed[PPMI_GLTF_LIST_COUNT]; /* per element of a list; NULL: none of it is */
    /* while bindings are made: */
    size_t *places; /* of the values that are bound, hashed: index of a binding + 1; 0: free */
    size_t place_count;
    size_t look_ups; /* of places and of users so far: what grows if finding is not linear */
    int32_t *first_user, *next_user; /* of a mesh, and of its mesh after a node: a node, or -1 */
} ppmi_gltf_animations;

/* Whether options->animation, if there is one, is in the file: OK, or INVALID_ARGUMENT with what
 * there is. */
ppm_status ppmi_gltf_animations_check_name(ppmi_gltf_reader *reader);

/* Reads the keys of the chosen animations and finds what they change; at its first call. */
ppm_status ppmi_gltf_animations_bind(ppmi_gltf_reader *reader);

/* Writes the values at a time, or those of the file, into the document and the pose's weights. */
void ppmi_gltf_animations_apply(ppmi_gltf_reader *reader, double time_s);
void ppmi_gltf_animations_rest(ppmi_gltf_reader *reader);

/* Whether any value of an element of a list (PPMI_GLTF_) is animated. */
bool ppmi_gltf_animations_change(const ppmi_gltf_reader *reader, int32_t list, int32_t index);

void ppmi_gltf_animations_deinit(ppm_context *context, ppmi_gltf_animations *animations);

#endif
