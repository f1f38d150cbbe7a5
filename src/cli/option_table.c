/* getopt_long does the splitting. Its habit of taking any unambiguous beginning of a name is
 * refused: a script that relies on "--exp" would break on the day that a second such name comes. */
#include "option_table.h"

#include <getopt.h>
#include <stdlib.h>
#include <string.h>

#include "base/printable.h"
#include "base/suggest.h"
#include "values.h"

enum { FIRST_LONG = 256 }; /* long options answer with this plus their row */

/* ---- help ------------------------------------------------------------------------------------ */

enum { HELP_WIDTH = 80 };

/* Words up to HELP_WIDTH columns, from column on, in lines that begin at margin. */
static void print_words(const char *text, int column, int margin, FILE *stream)
{
    fprintf(stream, "%*s", margin - column, "");
    column = margin;
    while (*text) {
        const int length = (int)strcspn(text, " \n");
        const bool is_first = column == margin;
        if (!is_first && column + 1 + length > HELP_WIDTH) {
            fprintf(stream, "\n%*s", margin, "");
            column = margin;
        } else if (!is_first) {
            fputc(' ', stream);
            column++;
        }
        column += fprintf(stream, "%.*s", length, text);
        text += length;
        const size_t gap = strspn(text, " \n");
        if (strncmp(text, "\n\n", 2) == 0) column = HELP_WIDTH; /* whatever follows */
        text += gap;
    }
    fputc('\n', stream);
}

static void print_row(const option_table *table, const option_row *row, FILE *stream)
{
    char letter[5] = "    ";
    const bool has_space = row->argument && !row->may_lack_value;
    if (row->letter) snprintf(letter, sizeof letter, "-%c, ", row->letter);
    int column = fprintf(stream, "  %s--%s%s%s", letter, row->name, has_space ? " " : "",
                         row->argument ? row->argument : "");
    if (column >= table->help_column) {
        fputc('\n', stream);
        column = 0;
    }
    print_words(row->help, column, table->help_column, stream);
}

void option_table_print_help(const option_table *table, FILE *stream)
{
    for (size_t i = 0; i < table->count; i++) {
        if (table->rows[i].group) fprintf(stream, "\n%s:\n", table->rows[i].group);
        print_row(table, &table->rows[i], stream);
    }
}

/* ---- complaints ------------------------------------------------------------------------------ */

int option_give_hint(const option_table *table)
{
    if (table->source) return EXIT_INPUT;
    ppmi_print(stderr, "Try '%s --help'.\n", table->program);
    return EXIT_USAGE;
}

/* "program: error: --name: ", or the place in a setup file. */
static void begin_complaint(const option_table *table, const option_row *row)
{
    if (table->source) {
        ppmi_print(stderr, "%s: error: %s: render.%s: ", table->program, table->source, row->name);
    } else {
        ppmi_print(stderr, "%s: error: --%s: ", table->program, row->name);
    }
}

int option_complain_of_all(const option_table *table, const char *message)
{
    ppmi_print(stderr, "%s: error: %s%s%s\n", table->program, table->source ? table->source : "",
               table->source ? ": " : "", message);
    return option_give_hint(table);
}

int option_complain(const option_table *table, const option_row *row, const char *value,
                    const char *expected)
{
    begin_complaint(table, row);
    ppmi_print(stderr, "'%s' is not %s\n", value, expected);
    return option_give_hint(table);
}

static void suggest(const char *nearest, const char *dashes)
{
    if (nearest) ppmi_print(stderr, "; did you mean '%s%s'?", dashes, nearest);
    fputc('\n', stderr);
}

/* name is what stands there; it is shown behind dashes, or in a setup file without. */
static int unknown_name(const option_table *table, const char *name)
{
    const char *const dashes = table->source ? "" : "--";
    const char **const names = calloc(table->count, sizeof *names);
    if (!names) return EXIT_RESOURCES;
    for (size_t i = 0; i < table->count; i++)
        names[i] = table->rows[i].name;
    ppmi_print(stderr, "%s: error: %s%sunknown option '%s%s'", table->program,
               table->source ? table->source : "", table->source ? ": render: " : "", dashes, name);
    suggest(ppmi_suggest(name, names, table->count), dashes);
    free(names);
    return option_give_hint(table);
}

static int unknown_long(const option_table *table, const char *word)
{
    char name[64];
    snprintf(name, sizeof name, "%.*s", (int)strcspn(word + 2, "="), word + 2);
    return unknown_name(table, name);
}

static int unknown_letter(const option_table *table, int letter)
{
    const int other_case = letter ^ ('a' ^ 'A');
    ppmi_print(stderr, "%s: error: unknown option '-%c'", table->program, letter);
    for (size_t i = 0; i < table->count; i++) {
        if (table->rows[i].letter && table->rows[i].letter == other_case) {
            ppmi_print(stderr, "; did you mean '-%c' (--%s)?", other_case, table->rows[i].name);
        }
    }
    fputc('\n', stderr);
    return option_give_hint(table);
}

/* ---- values ---------------------------------------------------------------------------------- */

int option_store_integer(const option_table *table, const option_row *row, const char *text,
                         uint64_t *field)
{
    uint64_t value = 0;
    const bool is_number = row->kind == OPTION_COUNT ? value_parse_count(text, &value)
                                                     : value_parse_integer(text, &value);
    if (!is_number || value < row->least || value > row->most) {
        char expected[80];
        snprintf(expected, sizeof expected, "a whole number from %llu to %llu",
                 (unsigned long long)row->least, (unsigned long long)row->most);
        return option_complain(table, row, text, expected);
    }
    *field = value;
    return EXIT_DONE;
}

int option_store_real(const option_table *table, const option_row *row, const char *text,
                      double *field)
{
    double value = 0.0;
    if (!value_parse_real(text, &value) || value < row->low || value > row->high) {
        char expected[80];
        snprintf(expected, sizeof expected, "a number from %g to %g", row->low, row->high);
        return option_complain(table, row, text, expected);
    }
    *field = value;
    return EXIT_DONE;
}

int option_store_choice(const option_table *table, const option_row *row, const char *text,
                        size_t length, int32_t *field)
{
    enum { CHOICES_MAX = 16 };
    const char *names[CHOICES_MAX];
    size_t count = 0;
    char name[64];
    snprintf(name, sizeof name, "%.*s", (int)length, text);
    for (const option_choice *each = row->choices; each->name && count < CHOICES_MAX; each++) {
        if (strcmp(each->name, name) == 0) {
            *field = each->value;
            return EXIT_DONE;
        }
        names[count++] = each->name;
    }
    begin_complaint(table, row);
    ppmi_print(stderr, "'%s' is not one of", name);
    for (size_t i = 0; i < count; i++)
        ppmi_print(stderr, "%s %s", i ? "," : "", names[i]);
    suggest(ppmi_suggest(name, names, count), "");
    return option_give_hint(table);
}

static int store(const option_table *table, const option_row *row, const char *text, void *options)
{
    void *const field = (char *)options + row->field;
    if (text && *text == '\0') return option_complain(table, row, text, "a value");
    switch (row->kind) {
    case OPTION_SET:
        *(int32_t *)field = row->set;
        return EXIT_DONE;
    case OPTION_TEXT:
        *(const char **)field = text;
        return EXIT_DONE;
    case OPTION_INTEGER:
    case OPTION_COUNT:
        return option_store_integer(table, row, text, field);
    case OPTION_REAL:
        return option_store_real(table, row, text, field);
    case OPTION_CHOICE:
        return option_store_choice(table, row, text, strlen(text), field);
    }
    return table->store_own(table, row, text, options);
}

int option_table_store(const option_table *table, const char *name, const char *value,
                       void *options)
{
    for (size_t i = 0; i < table->count; i++) {
        const option_row *const row = &table->rows[i];
        if (strcmp(row->name, name) != 0) continue;
        if (row->kind == OPTION_SET && *value) {
            return option_complain(table, row, value, "true or false");
        }
        return store(table, row, row->kind == OPTION_SET ? NULL : value, options);
    }
    return unknown_name(table, name);
}

/* ---- parsing --------------------------------------------------------------------------------- */

static int argument_need(const option_row *row)
{
    if (row->may_lack_value) return optional_argument;
    return row->kind == OPTION_SET ? no_argument : required_argument;
}

/* letters has room for ':' in front, and a letter and a colon for each row; names for one more. */
static void fill_tables(const option_table *table, char *letters, struct option *names)
{
    *letters++ = ':'; /* a missing argument answers ':' instead of '?' */
    for (size_t i = 0; i < table->count; i++) {
        const option_row *const row = &table->rows[i];
        names[i].name = row->name;
        names[i].has_arg = argument_need(row);
        names[i].val = FIRST_LONG + (int)i;
        if (!row->letter) continue;
        *letters++ = row->letter;
        if (row->kind != OPTION_SET) *letters++ = ':';
    }
}

static const option_row *find_row(const option_table *table, int answer)
{
    if (answer >= FIRST_LONG) return &table->rows[answer - FIRST_LONG];
    for (size_t i = 0; i < table->count; i++) {
        if (table->rows[i].letter && table->rows[i].letter == answer) return &table->rows[i];
    }
    return NULL;
}

/* What getopt_long could not take; word is the argument that it stands at. */
static int refuse(const option_table *table, int answer, const char *word)
{
    const option_row *const row = find_row(table, optopt);
    if (answer == ':' && row) {
        ppmi_print(stderr, "%s: error: --%s needs a value: %s\n", table->program, row->name,
                   row->argument);
        return option_give_hint(table);
    }
    if (row && optopt >= FIRST_LONG) {
        ppmi_print(stderr, "%s: error: --%s takes no value\n", table->program, row->name);
        return option_give_hint(table);
    }
    return optopt ? unknown_letter(table, optopt) : unknown_long(table, word);
}

/* The word that the long option just read stands in: the one before its value if that is a word
 * of its own. */
static const char *long_option_word(char **argv)
{
    return optarg && optarg == argv[optind - 1] ? argv[optind - 2] : argv[optind - 1];
}

static bool is_abbreviated(const char *word, const option_row *row)
{
    return strcspn(word + 2, "=") != strlen(row->name);
}

static int parse_words(const option_table *table, int argc, char **argv, const char *letters,
                       const struct option *names, void *options)
{
    opterr = 0;
    for (;;) {
        const int answer = getopt_long(argc, argv, letters, names, NULL);
        if (answer == -1) return EXIT_DONE;
        if (answer == '?' || answer == ':') return refuse(table, answer, argv[optind - 1]);
        const option_row *const row = find_row(table, answer);
        if (answer >= FIRST_LONG) {
            const char *const word = long_option_word(argv);
            if (is_abbreviated(word, row)) return unknown_long(table, word);
        }
        const int status = store(table, row, optarg, options);
        if (status != EXIT_DONE || table->is_settled(options)) return status;
    }
}

int option_table_parse(const option_table *table, int argc, char **argv, void *options)
{
    char *const letters = calloc(2 * table->count + 2, 1);
    struct option *const names = calloc(table->count + 1, sizeof *names);
    int status = EXIT_RESOURCES;
    if (letters && names) {
        fill_tables(table, letters, names);
        status = parse_words(table, argc, argv, letters, names, options);
    } else {
        ppmi_print(stderr, "%s: error: out of memory\n", table->program);
    }
    free(letters);
    free(names);
    return status;
}
