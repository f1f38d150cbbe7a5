/* One table describes every option; parsing, checking, help and suggestions all come from it.
 *
 * getopt_long does the splitting. Its habit of taking any unambiguous beginning of a name is
 * refused: a script that relies on "--exp" would break on the day that a second such name comes. */
#include "options.h"

#include <getopt.h>
#include <stdbool.h>
#include <stdlib.h>
#include <string.h>

#include "base/suggest.h"
#include "ppm/ppm.h"
#include "values.h"

enum { DEFAULT_PASSES = 256, DEFAULT_PHOTONS_PER_EPOCH = 10000000, DEFAULT_FPS = 24 };

typedef enum value_kind {
    VALUE_SET,        /* no argument: stores .set in an int32_t */
    VALUE_TEXT,       /* const char * */
    VALUE_OUTPUT,     /* one more of the cli_outputs */
    VALUE_INTEGER,    /* uint64_t */
    VALUE_COUNT,      /* uint64_t, with k, M, G */
    VALUE_REAL,       /* double */
    VALUE_SIZE,       /* image_size */
    VALUE_SUN,        /* sun_choice */
    VALUE_BACKGROUND, /* background_choice */
    VALUE_FOG,        /* fog_values */
    VALUE_SPLIT,      /* int32_t: a number, 0 stored as -1 */
    VALUE_SHUTTER,    /* shutter_times */
    VALUE_CROP,       /* crop_window */
    VALUE_FILTER,     /* filter_choice, from a list of names */
    VALUE_FRAME,      /* frame_choice: one */
    VALUE_FRAMES,     /* frame_choice: several */
    VALUE_LIST,       /* int32_t, from a list of names, may be missing; and the action */
    VALUE_CHOICE      /* int32_t, from a list of names */
} value_kind;

typedef struct choice {
    const char *name; /* NULL ends a list */
    int32_t value;
} choice;

typedef struct option_row {
    const char *name;
    char letter; /* 0: none */
    value_kind kind;
    size_t field; /* offset in cli_options */
    int32_t set;
    uint64_t least, most;  /* INTEGER, COUNT, SIZE (each side) */
    double low, high;      /* REAL; FILTER: of the width */
    const choice *choices; /* CHOICE, FILTER */
    const char *argument;  /* as the help shows it */
    const char *help;      /* lines separated by \n */
    const char *group;     /* a heading, where a group begins */
} option_row;

static const choice integrators[] = {{"sppm", PPM_INTEGRATOR_SPPM},
                                     {"ppm", PPM_INTEGRATOR_PPM},
                                     {"path", PPM_INTEGRATOR_PATH},
                                     {NULL, 0}};
static const choice schedules[] = {
    {"progressive", PPM_SCHEDULE_PROGRESSIVE}, {"memoryless", PPM_SCHEDULE_MEMORYLESS}, {NULL, 0}};
static const choice directs[] = {
    {"sample", PPM_DIRECT_SAMPLE}, {"photons", PPM_DIRECT_PHOTONS}, {NULL, 0}};
static const choice aims[] = {{"learnt", PPM_AIM_LEARNT}, {"even", PPM_AIM_EVEN}, {NULL, 0}};
static const choice filters[] = {{"box", PPM_PIXEL_FILTER_BOX},
                                 {"gaussian", PPM_PIXEL_FILTER_GAUSSIAN},
                                 {"blackman-harris", PPM_PIXEL_FILTER_BLACKMAN_HARRIS},
                                 {NULL, 0}};
static const choice light_units[] = {{"auto", PPM_LIGHT_UNITS_AUTO},
                                     {"gltf", PPM_LIGHT_UNITS_GLTF},
                                     {"blender", PPM_LIGHT_UNITS_BLENDER},
                                     {"raw", PPM_LIGHT_UNITS_RAW},
                                     {NULL, 0}};
static const choice transmissions[] = {{"auto", PPM_TRANSMISSION_POLICY_AUTO},
                                       {"solid", PPM_TRANSMISSION_POLICY_SOLID},
                                       {"thin", PPM_TRANSMISSION_POLICY_THIN},
                                       {NULL, 0}};

static const choice lists[] = {{"table", LIST_TABLE}, {"json", LIST_JSON}, {NULL, 0}};

#define FIELD(member) .field = offsetof(cli_options, member)
static const option_row rows[] = {
    {"output", 'o', VALUE_OUTPUT, .argument = "FILE", .group = "Pictures",
     .help = "write the picture to FILE; may be repeated. The ending says the\n"
             "kind: .exr is scene-linear; .png .jpg .tif are for display\n"
             "(default: INPUT's name as .exr and .png in the current folder).\n"
             "In a sequence %04d or #### stands for the frame, %c for the camera"},
    {"size", 's', VALUE_SIZE, FIELD(size), .least = 1, .most = 65536, .argument = "WxH",
     .help = "pixels (default: 1280 wide, height from the camera's aspect)"},
    {"stats", 0, VALUE_TEXT, FIELD(stats), .argument = "FILE.json",
     .help = "write counts and timings to FILE.json at the end"},
    {"skip-existing", 0, VALUE_SET, FIELD(skips_existing), .set = 1,
     .help = "leave out pictures whose files are all there; a picture then\n"
             "appears when it is finished, never before"},

    {"list", 0, VALUE_LIST, FIELD(list), .choices = lists, .argument = "[=json]",
     .group = "What is in the file",
     .help = "show scenes, cameras, nodes, meshes, materials, lights, variants,\n"
             "animations, images and what of it is not supported, and end"},
    {"scene", 0, VALUE_TEXT, FIELD(scene), .argument = "NAME|N",
     .help = "by name, or by number from 1 (default: the file's own)"},
    {"variant", 0, VALUE_TEXT, FIELD(variant), .argument = "NAME",
     .help = "of the materials (default: none)"},
    {"strict", 0, VALUE_SET, FIELD(is_strict), .set = 1,
     .help = "refuse a file that uses something which is not supported"},
    {"allow-outside", 0, VALUE_SET, FIELD(allows_outside), .set = 1,
     .help = "read files that INPUT names outside of its folder"},

    {"frame", 0, VALUE_FRAME, FIELD(frames), .argument = "N", .group = "Animation",
     .help = "the moment N / fps seconds into the animations (default: the\n"
             "pose that the file has without them)"},
    {"frames", 0, VALUE_FRAMES, FIELD(frames), .argument = "A-B[/STEP]",
     .help = "one picture for each frame, in files like walk.0007.exr"},
    {"fps", 0, VALUE_REAL, FIELD(fps), .low = 0.001, .high = 1e6, .argument = "F",
     .help = "frames per second (default: 24)"},
    {"animation", 0, VALUE_TEXT, FIELD(animation), .argument = "NAME|all",
     .help = "which one is played (default: all, together)"},
    {"motion-steps", 0, VALUE_INTEGER, FIELD(motion_steps), .least = 2,
     .most = PPM_MAX_MOTION_STEPS, .argument = "N",
     .help = "with --shutter: times at which what moves is looked at; between\n"
             "them it moves on straight lines (default: 2)"},

    {"passes", 'n', VALUE_COUNT, FIELD(passes), .least = 1, .most = 1000000000, .argument = "N",
     .group = "When to stop", .help = "after N passes (default: 256; with --time no limit)"},
    {"time", 't', VALUE_REAL, FIELD(seconds), .low = 1e-9, .high = 1e9, .argument = "SECONDS",
     .help = "after that much rendering, at the nearest end of a pass\n"
             "(default: no limit)"},

    {"integrator", 'i', VALUE_CHOICE, FIELD(integrator), .choices = integrators, .argument = "NAME",
     .group = "Light transport",
     .help = "sppm: stochastic progressive photon mapping (default)\n"
             "ppm: progressive photon mapping, one eye pass or epochs\n"
             "path: unidirectional path tracer, to compare with"},
    {"photons", 'p', VALUE_COUNT, FIELD(photons), .least = 1, .most = UINT64_C(1) << 40,
     .argument = "N",
     .help = "photons per pass; k and M stand for 1024 and 1024^2\n"
             "(default: the number of pixels, within 256k .. 4M; sppm takes\n"
             "fewer where aimed ones do as much)"},
    {"radius", 0, VALUE_REAL, FIELD(radius_m), .low = 1e-9, .high = 1e9, .argument = "R",
     .help = "first gather radius in metres (default: a few pixels wide)"},
    {"alpha", 0, VALUE_REAL, FIELD(alpha), .low = 1e-6, .high = 1.0, .argument = "A",
     .help = "share of new photons that is kept, above 0, up to 1; less\n"
             "shrinks the radius faster (default: 2/3)"},
    {"schedule", 0, VALUE_CHOICE, FIELD(schedule), .choices = schedules, .argument = "HOW",
     .help = "how sppm's radius shrinks: progressive, by the photons found\n"
             "(default), or memoryless, by the number of the pass"},
    {"direct", 0, VALUE_CHOICE, FIELD(direct), .choices = directs, .argument = "HOW",
     .help = "light straight from lamps: sample (default), or photons as for\n"
             "all other light"},
    {"aim", 0, VALUE_CHOICE, FIELD(aim), .choices = aims, .argument = "HOW",
     .help = "where photons are sent: learnt, mostly to where a pilot's were\n"
             "seen (default), or even"},
    {"epochs", 0, VALUE_COUNT, FIELD(epochs), .least = 1, .most = 1000000, .argument = "K",
     .help = "ppm: render K times with new eye paths and average, in place\n"
             "of --passes (default: one eye pass for ever)"},
    {"photons-per-epoch", 0, VALUE_COUNT, FIELD(photons_per_epoch), .least = 1,
     .most = UINT64_C(1) << 50, .argument = "N",
     .help = "ppm: photons of an epoch (default with --epochs: 10 million)"},
    {"split-depth", 0, VALUE_SPLIT, FIELD(split_depth), .least = 0, .most = 12, .argument = "N",
     .help = "ppm: at so many surfaces an eye path follows both reflection\n"
             "and refraction; beyond, one is drawn (default: 4)"},
    {"max-depth", 0, VALUE_INTEGER, FIELD(max_depth), .least = 1, .most = 10000, .argument = "N",
     .help = "bounces of a path (default: 32)"},
    {"seed", 0, VALUE_INTEGER, FIELD(seed), .most = INT64_MAX, .argument = "N",
     .help = "other random numbers (default: 0)"},
    {"threads", 0, VALUE_INTEGER, FIELD(threads), .least = 1, .most = 4096, .argument = "N",
     .help = "does not change the picture (default: all processors)"},

    {"camera", 0, VALUE_TEXT, FIELD(camera), .argument = "NAME|N|all", .group = "Camera",
     .help = "by name, by number from 1, or one after the other (default: the\n"
             "first; a file without a camera is shown whole)"},
    {"aperture", 0, VALUE_REAL, FIELD(aperture), .low = 0.001, .high = 1e6, .argument = "F",
     .help = "f-number of a lens that blurs what is out of focus; less\n"
             "blurs more (default: the camera's own, else all is sharp)"},
    {"focus", 0, VALUE_TEXT, FIELD(focus), .argument = "R|NODE",
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

    {"env", 0, VALUE_TEXT, FIELD(environment), .argument = "FILE", .group = "Scene",
     .help = "light from a latitude-longitude picture, besides INPUT's lights"},
    {"env-rotation", 0, VALUE_REAL, FIELD(environment_rotation_deg), .low = -360, .high = 360,
     .argument = "DEGREES",
     .help = "turns that picture, counter-clockwise seen from above (default: 0)"},
    {"env-intensity", 0, VALUE_REAL, FIELD(environment_intensity), .low = 1e-9, .high = 1e9,
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
    {"light-units", 0, VALUE_CHOICE, FIELD(light_units), .choices = light_units, .argument = "HOW",
     .help = "how lamps are read: auto, gltf, blender, raw (default: auto)"},
    {"transmission", 0, VALUE_CHOICE, FIELD(transmission), .choices = transmissions,
     .argument = "HOW", .help = "glass without a thickness: auto, solid, thin (default: auto)"},

    {"exposure", 0, VALUE_REAL, FIELD(exposure_ev), .low = -64, .high = 64, .argument = "EV",
     .group = "Colour of .png .jpg .tif", .help = "stops; 1 is twice as bright (default: 0)"},
    {"display", 0, VALUE_TEXT, FIELD(display), .argument = "NAME",
     .help = "of the OpenColorIO configuration (default: its default)"},
    {"view", 0, VALUE_TEXT, FIELD(view), .argument = "NAME",
     .help = "of the display (default: its default)"},
    {"ocio", 0, VALUE_TEXT, FIELD(ocio), .argument = "FILE",
     .help = "an OpenColorIO configuration (default: the one that $OCIO\n"
             "names, else one that is built in)"},
    {"list-views", 0, VALUE_SET, FIELD(action), .set = ACTION_LIST_VIEWS,
     .help = "show displays, views and colour spaces, and end"},

    {"quiet", 'q', VALUE_SET, FIELD(verbosity), .set = VERBOSITY_QUIET, .group = "Messages",
     .help = "errors only"},
    {"verbose", 'v', VALUE_SET, FIELD(verbosity), .set = VERBOSITY_VERBOSE,
     .help = "details and timings too"},
    {"version", 0, VALUE_SET, FIELD(action), .set = ACTION_VERSION,
     .help = "show version and build, and end"},
    {"help", 'h', VALUE_SET, FIELD(action), .set = ACTION_HELP, .help = "show this, and end"},
};
#undef FIELD
enum { ROW_COUNT = sizeof rows / sizeof rows[0], FIRST_LONG = 256 };

/* ---- help ------------------------------------------------------------------------------------ */

static void print_row(FILE *stream, const option_row *row)
{
    enum { HELP_COLUMN = 27 };
    char letter[5] = "    ";
    if (row->letter) snprintf(letter, sizeof letter, "-%c, ", row->letter);
    const bool has_space = row->argument && row->kind != VALUE_LIST;
    int column = fprintf(stream, "  %s--%s%s%s", letter, row->name, has_space ? " " : "",
                         row->argument ? row->argument : "");
    if (column >= HELP_COLUMN) {
        fputc('\n', stream);
        column = 0;
    }
    for (const char *line = row->help; line;) {
        const size_t length = strcspn(line, "\n");
        fprintf(stream, "%*s%.*s\n", HELP_COLUMN - column, "", (int)length, line);
        line = line[length] ? line + length + 1 : NULL;
        column = 0;
    }
}

void cli_options_print_help(FILE *stream)
{
    fputs("Usage: ppm-render [options] INPUT.{gltf,glb,obj}\n"
          "Renders a glTF or OBJ scene by progressive photon mapping.\n",
          stream);
    for (size_t i = 0; i < ROW_COUNT; i++) {
        if (rows[i].group) fprintf(stream, "\n%s:\n", rows[i].group);
        print_row(stream, &rows[i]);
    }
    fputs("\nExample: ten minutes for a picture of 1920x1080 pixels, two stops brighter\n"
          "  ppm-render -s 1920x1080 -t 600 --exposure 2 -o hall.exr -o hall.png hall.glb\n"
          "Example: a second of an animation with motion blur; again, it goes on where it ended\n"
          "  ppm-render --frames 1-24 --shutter -0.25,0.25 --skip-existing -o walk.%04d.exr "
          "walk.glb\n"
          "\nExit status: 0 done (also when stopped by SIGINT or SIGTERM), 1 wrong usage,\n"
          "2 input not usable, 3 output not writable, 4 out of resources, 130 ended by a signal\n"
          "before its pictures were written.\n",
          stream);
}

/* ---- complaints ------------------------------------------------------------------------------ */

static int give_hint(void)
{
    fputs("Try 'ppm-render --help'.\n", stderr);
    return EXIT_USAGE;
}

/* expected completes "'value' is not ..." */
static int complain(const option_row *row, const char *value, const char *expected)
{
    fprintf(stderr, "ppm-render: error: --%s: '%s' is not %s\n", row->name, value, expected);
    return give_hint();
}

static int unknown_long(const char *argument)
{
    const char *names[ROW_COUNT];
    for (size_t i = 0; i < ROW_COUNT; i++)
        names[i] = rows[i].name;
    char name[64];
    snprintf(name, sizeof name, "%.*s", (int)strcspn(argument + 2, "="), argument + 2);
    const char *const nearest = ppmi_suggest(name, names, ROW_COUNT);
    fprintf(stderr, "ppm-render: error: unknown option '--%s'", name);
    if (nearest) fprintf(stderr, "; did you mean '--%s'?", nearest);
    fputc('\n', stderr);
    return give_hint();
}

static int unknown_letter(int letter)
{
    fprintf(stderr, "ppm-render: error: unknown option '-%c'", letter);
    for (size_t i = 0; i < ROW_COUNT; i++) {
        const int other_case = letter ^ ('a' ^ 'A');
        if (rows[i].letter && rows[i].letter == other_case) {
            fprintf(stderr, "; did you mean '-%c' (--%s)?", other_case, rows[i].name);
        }
    }
    fputc('\n', stderr);
    return give_hint();
}

/* ---- values ---------------------------------------------------------------------------------- */

static int store_integer(const option_row *row, const char *text, uint64_t *field)
{
    uint64_t value = 0;
    const bool is_number = row->kind == VALUE_COUNT ? value_parse_count(text, &value)
                                                    : value_parse_integer(text, &value);
    if (!is_number || value < row->least || value > row->most) {
        char expected[80];
        snprintf(expected, sizeof expected, "a whole number from %llu to %llu",
                 (unsigned long long)row->least, (unsigned long long)row->most);
        return complain(row, text, expected);
    }
    *field = value;
    return EXIT_DONE;
}

static int store_real(const option_row *row, const char *text, double *field)
{
    double value = 0.0;
    const bool is_number = value_parse_real(text, &value);
    if (!is_number || value < row->low || value > row->high) {
        char expected[80];
        snprintf(expected, sizeof expected, "a number from %g to %g", row->low, row->high);
        return complain(row, text, expected);
    }
    *field = value;
    return EXIT_DONE;
}

static int store_size(const option_row *row, const char *text, image_size *field)
{
    image_size size = {0, 0};
    if (!value_parse_size(text, &size.width, &size.height)) {
        return complain(row, text, "a size like 1280x720");
    }
    if (size.width < row->least || size.width > row->most || size.height < row->least ||
        size.height > row->most) {
        char expected[80];
        snprintf(expected, sizeof expected, "a size whose sides are from %llu to %llu",
                 (unsigned long long)row->least, (unsigned long long)row->most);
        return complain(row, text, expected);
    }
    *field = size;
    return EXIT_DONE;
}

static int store_fog(const option_row *row, const char *text, fog_values *field)
{
    double values[3] = {0.0, 0.0, 0.0};
    size_t count = 0;
    if (!value_parse_reals(text, 3, values, &count) || count < 2 || values[0] < 0.0 ||
        values[1] < 0.0 || values[0] > 1e9 || values[1] > 1e9 ||
        !(values[2] > -1.0 && values[2] < 1.0)) {
        return complain(row, text,
                        "like 0.1,0.01 or 0.1,0.01,0.5: two coefficients of at least 0 and "
                        "a number between -1 and 1");
    }
    *field = (fog_values){values[0], values[1], values[2]};
    return EXIT_DONE;
}

static int store_split(const option_row *row, const char *text, int32_t *field)
{
    uint64_t value = 0;
    const int status = store_integer(row, text, &value);
    if (status == EXIT_DONE) *field = value == 0 ? -1 : (int32_t)value;
    return status;
}

static int store_sun(const option_row *row, const char *text, sun_choice *field)
{
    double values[3] = {0.0, 0.0, 0.0};
    size_t count = 0;
    if (!value_parse_reals(text, 3, values, &count) || count < 2) {
        return complain(row, text, "ELEVATION,AZIMUTH[,TURBIDITY] like 35,160 or 35,160,3");
    }
    if (values[0] < 0.0 || values[0] > 90.0) {
        return complain(row, text, "a sun with an elevation from 0 to 90 degrees");
    }
    if (values[1] < -360.0 || values[1] > 360.0) {
        return complain(row, text, "a sun with an azimuth from -360 to 360 degrees");
    }
    if (count == 3 && !(values[2] >= 2.0 && values[2] <= 10.0)) {
        return complain(row, text, "a sun with a turbidity from 2 to 10");
    }
    *field = (sun_choice){.is_given = 1,
                          .elevation_deg = values[0],
                          .azimuth_deg = values[1],
                          .turbidity = values[2]};
    return EXIT_DONE;
}

static int store_background(const option_row *row, const char *text, background_choice *field)
{
    const double most = 1e9;
    double rgb[3] = {0.0, 0.0, 0.0};
    size_t count = 1;
    if (strcmp(text, "env") == 0) {
        *field = (background_choice){.kind = BACKGROUND_ENVIRONMENT};
        return EXIT_DONE;
    }
    bool is_valid = strcmp(text, "black") == 0;
    if (!is_valid) is_valid = value_parse_reals(text, 3, rgb, &count) && count != 2;
    if (count == 1) rgb[1] = rgb[2] = rgb[0];
    for (int i = 0; i < 3; i++)
        is_valid = is_valid && rgb[i] >= 0.0 && rgb[i] <= most;
    if (!is_valid) {
        return complain(row, text, "env, black, or a radiance from 0 to 1e+09: 0.5 or 0.1,0.2,0.3");
    }
    *field = (background_choice){.kind = BACKGROUND_RADIANCE,
                                 .radiance = {(float)rgb[0], (float)rgb[1], (float)rgb[2]}};
    return EXIT_DONE;
}

/* length letters of text are the name. */
static int store_name(const option_row *row, const char *text, size_t length, int32_t *field)
{
    enum { CHOICES_MAX = 16 };
    const char *names[CHOICES_MAX];
    size_t count = 0;
    char name[64];
    snprintf(name, sizeof name, "%.*s", (int)length, text);
    for (const choice *each = row->choices; each->name && count < CHOICES_MAX; each++) {
        if (strcmp(each->name, name) == 0) {
            *field = each->value;
            return EXIT_DONE;
        }
        names[count++] = each->name;
    }
    const char *const nearest = ppmi_suggest(name, names, count);
    fprintf(stderr, "ppm-render: error: --%s: '%s' is not one of", row->name, name);
    for (size_t i = 0; i < count; i++)
        fprintf(stderr, "%s %s", i ? "," : "", names[i]);
    if (nearest) fprintf(stderr, "; did you mean '%s'?", nearest);
    fputc('\n', stderr);
    return give_hint();
}

static int store_shutter(const option_row *row, const char *text, shutter_times *field)
{
    double times[2] = {0.0, 0.0};
    size_t count = 0;
    if (!value_parse_reals(text, 2, times, &count) || count != 2 || times[0] > times[1] ||
        times[0] < -1e6 || times[1] > 1e6) {
        return complain(row, text, "two numbers of frames like -0.25,0.25, the smaller first");
    }
    *field = (shutter_times){times[0], times[1]};
    return EXIT_DONE;
}

/* Pixels are whole numbers; shares of the picture all have a decimal point. */
static int store_crop(const option_row *row, const char *text, crop_window *field)
{
    const char *const expected =
        "four numbers X0,Y0,X1,Y1 with X0 < X1 and Y0 < Y1: whole ones, or "
        "from 0.0 to 1.0, all with a point";
    crop_window crop = {.is_given = true, .is_in_shares = strchr(text, '.') != NULL};
    size_t points = 0, count = 0;
    for (const char *letter = text; *letter; letter++)
        points += *letter == '.';
    const bool is_uniform =
        crop.is_in_shares ? points == 4 : text[strspn(text, "0123456789,")] == '\0';
    if (!is_uniform || !value_parse_reals(text, 4, crop.sides, &count) || count != 4)
        return complain(row, text, expected);
    const double *const sides = crop.sides, most = crop.is_in_shares ? 1.0 : 65536.0;
    if (sides[0] < 0.0 || sides[1] < 0.0 || sides[2] > most || sides[3] > most ||
        sides[0] >= sides[2] || sides[1] >= sides[3]) {
        return complain(row, text, expected);
    }
    *field = crop;
    return EXIT_DONE;
}

static int store_filter(const option_row *row, const char *text, filter_choice *field)
{
    filter_choice filter = {0};
    const size_t length = strcspn(text, ",");
    const int status = store_name(row, text, length, &filter.kind);
    if (status != EXIT_DONE) return status;
    if (text[length] == ',') {
        const bool is_number = value_parse_real(text + length + 1, &filter.width);
        if (!is_number || filter.width < row->low || filter.width > row->high) {
            return complain(row, text, "a filter with a width from 0.001 to 100 pixels");
        }
    }
    *field = filter;
    return EXIT_DONE;
}

/* The later of --frame and --frames would win without a word; both being there is found by kind. */
static int store_frames(const option_row *row, const char *text, frame_choice *field)
{
    frame_choice frames = {.is_given = true, .is_range = row->kind == VALUE_FRAMES};
    if (field->is_given && field->is_range != frames.is_range) {
        fputs("ppm-render: error: --frame and --frames both say what to render\n", stderr);
        return give_hint();
    }
    if (frames.is_range) {
        if (!frames_parse(text, &frames.range)) {
            return complain(row, text,
                            "frames like 1-24 or 1-24/2: whole numbers, at most a million of them");
        }
    } else {
        if (!frames_parse_one(text, &frames.range.first)) {
            return complain(row, text, "a whole number of at most 10000000, which may be below 0");
        }
        frames.range.last = frames.range.first;
        frames.range.step = 1;
    }
    *field = frames;
    return EXIT_DONE;
}

static int store_list(const option_row *row, const char *text, cli_options *options)
{
    options->action = ACTION_LIST;
    options->list = LIST_TABLE;
    return text ? store_name(row, text, strlen(text), &options->list) : EXIT_DONE;
}

/* outputs has room for one entry per word of argv, so appending never allocates. */
static int store(const option_row *row, const char *text, cli_options *options)
{
    void *const field = (char *)options + row->field;
    if (text && *text == '\0') return complain(row, text, "a value");
    switch (row->kind) {
    case VALUE_SET:
        *(int32_t *)field = row->set;
        return EXIT_DONE;
    case VALUE_TEXT:
        *(const char **)field = text;
        return EXIT_DONE;
    case VALUE_OUTPUT:
        options->outputs[options->output_count++] = text;
        return EXIT_DONE;
    case VALUE_INTEGER:
    case VALUE_COUNT:
        return store_integer(row, text, field);
    case VALUE_REAL:
        return store_real(row, text, field);
    case VALUE_SIZE:
        return store_size(row, text, field);
    case VALUE_FOG:
        return store_fog(row, text, field);
    case VALUE_SPLIT:
        return store_split(row, text, field);
    case VALUE_SUN:
        return store_sun(row, text, field);
    case VALUE_BACKGROUND:
        return store_background(row, text, field);
    case VALUE_CHOICE:
        return store_name(row, text, strlen(text), field);
    case VALUE_SHUTTER:
        return store_shutter(row, text, field);
    case VALUE_CROP:
        return store_crop(row, text, field);
    case VALUE_FILTER:
        return store_filter(row, text, field);
    case VALUE_FRAME:
    case VALUE_FRAMES:
        return store_frames(row, text, field);
    case VALUE_LIST:
        return store_list(row, text, options);
    }
    return EXIT_USAGE;
}

/* ---- parsing --------------------------------------------------------------------------------- */

/* Room for ':' in front, and a letter and a colon for each row. */
typedef struct getopt_tables {
    char letters[2 * ROW_COUNT + 2];
    struct option names[ROW_COUNT + 1];
} getopt_tables;

static int argument_need(value_kind kind)
{
    if (kind == VALUE_LIST) return optional_argument;
    return kind == VALUE_SET ? no_argument : required_argument;
}

/* Long options answer with FIRST_LONG + row, so that the row is at hand. */
static void fill_tables(getopt_tables *tables)
{
    memset(tables, 0, sizeof *tables);
    char *letter = tables->letters;
    *letter++ = ':'; /* a missing argument answers ':' instead of '?' */
    for (size_t i = 0; i < ROW_COUNT; i++) {
        tables->names[i].name = rows[i].name;
        tables->names[i].has_arg = argument_need(rows[i].kind);
        tables->names[i].val = FIRST_LONG + (int)i;
        if (!rows[i].letter) continue;
        *letter++ = rows[i].letter;
        if (rows[i].kind != VALUE_SET) *letter++ = ':';
    }
}

static const option_row *find_row(int answer)
{
    if (answer >= FIRST_LONG) return &rows[answer - FIRST_LONG];
    for (size_t i = 0; i < ROW_COUNT; i++) {
        if (rows[i].letter && rows[i].letter == answer) return &rows[i];
    }
    return NULL;
}

/* What getopt_long could not take; word is the argument that it stands at. */
static int refuse(int answer, const char *word)
{
    const option_row *const row = find_row(optopt);
    if (answer == ':' && row) {
        fprintf(stderr, "ppm-render: error: --%s needs a value: %s\n", row->name, row->argument);
        return give_hint();
    }
    if (row && optopt >= FIRST_LONG) {
        fprintf(stderr, "ppm-render: error: --%s takes no value\n", row->name);
        return give_hint();
    }
    return optopt ? unknown_letter(optopt) : unknown_long(word);
}

/* The word that the long option just read stands in: the one before its value if that is a word
 * of its own. */
static const char *long_option_word(char **argv)
{
    return optarg && optarg == argv[optind - 1] ? argv[optind - 2] : argv[optind - 1];
}

static bool is_abbreviated(const char *word, const option_row *row)
{
    const size_t length = strcspn(word + 2, "=");
    return length != strlen(row->name);
}

static int parse_words(int argc, char **argv, cli_options *options)
{
    getopt_tables tables;
    fill_tables(&tables);
    opterr = 0;
    for (;;) {
        const int answer = getopt_long(argc, argv, tables.letters, tables.names, NULL);
        if (answer == -1) return EXIT_DONE;
        if (answer == '?' || answer == ':') return refuse(answer, argv[optind - 1]);
        const option_row *const row = find_row(answer);
        if (answer >= FIRST_LONG) {
            const char *const word = long_option_word(argv);
            if (is_abbreviated(word, row)) return unknown_long(word);
        }
        const int status = store(row, optarg, options);
        if (status != EXIT_DONE) return status;
        /* "ppm-render --help --size oops" is a call for help */
        if (options->action == ACTION_HELP || options->action == ACTION_VERSION) return EXIT_DONE;
    }
}

/* An option that would do nothing is a mistake. */
static int check_together(const cli_options *options)
{
    const bool has_sky = options->environment || options->sun.is_given;
    const bool has_frames = options->frames.is_given;
    const bool has_blur = has_frames && options->shutter.close > options->shutter.open;
    const struct {
        bool is_idle;
        const char *message;
    } rules[] = {
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
        {options->epochs > 0 && options->passes > 0, "--epochs and --passes both say when to stop"},
    };
    for (size_t i = 0; i < sizeof rules / sizeof rules[0]; i++) {
        if (!rules[i].is_idle) continue;
        fprintf(stderr, "ppm-render: error: %s\n", rules[i].message);
        return give_hint();
    }
    return EXIT_DONE;
}

/* "all" is a word, whatever the file calls its cameras and animations; those have numbers, too. */
static void take_all(cli_options *options)
{
    if (options->camera && strcmp(options->camera, "all") == 0) {
        options->all_cameras = true;
        options->camera = NULL;
    }
    if (options->animation && strcmp(options->animation, "all") == 0) options->animation = NULL;
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
        fputs("ppm-render: error: no INPUT file\n", stderr);
        return give_hint();
    }
    if (optind + 1 < argc) {
        const char *const first = argv[optind], *const second = argv[optind + 1];
        fprintf(stderr, "ppm-render: error: one INPUT at a time; besides '%s' there is '%s'\n",
                first, second);
        if (options->list && strcmp(first, "json") == 0) {
            fputs("For JSON write --list=json.\n", stderr);
        }
        return give_hint();
    }
    options->input = argv[optind];
    return EXIT_DONE;
}

int cli_options_parse(int argc, char **argv, cli_options *out_options)
{
    memset(out_options, 0, sizeof *out_options);
    out_options->outputs = calloc((size_t)argc + 1, sizeof *out_options->outputs);
    if (!out_options->outputs) {
        fputs("ppm-render: error: out of memory\n", stderr);
        return EXIT_RESOURCES;
    }
    int status = parse_words(argc, argv, out_options);
    const int32_t action = out_options->action;
    const bool needs_input = action == ACTION_RENDER || action == ACTION_LIST;
    if (status != EXIT_DONE || !needs_input) return status;
    status = take_input(argc, argv, out_options);
    if (status == EXIT_DONE) status = check_together(out_options);
    take_all(out_options);
    fill_defaults(out_options);
    return status;
}

void cli_options_deinit(cli_options *options)
{
    free(options->outputs);
    options->outputs = NULL;
}
