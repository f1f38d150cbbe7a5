/* Columns below solids: each solid has one while they are few, then those are joined that grow
 * least. */
#include "transport/columns.h"

static void grow(ppmi_vec3 *low, ppmi_vec3 *high, ppmi_vec3 p)
{
    *low = vec3(ppmi_min(low->x, p.x), ppmi_min(low->y, p.y), ppmi_min(low->z, p.z));
    *high = vec3(ppmi_max(high->x, p.x), ppmi_max(high->y, p.y), ppmi_max(high->z, p.z));
}

/* The box around a part at all steps of its motion, with room for rounding. */
static void part_box(const ppmi_instance *instance, const ppmi_primitive *primitive,
                     ppmi_vec3 *out_low, ppmi_vec3 *out_high)
{
    const ppmi_vec3 near = primitive->bounds_min, far = primitive->bounds_max;
    *out_low = vec3_splat(INFINITY);
    *out_high = vec3_splat(-INFINITY);
    for (uint32_t pose = 0; pose < instance->motion_steps; pose++) {
        const ppmi_transform *to_world =
            instance->motion ? &instance->motion[pose] : &instance->to_world;
        for (uint32_t i = 0; i < 8; i++) {
            const ppmi_vec3 corner =
                vec3(i & 1 ? far.x : near.x, i & 2 ? far.y : near.y, i & 4 ? far.z : near.z);
            grow(out_low, out_high, ppmi_transform_point(to_world, corner));
        }
    }
    const float rounding =
        1e-5f * ppmi_max(vec3_max_abs(*out_low), vec3_max_abs(*out_high)) + 1e-30f;
    *out_low = vec3_sub(*out_low, vec3_splat(rounding));
    *out_high = vec3_add(*out_high, vec3_splat(rounding));
}

static float section(ppmi_vec3 low, ppmi_vec3 high)
{
    return (high.x - low.x) * (high.z - low.z);
}

static void add(ppmi_columns *columns, ppmi_vec3 low, ppmi_vec3 high)
{
    if (columns->count < PPMI_COLUMNS_MAX) {
        columns->low[columns->count] = low;
        columns->high[columns->count++] = high;
        return;
    }
    uint32_t best = 0;
    float least = INFINITY;
    for (uint32_t i = 0; i < columns->count; i++) {
        ppmi_vec3 joined_low = columns->low[i], joined_high = columns->high[i];
        grow(&joined_low, &joined_high, low);
        grow(&joined_low, &joined_high, high);
        const float growth =
            section(joined_low, joined_high) - section(columns->low[i], columns->high[i]);
        if (growth < least) {
            least = growth;
            best = i;
        }
    }
    grow(&columns->low[best], &columns->high[best], low);
    grow(&columns->low[best], &columns->high[best], high);
}

void ppmi_columns_init(ppmi_columns *columns, const ppm_scene *scene)
{
    columns->count = 0;
    for (uint32_t i = 0; i < scene->instance_count; i++) {
        const ppmi_instance *instance = &scene->instances[i];
        const ppmi_mesh *mesh = &scene->meshes[instance->mesh];
        if (!ppmi_instance_is_there(instance)) continue;
        for (uint32_t k = 0; k < mesh->primitive_count; k++) {
            const ppmi_primitive *primitive = &mesh->primitives[k];
            if (!scene->materials[primitive->material].is_solid_glass) continue;
            if (primitive->bounds_min.x > primitive->bounds_max.x) continue;
            ppmi_vec3 low, high;
            part_box(instance, primitive, &low, &high);
            add(columns, low, high);
        }
    }
}
