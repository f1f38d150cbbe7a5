/* The hierarchy at the times of one picture: where every node is while the shutter is open. */
#ifndef PPMI_GLTF_POSE_H
#define PPMI_GLTF_POSE_H

#include "gltf/gltf_reader.h"

/* Samples are taken at even times from the opening of the shutter to its closing. A node needs
 * only some of them: the first alone when it rests, every other, every fourth ... when the straight
 * lines between these are as good. */
typedef struct ppmi_gltf_pose {
    size_t node_count, order_count;
    size_t shown_count; /* of order: those of the scene; the rest are joints of its skins, and what
                           is above and below them, which are placed but not shown */
    int32_t *order;     /* the nodes of the scene, parents before their children */
    int32_t *parents;   /* -1: a root; -2: not in the scene */
    int32_t *assets;    /* the node whose name is the asset's; -1: none; see gltf_belong.h */
    int32_t *groups;    /* the node that says the light group; -1: none */

    size_t *first_weight; /* node_count + 1: where a node's weights are among all of them */
    double *weights;      /* of morph targets, now */

    double origin_m[3]; /* of the scene, in the file's coordinates: subtracted from the worlds */

    uint32_t sample_count;     /* 1: nothing is blurred */
    double (*worlds)[16];      /* sample_count * node_count: local to world */
    double *sampled_weights;   /* sample_count * first_weight[node_count] */
    double (*middle)[16];      /* node_count: at the middle of the shutter */
    bool *is_visible;          /* node_count: itself and all above it, at the middle */
    uint32_t *node_steps;      /* node_count: how many samples its place needs */
    uint32_t *weight_steps;    /* node_count: the same for its weights */
    bool *has_moved;           /* node_count: since the pose before, place or visibility */
    bool *has_changed_weights; /* node_count: the same for its weights */
} ppmi_gltf_pose;

/* Allocates for the document's nodes, with order empty, and parents -2. */
ppm_status ppmi_gltf_pose_create(ppmi_gltf_reader *reader);
void ppmi_gltf_pose_destroy(ppm_context *context, ppmi_gltf_pose *pose);

/* Of a file that lies far away for its size (a georeferenced site), takes its middle at rest as the
 * point 0 of the scene, where nothing has been added to it yet; order has to be there. So
 * transforms are composed in the file's own coordinates, in double precision, and rounded near 0.
 */
ppm_status ppmi_gltf_pose_choose_origin(ppmi_gltf_reader *reader);

/* Evaluates the animations at the times of when. Afterwards the document's values are those at the
 * middle of the shutter. */
ppm_status ppmi_gltf_pose_take(ppmi_gltf_reader *reader, const ppm_pose *when);

/* A node's place at step i of steps, which is one of node_steps or more of them. */
const double *ppmi_gltf_pose_world(const ppmi_gltf_pose *pose, int32_t node, uint32_t i,
                                   uint32_t steps);
/* The same for its weights. */
const double *ppmi_gltf_pose_weights_at(const ppmi_gltf_pose *pose, int32_t node, uint32_t i,
                                        uint32_t steps);

/* The weights of a node's morph targets now, for animations to write; NULL when it has none. */
double *ppmi_gltf_pose_weights(ppmi_gltf_reader *reader, int32_t node, uint32_t *out_count);

#endif
