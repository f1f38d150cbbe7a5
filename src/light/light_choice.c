/* Clusters are a cut through the light tree, few and apart; far light is one choice for all
 * directional lights, one for the environment.
 *
 * A choice is made by what it promises (importance) times what is known to come of that at the
 * place (light_cells.h): the best shares are those of the root of the second moment. Where nothing
 * is known, near lights, directional lights and the environment, those that are there, have even
 * shares, divided by importance within the first. A tenth of these is the least that a choice gets
 * in any case, which bounds what a place pays that differs from its cell. It is not taken from the
 * others: they would miss it as noise, however sure they are. Shares then add up to a little more
 * than 1, and a second sample is taken as often as that says (systematic sampling: one number
 * decides, and no choice is made twice). */
#include "light/light_choice.h"

static const float least_share = 0.1f; /* of the even one */

/* ---- the cut --------------------------------------------------------------------------------- */

/* A lamp of several triangles is seen or hidden as a whole. */
static bool is_one_lamp(const ppmi_light_node *node)
{
    return node->is_leaf || node->radius2 <= 2.0f * node->area;
}

/* The cluster that a cut gains most by parting; count if none. */
static uint32_t widest(const ppmi_lights *lights, uint32_t count)
{
    uint32_t best = count;
    float most = 0.0f;
    for (uint32_t i = 0; i < count; i++) {
        const ppmi_light_node *node = &lights->near_lights.nodes[lights->clusters[i].node];
        const float width = node->radius2 * sqrtf(node->energy);
        if (is_one_lamp(node) || !(width > most)) continue;
        most = width;
        best = i;
    }
    return best;
}

static void cut_tree(ppmi_lights *lights)
{
    ppmi_light_node *nodes = lights->near_lights.nodes;
    uint32_t count = lights->near_lights.node_count > 0 ? 1 : 0;
    lights->clusters[0] = (ppmi_light_cluster){0, 0};
    while (count > 0 && count < PPMI_LIGHT_CLUSTERS) {
        const uint32_t i = widest(lights, count);
        if (i == count) break;
        const ppmi_light_cluster whole = lights->clusters[i];
        lights->clusters[i] = (ppmi_light_cluster){whole.node + 1, whole.depth + 1};
        lights->clusters[count++] = (ppmi_light_cluster){nodes[whole.node].next, whole.depth + 1};
    }
    for (uint32_t i = 0; i < count; i++)
        nodes[lights->clusters[i].node].cluster = (uint8_t)(i + 1);
    lights->cluster_count = count;
}

void ppmi_light_choices_init(ppmi_lights *lights)
{
    cut_tree(lights);
    lights->directional_choice = lights->cluster_count;
    lights->environment_choice =
        lights->directional_choice + (lights->directional_count > 0 ? 1u : 0u);
    lights->choice_count = lights->environment_choice + (lights->has_environment ? 1u : 0u);
}

uint32_t ppmi_light_choice_of(const ppmi_lights *lights, uint32_t emitter, uint32_t *out_depth)
{
    const ppmi_light_tree *tree = &lights->near_lights;
    *out_depth = 0;
    if (tree->node_count == 0 || tree->trails[emitter] == PPMI_NO_TRAIL) {
        return lights->choice_count;
    }
    uint64_t trail = tree->trails[emitter];
    uint32_t node = 0;
    for (; tree->nodes[node].cluster == 0; trail >>= 1, ++*out_depth)
        node = trail & 1 ? tree->nodes[node].next : node + 1;
    return tree->nodes[node].cluster - 1u;
}

/* ---- shares ---------------------------------------------------------------------------------- */

enum { DIRECTIONALS_LOOKED_AT = 8 };

/* Lux of all on the receiver; of many, as if they faced it. */
static float directional_importance(const ppmi_lights *lights, const ppmi_receiver *receiver)
{
    const float least = 0.01f;
    const ppmi_emitter *first = lights->emitters + lights->near_count;
    const bool has_cosines =
        ppmi_receiver_is_surface(receiver) && lights->directional_count <= DIRECTIONALS_LOOKED_AT;
    if (!has_cosines) return lights->directional_lux;
    float sum = 0.0f;
    for (uint32_t i = 0; i < lights->directional_count; i++) {
        const ppmi_punctual *light = &lights->scene->punctuals[first[i].triangle];
        const float cosine = -vec3_dot(light->direction, receiver->normal);
        sum += vec3_mean(light->intensity) *
               ppmi_max(receiver->is_open ? fabsf(cosine) : cosine, least);
    }
    return sum;
}

float ppmi_light_choice_importance(const ppmi_lights *lights, uint32_t choice,
                                   const ppmi_receiver *receiver)
{
    if (choice < lights->cluster_count) {
        const uint32_t node = lights->clusters[choice].node;
        return ppmi_light_node_importance(&lights->near_lights.nodes[node], receiver);
    }
    if (choice == lights->directional_choice && lights->directional_count > 0) {
        return directional_importance(lights, receiver);
    }
    const float all = vec3_mean(lights->environment.integral);
    return ppmi_receiver_is_surface(receiver) ? 0.25f * all : all;
}

/* By importance within the near lights, evenly between the classes. Returns the sum: 1, or 0. */
static float even_shares(const ppmi_lights *lights, const float *importance, float *out_shares)
{
    float near_sum = 0.0f;
    for (uint32_t c = 0; c < lights->cluster_count; c++)
        near_sum += importance[c];
    const bool has_near = near_sum > 0.0f;
    const uint32_t classes = lights->choice_count - lights->cluster_count + (has_near ? 1u : 0u);
    const float of_class = classes > 0 ? 1.0f / (float)classes : 0.0f;
    const float of_near = has_near ? of_class / near_sum : 0.0f;
    for (uint32_t c = 0; c < lights->cluster_count; c++)
        out_shares[c] = importance[c] * of_near;
    for (uint32_t c = lights->cluster_count; c < lights->choice_count; c++)
        out_shares[c] = of_class;
    return classes > 0 ? 1.0f : 0.0f;
}

float ppmi_light_choice_shares(const ppmi_lights *lights, const ppmi_receiver *receiver,
                               float *out_shares)
{
    if (lights->choice_count == 1) return out_shares[0] = 1.0f;
    const float *worth = ppmi_light_cells_worth(&lights->cells, receiver);
    float importance[PPMI_LIGHT_CHOICES], sum = 0.0f;
    for (uint32_t c = 0; c < lights->choice_count; c++) {
        importance[c] = ppmi_min(ppmi_light_choice_importance(lights, c, receiver), 1e30f);
        if (worth) sum += importance[c] * worth[c];
    }
    const float even_sum = even_shares(lights, importance, out_shares);
    if (!(sum > 1e-30f) || !isfinite(sum)) return even_sum;
    const float scale = 1.0f / sum;
    sum = 0.0f;
    for (uint32_t c = 0; c < lights->choice_count; c++) {
        const float known = ppmi_min(importance[c] * worth[c] * scale, 1.0f);
        out_shares[c] = ppmi_max(known, least_share * out_shares[c]);
        sum += out_shares[c];
    }
    return sum;
}
