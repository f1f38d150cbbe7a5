#include "gltf_motion.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

ppm_pose gltf_at(double time_s)
{
    return (ppm_pose){.is_animated = 1, .open_s = time_s, .close_s = time_s};
}

ppm_pose gltf_between(double open_s, double close_s)
{
    return (ppm_pose){.is_animated = 1, .open_s = open_s, .close_s = close_s};
}

ppm_status gltf_open_path(gltf_fixture *f, const char *path, ppmi_gltf_asset **out_asset)
{
    *out_asset = NULL;
    ppm_status status = ppmi_gltf_asset_open(f->context, path, &f->options, out_asset);
    if (status == PPM_STATUS_OK) status = ppmi_gltf_asset_import(*out_asset, f->scene);
    if (status != PPM_STATUS_OK) {
        ppmi_gltf_asset_close(*out_asset);
        *out_asset = NULL;
    }
    return status;
}

ppm_status gltf_open_text(gltf_fixture *f, const char *json, ppmi_gltf_asset **out_asset)
{
    static char path[160];
    const size_t length = strlen(json);
    char *text = malloc(length + 1);
    assert_non_null(text);
    for (size_t i = 0; i <= length; ++i) {
        text[i] = (char)(json[i] == '\'' ? '"' : json[i]);
    }
    gltf_write(f, "sub/scene.gltf", text, length);
    free(text);
    snprintf(path, sizeof path, "%s", gltf_path(f, "sub/scene.gltf"));
    return gltf_open_path(f, path, out_asset);
}

ppm_status gltf_open_keys(gltf_fixture *f, const gltf_keys *keys, const char *middle,
                          ppmi_gltf_asset **out_asset)
{
    static const float triangle[9] = {0, 0, 0, 1, 0, 0, 0, 1, 0};
    const size_t times = keys->count, values = keys->value_count * keys->width;
    const size_t size = (9 + times + values) * sizeof(float);
    static char text[1 << 15];
    float data[512];
    assert_true(size <= sizeof data);
    memcpy(data, triangle, sizeof triangle);
    memcpy(data + 9, keys->times, times * sizeof(float));
    memcpy(data + 9 + times, keys->values, values * sizeof(float));
    snprintf(text, sizeof text,
             "{'asset':{'version':'2.0'},'scenes':[{'nodes':[0]}],%s,"
             "'meshes':[{'name':'M','primitives':[{'attributes':{'POSITION':0},'material':0}]}],"
             "'accessors':[{'bufferView':0,'componentType':5126,'count':3,'type':'VEC3'},"
             "{'bufferView':0,'byteOffset':36,'componentType':5126,'count':%zu,'type':'SCALAR'},"
             "{'bufferView':0,'byteOffset':%zu,'componentType':5126,'count':%zu,'type':'%s'}],"
             "'bufferViews':[{'buffer':0,'byteLength':%zu}],"
             "'buffers':[{'byteLength':%zu,'uri':'%s'}]}",
             middle, times, 36 + 4 * times, keys->value_count, keys->type, size, size,
             gltf_data_uri(data, size));
    return gltf_open_text(f, text, out_asset);
}

ppm_status gltf_open_channel(gltf_fixture *f, const gltf_keys *keys, const char *path,
                             const char *node, ppmi_gltf_asset **out_asset)
{
    char middle[2048];
    snprintf(middle, sizeof middle,
             "'materials':[{}],'nodes':[{%s'mesh':0}],"
             "'animations':[{'name':'A','channels':[{'sampler':0,'target':{'node':0,"
             "'path':'%s'}}],'samplers':[{'input':1,'output':2,'interpolation':'%s'}]}]",
             node, path, keys->interpolation);
    return gltf_open_keys(f, keys, middle, out_asset);
}

/* FNV-1a */
static uint64_t add_bytes(uint64_t hash, const void *bytes, size_t count)
{
    for (size_t i = 0; i < count; ++i) {
        hash = (hash ^ ((const unsigned char *)bytes)[i]) * 1099511628211u;
    }
    return hash;
}

static uint64_t add_mesh(uint64_t hash, const ppmi_primitive *p)
{
    const size_t count = (size_t)p->vertex_count * p->motion_steps;
    hash = add_bytes(hash, p->positions, 3 * count * sizeof(float));
    if (p->normals) hash = add_bytes(hash, p->normals, 3 * count * sizeof(float));
    if (p->tangents) hash = add_bytes(hash, p->tangents, 4 * count * sizeof(float));
    return hash;
}

uint64_t gltf_scene_hash(const ppm_scene *scene)
{
    uint64_t hash = 14695981039346656037u;
    for (uint32_t i = 0; i < scene->mesh_count; ++i) {
        for (uint32_t k = 0; k < scene->meshes[i].primitive_count; ++k) {
            hash = add_mesh(hash, &scene->meshes[i].primitives[k]);
        }
    }
    for (uint32_t i = 0; i < scene->instance_count; ++i) {
        const ppmi_instance *instance = &scene->instances[i];
        hash = add_bytes(hash, &instance->to_world, sizeof instance->to_world);
        hash = add_bytes(hash, &instance->is_hidden, sizeof instance->is_hidden);
        hash = add_bytes(hash, &instance->motion_steps, sizeof instance->motion_steps);
    }
    for (uint32_t i = 0; i < scene->camera_count; ++i) {
        hash = add_bytes(hash, &scene->cameras[i].origin, sizeof(ppmi_vec3));
        hash = add_bytes(hash, &scene->cameras[i].forward, sizeof(ppmi_vec3));
        hash = add_bytes(hash, &scene->cameras[i].y_fov_rad, sizeof(float));
    }
    for (uint32_t i = 0; i < scene->punctual_count; ++i) {
        hash = add_bytes(hash, &scene->punctuals[i].position, sizeof(ppmi_vec3));
        hash = add_bytes(hash, &scene->punctuals[i].intensity, sizeof(ppmi_vec3));
    }
    for (uint32_t i = 0; i < scene->material_count; ++i) {
        const ppm_material_desc *m = &scene->materials[i].desc;
        hash = add_bytes(hash, m->base_color, sizeof m->base_color);
        hash = add_bytes(hash, m->emission, sizeof m->emission);
        hash = add_bytes(hash, &m->roughness, sizeof m->roughness);
    }
    return hash;
}
