/* tinygltf behind a C interface: a checked text in, plain structs out. C interface of a C++ shim:
 * no exception leaves it.
 *
 * The text comes from gltf_check.c, so buffers, images, animations and skins are not in it, every
 * value has the right type, and broken elements stand there as harmless ones. Indices may be out of
 * range: whoever uses one checks it. -1 is "none". */
#ifndef PPMI_GLTF_SHIM_H
#define PPMI_GLTF_SHIM_H

#include <stdint.h>

#include "base/context.h"

#ifdef __cplusplus
extern "C" {
#endif

/* componentType */
enum {
    PPMI_GLTF_BYTE = 5120,
    PPMI_GLTF_UNSIGNED_BYTE = 5121,
    PPMI_GLTF_SHORT = 5122,
    PPMI_GLTF_UNSIGNED_SHORT = 5123,
    PPMI_GLTF_UNSIGNED_INT = 5125,
    PPMI_GLTF_FLOAT = 5126
};

/* mode of a primitive */
enum {
    PPMI_GLTF_POINTS = 0,
    PPMI_GLTF_LINES = 1,
    PPMI_GLTF_LINE_LOOP = 2,
    PPMI_GLTF_LINE_STRIP = 3,
    PPMI_GLTF_TRIANGLES = 4,
    PPMI_GLTF_TRIANGLE_STRIP = 5,
    PPMI_GLTF_TRIANGLE_FAN = 6
};

/* EXT_meshopt_compression or KHR_meshopt_compression of a buffer view. Sizes that are no sizes are
 * SIZE_MAX. */
typedef struct ppmi_gltf_meshopt {
    bool is_given;
    const char *name; /* of the extension */
    int32_t buffer;
    size_t byte_offset, byte_length, byte_stride, count;
    const char *mode, *filter;
} ppmi_gltf_meshopt;

typedef struct ppmi_gltf_buffer_view {
    int32_t buffer;
    size_t byte_offset, byte_length;
    size_t byte_stride; /* 0: packed */
    ppmi_gltf_meshopt meshopt;
} ppmi_gltf_buffer_view;

typedef struct ppmi_gltf_accessor {
    int32_t buffer_view; /* -1: zeros */
    size_t byte_offset;
    int32_t component_type;
    uint32_t component_count; /* 1..4 of SCALAR and VECn; 4, 9, 16 of matrices */
    uint32_t column_count;    /* of matrices, 2..4; 1 for all others */
    bool normalized;
    size_t count;
    size_t sparse_count; /* 0: not sparse */
    int32_t sparse_indices_view, sparse_indices_type, sparse_values_view;
    size_t sparse_indices_offset, sparse_values_offset;
} ppmi_gltf_accessor;

/* "POSITION" and the like, and an accessor; among Draco's attributes, an id in its stream. */
typedef struct ppmi_gltf_attribute {
    const char *name;
    int32_t accessor;
} ppmi_gltf_attribute;

typedef struct ppmi_gltf_primitive {
    int32_t mode, indices, material;
    uint32_t attribute_count;
    const ppmi_gltf_attribute *attributes;
    bool has_targets; /* morph targets */
    bool is_draco;    /* KHR_draco_mesh_compression is given */
    int32_t draco_view;
    uint32_t draco_attribute_count;
    const ppmi_gltf_attribute *draco_attributes;
} ppmi_gltf_primitive;

typedef struct ppmi_gltf_mesh {
    const char *name; /* as all names: never NULL, "" for none */
    uint32_t primitive_count;
    const ppmi_gltf_primitive *primitives;
} ppmi_gltf_mesh;

typedef struct ppmi_gltf_node {
    const char *name;
    int32_t mesh, camera, skin, light;
    uint32_t child_count;
    const int32_t *children;
    bool has_matrix;
    double matrix[16]; /* column-major */
    double translation[3], rotation[4], scale[3];
    bool is_instanced; /* EXT_mesh_gpu_instancing */
    uint32_t instance_attribute_count;
    const ppmi_gltf_attribute *instance_attributes;
} ppmi_gltf_node;

typedef struct ppmi_gltf_scene {
    uint32_t node_count;
    const int32_t *nodes;
} ppmi_gltf_scene;

typedef struct ppmi_gltf_camera {
    const char *name;
    bool is_orthographic;
    double y_fov_rad, aspect; /* aspect 0: not said */
    double x_mag, y_mag;
} ppmi_gltf_camera;

enum { PPMI_GLTF_LIGHT_POINT, PPMI_GLTF_LIGHT_SPOT, PPMI_GLTF_LIGHT_DIRECTIONAL };

typedef struct ppmi_gltf_light {
    const char *name;
    int32_t kind;
    double color[3];
    double intensity;
    double inner_cone_rad, outer_cone_rad;
} ppmi_gltf_light;

typedef struct ppmi_gltf_texture_info {
    int32_t texture;
    int32_t uv_set;
    double scale; /* of normal textures */
    bool has_transform;
    double offset[2], rotation_rad, uv_scale[2];
} ppmi_gltf_texture_info;

typedef struct ppmi_gltf_material {
    const char *name;
    double base_color[4], metallic, roughness, emissive[3], emissive_strength;
    ppmi_gltf_texture_info base_color_texture, metallic_roughness_texture, normal_texture,
        emissive_texture;
    const char *alpha_mode;
    double alpha_cutoff;
    bool double_sided;
    bool is_unlit;
    double ior;
    double specular, specular_color[3];
    ppmi_gltf_texture_info specular_texture, specular_color_texture;
    double transmission;
    ppmi_gltf_texture_info transmission_texture;
    double thickness, attenuation_color[3], attenuation_distance; /* distance 0: infinite */
    double dispersion;                                            /* 20 / Abbe number; 0: none */
    double priority; /* extras.ppm_priority; 0 where it is not given */
} ppmi_gltf_material;

typedef struct ppmi_gltf_texture {
    int32_t source, webp_source, basisu_source;
    int32_t sampler;
} ppmi_gltf_texture;

typedef struct ppmi_gltf_sampler {
    int32_t mag_filter, wrap_s, wrap_t; /* OpenGL's numbers; filter -1: not said */
} ppmi_gltf_sampler;

/* Everything is owned by the document and valid until it is destroyed. */
typedef struct ppmi_gltf_document {
    const char *generator; /* asset.generator */
    int32_t default_scene;
    size_t used_count, required_count;
    const char *const *extensions_used;
    const char *const *extensions_required;
    size_t scene_count, node_count, mesh_count, accessor_count, buffer_view_count, material_count,
        texture_count, sampler_count, camera_count, light_count;
    const ppmi_gltf_scene *scenes;
    const ppmi_gltf_node *nodes;
    const ppmi_gltf_mesh *meshes;
    const ppmi_gltf_accessor *accessors;
    const ppmi_gltf_buffer_view *buffer_views;
    const ppmi_gltf_material *materials;
    const ppmi_gltf_texture *textures;
    const ppmi_gltf_sampler *samplers;
    const ppmi_gltf_camera *cameras;
    const ppmi_gltf_light *lights;
} ppmi_gltf_document;

/* file is for messages. Returns OK, INPUT_INVALID with tinygltf's text, OUT_OF_MEMORY. */
ppm_status ppmi_gltf_document_create(ppm_context *context, const char *file, const char *text,
                                     size_t length, const ppmi_gltf_document **out_document);
/* NULL is fine. */
void ppmi_gltf_document_destroy(const ppmi_gltf_document *document);

#ifdef __cplusplus
}
#endif

#endif
