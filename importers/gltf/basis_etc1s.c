/* ETC1S pictures in BasisLZ; see the header. Colours of a block: Khronos Data Format 1.3, 21.1. */
#include "gltf/basis_etc1s.h"

#include <string.h>

#include "gltf/basis_huffman.h"

enum { FIXED = 20, IMAGE = 20, P_FRAME = 2, REPEAT = 256, HISTORY_MOST = 8191, LONG_RUN = 63 };

typedef struct endpoint {
    uint8_t color[3]; /* 5 bits each */
    uint8_t table;
} endpoint;

/* The codebooks, and the codes of slices. */
typedef struct book {
    endpoint *endpoints;
    uint8_t (*selectors)[4]; /* a row each, two bits a texel from the lowest on */
    uint32_t endpoint_count, selector_count, history_size;
    ppmi_basis_code prediction, delta, selector, run;
    ppmi_basis_code scratch[4];
} book;

/* What decoding a slice remembers. */
typedef struct walk {
    ppmi_basis_bits bits;
    uint32_t across, down;
    uint16_t *above[2];       /* endpoints of a row of blocks, even and odd */
    uint8_t *below;           /* predictions of the odd row, for two blocks each */
    uint32_t pair, symbol;    /* predictions left of this pair; the last symbol for 2 x 2 blocks */
    uint32_t repeats, before; /* of the symbol; the endpoint before */
    uint32_t run, rover;      /* left of a run of selectors; where the next one goes */
    uint16_t history[HISTORY_MOST + 1];
} walk;

static uint32_t u16(const unsigned char *p)
{
    return (uint32_t)p[0] | (uint32_t)p[1] << 8;
}

static uint32_t u32(const unsigned char *p)
{
    return u16(p) | u16(p + 2) << 16;
}

/* ---- codebooks ------------------------------------------------------------------------------- */

static bool read_endpoints(ppmi_basis_bits bits, book *b)
{
    endpoint last = {{16, 16, 16}, 0};
    for (int i = 0; i < 4; ++i) {
        if (!ppmi_basis_read_code(&bits, &b->scratch[i])) return false;
    }
    const uint32_t channels = ppmi_basis_get(&bits, 1) ? 1 : 3;
    for (uint32_t i = 0; i < b->endpoint_count; ++i) {
        const uint32_t table_by = ppmi_basis_symbol(&bits, &b->scratch[3]);
        if (table_by == PPMI_BASIS_NO_SYMBOL) return false;
        last.table = (uint8_t)((last.table + table_by) & 7);
        for (uint32_t c = 0; c < channels; ++c) {
            const int model = last.color[c] <= 9 ? 0 : last.color[c] <= 21 ? 1 : 2;
            const uint32_t by = ppmi_basis_symbol(&bits, &b->scratch[model]);
            if (by == PPMI_BASIS_NO_SYMBOL) return false;
            last.color[c] = (uint8_t)((last.color[c] + by) & 31);
        }
        if (channels == 1) last.color[1] = last.color[2] = last.color[0];
        b->endpoints[i] = last;
    }
    return true;
}

static bool read_selectors(ppmi_basis_bits bits, book *b)
{
    if (ppmi_basis_get(&bits, 2) != 0) return false;
    const bool is_plain = ppmi_basis_get(&bits, 1);
    if (!is_plain && !ppmi_basis_read_code(&bits, &b->scratch[0])) return false;
    for (uint32_t i = 0; i < b->selector_count; ++i) {
        for (int row = 0; row < 4; ++row) {
            const bool is_whole = is_plain || i == 0;
            const uint32_t value =
                is_whole ? ppmi_basis_get(&bits, 8) : ppmi_basis_symbol(&bits, &b->scratch[0]);
            if (value > 255 || bits.is_over) return false;
            b->selectors[i][row] = (uint8_t)(is_whole ? value : value ^ b->selectors[i - 1][row]);
        }
    }
    return true;
}

static bool read_tables(ppmi_basis_bits bits, book *b)
{
    if (!ppmi_basis_read_code(&bits, &b->prediction) || !ppmi_basis_read_code(&bits, &b->delta) ||
        !ppmi_basis_read_code(&bits, &b->selector) || !ppmi_basis_read_code(&bits, &b->run))
        return false;
    b->history_size = ppmi_basis_get(&bits, 13);
    return !bits.is_over;
}

/* ---- a slice --------------------------------------------------------------------------------- */

/* A number in chunks of so many bits, each followed by whether another one comes. */
static uint32_t chunked(ppmi_basis_bits *bits, uint32_t chunk)
{
    uint32_t value = 0;
    for (uint32_t shift = 0; shift < 32; shift += chunk) {
        value |= ppmi_basis_get(bits, chunk) << shift;
        if (!ppmi_basis_get(bits, 1)) break;
    }
    return value;
}

/* At the left block of a pair: how the endpoints of both are found. False at a broken symbol. */
static bool next_pair(const book *b, walk *w, uint32_t x, uint32_t y)
{
    if (y & 1) {
        w->pair = w->below[x / 2];
        return true;
    }
    if (w->repeats > 0) {
        --w->repeats;
    } else {
        const uint32_t symbol = ppmi_basis_symbol(&w->bits, &b->prediction);
        if (symbol > REPEAT) return false;
        if (symbol == REPEAT) {
            w->repeats = chunked(&w->bits, 4) + 2;
        } else {
            w->symbol = symbol;
        }
    }
    w->pair = w->symbol;
    w->below[x / 2] = (uint8_t)(w->symbol >> 4);
    return true;
}

static bool next_endpoint(const book *b, walk *w, uint32_t x, uint32_t y, uint32_t *out)
{
    if ((x & 1) == 0 && !next_pair(b, w, x, y)) return false;
    const uint32_t from = w->pair & 3;
    const uint16_t *above = w->above[~y & 1];
    w->pair >>= 2;
    if ((from == 0 && x == 0) || (from == 1 && y == 0) || (from == 2 && (x == 0 || y == 0)))
        return false;
    *out = from == 0 ? w->before : from == 1 ? above[x] : from == 2 ? above[x - 1] : 0;
    if (from == 3) {
        const uint32_t by = ppmi_basis_symbol(&w->bits, &b->delta);
        if (by >= b->endpoint_count) return false;
        *out = (w->before + by) % b->endpoint_count;
    }
    w->above[y & 1][x] = (uint16_t)*out;
    w->before = *out;
    return true;
}

/* The selectors used last are few; a hit moves half way to the front. */
static uint32_t from_history(walk *w, uint32_t at)
{
    const uint16_t value = w->history[at];
    w->history[at] = w->history[at / 2];
    w->history[at / 2] = value;
    return value;
}

static bool next_selector(const book *b, walk *w, uint32_t *out)
{
    uint32_t symbol = b->selector_count;
    if (w->run > 0) {
        --w->run;
    } else {
        symbol = ppmi_basis_symbol(&w->bits, &b->selector);
        if (symbol == b->selector_count + b->history_size) {
            const uint32_t run = ppmi_basis_symbol(&w->bits, &b->run);
            if (run > LONG_RUN) return false;
            w->run = (run == LONG_RUN ? chunked(&w->bits, 7) : run) + 2;
            symbol = b->selector_count;
        }
    }
    if (symbol >= b->selector_count + b->history_size) return false;
    if (symbol >= b->selector_count) {
        *out = from_history(w, symbol - b->selector_count);
        return *out < b->selector_count;
    }
    *out = symbol;
    if (b->history_size == 0) return true;
    w->history[w->rover++] = (uint16_t)symbol;
    if (w->rover == b->history_size) w->rover = b->history_size / 2;
    return true;
}

static uint8_t clamp_byte(int value)
{
    return (uint8_t)(value < 0 ? 0 : value > 255 ? 255 : value);
}

/* The four colours of a block: its own, made darker and brighter. */
static void block_colors(const endpoint *e, uint8_t out[4][3])
{
    static const uint8_t tables[8][2] = {{2, 8},   {5, 17},  {9, 29},   {13, 42},
                                         {18, 60}, {24, 80}, {33, 106}, {47, 183}};
    const int a = tables[e->table][0], b = tables[e->table][1];
    const int by[4] = {-b, -a, a, b};
    for (int i = 0; i < 4; ++i) {
        for (int c = 0; c < 3; ++c)
            out[i][c] = clamp_byte((e->color[c] << 3 | e->color[c] >> 2) + by[i]);
    }
}

/* The block's texels; of the slice of alpha they are the green value. */
static void put_block(const ppmi_basis_source *s, const endpoint *e, const uint8_t rows[4],
                      uint32_t left, uint32_t top, bool is_alpha, uint8_t *out)
{
    uint8_t colors[4][3];
    block_colors(e, colors);
    for (uint32_t y = 0; y < 4 && top + y < s->height; ++y) {
        for (uint32_t x = 0; x < 4 && left + x < s->width; ++x) {
            uint8_t *texel = out + 4 * ((size_t)(top + y) * s->width + left + x);
            const uint8_t *color = colors[rows[y] >> (2 * x) & 3];
            if (is_alpha) {
                texel[3] = color[1];
            } else {
                memcpy(texel, color, 3);
                texel[3] = 255;
            }
        }
    }
}

static bool decode_blocks(const ppmi_basis_source *s, const book *b, walk *w, bool is_alpha,
                          uint8_t *out)
{
    for (uint32_t y = 0; y < w->down; ++y) {
        for (uint32_t x = 0; x < w->across; ++x) {
            uint32_t color, selector;
            if (!next_endpoint(b, w, x, y, &color) || !next_selector(b, w, &selector)) return false;
            put_block(s, &b->endpoints[color], b->selectors[selector], 4 * x, 4 * y, is_alpha, out);
        }
    }
    return !w->bits.is_over;
}

/* The slice that two numbers of the image's description, offset and length, say. */
static ppm_status decode_slice(ppm_context *context, const ppmi_basis_source *s, const book *b,
                               const unsigned char *where, bool is_alpha, uint8_t *out,
                               const char **reason)
{
    const uint32_t at = u32(where), count = u32(where + 4), across = (s->width + 3) / 4;
    *reason = "a slice of its picture is not within it";
    if (at > s->level_count || count > s->level_count - at) return PPM_STATUS_INPUT_INVALID;
    *reason = "out of memory";
    walk *w = ppmi_alloc_zeroed(context, 1, sizeof *w);
    uint16_t *rows = ppmi_alloc_zeroed(context, 3 * (size_t)across, sizeof *rows);
    ppm_status status = PPM_STATUS_OUT_OF_MEMORY;
    if (w && rows) {
        w->bits = (ppmi_basis_bits){.bytes = s->level + at, .count = count};
        w->across = across;
        w->down = (s->height + 3) / 4;
        w->above[0] = rows;
        w->above[1] = rows + across;
        w->below = (uint8_t *)(rows + 2 * (size_t)across);
        w->rover = b->history_size / 2;
        *reason = is_alpha ? "its slice of alpha is broken" : "its slice of colours is broken";
        status = decode_blocks(s, b, w, is_alpha, out) ? PPM_STATUS_OK : PPM_STATUS_INPUT_INVALID;
    }
    ppmi_free(context, rows);
    ppmi_free(context, w);
    return status;
}

/* ---- the picture ----------------------------------------------------------------------------- */

static bool read_book(const ppmi_basis_source *s, book *b, const char **reason)
{
    const unsigned char *g = s->global;
    const size_t ends[3] = {u32(g + 4), u32(g + 8), u32(g + 12)};
    const ppmi_basis_bits endpoints = {.bytes = g + FIXED + IMAGE * (size_t)s->images,
                                       .count = ends[0]};
    const ppmi_basis_bits selectors = {.bytes = endpoints.bytes + ends[0], .count = ends[1]};
    const ppmi_basis_bits tables = {.bytes = selectors.bytes + ends[1], .count = ends[2]};
    *reason = "its codebook of endpoints is broken";
    if (!read_endpoints(endpoints, b)) return false;
    *reason = "its codebook of selectors is broken";
    if (!read_selectors(selectors, b)) return false;
    *reason = "its tables of codes are broken";
    return read_tables(tables, b);
}

/* Whether the global data is as long as its parts say. */
static bool has_parts(const ppmi_basis_source *s)
{
    const unsigned char *g = s->global;
    if (s->global_count < FIXED) return false;
    const uint64_t parts = (uint64_t)u32(g + 4) + u32(g + 8) + u32(g + 12) + u32(g + 16);
    return s->image < s->images && u16(g) > 0 && u16(g + 2) > 0 &&
           FIXED + IMAGE * (uint64_t)s->images + parts == s->global_count;
}

static ppm_status decode(ppm_context *context, const ppmi_basis_source *s, book *b, uint8_t *out,
                         const char **reason)
{
    const unsigned char *image = s->global + FIXED + IMAGE * (size_t)s->image;
    *reason = "it is a frame of a video, that needs the one before";
    if (u32(image) & P_FRAME) return PPM_STATUS_INPUT_UNSUPPORTED;
    if (!read_book(s, b, reason)) return PPM_STATUS_INPUT_INVALID;
    const ppm_status status = decode_slice(context, s, b, image + 4, false, out, reason);
    if (status != PPM_STATUS_OK || u32(image + 16) == 0) return status;
    return decode_slice(context, s, b, image + 12, true, out, reason);
}

ppm_status ppmi_basis_decode_etc1s(ppm_context *context, const ppmi_basis_source *source,
                                   uint8_t *out, const char **reason)
{
    *reason = "its global data has not the length that its parts need";
    if (!has_parts(source)) return PPM_STATUS_INPUT_INVALID;
    ppm_status status = PPM_STATUS_OUT_OF_MEMORY;
    book *b = ppmi_alloc_zeroed(context, 1, sizeof *b);
    if (b) {
        b->endpoint_count = u16(source->global);
        b->selector_count = u16(source->global + 2);
        b->endpoints = ppmi_alloc_zeroed(context, b->endpoint_count, sizeof *b->endpoints);
        b->selectors = ppmi_alloc_zeroed(context, b->selector_count, sizeof *b->selectors);
    }
    *reason = "out of memory";
    if (b && b->endpoints && b->selectors) status = decode(context, source, b, out, reason);
    if (b) {
        ppmi_free(context, b->selectors);
        ppmi_free(context, b->endpoints);
    }
    ppmi_free(context, b);
    return status;
}
