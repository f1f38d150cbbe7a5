/* The corners around one vertex, and how they fall into groups of one tangent. */
#ifndef PPMI_TANGENT_FAN_H
#define PPMI_TANGENT_FAN_H

#include <stddef.h>
#include <stdint.h>

#include "base/context.h"

#define PPMI_TANGENT_NO_GROUP UINT32_MAX

/* How the coordinates of a triangle turn. */
enum {
    PPMI_TANGENT_NEGATIVE = 0,
    PPMI_TANGENT_POSITIVE = 1,
    PPMI_TANGENT_ANY = 2 /* no area in the coordinates */
};

/* A triangle's corner at the vertex: its other vertices, in the order of the triangle. */
typedef struct ppmi_tangent_corner {
    uint32_t next, previous;
    uint8_t turn;
    uint32_t group; /* out */
} ppmi_tangent_corner;

typedef struct ppmi_tangent_edge {
    uint32_t vertex, corner;
} ppmi_tangent_edge;

/* Arrays of as many elements as the largest fan has corners. */
typedef struct ppmi_tangent_workspace {
    ppmi_tangent_corner *corners;
    ppmi_tangent_edge *edges;
    uint32_t *left, *right, *stack;
} ppmi_tangent_workspace;

/* Sets the groups of the first count corners, numbered from 0; returns how many there are. The
 * corners come in the order of their triangles. */
uint32_t ppmi_tangent_group_fan(ppmi_tangent_workspace *workspace, uint32_t count);

#endif
