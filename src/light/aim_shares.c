/* Which lights a target gets its photons from, before anything is known: half of them by what the
 * lights send to it if nothing is in the way, half evenly, to each lamp and to each thing that
 * shines alike. What is in the way is learnt (photon/guide.h), and can only be learnt by photons
 * that are sent. */
#include "light/aim_tables.h"

enum { MAX_GROUPS = 4096, SAMPLES = 4 };

static const double even_share = 0.5;

static uint32_t set_of(const ppmi_aim *aim, uint32_t emitter)
{
    const ppmi_emitter *e = &aim->lights->emitters[emitter];
    return e->kind == PPMI_EMITTER_TRIANGLE ? e->instance : UINT32_MAX - emitter;
}

static double power_of(const ppmi_aim *aim, uint32_t begin, uint32_t end)
{
    return aim->powers[end] - aim->powers[begin];
}

/* Groups end with their instance, and where they become too large. */
static void cut_groups(ppmi_aim *aim)
{
    const uint32_t count = aim->lights->count;
    const uint32_t most = (count + MAX_GROUPS - 1) / MAX_GROUPS;
    aim->group_count = 0;
    for (uint32_t i = 0; i < count;) {
        aim->group_first[aim->group_count++] = i;
        const uint32_t first = i++;
        while (i < count && i - first < most &&
               (count > MAX_GROUPS || set_of(aim, i) == set_of(aim, first))) {
            i++;
        }
    }
    aim->group_first[aim->group_count] = count;
}

static ppmi_vec3 position_of(const ppmi_lights *lights, const ppmi_emitter *e,
                             ppmi_surface *out_surface)
{
    if (e->kind != PPMI_EMITTER_TRIANGLE) return lights->scene->punctuals[e->triangle].position;
    ppmi_emitter_surface(lights, e, 0.3f, 0.3f, 0.0f, out_surface);
    return out_surface->position;
}

/* By how much a near light's intensity towards a direction is above its mean, about. */
static double leaning(const ppmi_lights *lights, const ppmi_emitter *e, const ppmi_surface *surface,
                      ppmi_vec3 direction)
{
    const double least = 0.02;
    if (e->kind == PPMI_EMITTER_TRIANGLE) {
        const double cosine = (double)vec3_dot(surface->ng, direction);
        return e->sides == 2 ? fmax(2.0 * fabs(cosine), least) : fmax(4.0 * cosine, least);
    }
    const ppmi_punctual *light = &lights->scene->punctuals[e->triangle];
    if (light->kind != PPM_LIGHT_SPOT) return 1.0;
    const double cosine = (double)vec3_dot(light->direction, direction);
    const double mean = 0.5 * (1.0 - (double)light->cos_outer);
    return cosine > (double)light->cos_outer ? 1.0 / fmax(mean, 1e-4) : least;
}

/* The share of a near light's power that goes towards a target. What is inside of a smaller one
 * sends everything there. */
static double near_share(const ppmi_aim *aim, const ppmi_emitter *e, uint32_t part)
{
    ppmi_surface surface;
    const ppmi_vec3 position = position_of(aim->lights, e, &surface);
    for (uint32_t k = 0; k < part; k++) {
        if (ppmi_target_is_met(&aim->targets[k], position, vec3_splat(0.0f))) return 1e-3;
    }
    if (part == aim->target_count) return 1.0;
    const ppmi_target *target = &aim->targets[part];
    const double share =
        ppmi_target_cone_from(target, position).solid_angle / (4.0 * (double)PPMI_PI);
    if (share > 0.25) return share;
    const ppmi_vec3 direction = vec3_normalize(vec3_sub(target->center, position));
    return fmin(share * leaning(aim->lights, e, &surface, direction), 1.0);
}

static double far_share(const ppmi_aim *aim, const ppmi_emitter *e, uint32_t part)
{
    if (part == aim->target_count) return 1.0;
    const ppmi_target *target = &aim->targets[part];
    const ppmi_light_extent *extent = &aim->lights->extent;
    if (e->kind == PPMI_EMITTER_ENVIRONMENT) {
        const double sum = ppmi_target_shadow(target, vec3(1, 0, 0)) +
                           ppmi_target_shadow(target, vec3(0, 1, 0)) +
                           ppmi_target_shadow(target, vec3(0, 0, 1));
        return fmin(sum / 3.0 / (double)ppmi_light_extent_mean_shadow(extent), 1.0);
    }
    const ppmi_vec3 direction = aim->lights->scene->punctuals[e->triangle].direction;
    return fmin(ppmi_target_shadow(target, direction) /
                    (double)ppmi_light_extent_shadow(extent, direction),
                1.0);
}

static double share_of(const ppmi_aim *aim, uint32_t emitter, uint32_t part)
{
    const ppmi_emitter *e = &aim->lights->emitters[emitter];
    const bool is_far = emitter >= aim->lights->near_count;
    return is_far ? far_share(aim, e, part) : near_share(aim, e, part);
}

/* What a group sends to a part, by some of its emitters. */
static double flux_of(const ppmi_aim *aim, uint32_t group, uint32_t part)
{
    const uint32_t begin = aim->group_first[group], end = aim->group_first[group + 1];
    const uint32_t samples = end - begin < SAMPLES ? end - begin : SAMPLES;
    double sum = 0.0;
    for (uint32_t i = 0; i < samples; i++)
        sum += share_of(aim, begin + (uint32_t)((uint64_t)(end - begin) * i / samples), part);
    return power_of(aim, begin, end) * sum / samples;
}

/* Turns weights into sums of probabilities. */
static void accumulate(double *weights, uint32_t count)
{
    double total = 0.0, sum = 0.0;
    for (uint32_t i = 0; i < count; i++)
        total += weights[i];
    for (uint32_t i = 0; i < count; i++) {
        const double weight = weights[i];
        weights[i] = sum;
        sum += total > 0.0 ? weight / total : 1.0 / count;
    }
    weights[count] = 1.0;
}

/* Each set has one share, which its groups have by their power. */
static void even_weights(const ppmi_aim *aim, double *weights)
{
    uint32_t sets = 0;
    for (uint32_t g = 0; g < aim->group_count;) {
        const uint32_t first = g, set = set_of(aim, aim->group_first[g]);
        while (g < aim->group_count && set_of(aim, aim->group_first[g]) == set)
            g++;
        const double power = power_of(aim, aim->group_first[first], aim->group_first[g]);
        for (uint32_t i = first; i < g && power > 0.0; i++)
            weights[i] = power_of(aim, aim->group_first[i], aim->group_first[i + 1]) / power;
        sets += power > 0.0;
    }
    for (uint32_t g = 0; g < aim->group_count; g++)
        weights[g] /= sets > 0 ? sets : 1;
}

static void share_part(const ppmi_aim *aim, uint32_t part, const double *even)
{
    double *weights = aim->groups + (size_t)part * (aim->group_count + 1);
    double total = 0.0;
    for (uint32_t g = 0; g < aim->group_count; g++)
        total += weights[g] = flux_of(aim, g, part);
    for (uint32_t g = 0; g < aim->group_count; g++) {
        const double by_flux = total > 0.0 ? weights[g] / total : 0.0;
        weights[g] = even_share * even[g] + (1.0 - even_share) * by_flux;
    }
    accumulate(weights, aim->group_count);
}

bool ppmi_aim_fill_groups(ppmi_aim *aim)
{
    const uint32_t count = aim->lights->count, parts = aim->target_count + 1;
    const uint32_t most = count < 2 * MAX_GROUPS ? count : 2 * MAX_GROUPS;
    aim->powers = ppmi_alloc(aim->context, (size_t)count + 1, sizeof *aim->powers);
    aim->group_first = ppmi_alloc(aim->context, (size_t)most + 1, sizeof *aim->group_first);
    if (!aim->powers || !aim->group_first) return false;
    for (uint32_t i = 0; i < count; i++)
        aim->powers[i] = (double)ppmi_alias_probability(&aim->lights->by_power, i);
    accumulate(aim->powers, count);
    cut_groups(aim);
    aim->groups =
        ppmi_alloc(aim->context, (size_t)parts * (aim->group_count + 1), sizeof *aim->groups);
    double *even = ppmi_alloc_zeroed(aim->context, aim->group_count, sizeof *even);
    const bool has_memory = aim->groups && even;
    if (has_memory) {
        even_weights(aim, even);
        for (uint32_t part = 0; part < parts; part++)
            share_part(aim, part, even);
    }
    ppmi_free(aim->context, even);
    return has_memory;
}
