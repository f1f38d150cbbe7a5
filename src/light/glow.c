/* Trees of triangles: drawing, densities, and how they are cut.
 *
 * The cut is that of least cost (Breiman et al. 1984, "Classification and Regression Trees",
 * chapter 3: minimal cost-complexity pruning). A part that is drawn from evenly, with the
 * probability of its mean, adds its area times variance / mean to the second moment of f / p; a
 * node is worth keeping if its parts together add less, by more than a price for each. One pass
 * from the finest parts upwards finds the best tree. */
#include "light/glow.h"

#include <math.h>
#include <string.h>

/* Of the probability, spread evenly over a triangle: what lies between the places that were looked
 * at is drawn too. */
static const double even_share = 1.0 / 32.0;

/* ---- drawing --------------------------------------------------------------------------------- */

/* A part of a triangle: its first corner, and the side that the others are away by, below 0 where
 * it is turned round. */
typedef struct part {
    double u, v, side;
} part;

static part part_of(part whole, uint32_t child)
{
    const double half = 0.5 * whole.side;
    switch (child) {
    case 0:
        return (part){whole.u, whole.v, half};
    case 1:
        return (part){whole.u + half, whole.v, half};
    case 2:
        return (part){whole.u, whole.v + half, half};
    default:
        return (part){whole.u + half, whole.v + half, -half};
    }
}

static float probability(const ppmi_glow_node *node, uint32_t child)
{
    switch (child) {
    case 0:
        return node->left * node->low[0];
    case 1:
        return (1.0f - node->left) * node->low[1];
    case 2:
        return node->left * (1.0f - node->low[0]);
    default:
        return (1.0f - node->left) * (1.0f - node->low[1]);
    }
}

/* Whether u falls to a share; what is left of it is even again. */
static bool take(double *u, float share)
{
    const double s = (double)share;
    const bool is_taken = *u < s;
    *u = is_taken ? *u / s : (*u - s) / (1.0 - s);
    if (!(*u < 1.0)) *u = 0x1.fffffffffffffp-1;
    return is_taken;
}

static uint32_t draw_child(const ppmi_glow_node *node, double *u, double *v)
{
    if (take(u, node->left)) return take(v, node->low[0]) ? 0 : 2;
    return take(v, node->low[1]) ? 1 : 3;
}

ppmi_vec2 ppmi_glow_sample(const ppmi_glow *glow, uint32_t root, double u, double v,
                           float *out_density)
{
    part at = {0.0, 0.0, 1.0};
    *out_density = 1.0f;
    for (uint32_t i = root; i != PPMI_GLOW_EVEN;) {
        const ppmi_glow_node *node = &glow->nodes[i];
        const uint32_t child = draw_child(node, &u, &v);
        *out_density *= 4.0f * probability(node, child);
        at = part_of(at, child);
        i = node->children[child];
    }
    const float largest = 0x1.fffffep-1f;
    const ppmi_vec2 p =
        ppmi_sample_triangle(ppmi_min((float)u, largest), ppmi_min((float)v, largest));
    return (ppmi_vec2){(float)(at.u + at.side * (double)p.x),
                       (float)(at.v + at.side * (double)p.y)};
}

float ppmi_glow_density(const ppmi_glow *glow, uint32_t root, float u, float v)
{
    double x = (double)u, y = (double)v;
    float density = 1.0f;
    for (uint32_t i = root; i != PPMI_GLOW_EVEN;) {
        const ppmi_glow_node *node = &glow->nodes[i];
        uint32_t child;
        if (x >= 0.5) {
            child = 1;
            x -= 0.5;
        } else if (y >= 0.5) {
            child = 2;
            y -= 0.5;
        } else if (x + y <= 0.5) {
            child = 0;
        } else {
            child = 3;
            x = 0.5 - x;
            y = 0.5 - y;
        }
        x *= 2.0;
        y *= 2.0;
        density *= 4.0f * probability(node, child);
        i = node->children[child];
    }
    return density;
}

/* ---- building -------------------------------------------------------------------------------- */

static double corner_at(const ppmi_glow_lattice *lattice, int64_t column, int64_t row)
{
    return (double)
        lattice->corners[ppmi_glow_row_start(lattice->side, (uint32_t)row) + (size_t)column];
}

/* A place counts in the small triangles around it: six within, three on an edge, one at a corner.
 */
static double row_sum(const ppmi_glow_lattice *lattice, uint32_t row)
{
    const float *values = lattice->corners + ppmi_glow_row_start(lattice->side, row);
    const uint32_t last = lattice->side - row;
    double inner = 0.0;
    for (uint32_t i = 1; i < last; i++)
        inner += (double)values[i];
    const bool is_edge = row == 0;
    const double ends = (double)values[0] + (last > 0 ? (double)values[last] : 0.0);
    if (last == 0) return ends;
    return (is_edge ? 3.0 : 6.0) * inner + (is_edge ? 1.0 : 3.0) * ends;
}

double ppmi_glow_mean_of_middles(const ppmi_glow_lattice *lattice)
{
    const size_t count = (size_t)lattice->side * lattice->side;
    double sum = 0.0;
    for (size_t i = 0; i < count; i++)
        sum += (double)lattice->middles[i];
    return sum / (double)count;
}

double ppmi_glow_mean_of_corners(const ppmi_glow_lattice *lattice)
{
    double sum = 0.0;
    for (uint32_t row = 0; row <= lattice->side; row++)
        sum += row_sum(lattice, row);
    return sum / (3.0 * (double)lattice->side * (double)lattice->side);
}

typedef struct builder {
    ppm_context *context;
    ppmi_glow *glow;
    const ppmi_glow_lattice *lattice;
    double floor; /* added to every value */
    double node_cost;
    bool is_out_of_memory;
} builder;

/* Of a part, area in small triangles. */
typedef struct tally {
    double mass, squares; /* integrals of the value and its square */
    double cost;
    uint32_t node;
} tally;

static bool push(builder *b, const ppmi_glow_node *node)
{
    ppmi_glow *glow = b->glow;
    if (glow->count == glow->capacity) {
        const uint32_t capacity = glow->capacity > 0 ? 2 * glow->capacity : 1024;
        ppmi_glow_node *nodes = ppmi_alloc(b->context, capacity, sizeof *nodes);
        if (!nodes) return false;
        if (glow->count > 0) memcpy(nodes, glow->nodes, glow->count * sizeof *nodes);
        ppmi_free(b->context, glow->nodes);
        glow->nodes = nodes;
        glow->capacity = capacity;
    }
    glow->nodes[glow->count++] = *node;
    return true;
}

static float share(double one, double other)
{
    return one + other > 0.0 ? (float)(one / (one + other)) : 0.5f;
}

static ppmi_glow_node node_of(const tally children[4], double floor)
{
    double mass[4];
    for (int k = 0; k < 4; k++)
        mass[k] = children[k].mass + floor;
    return (ppmi_glow_node){
        .left = share(mass[0] + mass[2], mass[1] + mass[3]),
        .low = {share(mass[0], mass[2]), share(mass[1], mass[3])},
        .children = {children[0].node, children[1].node, children[2].node, children[3].node}};
}

/* Half by its middle, half by its corners: what is bright beside it may reach into it. */
static tally smallest(const builder *b, int64_t column, int64_t row, int64_t side)
{
    const ppmi_glow_lattice *lattice = b->lattice;
    const double corners = corner_at(lattice, column, row) +
                           corner_at(lattice, column + side, row) +
                           corner_at(lattice, column, row + side);
    const size_t middle =
        ppmi_glow_middle_at(lattice->side, (uint32_t)column, (uint32_t)row, side < 0);
    const double value = 0.5 * (double)lattice->middles[middle] + corners / 6.0;
    return (tally){value, value * value, b->node_cost, PPMI_GLOW_EVEN};
}

/* The best tree of a part, whose nodes are the last of the list. */
static tally build(builder *b, int64_t column, int64_t row, int64_t side)
{
    if (side == 1 || side == -1) return smallest(b, column, row, side);
    const int64_t half = side / 2;
    const uint32_t begin = b->glow->count;
    const tally children[4] = {build(b, column, row, half), build(b, column + half, row, half),
                               build(b, column, row + half, half),
                               build(b, column + half, row + half, -half)};
    tally sum = {.node = PPMI_GLOW_EVEN};
    for (int k = 0; k < 4; k++) {
        sum.mass += children[k].mass;
        sum.squares += children[k].squares;
        sum.cost += children[k].cost;
    }
    const double area = (double)side * (double)side, mean = sum.mass / area;
    const double variance = fmax(sum.squares - sum.mass * mean, 0.0);
    const double even = variance / (mean + b->floor) + b->node_cost;
    if (even > sum.cost) {
        const ppmi_glow_node node = node_of(children, 0.25 * area * b->floor);
        b->is_out_of_memory = b->is_out_of_memory || !push(b, &node);
        sum.node = b->glow->count - 1;
        return sum;
    }
    b->glow->count = begin;
    sum.cost = even;
    return sum;
}

ppm_status ppmi_glow_add(ppm_context *context, ppmi_glow *glow, const ppmi_glow_lattice *lattice,
                         double node_cost, uint32_t *out_root)
{
    const double mean =
        0.5 * (ppmi_glow_mean_of_middles(lattice) + ppmi_glow_mean_of_corners(lattice));
    const double cells = (double)lattice->side * (double)lattice->side;
    *out_root = PPMI_GLOW_EVEN;
    if (!(mean > 0.0)) return PPM_STATUS_OK;
    builder b = {.context = context,
                 .glow = glow,
                 .lattice = lattice,
                 .floor = mean * even_share / (1.0 - even_share),
                 .node_cost = node_cost * cells};
    *out_root = build(&b, 0, 0, lattice->side).node;
    if (!b.is_out_of_memory) return PPM_STATUS_OK;
    return ppmi_fail(context, PPM_STATUS_OUT_OF_MEMORY, "out of memory: emissive textures");
}

void ppmi_glow_deinit(ppm_context *context, ppmi_glow *glow)
{
    ppmi_free(context, glow->nodes);
    *glow = (ppmi_glow){0};
}
