/* The options of ppm-render: their table, what they mean together, and defaults. */
#include "options.h"

#include <getopt.h>
#include <stdbool.h>
#include <stdlib.h>
#include <string.h>
#include <strings.h>

#include "base/printable.h"
#include "option_values.h"
#include "ppm/ppm.h"
#include "setup_file.h"

enum { DEFAULT_PASSES = 256, DEFAULT_PHOTONS_PER_EPOCH = 10000000, DEFAULT_FPS = 24 };

static const option_choice integrators[] = {{"sppm", PPM_INTEGRATOR_SPPM},
                                            {"ppm", PPM_INTEGRATOR_PPM},
                                            {"path", PPM_INTEGRATOR_PATH},
                                            {NULL, 0}};
static const option_choice schedules[] = {
    {"progressive", PPM_SCHEDULE_PROGRESSIVE}, {"memoryless", PPM_SCHEDULE_MEMORYLESS}, {NULL, 0}};
static const option_choice directs[] = {
    {"sample", PPM_DIRECT_SAMPLE}, {"photons", PPM_DIRECT_PHOTONS}, {NULL, 0}};
static const option_choice aims[] = {{"learnt", PPM_AIM_LEARNT}, {"even", PPM_AIM_EVEN}, {NULL, 0}};
static const option_choice filters[] = {{"box", PPM_PIXEL_FILTER_BOX},
                                        {"gaussian", PPM_PIXEL_FILTER_GAUSSIAN},
                                        {"blackman-harris", PPM_PIXEL_FILTER_BLACKMAN_HARRIS},
                                        {NULL, 0}};
static const option_choice light_units[] = {{"auto", PPM_LIGHT_UNITS_AUTO},
                                            {"gltf", PPM_LIGHT_UNITS_GLTF},
                                            {"blender", PPM_LIGHT_UNITS_BLENDER},
                                            {"raw", PPM_LIGHT_UNITS_RAW},
                                            {NULL, 0}};
static const option_choice transmissions[] = {{"auto", PPM_TRANSMISSION_POLICY_AUTO},
                                              {"solid", PPM_TRANSMISSION_POLICY_SOLID},
                                              {"thin", PPM_TRANSMISSION_POLICY_THIN},
                                              {NULL, 0}};

static const option_choice ups[] = {{"y", PPM_UP_Y}, {"z", PPM_UP_Z}, {NULL, 0}};
static const option_choice light_groups[] = {
    {"given", PPM_LIGHT_GROUPS_GIVEN}, {"named", PPM_LIGHT_GROUPS_NAMED}, {NULL, 0}};
static const option_choice normals[] = {{"world", 0}, {"camera", 1}, {NULL, 0}};
static const option_choice depths[] = {
    {"half", PPM_DEPTH_HALF}, {"float", PPM_DEPTH_FLOAT}, {NULL, 0}};
static const option_choice packings[] = {{"zips", PPM_COMPRESSION_ZIPS},
                                         {"zip", PPM_COMPRESSION_ZIP},
                                         {"piz", PPM_COMPRESSION_PIZ},
                                         {"rle", PPM_COMPRESSION_RLE},
                                         {"dwaa", PPM_COMPRESSION_DWAA},
                                         {"dwab", PPM_COMPRESSION_DWAB},
                                         {"pxr24", PPM_COMPRESSION_PXR24},
                                         {"none", PPM_COMPRESSION_NONE},
                                         {NULL, 0}};
static const option_choice bit_counts[] = {{"8", 8}, {"16", 16}, {NULL, 0}};

static const option_choice lists[] = {{"table", LIST_TABLE}, {"json", LIST_JSON}, {NULL, 0}};

#define FIELD(member) .field = offsetof(cli_options, member)
static const option_row rows[] = {
    {"output", 'o', VALUE_OUTPUT, .argument = "FILE", .group = "Pictures",
     .help = "write the picture to FILE; may be repeated. The ending says the\n"
             "kind: .exr is scene-linear; .png .jpg .tif are for display\n"
             "(default: INPUT's name as .exr and .png in the current folder).\n"
             "In a sequence %04d or #### stands for the frame, %c for the camera"},
    {"size", 's', VALUE_SIZE, FIELD(size), .least = 1, .most = 65536, .argument = "WxH",
     .help = "pixels (default: 1280 wide, height from the camera's aspect)"},
    {"stats", 0, OPTION_TEXT, FIELD(stats), .argument = "FILE.json",
     .help = "write counts and timings to FILE.json at the end"},
    {"skip-existing", 0, OPTION_SET, FIELD(skips_existing), .set = 1,
     .help = "leave out pictures whose files are all there; a picture then\n"
             "appears when it is finished, never before"},

    {"list", 0, VALUE_LIST, FIELD(list), .choices = lists, .may_lack_value = true,
     .argument = "[=json]", .group = "What is in the file",
     .help = "show scenes, cameras, nodes, meshes, materials, lights, variants,\n"
             "animations, images and what of it is not supported, and end"},
    {"scene", 0, OPTION_TEXT, FIELD(scene), .argument = "NAME|N",
     .help = "by name, or by number from 1 (default: the file's own)"},
    {"variant", 0, OPTION_TEXT, FIELD(variant), .argument = "NAME",
     .help = "of the materials (default: none)"},
    {"strict", 0, OPTION_SET, FIELD(is_strict), .set = 1,
     .help = "refuse a file that uses something which is not supported"},
    {"no-clip", 0, OPTION_SET, FIELD(has_no_clip), .set = 1,
     .help = "glTF cameras see what is nearer than znear and beyond zfar too"},
    {"allow-outside", 0, OPTION_SET, FIELD(allows_outside), .set = 1,
     .help = "read files that INPUT names outside of its folder"},
    {"setup", 0, OPTION_TEXT, FIELD(setup), .argument = "FILE|none",
     .help = "cameras, lights, materials and render options of INPUT (default:\n"
             "its name with .ppm.json, if that is there)"},

    {"frame", 0, VALUE_FRAME, FIELD(frames), .argument = "N", .group = "Animation",
     .help = "the moment N / fps seconds into the animations (default: the\n"
             "pose that the file has without them)"},
    {"frames", 0, VALUE_FRAMES, FIELD(frames), .argument = "A-B[/STEP]",
     .help = "one picture for each frame, in files like walk.0007.exr"},
    {"fps", 0, VALUE_RATE, FIELD(fps), .low = 0.001, .high = 1e6, .argument = "F",
     .help = "frames per second, also like 24000/1001 (default: 24)"},
    {"animation", 0, OPTION_TEXT, FIELD(animation), .argument = "NAME|all",
     .help = "which one is played (default: all, together)"},
    {"motion-steps", 0, OPTION_INTEGER, FIELD(motion_steps), .least = 2,
     .most = PPM_MAX_MOTION_STEPS, .argument = "N",
     .help = "with --shutter: times at which what moves is looked at; between\n"
             "them it moves on straight lines (default: as many as\n"
             "show its way, up to 33)"},

    {"passes", 'n', OPTION_COUNT, FIELD(passes), .least = 1, .most = 1000000000, .argument = "N",
     .group = "When to stop", .help = "after N passes (default: 256; with --time no limit)"},
    {"time", 't', OPTION_REAL, FIELD(seconds), .low = 1e-9, .high = 1e9, .argument = "SECONDS",
     .help = "after that much rendering, at the nearest end of a pass\n"
             "(default: no limit)"},

    {"integrator", 'i', OPTION_CHOICE, FIELD(integrator), .choices = integrators,
     .argument = "NAME", .group = "Light transport",
     .help = "sppm: stochastic progressive photon mapping (default)\n\n"
             "ppm: progressive photon mapping, one eye pass or epochs\n\n"
             "path: unidirectional path tracer, to compare with"},
    {"photons", 'p', OPTION_COUNT, FIELD(photons), .least = 1, .most = UINT64_C(1) << 40,
     .argument = "N",
     .help = "photons per pass; k and M stand for 1024 and 1024^2\n"
             "(default: the number of pixels, within 256k .. 4M; sppm takes\n"
             "fewer where aimed ones do as much)"},
    {"radius", 0, OPTION_REAL, FIELD(radius_m), .low = 1e-9, .high = 1e9, .argument = "R",
     .help = "first gather radius in metres (default: a few pixels wide)"},
    {"alpha", 0, OPTION_REAL, FIELD(alpha), .low = 1e-6, .high = 1.0, .argument = "A",
     .help = "share of new photons that is kept, above 0, up to 1; less\n"
             "shrinks the radius faster (default: 2/3)"},
    {"schedule", 0, OPTION_CHOICE, FIELD(schedule), .choices = schedules, .argument = "HOW",
     .help = "how sppm's radius shrinks: progressive, by the photons found\n"
             "(default), or memoryless, by the number of the pass"},
    {"direct", 0, OPTION_CHOICE, FIELD(direct), .choices = directs, .argument = "HOW",
     .help = "light straight from lamps: sample (default), or photons as for\n"
             "all other light"},
    {"aim", 0, OPTION_CHOICE, FIELD(aim), .choices = aims, .argument = "HOW",
     .help = "where photons are sent: learnt, mostly to where a pilot's were\n"
             "seen (default), or even"},
    {"epochs", 0, OPTION_COUNT, FIELD(epochs), .least = 1, .most = 1000000, .argument = "K",
     .help = "ppm: render K times with new eye paths and average, in place\n"
             "of --passes (default: one eye pass for ever)"},
    {"photons-per-epoch", 0, OPTION_COUNT, FIELD(photons_per_epoch), .least = 1,
     .most = UINT64_C(1) << 50, .argument = "N",
     .help = "ppm: photons of an epoch (default with --epochs: 10 million)"},
    {"split-depth", 0, VALUE_SPLIT, FIELD(split_depth), .least = 0, .most = 12, .argument = "N",
     .help = "sppm, ppm: at so many surfaces an eye path follows both\n"
             "reflection and refraction; beyond, one is drawn (default: 4)"},
    {"max-depth", 0, OPTION_INTEGER, FIELD(max_depth), .least = 1, .most = 10000, .argument = "N",
     .help = "most bounces of a path (default: 4096, all that matter)"},
    {"seed", 0, OPTION_INTEGER, FIELD(seed), .most = INT64_MAX, .argument = "N",
     .help = "other random numbers (default: 0)"},
    {"threads", 0, OPTION_INTEGER, FIELD(threads), .least = 1, .most = 4096, .argument = "N",
     .help = "does not change the picture (default: all processors)"},

    {"camera", 0, OPTION_TEXT, FIELD(camera), .argument = "NAME|N|all", .group = "Camera",
     .help = "by name, by number from 1, or one after the other (default: the\n"
             "first; a file without a camera is shown whole)"},
    {"aperture", 0, OPTION_REAL, FIELD(aperture), .low = 0.001, .high = 1e6, .argument = "F",
     .help = "f-number of a lens that blurs what is out of focus; less\n"
             "blurs more (default: the camera's own, else all is sharp)"},
    {"focus", 0, OPTION_TEXT, FIELD(focus), .argument = "R|NODE",
     .help = "what is sharp: metres along the axis, or the name of a node\n"
             "(default: what is in the middle of the picture)"},
    {"shutter", 0, VALUE_SHUTTER, FIELD(shutter), .argument = "OPEN,CLOSE",
     .help = "motion blur: frames before and after the moment, as -0.25,0.25\n"
             "(default: none)"},
    {"crop", 0, VALUE_CROP, FIELD(crop), .argument = "X0,Y0,X1,Y1",
     .help = "a part of the picture, in pixels from its upper left, X1 and\n"
             "Y1 excluded; or in shares, as 0.0,0.5,1.0,1.0"},
    {"filter", 0, VALUE_FILTER, FIELD(filter), .low = 0.001, .high = 100, .choices = filters,
     .argument = "NAME[,W]",
     .help = "what a pixel averages over: box, gaussian, blackman-harris;\n"
             "W pixels wide (default: blackman-harris,3)"},

    {"env", 0, OPTION_TEXT, FIELD(environment), .argument = "FILE", .group = "Scene",
     .help = "light from a latitude-longitude picture, besides INPUT's lights"},
    {"env-rotation", 0, OPTION_REAL, FIELD(environment_rotation_deg), .low = -360, .high = 360,
     .argument = "DEGREES",
     .help = "turns that picture, counter-clockwise seen from above (default: 0)"},
    {"env-intensity", 0, OPTION_REAL, FIELD(environment_intensity), .low = 1e-9, .high = 1e9,
     .argument = "FACTOR", .help = "of that picture, and of --sun with its sky (default: 1)"},
    {"sun", 0, VALUE_SUN, FIELD(sun), .argument = "ELEVATION,AZIMUTH[,TURBIDITY]",
     .help = "a clear sky with its sun: degrees above the horizon, degrees\n"
             "clockwise from north (-Z), haze 2 .. 10 (default: 3); with\n"
             "--env the sun only"},
    {"background", 0, VALUE_BACKGROUND, FIELD(background), .argument = "WHAT",
     .help = "what the camera sees where nothing is: env, black, a grey 0.5\n"
             "or 0.1,0.2,0.3 (default: env; grey for a scene without light)"},
    {"fog", 0, VALUE_FOG, FIELD(fog), .argument = "S,A[,G]",
     .help = "fog around everything: scattering and absorption per metre;\n"
             "G from -1 to 1 scatters backwards or forwards (default: 0)"},
    {"light-units", 0, OPTION_CHOICE, FIELD(light_units), .choices = light_units, .argument = "HOW",
     .help = "how lamps are read: auto, gltf, blender, raw (default: auto)"},
    {"line-radius", 0, OPTION_REAL, FIELD(line_radius_m), .low = 1e-9, .high = 1e9, .argument = "R",
     .help = "of the file's points and lines, in metres of their mesh\n"
             "(default: 0.2 % of the diagonal of its box)"},
    {"transmission", 0, OPTION_CHOICE, FIELD(transmission), .choices = transmissions,
     .argument = "HOW", .help = "glass without a thickness: auto, solid, thin (default: auto)"},
    {"crease", 0, OPTION_REAL, FIELD(crease_deg), .low = 0.001, .high = 180, .argument = "DEGREES",
     .help = "an OBJ without normals and smoothing groups is smooth across\n"
             "edges that bend by no more (default: flat)"},
    {"unit-scale", 0, OPTION_REAL, FIELD(unit_scale), .low = 1e-9, .high = 1e9, .argument = "F",
     .help = "metres of one unit of an OBJ (default: 1)"},
    {"up", 0, OPTION_CHOICE, FIELD(up), .choices = ups, .argument = "AXIS",
     .help = "of an OBJ: y, z (default: y)"},
    {"texture-path", 0, VALUE_TEXTURE_FOLDER, .argument = "DIR",
     .help = "where images and libraries of an OBJ are looked for that are\n"
             "not beside it; may be repeated"},

    {"aov", 0, VALUE_LAYERS, FIELD(layers), .argument = "LIST|all", .group = "Layers of .exr",
     .help = "layers beside the picture, as caustics,albedo,crypto; may be\n"
             "repeated. all: all that there are but denoised"},
    {"light-groups", 0, VALUE_GROUPS, FIELD(light_groups), .choices = light_groups,
     .may_lack_value = true, .argument = "[=HOW]",
     .help = "a layer for each group of lights: given by the scene (the\n"
             "default), or named: lights without a group are one each.\n"
             "With --aov caustics one more for the caustics of each"},
    {"transparent", 0, OPTION_SET, FIELD(is_transparent), .set = 1,
     .help = "alpha is 0 where the camera sees the environment"},
    {"catcher", 0, VALUE_CATCHER, .argument = "NODE",
     .help = "a thing of a photograph, to put all else into it: the picture\n"
             "holds what light it gets and loses, with alpha; may be\n"
             "repeated. Implies --transparent"},
    {"normals", 0, OPTION_CHOICE, FIELD(normals_of_camera), .choices = normals, .argument = "SPACE",
     .help = "of the layer normal: world, camera (default: world)"},
    {"follow-specular", 0, OPTION_SET, FIELD(follows_specular), .set = 1,
     .help = "albedo and normal of what is seen in mirrors and through glass"},
    {"denoise", 0, OPTION_SET, FIELD(denoises), .set = 1,
     .help = "filters the noise: as the layer denoised of .exr, beside the\n"
             "noisy ones, and as what all other files show"},
    {"cryptomatte-levels", 0, VALUE_RANKS, FIELD(cryptomatte_ranks), .least = 2, .most = 32,
     .argument = "N", .help = "ids that a pixel can hold (default: 6)"},
    {"depth", 0, OPTION_CHOICE, FIELD(depth), .choices = depths, .argument = "BITS",
     .help = "half, float; ids and distances are float always (default: float)"},
    {"exr-compression", 0, VALUE_PACKING, FIELD(packing), .choices = packings, .low = 1,
     .high = 10000, .argument = "NAME",
     .help = "zips, zip, piz, rle, none; with losses pxr24, dwaa[:LEVEL],\n"
             "dwab[:LEVEL] (default: zips; LEVEL 45)"},
    {"exr-multipart", 0, OPTION_SET, FIELD(is_multipart), .set = 1,
     .help = "a part for each layer, in place of one with all channels"},
    {"exr-tiles", 0, VALUE_TILES, FIELD(tile_side), .least = 16, .most = 4096,
     .may_lack_value = true, .argument = "[=N]",
     .help = "tiles of N x N pixels (default: 64), in place of rows"},

    {"exposure", 0, OPTION_REAL, FIELD(exposure_ev), .low = -64, .high = 64, .argument = "EV",
     .group = "Colour of .png .jpg .tif", .help = "stops; 1 is twice as bright (default: 0)"},
    {"display", 0, OPTION_TEXT, FIELD(display), .argument = "NAME",
     .help = "of the OpenColorIO configuration (default: its default)"},
    {"view", 0, OPTION_TEXT, FIELD(view), .argument = "NAME|auto",
     .help = "of the display (default: its default); auto: what the Blender\n"
             "that wrote INPUT shows"},
    {"look", 0, OPTION_TEXT, FIELD(look), .argument = "NAME",
     .help = "of the configuration, or none (default: the view's own)"},
    {"gamma", 0, OPTION_REAL, FIELD(gamma), .low = 0.01, .high = 100, .argument = "G",
     .help = "to the power of 1/G, after the view (default: 1)"},
    {"bits", 0, OPTION_CHOICE, FIELD(bits), .choices = bit_counts, .argument = "8|16",
     .help = "a channel, in .png and .tif (default: 8 in .png, 16 in .tif)"},
    {"no-dither", 0, OPTION_SET, FIELD(has_no_dither), .set = 1,
     .help = "round to 8 bits without noise against banding"},
    {"jpeg-quality", 0, OPTION_INTEGER, FIELD(jpeg_quality), .least = 1, .most = 100,
     .argument = "N", .help = "1 .. 100 (default: 95)"},
    {"ocio", 0, OPTION_TEXT, FIELD(ocio), .argument = "FILE", .group = "Colour management",
     .help = "an OpenColorIO configuration (default: the one that $OCIO\n"
             "names, else one that is built in)"},
    {"working-space", 0, OPTION_TEXT, FIELD(working_space), .argument = "NAME",
     .help = "a scene-linear space or role of it: what is rendered in, and\n"
             "what .exr holds (default: the role scene_linear)"},
    {"texture-space", 0, VALUE_TEXTURE_SPACE, .argument = "PATTERN=SPACE",
     .help = "colour textures whose file name matches PATTERN (* ? [...])\n"
             "are in SPACE; may be repeated (default: sRGB)"},
    {"list-views", 0, OPTION_SET, FIELD(action), .set = ACTION_LIST_VIEWS,
     .help = "show displays, views, looks and colour spaces, and end"},

    {"quiet", 'q', OPTION_SET, FIELD(verbosity), .set = VERBOSITY_QUIET, .group = "Messages",
     .help = "errors only"},
    {"verbose", 'v', OPTION_SET, FIELD(verbosity), .set = VERBOSITY_VERBOSE,
     .help = "details and timings too"},
    {"version", 0, OPTION_SET, FIELD(action), .set = ACTION_VERSION,
     .help = "show version and build, and end"},
    {"help", 'h', OPTION_SET, FIELD(action), .set = ACTION_HELP, .help = "show this, and end"},
};
#undef FIELD

/* "ppm-render --help --size oops" is a call for help. */
static bool is_settled(const void *options)
{
    const int32_t action = ((const cli_options *)options)->action;
    return action == ACTION_HELP || action == ACTION_VERSION;
}

static const option_table table = {.program = "ppm-render",
                                   .help_column = 27,
                                   .rows = rows,
                                   .count = sizeof rows / sizeof rows[0],
                                   .store_own = option_store_own,
                                   .is_settled = is_settled};

void cli_options_print_help(FILE *stream)
{
    fputs("Usage: ppm-render [options] INPUT.{gltf,glb,obj}\n"
          "Renders a glTF or OBJ scene by progressive photon mapping.\n",
          stream);
    option_table_print_help(&table, stream);
    fputs("\nExample: ten minutes for a picture of 1920x1080 pixels, two stops brighter\n"
          "  ppm-render -s 1920x1080 -t 600 --exposure 2 -o hall.exr -o hall.png hall.glb\n"
          "Example: a second of an animation with motion blur; run again, it goes on\n"
          "  ppm-render --frames 1-24 --shutter -0.25,0.25 --skip-existing \\\n"
          "      -o walk.%04d.exr walk.glb\n"
          "Example: glass into a photograph of a table, with layers to work on\n"
          "  ppm-render --catcher Table --aov caustics,crypto -o glass.exr glass.glb\n"
          "\nExit status: 0 done (also when stopped by SIGINT or SIGTERM), 1 wrong usage,\n"
          "2 input not usable, 3 output not writable, 4 out of resources,\n"
          "130 ended by a signal before its pictures were written.\n",
          stream);
}

/* What is wrong with options together, or NULL. An option that would do nothing is a mistake. */
static const char *fault_together(const cli_options *options)
{
    const bool has_sky = options->environment || options->sun.is_given;
    const bool has_frames = options->frames.is_given;
    const bool has_blur = has_frames && options->shutter.close > options->shutter.open;
    const struct {
        bool is_idle;
        const char *message;
    } rules[] = {
        {options->epochs > 0 && options->passes > 0, "--epochs and --passes both say when to stop"},
        {options->environment_rotation_deg != 0.0 && !options->environment,
         "--env-rotation turns the picture of --env, which is not given"},
        {options->environment_intensity > 0.0 && !has_sky,
         "--env-intensity is about --env and --sun, neither of which is given"},
        {options->fps > 0.0 && !has_frames,
         "--fps is about --frame and --frames, neither of which is given"},
        {options->animation && !has_frames,
         "--animation is played by --frame and --frames, neither of which is given"},
        {options->motion_steps > 0 && !has_blur,
         "--motion-steps is about --shutter with --frame or --frames, which are not all given"},
    };
    for (size_t i = 0; i < sizeof rules / sizeof rules[0]; i++) {
        if (rules[i].is_idle) return rules[i].message;
    }
    return NULL;
}

static bool has_exr(const cli_options *options)
{
    for (size_t i = 0; i < options->output_count; i++) {
        const size_t length = strlen(options->outputs[i]);
        if (length >= 4 && strcasecmp(options->outputs[i] + length - 4, ".exr") == 0) return true;
    }
    return options->output_count == 0;
}

static bool asks_for(const cli_options *options, int32_t first, int32_t last)
{
    for (int32_t kind = first; kind <= last; kind++) {
        if (options->layers & PPM_LAYER_BIT(kind)) return true;
    }
    return false;
}

/* The same for layers. */
static const char *fault_of_layers(const cli_options *options)
{
    const bool is_packed =
        options->depth || options->packing.kind || options->is_multipart || options->tile_side > 0;
    const bool has_crypto = asks_for(options, PPM_LAYER_CRYPTO_OBJECT, PPM_LAYER_CRYPTO_ASSET);
    const bool denoises =
        options->denoises || asks_for(options, PPM_LAYER_DENOISED, PPM_LAYER_DENOISED);
    const struct {
        bool is_idle;
        const char *message;
    } rules[] = {
        {(options->layers || options->light_groups) && !has_exr(options),
         "--aov and --light-groups are layers of an .exr, which is not among the outputs"},
        {is_packed && !has_exr(options),
         "--depth and --exr-... are about an .exr, which is not among the outputs"},
        {options->normals_of_camera && !asks_for(options, PPM_LAYER_NORMAL, PPM_LAYER_NORMAL),
         "--normals is about the layer normal, which --aov does not name"},
        {options->follows_specular && !denoises &&
             !asks_for(options, PPM_LAYER_ALBEDO, PPM_LAYER_NORMAL),
         "--follow-specular is about the layers albedo and normal, which --aov does not name"},
        {denoises && options->passes == 1,
         "--denoise tells noise by the differences between passes: it needs 2 at least, better 16"},
        {options->cryptomatte_ranks > 0 && !has_crypto,
         "--cryptomatte-levels is about Cryptomattes, which --aov does not name (crypto)"},
    };
    for (size_t i = 0; i < sizeof rules / sizeof rules[0]; i++) {
        if (rules[i].is_idle) return rules[i].message;
    }
    return NULL;
}

/* words is the command line alone: what a setup file says for the case that there are frames is no
 * mistake where there are none. */
static int check_together(const cli_options *words, const cli_options *options)
{
    const char *const fault = fault_together(options);
    const bool is_torn = options->epochs > 0 && options->passes > 0;
    if (fault && (is_torn || fault_together(words))) return option_complain_of_all(&table, fault);
    const char *const layers = fault_of_layers(options);
    if (layers && fault_of_layers(words)) return option_complain_of_all(&table, layers);
    return EXIT_DONE;
}

/* Groups come by name or by their option; caustics of each where both are wanted. */
static void take_groups(cli_options *options)
{
    const uint64_t groups = PPM_LAYER_BIT(PPM_LAYER_LIGHT_GROUP);
    const uint64_t caustics = PPM_LAYER_BIT(PPM_LAYER_CAUSTICS);
    if (options->light_groups) options->layers |= groups;
    if ((options->layers & groups) && (options->layers & caustics)) {
        options->layers |= PPM_LAYER_BIT(PPM_LAYER_GROUP_CAUSTICS);
    }
}

/* "all" is a word, whatever the file calls its cameras and animations; those have numbers, too. */
static void take_all(cli_options *options)
{
    if (options->camera && strcmp(options->camera, "all") == 0) {
        options->all_cameras = true;
        options->camera = NULL;
    }
    if (options->animation && strcmp(options->animation, "all") == 0) options->animation = NULL;
    if (options->view && strcmp(options->view, "auto") == 0) {
        options->has_auto_view = true;
        options->view = NULL;
    }
}

static void fill_defaults(cli_options *options)
{
    const bool has_epochs = options->epochs > 0; /* passes follow from the photons of a pass */
    if (has_epochs && options->photons_per_epoch == 0) {
        options->photons_per_epoch = DEFAULT_PHOTONS_PER_EPOCH;
    }
    if (!has_epochs && options->passes == 0 && !(options->seconds > 0.0)) {
        options->passes = DEFAULT_PASSES;
    }
    if (!(options->fps > 0.0)) options->fps = DEFAULT_FPS;
}

/* What is left of the words is INPUT. */
static int take_input(int argc, char **argv, cli_options *options)
{
    if (optind == argc) {
        return option_complain_of_all(&table, "no INPUT file");
    }
    if (optind + 1 < argc) {
        const char *const first = argv[optind], *const second = argv[optind + 1];
        ppmi_print(stderr, "ppm-render: error: one INPUT at a time; besides '%s' there is '%s'\n",
                   first, second);
        if (options->list && strcmp(first, "json") == 0) {
            fputs("For JSON write --list=json.\n", stderr);
        }
        return option_give_hint(&table);
    }
    options->input = argv[optind];
    return EXIT_DONE;
}

int cli_options_parse(int argc, char **argv, cli_options *out_options)
{
    memset(out_options, 0, sizeof *out_options);
    out_options->outputs = calloc((size_t)argc + 1, sizeof *out_options->outputs);
    out_options->texture_folders = calloc((size_t)argc + 1, sizeof *out_options->texture_folders);
    out_options->texture_spaces = calloc((size_t)argc + 1, sizeof *out_options->texture_spaces);
    out_options->catchers = calloc((size_t)argc + 1, sizeof *out_options->catchers);
    if (!out_options->outputs || !out_options->texture_folders || !out_options->texture_spaces ||
        !out_options->catchers) {
        fputs("ppm-render: error: out of memory\n", stderr);
        return EXIT_RESOURCES;
    }
    int status = option_table_parse(&table, argc, argv, out_options);
    const int32_t action = out_options->action;
    const bool needs_input = action == ACTION_RENDER || action == ACTION_LIST;
    if (status != EXIT_DONE || !needs_input) return status;
    return take_input(argc, argv, out_options);
}

static void free_patterns(cli_options *options)
{
    for (uint32_t i = 0; i < options->texture_space_count; i++)
        free((char *)options->texture_spaces[i].pattern);
    options->texture_space_count = 0;
}

/* The setup's options first, then the words of argv once more. */
static int take_setup(int argc, char **argv, const ppm_setup *setup, const cli_options *words,
                      cli_options *options)
{
    free_patterns(options);
    *options = (cli_options){.outputs = words->outputs,
                             .texture_folders = words->texture_folders,
                             .catchers = words->catchers,
                             .texture_spaces = words->texture_spaces};
    int status = setup_file_store(&table, setup, words, options);
    optind = 0; /* glibc: begin again */
    if (status == EXIT_DONE) status = option_table_parse(&table, argc, argv, options);
    if (status == EXIT_DONE) status = take_input(argc, argv, options);
    return status;
}

int cli_options_complete(int argc, char **argv, const ppm_setup *setup, cli_options *options)
{
    const cli_options words = *options;
    int status = EXIT_DONE;
    if (ppm_setup_option_count(setup) > 0) {
        status = take_setup(argc, argv, setup, &words, options);
    }
    if (status == EXIT_DONE) status = check_together(&words, options);
    take_groups(options);
    take_all(options);
    fill_defaults(options);
    return status;
}

void cli_options_deinit(cli_options *options)
{
    free_patterns(options);
    free(options->texture_spaces);
    free(options->outputs);
    options->texture_spaces = NULL;
    options->outputs = NULL;
    free(options->texture_folders);
    free(options->catchers);
    options->texture_folders = NULL;
    options->catchers = NULL;
}
