/* Layers go by the names that the library has for them, and by words for several at once. */
#include "layer_values.h"

#include <string.h>

#include "base/printable.h"
#include "base/suggest.h"
#include "option_values.h"
#include "options.h"
#include "ppm/ppm.h"
#include "values.h"

enum { TILE_SIDE_DEFAULT = 64 };

/* ---- names of layers ------------------------------------------------------------------------- */

static uint64_t bits_between(int32_t first, int32_t last)
{
    uint64_t bits = 0;
    for (int32_t kind = first; kind <= last; kind++)
        bits |= PPM_LAYER_BIT(kind);
    return bits;
}

uint64_t layer_bits_of_all(void)
{
    return bits_between(0, PPM_LAYER_KINDS - 1) & ~PPM_LAYER_BIT(PPM_LAYER_DENOISED);
}

/* 0: there is none of that name. The first of a name counts: caustics of groups are called as the
 * caustics of all light. */
static uint64_t bits_of(const char *name)
{
    if (strcmp(name, "all") == 0) return layer_bits_of_all();
    if (strcmp(name, "crypto") == 0) {
        return bits_between(PPM_LAYER_CRYPTO_OBJECT, PPM_LAYER_CRYPTO_ASSET);
    }
    if (strcmp(name, "light_variance") == 0) return PPM_LAYER_BIT(PPM_LAYER_LIGHT_VARIANCE);
    for (int32_t kind = 0; kind < PPM_LAYER_KINDS; kind++) {
        if (strcmp(name, ppm_layer_kind_name(kind)) == 0) return PPM_LAYER_BIT(kind);
    }
    return 0;
}

static int complain_of_name(const option_table *table, const option_row *row, const char *name)
{
    enum { WORDS = 3 };
    const char *names[WORDS + PPM_LAYER_KINDS] = {"all", "crypto", "light_variance"};
    for (int32_t kind = 0; kind < PPM_LAYER_KINDS; kind++)
        names[WORDS + kind] = ppm_layer_kind_name(kind);
    const char *const nearest = ppmi_suggest(name, names, WORDS + PPM_LAYER_KINDS);
    ppmi_print(stderr, "%s: error: --%s: there is no layer '%s'", table->program, row->name, name);
    if (nearest) ppmi_print(stderr, "; did you mean '%s'?", nearest);
    fputs("\nLayers: all, crypto, light_variance", stderr);
    for (int32_t kind = 0; kind < PPM_LAYER_KINDS; kind++) {
        const bool is_second = kind == PPM_LAYER_GROUP_CAUSTICS || kind == PPM_LAYER_LIGHT_VARIANCE;
        if (!is_second) ppmi_print(stderr, ", %s", ppm_layer_kind_name(kind));
    }
    fputc('\n', stderr);
    return option_give_hint(table);
}

static int store_layers(const option_table *table, const option_row *row, const char *text,
                        uint64_t *field)
{
    uint64_t bits = 0;
    for (const char *word = text; word;) {
        char name[64];
        const size_t length = strcspn(word, ",");
        snprintf(name, sizeof name, "%.*s", (int)length, word);
        const uint64_t more = bits_of(name);
        if (more == 0) return complain_of_name(table, row, name);
        bits |= more;
        word = word[length] ? word + length + 1 : NULL;
    }
    *field |= bits;
    return EXIT_DONE;
}

/* ---- the file -------------------------------------------------------------------------------- */

/* "zip", "dwaa", "dwaa:30" */
static int store_packing(const option_table *table, const option_row *row, const char *text,
                         packing_choice *field)
{
    packing_choice packing = {0};
    const size_t length = strcspn(text, ":");
    const int status = option_store_choice(table, row, text, length, &packing.kind);
    if (status != EXIT_DONE) return status;
    const bool has_level =
        packing.kind == PPM_COMPRESSION_DWAA || packing.kind == PPM_COMPRESSION_DWAB;
    if (text[length] == ':') {
        const bool is_number = value_parse_real(text + length + 1, &packing.level);
        if (!has_level || !is_number || packing.level < row->low || packing.level > row->high) {
            return option_complain(
                table, row, text, "like dwaa:45: only dwaa and dwab have a level, from 1 to 10000");
        }
    }
    *field = packing;
    return EXIT_DONE;
}

static int store_tiles(const option_table *table, const option_row *row, const char *text,
                       uint32_t *field)
{
    uint64_t side = TILE_SIDE_DEFAULT;
    const int status = text ? option_store_integer(table, row, text, &side) : EXIT_DONE;
    if (status == EXIT_DONE) *field = (uint32_t)side;
    return status;
}

/* A layer of a Cryptomatte holds two. */
static int store_ranks(const option_table *table, const option_row *row, const char *text,
                       uint64_t *field)
{
    uint64_t ranks = 0;
    const int status = option_store_integer(table, row, text, &ranks);
    if (status != EXIT_DONE) return status;
    if (ranks % 2 != 0) return option_complain(table, row, text, "an even number");
    *field = ranks;
    return EXIT_DONE;
}

int option_store_layer_value(const option_table *table, const option_row *row, const char *text,
                             void *field)
{
    switch (row->kind) {
    case VALUE_LAYERS:
        return store_layers(table, row, text, field);
    case VALUE_PACKING:
        return store_packing(table, row, text, field);
    case VALUE_TILES:
        return store_tiles(table, row, text, field);
    case VALUE_RANKS:
        return store_ranks(table, row, text, field);
    }
    *(int32_t *)field = PPM_LIGHT_GROUPS_GIVEN; /* VALUE_GROUPS */
    return text ? option_store_choice(table, row, text, strlen(text), field) : EXIT_DONE;
}
