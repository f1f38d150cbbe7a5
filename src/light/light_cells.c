/* Cells of probes: a kd-tree for each side that normals face, parted at medians. */
#include "light/light_cells.h"

#include <stdlib.h>

enum { CELL_PROBES = 24 }; /* a cell with more is parted */

/* What is known of the cell around, or for all probes that everything arrives, counts like as many
 * probes. Where no probe is lit, it gets less from cell to cell: a sky promises a closed room ten
 * thousand times what its lamp does. */
static const float prior_probes = 1.0f;

typedef struct sort_key {
    float at;
    uint32_t probe;
} sort_key;

typedef struct cell_builder {
    const ppmi_light_probe *probes;
    ppmi_light_cells *cells;
    sort_key *keys;
} cell_builder;

static int compare_keys(const void *a, const void *b)
{
    const sort_key *x = a, *y = b;
    if (x->at != y->at) return x->at < y->at ? -1 : 1;
    return x->probe < y->probe ? -1 : x->probe > y->probe;
}

static float component(ppmi_vec3 v, uint32_t axis)
{
    return axis == 0 ? v.x : axis == 1 ? v.y : v.z;
}

/* The axis that a normal is closest to, with its sign. */
static uint32_t side_of(ppmi_vec3 n)
{
    if (!(vec3_length2(n) > 0.0f)) return PPMI_CELL_SIDES - 1;
    const float x = fabsf(n.x), y = fabsf(n.y), z = fabsf(n.z);
    const uint32_t axis = x >= y && x >= z ? 0 : y >= z ? 1 : 2;
    return 2 * axis + (component(n, axis) < 0.0f ? 1 : 0);
}

/* ---- worth ----------------------------------------------------------------------------------- */

/* Mean squares of the probes of some keys, drawn to those of the cell around by a few probes. */
static void mean_squares(const cell_builder *builder, uint32_t first, uint32_t end,
                         const float *around, float *out_squares)
{
    for (uint32_t c = 0; c < builder->cells->choices; c++) {
        float sum = prior_probes * around[c], count = prior_probes;
        for (uint32_t i = first; i < end; i++) {
            const float share = builder->probes[builder->keys[i].probe].shares[c];
            if (share < 0.0f) continue;
            sum += share * share;
            count += 1.0f;
        }
        out_squares[c] = sum / count;
    }
}

static void add_row(ppmi_light_cells *cells, const float *squares)
{
    float *row = cells->worth + (size_t)cells->choices * cells->row_count++;
    for (uint32_t c = 0; c < cells->choices; c++)
        row[c] = sqrtf(squares[c]);
}

/* ---- building -------------------------------------------------------------------------------- */

static void sort_by(const cell_builder *builder, uint32_t first, uint32_t end, uint32_t axis)
{
    for (uint32_t i = first; i < end; i++) {
        const uint32_t probe = builder->keys[i].probe;
        builder->keys[i].at = component(builder->probes[probe].receiver.position, axis);
    }
    qsort(builder->keys + first, end - first, sizeof *builder->keys, compare_keys);
}

static uint32_t longest_axis(const cell_builder *builder, uint32_t first, uint32_t end)
{
    ppmi_vec3 low = vec3_splat(INFINITY), high = vec3_splat(-INFINITY);
    for (uint32_t i = first; i < end; i++) {
        const ppmi_vec3 p = builder->probes[builder->keys[i].probe].receiver.position;
        low = vec3(ppmi_min(low.x, p.x), ppmi_min(low.y, p.y), ppmi_min(low.z, p.z));
        high = vec3(ppmi_max(high.x, p.x), ppmi_max(high.y, p.y), ppmi_max(high.z, p.z));
    }
    const ppmi_vec3 extent = vec3_sub(high, low);
    return extent.x >= extent.y && extent.x >= extent.z ? 0 : extent.y >= extent.z ? 1 : 2;
}

/* The key nearest to the middle that is above the one before; first where all are the same. */
static uint32_t median(const cell_builder *builder, uint32_t first, uint32_t end)
{
    const uint32_t middle = first + (end - first) / 2;
    for (uint32_t step = 0; step <= middle - first; step++) {
        const uint32_t low = middle - step, high = middle + step;
        if (low > first && builder->keys[low - 1].at < builder->keys[low].at) return low;
        if (high < end && builder->keys[high - 1].at < builder->keys[high].at) return high;
    }
    return first;
}

static void add_cells(cell_builder *builder, uint32_t first, uint32_t end, const float *around)
{
    ppmi_light_cells *cells = builder->cells;
    const uint32_t index = cells->cell_count++;
    float squares[PPMI_LIGHT_CHOICES];
    mean_squares(builder, first, end, around, squares);
    uint32_t middle = first, axis = 3;
    if (end - first > CELL_PROBES) {
        axis = longest_axis(builder, first, end);
        sort_by(builder, first, end, axis);
        middle = median(builder, first, end);
    }
    if (middle == first) {
        cells->cells[index] = (ppmi_light_cell){.axis = 3, .next = cells->row_count};
        add_row(cells, squares);
        return;
    }
    cells->cells[index].axis = axis;
    cells->cells[index].at = builder->keys[middle].at;
    add_cells(builder, first, middle, squares);
    cells->cells[index].next = cells->cell_count;
    add_cells(builder, middle, end, squares);
}

/* Keys by side, in the order of the probes. */
static void build(cell_builder *builder, uint32_t count)
{
    float squares[PPMI_LIGHT_CHOICES];
    for (uint32_t c = 0; c < builder->cells->choices; c++)
        squares[c] = 1.0f;
    for (uint32_t i = 0; i < count; i++)
        builder->keys[i].probe = i;
    mean_squares(builder, 0, count, squares, squares);
    add_row(builder->cells, squares);
    uint32_t end = 0;
    for (uint32_t side = 0; side < PPMI_CELL_SIDES; side++) {
        const uint32_t first = end;
        for (uint32_t i = 0; i < count; i++) {
            if (side_of(builder->probes[i].receiver.normal) == side) {
                builder->keys[end++].probe = i;
            }
        }
        builder->cells->roots[side] = end > first ? builder->cells->cell_count : UINT32_MAX;
        if (end > first) add_cells(builder, first, end, squares);
    }
}

ppm_status ppmi_light_cells_init(ppm_context *context, ppmi_light_cells *cells,
                                 const ppmi_light_probe *probes, uint32_t count, uint32_t choices)
{
    *cells = (ppmi_light_cells){.choices = choices};
    if (count == 0) return PPM_STATUS_OK;
    cell_builder builder = {.probes = probes, .cells = cells};
    builder.keys = ppmi_alloc(context, count, sizeof *builder.keys);
    cells->cells = ppmi_alloc(context, count, 2 * sizeof *cells->cells);
    cells->worth = ppmi_alloc(context, count + 1u, choices * sizeof *cells->worth);
    if (!builder.keys || !cells->cells || !cells->worth) {
        ppmi_free(context, builder.keys);
        ppmi_light_cells_deinit(context, cells);
        return ppmi_fail(context, PPM_STATUS_OUT_OF_MEMORY, "out of memory: light cells");
    }
    build(&builder, count);
    ppmi_free(context, builder.keys);
    return PPM_STATUS_OK;
}

void ppmi_light_cells_deinit(ppm_context *context, ppmi_light_cells *cells)
{
    ppmi_free(context, cells->cells);
    ppmi_free(context, cells->worth);
    *cells = (ppmi_light_cells){0};
}

const float *ppmi_light_cells_worth(const ppmi_light_cells *cells, const ppmi_receiver *receiver)
{
    if (cells->row_count == 0) return NULL;
    uint32_t i = cells->roots[side_of(receiver->normal)];
    if (i == UINT32_MAX) return cells->worth;
    const float p[3] = {receiver->position.x, receiver->position.y, receiver->position.z};
    while (cells->cells[i].axis < 3) {
        const ppmi_light_cell *cell = &cells->cells[i];
        i = p[cell->axis] < cell->at ? i + 1 : cell->next;
    }
    return cells->worth + (size_t)cells->choices * cells->cells[i].next;
}
