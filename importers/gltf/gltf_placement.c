#include "gltf/gltf_placement.h"

#include <string.h>

#include "gltf/gltf_deform.h"
#include "gltf/gltf_matrix.h"
#include "gltf/gltf_patch.h"
#include "gltf/gltf_pose.h"

ppm_status ppmi_gltf_placements_create(ppmi_gltf_reader *reader)
{
    const size_t count = reader->document->node_count;
    ppmi_gltf_placements *p = ppmi_alloc_zeroed(reader->context, 1, sizeof *p);
    reader->placements = p;
    if (!p) return ppmi_gltf_out_of_memory(reader, "nodes");
    p->first_instance = ppmi_alloc(reader->context, count + 1, sizeof *p->first_instance);
    p->cameras = ppmi_alloc_zeroed(reader->context, count + 1, sizeof *p->cameras);
    p->lights =
        ppmi_alloc_zeroed(reader->context, count + 1, PPMI_GLTF_WAY_COUNT * sizeof *p->lights);
    p->deforms = ppmi_alloc_zeroed(reader->context, count + 1, sizeof(ppmi_gltf_deform *));
    if (!p->first_instance || !p->cameras || !p->lights || !p->deforms) {
        return ppmi_gltf_out_of_memory(reader, "nodes");
    }
    for (size_t i = 0; i < count; ++i) {
        p->first_instance[i] = PPMI_GLTF_NO_INSTANCE;
    }
    return PPM_STATUS_OK;
}

void ppmi_gltf_placements_destroy(ppmi_gltf_reader *reader)
{
    ppmi_gltf_placements *p = reader->placements;
    ppm_context *context = reader->context;
    if (!p) return;
    for (size_t i = 0; p->deforms && i < reader->document->node_count; ++i) {
        ppmi_gltf_deform_destroy(context, p->deforms[i]);
    }
    ppmi_free(context, p->deforms);
    ppmi_free(context, p->first_instance);
    ppmi_free(context, p->cameras);
    ppmi_free(context, p->lights);
    ppmi_free(context, p->instances);
    ppmi_free(context, p);
}

/* The scene drops an instance whose scale is zero when it is added, but not later: one that may
 * grow is added at another size. */
static ppm_status add_instance(ppmi_gltf_reader *reader, const ppm_instance_desc *desc,
                               ppm_instance_id *out_id)
{
    static const float identity[16] = {[0] = 1.0f, [5] = 1.0f, [10] = 1.0f, [15] = 1.0f};
    ppm_instance_desc unit = *desc;
    unit.motion_steps = 0;
    unit.motion = NULL;
    memcpy(unit.transform, identity, sizeof identity);
    if (reader->document->animation_count == 0) {
        return ppm_scene_add_instance(reader->scene, desc, out_id);
    }
    const ppm_status status = ppm_scene_add_instance(reader->scene, &unit, out_id);
    if (status != PPM_STATUS_OK) return status;
    return ppm_scene_set_instance(reader->scene, *out_id, desc);
}

ppm_status ppmi_gltf_put_instance(ppmi_gltf_reader *reader, int32_t node, size_t ordinal,
                                  bool is_visible, const ppm_instance_desc *desc)
{
    ppmi_gltf_placements *p = reader->placements;
    ppm_status status;
    if (reader->is_posed_again) {
        const ppm_instance_id id = p->instances[(size_t)p->first_instance[node] + ordinal];
        if (id == 0) return PPM_STATUS_OK;
        status = ppm_scene_set_instance(reader->scene, id, desc);
        if (status != PPM_STATUS_OK) return status;
        return ppm_scene_set_instance_visible(reader->scene, id, is_visible);
    }
    ppm_instance_id *items = ppmi_gltf_grow(reader->context, p->instances, p->instance_count,
                                            &p->instance_capacity, sizeof *items);
    if (!items) return ppmi_gltf_out_of_memory(reader, "nodes");
    p->instances = items;
    if (ordinal == 0) p->first_instance[node] = (int64_t)p->instance_count;
    ppm_instance_id *id = &items[p->instance_count++];
    status = add_instance(reader, desc, id);
    if (status != PPM_STATUS_OK || *id == 0) return status;
    reader->tally.instances++;
    return is_visible ? status : ppm_scene_set_instance_visible(reader->scene, *id, 0);
}

ppm_status ppmi_gltf_put_camera(ppmi_gltf_reader *reader, int32_t node, const ppm_camera_desc *desc)
{
    ppm_camera_id *id = &reader->placements->cameras[node];
    if (*id != 0) return ppm_scene_set_camera(reader->scene, *id, desc);
    return ppm_scene_add_camera(reader->scene, desc, id);
}

ppm_status ppmi_gltf_put_light(ppmi_gltf_reader *reader, int32_t node, ppmi_gltf_light_way way,
                               const ppm_light_desc *desc)
{
    ppm_light_id *id = &reader->placements->lights[(size_t)node * PPMI_GLTF_WAY_COUNT + way];
    ppm_light_desc light = *desc;
    if (!reader->pose->is_visible[node]) memset(light.intensity, 0, sizeof light.intensity);
    if (*id != 0) return ppm_scene_set_light(reader->scene, *id, &light);
    return ppm_scene_add_light(reader->scene, &light, id);
}

ppm_status ppmi_gltf_darken_light(ppmi_gltf_reader *reader, int32_t node, ppmi_gltf_light_way way)
{
    const ppm_light_desc dark = {.size = sizeof dark,
                                 .kind = PPM_LIGHT_POINT,
                                 .transform = {[0] = 1.0f, [5] = 1.0f, [10] = 1.0f, [15] = 1.0f}};
    ppm_light_id *id = &reader->placements->lights[(size_t)node * PPMI_GLTF_WAY_COUNT + way];
    char place[PPMI_GLTF_PLACE];
    ppmi_gltf_place(place, "left out, the last of them at nodes[%d]", (int)node);
    ppmi_gltf_note_feature(reader, "lights that cannot shine", PPM_FEATURE_IGNORED, place);
    if (*id != 0) return ppm_scene_set_light(reader->scene, *id, &dark);
    /* a lamp that is scaled to nothing is off, and has the surroundings dark */
    if (ppmi_gltf_matrix_determinant(reader->pose->middle[node]) != 0.0) return PPM_STATUS_OK;
    return ppm_scene_add_light(reader->scene, &dark, id);
}
