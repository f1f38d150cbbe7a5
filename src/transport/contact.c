/* Boxes around the neighbours of solids.
 *
 * For each solid part the triangles of all other parts that come into its bounds are split at the
 * middle of the longest side, again and again, into a few clusters; each leaves one box. */
#include "transport/contact.h"

#include <string.h>

/* Clusters for one solid, and triangles that are not worth splitting. */
enum { MAX_CLUSTERS = 64, SMALL_CLUSTER = 4 };

/* Of boxes, for a whole scene: some tenths of a second. */
enum { MAX_TESTS = 50000000 };

typedef struct box_list {
    ppmi_box *boxes;
    uint32_t count, capacity;
} box_list;

static const ppmi_box empty_box = {{INFINITY, INFINITY, INFINITY},
                                   {-INFINITY, -INFINITY, -INFINITY}};

static void grow(ppmi_box *box, ppmi_vec3 p)
{
    box->low =
        vec3(ppmi_min(box->low.x, p.x), ppmi_min(box->low.y, p.y), ppmi_min(box->low.z, p.z));
    box->high =
        vec3(ppmi_max(box->high.x, p.x), ppmi_max(box->high.y, p.y), ppmi_max(box->high.z, p.z));
}

static bool overlap(const ppmi_box *a, const ppmi_box *b)
{
    return a->low.x <= b->high.x && b->low.x <= a->high.x && a->low.y <= b->high.y &&
           b->low.y <= a->high.y && a->low.z <= b->high.z && b->low.z <= a->high.z;
}

/* Room for rounding: of positions in their instance and in the world. */
static void inflate(ppmi_box *box, float by)
{
    box->low = vec3_sub(box->low, vec3_splat(by));
    box->high = vec3_add(box->high, vec3_splat(by));
}

static bool push(ppm_context *context, box_list *list, ppmi_box box)
{
    if (list->count == list->capacity) {
        const uint32_t capacity = list->capacity > 0 ? 2 * list->capacity : 256;
        ppmi_box *larger =
            capacity > list->capacity ? ppmi_alloc(context, capacity, sizeof *larger) : NULL;
        if (!larger) return false;
        if (list->count > 0) memcpy(larger, list->boxes, list->count * sizeof *larger);
        ppmi_free(context, list->boxes);
        list->boxes = larger;
        list->capacity = capacity;
    }
    list->boxes[list->count++] = box;
    return true;
}

/* The transform of an instance at a motion step. */
static const ppmi_transform *transform_at(const ppmi_instance *instance, uint32_t step)
{
    return instance->motion ? &instance->motion[step] : &instance->to_world;
}

/* Over the whole shutter: within the hull of all steps of the vertices under all of the instance.
 */
static ppmi_box triangle_box(const ppmi_instance *instance, const ppmi_primitive *primitive,
                             uint32_t triangle)
{
    ppmi_box box = empty_box;
    for (uint32_t pose = 0; pose < instance->motion_steps; pose++) {
        const ppmi_transform *to_world = transform_at(instance, pose);
        for (uint32_t step = 0; step < primitive->motion_steps; step++) {
            const float *positions =
                primitive->positions + 3 * (size_t)step * primitive->vertex_count;
            for (uint32_t k = 0; k < 3; k++) {
                const size_t vertex = primitive->indices[3 * (size_t)triangle + k];
                grow(&box, ppmi_transform_point(to_world, vec3_load(positions + 3 * vertex)));
            }
        }
    }
    return box;
}

static void grow_by_corners(ppmi_box *box, const ppmi_instance *instance, ppmi_vec3 low,
                            ppmi_vec3 high)
{
    for (uint32_t pose = 0; pose < instance->motion_steps; pose++) {
        for (uint32_t i = 0; i < 8; i++) {
            const ppmi_vec3 corner =
                vec3(i & 1 ? high.x : low.x, i & 2 ? high.y : low.y, i & 4 ? high.z : low.z);
            grow(box, ppmi_transform_point(transform_at(instance, pose), corner));
        }
    }
}

/* Of the whole mesh, by its corners: many instances may share a large one. */
static ppmi_box instance_box(const ppm_scene *scene, const ppmi_instance *instance)
{
    const ppmi_mesh *mesh = &scene->meshes[instance->mesh];
    ppmi_box box = empty_box;
    if (mesh->bounds_min.x > mesh->bounds_max.x || !ppmi_instance_is_there(instance)) return box;
    grow_by_corners(&box, instance, mesh->bounds_min, mesh->bounds_max);
    return box;
}

/* ---- clusters -------------------------------------------------------------------------------- */

static float axis_of(ppmi_vec3 v, int axis)
{
    return axis == 0 ? v.x : axis == 1 ? v.y : v.z;
}

static ppmi_box bounds_of(const ppmi_box *boxes, uint32_t count)
{
    ppmi_box bounds = empty_box;
    for (uint32_t i = 0; i < count; i++) {
        grow(&bounds, boxes[i].low);
        grow(&bounds, boxes[i].high);
    }
    return bounds;
}

/* Orders boxes by the side of their middles; returns how many lie below. */
static uint32_t partition(ppmi_box *boxes, uint32_t count)
{
    ppmi_box middles = empty_box;
    for (uint32_t i = 0; i < count; i++)
        grow(&middles, vec3_scale(vec3_add(boxes[i].low, boxes[i].high), 0.5f));
    const ppmi_vec3 size = vec3_sub(middles.high, middles.low);
    const int axis = size.x >= size.y && size.x >= size.z ? 0 : size.y >= size.z ? 1 : 2;
    const float middle = 0.5f * (axis_of(middles.low, axis) + axis_of(middles.high, axis));
    uint32_t below = 0;
    for (uint32_t i = 0; i < count; i++) {
        const float at = 0.5f * (axis_of(boxes[i].low, axis) + axis_of(boxes[i].high, axis));
        if (at >= middle) continue;
        const ppmi_box swap = boxes[below];
        boxes[below++] = boxes[i];
        boxes[i] = swap;
    }
    return below;
}

/* Splits boxes into at most budget clusters, appended to list. */
static bool cluster(ppm_context *context, ppmi_box *boxes, uint32_t count, uint32_t budget,
                    box_list *list)
{
    if (count == 0) return true;
    const uint32_t below = budget > 1 && count > SMALL_CLUSTER ? partition(boxes, count) : 0;
    if (below == 0 || below == count) return push(context, list, bounds_of(boxes, count));
    return cluster(context, boxes, below, budget / 2, list) &&
           cluster(context, boxes + below, count - below, budget - budget / 2, list);
}

/* ---- parts ----------------------------------------------------------------------------------- */

typedef struct contact_build {
    ppm_context *context;
    const ppm_scene *scene;
    ppmi_contacts *contacts;
    ppmi_box *instances; /* around each */
    uint64_t tests_left; /* of boxes: solids that come after count as near to everything */
    box_list clusters;   /* the result */
    box_list near;       /* scratch: triangles near one solid */
} contact_build;

static const ppmi_mesh *mesh_of(const ppm_scene *scene, uint32_t instance)
{
    return &scene->meshes[scene->instances[instance].mesh];
}

/* Bounds' rounding: a share of the largest coordinate, as ppmi_surface's error bound has it. */
static float slack_of(const ppmi_box *box)
{
    return 1e-5f * ppmi_max(vec3_max_abs(box->low), vec3_max_abs(box->high));
}

/* Takes n tests from what may be spent. False when it is used up. */
static bool spend(contact_build *build, uint64_t n)
{
    build->tests_left = build->tests_left > n ? build->tests_left - n : 0;
    return build->tests_left > 0;
}

static bool add_near(contact_build *build, uint32_t instance, uint32_t primitive_index,
                     const ppmi_box *solid)
{
    const ppmi_primitive *primitive = &mesh_of(build->scene, instance)->primitives[primitive_index];
    if (!spend(build, primitive->element_count)) return true;
    if (primitive->kind != PPM_PRIMITIVE_TRIANGLES) { /* a cloud of balls is one box */
        ppmi_box box = empty_box;
        if (primitive->element_count == 0) return true;
        grow_by_corners(&box, &build->scene->instances[instance], primitive->bounds_min,
                        primitive->bounds_max);
        return !overlap(&box, solid) || push(build->context, &build->near, box);
    }
    for (uint32_t i = 0; i < primitive->triangle_count; i++) {
        const ppmi_box box = triangle_box(&build->scene->instances[instance], primitive, i);
        if (overlap(&box, solid) && !push(build->context, &build->near, box)) return false;
    }
    return true;
}

static bool add_solid(contact_build *build, uint32_t slot, uint32_t instance, uint32_t primitive)
{
    const ppm_scene *scene = build->scene;
    ppmi_box solid = build->instances[instance];
    const float slack = slack_of(&solid);
    inflate(&solid, slack);
    build->near.count = 0;
    spend(build, scene->instance_count);
    for (uint32_t i = 0; i < scene->instance_count && build->tests_left > 0; i++) {
        if (!overlap(&build->instances[i], &solid)) continue;
        for (uint32_t k = 0; k < mesh_of(scene, i)->primitive_count; k++) {
            const bool is_own = i == instance && k == primitive;
            if (!is_own && !add_near(build, i, k, &solid)) return false;
        }
    }
    if (build->tests_left == 0) {
        const ppmi_box everything = {vec3_splat(-INFINITY), vec3_splat(INFINITY)};
        build->near.count = 0;
        if (!push(build->context, &build->near, everything)) return false;
    }
    const uint32_t first = build->clusters.count;
    if (!cluster(build->context, build->near.boxes, build->near.count, MAX_CLUSTERS,
                 &build->clusters)) {
        return false;
    }
    build->contacts->ranges[slot] = (ppmi_contact_range){first, build->clusters.count - first};
    for (uint32_t i = first; i < build->clusters.count; i++)
        inflate(&build->clusters.boxes[i], slack);
    return true;
}

static bool add_solids(contact_build *build)
{
    uint32_t slot = 0;
    for (uint32_t i = 0; i < build->scene->instance_count; i++) {
        const ppmi_mesh *mesh = mesh_of(build->scene, i);
        for (uint32_t k = 0; k < mesh->primitive_count; k++, slot++) {
            const ppmi_material *material = &build->scene->materials[mesh->primitives[k].material];
            const bool is_solid =
                material->is_solid_glass && ppmi_instance_is_there(&build->scene->instances[i]);
            if (is_solid && !add_solid(build, slot, i, k)) return false;
        }
    }
    return true;
}

static bool build_all(contact_build *build)
{
    const ppm_scene *scene = build->scene;
    ppmi_contacts *contacts = build->contacts;
    size_t slots = 0;
    contacts->first_slot =
        ppmi_alloc(build->context, scene->instance_count + 1u, sizeof *contacts->first_slot);
    if (!contacts->first_slot) return false;
    for (uint32_t i = 0; i < scene->instance_count; i++) {
        contacts->first_slot[i] = (uint32_t)slots;
        slots += mesh_of(scene, i)->primitive_count;
    }
    contacts->ranges = ppmi_alloc_zeroed(build->context, slots + 1, sizeof *contacts->ranges);
    build->instances =
        ppmi_alloc(build->context, scene->instance_count + 1u, sizeof *build->instances);
    if (!contacts->ranges || !build->instances) return false;
    for (uint32_t i = 0; i < scene->instance_count; i++)
        build->instances[i] = instance_box(scene, &scene->instances[i]);
    return add_solids(build);
}

static bool has_solids(const ppm_scene *scene)
{
    for (uint32_t i = 0; i < scene->material_count; i++) {
        if (scene->materials[i].is_solid_glass) return true;
    }
    return false;
}

ppm_status ppmi_contacts_create(ppm_context *context, const ppm_scene *scene,
                                ppmi_contacts **out_contacts)
{
    ppmi_contacts *contacts = ppmi_alloc_zeroed(context, 1, sizeof *contacts);
    contact_build build = {
        .context = context, .scene = scene, .contacts = contacts, .tests_left = MAX_TESTS};
    const bool is_built = contacts && (!has_solids(scene) || build_all(&build));
    ppmi_free(context, build.instances);
    ppmi_free(context, build.near.boxes);
    if (!is_built) {
        ppmi_free(context, build.clusters.boxes);
        ppmi_contacts_destroy(context, contacts);
        return ppmi_fail(context, PPM_STATUS_OUT_OF_MEMORY, "out of memory: contacts of solids");
    }
    contacts->boxes = build.clusters.boxes;
    contacts->box_count = build.clusters.count;
    *out_contacts = contacts;
    return PPM_STATUS_OK;
}

void ppmi_contacts_destroy(ppm_context *context, ppmi_contacts *contacts)
{
    if (!contacts) return;
    ppmi_free(context, contacts->first_slot);
    ppmi_free(context, contacts->ranges);
    ppmi_free(context, contacts->boxes);
    ppmi_free(context, contacts);
}

bool ppmi_contacts_may_touch(const ppmi_contacts *contacts, uint32_t instance, uint32_t primitive,
                             ppmi_vec3 p, float distance)
{
    const ppmi_contact_range range = contacts->ranges[contacts->first_slot[instance] + primitive];
    for (uint32_t i = range.first; i < range.first + range.count; i++) {
        const ppmi_box *box = &contacts->boxes[i];
        const float outside = ppmi_max(ppmi_max(ppmi_max(box->low.x - p.x, p.x - box->high.x),
                                                ppmi_max(box->low.y - p.y, p.y - box->high.y)),
                                       ppmi_max(box->low.z - p.z, p.z - box->high.z));
        if (outside <= distance) return true;
    }
    return false;
}
