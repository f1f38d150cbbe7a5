/* ICC.1:2022 (4.4): the header (7.2), a table of tags (7.3), and the tags that a three-component
 * matrix display profile must have (8.4.3). Colorants are relative to the connection space's D50:
 * adapted by Bradford, whose matrix is the chromatic adaptation tag. Nothing in it depends on the
 * time or the machine. */
#include "color/icc.h"

#include <math.h>
#include <string.h>

#include "color/primaries.h"

typedef struct profile {
    uint8_t *bytes;
    size_t size;
    uint32_t tag_count;
} profile;

enum { HEADER_BYTES = 128, TAGS = 10, TAG_ENTRY_BYTES = 12 };

static const double d50_xy[2] = {0.345702915, 0.358538597}; /* of X, Y, Z 0.9642, 1, 0.8249 */

static void put_u32(uint8_t *at, uint32_t value)
{
    for (int i = 0; i < 4; i++)
        at[i] = (uint8_t)(value >> (24 - 8 * i));
}

static void put_signature(uint8_t *at, const char text[4])
{
    memcpy(at, text, 4);
}

static void put_number(uint8_t *at, double value) /* s15Fixed16Number */
{
    put_u32(at, (uint32_t)(int32_t)lround(value * 65536));
}

static void put_header(profile *p)
{
    uint8_t *const h = p->bytes;
    put_u32(h + 8, 0x04400000); /* version 4.4 */
    put_signature(h + 12, "mntr");
    put_signature(h + 16, "RGB ");
    put_signature(h + 20, "XYZ ");
    h[24] = 0x07; /* 2022-05-01: of the specification */
    h[25] = 0xe6;
    h[27] = 5;
    h[29] = 1;
    put_signature(h + 36, "acsp");
    put_number(h + 68, 0.9642);
    put_number(h + 72, 1.0);
    put_number(h + 76, 0.8249);
}

/* Enters a tag whose data begins here. */
static void enter_tag(profile *p, const char signature[4], size_t begin, size_t size)
{
    uint8_t *const entry = p->bytes + HEADER_BYTES + 4 + TAG_ENTRY_BYTES * p->tag_count++;
    put_signature(entry, signature);
    put_u32(entry + 4, (uint32_t)begin);
    put_u32(entry + 8, (uint32_t)size);
}

/* Room for a tag's data, which begins with its type; at multiples of four. */
static uint8_t *add_tag(profile *p, const char signature[4], const char type[4], size_t size)
{
    uint8_t *const data = p->bytes + p->size;
    put_signature(data, type);
    enter_tag(p, signature, p->size, size);
    p->size += (size + 3) / 4 * 4;
    return data;
}

static void add_text(profile *p, const char signature[4], const char *text)
{
    const size_t length = strlen(text), header = 28;
    uint8_t *const data = add_tag(p, signature, "mluc", header + 2 * length);
    put_u32(data + 8, 1);
    put_u32(data + 12, 12);
    memcpy(data + 16, "enUS", 4);
    put_u32(data + 20, (uint32_t)(2 * length));
    put_u32(data + 24, (uint32_t)header);
    for (size_t i = 0; i < length; i++) /* UTF-16 */
        data[header + 2 * i + 1] = (uint8_t)text[i];
}

static void add_xyz(profile *p, const char signature[4], double x, double y, double z)
{
    uint8_t *const data = add_tag(p, signature, "XYZ ", 20);
    put_number(data + 8, x);
    put_number(data + 12, y);
    put_number(data + 16, z);
}

/* One curve for the three channels (10.18): Y = X^g, or sRGB's, which is linear below a point. */
static void add_curves(profile *p, const ppmi_display_tag *tag)
{
    static const double srgb[5] = {2.4, 1 / 1.055, 0.055 / 1.055, 1 / 12.92, 0.04045};
    const bool is_srgb = tag->curve == PPMI_CURVE_SRGB;
    const size_t begin = p->size, size = is_srgb ? 32 : 16;
    uint8_t *const data = add_tag(p, "rTRC", "para", size);
    data[9] = is_srgb ? 3 : 0;
    for (int i = 0; i < (is_srgb ? 5 : 1); i++)
        put_number(data + 12 + 4 * i, is_srgb ? srgb[i] : tag->gamma);
    enter_tag(p, "gTRC", begin, size);
    enter_tag(p, "bTRC", begin, size);
}

size_t ppmi_icc_write(const ppmi_display_tag *tag, uint8_t out[PPMI_ICC_BYTES_MAX])
{
    static const char colorants[3][5] = {"rXYZ", "gXYZ", "bXYZ"};
    double to_xyz[9], adaptation[9], to_d50[9];
    if (tag->curve == PPMI_CURVE_HDR || !ppmi_primaries_to_xyz(tag->primaries, to_xyz)) return 0;
    ppmi_white_adaptation(tag->primaries->xy + 6, d50_xy, adaptation);
    ppmi_matrix_multiply(adaptation, to_xyz, to_d50);
    memset(out, 0, PPMI_ICC_BYTES_MAX);
    profile p = {.bytes = out, .size = HEADER_BYTES + 4 + TAG_ENTRY_BYTES * TAGS};
    put_header(&p);
    add_text(&p, "desc", tag->name);
    add_text(&p, "cprt", "No copyright, use freely");
    add_xyz(&p, "wtpt", 0.9642, 1.0, 0.8249);
    for (int i = 0; i < 3; i++)
        add_xyz(&p, colorants[i], to_d50[i], to_d50[3 + i], to_d50[6 + i]);
    add_curves(&p, tag);
    uint8_t *const chad = add_tag(&p, "chad", "sf32", 44);
    for (int i = 0; i < 9; i++)
        put_number(chad + 8 + 4 * i, adaptation[i]);
    put_u32(out, (uint32_t)p.size);
    put_u32(out + HEADER_BYTES, p.tag_count);
    return p.size;
}
