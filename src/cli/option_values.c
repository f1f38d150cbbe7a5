/* Each value is checked whole, and refused with what was expected. */
#include "option_values.h"

#include <stdbool.h>
#include <stdio.h>
#include <string.h>

#include "layer_values.h"
#include "options.h"
#include "ppm/ppm.h"
#include "values.h"

static int store_size(const option_table *table, const option_row *row, const char *text,
                      image_size *field)
{
    image_size size = {0, 0};
    if (!value_parse_size(text, &size.width, &size.height)) {
        return option_complain(table, row, text, "a size like 1280x720");
    }
    if (size.width < row->least || size.width > row->most || size.height < row->least ||
        size.height > row->most) {
        char expected[80];
        snprintf(expected, sizeof expected, "a size whose sides are from %llu to %llu",
                 (unsigned long long)row->least, (unsigned long long)row->most);
        return option_complain(table, row, text, expected);
    }
    *field = size;
    return EXIT_DONE;
}

static int store_fog(const option_table *table, const option_row *row, const char *text,
                     fog_values *field)
{
    double values[3] = {0.0, 0.0, 0.0};
    size_t count = 0;
    if (!value_parse_reals(text, 3, values, &count) || count < 2 || values[0] < 0.0 ||
        values[1] < 0.0 || values[0] > 1e9 || values[1] > 1e9 ||
        !(values[2] > -1.0 && values[2] < 1.0)) {
        return option_complain(table, row, text,
                               "like 0.1,0.01 or 0.1,0.01,0.5: two coefficients of at least 0 and "
                               "a number between -1 and 1");
    }
    *field = (fog_values){values[0], values[1], values[2], true};
    return EXIT_DONE;
}

static int store_split(const option_table *table, const option_row *row, const char *text,
                       int32_t *field)
{
    uint64_t value = 0;
    const int status = option_store_integer(table, row, text, &value);
    if (status == EXIT_DONE) *field = value == 0 ? -1 : (int32_t)value;
    return status;
}

static int store_sun(const option_table *table, const option_row *row, const char *text,
                     sun_choice *field)
{
    double values[3] = {0.0, 0.0, 0.0};
    size_t count = 0;
    if (!value_parse_reals(text, 3, values, &count) || count < 2) {
        return option_complain(table, row, text,
                               "ELEVATION,AZIMUTH[,TURBIDITY] like 35,160 or 35,160,3");
    }
    if (values[0] < 0.0 || values[0] > 90.0) {
        return option_complain(table, row, text, "a sun with an elevation from 0 to 90 degrees");
    }
    if (values[1] < -360.0 || values[1] > 360.0) {
        return option_complain(table, row, text, "a sun with an azimuth from -360 to 360 degrees");
    }
    if (count == 3 && !(values[2] >= 2.0 && values[2] <= 10.0)) {
        return option_complain(table, row, text, "a sun with a turbidity from 2 to 10");
    }
    *field = (sun_choice){.is_given = 1,
                          .elevation_deg = values[0],
                          .azimuth_deg = values[1],
                          .turbidity = values[2]};
    return EXIT_DONE;
}

static int store_background(const option_table *table, const option_row *row, const char *text,
                            background_choice *field)
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
        return option_complain(table, row, text,
                               "env, black, or a radiance from 0 to 1e+09: 0.5 or 0.1,0.2,0.3");
    }
    *field = (background_choice){.kind = BACKGROUND_RADIANCE,
                                 .radiance = {(float)rgb[0], (float)rgb[1], (float)rgb[2]}};
    return EXIT_DONE;
}

static int store_shutter(const option_table *table, const option_row *row, const char *text,
                         shutter_times *field)
{
    double times[2] = {0.0, 0.0};
    size_t count = 0;
    if (!value_parse_reals(text, 2, times, &count) || count != 2 || times[0] > times[1] ||
        times[0] < -1e6 || times[1] > 1e6) {
        return option_complain(table, row, text,
                               "two numbers of frames like -0.25,0.25, the smaller first");
    }
    *field = (shutter_times){times[0], times[1]};
    return EXIT_DONE;
}

/* A rate: of film and video also as the fraction that it is, since 23.976 is not 24000/1001. */
static int store_rate(const option_table *table, const option_row *row, const char *text,
                      double *field)
{
    enum { LETTERS_MAX = 64 };
    const char *const slash = strchr(text, '/');
    char above[LETTERS_MAX];
    double value = 0.0, below = 1.0;
    if (!slash) return option_store_real(table, row, text, field);
    const size_t length = (size_t)(slash - text);
    if (length < sizeof above) {
        memcpy(above, text, length);
        above[length] = '\0';
    }
    if (length >= sizeof above || !value_parse_real(above, &value) ||
        !value_parse_real(slash + 1, &below) || !(below > 0.0) || !(value / below >= row->low) ||
        value / below > row->high) {
        return option_complain(table, row, text, "a rate like 24, 23.976 or 24000/1001");
    }
    *field = value / below;
    return EXIT_DONE;
}

/* Pixels are whole numbers; shares of the picture all have a decimal point. */
static int store_crop(const option_table *table, const option_row *row, const char *text,
                      crop_window *field)
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
        return option_complain(table, row, text, expected);
    const double *const sides = crop.sides, most = crop.is_in_shares ? 1.0 : 65536.0;
    if (sides[0] < 0.0 || sides[1] < 0.0 || sides[2] > most || sides[3] > most ||
        sides[0] >= sides[2] || sides[1] >= sides[3]) {
        return option_complain(table, row, text, expected);
    }
    *field = crop;
    return EXIT_DONE;
}

static int store_filter(const option_table *table, const option_row *row, const char *text,
                        filter_choice *field)
{
    filter_choice filter = {0};
    const size_t length = strcspn(text, ",");
    const int status = option_store_choice(table, row, text, length, &filter.kind);
    if (status != EXIT_DONE) return status;
    if (text[length] == ',') {
        const bool is_number = value_parse_real(text + length + 1, &filter.width);
        if (!is_number || filter.width < row->low || filter.width > row->high) {
            return option_complain(table, row, text,
                                   "a filter with a width from 0.001 to 100 pixels");
        }
    }
    *field = filter;
    return EXIT_DONE;
}

/* The later of --frame and --frames would win without a word; both being there is found by kind. */
static int store_frames(const option_table *table, const option_row *row, const char *text,
                        frame_choice *field)
{
    frame_choice frames = {.is_given = true, .is_range = row->kind == VALUE_FRAMES};
    if (field->is_given && field->is_range != frames.is_range) {
        return option_complain_of_all(table, "--frame and --frames both say what to render");
    }
    if (frames.is_range) {
        if (!frames_parse(text, &frames.range)) {
            return option_complain(
                table, row, text,
                "frames like 1-24 or 1-24/2: whole numbers, at most a million of them");
        }
    } else {
        if (!frames_parse_one(text, &frames.range.first)) {
            return option_complain(table, row, text,
                                   "a whole number of at most 10000000, which may be below 0");
        }
        frames.range.last = frames.range.first;
        frames.range.step = 1;
    }
    *field = frames;
    return EXIT_DONE;
}

static int store_list(const option_table *table, const option_row *row, const char *text,
                      cli_options *options)
{
    options->action = ACTION_LIST;
    options->list = LIST_TABLE;
    return text ? option_store_choice(table, row, text, strlen(text), &options->list) : EXIT_DONE;
}

/* A pattern may hold a =, the name of a space hardly. The text before it is cut off in a copy. */
static int store_texture_space(const option_table *table, const option_row *row, const char *text,
                               cli_options *options)
{
    const char *const equals = strrchr(text, '=');
    if (!equals || equals == text || equals[1] == '\0') {
        return option_complain(table, row, text, "like '*_p3.png=Display P3': PATTERN=SPACE");
    }
    char *const pattern = strndup(text, (size_t)(equals - text));
    if (!pattern) {
        fputs("ppm-render: error: out of memory\n", stderr);
        return EXIT_RESOURCES;
    }
    options->texture_spaces[options->texture_space_count++] =
        (ppm_texture_space){.pattern = pattern, .space = equals + 1};
    return EXIT_DONE;
}

/* outputs, texture_folders and texture_spaces have room for one entry per word of argv, so
 * appending never allocates. */
int option_store_own(const option_table *table, const option_row *row, const char *text,
                     void *options)
{
    cli_options *const all = options;
    void *const field = (char *)options + row->field;
    switch (row->kind) {
    case VALUE_OUTPUT:
        all->outputs[all->output_count++] = text;
        return EXIT_DONE;
    case VALUE_CATCHER:
        all->catchers[all->catcher_count++] = text;
        return EXIT_DONE;
    case VALUE_TEXTURE_FOLDER:
        all->texture_folders[all->texture_folder_count++] = text;
        return EXIT_DONE;
    case VALUE_SIZE:
        return store_size(table, row, text, field);
    case VALUE_FOG:
        return store_fog(table, row, text, field);
    case VALUE_SPLIT:
        return store_split(table, row, text, field);
    case VALUE_SUN:
        return store_sun(table, row, text, field);
    case VALUE_BACKGROUND:
        return store_background(table, row, text, field);
    case VALUE_SHUTTER:
        return store_shutter(table, row, text, field);
    case VALUE_RATE:
        return store_rate(table, row, text, field);
    case VALUE_CROP:
        return store_crop(table, row, text, field);
    case VALUE_FILTER:
        return store_filter(table, row, text, field);
    case VALUE_FRAME:
    case VALUE_FRAMES:
        return store_frames(table, row, text, field);
    case VALUE_TEXTURE_SPACE:
        return store_texture_space(table, row, text, all);
    case VALUE_LIST:
        return store_list(table, row, text, all);
    case VALUE_LAYERS:
    case VALUE_GROUPS:
    case VALUE_PACKING:
    case VALUE_TILES:
    case VALUE_RANKS:
        return option_store_layer_value(table, row, text, field);
    }
    return EXIT_USAGE;
}
