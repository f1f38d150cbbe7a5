/* Building and reading the hash grid. */
#include "photon/grid.h"

#include <math.h>
#include <omp.h>
#include <stdatomic.h>
#include <string.h>

#define FREE_KEY UINT64_MAX

/* ---- Morton codes ---------------------------------------------------------------------------- */

/* Spreads the lower 21 bits to every third bit. */
static inline uint64_t spread_bits(uint64_t x)
{
    x &= 0x1fffff;
    x = (x | x << 32) & 0x1f00000000ffffu;
    x = (x | x << 16) & 0x1f0000ff0000ffu;
    x = (x | x << 8) & 0x100f00f00f00f00fu;
    x = (x | x << 4) & 0x10c30c30c30c30c3u;
    x = (x | x << 2) & 0x1249249249249249u;
    return x;
}

static inline uint32_t coordinate(float x, float origin, float inverse_cell)
{
    const float scaled = (x - origin) * inverse_cell;
    const float last = (float)((1u << PPMI_GRID_BITS) - 1u);
    return (uint32_t)ppmi_min(ppmi_max(scaled, 0.0f), last);
}

static inline uint64_t photon_code(const ppmi_photon_grid *grid, ppmi_vec3 p)
{
    return spread_bits(coordinate(p.x, grid->origin.x, grid->inverse_cell)) |
           spread_bits(coordinate(p.y, grid->origin.y, grid->inverse_cell)) << 1 |
           spread_bits(coordinate(p.z, grid->origin.z, grid->inverse_cell)) << 2;
}

/* ---- sorting --------------------------------------------------------------------------------- */

enum { DIGIT_BITS = 11, DIGITS = 1 << DIGIT_BITS, DIGIT_PASSES = 6 };

static inline uint32_t digit_of(uint64_t code, uint32_t pass)
{
    return (uint32_t)(code >> (pass * DIGIT_BITS)) & (DIGITS - 1u);
}

/* One thread's share of 0 .. count. */
static void share_of(uint32_t count, uint32_t thread, uint32_t threads, uint32_t *begin,
                     uint32_t *end)
{
    *begin = (uint32_t)((uint64_t)count * thread / threads);
    *end = (uint32_t)((uint64_t)count * (thread + 1) / threads);
}

/* Turns the threads' digit counts into their first places. False when all share one digit: nothing
 * would move. */
static bool prefix_histograms(uint32_t *histograms, uint32_t threads, uint32_t count)
{
    uint32_t place = 0;
    for (uint32_t digit = 0; digit < DIGITS; digit++) {
        const uint32_t before = place;
        for (uint32_t t = 0; t < threads; t++) {
            uint32_t *entry = &histograms[(size_t)t * DIGITS + digit];
            const uint32_t occurrences = *entry;
            *entry = place;
            place += occurrences;
        }
        if (place - before == count) return false;
    }
    return true;
}

/* A stable sort by digits from the lowest: the result does not depend on the number of threads. */
static void radix_sort(ppmi_photon_grid *grid, uint32_t threads)
{
    const uint32_t count = grid->count;
    for (uint32_t pass = 0; pass < DIGIT_PASSES; pass++) {
        bool moves = true;
#pragma omp parallel num_threads((int)threads)
        {
            const uint32_t thread = (uint32_t)omp_get_thread_num();
            const uint32_t team = (uint32_t)omp_get_num_threads();
            uint32_t *histogram = grid->histograms + (size_t)thread * DIGITS;
            uint32_t begin, end;
            share_of(count, thread, team, &begin, &end);
            memset(histogram, 0, DIGITS * sizeof *histogram);
            for (uint32_t i = begin; i < end; i++)
                histogram[digit_of(grid->codes[i], pass)]++;
#pragma omp barrier
#pragma omp single
            moves = prefix_histograms(grid->histograms, team, count);
            for (uint32_t i = begin; moves && i < end; i++) {
                const uint32_t place = histogram[digit_of(grid->codes[i], pass)]++;
                grid->codes_swap[place] = grid->codes[i];
                grid->order_swap[place] = grid->order[i];
            }
        }
        if (!moves) continue;
        uint64_t *codes = grid->codes;
        grid->codes = grid->codes_swap;
        grid->codes_swap = codes;
        uint32_t *order = grid->order;
        grid->order = grid->order_swap;
        grid->order_swap = order;
    }
}

/* ---- building -------------------------------------------------------------------------------- */

static void free_arrays(ppm_context *context, ppmi_photon_grid *grid)
{
    ppmi_free(context, grid->x);
    ppmi_free(context, grid->y);
    ppmi_free(context, grid->z);
    ppmi_free(context, grid->payloads);
    ppmi_free(context, grid->codes);
    ppmi_free(context, grid->codes_swap);
    ppmi_free(context, grid->order);
    ppmi_free(context, grid->order_swap);
}

void ppmi_photon_grid_deinit(ppm_context *context, ppmi_photon_grid *grid)
{
    free_arrays(context, grid);
    ppmi_free(context, grid->histograms);
    ppmi_free(context, grid->table);
    *grid = (ppmi_photon_grid){0};
}

static bool reserve_arrays(ppm_context *context, ppmi_photon_grid *grid, size_t count)
{
    if (count <= grid->capacity) return true;
    free_arrays(context, grid);
    const size_t capacity = count + count / 4;
    grid->x = ppmi_alloc(context, capacity + 8, sizeof *grid->x); /* 8: vector loads at the end */
    grid->y = ppmi_alloc(context, capacity + 8, sizeof *grid->y);
    grid->z = ppmi_alloc(context, capacity + 8, sizeof *grid->z);
    grid->payloads = ppmi_alloc(context, capacity, sizeof *grid->payloads);
    grid->codes = ppmi_alloc(context, capacity, sizeof *grid->codes);
    grid->codes_swap = ppmi_alloc(context, capacity, sizeof *grid->codes_swap);
    grid->order = ppmi_alloc(context, capacity, sizeof *grid->order);
    grid->order_swap = ppmi_alloc(context, capacity, sizeof *grid->order_swap);
    const bool has_all = grid->x && grid->y && grid->z && grid->payloads && grid->codes &&
                         grid->codes_swap && grid->order && grid->order_swap;
    grid->capacity = has_all ? (uint32_t)capacity : 0;
    return has_all;
}

static bool reserve_histograms(ppm_context *context, ppmi_photon_grid *grid, uint32_t threads)
{
    if (threads <= grid->histogram_threads) return true;
    ppmi_free(context, grid->histograms);
    grid->histograms = ppmi_alloc(context, (size_t)threads * DIGITS, sizeof *grid->histograms);
    grid->histogram_threads = grid->histograms ? threads : 0;
    return grid->histograms != NULL;
}

/* The bounding cube, a little enlarged. */
static void measure(ppmi_photon_grid *grid, const ppmi_photon *photons)
{
    float low[3] = {INFINITY, INFINITY, INFINITY}, high[3] = {-INFINITY, -INFINITY, -INFINITY};
    for (uint32_t i = 0; i < grid->count; i++) {
        const float p[3] = {photons[i].position.x, photons[i].position.y, photons[i].position.z};
        for (int k = 0; k < 3; k++) {
            low[k] = p[k] < low[k] ? p[k] : low[k];
            high[k] = p[k] > high[k] ? p[k] : high[k];
        }
    }
    float side = 0.0f;
    grid->magnitude = 0.0f;
    for (int k = 0; k < 3; k++) {
        side = ppmi_max(side, high[k] - low[k]);
        grid->magnitude = ppmi_max(grid->magnitude, ppmi_max(fabsf(low[k]), fabsf(high[k])));
    }
    side = ppmi_max(side * 1.0001f, ppmi_max(grid->magnitude * 1e-6f, 1e-30f));
    grid->origin = vec3(low[0], low[1], low[2]);
    grid->cell = side / (float)(1u << PPMI_GRID_BITS);
    grid->inverse_cell = 1.0f / grid->cell;
}

/* The finest level whose cells are not smaller than the radius. */
static uint32_t level_for(const ppmi_photon_grid *grid, float radius)
{
    uint32_t level = 0;
    float cell = grid->cell;
    while (level < PPMI_GRID_BITS && cell < radius) {
        cell *= 2.0f;
        level++;
    }
    return level;
}

/* A mark just above the 63 - 3 level bits of a cell keeps the levels apart. No key is FREE_KEY: the
 * bounding cube is enlarged, so that its last corner cell stays empty. */
static inline uint64_t cell_key(uint64_t code, uint32_t level)
{
    return code >> (3 * level) | (uint64_t)1 << (63 - 3 * level);
}

/* The eight cells of a block of two by two by two lie side by side: a look-up visits neighbours. */
static inline uint64_t slot_of(const ppmi_photon_grid *grid, uint64_t key)
{
    uint64_t block = key >> 3;
    block ^= block >> 32;
    block *= 0x9e3779b97f4a7c15u;
    block ^= block >> 29;
    return (block << 3 | (key & 7)) & grid->table_mask;
}

static void insert(ppmi_photon_grid *grid, uint64_t key, uint32_t begin, uint32_t end)
{
    uint64_t slot = slot_of(grid, key);
    for (;;) {
        _Atomic uint64_t *place = (_Atomic uint64_t *)&grid->table[slot].key;
        uint64_t expected = FREE_KEY;
        if (atomic_compare_exchange_strong_explicit(place, &expected, key, memory_order_relaxed,
                                                    memory_order_relaxed)) {
            grid->table[slot].begin = begin;
            grid->table[slot].end = end;
            return;
        }
        slot = (slot + 1) & grid->table_mask;
    }
}

static inline bool starts_cell(const uint64_t *codes, uint32_t i, uint32_t level)
{
    return i == 0 || codes[i] >> (3 * level) != codes[i - 1] >> (3 * level);
}

static uint64_t count_cells(const ppmi_photon_grid *grid, uint32_t level, uint32_t threads)
{
    uint64_t cells = 0;
#pragma omp parallel for num_threads((int)threads) reduction(+ : cells) schedule(static)
    for (uint32_t i = 0; i < grid->count; i++)
        cells += starts_cell(grid->codes, i, level);
    return cells;
}

/* Enters all cells of a level: each by the thread that holds its first photon. */
static void fill_level(ppmi_photon_grid *grid, uint32_t level, uint32_t threads)
{
    const uint64_t *codes = grid->codes;
    const uint32_t count = grid->count;
#pragma omp parallel num_threads((int)threads)
    {
        uint32_t i, share_end;
        share_of(count, (uint32_t)omp_get_thread_num(), (uint32_t)omp_get_num_threads(), &i,
                 &share_end);
        while (i < share_end && !starts_cell(codes, i, level))
            i++;
        while (i < share_end) {
            const uint32_t begin = i++;
            while (i < count && !starts_cell(codes, i, level))
                i++;
            insert(grid, cell_key(codes[begin], level), begin, i);
        }
    }
}

/* Levels from the finest wanted one up. Coarser levels have ever fewer cells: on surfaces all
 * together have about a third of the finest one's. */
static bool build_table(ppm_context *context, ppmi_photon_grid *grid, float typical_radius,
                        uint32_t threads)
{
    grid->finest_level = level_for(grid, typical_radius);
    uint64_t cells = 0;
    for (uint32_t level = grid->finest_level; level <= PPMI_GRID_BITS; level++) {
        cells += count_cells(grid, level, threads);
    }
    uint64_t slots = 64;
    while (slots < 2 * cells)
        slots *= 2;
    if (slots > grid->table_capacity) {
        ppmi_free(context, grid->table);
        grid->table = ppmi_alloc(context, slots, sizeof *grid->table);
        grid->table_capacity = grid->table ? slots : 0;
        if (!grid->table) return false;
    }
    grid->table_mask = slots - 1;
#pragma omp parallel for num_threads((int)threads) schedule(static)
    for (uint64_t i = 0; i < slots; i++)
        grid->table[i].key = FREE_KEY;
    for (uint32_t level = grid->finest_level; level <= PPMI_GRID_BITS; level++) {
        fill_level(grid, level, threads);
    }
    return true;
}

static void compute_codes(ppmi_photon_grid *grid, const ppmi_photon *photons, uint32_t threads)
{
#pragma omp parallel for num_threads((int)threads) schedule(static)
    for (uint32_t i = 0; i < grid->count; i++) {
        grid->codes[i] = photon_code(grid, photons[i].position);
        grid->order[i] = i;
    }
}

static void reorder(ppmi_photon_grid *grid, const ppmi_photon *photons, uint32_t threads)
{
#pragma omp parallel for num_threads((int)threads) schedule(static)
    for (uint32_t i = 0; i < grid->count; i++) {
        const ppmi_photon *photon = &photons[grid->order[i]];
        grid->x[i] = photon->position.x;
        grid->y[i] = photon->position.y;
        grid->z[i] = photon->position.z;
        grid->payloads[i] =
            (ppmi_photon_payload){photon->wi, photon->power, photon->ng, photon->crowding};
    }
}

ppm_status ppmi_photon_grid_build(ppm_context *context, ppmi_photon_grid *grid,
                                  const ppmi_photon *photons, size_t count, float typical_radius,
                                  uint32_t threads)
{
    grid->count = 0;
    if (count == 0) return PPM_STATUS_OK;
    if (count >= UINT32_MAX / 2 || !reserve_arrays(context, grid, count) ||
        !reserve_histograms(context, grid, threads)) {
        return ppmi_fail(context, PPM_STATUS_OUT_OF_MEMORY, "out of memory: grid of %zu photons",
                         count);
    }
    grid->count = (uint32_t)count;
    measure(grid, photons);
    compute_codes(grid, photons, threads);
    radix_sort(grid, threads);
    reorder(grid, photons, threads);
    if (!build_table(context, grid, typical_radius, threads)) {
        grid->count = 0;
        return ppmi_fail(context, PPM_STATUS_OUT_OF_MEMORY, "out of memory: photon hash table");
    }
    return PPM_STATUS_OK;
}

/* ---- look-up --------------------------------------------------------------------------------- */

static const ppmi_grid_entry *find(const ppmi_photon_grid *grid, uint64_t key)
{
    uint64_t slot = slot_of(grid, key);
    while (grid->table[slot].key != FREE_KEY) {
        if (grid->table[slot].key == key) return &grid->table[slot];
        slot = (slot + 1) & grid->table_mask;
    }
    return NULL;
}

/* Cells of one axis that the interval p +- radius touches: first and last. False outside. */
static bool axis_range(float p, float radius, float origin, float inverse_cell, uint32_t level,
                       uint32_t *first, uint32_t *last)
{
    const float extent = (float)(1u << PPMI_GRID_BITS);
    const float low = (p - radius - origin) * inverse_cell;
    const float high = (p + radius - origin) * inverse_cell;
    if (!(high >= 0.0f) || !(low < extent)) return false;
    *first = (uint32_t)ppmi_max(low, 0.0f) >> level;
    *last = (uint32_t)ppmi_min(high, extent - 1.0f) >> level;
    return true;
}

uint32_t ppmi_photon_grid_lookup(const ppmi_photon_grid *grid, ppmi_vec3 p, float radius,
                                 ppmi_vec3 n, float thickness,
                                 ppmi_photon_run out_runs[PPMI_GRID_MAX_RUNS])
{
    if (grid->count == 0) return 0;
    /* rounding of coordinates must not lose a photon at the rim */
    radius += radius * 1e-5f + grid->magnitude * 4e-7f;
    thickness += radius * 1e-5f + grid->magnitude * 4e-7f;
    uint32_t level = level_for(grid, radius);
    if (level < grid->finest_level) level = grid->finest_level;
    uint32_t first[3], last[3];
    if (!axis_range(p.x, radius, grid->origin.x, grid->inverse_cell, level, &first[0], &last[0]) ||
        !axis_range(p.y, radius, grid->origin.y, grid->inverse_cell, level, &first[1], &last[1]) ||
        !axis_range(p.z, radius, grid->origin.z, grid->inverse_cell, level, &first[2], &last[2])) {
        return 0;
    }
    const float side = grid->cell * (float)(1u << level);
    /* half of a cell's extent along n */
    const float reach = 0.5f * side * (fabsf(n.x) + fabsf(n.y) + fabsf(n.z)) + thickness;
    uint32_t runs = 0;
    for (uint32_t z = first[2]; z <= last[2]; z++) {
        const float dz = grid->origin.z + ((float)z + 0.5f) * side - p.z;
        const uint64_t code_z = spread_bits(z) << 2;
        for (uint32_t y = first[1]; y <= last[1]; y++) {
            const float dy = grid->origin.y + ((float)y + 0.5f) * side - p.y;
            const uint64_t code_yz = spread_bits(y) << 1 | code_z;
            for (uint32_t x = first[0]; x <= last[0]; x++) {
                const float dx = grid->origin.x + ((float)x + 0.5f) * side - p.x;
                if (fabsf(dx * n.x + dy * n.y + dz * n.z) > reach) continue;
                const uint64_t code = (spread_bits(x) | code_yz) << (3 * level);
                const ppmi_grid_entry *entry = find(grid, cell_key(code, level));
                if (entry) out_runs[runs++] = (ppmi_photon_run){entry->begin, entry->end};
            }
        }
    }
    return runs;
}
