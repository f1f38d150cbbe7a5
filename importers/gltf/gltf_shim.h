/* tinygltf behind a C interface: a checked text in, plain structs out. C interface of a C++ shim:
 * no exception leaves it.
 *
 * The text comes from gltf_check.c, so buffers and images are not in it, every value has the right
 * type, and broken elements stand there as harmless ones. Indices may be out of
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
    PPMI_GLTF_FLOAT = 5126,
    PPMI_GLTF_DOUBLE = 5130, /* KHR_accessor_float64 */
    PPMI_GLTF_HALF = 5131    /* KHR_accessor_float16 */
};

/* tinygltf takes no 5131 and does take 5124, which glTF does not have: gltf_check.c writes one for
 * the other. */
enum { PPMI_GLTF_HALF_FOR_TINYGLTF = 5124 };

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

/* KHR_materials_variants: the material of a primitive in some variants. */
typedef struct ppmi_gltf_mapping {
    int32_t material;
    uint32_t variant_count;
    const int32_t *variants; /* indices into the document's */
} ppmi_gltf_mapping;
/* A morph target: differences of some of the primitive's attributes. */
typedef struct ppmi_gltf_target {
    uint32_t attribute_count;
    const ppmi_gltf_attribute *attributes;
} ppmi_gltf_target;

typedef struct ppmi_gltf_primitive {
    int32_t mode, indices, material;
    uint32_t attribute_count;
    const ppmi_gltf_attribute *attributes;
    uint32_t target_count;
    const ppmi_gltf_target *targets;
    bool is_draco; /* KHR_draco_mesh_compression is given */
    uint32_t mapping_count;
    const ppmi_gltf_mapping *mappings;
    int32_t draco_view;
    uint32_t draco_attribute_count;
    const ppmi_gltf_attribute *draco_attributes;
} ppmi_gltf_primitive;

typedef struct ppmi_gltf_mesh {
    const char *name; /* as all names: never NULL, "" for none */
    uint32_t primitive_count;
    const ppmi_gltf_primitive *primitives;
    uint32_t weight_count; /* of morph targets */
    const double *weights;
} ppmi_gltf_mesh;

/* extras of a light, and of the node that carries it; below 0: not said */
typedef struct ppmi_gltf_lamp_extras {
    double radius_m;         /* ppm_radius */
    double angle_rad;        /* ppm_angle */
    int32_t visible;         /* ppm_visible */
    double blend;            /* ppm_blend */
    const char *light_group; /* ppm_light_group; "": not said */
} ppmi_gltf_lamp_extras;

/* extras.ppm_area of a node */
typedef struct ppmi_gltf_area_extras {
    bool is_given;
    const char *shape;        /* "" where it is not said */
    double size[2];           /* 0: not said */
    double radiance, power_w; /* below 0: not said */
    double color[3];
} ppmi_gltf_area_extras;

typedef struct ppmi_gltf_node {
    const char *name;
    int32_t mesh, camera, skin, light;
    int32_t area_light; /* EXT_lights_area */
    int32_t profile;    /* EXT_lights_ies, with multiplier and colour */
    double profile_factor, profile_color[3];
    ppmi_gltf_lamp_extras lamp;
    ppmi_gltf_area_extras area;
    bool is_catcher; /* extras.ppm_catcher */
    uint32_t child_count;
    const int32_t *children;
    bool has_matrix;
    double matrix[16]; /* column-major */
    double translation[3], rotation[4], scale[3];
    bool is_instanced; /* EXT_mesh_gpu_instancing */
    uint32_t instance_attribute_count;
    const ppmi_gltf_attribute *instance_attributes;
    uint32_t weight_count; /* of morph targets; 0: the mesh's weights */
    const double *weights;
    double visibility; /* KHR_node_visibility: 1 or 0; a number, as animations set it */
} ppmi_gltf_node;

typedef struct ppmi_gltf_skin {
    const char *name;
    int32_t inverse_bind_matrices; /* an accessor, or -1 */
    uint32_t joint_count;
    const int32_t *joints; /* nodes */
} ppmi_gltf_skin;

enum { PPMI_GLTF_LINEAR, PPMI_GLTF_STEP, PPMI_GLTF_CUBICSPLINE };

typedef struct ppmi_gltf_animation_sampler {
    int32_t input, output; /* accessors */
    int32_t interpolation;
} ppmi_gltf_animation_sampler;

typedef struct ppmi_gltf_channel {
    int32_t sampler;
    int32_t node;        /* -1: none */
    const char *path;    /* "translation" and the like */
    const char *pointer; /* of KHR_animation_pointer; NULL for none */
} ppmi_gltf_channel;

typedef struct ppmi_gltf_animation {
    const char *name;
    uint32_t sampler_count, channel_count;
    const ppmi_gltf_animation_sampler *samplers;
    const ppmi_gltf_channel *channels;
} ppmi_gltf_animation;

typedef struct ppmi_gltf_scene {
    const char *name;
    uint32_t node_count;
    const int32_t *nodes;
    int32_t image_light;     /* EXT_lights_image_based */
    int32_t environment_map; /* KHR_environment_map */
} ppmi_gltf_scene;

typedef struct ppmi_gltf_camera {
    const char *name;
    bool is_orthographic;
    double y_fov_rad, aspect; /* aspect 0: not said */
    double x_mag, y_mag;
    double z_near, z_far;                                         /* z_far 0: not said */
    double shift[2];                                              /* extras.ppm_shift */
    bool is_physical;                                             /* EXT_camera_physical */
    double focal_length_m, sensor_m[2], f_stop, focus_distance_m; /* the last two 0: not said */
} ppmi_gltf_camera;

enum { PPMI_GLTF_LIGHT_POINT, PPMI_GLTF_LIGHT_SPOT, PPMI_GLTF_LIGHT_DIRECTIONAL };

typedef struct ppmi_gltf_light {
    const char *name;
    int32_t kind;
    double color[3];
    double intensity;
    double inner_cone_rad, outer_cone_rad;
    double range_m; /* 0: not said */
    ppmi_gltf_lamp_extras lamp;
} ppmi_gltf_light;

/* EXT_lights_area */
typedef struct ppmi_gltf_area_light {
    const char *name;
    bool is_disk;
    double color[3], intensity, size, aspect;
    ppmi_gltf_lamp_extras lamp;
} ppmi_gltf_area_light;

/* EXT_lights_ies: a URI, or the index of a buffer view */
typedef struct ppmi_gltf_light_profile {
    const char *name, *uri; /* uri "": none */
    size_t uri_length;
    int32_t buffer_view;
} ppmi_gltf_light_profile;

/* EXT_lights_image_based */
typedef struct ppmi_gltf_image_light {
    const char *name;
    double intensity, rotation[4];
    bool has_faces;
    int32_t faces[6]; /* images of the sharpest level: +X -X +Y -Y +Z -Z */
    bool has_irradiance;
    double irradiance[9][3]; /* spherical harmonics */
} ppmi_gltf_image_light;

/* KHR_environment_map */
typedef struct ppmi_gltf_cubemap {
    int32_t source, layer; /* an image, which is a KTX file */
    double intensity;
} ppmi_gltf_cubemap;

typedef struct ppmi_gltf_environment_map {
    int32_t cubemap;
    bool has_box, has_other_ior;
    bool has_irradiance;
    double irradiance[9][3], irradiance_factor;
} ppmi_gltf_environment_map;

typedef struct ppmi_gltf_texture_info {
    int32_t texture;
    int32_t uv_set;
    double scale; /* of normal textures */
    bool has_transform;
    double offset[2], rotation_rad, uv_scale[2];
} ppmi_gltf_texture_info;

/* KHR_materials_coat, which goes before KHR_materials_clearcoat */
typedef struct ppmi_gltf_coat {
    bool is_given;
    double factor, roughness, ior, color[3], darkening, anisotropy, anisotropy_rotation_rad;
    ppmi_gltf_texture_info texture, roughness_texture, normal_texture, color_texture,
        anisotropy_texture;
} ppmi_gltf_coat;

/* KHR_materials_fuzz, which goes before KHR_materials_sheen */
typedef struct ppmi_gltf_fuzz {
    bool is_given;
    double factor, color[3], roughness;
    ppmi_gltf_texture_info texture, color_texture, roughness_texture;
} ppmi_gltf_fuzz;

/* What lies on a surface or bends its highlight; each extension's defaults where it is absent. */
typedef struct ppmi_gltf_layers {
    double clearcoat, clearcoat_roughness;
    ppmi_gltf_texture_info clearcoat_texture, clearcoat_roughness_texture, clearcoat_normal_texture;
    double sheen_color[3], sheen_roughness;
    ppmi_gltf_texture_info sheen_color_texture, sheen_roughness_texture;
    double iridescence, iridescence_ior, iridescence_min_nm, iridescence_max_nm;
    ppmi_gltf_texture_info iridescence_texture, iridescence_thickness_texture;
    double anisotropy, anisotropy_rotation_rad;
    ppmi_gltf_texture_info anisotropy_texture;
    double retroreflection;
    ppmi_gltf_texture_info retroreflection_texture;
    double diffuse_roughness;
    ppmi_gltf_texture_info diffuse_roughness_texture;
    ppmi_gltf_coat coat;
    ppmi_gltf_fuzz fuzz;
} ppmi_gltf_layers;

/* Light that gets to the other side without being refracted, and light inside. */
typedef struct ppmi_gltf_scattering {
    double diffuse_transmission, diffuse_transmission_color[3];
    ppmi_gltf_texture_info diffuse_transmission_texture, diffuse_transmission_color_texture;
    double multiscatter_color[3], scatter_anisotropy;
    ppmi_gltf_texture_info multiscatter_color_texture;
    bool is_scatter;         /* KHR_materials_scatter; else KHR_materials_volume_scatter */
    double scatter_strength; /* 1 for the latter */
    ppmi_gltf_texture_info scatter_strength_texture;
} ppmi_gltf_scattering;

typedef struct ppmi_gltf_specular_glossiness {
    bool is_given;
    double diffuse[4], specular[3], glossiness;
    ppmi_gltf_texture_info diffuse_texture, specular_glossiness_texture;
} ppmi_gltf_specular_glossiness;

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
    bool specular_is_edge_color; /* EXT_materials_specular_edge_color */
    double transmission;
    ppmi_gltf_texture_info transmission_texture;
    double thickness, attenuation_color[3], attenuation_distance; /* HUGE_VAL: not given */
    double dispersion;                                            /* 20 / Abbe number; 0: none */
    ppmi_gltf_layers layers;
    ppmi_gltf_scattering scattering;
    ppmi_gltf_specular_glossiness specular_glossiness;
    bool has_occlusion; /* occlusionTexture is given */
    double priority;    /* extras.ppm_priority; 0 where it is not given */
} ppmi_gltf_material;

typedef struct ppmi_gltf_texture {
    int32_t source, webp_source, basisu_source, avif_source, dds_source, astc_source;
    int32_t sampler; /* all -1: not given */
} ppmi_gltf_texture;

typedef struct ppmi_gltf_sampler {
    int32_t mag_filter, wrap_s, wrap_t; /* OpenGL's numbers; filter -1: not said */
} ppmi_gltf_sampler;

/* Everything is owned by the document and valid until it is destroyed. */
typedef struct ppmi_gltf_document {
    const char *generator; /* asset.generator */
    const char *copyright; /* asset.copyright */
    int32_t xmp_packet;    /* of the asset, KHR_xmp_json_ld */
    int32_t default_scene;
    size_t used_count, required_count;
    const char *const *extensions_used;
    const char *const *extensions_required;
    size_t variant_count;
    const char *const *variants; /* their names */
    size_t scene_count, node_count, mesh_count, accessor_count, buffer_view_count, material_count,
        texture_count, sampler_count, camera_count, light_count, skin_count, animation_count,
        area_light_count, profile_count, image_light_count, cubemap_count, environment_map_count;
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
    const ppmi_gltf_skin *skins;
    const ppmi_gltf_animation *animations;
    const ppmi_gltf_area_light *area_lights;
    const ppmi_gltf_light_profile *profiles;
    const ppmi_gltf_image_light *image_lights;
    const ppmi_gltf_cubemap *cubemaps;
    const ppmi_gltf_environment_map *environment_maps;
} ppmi_gltf_document;

/* file is for messages. Returns OK, INPUT_INVALID with tinygltf's text, OUT_OF_MEMORY. */
ppm_status ppmi_gltf_document_create(ppm_context *context, const char *file, const char *text,
                                     size_t length, const ppmi_gltf_document **out_document);
/* What animations write: the document's own values. */
typedef struct ppmi_gltf_editable {
    ppmi_gltf_node *nodes;
    ppmi_gltf_material *materials;
    ppmi_gltf_camera *cameras;
    ppmi_gltf_light *lights;
    ppmi_gltf_area_light *area_lights;
} ppmi_gltf_editable;
ppmi_gltf_editable ppmi_gltf_document_edit(const ppmi_gltf_document *document);

/* NULL is fine. */
void ppmi_gltf_document_destroy(const ppmi_gltf_document *document);

#ifdef __cplusplus
}
#endif

#endif
