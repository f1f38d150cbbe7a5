/* Boxes around instances, over the whole shutter.
 *
 * A vertex and a transform that both move on straight lines between their steps keep each point
 * within the hull of the vertices at all steps under the transforms at all steps. */
#include "scene/instance.h"

static ppmi_vec3 corner(ppmi_vec3 low, ppmi_vec3 high, uint32_t i)
{
    return vec3(i & 1 ? high.x : low.x, i & 2 ? high.y : low.y, i & 4 ? high.z : low.z);
}

static void grow(ppmi_vec3 p, ppmi_vec3 *low, ppmi_vec3 *high)
{
    *low = vec3(ppmi_min(low->x, p.x), ppmi_min(low->y, p.y), ppmi_min(low->z, p.z));
    *high = vec3(ppmi_max(high->x, p.x), ppmi_max(high->y, p.y), ppmi_max(high->z, p.z));
}

static void grow_by_box(ppmi_vec3 box_low, ppmi_vec3 box_high, const ppmi_transform *to_world,
                        ppmi_vec3 *low, ppmi_vec3 *high)
{
    if (box_low.x > box_high.x) return;
    for (uint32_t i = 0; i < 8; i++)
        grow(ppmi_transform_point(to_world, corner(box_low, box_high, i)), low, high);
}

static void grow_by_vertices(const ppmi_primitive *primitive, const ppmi_transform *to_world,
                             ppmi_vec3 *low, ppmi_vec3 *high)
{
    for (uint32_t step = 0; step < primitive->motion_steps; step++) {
        const float *positions = primitive->positions + 3 * (size_t)step * primitive->vertex_count;
        for (size_t k = 0; k < 3 * (size_t)primitive->triangle_count; k++) {
            const size_t vertex = primitive->indices[k];
            grow(ppmi_transform_point(to_world, vec3_load(positions + 3 * vertex)), low, high);
        }
    }
}

/* Meshes whose instance is turned are measured vertex by vertex: the box around a turned box is too
 * large. */
static void grow_at_step(const ppmi_mesh *mesh, const ppmi_transform *to_world, ppmi_vec3 *low,
                         ppmi_vec3 *high)
{
    const bool is_turned = to_world->x.y != 0.0f || to_world->x.z != 0.0f ||
                           to_world->y.x != 0.0f || to_world->y.z != 0.0f ||
                           to_world->z.x != 0.0f || to_world->z.y != 0.0f;
    if (!is_turned) {
        grow_by_box(mesh->bounds_min, mesh->bounds_max, to_world, low, high);
        return;
    }
    for (uint32_t i = 0; i < mesh->primitive_count; i++) {
        const ppmi_primitive *primitive = &mesh->primitives[i];
        if (primitive->kind == PPM_PRIMITIVE_TRIANGLES) {
            grow_by_vertices(primitive, to_world, low, high);
        } else { /* balls have room for theirs in the box */
            grow_by_box(primitive->bounds_min, primitive->bounds_max, to_world, low, high);
        }
    }
}

static void grow_by_instance(const ppm_scene *scene, const ppmi_instance *instance, ppmi_vec3 *low,
                             ppmi_vec3 *high)
{
    const ppmi_mesh *mesh = &scene->meshes[instance->mesh];
    if (mesh->bounds_min.x > mesh->bounds_max.x) return;
    grow_at_step(mesh, &instance->to_world, low, high);
    for (uint32_t i = 1; i < instance->motion_steps; i++)
        grow_at_step(mesh, &instance->motion[i], low, high);
}

bool ppmi_instance_bounds(const ppm_scene *scene, const ppmi_instance *instance, ppmi_vec3 *out_min,
                          ppmi_vec3 *out_max)
{
    *out_min = vec3_splat(INFINITY);
    *out_max = vec3_splat(-INFINITY);
    grow_by_instance(scene, instance, out_min, out_max);
    return out_min->x <= out_max->x;
}

ppm_status ppm_scene_instance_bounds(const ppm_scene *scene, ppm_instance_id id, float out_min[3],
                                     float out_max[3])
{
    if (!scene || id == 0 || id > scene->instance_count || !out_min || !out_max) {
        return PPM_STATUS_INVALID_ARGUMENT;
    }
    ppmi_vec3 low, high;
    if (!ppmi_instance_bounds(scene, &scene->instances[id - 1], &low, &high)) {
        return PPM_STATUS_INVALID_ARGUMENT;
    }
    vec3_store(out_min, vec3_add(low, scene->shift));
    vec3_store(out_max, vec3_add(high, scene->shift));
    return PPM_STATUS_OK;
}

bool ppmi_is_far(ppmi_vec3 p)
{
    return !(vec3_max_abs(p) < PPMI_FARTHEST_M) || !vec3_is_finite(p);
}

/* Without what is too far away: it will be left out. */
static bool bounds_of(const ppm_scene *scene, bool is_with_hidden, ppmi_vec3 *out_min,
                      ppmi_vec3 *out_max)
{
    *out_min = vec3_splat(INFINITY);
    *out_max = vec3_splat(-INFINITY);
    for (uint32_t i = 0; i < scene->instance_count; i++) {
        const ppmi_instance *instance = &scene->instances[i];
        ppmi_vec3 low, high;
        if (!is_with_hidden && !ppmi_instance_is_there(instance)) continue;
        if (!ppmi_instance_bounds(scene, instance, &low, &high)) continue;
        if (ppmi_is_far(low) || ppmi_is_far(high)) continue;
        grow(low, out_min, out_max);
        grow(high, out_min, out_max);
    }
    return out_min->x <= out_max->x;
}

bool ppmi_scene_bounds(const ppm_scene *scene, ppmi_vec3 *out_min, ppmi_vec3 *out_max)
{
    return bounds_of(scene, false, out_min, out_max);
}

bool ppmi_scene_bounds_of_all(const ppm_scene *scene, ppmi_vec3 *out_min, ppmi_vec3 *out_max)
{
    return bounds_of(scene, true, out_min, out_max);
}

static bool mesh_moves(const ppmi_mesh *mesh)
{
    for (uint32_t i = 0; i < mesh->primitive_count; i++) {
        if (mesh->primitives[i].motion_steps > 1) return true;
    }
    return false;
}

bool ppmi_scene_moves(const ppm_scene *scene)
{
    for (uint32_t i = 0; i < scene->instance_count; i++) {
        const ppmi_instance *instance = &scene->instances[i];
        if (!ppmi_instance_is_there(instance)) continue;
        if (instance->motion || mesh_moves(&scene->meshes[instance->mesh])) return true;
    }
    return false;
}
