/* A tree over the near lights, for choosing one of very many by what it may bring to a place:
 * Conty Estevez and Kulla 2018, "Importance Sampling of Many Lights with Adaptive Tree Splitting".
 *
 * Each node bounds its lights' places by a ball, the directions that they shine into by a cone, and
 * knows their energy, so that an importance can be told for a receiver: that of a light alone and
 * small is its irradiance before visibility. Going down from the root, a child is taken by its
 * share of the importance, and the same walk tells the probability of a given light. */
#ifndef PPMI_LIGHT_LIGHT_TREE_H
#define PPMI_LIGHT_LIGHT_TREE_H

#include "light/lights.h"

/* The directions that lights shine into: normals within theta_o of the axis, light within theta_e
 * of a normal (radians). */
typedef struct ppmi_light_cone {
    ppmi_vec3 axis; /* unit */
    float theta_o, theta_e;
    bool is_two_sided; /* the same along the opposite axis */
} ppmi_light_cone;

/* Bounds of one light. */
typedef struct ppmi_light_bounds {
    ppmi_vec3 low, high;
    ppmi_light_cone cone;
    float energy; /* above 0: candela where it shines most, as far as it is small */
    float area;   /* m^2, 0 of points and balls */
    uint32_t emitter;
} ppmi_light_bounds;

typedef struct ppmi_light_node {
    ppmi_vec3 center;
    float radius2;
    ppmi_vec3 axis;
    float cos_o, sin_o, cos_e;
    float energy, area;
    uint32_t next; /* of a leaf its emitter; else the second child: the first one follows */
    bool is_leaf, is_two_sided;
    uint8_t cluster; /* its number + 1, where the tree is cut here (light_choice.h); or 0 */
} ppmi_light_node;

/* The trail of an emitter that is not in the tree: paths are shorter than 63 turns. */
#define PPMI_NO_TRAIL UINT64_MAX

typedef struct ppmi_light_tree {
    uint32_t node_count; /* 0: no light */
    ppmi_light_node *nodes;
    uint64_t *trails; /* per emitter: the turns from the root to it, lowest bit first */
    uint32_t emitter_count;
} ppmi_light_tree;

/* lights is reordered. emitter_count: emitters are below that; those without bounds are never
 * drawn. Returns OK, OUT_OF_MEMORY. */
ppm_status ppmi_light_tree_init(ppm_context *context, ppmi_light_tree *tree,
                                ppmi_light_bounds *lights, uint32_t count, uint32_t emitter_count);
void ppmi_light_tree_deinit(ppm_context *context, ppmi_light_tree *tree);

/* What the node's lights may bring to a receiver; 0 only if they bring nothing. */
float ppmi_light_node_importance(const ppmi_light_node *node, const ppmi_receiver *receiver);

/* Draws a light below a node, with u in [0, 1); false where none brings anything. *out_pdf: its
 * probability. */
bool ppmi_light_tree_sample(const ppmi_light_tree *tree, uint32_t node,
                            const ppmi_receiver *receiver, double u, uint32_t *out_emitter,
                            float *out_pdf);

/* The probability that the above draws a light, which is below the node; depth: of the node. */
float ppmi_light_tree_pdf(const ppmi_light_tree *tree, uint32_t node, uint32_t depth,
                          const ppmi_receiver *receiver, uint32_t emitter);

#endif
