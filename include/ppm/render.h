/* Rendering: a session that a host drives pass by pass.
 *
 *     ppm_render_create(scene, &options, &render);
 *     while (ppm_render_advance(render) == PPM_STATUS_OK && !enough)
 *         show(render);                  // ppm_render_read_image
 *     ppm_render_destroy(render);
 *
 * After every pass the whole picture is there; every further pass improves it. */
#ifndef PPM_RENDER_H
#define PPM_RENDER_H

#include "ppm/scene.h"

#ifdef __cplusplus
extern "C" {
#endif

typedef struct ppm_render ppm_render;

enum {
    PPM_INTEGRATOR_DEFAULT = 0, /* SPPM */
    PPM_INTEGRATOR_SPPM = 1,    /* stochastic progressive photon mapping (Hachisuka, Jensen 2009) */
    PPM_INTEGRATOR_PATH = 2,    /* unidirectional path tracer with light sampling, the yardstick */
    PPM_INTEGRATOR_PPM = 3      /* progressive photon mapping (Hachisuka, Ogaki, Jensen 2008) */
};

/* How the gather radius shrinks. */
enum {
    PPM_SCHEDULE_DEFAULT = 0,     /* PROGRESSIVE */
    PPM_SCHEDULE_PROGRESSIVE = 1, /* by the photons that were found (Hachisuka et al. 2008) */
    PPM_SCHEDULE_MEMORYLESS = 2   /* by the number of the pass alone (Knaus, Zwicker 2011); SPPM */
};

/* Where light comes from that meets a surface or the fog straight from a lamp. */
enum {
    PPM_DIRECT_DEFAULT = 0, /* SAMPLE */
    PPM_DIRECT_SAMPLE = 1,  /* light sampling at the eye's vertices */
    PPM_DIRECT_PHOTONS = 2  /* photons, as all other light */
};

/* Where photons are sent. */
enum {
    PPM_AIM_DEFAULT = 0, /* LEARNT */
    PPM_AIM_LEARNT = 1,  /* mostly to where they matter for the picture */
    PPM_AIM_EVEN = 2     /* by power alone, towards the scene */
};

/* What a pixel averages over. Widths are full widths, in pixels. */
enum {
    PPM_PIXEL_FILTER_DEFAULT = 0,        /* BLACKMAN_HARRIS */
    PPM_PIXEL_FILTER_BOX = 1,            /* default width 1 */
    PPM_PIXEL_FILTER_GAUSSIAN = 2,       /* standard deviation width / 6, cut off; default 3 */
    PPM_PIXEL_FILTER_BLACKMAN_HARRIS = 3 /* default 3, which Blender's Cycles calls 1.5 */
};

/* ---- layers ---------------------------------------------------------------------------------- */

/* What a session can keep beside the picture, as bits PPM_LAYER_BIT(kind) of the option layers.
 * docs/compositing.md says what each holds.
 *
 * The light layers DIFFUSE_DIRECT .. VOLUME part the picture: they add up to it, and so do the
 * light groups among themselves. Light that the camera sees straight, or through alpha, is EMISSION
 * or ENVIRONMENT. Light that met specular surfaces after it left its lamp and before its first
 * diffuse one is CAUSTICS, wherever it goes on; specular are mirrors, smooth glass and all else too
 * narrow for photons to be gathered. All other light is of the class of what the camera sees it on:
 * VOLUME in fog, TRANSMISSION through a surface (a cloudy solid's too), DIFFUSE or GLOSSY by its
 * reflection, DIRECT where it comes there straight from the lamp.
 *
 * VARIANCE is an estimate, from the differences between passes: of the square of the standard
 * deviation of each channel, 0 after the first pass. It does not know that passes are spread evenly
 * (path: it is rather too large), nor that radii are still too large (SPPM), nor of what the eye
 * paths of an epoch miss (PPM). PHOTON_DENSITY is of surfaces; it and RADIUS are 0 of PATH.
 *
 * DENOISED is RGBA like COMBINED: each light layer but EMISSION and ENVIRONMENT is filtered by its
 * variance, with albedo, normal and depth as guides, which the session keeps for it. It needs two
 * passes: after one it is the picture as it is, with a warning in the log. */
enum {
    PPM_LAYER_COMBINED = 0, /* the picture; always there */
    PPM_LAYER_DIFFUSE_DIRECT = 1,
    PPM_LAYER_DIFFUSE_INDIRECT = 2,
    PPM_LAYER_GLOSSY_DIRECT = 3,
    PPM_LAYER_GLOSSY_INDIRECT = 4,
    PPM_LAYER_TRANSMISSION = 5,
    PPM_LAYER_EMISSION = 6,     /* lamps and shining surfaces, seen straight */
    PPM_LAYER_ENVIRONMENT = 7,  /* seen straight */
    PPM_LAYER_CAUSTICS = 8,     /* light that met specular surfaces before its first diffuse one */
    PPM_LAYER_VOLUME = 9,       /* light that is seen on fog */
    PPM_LAYER_LIGHT_GROUP = 10, /* one layer for each group of lights */
    PPM_LAYER_GROUP_CAUSTICS = 11, /* and the part of CAUSTICS that is its own */

    PPM_LAYER_VARIANCE = 12,       /* of the picture's mean over the passes */
    PPM_LAYER_PHOTON_DENSITY = 13, /* photons gathered by area, 1/m2; SPPM and PPM */
    PPM_LAYER_RADIUS = 14,         /* of the latest gathering, metres; SPPM and PPM */

    PPM_LAYER_ALBEDO = 15,
    PPM_LAYER_NORMAL = 16,
    PPM_LAYER_POSITION = 17, /* metres, world space */
    PPM_LAYER_DEPTH = 18,    /* metres along the camera's axis */
    PPM_LAYER_UV = 19,
    PPM_LAYER_OBJECT_INDEX = 20,   /* ppm_instance_id */
    PPM_LAYER_MATERIAL_INDEX = 21, /* ppm_material_id */
    PPM_LAYER_MOTION = 22,         /* pixels */
    PPM_LAYER_CRYPTO_OBJECT = 23,  /* Cryptomatte 1.2, ranked ids and coverage */
    PPM_LAYER_CRYPTO_MATERIAL = 24,
    PPM_LAYER_CRYPTO_ASSET = 25,
    PPM_LAYER_LIGHT_VARIANCE = 26, /* as VARIANCE, of DIFFUSE_DIRECT .. VOLUME: a layer for each */
    PPM_LAYER_CATCHER = 27,        /* catchers with all light on them; alpha is their coverage */
    PPM_LAYER_DENOISED = 28,       /* the picture, of which the noise is filtered when it is read */
    PPM_LAYER_KINDS = 29
};
#define PPM_LAYER_BIT(kind) (UINT64_C(1) << (kind))

/* Which lights make a group. */
enum {
    PPM_LIGHT_GROUPS_DEFAULT = 0, /* GIVEN */
    PPM_LIGHT_GROUPS_GIVEN = 1,   /* as the scene's light_group fields say; all other light is the
                                     group "rest" */
    PPM_LIGHT_GROUPS_NAMED = 2    /* every light without a given group is one of its own, by name */
};

/* 0 in any field means its default. */
typedef struct ppm_render_options {
    uint32_t size;      /* sizeof(ppm_render_options) */
    int32_t integrator; /* PPM_INTEGRATOR_ */
    uint32_t width;     /* pixels; default 1280 */
    uint32_t height;    /* pixels; default from width and the camera's aspect (16:9 if not said) */
    uint64_t photons_per_pass; /* default: the number of pixels, within 2^18 .. 2^22; SPPM sends
                                  fewer where aiming keeps as many of them */
    uint32_t max_depth;        /* bounces of a path; default 4096: roulette ends paths before */
    float radius_m;            /* first gather radius; default: from each pixel's footprint */
    float alpha;               /* share of new photons that is kept, 0 < alpha <= 1; default 2/3 */
    uint64_t seed;             /* default 0 is a seed like any other */
    uint32_t threads;          /* default: all processors that the process may use */
    ppm_camera_id camera;      /* default: the first; a scene without one is framed */

    int32_t schedule;           /* PPM_SCHEDULE_ */
    int32_t direct;             /* PPM_DIRECT_; SPPM and PPM */
    int32_t aim;                /* PPM_AIM_; SPPM and PPM */
    uint64_t photons_per_epoch; /* PPM: after so many photons, in whole passes, new eye paths and
                                   statistics; the epochs are averaged. 0: one endless epoch */
    int32_t split_depth;        /* SPPM and PPM: surfaces at which an eye path follows all its
                                   branches; default 4; negative: none, they are drawn at random */

    float aperture_f_number; /* default: the camera's own; infinite: a pinhole; else at least 0.001.
                                An orthographic camera has none: resolved to infinite */
    float focus_distance_m;  /* along the axis; default: the camera's own. With an aperture and no
                                distance of either, the session focuses on what is in the middle of
                                the whole picture; ppm_render_get_options has the distance */
    float shutter_open;      /* frames, relative to the one that is rendered; */
    float shutter_close;     /* not before open; both the same: a moment */
    uint32_t crop[4];        /* x0, y0, x1, y1 in pixels of the whole picture, the upper bounds
                                excluded; all 0: the whole picture */
    int32_t pixel_filter;    /* PPM_PIXEL_FILTER_ */
    float pixel_filter_width; /* pixels, 0.001 .. 100; default: the filter's own */

    uint64_t layers;            /* PPM_LAYER_BIT of each kind that is wanted beside the picture */
    int32_t light_groups;       /* PPM_LIGHT_GROUPS_ */
    uint32_t is_transparent;    /* non-zero: what the camera sees of the environment straight is
                                   transparent: left out of the picture and its layers, with alpha
                                   premultiplied; else alpha is 1 */
    uint32_t normals_of_camera; /* non-zero: normals in the camera's space; else the world's */
    uint32_t follows_specular;  /* non-zero: albedo and normal are of what is seen in mirrors and
                                   through glass */
    uint32_t cryptomatte_ranks; /* ids a pixel can hold, even, at most 32; default 6 */
    uint32_t denoise;           /* non-zero: layers gets PPM_LAYER_DENOISED, and ppm_render_write
                                   shows it in files for display. PPM_LAYER_COMBINED and
                                   ppm_render_read_image are not changed */
} ppm_render_options;

/* The options in effect: defaults filled in for this scene. Returns INVALID_ARGUMENT for values
 * out of range, naming them. Does not change the scene. */
PPM_API ppm_status ppm_render_options_resolve(const ppm_scene *scene,
                                              const ppm_render_options *options,
                                              ppm_render_options *out_resolved);

/* Makes a session: freezes the scene, builds acceleration structures and light tables, allocates
 * the film. The scene must outlive the session. options may be NULL.
 * A scene without a camera gets ppm_scene_add_framing_camera, one without any light a uniform
 * environment of 1 nit with a grey backdrop until the session ends; both are logged (INFO). Several
 * sessions may share a frozen scene; one thread at a time makes and destroys those of a scene.
 * A scene in which nothing is visible gives a picture of its surroundings, with alpha 0; only one
 * without instances, cameras and lights is refused.
 * Returns OK, INVALID_ARGUMENT (also: nothing to focus on), WRONG_STATE (nothing to render),
 * OUT_OF_MEMORY. */
PPM_API ppm_status ppm_render_create(ppm_scene *scene, const ppm_render_options *options,
                                     ppm_render **out_render);
PPM_API void ppm_render_destroy(ppm_render *render);

/* Renders one pass on the session's threads and returns when it is done. A cancelled pass leaves
 * the picture as it was before the pass. Returns OK, CANCELLED, OUT_OF_MEMORY.
 * Threads: one caller at a time. Result: the same bits for the same scene, options and seed, with
 * any number of threads. */
PPM_API ppm_status ppm_render_advance(ppm_render *render);

/* Makes the running and every later ppm_render_advance return CANCELLED soon (some milliseconds).
 * Any thread; also from a signal handler. */
PPM_API void ppm_render_cancel(ppm_render *render);

/* The options in effect. Valid until ppm_render_destroy. */
PPM_API const ppm_render_options *ppm_render_get_options(const ppm_render *render);

/* What became of the photons of one light, in the last round of learning where to send them. */
typedef struct ppm_light_use {
    const char *name;  /* of a lamp, or of the instance that shines; "environment" */
    double sent_share; /* of all photons */
    double used_share; /* of those that it sent: the picture has light of them */
} ppm_light_use;

typedef struct ppm_render_stats {
    uint32_t size;            /* sizeof(ppm_render_stats), set by the caller */
    uint64_t passes;          /* finished */
    uint64_t photons_emitted; /* in finished passes */
    uint64_t photons_stored;  /* photon vertices kept for gathering */
    uint64_t eye_paths;
    uint64_t rays;         /* of all kinds that were traced */
    double seconds_build;  /* acceleration structures and light tables */
    double seconds_render; /* sum over passes */
    double seconds_eye;    /* its parts */
    double seconds_photons;
    double seconds_gather;
    uint32_t threads;
    double photons_used_share; /* photons that the picture has light of, of those that are sent, by
                                  the last round of learning; below 0: nothing is learnt */
    const ppm_light_use *light_uses; /* of the lights that send photons; until the session ends */
    uint32_t light_use_count;
} ppm_render_stats;

/* Not while another thread is in ppm_render_advance. */
PPM_API ppm_status ppm_render_get_stats(const ppm_render *render, ppm_render_stats *out_stats);

/* Gives the session what its catchers look like alone: the layer PPM_LAYER_CATCHER of a session of
 * the same camera, focus, size and crop, made while ppm_scene_show_catchers_alone was in effect.
 * From then on, of what the camera sees of catchers, the picture holds what light all else adds,
 * with alpha for what it takes away: over the plate the picture is what it would be without this
 * call, over a photograph of the same things it is the photograph with all else in it. The copied
 * values are value_count = 4 * width * height floats. Layers stay as they are. Returns OK,
 * INVALID_ARGUMENT, WRONG_STATE (no catcher in the scene), OUT_OF_MEMORY. */
PPM_API ppm_status ppm_render_set_plate(ppm_render *render, const float *rgba, size_t value_count);

/* Copies the picture so far: 4 * width * height floats (with a crop, of its pixels only), RGBA, row
 * 0 on top, in the working space of the scene's colour (scene-linear), alpha premultiplied.
 * rgba_count is the number of floats in rgba. Not while another thread is in ppm_render_advance.
 * Returns OK, INVALID_ARGUMENT, WRONG_STATE (no finished pass). */
PPM_API ppm_status ppm_render_read_image(const ppm_render *render, float *rgba, size_t rgba_count);

/* What layers of a kind are called: "combined", "caustics"; those of light groups "light" and
 * "caustics", before the group's name. NULL for a number that is no kind. Static. */
PPM_API const char *ppm_layer_kind_name(int32_t kind);

/* A layer of the session: a picture of its own, of 1 to 4 channels. */
typedef struct ppm_layer_info {
    uint32_t size;                /* sizeof(ppm_layer_info), set by the caller */
    int32_t kind;                 /* PPM_LAYER_ */
    const char *name;             /* "caustics", "CryptoObject00"; of one light group
                                     "light.NAME" and "caustics.NAME". Unique in the session */
    uint32_t channel_count;       /* 1..4 */
    const char *channel_names[4]; /* "R", "G", "B", "A"; "X", "Y", "Z"; "Z"; "U", "V" */
    uint32_t is_exact;            /* non-zero: half floats would spoil it (ids, distances) */
} ppm_layer_info;

/* The layers of the session: combined first, then by kind. Strings are valid until
 * ppm_render_destroy. */
PPM_API uint32_t ppm_render_layer_count(const ppm_render *render);
/* index counts from 0. Returns OK, INVALID_ARGUMENT. */
PPM_API ppm_status ppm_render_get_layer(const ppm_render *render, uint32_t index,
                                        ppm_layer_info *out_info);
/* Copies a layer so far: channel_count * width * height floats as ppm_render_read_image does
 * (value_count is their number). Not while another thread is in ppm_render_advance. Returns OK,
 * INVALID_ARGUMENT, WRONG_STATE (no finished pass). */
PPM_API ppm_status ppm_render_read_layer(const ppm_render *render, uint32_t index, float *values,
                                         size_t value_count);

/* The names that the ids of a Cryptomatte layer stand for, as its manifest,
 * {"name":"1a2b3c4d",...}: each name once, those of what is visible in the scene, in the order of
 * their bytes; the digits are the bits of the id. kind: PPM_LAYER_CRYPTO_. *out_json is valid until
 * ppm_render_destroy. Returns OK, INVALID_ARGUMENT (no such layer in the session). */
PPM_API ppm_status ppm_render_cryptomatte_manifest(const ppm_render *render, int32_t kind,
                                                   const char **out_json);

/* The key of a Cryptomatte in a file's metadata, "cryptomatte/KEY/name": the first seven
 * hexadecimal digits of the id of the layer's name without its number ("CryptoObject"), and a
 * terminating zero. Any thread. */
PPM_API void ppm_cryptomatte_key(const char *layer_name, char out_key[8]);

#ifdef __cplusplus
}
#endif

#endif
