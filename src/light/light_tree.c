/* The light tree: importance, and choice by it. */
#include "light/light_tree.h"

#include <float.h>

/* ---- importance ------------------------------------------------------------------------------ */

/* cos(max(0, a - b)) for angles up to pi. */
static float cos_difference(float cos_a, float sin_a, float cos_b, float sin_b)
{
    return cos_a > cos_b ? 1.0f : cos_a * cos_b + sin_a * sin_b;
}

/* sin(max(0, a - b)). */
static float sin_difference(float cos_a, float sin_a, float cos_b, float sin_b)
{
    return cos_a > cos_b ? 0.0f : sin_a * cos_b - cos_a * sin_b;
}

static float sine_of(float cosine)
{
    return sqrtf(ppmi_max(1.0f - cosine * cosine, 0.0f));
}

/* Cosine of the least angle between a light's normal and the way to the receiver, by bounds of both
 * (Conty Estevez and Kulla 2018, figure 8); 0 where nothing is sent. */
static float emission_cosine(const ppmi_light_node *node, float cos_w, float cos_b, float sin_b)
{
    const float least = 1e-3f; /* what rounding may hide */
    if (node->cos_o <= -1.0f) return 1.0f;
    if (node->is_two_sided) cos_w = fabsf(cos_w);
    const float sin_w = sine_of(cos_w);
    const float cos_x = cos_difference(cos_w, sin_w, node->cos_o, node->sin_o);
    const float sin_x = sin_difference(cos_w, sin_w, node->cos_o, node->sin_o);
    const float cosine = cos_difference(cos_x, sin_x, cos_b, sin_b);
    return cosine < node->cos_e - least ? 0.0f : ppmi_max(cosine, least);
}

/* The same at the receiver. What lies behind it is not left out: a coat may have a normal of its
 * own. */
static float reception_cosine(const ppmi_receiver *receiver, ppmi_vec3 towards, float cos_b,
                              float sin_b)
{
    const float least = 0.01f;
    float cos_i = vec3_dot(towards, receiver->normal);
    if (receiver->is_open) cos_i = fabsf(cos_i);
    return ppmi_max(cos_difference(cos_i, sine_of(cos_i), cos_b, sin_b), least);
}

float ppmi_light_node_importance(const ppmi_light_node *node, const ppmi_receiver *receiver)
{
    const ppmi_vec3 way = vec3_sub(node->center, receiver->position);
    const float distance2 = vec3_length2(way);
    if (!(distance2 > node->radius2)) { /* from within, lights may be anywhere */
        return ppmi_clampf(node->energy / ppmi_max(node->radius2, 1e-30f), FLT_MIN, FLT_MAX);
    }
    const ppmi_vec3 towards = vec3_scale(way, 1.0f / sqrtf(distance2));
    const float sin_b = sqrtf(node->radius2 / distance2);
    const float cos_b = sine_of(sin_b);
    float cosines = emission_cosine(node, -vec3_dot(towards, node->axis), cos_b, sin_b);
    if (cosines <= 0.0f) return 0.0f;
    if (ppmi_receiver_is_surface(receiver)) {
        cosines *= reception_cosine(receiver, towards, cos_b, sin_b);
    }
    return ppmi_clampf(node->energy * cosines / distance2, FLT_MIN, FLT_MAX);
}

/* ---- choice ---------------------------------------------------------------------------------- */

/* Probability of the first child; false where neither brings anything. */
static bool first_share(const ppmi_light_tree *tree, uint32_t node, const ppmi_receiver *receiver,
                        float *out_share)
{
    const ppmi_light_node *nodes = tree->nodes;
    const float first = ppmi_light_node_importance(&nodes[node + 1], receiver);
    const float second = ppmi_light_node_importance(&nodes[nodes[node].next], receiver);
    if (!(first + second > 0.0f)) return false;
    *out_share =
        first > second ? 1.0f / (1.0f + second / first) : 1.0f - 1.0f / (1.0f + first / second);
    return true;
}

bool ppmi_light_tree_sample(const ppmi_light_tree *tree, uint32_t node,
                            const ppmi_receiver *receiver, double u, uint32_t *out_emitter,
                            float *out_pdf)
{
    float pdf = 1.0f;
    while (!tree->nodes[node].is_leaf) {
        float share;
        if (!first_share(tree, node, receiver, &share)) return false;
        if (u < (double)share) {
            u /= (double)share;
            pdf *= share;
            node++;
        } else {
            u = (u - (double)share) / (1.0 - (double)share);
            pdf *= 1.0f - share;
            node = tree->nodes[node].next;
        }
    }
    *out_emitter = tree->nodes[node].next;
    *out_pdf = pdf;
    return pdf > 0.0f;
}

float ppmi_light_tree_pdf(const ppmi_light_tree *tree, uint32_t node, uint32_t depth,
                          const ppmi_receiver *receiver, uint32_t emitter)
{
    uint64_t trail = tree->trails[emitter];
    if (trail == PPMI_NO_TRAIL) return 0.0f;
    trail >>= depth;
    float pdf = 1.0f;
    for (; !tree->nodes[node].is_leaf; trail >>= 1) {
        float share;
        if (!first_share(tree, node, receiver, &share)) return 0.0f;
        const bool is_second = (trail & 1) != 0;
        pdf *= is_second ? 1.0f - share : share;
        node = is_second ? tree->nodes[node].next : node + 1;
    }
    return pdf;
}
