/* The scene as arrays: what the builder checks and keeps, and what rendering reads.
 *
 * Everything is const once frozen. Ids of the public API are index + 1. */
#ifndef PPMI_SCENE_H
#define PPMI_SCENE_H

#include <stdint.h>

#include "base/context.h"
#include "base/working_space.h"
#include "math/transform.h"
#include "ppm/scene.h"

#ifdef __cplusplus
extern "C" {
#endif

/* Pixels of a texture. 8-bit values go through decode (256 entries), so that sRGB images stay one
 * byte a channel; alpha and data never do. */
typedef struct ppmi_image_level {
    uint32_t width, height;
    const uint8_t *u8; /* or NULL */
    const float *f32;  /* or NULL */
} ppmi_image_level;

typedef struct ppmi_image {
    char *name;
    uint32_t width, height, channels;
    uint8_t *u8;     /* or NULL */
    float *f32;      /* or NULL; linear */
    bool is_srgb;    /* u8 holds sRGB-encoded colour */
    bool is_working; /* f32 holds colour of a working space that is not linear Rec.709 */
    bool is_rec709;  /* u8 holds colour of Rec.709 primaries; look-ups bring it to the working space
                      */

    uint32_t mip_count;     /* levels beyond the image itself; scene/mipmap.h */
    ppmi_image_level *mips; /* NULL: not built */
    void *mip_pixels;       /* of all of them */
} ppmi_image;

/* Coordinates are below it: their squares stay far within single precision's range. */
#define PPMI_FARTHEST_M 1e15f

/* What fills the space between surfaces, homogeneous; all 0: nothing. */
typedef struct ppmi_medium {
    ppmi_vec3 sigma_s, sigma_a; /* scattering and absorption coefficients, 1/m */
    float asymmetry_g;          /* Henyey-Greenstein */
} ppmi_medium;

typedef struct ppmi_material {
    char *name;
    ppm_material_desc desc; /* desc.name is not used */
    bool emits;             /* emission is not black */
    bool has_alpha;         /* MASK or BLEND: a ray may pass */
    bool is_solid_glass;    /* transmissive, bounds a solid */
    bool is_sheet;          /* transmissive, thin: light may go straight on */
    bool is_layered;        /* has more than core, ior, specular and transmission ask for */
    ppmi_medium inside;     /* of the solid */
} ppmi_material;

/* Triangles, points or lines with one material. positions, normals and tangents hold a block of
 * vertex_count elements for each motion step. positions have 16 bytes of padding behind them, as
 * Embree reads the last vertex 16 bytes at once. */
typedef struct ppmi_primitive {
    uint32_t vertex_count, triangle_count;
    float *positions;
    float *normals;  /* or NULL: flat */
    float *tangents; /* or NULL */
    float *uvs[PPM_MAX_UV_SETS];
    float *colors; /* or NULL */
    uint32_t *indices;
    uint32_t material;       /* index */
    uint32_t motion_steps;   /* 1: at rest */
    int32_t kind;            /* PPM_PRIMITIVE_; triangle_count is 0 for all but triangles */
    uint32_t element_count;  /* triangles, points or lines, by kind */
    float radius_m;          /* of points and lines, object space */
    uint32_t *given_indices; /* of all elements that were given, where some are left out; or NULL */
    uint32_t given_count;    /* elements */
    ppmi_vec3 bounds_min, bounds_max; /* object space, of the used vertices at all steps */
} ppmi_primitive;

typedef struct ppmi_mesh {
    char *name;
    uint32_t primitive_count;
    ppmi_primitive *primitives;
    ppmi_vec3 bounds_min, bounds_max; /* object space, of the used vertices at all steps */
    uint64_t shape_version;           /* rises with every change of the vertices */
    uint64_t topology_version; /* rises where such a change is more than a move of vertices */
    uint64_t oriented_version; /* the shape_version that scene/orient.h has looked at; 0: none */
    uint32_t turned_count;     /* triangles of solids that it has turned */
} ppmi_mesh;

/* Motion: transforms holds motion_steps transforms as they are kept, and behind them the same as
 * they were given (see ppmi_scene_freeze). In between, matrices are interpolated linearly. */
typedef struct ppmi_instance {
    char *name;
    uint32_t mesh;           /* index */
    ppmi_transform to_world; /* in motion: at the opening of the shutter */
    ppmi_transform normals;  /* takes normals to normals, up to length */
    float scale;             /* longest column of to_world at any step: how much it enlarges */
    bool is_mirrored;        /* to_world has a negative determinant: the winding is reversed */
    bool is_hidden;          /* by the caller */
    bool is_singular;        /* a line or a point at all steps: nothing to see */
    bool is_beyond;          /* of what single precision can trace; while a session lasts */
    bool is_catcher;
    bool is_left_out;       /* while catchers are shown alone */
    uint32_t motion_steps;  /* 1: at rest */
    ppmi_transform *motion; /* or NULL: at rest */
    ppmi_vec3 given_origin; /* of to_world */
    char *asset;            /* never NULL */
    char *light_group;      /* NULL: none is given */
} ppmi_instance;

/* Whether rays can meet the instance. */
static inline bool ppmi_instance_is_there(const ppmi_instance *instance)
{
    return !instance->is_hidden && !instance->is_singular && !instance->is_beyond &&
           !instance->is_left_out;
}

/* Where a camera stands and how it is turned: orthonormal. */
typedef struct ppmi_camera_pose {
    ppmi_vec3 origin, right, up, forward;
    ppmi_vec3 given_origin;
} ppmi_camera_pose;

typedef struct ppmi_camera {
    char *name;
    int32_t kind;
    ppmi_vec3 origin, right, up, forward; /* orthonormal; in motion: at the opening */
    ppmi_vec3 given_origin;
    uint32_t motion_steps;    /* 1: at rest */
    ppmi_camera_pose *motion; /* at all steps; or NULL: at rest */
    float y_fov_rad;
    float half_width_m, half_height_m;
    float aspect;
    float f_number;         /* 0: pinhole */
    float focus_distance_m; /* 0: not said */
    float shift[2];         /* in heights of the picture */
    float near_m, far_m;    /* along the axis; far_m 0: without end */
} ppmi_camera;

typedef struct ppmi_punctual {
    char *name;
    int32_t kind;
    ppmi_vec3 position, direction; /* direction: where it shines, unit */
    ppmi_vec3 given_position;
    ppmi_vec3 intensity;
    float cos_inner, cos_outer;        /* spot */
    float angular_radius_rad;          /* directional; 0: parallel light */
    ppmi_vec3 right, up;               /* local X and Y, unit */
    float radius_m;                    /* point, spot; 0: a point */
    float half_width_m, half_height_m; /* rectangle, disk */
    bool is_hidden;                    /* from the camera */
    uint32_t profile;                  /* index + 1; 0: none */
    char *light_group;                 /* NULL: none is given */
} ppmi_punctual;

/* As in ppm_light_profile_desc. */
typedef struct ppmi_light_profile {
    char *name;
    uint32_t polar_count, azimuth_count;
    float *polar_rad, *azimuth_rad, *candela;
} ppmi_light_profile;

/* Frees what it holds. */
void ppmi_light_profile_deinit(ppm_context *context, ppmi_light_profile *profile);

typedef struct ppmi_environment {
    bool is_set;
    ppmi_vec3 radiance;
    uint32_t image; /* index + 1; 0: constant */
    float rotation_rad;
    bool has_backdrop;
    ppmi_vec3 backdrop;
    char *light_group; /* NULL: none is given */
} ppmi_environment;

/* A copy of a desc's light_group in *out_group: NULL where none is given (NULL or ""). False when
 * memory is out. */
bool ppmi_light_group_copy(ppm_context *context, const char *group, char **out_group);

/* What another folder keeps with the scene from session to session. */
typedef struct ppmi_kept {
    void *data; /* NULL: nothing */
    void (*destroy)(void *data);
} ppmi_kept;

struct ppm_scene {
    ppm_context *context;
    float srgb_to_linear[256];
    ppmi_working_space working; /* of all colours, but those of images that say otherwise */
    const ppm_color *color;     /* what it was made with, or NULL */
    uint32_t image_count, material_count, mesh_count, instance_count, camera_count, punctual_count;
    uint32_t profile_count;
    ppmi_image *images;
    ppmi_material *materials;
    ppmi_mesh *meshes;
    ppmi_instance *instances;
    ppmi_camera *cameras;
    ppmi_punctual *punctuals;
    ppmi_light_profile *profiles;
    ppmi_environment environment;
    bool environment_is_assumed; /* for the time of a session: see ppmi_scene_thaw */
    ppmi_medium fog;
    ppm_material_id default_material; /* of primitives without one; 0: not made yet */
    ppmi_vec3 shift;        /* what has been subtracted from all positions; see ppmi_scene_freeze */
    double origin_m[3];     /* of all positions, in the file's coordinates */
    ppmi_kept accel;        /* acceleration structures of the meshes */
    uint32_t session_count; /* render sessions that keep it frozen */
    bool is_frozen;
};

/* Ends building for the time of a session. Instances that single precision cannot trace, since they
 * lie beyond PPMI_FARTHEST_M or are too small for where they stand, are left out with a warning. A
 * scene that lies far from the origin for its size (a georeferenced site) is moved there first:
 * floats are finest at zero. What the public API tells of positions stays as it was. */
void ppmi_scene_freeze(ppm_scene *scene);

/* The end of a session: once for each freeze. The last one opens the scene for changes: all is
 * where it was given, to the bit, and an assumed environment is gone. */
void ppmi_scene_thaw(ppm_scene *scene);

/* Whether anything that is there moves while the shutter is open; the camera does not count. */
bool ppmi_scene_moves(const ppm_scene *scene);

/* World bounds of all instances that are there, over the whole shutter, in the positions as they
 * are kept, but for those too far away to be traced; false when there is nothing. */
bool ppmi_scene_bounds(const ppm_scene *scene, ppmi_vec3 *out_min, ppmi_vec3 *out_max);

/* The same of all instances, hidden ones too. */
bool ppmi_scene_bounds_of_all(const ppm_scene *scene, ppmi_vec3 *out_min, ppmi_vec3 *out_max);

/* Whether there is anything that is meant to light the scene, though it may be off or hidden now: a
 * frame in which the lamps go out is dark. An environment, a punctual light, or an emissive
 * material in use that has no texture or is brighter than 1 nit. Emissive textures within 0 .. 1
 * are decoration (a display, a glowing logo): files that have nothing else were made for viewers
 * that bring their own light. */
bool ppmi_scene_has_light(const ppm_scene *scene);

/* Takes ownership of decoded pixels (u8 or f32 made by ppmi_alloc); on failure the caller keeps
 * them. */
ppm_status ppmi_scene_take_image(ppm_scene *scene, const ppmi_image *image, ppm_image_id *out_id);

/* WRONG_STATE while frozen, else OK. */
ppm_status ppmi_scene_check_open(const ppm_scene *scene);

/* Room for one more element in an array that doubles; the new element is zeroed and NOT counted
 * until the caller raises *count. NULL when memory is out (reported). */
void *ppmi_scene_grow(ppm_context *context, void *array, uint32_t count, size_t element_size);

#ifdef __cplusplus
}
#endif

#endif
