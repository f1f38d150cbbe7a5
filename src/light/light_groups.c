/* Groups of lights by name. */
#include "light/light_groups.h"

#include <stdio.h>
#include <string.h>

#include "light/tables.h"
#include "ppm/render.h"

enum { MAX_GROUPS = 4096 };

static const char rest[] = "rest";

/* Groups while they are made. */
typedef struct builder {
    ppm_context *context;
    ppmi_light_groups *groups;
    bool is_named; /* lights without a given group have their own */
    ppm_status status;
} builder;

static uint32_t find(const ppmi_light_groups *groups, const char *name)
{
    for (uint32_t i = 0; i < groups->count; i++) {
        if (strcmp(groups->names[i], name) == 0) return i;
    }
    return groups->count;
}

static void fail(builder *b, ppm_status status, const char *text)
{
    if (b->status == PPM_STATUS_OK) b->status = ppmi_fail(b->context, status, "%s", text);
}

static uint16_t add(builder *b, const char *name)
{
    ppmi_light_groups *groups = b->groups;
    if (b->status != PPM_STATUS_OK) return 0;
    if (groups->count == MAX_GROUPS) {
        fail(b, PPM_STATUS_INVALID_ARGUMENT,
             "more than 4096 groups of lights: name fewer of them in the scene, and take the "
             "others together");
        return 0;
    }
    groups->names[groups->count] = ppmi_string_copy(b->context, name);
    if (!groups->names[groups->count]) {
        fail(b, PPM_STATUS_OUT_OF_MEMORY, "out of memory: groups of lights");
        return 0;
    }
    return (uint16_t)groups->count++;
}

/* A group of that name, made where there is none. */
static uint16_t shared_group(builder *b, const char *name)
{
    const uint32_t found = find(b->groups, name);
    return found < b->groups->count ? (uint16_t)found : add(b, name);
}

/* A new group: "lamp", and where that is taken "lamp 2", "lamp 3" .. */
static uint16_t own_group(builder *b, const char *name)
{
    char numbered[256];
    snprintf(numbered, sizeof numbered, "%s", name);
    for (unsigned i = 2; find(b->groups, numbered) < b->groups->count; i++)
        snprintf(numbered, sizeof numbered, "%.200s %u", name, i);
    return add(b, numbered);
}

static uint16_t group_of(builder *b, const char *given, const char *name, const char *kind)
{
    if (given) return shared_group(b, given);
    if (!b->is_named) return shared_group(b, rest);
    return own_group(b, name[0] != '\0' ? name : kind);
}

/* Given names come first, so that they keep to themselves: a light of the same name gets a number.
 */
static void take_given_names(builder *b, const ppm_scene *scene, const bool *shines)
{
    for (uint32_t i = 0; i < scene->punctual_count; i++) {
        if (scene->punctuals[i].light_group) shared_group(b, scene->punctuals[i].light_group);
    }
    for (uint32_t i = 0; i < scene->instance_count; i++) {
        if (shines[i] && scene->instances[i].light_group) {
            shared_group(b, scene->instances[i].light_group);
        }
    }
    if (scene->environment.is_set && scene->environment.light_group) {
        shared_group(b, scene->environment.light_group);
    }
}

static bool instance_shines(const ppm_scene *scene, const ppmi_instance *instance)
{
    const ppmi_mesh *mesh = &scene->meshes[instance->mesh];
    if (!ppmi_instance_is_there(instance)) return false;
    for (uint32_t k = 0; k < mesh->primitive_count; k++) {
        if (scene->materials[mesh->primitives[k].material].emits) return true;
    }
    return false;
}

static void build(builder *b, const ppm_scene *scene, bool *shines)
{
    ppmi_light_groups *groups = b->groups;
    for (uint32_t i = 0; i < scene->instance_count; i++)
        shines[i] = instance_shines(scene, &scene->instances[i]);
    if (b->is_named) take_given_names(b, scene, shines);
    for (uint32_t i = 0; i < scene->punctual_count; i++) {
        const ppmi_punctual *light = &scene->punctuals[i];
        groups->of_punctual[i] = group_of(b, light->light_group, light->name, "light");
    }
    for (uint32_t i = 0; i < scene->instance_count; i++) {
        const ppmi_instance *instance = &scene->instances[i];
        if (!shines[i]) continue;
        groups->of_instance[i] = group_of(b, instance->light_group, instance->name, "object");
    }
    if (!scene->environment.is_set) return;
    groups->of_environment = group_of(b, scene->environment.light_group, "environment", "");
}

ppm_status ppmi_light_groups_create(ppm_context *context, const ppm_scene *scene, int32_t mode,
                                    ppmi_light_groups **out_groups)
{
    ppmi_light_groups *groups = ppmi_alloc_zeroed(context, 1, sizeof *groups);
    bool *shines = ppmi_alloc_zeroed(context, scene->instance_count + 1u, sizeof *shines);
    builder b = {context, groups, mode == PPM_LIGHT_GROUPS_NAMED, PPM_STATUS_OK};
    if (groups) {
        groups->names = ppmi_alloc_zeroed(context, MAX_GROUPS, sizeof *groups->names);
        groups->of_punctual =
            ppmi_alloc_zeroed(context, scene->punctual_count + 1u, sizeof *groups->of_punctual);
        groups->of_instance =
            ppmi_alloc_zeroed(context, scene->instance_count + 1u, sizeof *groups->of_instance);
    }
    if (!groups || !shines || !groups->names || !groups->of_punctual || !groups->of_instance) {
        fail(&b, PPM_STATUS_OUT_OF_MEMORY, "out of memory: groups of lights");
    } else {
        build(&b, scene, shines);
    }
    ppmi_free(context, shines);
    if (b.status != PPM_STATUS_OK) {
        ppmi_light_groups_destroy(context, groups);
        return b.status;
    }
    *out_groups = groups;
    return PPM_STATUS_OK;
}

void ppmi_light_groups_destroy(ppm_context *context, ppmi_light_groups *groups)
{
    if (!groups) return;
    for (uint32_t i = 0; i < groups->count; i++)
        ppmi_free(context, groups->names[i]);
    ppmi_free(context, groups->names);
    ppmi_free(context, groups->of_punctual);
    ppmi_free(context, groups->of_instance);
    ppmi_free(context, groups);
}

uint32_t ppmi_light_groups_of(const ppmi_light_groups *groups, const ppmi_lights *lights,
                              uint32_t emitter)
{
    const ppmi_emitter *e = &lights->emitters[emitter];
    switch (e->kind) {
    case PPMI_EMITTER_TRIANGLE:
        return groups->of_instance[e->instance];
    case PPMI_EMITTER_ENVIRONMENT:
        return groups->of_environment;
    default:
        return groups->of_punctual[e->triangle];
    }
}
