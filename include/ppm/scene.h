/* The scene: what is rendered. Built by calls, or filled by ppm_scene_import (import.h).
 *
 * Conventions, everywhere in this API:
 *   lengths in metres, angles in radians, right-handed, +Y up;
 *   transforms are local-to-world, 4x4, column-major (translation in elements 12, 13, 14),
 *   affine (last row 0 0 0 1);
 *   colours are linear Rec.709 (D65), not premultiplied, whatever the working space of the scene
 *   is: they are converted where they enter it (color.h);
 *   radiance in nit (cd/m2), radiant intensity of point and spot lights in candela, irradiance of
 *   directional lights in lux, all on one photometric scale;
 *   ids start at 1; 0 is "none".
 * All arrays and strings that a desc points to are copied; the caller keeps its own.
 * Threads: one thread builds a scene at a time. While a render session of a scene is alive, the
 * scene is frozen: adding to it and changing it return WRONG_STATE, reading is free from any
 * thread. */
#ifndef PPM_SCENE_H
#define PPM_SCENE_H

#include <stddef.h>
#include <stdint.h>

#include "ppm/color.h"
#include "ppm/context.h"

#ifdef __cplusplus
extern "C" {
#endif

typedef struct ppm_scene ppm_scene;

typedef uint32_t ppm_image_id;
typedef uint32_t ppm_material_id;
typedef uint32_t ppm_mesh_id;
typedef uint32_t ppm_instance_id;
typedef uint32_t ppm_camera_id;
typedef uint32_t ppm_light_id;
typedef uint32_t ppm_light_profile_id;

/* Makes an empty scene in the working space of color, which converts its textures and colours; NULL
 * uses the built-in configuration and linear Rec.709. The
 * context and color must outlive the scene. Returns OK, INVALID_ARGUMENT, OUT_OF_MEMORY. */
PPM_API ppm_status ppm_scene_create(ppm_context *context, const ppm_color *color,
                                    ppm_scene **out_scene);
/* NULL is fine. No render session of this scene may be alive. */
PPM_API void ppm_scene_destroy(ppm_scene *scene);

/* ---- images and textures --------------------------------------------------------------------- */

enum {
    PPM_IMAGE_COLOR = 1, /* display-encoded colour: sRGB, or scene-linear where the file is HDR */
    PPM_IMAGE_DATA = 2   /* numbers: normals, roughness, masks; no colour conversion */
};
enum { PPM_PIXELS_U8 = 1, PPM_PIXELS_F32 = 2 };

/* One image, from exactly one of: a file, an encoded file in memory, or pixels. */
typedef struct ppm_image_desc {
    uint32_t size;     /* sizeof(ppm_image_desc) */
    const char *name;  /* for messages; may be NULL */
    int32_t role;      /* PPM_IMAGE_COLOR or PPM_IMAGE_DATA */
    const char *path;  /* a file, UTF-8; or NULL */
    const void *bytes; /* an encoded file (PNG, JPEG, ...) of byte_count bytes; or NULL */
    size_t byte_count;
    const void *pixels; /* width * height * channels values, row 0 on top, packed; or NULL */
    int32_t pixel_type; /* PPM_PIXELS_U8 (0..255 is 0..1) or PPM_PIXELS_F32, of pixels */
    uint32_t width;     /* of pixels */
    uint32_t height;    /* of pixels */
    uint32_t channels;  /* of pixels: 1 grey, 2 grey+alpha, 3 RGB, 4 RGBA */
    const char *label;  /* what its file calls it, or NULL: without a path, patterns of texture
                           spaces  (color.h) and file rules are about it, or about name without it */
    int32_t strict;     /* 1: a file that is damaged fails (INPUT_INVALID) even where all its pixels
                           are there; 0: that is warned about */
} ppm_image_desc;

/* Decodes and keeps an image. PPM_IMAGE_COLOR pixels of type F32 are taken as linear Rec.709, those
 * of type U8 as sRGB, unless the scene's color has a texture space or a file rule for the path or
 * name; floats of a file have the primaries that it tells.
 * Returns OK, INVALID_ARGUMENT, INPUT_NOT_FOUND, INPUT_INVALID, INPUT_UNSUPPORTED, OUT_OF_MEMORY,
 * WRONG_STATE. */
PPM_API ppm_status ppm_scene_add_image(ppm_scene *scene, const ppm_image_desc *desc,
                                       ppm_image_id *out_id);

/* The mean of an image's pixels: linear Rec.709 for PPM_IMAGE_COLOR, and alpha, 1 without. Returns
 * OK, INVALID_ARGUMENT. */
PPM_API ppm_status ppm_scene_image_mean(const ppm_scene *scene, ppm_image_id id, float out_rgba[4]);

typedef struct ppm_image_info {
    uint32_t size;      /* sizeof(ppm_image_info), set by the caller */
    uint32_t width;     /* pixels */
    uint32_t height;    /* pixels */
    uint32_t channels;  /* 1 grey, 2 grey and alpha, 3 RGB, 4 RGBA */
    int32_t pixel_type; /* PPM_PIXELS_: how exactly it is kept */
} ppm_image_info;

/* Returns OK, INVALID_ARGUMENT. */
PPM_API ppm_status ppm_scene_get_image_info(const ppm_scene *scene, ppm_image_id id,
                                            ppm_image_info *out_info);
/* One row of an image, from 0 on top: 4 * width floats, RGBA; grey is in all three, alpha 1
 * without. Linear Rec.709 for PPM_IMAGE_COLOR, else as it stands. Returns OK, INVALID_ARGUMENT. */
PPM_API ppm_status ppm_scene_read_image_row(const ppm_scene *scene, ppm_image_id id, uint32_t row,
                                            float *out_rgba);

/* Decodes and keeps count images, as many at once as there are processors. Ids and messages are in
 * the order of descs, whatever image is ready first. out_ids and out_statuses have count entries: 0
 * and what ppm_scene_add_image would have returned for an image that fails, of which the log tells
 * as a warning, unless memory is out; the others are added.
 * Returns OK also where images fail; INVALID_ARGUMENT for a desc that is not valid (nothing is
 * added then), OUT_OF_MEMORY, WRONG_STATE. */
PPM_API ppm_status ppm_scene_add_images(ppm_scene *scene, const ppm_image_desc *descs,
                                        uint32_t count, ppm_image_id *out_ids,
                                        ppm_status *out_statuses);

enum { PPM_WRAP_REPEAT = 0, PPM_WRAP_CLAMP = 1, PPM_WRAP_MIRROR = 2 };
enum { PPM_FILTER_LINEAR = 0, PPM_FILTER_NEAREST = 1 };

/* A use of an image by a material. All zero: no texture. */
typedef struct ppm_texture {
    ppm_image_id image;     /* 0: none */
    uint32_t uv_set;        /* 0 .. PPM_MAX_UV_SETS - 1 */
    int32_t wrap_u;         /* PPM_WRAP_ */
    int32_t wrap_v;         /* PPM_WRAP_ */
    int32_t filter;         /* PPM_FILTER_ */
    uint32_t has_transform; /* non-zero: uv_transform applies */
    float uv_transform[6];  /* u' = t0 u + t1 v + t2, v' = t3 u + t4 v + t5; origin top left */
} ppm_texture;

/* ---- materials ------------------------------------------------------------------------------- */

enum { PPM_ALPHA_OPAQUE = 0, PPM_ALPHA_MASK = 1, PPM_ALPHA_BLEND = 2 };
enum {
    PPM_TRANSMISSION_SOLID = 0, /* the surface bounds a solid: rays bend */
    PPM_TRANSMISSION_THIN = 1   /* the surface is an infinitely thin sheet: rays do not bend */
};

/* The metallic-roughness model of glTF 2.0 with the extensions that are named. Textures multiply
 * the factors. Fill with ppm_material_desc_init first. */
typedef struct ppm_material_desc {
    uint32_t size;    /* sizeof(ppm_material_desc) */
    const char *name; /* may be NULL */

    float base_color[4];            /* linear Rec.709 and alpha; default 1 1 1 1 */
    ppm_texture base_color_texture; /* RGB colour, A alpha */
    float metallic;                 /* 0..1; default 0 (glTF's own default, 1, is the importer's) */
    float roughness;                /* perceptual, 0..1: GGX alpha is its square; default 0.5 */
    ppm_texture metallic_roughness_texture; /* G roughness, B metallic */
    ppm_texture normal_texture;             /* tangent space; needs uv, tangents help */
    float normal_scale;                     /* default 1 */
    float emission[3];                      /* radiance, nit; default 0 */
    ppm_texture emission_texture;

    float ior;                          /* outside is 1; default 1.5 (KHR_materials_ior); 0 is the
                                           extension's "full Fresnel" value */
    float specular;                     /* KHR_materials_specular; default 1 */
    ppm_texture specular_texture;       /* A */
    float specular_color[3];            /* default 1 1 1 */
    ppm_texture specular_color_texture; /* RGB */

    float transmission;               /* KHR_materials_transmission; default 0 */
    ppm_texture transmission_texture; /* R */
    int32_t transmission_kind;        /* PPM_TRANSMISSION_ */
    float attenuation_color[3];       /* KHR_materials_volume; default 1 1 1 */
    float attenuation_distance_m;     /* 0: none; default 0 */
    float dispersion;                 /* KHR_materials_dispersion: 20 / Abbe number; default 0 */
    int32_t nested_priority;          /* of solids that overlap the one with the higher number is
                                         there, among equals the one that a ray entered last;
                                         default 0 (docs/transport.md) */

    int32_t alpha_mode;    /* PPM_ALPHA_ */
    float alpha_cutoff;    /* for MASK; default 0.5 */
    uint32_t double_sided; /* 0: the back is not seen by the camera and does not emit; default 1 */

    float clearcoat;                         /* KHR_materials_clearcoat, 0..1; default 0 */
    ppm_texture clearcoat_texture;           /* R */
    float clearcoat_roughness;               /* perceptual, 0..1; default 0 */
    ppm_texture clearcoat_roughness_texture; /* G */
    ppm_texture clearcoat_normal_texture;    /* tangent space, of the coat alone */
    float clearcoat_normal_scale;            /* default 1 */

    float sheen_color[3];                /* KHR_materials_sheen, 0..1; default 0 */
    ppm_texture sheen_color_texture;     /* RGB */
    float sheen_roughness;               /* perceptual, 0..1; default 0 */
    ppm_texture sheen_roughness_texture; /* A */

    float iridescence;                         /* KHR_materials_iridescence, 0..1; default 0 */
    ppm_texture iridescence_texture;           /* R */
    float iridescence_ior;                     /* of the film; default 1.3 */
    float iridescence_thickness_min_nm;        /* where the texture is 0; default 100 */
    float iridescence_thickness_max_nm;        /* where it is 1, or without one; default 400 */
    ppm_texture iridescence_thickness_texture; /* G */

    float anisotropy;               /* KHR_materials_anisotropy: strength, 0..1; default 0 */
    float anisotropy_rotation_rad;  /* of the direction, from the tangent, counter-clockwise */
    ppm_texture anisotropy_texture; /* RG direction in -1..1, B strength */

    float diffuse_transmission; /* KHR_materials_diffuse_transmission, 0..1. Bounds a solid if
                                   transmission_kind says so and the attenuation is not nothing */
    ppm_texture diffuse_transmission_texture;       /* A */
    float diffuse_transmission_color[3];            /* default 1 1 1 */
    ppm_texture diffuse_transmission_color_texture; /* RGB */

    float multiscatter_color[3]; /* KHR_materials_volume_scatter (draft): albedo of the medium
                                    inside after all scattering, 0..1; default 0: no scattering */
    float scatter_anisotropy_g;  /* Henyey-Greenstein's mean cosine, -1 < g < 1; default 0 */

    float retroreflection;               /* KHR_materials_retroreflection (draft): the share of the
                                            specular reflection that goes back where the light came
                                            from, 0..1; default 0 */
    ppm_texture retroreflection_texture; /* R */

    uint32_t roughness_is_glossiness;     /* non-zero: roughness is a glossiness, and A of
                                             metallic_roughness_texture multiplies it. The perceptual
                                             roughness is 1 less the product, and nothing multiplies
                                             metallic (KHR_materials_pbrSpecularGlossiness) */
    uint32_t emission_takes_vertex_color; /* non-zero: vertex colours multiply the emission, as they
                                             do base_color (KHR_materials_unlit) */

    float diffuse_roughness; /* KHR_materials_diffuse_roughness (draft), 0..1, of the diffuse base
                                and what it transmits; default 0: Lambert's */
    ppm_texture diffuse_roughness_texture; /* R */

    uint32_t specular_is_edge_color; /* non-zero: EXT_materials_specular_edge_color (draft):
                                        specular_color tints the whole of a dielectric's reflection,
                                        and that of metals at 82 degrees */

    /* KHR_materials_coat (draft): what it has beyond the clearcoat */
    float coat_ior;                      /* default 1.5; 0 as for ior */
    float coat_color[3];                 /* of light that has crossed it twice; default 1 1 1 */
    ppm_texture coat_color_texture;      /* RGB */
    float coat_darkening;                /* of what lies below, by light that is reflected to and
                                            fro; 0..1; default 0, the extension's is 1 */
    float coat_anisotropy;               /* strength, 0..1; default 0 */
    float coat_anisotropy_rotation_rad;  /* as anisotropy_rotation_rad */
    ppm_texture coat_anisotropy_texture; /* RG direction in -1..1, B strength */
    uint32_t emission_is_above_coat;     /* non-zero: the coat does not dim emission; default 0 */

    float fuzz;               /* KHR_materials_fuzz (draft): the share of the surface that fibres
                                 cover, 0..1; default 0. Above 0, sheen_color is their colour alone
                                 and they lie above the coat */
    ppm_texture fuzz_texture; /* R */
} ppm_material_desc;

/* Fills in the defaults and size. */
PPM_API void ppm_material_desc_init(ppm_material_desc *desc);

/* Returns OK, INVALID_ARGUMENT (a value that is not finite or out of range, an unknown image),
 * OUT_OF_MEMORY, WRONG_STATE. */
PPM_API ppm_status ppm_scene_add_material(ppm_scene *scene, const ppm_material_desc *desc,
                                          ppm_material_id *out_id);

/* ---- meshes and instances -------------------------------------------------------------------- */

enum { PPM_MAX_UV_SETS = 8 };

enum {
    PPM_PRIMITIVE_TRIANGLES = 0,
    PPM_PRIMITIVE_POINTS = 1, /* balls of radius_m */
    PPM_PRIMITIVE_LINES = 2   /* round segments of radius_m */
};
enum { PPM_MAX_MOTION_STEPS = 129 };

/* One indexed list of triangles, points or segments with one material.
 *
 * Motion: with motion_steps > 1, positions, normals and tangents each hold that many blocks of
 * vertex_count elements, one after the other: the vertices at even times from the opening of the
 * shutter to its closing, between which they move on straight lines. */
typedef struct ppm_primitive_desc {
    uint32_t vertex_count;
    uint32_t triangle_count;
    const float *positions;            /* 3 * vertex_count, metres, object space */
    const float *normals;              /* 3 * vertex_count, or NULL: flat, from the faces */
    const float *tangents;             /* 4 * vertex_count (xyz, w = bitangent sign), or NULL */
    const float *uvs[PPM_MAX_UV_SETS]; /* 2 * vertex_count each, v down, or NULL */
    const float *colors;               /* 4 * vertex_count linear Rec.709 + alpha, or NULL */
    const uint32_t *indices;           /* 3 * triangle_count, each < vertex_count,
                                          counter-clockwise from outside */
    ppm_material_id material;          /* 0: a grey default */
    uint32_t motion_steps;             /* 0 and 1: at rest; up to PPM_MAX_MOTION_STEPS */
    int32_t kind;                      /* PPM_PRIMITIVE_; for all but triangles triangle_count is 0
                                          and indices has element_count entries (points) or
                                          2 * element_count (lines) */
    uint32_t element_count;
    float radius_m; /* of points and lines, object space, > 0 */
} ppm_primitive_desc;

typedef struct ppm_mesh_desc {
    uint32_t size;    /* sizeof(ppm_mesh_desc) */
    const char *name; /* may be NULL */
    uint32_t primitive_count;
    const ppm_primitive_desc *primitives;
    /* Called once for each array of the primitives as soon as it has been copied, if not NULL, so
     * that the caller can free it: a large mesh is then never in memory twice as a whole. After a
     * failure only those that it was called for have been copied. An array that is given twice must
     * not be freed at the first call. */
    void (*release)(void *user, const void *array);
    void *release_user;
} ppm_mesh_desc;

/* Adds a mesh. Triangles with a position that is not finite, and those of no area, are dropped and
 * counted in a warning; normals that are not finite or zero are replaced by the face's.
 * Returns OK, INVALID_ARGUMENT (an index out of range, sizes that overflow), OUT_OF_MEMORY,
 * WRONG_STATE. The id is valid until ppm_scene_destroy; *out_id is untouched on failure. */
PPM_API ppm_status ppm_scene_add_mesh(ppm_scene *scene, const ppm_mesh_desc *desc,
                                      ppm_mesh_id *out_id);

typedef struct ppm_instance_desc {
    uint32_t size;    /* sizeof(ppm_instance_desc) */
    const char *name; /* may be NULL */
    ppm_mesh_id mesh;
    float transform[16];     /* mirrored ones (negative determinant) are fine */
    uint32_t motion_steps;   /* 0 and 1: at rest; up to PPM_MAX_MOTION_STEPS */
    const float *motion;     /* 16 * motion_steps, in place of transform: at even times from the
                                opening of the shutter to its closing; or NULL */
    const char *asset;       /* name of the thing that it is a part of (Cryptomatte's asset); NULL:
                                its own name */
    const char *light_group; /* of what its emissive surfaces shine; NULL or "": none is given */
    uint32_t is_catcher;     /* non-zero: as ppm_scene_set_instance_catcher */
} ppm_instance_desc;

/* Where the point 0 of all that is added lies in the coordinates of the file that it comes from: of
 * a georeferenced site, whose coordinates single precision would round to a coarse grid. Importers
 * set it by themselves; the position layer and setup files count from the file's point 0. 0 0 0 by
 * default. Set returns OK, INVALID_ARGUMENT (not finite), WRONG_STATE (something has been added
 * that has a place). */
PPM_API ppm_status ppm_scene_set_origin(ppm_scene *scene, const double origin_m[3]);
PPM_API void ppm_scene_get_origin(const ppm_scene *scene, double out_origin_m[3]);

/* Returns OK, INVALID_ARGUMENT (unknown mesh, a transform that is not finite), OUT_OF_MEMORY,
 * WRONG_STATE. A singular transform is dropped with a warning; *out_id is then 0. */
PPM_API ppm_status ppm_scene_add_instance(ppm_scene *scene, const ppm_instance_desc *desc,
                                          ppm_instance_id *out_id);

/* Turns what is closed, of a solid material (PPM_TRANSMISSION_SOLID), wound inside out and not
 * inside of another solid, with all that is inside of it: in a mesh whose vertices or materials are
 * new since the last call. Open surfaces stay: their outside is where the winding says. A render
 * session does this when it is created; importers do, to tell of it. *out_meshes: how many meshes
 * have been turned, whole or in parts. Returns OK, INVALID_ARGUMENT, WRONG_STATE, OUT_OF_MEMORY. */
PPM_API ppm_status ppm_scene_turn_solids(ppm_scene *scene, uint32_t *out_meshes);

/* ---- changes between frames ------------------------------------------------------------------ */

/* What follows changes what has been added, between two renders: it returns WRONG_STATE while a
 * render session of the scene is alive, INVALID_ARGUMENT for an unknown id or a value that adding
 * would refuse, and OUT_OF_MEMORY; a call that fails changes nothing. Names stay as they were. What
 * does not change keeps its acceleration structure for the next session. */

/* A new transform, or motion, as in ppm_instance_desc; of desc nothing else is used. While its
 * transform is singular (at all motion steps) the instance is not there: give one that is not to
 * ppm_scene_add_instance, which drops such instances, where they are to appear later. */
PPM_API ppm_status ppm_scene_set_instance(ppm_scene *scene, ppm_instance_id id,
                                          const ppm_instance_desc *desc);
/* Whether the instance is there at all: for rays, light and bounds; it is when added. */
PPM_API ppm_status ppm_scene_set_instance_visible(ppm_scene *scene, ppm_instance_id id,
                                                  uint32_t is_visible);
/* Catchers stand for things that are in a photograph: the picture shows only the light that all
 * else adds to them and takes from them (ppm_render_set_plate, docs/compositing.md). */
PPM_API ppm_status ppm_scene_set_instance_catcher(ppm_scene *scene, ppm_instance_id id,
                                                  uint32_t is_catcher);
/* Catchers that are visible. */
PPM_API uint32_t ppm_scene_catcher_count(const ppm_scene *scene);
/* Non-zero: of all instances only catchers and those that shine are there, until it is called with
 * 0. All light is thus that of the photograph. */
PPM_API ppm_status ppm_scene_show_catchers_alone(ppm_scene *scene, uint32_t is_alone);
/* New vertices of one primitive: positions, normals, tangents and motion_steps of desc, and those
 * of its colors and uvs that are not NULL and that the primitive has had; its vertex_count must be
 * what it was, all else is not used. */
PPM_API ppm_status ppm_scene_set_mesh_vertices(ppm_scene *scene, ppm_mesh_id id, uint32_t primitive,
                                               const ppm_primitive_desc *desc);
PPM_API ppm_status ppm_scene_set_material(ppm_scene *scene, ppm_material_id id,
                                          const ppm_material_desc *desc);

PPM_API uint32_t ppm_scene_instance_count(const ppm_scene *scene);
/* The name of an instance, never NULL for a valid id; NULL otherwise. Several may have the same.
 * Valid until destroy. */
PPM_API const char *ppm_scene_instance_name(const ppm_scene *scene, ppm_instance_id id);
/* The box around an instance over all of its motion, world space, whether it is visible or not.
 * Returns OK, INVALID_ARGUMENT (no such instance, or one without triangles, points or lines). */
PPM_API ppm_status ppm_scene_instance_bounds(const ppm_scene *scene, ppm_instance_id id,
                                             float out_min[3], float out_max[3]);

/* ---- cameras --------------------------------------------------------------------------------- */

enum { PPM_CAMERA_PERSPECTIVE = 0, PPM_CAMERA_ORTHOGRAPHIC = 1 };

/* Looks along its local -Z, +Y up. Scale in the transform is ignored. */
typedef struct ppm_camera_desc {
    uint32_t size; /* sizeof(ppm_camera_desc) */
    const char *name;
    int32_t kind;
    float transform[16];
    float y_fov_rad;        /* perspective: full vertical angle, 0 < a < pi */
    float half_width_m;     /* orthographic: half of the seen width */
    float half_height_m;    /* orthographic: half of the seen height */
    float aspect;           /* width / height that the file asks for; 0: not said */
    float f_number;         /* perspective: focal length by aperture, for a sensor whose longer side
                               is 36 mm; 0: a pinhole, all in focus */
    float focus_distance_m; /* along the axis; 0: not said */
    uint32_t motion_steps;  /* as in ppm_instance_desc */
    const float *motion;
    float shift[2]; /* moves the picture to the right and up in its plane, by so many of its
                       heights, as a shift lens does: -100 .. 100 */
    float near_m;   /* along the axis: the camera itself sees nothing that is nearer, mirrors and
                       shadows do; 0: all */
    float far_m;    /* nor further; 0: without end; above near_m */
} ppm_camera_desc;

PPM_API ppm_status ppm_scene_add_camera(ppm_scene *scene, const ppm_camera_desc *desc,
                                        ppm_camera_id *out_id);
PPM_API uint32_t ppm_scene_camera_count(const ppm_scene *scene);
/* The name of a camera, never NULL for a valid id; NULL otherwise. Valid until destroy. */
PPM_API const char *ppm_scene_camera_name(const ppm_scene *scene, ppm_camera_id id);
/* Where a camera stands and how it is turned, in motion at the opening of the shutter: its
 * transform without scale. Returns OK, INVALID_ARGUMENT. */
PPM_API ppm_status ppm_scene_camera_transform(const ppm_scene *scene, ppm_camera_id id,
                                              float out_transform[16]);
/* Adds a camera that shows the whole scene from a three-quarter view (from the right, the front
 * and above), for the given aspect (width / height): all that is visible; where nothing is, all
 * that is hidden; in a scene without instances a cube of 2 m around the origin. */
PPM_API ppm_status ppm_scene_add_framing_camera(ppm_scene *scene, float aspect,
                                                ppm_camera_id *out_id);
/* Replaces a camera, as the calls under "changes between frames" do. */
PPM_API ppm_status ppm_scene_set_camera(ppm_scene *scene, ppm_camera_id id,
                                        const ppm_camera_desc *desc);
/* The aspect that a camera's file asks for, or 0. */
PPM_API float ppm_scene_camera_aspect(const ppm_scene *scene, ppm_camera_id id);

/* ---- lights ---------------------------------------------------------------------------------- */

/* How a lamp's intensity goes with direction: a table by two angles, as IES files hold it. The
 * polar angle is counted from the light's local -Z; the azimuth from +X towards +Y. Between the
 * entries the values are linear in the angles, beyond the last polar angle they are 0. */
typedef struct ppm_light_profile_desc {
    uint32_t size;    /* sizeof(ppm_light_profile_desc) */
    const char *name; /* may be NULL */
    uint32_t polar_count;
    uint32_t azimuth_count;
    const float *polar_rad;   /* polar_count rising angles within 0 .. pi, at least one */
    const float *azimuth_rad; /* azimuth_count rising angles from 0: one (the same all around), up
                                 to pi/2 (both planes mirror), up to pi (the XZ plane mirrors) or up
                                 to 2 pi (all around) */
    const float *candela;     /* azimuth_count rows of polar_count values, at least 0 */
} ppm_light_profile_desc;

/* Returns OK, INVALID_ARGUMENT, OUT_OF_MEMORY, WRONG_STATE. */
PPM_API ppm_status ppm_scene_add_light_profile(ppm_scene *scene, const ppm_light_profile_desc *desc,
                                               ppm_light_profile_id *out_id);

enum {
    PPM_LIGHT_POINT = 0,
    PPM_LIGHT_SPOT = 1,
    PPM_LIGHT_DIRECTIONAL = 2,
    PPM_LIGHT_RECTANGLE = 3,
    PPM_LIGHT_DISK = 4 /* or an ellipse */
};

/* Shines along its local -Z (spot, directional, rectangle, disk). Scale in the transform is
 * ignored.
 *
 * A light with an extent (a point or spot with a radius, a rectangle, a disk) can be seen, in
 * mirrors and through glass too, casts soft shadows, and stops no ray: what lies behind it is seen
 * through it, with its light added. */
typedef struct ppm_light_desc {
    uint32_t size; /* sizeof(ppm_light_desc) */
    const char *name;
    int32_t kind;
    float transform[16];
    float intensity[3];       /* linear Rec.709: candela (point, spot), lux (directional) or nit
                                 (rectangle, disk); with a profile a factor on it */
    float inner_cone_rad;     /* spot: half angle of full intensity */
    float outer_cone_rad;     /* spot: half angle where it ends, <= pi/2 */
    float angular_radius_rad; /* directional: the light comes from a disk in the sky of this radius
                                 and of even radiance, which can be seen; < pi/2. Less than 1e-4 is
                                 taken as 0: parallel light */
    float radius_m;     /* point, spot: of a ball that sends the same intensity in each direction,
                           evenly from all over its outline; below 1e-6 it is a point */
    float width_m;      /* rectangle, disk: along the local X, > 0 */
    float height_m;     /* rectangle, disk: along the local Y, > 0 */
    uint32_t is_hidden; /* non-zero: the camera does not see the light straight ahead, only mirrors
                           and glass do */
    ppm_light_profile_id profile; /* point, spot: times the intensity; 0: none */
    const char *light_group;      /* NULL or "": none is given */
} ppm_light_desc;

PPM_API ppm_status ppm_scene_add_light(ppm_scene *scene, const ppm_light_desc *desc,
                                       ppm_light_id *out_id);

/* Replaces a light, its group too, as the calls under "changes between frames" do. */
PPM_API ppm_status ppm_scene_set_light(ppm_scene *scene, ppm_light_id id,
                                       const ppm_light_desc *desc);

/* The surroundings: a radiance for every direction. */
typedef struct ppm_environment_desc {
    uint32_t size;         /* sizeof(ppm_environment_desc) */
    float radiance[3];     /* nit, linear Rec.709; multiplies the image if there is one */
    ppm_image_id image;    /* latitude-longitude, row 0 is up (+Y), the middle column is -Z; or 0 */
    float rotation_rad;    /* turns the image about +Y, counter-clockwise seen from above */
    uint32_t has_backdrop; /* non-zero: backdrop applies */
    float backdrop[3];     /* nit, linear Rec.709 */
    const char *light_group; /* NULL or "": none is given */
} ppm_environment_desc;

/* Sets or replaces the environment, its group too. Without one it is black.
 * The backdrop replaces what the camera sees straight ahead, and nothing else: light, reflections
 * and refractions are those of the environment. */
PPM_API ppm_status ppm_scene_set_environment(ppm_scene *scene, const ppm_environment_desc *desc);

/* Surroundings as the six sides of a cube, each a picture of its side as one sees it from inside.
 */
typedef struct ppm_cube_environment_desc {
    uint32_t size;         /* sizeof(ppm_cube_environment_desc) */
    ppm_image_id faces[6]; /* square, towards +X -X +Y -Y +Z -Z. Up in the picture is +Y, in that of
                              +Y it is -Z, in that of -Y +Z */
    uint32_t is_rgbd;      /* non-zero: colours of 8-bit images with alpha are divided by it */
    float radiance[3];     /* nit, linear Rec.709; multiplies the images */
    float rotation[4];     /* turns the cube: a quaternion x y z w of any length; all 0: none */
    uint32_t is_mirrored;  /* non-zero: each face is mirrored left to right, as Vulkan and OpenGL
                              sample cubes by directions of a right-handed world */
} ppm_cube_environment_desc;

/* Sets the environment to a latitude-longitude image made of the cube, with the backdrop that it
 * had. Returns OK, INVALID_ARGUMENT, OUT_OF_MEMORY, WRONG_STATE. */
PPM_API ppm_status ppm_scene_set_cube_environment(ppm_scene *scene,
                                                  const ppm_cube_environment_desc *desc);

/* A clear sky with its sun (Preetham, Shirley, Smits 1999), in nit and lux. Fill with
 * ppm_sun_sky_desc_init first. */
typedef struct ppm_sun_sky_desc {
    uint32_t size;       /* sizeof(ppm_sun_sky_desc) */
    float elevation_rad; /* of the sun above the horizon, 0 .. pi/2; default pi/4 */
    float azimuth_rad; /* clockwise seen from above, from north (-Z) by east (+X); default 3/4 pi */
    float turbidity;   /* 2 (very clear) .. 10 (hazy); default 3 */
    float factor;      /* on the light of sun and sky, 0 .. 1e9; default 1 */
    float ground_albedo; /* below the horizon the sky's image shows level ground in this light;
                            0 .. 1; default 0.2 */
    uint32_t sun_only;   /* non-zero: the environment stays as it is; default 0 */
} ppm_sun_sky_desc;

/* Fills in the defaults and size. */
PPM_API void ppm_sun_sky_desc_init(ppm_sun_sky_desc *desc);

/* Sets the environment to the sky, a generated image, with the backdrop that it had; and adds the
 * sun, a directional light of angular radius 0.2665 degrees. out_sun may be NULL.
 * Returns OK, INVALID_ARGUMENT, OUT_OF_MEMORY, WRONG_STATE. */
PPM_API ppm_status ppm_scene_add_sun_sky(ppm_scene *scene, const ppm_sun_sky_desc *desc,
                                         ppm_light_id *out_sun);

/* ---- fog ------------------------------------------------------------------------------------- */

/* A homogeneous medium in the ball around everything in the scene that has a surface, outside of
 * solids. */
typedef struct ppm_fog_desc {
    uint32_t size; /* sizeof(ppm_fog_desc) */
    float
        sigma_s[3];    /* scattering coefficient, 1/m, by linear Rec.709 channel; in another working
                          space those that leave and scatter the same colours after a mean free path */
    float sigma_a[3];  /* absorption coefficient, 1/m */
    float asymmetry_g; /* Henyey-Greenstein's mean cosine, -1 < g < 1; above 0 scatters forwards */
} ppm_fog_desc;

/* Sets or replaces the fog; all coefficients 0 takes it away. Returns OK, INVALID_ARGUMENT,
 * WRONG_STATE. */
PPM_API ppm_status ppm_scene_set_fog(ppm_scene *scene, const ppm_fog_desc *desc);

/* ---- facts ----------------------------------------------------------------------------------- */

typedef struct ppm_scene_info {
    uint32_t size;      /* sizeof(ppm_scene_info), set by the caller */
    uint64_t triangles; /* of all meshes, each mesh once */
    uint64_t instances;
    uint64_t meshes;
    uint64_t materials;
    uint64_t textures; /* images */
    uint64_t lights;   /* punctual lights, emissive triangles, points and lines that are visible,
                          and 1 for an environment */
    uint64_t cameras;
    uint32_t has_light;  /* non-zero when anything is meant to shine, be it off or hidden now */
    float bounds_min[3]; /* of all instances, world space; min > max when there are none */
    float bounds_max[3];
} ppm_scene_info;

PPM_API ppm_status ppm_scene_get_info(const ppm_scene *scene, ppm_scene_info *out_info);

/* ---- what has been added, read back ---------------------------------------------------------- */

PPM_API uint32_t ppm_scene_material_count(const ppm_scene *scene);
/* A material as it is now, for ppm_scene_set_material; desc->name is the material's, never NULL,
 * valid until destroy. desc->size is set by the caller. Returns OK, INVALID_ARGUMENT. */
PPM_API ppm_status ppm_scene_get_material(const ppm_scene *scene, ppm_material_id id,
                                          ppm_material_desc *desc);
/* The mesh that an instance shows; 0 for an unknown id. */
PPM_API ppm_mesh_id ppm_scene_instance_mesh(const ppm_scene *scene, ppm_instance_id id);
PPM_API uint32_t ppm_scene_primitive_count(const ppm_scene *scene, ppm_mesh_id id);
/* The material of one primitive of a mesh; 0 for unknown ones. */
PPM_API ppm_material_id ppm_scene_primitive_material(const ppm_scene *scene, ppm_mesh_id id,
                                                     uint32_t primitive);
/* Gives a primitive another material, in all instances of its mesh, as the calls under "changes
 * between frames" do. */
PPM_API ppm_status ppm_scene_set_primitive_material(ppm_scene *scene, ppm_mesh_id id,
                                                    uint32_t primitive, ppm_material_id material);
/* The environment as it is now; all 0 but size where none is set. desc->size is set by the caller.
 * Returns OK, INVALID_ARGUMENT. */
PPM_API ppm_status ppm_scene_get_environment(const ppm_scene *scene, ppm_environment_desc *desc);

#ifdef __cplusplus
}
#endif

#endif
