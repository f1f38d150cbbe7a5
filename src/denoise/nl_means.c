/* Non-local means in tiles. All offsets of the window are visited one by one, and for each the
 * distances of all the tile's pixels to their neighbours at that offset are made at once: the
 * patches' sums are then two runs of a box (Rousselle, Knaus, Zwicker 2012, section 4). A tile's
 * pixels depend on nothing but the input, so threads change no bit. */
#include "denoise/nl_means.h"

#include <math.h>
#include <omp.h>
#include <string.h>

#include "math/vec.h"

enum {
    TILE = 32,
    WINDOW = 7, /* neighbours to each side */
    FINE = 1,   /* radii of patches */
    COARSE = 3,
    HALO = WINDOW + COARSE,
    SIDE = TILE + 2 * HALO, /* of a tile with all that it looks at */
    PATCHED = TILE + 2 * COARSE,
    PIXELS = TILE * TILE,
    MASK = PPMI_NL_PLANES, /* 1 inside the picture */
    PLANES = MASK + 1
};

/* k of Rousselle et al. 2013, section 3: differences within so many standard deviations count as
 * noise. */
static const float color_k2 = 0.45f * 0.45f;

/* Squared relative distance from the neighbour's surface, taken on, that halves of a weight. */
static const float nearness_scale = 1.0f / (0.02f * 0.02f);

/* Sums of a candidate over the window. */
typedef struct window_sums {
    float weight[PIXELS];
    float light[3][PIXELS];
    float alike[3][PIXELS];  /* of weights times the covariance with the pixel in the middle */
    float pull[3][PIXELS];   /* of the weights' derivatives, */
    float pulled[3][PIXELS]; /* and of those times the neighbour's light */
} window_sums;

typedef struct tile_work {
    float planes[PLANES][SIDE * SIDE];
    float distance[PATCHED * PATCHED]; /* of pixels; then rows summed */
    float rows[PATCHED * PATCHED];
    float patch[PIXELS], feature[PIXELS];
    window_sums sums[PPMI_DENOISE_CANDIDATES];
} tile_work;

/* ---- a tile's input -------------------------------------------------------------------------- */

static uint32_t clamp_to(int64_t i, uint32_t count)
{
    return i < 0 ? 0 : i >= count ? count - 1 : (uint32_t)i;
}

/* Outside the picture its border is repeated, for patches; as neighbours those do not count. */
static void load_tile(const ppmi_nl_input *input, uint32_t x0, uint32_t y0, tile_work *work)
{
    const size_t pixels = (size_t)input->width * input->height;
    for (int y = 0; y < SIDE; y++) {
        const int64_t row = (int64_t)y0 + y - HALO;
        const size_t from_row = (size_t)clamp_to(row, input->height) * input->width;
        for (int x = 0; x < SIDE; x++) {
            const int64_t column = (int64_t)x0 + x - HALO;
            const size_t from = from_row + clamp_to(column, input->width);
            for (size_t i = 0; i < PPMI_NL_PLANES; i++)
                work->planes[i][y * SIDE + x] = input->planes[i * pixels + from];
            const bool is_inside =
                row >= 0 && row < input->height && column >= 0 && column < input->width;
            work->planes[MASK][y * SIDE + x] = is_inside ? 1.0f : 0.0f;
        }
    }
}

/* ---- distances ------------------------------------------------------------------------------- */

/* exp(-x) for x >= 0 to within 0.01, and 0 from 8 on. Loops of it become vector code. */
static inline float weight_of(float x)
{
    float y = ppmi_max(1.0f - 0.125f * x, 0.0f);
    y *= y;
    y *= y;
    return y * y;
}

/* Of single pixels, the sum over the channels; equation 2 of Rousselle et al. 2013. */
static void find_distances(tile_work *work, int dx, int dy)
{
    memset(work->distance, 0, sizeof work->distance);
    for (int c = 0; c < 3; c++) {
        const float *light = work->planes[PPMI_NL_LIGHT + c];
        const float *variance = work->planes[PPMI_NL_VARIANCE + c];
        for (int y = 0; y < PATCHED; y++) {
            const int at = (y + WINDOW) * SIDE + WINDOW, to = at + dy * SIDE + dx;
            float *distance = work->distance + y * PATCHED;
            for (int x = 0; x < PATCHED; x++) {
                const float difference = light[at + x] - light[to + x];
                const float here = variance[at + x], there = variance[to + x];
                distance[x] += (difference * difference - (here + ppmi_min(here, there))) /
                               (1e-30f + color_k2 * (here + there));
            }
        }
    }
}

/* Means over patches and channels, from 0 on. */
static void sum_patches(tile_work *work, int radius)
{
    const float scale = 1.0f / (3.0f * (float)((2 * radius + 1) * (2 * radius + 1)));
    for (int y = 0; y < PATCHED; y++) {
        const float *from = work->distance + y * PATCHED + COARSE - radius;
        for (int x = 0; x < TILE; x++) {
            float sum = 0.0f;
            for (int i = 0; i <= 2 * radius; i++)
                sum += from[x + i];
            work->rows[y * TILE + x] = sum;
        }
    }
    for (int y = 0; y < TILE; y++) {
        const float *from = work->rows + (y + COARSE - radius) * TILE;
        for (int x = 0; x < TILE; x++) {
            float sum = 0.0f;
            for (int i = 0; i <= 2 * radius; i++)
                sum += from[i * TILE + x];
            work->patch[y * TILE + x] = ppmi_max(scale * sum, 0.0f);
        }
    }
}

static inline float square_between(const tile_work *work, int plane, int at, int to)
{
    float sum = 0.0f;
    for (int c = 0; c < 3; c++) {
        const float difference = work->planes[plane + c][at] - work->planes[plane + c][to];
        sum += difference * difference;
    }
    return sum;
}

/* The largest of the features' distances; of depth it is the distance from the plane that the
 * pixel's surface goes on in (as in SVGF, Schied et al. 2017, equation 3). Neighbours outside the
 * picture are too far. */
static void find_feature_distances(tile_work *work, int dx, int dy)
{
    const float *nearness = work->planes[PPMI_NL_NEARNESS];
    const float *slope_x = work->planes[PPMI_NL_SLOPE], *slope_y = work->planes[PPMI_NL_SLOPE + 1];
    const float *scales = work->planes[PPMI_NL_SCALE];
    const float *normal_scales = work->planes[PPMI_NL_SCALE + 1];
    const float *mask = work->planes[MASK];
    for (int y = 0; y < TILE; y++) {
        const int row = (y + HALO) * SIDE + HALO;
        for (int x = 0; x < TILE; x++) {
            const int at = row + x, to = at + dy * SIDE + dx;
            const float expected = nearness[at] + (float)dx * slope_x[at] + (float)dy * slope_y[at];
            const float off = nearness[to] - expected;
            const float largest = ppmi_max(nearness[at], nearness[to]);
            const float of_depth = nearness_scale * off * off / (largest * largest + 1e-30f);
            const float of_albedo = scales[at] * square_between(work, PPMI_NL_ALBEDO, at, to);
            const float of_normal =
                normal_scales[at] * square_between(work, PPMI_NL_NORMAL, at, to);
            work->feature[y * TILE + x] =
                ppmi_max(ppmi_max(of_depth, of_albedo), of_normal) + 8.0f * (1.0f - mask[to]);
        }
    }
}

/* ---- sums ------------------------------------------------------------------------------------ */

/* The share that two disks of a radius have in common, whose centres are so far apart: how alike
 * the noise of two pixels is that gather the same photons. */
static float overlap(float distance, float radius)
{
    if (distance == 0.0f) return 1.0f;
    const float x = distance / (2.0f * radius);
    if (!(x < 1.0f)) return 0.0f;
    return 2.0f * PPMI_INV_PI * (acosf(x) - x * sqrtf(1.0f - x * x));
}

/* Adds the neighbours at an offset. patch_scale: by how much one pixel's distance counts in the
 * patch's; 0 for a candidate that does not look at the light. */
static void add_neighbours(tile_work *work, window_sums *sums, int dx, int dy, float alike,
                           float patch_scale)
{
    const bool looks = patch_scale > 0.0f;
    for (int c = 0; c < 3; c++) {
        const float *light = work->planes[PPMI_NL_LIGHT + c];
        const float *variance = work->planes[PPMI_NL_VARIANCE + c];
        for (int y = 0; y < TILE; y++) {
            const int row = (y + HALO) * SIDE + HALO;
            for (int x = 0; x < TILE; x++) {
                const int i = y * TILE + x, at = row + x, to = at + dy * SIDE + dx;
                const float patch = looks ? work->patch[i] : 0.0f;
                const float weight = weight_of(ppmi_max(patch, work->feature[i]));
                const float both = variance[at] + variance[to];
                sums->light[c][i] += weight * light[to];
                sums->alike[c][i] += alike * weight * sqrtf(variance[at] * variance[to]);
                if (c == 0) sums->weight[i] += weight;
                if (!looks) continue;
                const float slope = patch > work->feature[i] ? weight * patch_scale : 0.0f;
                const float pull = slope * (light[to] - light[at]) / (1e-30f + color_k2 * both);
                sums->pull[c][i] += pull;
                sums->pulled[c][i] += pull * light[to];
            }
        }
    }
}

static void add_offset(const ppmi_nl_input *input, tile_work *work, int dx, int dy)
{
    const float alike = overlap(sqrtf((float)(dx * dx + dy * dy)), input->correlation_px);
    find_feature_distances(work, dx, dy);
    find_distances(work, dx, dy);
    sum_patches(work, FINE);
    add_neighbours(work, &work->sums[PPMI_DENOISE_FINE], dx, dy, alike, 2.0f / (3 * 9));
    sum_patches(work, COARSE);
    add_neighbours(work, &work->sums[PPMI_DENOISE_COARSE], dx, dy, alike, 2.0f / (3 * 49));
    add_neighbours(work, &work->sums[PPMI_DENOISE_FEATURES], dx, dy, alike, 0.0f);
}

/* Light, and Stein's estimate of its squared error (Stein 1981): (F - u)^2 - V + 2 V dF/du, where
 * V dF/du is the covariance of F and u to first order; with noise that pixels share, of all of the
 * window (Stein's lemma for a covariance matrix). */
static void finish_pixel(const tile_work *work, int candidate, int x, int y, size_t to,
                         const ppmi_nl_output *output)
{
    const window_sums *sums = &work->sums[candidate];
    const int i = y * TILE + x, at = (y + HALO) * SIDE + HALO + x;
    const float scale = 1.0f / sums->weight[i]; /* the pixel itself has a weight of 1 */
    float risk = 0.0f, all = 0.0f;
    for (int c = 0; c < 3; c++) {
        const float u = work->planes[PPMI_NL_LIGHT + c][at];
        const float v = work->planes[PPMI_NL_VARIANCE + c][at];
        const float f = scale * sums->light[c][i];
        const float by_weights = scale * (sums->pulled[c][i] - f * sums->pull[c][i]);
        risk += (f - u) * (f - u) - v + 2.0f * (scale * sums->alike[c][i] + v * by_weights);
        all += v;
        output->light[3 * to + (size_t)c] = f;
    }
    output->risk[to] = all > 0.0f ? ppmi_min(risk / all, 100.0f) : 1.0f;
}

/* Whether there is no noise in the tile: then there is nothing to do, as in most of most layers. */
static bool is_quiet(const tile_work *work)
{
    float sum = 0.0f;
    for (int c = 0; c < 3; c++) {
        for (int i = 0; i < SIDE * SIDE; i++)
            sum += work->planes[PPMI_NL_VARIANCE + c][i];
    }
    return sum == 0.0f;
}

static void do_tile(const ppmi_nl_input *input, uint32_t x0, uint32_t y0, tile_work *work,
                    const ppmi_nl_output *outputs)
{
    load_tile(input, x0, y0, work);
    memset(work->sums, 0, sizeof work->sums);
    const int window = is_quiet(work) ? 0 : WINDOW;
    for (int dy = -window; dy <= window; dy++) {
        for (int dx = -window; dx <= window; dx++)
            add_offset(input, work, dx, dy);
    }
    for (int candidate = 0; candidate < PPMI_DENOISE_CANDIDATES; candidate++) {
        for (int y = 0; y < TILE && y0 + (uint32_t)y < input->height; y++) {
            for (int x = 0; x < TILE && x0 + (uint32_t)x < input->width; x++) {
                const size_t to = (size_t)(y0 + (uint32_t)y) * input->width + x0 + (uint32_t)x;
                finish_pixel(work, candidate, x, y, to, &outputs[candidate]);
            }
        }
    }
}

ppm_status ppmi_nl_means(ppm_context *context, const ppmi_nl_input *input,
                         const ppmi_nl_output outputs[PPMI_DENOISE_CANDIDATES])
{
    const uint32_t columns = (input->width + TILE - 1) / TILE;
    const uint32_t tiles = columns * ((input->height + TILE - 1) / TILE);
    tile_work *works = ppmi_alloc(context, input->threads, sizeof *works);
    if (!works) {
        return ppmi_fail(context, PPM_STATUS_OUT_OF_MEMORY,
                         "out of memory: the denoiser's tiles for %u threads", input->threads);
    }
#pragma omp parallel for num_threads((int)input->threads) schedule(dynamic, 1)
    for (uint32_t i = 0; i < tiles; i++) {
        do_tile(input, i % columns * TILE, i / columns * TILE, &works[omp_get_thread_num()],
                outputs);
    }
    ppmi_free(context, works);
    return PPM_STATUS_OK;
}
