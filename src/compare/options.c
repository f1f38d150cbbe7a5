/* One table describes every option, as in ppm-render (cli/options.c): parsing, checking, help and
 * suggestions come from it. Long options are written out in full. */
#include "compare/options.h"

#include <getopt.h>
#include <stddef.h>
#include <string.h>

#include "base/suggest.h"
#include "cli/values.h"

typedef enum value_kind {
    VALUE_SET,    /* no argument: stores .set in an int32_t */
    VALUE_TEXT,   /* const char * */
    VALUE_REAL,   /* real_option */
    VALUE_CHOICE, /* int32_t, the place in .choices */
    VALUE_LIMIT   /* one of the limits, NAME=VALUE */
} value_kind;

typedef struct option_row {
    const char *name;
    char letter; /* 0: none */
    value_kind kind;
    size_t field; /* offset in compare_options */
    int32_t set;
    double low, high;           /* REAL */
    const char *const *choices; /* CHOICE, ended by NULL */
    const char *argument;       /* as the help shows it */
    const char *help;           /* lines separated by \n */
    const char *group;          /* a heading, where a group begins */
} option_row;

const char *const limit_names[LIMIT_COUNT] = {"mse", "relmse", "flip", "broken"};
static const char *const heat_names[] = {"flip", "relative", "squared", NULL};

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

    {"heat", 0, VALUE_TEXT, FIELD(heat), .argument = "FILE", .group = "Heat map",
     .help = "write where the errors are: .png .jpg .tif in colours, black for\n"
             "none, pale yellow for large; .exr as numbers"},
    {"heat-of", 0, VALUE_CHOICE, FIELD(heat_of), .choices = heat_names, .argument = "NAME",
     .help = "flip, relative, squared (default: flip)"},
    {"heat-top", 0, VALUE_REAL, FIELD(heat_top), .low = 1e-30, .high = 1e30, .argument = "X",
     .help = "the error that gets the brightest colour (default: 1 for flip, else\n"
             "what 99 of 100 pixels stay below)"},

    {"json", 0, VALUE_SET, FIELD(json), .set = 1, .group = "Use in scripts",
     .help = "print the numbers as JSON"},
    {"fail-above", 0, VALUE_LIMIT, .argument = "METRIC=X",
     .help = "end with status 5 if METRIC is above X; may be repeated. METRIC is\n"
             "mse, relmse, flip or broken (pixels that are no numbers)"},
    {"version", 0, VALUE_SET, FIELD(action), .set = ACTION_VERSION, .help = "show it, and end"},
    {"help", 'h', VALUE_SET, FIELD(action), .set = ACTION_HELP, .help = "show this, and end"},
};
#undef FIELD
enum { ROW_COUNT = sizeof rows / sizeof rows[0], FIRST_LONG = 256 };

/* ---- help ------------------------------------------------------------------------------------ */

static void print_row(FILE *stream, const option_row *row)
{
    enum { HELP_COLUMN = 28 };
    char letter[5] = "    ";
    if (row->letter) snprintf(letter, sizeof letter, "-%c, ", row->letter);
    int column = fprintf(stream, "  %s--%s%s%s", letter, row->name, row->argument ? " " : "",
                         row->argument ? row->argument : "");
    for (const char *line = row->help; line;) {
        const size_t length = strcspn(line, "\n");
        fprintf(stream, "%*s%.*s\n", column < HELP_COLUMN ? HELP_COLUMN - column : 1, "",
                (int)length, line);
        line = line[length] ? line + length + 1 : NULL;
        column = 0;
    }
}

void compare_options_print_help(FILE *stream)
{
    fputs("Usage: ppm-compare [options] TEST REFERENCE\n"
          "Says how far the picture TEST is from REFERENCE: MSE, relative MSE, PSNR and FLIP.\n"
          "Pictures are .exr .hdr .png .jpg .tif and others that ppm-render reads.\n",
          stream);
    for (size_t i = 0; i < ROW_COUNT; i++) {
        if (rows[i].group) fprintf(stream, "\n%s:\n", rows[i].group);
        print_row(stream, &rows[i]);
    }
    fputs("\nExamples: how noisy, where, and as a check in a script\n"
          "  ppm-compare --trim 0.001 noisy.exr converged.exr\n"
          "  ppm-compare --heat errors.png noisy.exr converged.exr\n"
          "  ppm-compare --fail-above flip=0.05 --fail-above broken=0 new.exr old.exr\n"
          "\nExit status: 0 compared (also when the pictures differ), 1 wrong usage, 2 input not\n"
          "usable, 3 heat map not writable, 4 out of resources, 5 above a limit.\n",
          stream);
}

/* ---- complaints ------------------------------------------------------------------------------ */

static int give_hint(void)
{
    fputs("Try 'ppm-compare --help'.\n", stderr);
    return EXIT_USAGE;
}

/* expected completes "'value' is not ..." */
static int complain(const option_row *row, const char *value, const char *expected)
{
    fprintf(stderr, "ppm-compare: error: --%s: '%s' is not %s\n", row->name, value, expected);
    return give_hint();
}

static int unknown_option(const char *word)
{
    const char *names[ROW_COUNT];
    for (size_t i = 0; i < ROW_COUNT; i++)
        names[i] = rows[i].name;
    char name[64];
    snprintf(name, sizeof name, "%.*s", (int)strcspn(word + 2, "="), word + 2);
    const char *const nearest = ppmi_suggest(name, names, ROW_COUNT);
    fprintf(stderr, "ppm-compare: error: unknown option '--%s'", name);
    if (nearest) fprintf(stderr, "; did you mean '--%s'?", nearest);
    fputc('\n', stderr);
    return give_hint();
}

/* "'value' is not one of a, b, c; did you mean 'b'?" */
static int complain_of_name(const option_row *row, const char *value, const char *name,
                            const char *const *names, size_t count)
{
    fprintf(stderr, "ppm-compare: error: --%s: '%s' is not one of", row->name, value);
    for (size_t i = 0; i < count; i++)
        fprintf(stderr, "%s %s", i ? "," : "", names[i]);
    const char *const nearest = ppmi_suggest(name, names, count);
    if (nearest) fprintf(stderr, "; did you mean '%s'?", nearest);
    fputc('\n', stderr);
    return give_hint();
}

/* ---- values ---------------------------------------------------------------------------------- */

static int store_real(const option_row *row, const char *text, real_option *field)
{
    double value = 0;
    if (!value_parse_real(text, &value) || value < row->low || value > row->high) {
        char expected[80];
        snprintf(expected, sizeof expected, "a number from %g to %g", row->low, row->high);
        return complain(row, text, expected);
    }
    *field = (real_option){true, value};
    return EXIT_DONE;
}

static int store_choice(const option_row *row, const char *text, int32_t *field)
{
    size_t count = 0;
    for (; row->choices[count]; count++) {
        if (strcmp(row->choices[count], text) != 0) continue;
        *field = (int32_t)count;
        return EXIT_DONE;
    }
    return complain_of_name(row, text, text, row->choices, count);
}

static int store_limit(const option_row *row, const char *text, real_option *limits)
{
    const size_t length = strcspn(text, "=");
    char name[32];
    snprintf(name, sizeof name, "%.*s", (int)length, text);
    if (strcmp(name, "psnr") == 0) {
        return complain(row, text, "a limit: PSNR falls as the error grows; take mse");
    }
    for (size_t i = 0; i < LIMIT_COUNT; i++) {
        if (strcmp(limit_names[i], name) != 0) continue;
        double value = 0;
        if (text[length] != '=' || !value_parse_real(text + length + 1, &value) || value < 0) {
            return complain(row, text, "like flip=0.05, with a number from 0 on");
        }
        limits[i] = (real_option){true, value};
        return EXIT_DONE;
    }
    return complain_of_name(row, text, name, limit_names, LIMIT_COUNT);
}

static int store(const option_row *row, const char *text, compare_options *options)
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
    case VALUE_REAL:
        return store_real(row, text, field);
    case VALUE_CHOICE:
        return store_choice(row, text, field);
    case VALUE_LIMIT:
        return store_limit(row, text, options->limits);
    }
    return EXIT_USAGE;
}

/* ---- parsing --------------------------------------------------------------------------------- */

/* Long options answer with FIRST_LONG + row. */
static void fill_names(struct option names[ROW_COUNT + 1])
{
    memset(names, 0, (ROW_COUNT + 1) * sizeof *names);
    for (size_t i = 0; i < ROW_COUNT; i++) {
        names[i].name = rows[i].name;
        names[i].has_arg = rows[i].kind == VALUE_SET ? no_argument : required_argument;
        names[i].val = FIRST_LONG + (int)i;
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
        fprintf(stderr, "ppm-compare: error: --%s needs a value: %s\n", row->name, row->argument);
        return give_hint();
    }
    if (row && optopt >= FIRST_LONG) {
        fprintf(stderr, "ppm-compare: error: --%s takes no value\n", row->name);
        return give_hint();
    }
    if (!optopt) return unknown_option(word);
    fprintf(stderr, "ppm-compare: error: unknown option '-%c'\n", optopt);
    return give_hint();
}

/* The word that the long option just read stands in: the one before its value if that is a word
 * of its own. */
static const char *long_option_word(char **argv)
{
    return optarg && optarg == argv[optind - 1] ? argv[optind - 2] : argv[optind - 1];
}

static int parse_words(int argc, char **argv, compare_options *options)
{
    struct option names[ROW_COUNT + 1];
    fill_names(names);
    opterr = 0;
    for (;;) {
        const int answer = getopt_long(argc, argv, ":h", names, NULL);
        if (answer == -1) return EXIT_DONE;
        if (answer == '?' || answer == ':') return refuse(answer, argv[optind - 1]);
        const option_row *const row = find_row(answer);
        if (answer >= FIRST_LONG) {
            const char *const word = long_option_word(argv);
            if (strcspn(word + 2, "=") != strlen(row->name)) return unknown_option(word);
        }
        const int status = store(row, optarg, options);
        if (status != EXIT_DONE || options->action != ACTION_COMPARE) return status;
    }
}

int compare_options_parse(int argc, char **argv, compare_options *out_options)
{
    memset(out_options, 0, sizeof *out_options);
    out_options->pixels_per_degree.value = 67;
    const int status = parse_words(argc, argv, out_options);
    if (status != EXIT_DONE || out_options->action != ACTION_COMPARE) return status;
    if (argc - optind != 2) {
        fprintf(stderr,
                "ppm-compare: error: two pictures are compared, TEST and REFERENCE; there %s %d\n",
                argc - optind == 1 ? "is" : "are", argc - optind);
        return give_hint();
    }
    out_options->test = argv[optind];
    out_options->reference = argv[optind + 1];
    if (!out_options->heat && (out_options->heat_top.is_given || out_options->heat_of)) {
        fputs("ppm-compare: error: --heat-of and --heat-top need --heat FILE\n", stderr);
        return give_hint();
    }
    return EXIT_DONE;
}
