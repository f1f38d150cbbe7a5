/* The command line of ppm-render, as values that have been checked. */
#ifndef PPM_CLI_OPTIONS_H
#define PPM_CLI_OPTIONS_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>

#include "exit_status.h"
#include "frames.h"
#include "ppm/color.h"
#include "ppm/setup.h"

enum { ACTION_RENDER = 0, ACTION_HELP, ACTION_VERSION, ACTION_LIST_VIEWS, ACTION_LIST };
enum { LIST_NONE = 0, LIST_TABLE, LIST_JSON };
enum { VERBOSITY_QUIET = -1, VERBOSITY_NORMAL = 0, VERBOSITY_VERBOSE = 1 };

typedef struct image_size {
    uint32_t width, height; /* 0: not said */
} image_size;

/* --fog: coefficients by metre, and the mean cosine of scattering. */
typedef struct fog_values {
    double sigma_s, sigma_a, g;
    bool is_given;
} fog_values;
/* What the camera sees straight ahead where nothing is. */
enum { BACKGROUND_UNSAID = 0, BACKGROUND_ENVIRONMENT, BACKGROUND_RADIANCE };
typedef struct background_choice {
    int32_t kind; /* BACKGROUND_ */
    float radiance[3];
} background_choice;

typedef struct sun_choice {
    int32_t is_given;
    double elevation_deg, azimuth_deg;
    double turbidity; /* 0: not said */
} sun_choice;
/* A part of the picture: x0, y0, x1, y1, in pixels, or in shares of the picture's sides. */
typedef struct crop_window {
    bool is_given, is_in_shares;
    double sides[4];
} crop_window;

typedef struct shutter_times {
    double open, close; /* frames */
} shutter_times;

typedef struct filter_choice {
    int32_t kind; /* PPM_PIXEL_FILTER_ */
    double width; /* pixels; 0: not said */
} filter_choice;

/* How an .exr is packed. */
typedef struct packing_choice {
    int32_t kind; /* PPM_COMPRESSION_; 0: not said */
    double level; /* 0: not said */
} packing_choice;

/* The moments that are rendered; a still picture where none is given. */
typedef struct frame_choice {
    bool is_given;
    bool is_range; /* by --frames */
    frame_range range;
} frame_choice;

/* 0 or NULL: not given, unless a comment says otherwise. Strings belong to argv. */
typedef struct cli_options {
    int32_t action;    /* ACTION_ */
    int32_t verbosity; /* VERBOSITY_ */
    const char *input;
    const char **outputs; /* output_count paths; owned */
    size_t output_count;
    const char *stats;
    int32_t skips_existing;

    int32_t list;        /* LIST_ */
    const char *scene;   /* a name, or a number from 1 */
    const char *variant; /* a name */
    int32_t is_strict;
    int32_t allows_outside;
    int32_t has_no_clip;
    const char *setup; /* a path; "none"; NULL: the one beside input, if there is one */

    frame_choice frames;   /* by --frame or --frames */
    double fps;            /* a default has been filled in */
    const char *animation; /* a name; NULL: all */
    uint64_t motion_steps;

    uint64_t passes; /* a default has been filled in unless there is a time */
    double seconds;

    int32_t integrator; /* PPM_INTEGRATOR_ */
    int32_t schedule;   /* PPM_SCHEDULE_ */
    int32_t direct;     /* PPM_DIRECT_ */
    int32_t aim;        /* PPM_AIM_ */
    uint64_t epochs;
    uint64_t photons_per_epoch;
    int32_t split_depth; /* as in ppm_render_options */
    image_size size;
    uint64_t photons;
    double radius_m;
    double alpha;
    uint64_t max_depth;
    uint64_t seed;
    uint64_t threads;

    const char *camera; /* a name, or a number from 1 */
    bool all_cameras;
    double aperture;   /* f-number */
    const char *focus; /* metres, or the name of a node */
    shutter_times shutter;
    crop_window crop;
    filter_choice filter;

    const char *environment;
    double environment_rotation_deg;
    double environment_intensity;
    sun_choice sun;
    background_choice background;
    fog_values fog;
    int32_t light_units;  /* PPM_LIGHT_UNITS_ */
    int32_t transmission; /* PPM_TRANSMISSION_POLICY_ */
    double line_radius_m; /* 0: by their mesh */
    double crease_deg;
    double unit_scale;
    int32_t up;                   /* PPM_UP_ */
    const char **texture_folders; /* room for one per word of argv */
    size_t texture_folder_count;
    const char **catchers; /* room for one per word of argv */
    size_t catcher_count;

    uint64_t layers;      /* PPM_LAYER_BIT of each kind */
    int32_t light_groups; /* PPM_LIGHT_GROUPS_; 0: not said */
    uint64_t cryptomatte_ranks;
    int32_t is_transparent;
    int32_t normals_of_camera;
    int32_t follows_specular;
    int32_t denoises;
    int32_t depth; /* PPM_DEPTH_ */
    packing_choice packing;
    int32_t is_multipart;
    uint32_t tile_side;

    double exposure_ev;
    const char *display;
    const char *view; /* a name, or "auto" */
    bool has_auto_view;
    const char *look;
    double gamma; /* 0: not said */
    const char *ocio;
    const char *working_space;
    ppm_texture_space *texture_spaces; /* texture_space_count; owned, patterns too */
    uint32_t texture_space_count;
    int32_t bits; /* of .png and .tif; 0: not said */
    int32_t has_no_dither;
    uint64_t jpeg_quality; /* 0: not said */
} cli_options;

/* Reads argv. What is wrong is said on standard error. Returns EXIT_DONE, EXIT_USAGE or
 * EXIT_RESOURCES; cli_options_deinit is due in every case. */
int cli_options_parse(int argc, char **argv, cli_options *out_options);

/* The second half, for options that are to render or to list: takes in the render options of a
 * setup file (NULL: none), over which the words of argv win, checks what they mean together and
 * fills in defaults. Strings of the setup are borrowed. Returns as above, or EXIT_INPUT for what is
 * wrong in the setup file. */
int cli_options_complete(int argc, char **argv, const ppm_setup *setup, cli_options *options);
void cli_options_deinit(cli_options *options);

void cli_options_print_help(FILE *stream);

#endif
