/* Channels of animations: which property of what each changes, and its values. */
#include "gltf/gltf_animation.h"

#include <string.h>

#include "gltf/gltf_choice.h"
#include "gltf/gltf_matrix.h"
#include "gltf/gltf_patch.h"
#include "gltf/gltf_pose.h"

enum { MAX_IGNORED = 8 }; /* channels without effect that are named one by one */

/* One animation on its way. */
typedef struct binder {
    ppmi_gltf_reader *reader;
    int32_t animation;
    char place[PPMI_GLTF_PLACE]; /* of the channel */
    size_t ignored, repeated;
} binder;

/* ---- bindings -------------------------------------------------------------------------------- */

/* Where the values are in the table, or the free place where they belong (linear probing). */
static size_t *place_of(ppmi_gltf_animations *all, const double *values)
{
    const uint64_t hash = (uint64_t)(uintptr_t)values * UINT64_C(0x9e3779b97f4a7c15);
    size_t at = (size_t)(hash >> 32) & (all->place_count - 1);
    all->look_ups++;
    while (all->places[at] != 0 && all->bindings[all->places[at] - 1].property.values != values) {
        at = (at + 1) & (all->place_count - 1);
        all->look_ups++;
    }
    return &all->places[at];
}

/* Room for one more, at most half full. */
static bool grow_places(ppm_context *context, ppmi_gltf_animations *all)
{
    if (2 * (all->count + 1) <= all->place_count) return true;
    const size_t more = all->place_count > 0 ? 2 * all->place_count : 64;
    size_t *places = ppmi_alloc_zeroed(context, more, sizeof *places);
    if (!places) return false;
    ppmi_free(context, all->places);
    all->places = places;
    all->place_count = more;
    for (size_t i = 0; i < all->count; ++i) {
        size_t *place = place_of(all, all->bindings[i].property.values);
        if (*place == 0) *place = i + 1;
    }
    return true;
}

/* Marks the element whose value a binding changes. */
static bool mark(ppmi_gltf_reader *reader, const ppmi_gltf_property *property)
{
    bool **marks = &reader->animations->is_changed[property->list];
    if (!*marks) {
        const size_t count = reader->outline.lists[property->list].count;
        *marks = ppmi_alloc_zeroed(reader->context, count + 1, sizeof **marks);
    }
    if (!*marks) return false;
    (*marks)[property->index] = true;
    return true;
}

/* A node that is given as a matrix gets the parts that can move. They hold as long as it is
 * animated. */
static void prepare_node(ppmi_gltf_reader *reader, ppmi_gltf_binding *binding)
{
    ppmi_gltf_node *node =
        &ppmi_gltf_document_edit(reader->document).nodes[binding->property.index];
    const double *values = binding->property.values;
    const bool is_placing =
        values == node->translation || values == node->rotation || values == node->scale;
    binding->has_matrix = node->has_matrix && is_placing;
    if (!binding->has_matrix) return;
    ppmi_gltf_matrix_decompose(node->matrix, node->translation, node->rotation, node->scale);
}

static ppm_status add_binding(binder *b, const ppmi_gltf_property *property, int32_t sampler)
{
    ppmi_gltf_reader *reader = b->reader;
    ppmi_gltf_animations *all = reader->animations;
    const ppmi_gltf_track_format format = {.width = property->count,
                                           .components = property->is_list ? 1 : property->count,
                                           .is_rotation = property->is_rotation,
                                           .is_flag = property->is_flag};
    ppmi_gltf_binding *items =
        ppmi_gltf_grow(reader->context, all->bindings, all->count, &all->capacity, sizeof *items);
    if (items) all->bindings = items;
    if (!items || !grow_places(reader->context, all) || !mark(reader, property)) {
        return ppmi_gltf_out_of_memory(reader, b->place);
    }
    size_t *place = place_of(all, property->values);
    ppmi_gltf_binding *binding = &items[all->count++];
    *binding = (ppmi_gltf_binding){.property = *property};
    if (*place != 0) b->repeated++;
    if (*place == 0) *place = all->count;
    if (property->list == PPMI_GLTF_NODES) prepare_node(reader, binding);
    if (property->texture) binding->has_no_transform = !property->texture->has_transform;
    binding->rest = ppmi_alloc(reader->context, property->count, sizeof *binding->rest);
    if (!binding->rest) return ppmi_gltf_out_of_memory(reader, b->place);
    memcpy(binding->rest, property->values, property->count * sizeof *binding->rest);
    return ppmi_gltf_track_read(reader, b->animation, sampler, &format, b->place, &binding->track);
}

/* ---- channels -------------------------------------------------------------------------------- */

static void ignore(binder *b, const char *why, const char *name)
{
    char shown[PPMI_GLTF_PLACE];
    ppmi_gltf_note_feature(b->reader, "animations", PPM_FEATURE_APPROXIMATED,
                           "channels that change nothing that is shown are left out");
    if (++b->ignored > MAX_IGNORED) return;
    ppmi_gltf_warn(b->reader, b->place, "left out: %s '%s'%s", why,
                   ppmi_gltf_printable(name, strlen(name), shown, sizeof shown),
                   b->ignored == MAX_IGNORED ? " (further ones are not listed)" : "");
}

/* Chains the nodes of each mesh, in their order. */
static bool find_users(ppmi_gltf_reader *reader)
{
    const ppmi_gltf_document *d = reader->document;
    ppmi_gltf_animations *all = reader->animations;
    if (all->first_user) return true;
    all->next_user = ppmi_alloc(reader->context, d->node_count + 1, sizeof *all->next_user);
    if (!all->next_user) return false;
    all->first_user = ppmi_alloc(reader->context, d->mesh_count + 1, sizeof *all->first_user);
    if (!all->first_user) return false;
    for (size_t i = 0; i < d->mesh_count; ++i) {
        all->first_user[i] = -1;
    }
    for (size_t i = d->node_count; i > 0; --i) {
        const int32_t mesh = d->nodes[i - 1].mesh;
        if (mesh < 0 || (size_t)mesh >= d->mesh_count) continue;
        all->next_user[i - 1] = all->first_user[mesh];
        all->first_user[mesh] = (int32_t)(i - 1);
    }
    return true;
}

/* The weights of a mesh are those of every node that uses it and has none of its own. */
static ppm_status bind_mesh_weights(binder *b, int32_t mesh, int32_t sampler)
{
    const ppmi_gltf_document *d = b->reader->document;
    ppmi_gltf_animations *all = b->reader->animations;
    ppm_status status = PPM_STATUS_OK;
    if (!find_users(b->reader)) return ppmi_gltf_out_of_memory(b->reader, b->place);
    for (int32_t i = all->first_user[mesh]; i >= 0 && status == PPM_STATUS_OK;
         i = all->next_user[i]) {
        ppmi_gltf_property property;
        all->look_ups++;
        if (d->nodes[i].weight_count > 0) continue;
        if (!ppmi_gltf_node_property(b->reader, i, "weights", &property)) continue;
        status = add_binding(b, &property, sampler);
    }
    return status;
}

static ppm_status bind_pointer(binder *b, const ppmi_gltf_channel *channel)
{
    ppmi_gltf_property property;
    switch (ppmi_gltf_resolve_pointer(b->reader, channel->pointer, &property)) {
    case PPMI_GLTF_POINTER_BROKEN:
        return ppmi_gltf_invalid(b->reader, b->place, "the pointer leads nowhere");
    case PPMI_GLTF_POINTER_IGNORED:
        ignore(b, "nothing that is shown is at", channel->pointer);
        return PPM_STATUS_OK;
    default:
        break;
    }
    if (property.list == PPMI_GLTF_MESHES) {
        return bind_mesh_weights(b, property.index, channel->sampler);
    }
    return add_binding(b, &property, channel->sampler);
}

static ppm_status bind_channel(binder *b, const ppmi_gltf_channel *channel)
{
    ppmi_gltf_property property;
    if (channel->pointer) return bind_pointer(b, channel);
    if (channel->node < 0) return PPM_STATUS_OK; /* to be ignored, says the specification */
    const ppm_status status =
        ppmi_gltf_require(b->reader, PPMI_GLTF_NODES, channel->node, b->place);
    if (status != PPM_STATUS_OK) return status;
    if (ppmi_gltf_node_property(b->reader, channel->node, channel->path, &property)) {
        return add_binding(b, &property, channel->sampler);
    }
    ignore(b, "the node has nothing of the name", channel->path);
    return PPM_STATUS_OK;
}

static ppm_status bind_animation(ppmi_gltf_reader *reader, int32_t index)
{
    binder b = {.reader = reader, .animation = index};
    ppmi_gltf_place(b.place, "animations[%d]", (int)index);
    ppm_status status = ppmi_gltf_require(reader, PPMI_GLTF_ANIMATIONS, index, b.place);
    if (status != PPM_STATUS_OK) return status;
    const ppmi_gltf_animation *animation = &reader->document->animations[index];
    for (uint32_t i = 0; i < animation->channel_count && status == PPM_STATUS_OK; ++i) {
        ppmi_gltf_place(b.place, "animations[%d].channels[%u]", (int)index, (unsigned)i);
        status = bind_channel(&b, &animation->channels[i]);
    }
    if (status == PPM_STATUS_OK && b.repeated > 0) {
        ppmi_gltf_place(b.place, "animations[%d]", (int)index);
        ppmi_gltf_warn(reader, b.place,
                       "%zu of its channels change what earlier ones change too; the later ones "
                       "count. An animation can be chosen by its name",
                       b.repeated);
    }
    return status;
}

/* ---- the choice ------------------------------------------------------------------------------ */

/* -1: all. */
static ppm_status choose(ppmi_gltf_reader *reader, int32_t *out_index)
{
    const ppmi_gltf_document *d = reader->document;
    *out_index = -1;
    if (!reader->options->animation) return PPM_STATUS_OK;
    const char **names = ppmi_alloc(reader->context, d->animation_count + 1, sizeof *names);
    if (!names) return ppmi_gltf_out_of_memory(reader, "animations");
    for (size_t i = 0; i < d->animation_count; ++i) {
        names[i] = d->animations[i].name;
    }
    const ppm_status status = ppmi_gltf_choose(reader, "animation", reader->options->animation,
                                               names, d->animation_count, false, out_index);
    ppmi_free(reader->context, names);
    return status;
}

ppm_status ppmi_gltf_animations_check_name(ppmi_gltf_reader *reader)
{
    int32_t index;
    return choose(reader, &index);
}

/* What only the making of bindings needs. */
static void forget_tables(ppm_context *context, ppmi_gltf_animations *animations)
{
    ppmi_free(context, animations->places);
    ppmi_free(context, animations->first_user);
    ppmi_free(context, animations->next_user);
    animations->places = NULL;
    animations->place_count = 0;
    animations->first_user = animations->next_user = NULL;
}

/* Forgets all bindings. */
static void clear(ppm_context *context, ppmi_gltf_animations *animations)
{
    for (size_t i = 0; i < animations->count; ++i) {
        ppmi_gltf_track_deinit(context, &animations->bindings[i].track);
        ppmi_free(context, animations->bindings[i].rest);
    }
    ppmi_free(context, animations->bindings);
    for (int i = 0; i < PPMI_GLTF_LIST_COUNT; ++i) {
        ppmi_free(context, animations->is_changed[i]);
    }
    forget_tables(context, animations);
    *animations = (ppmi_gltf_animations){0};
}

ppm_status ppmi_gltf_animations_bind(ppmi_gltf_reader *reader)
{
    int32_t chosen;
    if (reader->animations->is_bound) return PPM_STATUS_OK;
    ppm_status status = choose(reader, &chosen);
    for (size_t i = 0; i < reader->document->animation_count && status == PPM_STATUS_OK; ++i) {
        if (chosen < 0 || (size_t)chosen == i) status = bind_animation(reader, (int32_t)i);
    }
    forget_tables(reader->context, reader->animations);
    if (status != PPM_STATUS_OK) clear(reader->context, reader->animations);
    reader->animations->is_bound = status == PPM_STATUS_OK;
    return status;
}

/* ---- values ---------------------------------------------------------------------------------- */

static void set_switches(ppmi_gltf_reader *reader, const ppmi_gltf_binding *b, bool is_animated)
{
    if (b->has_matrix) {
        ppmi_gltf_document_edit(reader->document).nodes[b->property.index].has_matrix =
            !is_animated;
    }
    if (b->has_no_transform) b->property.texture->has_transform = is_animated;
}

void ppmi_gltf_animations_apply(ppmi_gltf_reader *reader, double time_s)
{
    for (size_t i = 0; i < reader->animations->count; ++i) {
        const ppmi_gltf_binding *b = &reader->animations->bindings[i];
        set_switches(reader, b, true);
        ppmi_gltf_track_eval(&b->track, time_s, b->property.values);
    }
}

void ppmi_gltf_animations_rest(ppmi_gltf_reader *reader)
{
    for (size_t i = 0; i < reader->animations->count; ++i) {
        const ppmi_gltf_binding *b = &reader->animations->bindings[i];
        set_switches(reader, b, false);
        memcpy(b->property.values, b->rest, b->property.count * sizeof *b->rest);
    }
}

bool ppmi_gltf_animations_change(const ppmi_gltf_reader *reader, int32_t list, int32_t index)
{
    const bool *marks = reader->animations->is_changed[list];
    return marks && index >= 0 && (size_t)index < reader->outline.lists[list].count && marks[index];
}

void ppmi_gltf_animations_deinit(ppm_context *context, ppmi_gltf_animations *animations)
{
    if (!animations) return;
    clear(context, animations);
    ppmi_free(context, animations);
}
