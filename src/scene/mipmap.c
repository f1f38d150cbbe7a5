/* Mipmaps: each level is the mean of the one before over boxes, in linear light.
 *
 * A side of n texels becomes one of n / 2, rounded down. Where n is odd a box covers parts of three
 * texels, weighed by what it covers of them, so that every level has the mean of the image and
 * shows things at the same place, whatever its size (Guthe and Heckbert, "Non-Power-of-Two
 * Mipmapping", NVIDIA 2005). Levels of 8-bit images are stored in 8 bits, sRGB ones encoded: each
 * is rounded once, from floats that are kept while the levels are made. */
#include "scene/mipmap.h"

#include <string.h>

enum { CURVE_CELLS = 4096 };

/* Linear light to the nearest of the 256 codes of the scene's decoding table. The cell of a value
 * gives a code that is not above the right one, and few below it: no two codes of sRGB are closer
 * than a cell. */
typedef struct code_table {
    uint8_t first[CURVE_CELLS + 1];
    float borders[256]; /* above the border to the next code; the last is infinite */
} code_table;

static void code_table_init(const float decode[256], code_table *out)
{
    for (int i = 0; i < 255; i++)
        out->borders[i] = 0.5f * (decode[i] + decode[i + 1]);
    out->borders[255] = INFINITY;
    uint32_t code = 0;
    for (uint32_t i = 0; i <= CURVE_CELLS; i++) {
        const float value = (float)i / CURVE_CELLS;
        while (code < 255 && value > out->borders[code])
            code++;
        out->first[i] = (uint8_t)code;
    }
}

static uint8_t encode(const code_table *codes, float value)
{
    const float x = ppmi_clampf(value, 0.0f, 1.0f);
    uint32_t code = codes->first[(uint32_t)(x * CURVE_CELLS)];
    while (x > codes->borders[code])
        code++;
    return (uint8_t)code;
}

static uint8_t to_u8(float value)
{
    return (uint8_t)(ppmi_clampf(value, 0.0f, 1.0f) * 255.0f + 0.5f);
}

/* ---- one level from the one before ----------------------------------------------------------- */

/* The texels that a box covers, and how much of it each fills. */
typedef struct box {
    uint32_t first, count;
    float weights[3];
} box;

static box box_at(uint32_t i, uint32_t size)
{
    if (size == 1) return (box){0, 1, {1.0f}};
    if (size % 2 == 0) return (box){2 * i, 2, {0.5f, 0.5f}};
    const float n = (float)(size / 2), scale = 1.0f / (float)size;
    return (box){2 * i, 3, {(n - (float)i) * scale, n * scale, ((float)i + 1.0f) * scale}};
}

/* Floats of one row of the image itself, linear. */
static void load_row(const ppmi_image *image, const float *decode, uint32_t y, float *out)
{
    const uint32_t channels = image->channels;
    const uint32_t colors = !image->is_srgb ? 0 : channels >= 3 ? 3 : 1;
    const size_t count = (size_t)image->width * channels, at = y * count;
    if (image->f32) {
        memcpy(out, image->f32 + at, count * sizeof *out);
        return;
    }
    const uint8_t *from = image->u8 + at;
    if (colors == channels) {
        for (size_t i = 0; i < count; i++)
            out[i] = decode[from[i]];
        return;
    }
    for (size_t i = 0; i < count; i++)
        out[i] = from[i] * (1.0f / 255.0f);
    for (uint32_t c = 0; c < colors; c++) {
        for (size_t i = c; i < count; i += channels)
            out[i] = decode[from[i]];
    }
}

/* Halves a row of an even number of texels; constants for channels let the compiler unroll. */
static inline void halve_even(const float *row, uint32_t half, uint32_t channels, float *out)
{
    for (uint32_t x = 0; x < half; x++) {
        const float *texel = row + 2 * (size_t)x * channels;
        for (uint32_t c = 0; c < channels; c++)
            out[(size_t)x * channels + c] = 0.5f * (texel[c] + texel[channels + c]);
    }
}

static void halve_odd(const float *row, uint32_t width, uint32_t channels, float *out)
{
    const uint32_t half = width > 1 ? width / 2 : 1;
    memset(out, 0, (size_t)half * channels * sizeof *out);
    for (uint32_t x = 0; x < half; x++) {
        const box b = box_at(x, width);
        for (uint32_t k = 0; k < b.count; k++) {
            const float *texel = row + (size_t)(b.first + k) * channels;
            for (uint32_t c = 0; c < channels; c++)
                out[(size_t)x * channels + c] += b.weights[k] * texel[c];
        }
    }
}

/* A row of width texels to half as many. */
static void halve(const float *row, uint32_t width, uint32_t channels, float *out)
{
    if (width % 2 != 0) {
        halve_odd(row, width, channels, out);
    } else if (channels == 1) {
        halve_even(row, width / 2, 1, out);
    } else if (channels == 3) {
        halve_even(row, width / 2, 3, out);
    } else if (channels == 4) {
        halve_even(row, width / 2, 4, out);
    } else {
        halve_even(row, width / 2, channels, out);
    }
}

/* A level in the making: the image itself (values NULL, rows are decoded as they are needed), or
 * floats. */
typedef struct source {
    uint32_t width, height;
    const float *values;
} source;

/* scratch holds two rows of the image. */
static void make_row(const ppmi_image *image, const float *decode, const source *from, uint32_t y,
                     float *scratch, float *out)
{
    const uint32_t channels = image->channels;
    const uint32_t half = from->width > 1 ? from->width / 2 : 1;
    const size_t count = (size_t)half * channels;
    float *const mean = scratch + (size_t)image->width * channels;
    const box b = box_at(y, from->height);
    for (uint32_t k = 0; k < b.count; k++) {
        const float *row = scratch;
        if (from->values) {
            row = from->values + (size_t)(b.first + k) * from->width * channels;
        } else {
            load_row(image, decode, b.first + k, scratch);
        }
        halve(row, from->width, channels, mean);
        const float weight = b.weights[k];
        for (size_t i = 0; i < count; i++)
            out[i] = (k == 0 ? 0.0f : out[i]) + weight * mean[i];
    }
}

static void store_row(const ppmi_image *image, const code_table *codes, const float *row,
                      size_t count, uint8_t *out)
{
    const uint32_t channels = image->channels;
    const uint32_t colors = !image->is_srgb ? 0 : channels >= 3 ? 3 : 1;
    if (colors < channels) {
        for (size_t i = 0; i < count; i++)
            out[i] = to_u8(row[i]);
    }
    for (uint32_t c = 0; c < colors; c++) {
        for (size_t i = c; i < count; i += channels)
            out[i] = encode(codes, row[i]);
    }
}

/* ---- all levels of an image ------------------------------------------------------------------ */

static uint32_t level_count(const ppmi_image *image)
{
    uint32_t count = 0;
    for (uint32_t size = image->width > image->height ? image->width : image->height; size > 1;
         size /= 2)
        count++;
    return count;
}

static size_t half_texels(uint32_t width, uint32_t height)
{
    return (size_t)(width > 1 ? width / 2 : 1) * (height > 1 ? height / 2 : 1);
}

static size_t texels_of_all_levels(const ppmi_image *image)
{
    size_t sum = 0;
    uint32_t width = image->width, height = image->height;
    while (width > 1 || height > 1) {
        sum += half_texels(width, height);
        width = width > 1 ? width / 2 : 1;
        height = height > 1 ? height / 2 : 1;
    }
    return sum;
}

/* What is needed while the levels of an image are made. */
typedef struct buffers {
    float *rows;      /* two of the image */
    float *values[2]; /* the level that is read and the one that is written */
} buffers;

/* Fills in the levels, whose memory is there: the image's mips and pixels. */
static void fill_levels(const ppm_scene *scene, const code_table *codes, ppmi_image *image,
                        const buffers *work)
{
    const uint32_t channels = image->channels;
    source from = {image->width, image->height, NULL};
    size_t at = 0;
    for (uint32_t i = 0; i < image->mip_count; i++) {
        const uint32_t width = from.width > 1 ? from.width / 2 : 1;
        const uint32_t height = from.height > 1 ? from.height / 2 : 1;
        const size_t row_values = (size_t)width * channels;
        float *level = image->f32 ? (float *)image->mip_pixels + at : work->values[i % 2];
        uint8_t *bytes = image->u8 ? (uint8_t *)image->mip_pixels + at : NULL;
        for (uint32_t y = 0; y < height; y++) {
            float *row = level + y * row_values;
            make_row(image, scene->srgb_to_linear, &from, y, work->rows, row);
            if (bytes) store_row(image, codes, row, row_values, bytes + y * row_values);
        }
        image->mips[i] = (ppmi_image_level){width, height, bytes, image->f32 ? level : NULL};
        from = (source){width, height, level};
        at += row_values * height;
    }
}

static bool build_image(const ppm_scene *scene, const code_table *codes, ppmi_image *image)
{
    ppm_context *context = scene->context;
    const uint32_t channels = image->channels, count = level_count(image);
    if (count == 0) return true;
    const size_t first = half_texels(image->width, image->height) * channels;
    buffers work = {.rows =
                        ppmi_alloc(context, 2 * (size_t)image->width * channels, sizeof(float))};
    if (image->u8) { /* the second level is not larger than the first */
        work.values[0] = ppmi_alloc(context, first, sizeof(float));
        work.values[1] = ppmi_alloc(context, first, sizeof(float));
    }
    image->mips = ppmi_alloc(context, count, sizeof *image->mips);
    image->mip_pixels = ppmi_alloc(context, texels_of_all_levels(image) * channels,
                                   image->u8 ? sizeof(uint8_t) : sizeof(float));
    const bool has_memory = work.rows && image->mips && image->mip_pixels &&
                            (!image->u8 || (work.values[0] && work.values[1]));
    if (has_memory) {
        image->mip_count = count;
        fill_levels(scene, codes, image, &work);
    } else {
        ppmi_free(context, image->mips);
        ppmi_free(context, image->mip_pixels);
        image->mips = NULL;
        image->mip_pixels = NULL;
    }
    ppmi_free(context, work.rows);
    ppmi_free(context, work.values[0]);
    ppmi_free(context, work.values[1]);
    return has_memory;
}

ppm_status ppmi_scene_build_mipmaps(ppm_scene *scene)
{
    const uint32_t environment = scene->environment.image;
    bool is_complete = true;
    code_table codes;
    code_table_init(scene->srgb_to_linear, &codes);
#pragma omp parallel for schedule(dynamic, 1) reduction(&& : is_complete)
    for (uint32_t i = 0; i < scene->image_count; i++) {
        if (scene->images[i].mips || i + 1 == environment) continue;
        is_complete = build_image(scene, &codes, &scene->images[i]) && is_complete;
    }
    if (is_complete) return PPM_STATUS_OK;
    return ppmi_fail(scene->context, PPM_STATUS_OUT_OF_MEMORY,
                     "out of memory for the mipmaps of textures");
}
