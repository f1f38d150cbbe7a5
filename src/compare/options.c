/* The options of ppm-compare: their table, what they mean together, and defaults. */
#include "compare/options.h"

#include <getopt.h>
#include <stddef.h>
#include <string.h>

#include "cli/option_table.h"
#include "cli/values.h"

enum {
    VALUE_REAL = OPTION_OWN, /* real_option */
    VALUE_LIMIT              /* one of the limits, NAME=VALUE */
};

const char *const limit_names[LIMIT_COUNT] = {"mse", "relmse", "flip", "broken"};
static const option_choice limits[] = {{"mse", LIMIT_MSE},
                                       {"relmse", LIMIT_RELATIVE_MSE},
                                       {"flip", LIMIT_FLIP},
                                       {"broken", LIMIT_BROKEN},
                                       {NULL, 0}};
static const option_choice heats[] = {
    {"flip", HEAT_FLIP}, {"relative", HEAT_RELATIVE}, {"squared", HEAT_SQUARED}, {NULL, 0}};

#define FIELD(member) .field = offsetof(compare_options, member)
static const option_row rows[] = {
    {"trim", 0, VALUE_REAL, FIELD(trim), .low = 0, .high = 0.999, .argument = "F",
     .group = "Numbers",
     .help = "leave that share of the pixels, the worst by relative error, out\n"
             "of MSE, relative MSE and PSNR: 0.001 is one in a thousand"},
    {"peak", 0, VALUE_REAL, FIELD(peak), .low = 1e-30, .high = 1e30, .argument = "X",
     .help = "of PSNR (default: the largest value of REFERENCE if the pictures\n"
             "hold light, 1 if they are for a display)"},
    {"ppd", 0, VALUE_REAL, FIELD(pixels_per_degree), .low = 1, .high = 1000, .argument = "N",
     .help = "pixels per degree that FLIP's observer sees (default: 67, a 4K\n"
             "display 0.7 m wide from 0.7 m)"},
    {"exposure", 0, VALUE_REAL, FIELD(exposure_ev), .low = -64, .high = 64, .argument = "EV",
     .help = "FLIP at this exposure only, clamped to the display's range\n"
             "(default: HDR-FLIP, all exposures that show something of REFERENCE;\n"
             "for .png .jpg .tif 0)"},

    {"heat", 0, OPTION_TEXT, FIELD(heat), .argument = "FILE", .group = "Heat map",
     .help = "write where the errors are: .png .jpg .tif in colours, black for\n"
             "none, pale yellow for large; .exr as numbers"},
    {"heat-of", 0, OPTION_CHOICE, FIELD(heat_of), .choices = heats, .argument = "NAME",
     .help = "flip, relative, squared (default: flip)"},
    {"heat-top", 0, VALUE_REAL, FIELD(heat_top), .low = 1e-30, .high = 1e30, .argument = "X",
     .help = "the error that gets the brightest colour (default: 1 for flip, else\n"
             "what 99 of 100 pixels stay below)"},

    {"json", 0, OPTION_SET, FIELD(json), .set = 1, .group = "Use in scripts",
     .help = "print the numbers as JSON"},
    {"fail-above", 0, VALUE_LIMIT, FIELD(limits), .choices = limits, .argument = "METRIC=X",
     .help = "end with status 5 if METRIC is above X; may be repeated. METRIC is\n"
             "mse, relmse, flip or broken (pixels that are no numbers)"},
    {"version", 0, OPTION_SET, FIELD(action), .set = ACTION_VERSION, .help = "show it, and end"},
    {"help", 'h', OPTION_SET, FIELD(action), .set = ACTION_HELP, .help = "show this, and end"},
};
#undef FIELD

/* ---- values ---------------------------------------------------------------------------------- */

static int store_real(const option_table *table, const option_row *row, const char *text,
                      real_option *field)
{
    real_option real = {.is_given = true};
    const int status = option_store_real(table, row, text, &real.value);
    if (status == EXIT_DONE) *field = real;
    return status;
}

static int store_limit(const option_table *table, const option_row *row, const char *text,
                       real_option *fields)
{
    const size_t length = strcspn(text, "=");
    if (length == 4 && strncmp(text, "psnr", length) == 0) {
        return option_complain(table, row, text,
                               "a limit: PSNR falls as the error grows; take mse");
    }
    int32_t limit = 0;
    const int status = option_store_choice(table, row, text, length, &limit);
    if (status != EXIT_DONE) return status;
    double value = 0;
    if (text[length] != '=' || !value_parse_real(text + length + 1, &value) || value < 0) {
        return option_complain(table, row, text, "like flip=0.05, with a number from 0 on");
    }
    fields[limit] = (real_option){true, value};
    return EXIT_DONE;
}

static int store_own(const option_table *table, const option_row *row, const char *text,
                     void *options)
{
    void *const field = (char *)options + row->field;
    return row->kind == VALUE_LIMIT ? store_limit(table, row, text, field)
                                    : store_real(table, row, text, field);
}

/* ---- parsing --------------------------------------------------------------------------------- */

static bool is_settled(const void *options)
{
    return ((const compare_options *)options)->action != ACTION_COMPARE;
}

static const option_table table = {.program = "ppm-compare",
                                   .help_column = 28,
                                   .rows = rows,
                                   .count = sizeof rows / sizeof rows[0],
                                   .store_own = store_own,
                                   .is_settled = is_settled};

void compare_options_print_help(FILE *stream)
{
    fputs("Usage: ppm-compare [options] TEST REFERENCE\n"
          "Says how far the picture TEST is from REFERENCE: MSE, relative MSE, PSNR, FLIP.\n"
          "Pictures are .exr .hdr .png .jpg .tif and others that ppm-render reads.\n",
          stream);
    option_table_print_help(&table, stream);
    fputs("\nExamples: how noisy, where, and as a check in a script\n"
          "  ppm-compare --trim 0.001 noisy.exr converged.exr\n"
          "  ppm-compare --heat errors.png noisy.exr converged.exr\n"
          "  ppm-compare --fail-above flip=0.05 --fail-above broken=0 new.exr old.exr\n"
          "\nExit status: 0 compared (also when the pictures differ), 1 wrong usage, 2 input\n"
          "not usable, 3 heat map not writable, 4 out of resources, 5 above a limit.\n",
          stream);
}

int compare_options_parse(int argc, char **argv, compare_options *out_options)
{
    memset(out_options, 0, sizeof *out_options);
    out_options->pixels_per_degree.value = 67;
    const int status = option_table_parse(&table, argc, argv, out_options);
    if (status != EXIT_DONE || out_options->action != ACTION_COMPARE) return status;
    if (argc - optind != 2) {
        fprintf(stderr,
                "ppm-compare: error: two pictures are compared, TEST and REFERENCE; there %s %d\n",
                argc - optind == 1 ? "is" : "are", argc - optind);
        return option_give_hint(&table);
    }
    out_options->test = argv[optind];
    out_options->reference = argv[optind + 1];
    if (!out_options->heat && (out_options->heat_top.is_given || out_options->heat_of)) {
        return option_complain_of_all(&table, "--heat-of and --heat-top need --heat FILE");
    }
    return EXIT_DONE;
}
