/* docs/gltf.md and the table of importers/gltf/gltf_extensions.c say the same. */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "gltf/gltf_extensions.h"
#include "gltf/gltf_report.h"
#include "gltf_fixture.h"

enum { MAX_NAMES = 128, NAME_SIZE = 64 };

/* Extensions with their verdicts. */
typedef struct table {
    char names[MAX_NAMES][NAME_SIZE];
    int32_t verdicts[MAX_NAMES];
    size_t count;
} table;

static char *read_text(const char *path)
{
    FILE *const file = fopen(path, "rb");
    if (!file) fail_msg("%s cannot be read", path);
    fseek(file, 0, SEEK_END);
    const long length = ftell(file);
    rewind(file);
    char *const text = malloc((size_t)length + 1);
    assert_non_null(text);
    assert_int_equal(fread(text, 1, (size_t)length, file), length);
    text[length] = 0;
    fclose(file);
    return text;
}

/* PREFIX_name, as all extensions are called; ours in extras are not. */
static bool is_extension(const char *name)
{
    return name[0] >= 'A' && name[0] <= 'Z' && strchr(name, '_') &&
           strncmp(name, "TEXCOORD_", 9) != 0 && strncmp(name, "COLOR_", 6) != 0;
}

static void add(table *t, const char *name, size_t length, int32_t verdict)
{
    assert_in_range(length, 1, NAME_SIZE - 1);
    memcpy(t->names[t->count], name, length);
    t->names[t->count][length] = 0;
    if (!is_extension(t->names[t->count])) return;
    assert_true(t->count + 1 < MAX_NAMES);
    t->verdicts[t->count++] = verdict;
}

/* A row is | names | verdict | what comes of it |; names stand in backquotes. */
static void read_row(table *t, const char *row)
{
    static const char *const words[] = {[PPM_FEATURE_HONOURED] = " honoured ",
                                        [PPM_FEATURE_APPROXIMATED] = " approximated ",
                                        [PPM_FEATURE_IGNORED] = " ignored "};
    const char *const cell = strchr(row + 1, '|');
    for (int32_t verdict = 0; cell && verdict < 3; ++verdict) {
        if (strncmp(cell + 1, words[verdict], strlen(words[verdict])) != 0) continue;
        for (const char *at = strchr(row, '`'); at && at < cell; at = strchr(at, '`')) {
            const char *const end = strchr(at + 1, '`');
            add(t, at + 1, (size_t)(end - at - 1), verdict);
            at = end + 1;
        }
    }
}

static table documented(void)
{
    table t = {0};
    char *const text = read_text(PPM_SOURCE_DIR "/docs/gltf.md");
    for (char *line = strtok(text, "\n"); line; line = strtok(NULL, "\n")) {
        if (line[0] == '|') read_row(&t, line);
    }
    free(text);
    return t;
}

static int32_t verdict_of(gltf_fixture *f, const char *name)
{
    ppmi_gltf_reader reader = {.context = f->context, .options = &f->options, .path = "x.gltf"};
    ppmi_gltf_note_extension(&reader, name);
    const ppmi_gltf_feature *feature = ppmi_gltf_find_feature(&reader, name);
    assert_non_null(feature);
    const int32_t verdict = feature->verdict;
    if (strcmp(feature->note, "the extension is not known") == 0) {
        fail_msg("%s is in docs/gltf.md and not in gltf_extensions.c", name);
    }
    ppmi_gltf_report_deinit(f->context, &reader.report);
    return verdict;
}

static void what_is_documented_is_what_the_report_says(void **state)
{
    const table t = documented();
    assert_true(t.count > 40);
    for (size_t i = 0; i < t.count; ++i) {
        const int32_t verdict = verdict_of(*state, t.names[i]);
        if (verdict != t.verdicts[i]) {
            fail_msg("%s: verdict %d in docs/gltf.md, %d in the code", t.names[i],
                     (int)t.verdicts[i], (int)verdict);
        }
    }
}

/* The names of the table, from its source: it has no other way out. */
static void what_the_report_knows_is_documented(void **state)
{
    (void)state;
    const table t = documented();
    char *const text = read_text(PPM_SOURCE_DIR "/importers/gltf/gltf_extensions.c");
    size_t count = 0;
    for (char *line = strtok(text, "\n"); line; line = strtok(NULL, "\n")) {
        char name[NAME_SIZE];
        if (sscanf(line, "    {\"%63[A-Za-z0-9_]\",", name) != 1) continue;
        size_t i = 0;
        while (i < t.count && strcmp(t.names[i], name) != 0)
            ++i;
        if (i == t.count) fail_msg("%s is not in docs/gltf.md", name);
        ++count;
    }
    free(text);
    assert_int_equal(count, t.count);
}

#define TEST(name) cmocka_unit_test_setup_teardown(name, gltf_setup, gltf_teardown)

int main(void)
{
    const struct CMUnitTest tests[] = {
        TEST(what_is_documented_is_what_the_report_says),
        TEST(what_the_report_knows_is_documented),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
