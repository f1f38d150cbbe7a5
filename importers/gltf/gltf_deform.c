/* Which nodes have meshes that change their shape, and what is kept of their skins. */
#include "gltf/gltf_deform.h"

#include <string.h>

#include "gltf/gltf_pose.h"

/* ---- which nodes ----------------------------------------------------------------------------- */

static bool has_targets(const ppmi_gltf_mesh *mesh)
{
    for (uint32_t i = 0; i < mesh->primitive_count; ++i) {
        if (mesh->primitives[i].target_count > 0) return true;
    }
    return false;
}

static bool may_change_weights(const ppmi_gltf_document *d)
{
    for (size_t i = 0; i < d->animation_count; ++i) {
        for (uint32_t k = 0; k < d->animations[i].channel_count; ++k) {
            const ppmi_gltf_channel *c = &d->animations[i].channels[k];
            if (strstr(c->pointer ? c->pointer : c->path, "weights")) return true;
        }
    }
    return false;
}

bool ppmi_gltf_is_deformed(const ppmi_gltf_reader *reader, int32_t index)
{
    const ppmi_gltf_document *d = reader->document;
    const ppmi_gltf_node *node = &d->nodes[index];
    if (node->mesh < 0 || (size_t)node->mesh >= d->mesh_count) return false;
    if (node->skin >= 0) return true;
    if (!has_targets(&d->meshes[node->mesh])) return false;
    for (size_t i = reader->pose->first_weight[index]; i < reader->pose->first_weight[index + 1];
         ++i) {
        if (reader->pose->weights[i] != 0.0) return true;
    }
    return may_change_weights(d);
}

/* ---- skins ----------------------------------------------------------------------------------- */

static ppm_status check_joints(ppmi_gltf_reader *reader, int32_t index)
{
    const ppmi_gltf_skin *skin = &reader->document->skins[index];
    char place[PPMI_GLTF_PLACE];
    ppmi_gltf_place(place, "skins[%d].joints", (int)index);
    if (skin->joint_count == 0) return ppmi_gltf_invalid(reader, place, "there are none");
    for (uint32_t i = 0; i < skin->joint_count; ++i) {
        ppmi_gltf_place(place, "skins[%d].joints[%u]", (int)index, (unsigned)i);
        const ppm_status status =
            ppmi_gltf_require(reader, PPMI_GLTF_NODES, skin->joints[i], place);
        if (status != PPM_STATUS_OK) return status;
        if (reader->pose->parents[skin->joints[i]] >= -1) continue;
        return ppmi_gltf_invalid(reader, place, "nodes[%d] is not in the scene",
                                 (int)skin->joints[i]);
    }
    return PPM_STATUS_OK;
}

/* Identities where the skin gives none. */
static ppm_status read_inverse_binds(ppmi_gltf_reader *reader, int32_t index,
                                     ppmi_gltf_deform *deform)
{
    static const ppmi_gltf_format matrix = {16, 16, 16, false};
    const ppmi_gltf_skin *skin = &reader->document->skins[index];
    char place[PPMI_GLTF_PLACE];
    double *values = NULL;
    size_t count = 0;
    ppmi_gltf_place(place, "skins[%d].inverseBindMatrices", (int)index);
    deform->inverse_binds =
        ppmi_alloc_zeroed(reader->context, skin->joint_count, sizeof *deform->inverse_binds);
    if (!deform->inverse_binds) return ppmi_gltf_out_of_memory(reader, place);
    if (skin->inverse_bind_matrices >= 0) {
        const ppm_status status = ppmi_gltf_read_doubles(reader, skin->inverse_bind_matrices, place,
                                                         &matrix, &values, &count);
        if (status != PPM_STATUS_OK) return status;
    }
    const bool is_short = values && count < skin->joint_count;
    for (size_t i = 0; i < skin->joint_count && !is_short; ++i) {
        for (size_t k = 0; k < 16; ++k) {
            deform->inverse_binds[i][k] = values ? values[16 * i + k] : k % 5 == 0;
        }
    }
    ppmi_free(reader->context, values);
    if (!is_short) return PPM_STATUS_OK;
    return ppmi_gltf_invalid(reader, place, "%zu matrices for %u joints", count,
                             (unsigned)skin->joint_count);
}

static ppm_status read_skin(ppmi_gltf_reader *reader, ppmi_gltf_deform *deform)
{
    const int32_t index = reader->document->nodes[deform->node].skin;
    char place[PPMI_GLTF_PLACE];
    ppmi_gltf_place(place, "nodes[%d].skin", (int)deform->node);
    ppm_status status = ppmi_gltf_require(reader, PPMI_GLTF_SKINS, index, place);
    if (status == PPM_STATUS_OK) status = check_joints(reader, index);
    if (status == PPM_STATUS_OK) status = read_inverse_binds(reader, index, deform);
    if (status != PPM_STATUS_OK) return status;
    deform->joint_count = reader->document->skins[index].joint_count;
    deform->joints = reader->document->skins[index].joints;
    return PPM_STATUS_OK;
}

/* ---- memory ---------------------------------------------------------------------------------- */

ppm_status ppmi_gltf_deform_create(ppmi_gltf_reader *reader, int32_t node, ppmi_gltf_deform **out)
{
    const ppmi_gltf_node *from = &reader->document->nodes[node];
    const uint32_t count = reader->document->meshes[from->mesh].primitive_count;
    char place[PPMI_GLTF_PLACE];
    ppmi_gltf_place(place, "nodes[%d]", (int)node);
    ppmi_gltf_deform *deform = ppmi_alloc_zeroed(reader->context, 1, sizeof *deform);
    *out = deform;
    if (!deform) return ppmi_gltf_out_of_memory(reader, place);
    deform->node = node;
    deform->primitives =
        ppmi_alloc_zeroed(reader->context, (size_t)count + 1, sizeof *deform->primitives);
    if (!deform->primitives) return ppmi_gltf_out_of_memory(reader, place);
    return from->skin >= 0 ? read_skin(reader, deform) : PPM_STATUS_OK;
}

static void free_delta(ppm_context *context, ppmi_gltf_delta *delta)
{
    ppmi_free(context, delta->vertices);
    ppmi_free(context, delta->values);
}

static void free_primitive(ppm_context *context, ppmi_gltf_deform_primitive *p)
{
    for (uint32_t i = 0; p->targets && i < p->target_count; ++i) {
        free_delta(context, &p->targets[i].position);
        free_delta(context, &p->targets[i].normal);
        free_delta(context, &p->targets[i].tangent);
        free_delta(context, &p->targets[i].color);
        for (size_t k = 0; k < PPM_MAX_UV_SETS; ++k) {
            free_delta(context, &p->targets[i].uvs[k]);
        }
    }
    ppmi_free(context, p->targets);
    ppmi_free(context, p->colors);
    for (size_t k = 0; k < PPM_MAX_UV_SETS; ++k) {
        ppmi_free(context, p->uvs[k]);
    }
    ppmi_free(context, p->positions);
    ppmi_free(context, p->normals);
    ppmi_free(context, p->tangents);
    ppmi_free(context, p->joints);
    ppmi_free(context, p->weights);
    ppmi_free(context, p->buffer);
}

void ppmi_gltf_deform_destroy(ppm_context *context, ppmi_gltf_deform *deform)
{
    if (!deform) return;
    for (uint32_t i = 0; deform->primitives && i < deform->primitive_count; ++i) {
        free_primitive(context, &deform->primitives[i]);
    }
    ppmi_free(context, deform->primitives);
    ppmi_free(context, deform->inverse_binds);
    ppmi_free(context, deform);
}
