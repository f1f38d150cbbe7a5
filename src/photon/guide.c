/* Learning and drawing. */
#include "photon/guide.h"

#include <math.h>

enum { BINS = 8, MAX_DEPTH = 48 };

/* ---- learning -------------------------------------------------------------------------------- */

/* A node while the tree grows: the photons in its cell, and what they say. */
typedef struct cell {
    ppmi_guide_seen *seen;
    size_t count;
    double low[PPMI_GUIDE_AXES], size[PPMI_GUIDE_AXES];
    double volume;
    double depth;
} cell;

typedef struct growth {
    ppmi_photon_guide *guide;
    double brings[PPMI_GUIDE_MAX_NODES]; /* what photons of the cell bring */
    double used[PPMI_GUIDE_MAX_NODES];   /* the share of its photons that are gathered */
    double mass[PPMI_GUIDE_MAX_NODES];   /* what it is worth, see weigh_leaves */
    double volume[PPMI_GUIDE_MAX_NODES];
} growth;

/* The sum of a cell's weights, and the number of photons of equal weight that say as much. */
static double weigh(const cell *c, double *out_effective)
{
    double sum = 0.0, squares = 0.0;
    for (size_t i = 0; i < c->count; i++) {
        sum += c->seen[i].weight;
        squares += c->seen[i].weight * c->seen[i].weight;
    }
    *out_effective = squares > 0.0 ? sum * sum / squares : 0.0;
    return sum;
}

/* The share of even photons in a cell that are gathered. */
static double used_share(const cell *c)
{
    double used = 0.0;
    for (size_t i = 0; i < c->count; i++)
        used += c->seen[i].volume;
    return fmin(used / c->volume, 1.0);
}

/* How like each other slices of the cell along an axis are: the coefficient of Bhattacharyya of
 * what they bring and even bars, 1 for alike. */
static double sliced(const cell *c, int axis, double weight)
{
    double bins[BINS] = {0.0};
    for (size_t i = 0; i < c->count; i++) {
        const double at = (c->seen[i].sample.x[axis] - c->low[axis]) / c->size[axis];
        const int bin = (int)(at * BINS);
        bins[bin < 0 ? 0 : bin < BINS ? bin : BINS - 1] += c->seen[i].weight;
    }
    double sum = 0.0;
    for (int i = 0; i < BINS; i++)
        sum += sqrt(bins[i] / BINS);
    return sum / sqrt(weight);
}

/* The axis that tells a cell's photons apart best; -1 where the difference may be chance. */
static int axis_of(const cell *c)
{
    const double least_photons = 24.0, least_gain = 0.02, chance = 1.5;
    double effective;
    const double weight = weigh(c, &effective);
    if (effective < least_photons) return -1;
    double best = 1.0 - least_gain - chance * (BINS - 1) / (8.0 * effective);
    int best_axis = -1;
    for (int axis = 0; axis < PPMI_GUIDE_AXES; axis++) {
        const double left = sliced(c, axis, weight);
        if (c->size[axis] < 0x1p-20 || !(left < best)) continue;
        best = left;
        best_axis = axis;
    }
    return best_axis;
}

static size_t part_at(const cell *c, int axis, double middle)
{
    size_t lower = 0;
    for (size_t i = 0; i < c->count; i++) {
        if (!(c->seen[i].sample.x[axis] < middle)) continue;
        const ppmi_guide_seen seen = c->seen[i];
        c->seen[i] = c->seen[lower];
        c->seen[lower++] = seen;
    }
    return lower;
}

/* The two halves of a cell. */
static void halve(const cell *c, int axis, cell halves[2])
{
    const double half = 0.5 * c->size[axis], middle = c->low[axis] + half;
    const size_t lower = part_at(c, axis, middle);
    halves[0] = halves[1] = *c;
    halves[0].count = lower;
    halves[1].seen += lower;
    halves[1].count -= lower;
    halves[1].low[axis] = middle;
    for (int i = 0; i < 2; i++) {
        halves[i].size[axis] = half;
        halves[i].volume *= 0.5;
        halves[i].depth++;
    }
}

/* Breadth first: where nodes run out, all places are about as fine. */
static void grow(growth *g, cell *cells)
{
    ppmi_photon_guide *guide = g->guide;
    for (uint32_t i = 0; i < guide->count; i++) {
        const cell *c = &cells[i];
        ppmi_guide_node *node = &guide->nodes[i];
        *node = (ppmi_guide_node){.lower = 0.5};
        double effective;
        g->volume[i] = c->volume / cells[0].volume;
        g->brings[i] = weigh(c, &effective);
        g->used[i] = used_share(c);
        const int axis = c->depth < MAX_DEPTH ? axis_of(c) : -1;
        if (axis < 0 || guide->count + 2 > PPMI_GUIDE_MAX_NODES) continue;
        node->axis = (uint16_t)axis;
        node->children = (uint16_t)guide->count;
        halve(c, axis, &cells[guide->count]);
        guide->count += 2;
    }
}

/* What leaves are worth: by what they bring to this power of the share of their photons that bring
 * it. Returns the share of photons that are gathered if they are drawn by that. */
static double weigh_leaves(growth *g, double power)
{
    ppmi_photon_guide *guide = g->guide;
    double by_worth = 0.0, evenly = 0.0;
    for (uint32_t i = guide->count; i-- > 0;) { /* halves come after what they are halves of */
        const uint32_t k = guide->nodes[i].children;
        if (k > 0) {
            g->mass[i] = g->mass[k] + g->mass[k + 1];
            continue;
        }
        const double used = g->used[i];
        g->mass[i] = used > 0.0 ? g->brings[i] * pow(used, power) : 0.0;
        by_worth += g->mass[i] * used;
        evenly += g->volume[i] * used;
    }
    if (!(g->mass[0] > 0.0)) return 0.0;
    return PPMI_GUIDE_EVEN_SHARE * evenly + (1.0 - PPMI_GUIDE_EVEN_SHARE) * by_worth / g->mass[0];
}

/* Variance is least with densities by the root of the mean square of what photons bring. Where few
 * of them bring it, each of those brings much: the root is the mean over the root of their share,
 * which is far better known than the mean square itself. It sends many photons to where few are of
 * use; where most could be, half shall. */
static void weigh_all(growth *g)
{
    const double half = 0.55, least = -0.5, step = 0.05; /* half, of what is an estimate */
    double power = least;
    if (weigh_leaves(g, 0.0) >= half) {
        while (power < 0.0 && weigh_leaves(g, power) < half)
            power += step;
    }
    weigh_leaves(g, power);
}

/* Each half's share of its cell: by what it is worth, but for the share that is even. */
static void share(growth *g)
{
    ppmi_photon_guide *guide = g->guide;
    weigh_all(g);
    const double total = g->mass[0], even = total > 0.0 ? PPMI_GUIDE_EVEN_SHARE : 1.0;
    for (uint32_t i = 0; i < guide->count; i++) {
        const uint32_t k = guide->nodes[i].children;
        if (k == 0) continue;
        double shares[2];
        for (uint32_t c = 0; c < 2; c++) {
            shares[c] = even * g->volume[k + c];
            if (total > 0.0) shares[c] += (1.0 - even) * g->mass[k + c] / total;
        }
        guide->nodes[i].lower = shares[0] / (shares[0] + shares[1]);
    }
}

ppm_status ppmi_guide_learn(ppm_context *context, ppmi_photon_guide *guide, ppmi_guide_seen *seen,
                            size_t count, double whole)
{
    growth *g = ppmi_alloc(context, 1, sizeof *g);
    cell *cells = ppmi_alloc(context, PPMI_GUIDE_MAX_NODES, sizeof *cells);
    const bool has_memory = g && cells;
    if (has_memory) {
        g->guide = guide;
        cells[0] = (cell){.seen = seen, .count = count, .volume = whole};
        for (int axis = 0; axis < PPMI_GUIDE_AXES; axis++)
            cells[0].size[axis] = 1.0;
        guide->count = 1;
        grow(g, cells);
        share(g);
    }
    ppmi_free(context, g);
    ppmi_free(context, cells);
    return has_memory ? PPM_STATUS_OK
                      : ppmi_fail(context, PPM_STATUS_OUT_OF_MEMORY, "out of memory: guide");
}

/* ---- drawing --------------------------------------------------------------------------------- */

double ppmi_guide_density(const ppmi_photon_guide *guide, const ppmi_emission_sample *sample)
{
    ppmi_emission_sample rest = *sample;
    double density = 1.0;
    const ppmi_guide_node *node = guide->nodes;
    while (node->children > 0) {
        double *x = &rest.x[node->axis];
        const bool is_upper = *x >= 0.5;
        const double lower = node->lower;
        *x = 2.0 * *x - (is_upper ? 1.0 : 0.0);
        density *= 2.0 * (is_upper ? 1.0 - lower : lower);
        node = &guide->nodes[node->children + is_upper];
    }
    return density;
}

double ppmi_guide_warp(const ppmi_photon_guide *guide, ppmi_emission_sample *sample)
{
    double low[PPMI_GUIDE_AXES] = {0.0}, size[PPMI_GUIDE_AXES] = {1.0, 1.0, 1.0, 1.0, 1.0};
    double density = 1.0;
    const ppmi_guide_node *node = guide->nodes;
    while (node->children > 0) {
        const uint32_t axis = node->axis;
        const double lower = node->lower, x = sample->x[axis];
        const bool is_upper = x >= lower;
        const double part = is_upper ? 1.0 - lower : lower;
        sample->x[axis] = (is_upper ? x - lower : x) / part;
        density *= 2.0 * part;
        size[axis] *= 0.5;
        if (is_upper) low[axis] += size[axis];
        node = &guide->nodes[node->children + is_upper];
    }
    for (int axis = 0; axis < PPMI_GUIDE_AXES; axis++) {
        const double last = 0x1.fffffffffffffp-1;
        const double within = sample->x[axis] < last ? sample->x[axis] : last;
        sample->x[axis] = low[axis] + size[axis] * within;
    }
    return density;
}
