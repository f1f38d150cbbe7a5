/* The options of ppm-merge: their table, and what they mean together. */
#include "merge/options.h"

#include <getopt.h>
#include <string.h>
#include <strings.h>

#include "cli/option_table.h"

static const option_choice depths[] = {{"half", 1}, {"float", 0}, {NULL, 0}};
static const option_choice packings[] = {{"zips", 0}, {"zip", 1},  {"piz", 2},
                                         {"rle", 3},  {"none", 4}, {NULL, 0}};

#define FIELD(member) .field = offsetof(merge_options, member)
static const option_row rows[] = {
    {"output", 'o', OPTION_TEXT, FIELD(output), .argument = "FILE.exr", .group = "The merged file",
     .help = "where to write it"},
    {"depth", 0, OPTION_CHOICE, FIELD(is_half), .choices = depths, .argument = "BITS",
     .help = "half, float; ids and distances are float always (default: float)"},
    {"exr-compression", 0, OPTION_CHOICE, FIELD(packing), .choices = packings, .argument = "NAME",
     .help = "zips, zip, piz, rle, none (default: zips)"},

    {"quiet", 'q', OPTION_SET, FIELD(is_quiet), .set = 1, .group = "Messages",
     .help = "errors only"},
    {"version", 0, OPTION_SET, FIELD(action), .set = MERGE_ACTION_VERSION,
     .help = "show it, and end"},
    {"help", 'h', OPTION_SET, FIELD(action), .set = MERGE_ACTION_HELP,
     .help = "show this, and end"},
};
#undef FIELD

static bool is_settled(const void *options)
{
    return ((const merge_options *)options)->action != MERGE_ACTION_MERGE;
}

/* There are no values of its own kinds. */
static int store_own(const option_table *table, const option_row *row, const char *text,
                     void *options)
{
    (void)options;
    return option_complain(table, row, text, "known");
}

static const option_table table = {.program = "ppm-merge",
                                   .help_column = 28,
                                   .rows = rows,
                                   .count = sizeof rows / sizeof rows[0],
                                   .store_own = store_own,
                                   .is_settled = is_settled};

void merge_options_print_help(FILE *stream)
{
    fputs("Usage: ppm-merge [options] -o ALL.exr A.exr B.exr ...\n"
          "Makes one picture of several that ppm-render made of the same scene with\n"
          "different seeds: all layers, weighted by photons or passes.\n",
          stream);
    option_table_print_help(&table, stream);
    fputs("\nExample: two machines, then one picture\n"
          "  ppm-render --seed 1 -o a.exr hall.glb\n"
          "  ppm-render --seed 2 -o b.exr hall.glb\n"
          "  ppm-merge -o hall.exr a.exr b.exr\n"
          "\nExit status: 0 done, 1 wrong usage, 2 input not usable (files that do not belong\n"
          "together, too), 3 output not writable, 4 out of resources.\n",
          stream);
}

static int check(merge_options *options)
{
    static const char *const names[] = {"zips", "zip", "piz", "rle", "none"};
    const size_t length = options->output ? strlen(options->output) : 0;
    char message[80];
    if (!options->output) return option_complain_of_all(&table, "no output; give -o FILE.exr");
    if (length < 4 || strcasecmp(options->output + length - 4, ".exr") != 0) {
        return option_complain(&table, &rows[0], options->output, "an .exr file");
    }
    if (options->input_count < 2) {
        snprintf(message, sizeof message, "two or more files are merged; there %s %zu",
                 options->input_count == 1 ? "is" : "are", options->input_count);
        return option_complain_of_all(&table, message);
    }
    options->compression = names[options->packing];
    return EXIT_DONE;
}

int merge_options_parse(int argc, char **argv, merge_options *out_options)
{
    *out_options = (merge_options){0};
    const int status = option_table_parse(&table, argc, argv, out_options);
    if (status != EXIT_DONE || is_settled(out_options)) return status;
    out_options->inputs = argv + optind;
    out_options->input_count = (size_t)(argc - optind);
    return check(out_options);
}
