/* Places on emissive triangles by their own brightness: a screen's bright window, a star on a dark
 * dome.
 *
 * Each triangle whose emission varies has a tree of triangles: a node is cut at the middles of its
 * edges into four, and each part is drawn by what it shines. So the density is told for any place,
 * whatever the texture coordinates do. What is as bright all over is not cut further
 * (light/glow_build.c). */
#ifndef PPMI_LIGHT_GLOW_H
#define PPMI_LIGHT_GLOW_H

#include "math/sampling.h"
#include "scene/scene.h"

/* The root of a triangle that is drawn from evenly, and a child that is not cut. */
#define PPMI_GLOW_EVEN UINT32_MAX

/* Parts: 0 at the first corner, 1 at the second, 2 at the third, 3 in the middle. Two numbers draw
 * one: the first tells {0, 2} from {1, 3}, the second the two of the pair. */
typedef struct ppmi_glow_node {
    float left;   /* probability of {0, 2} */
    float low[2]; /* of 0 among {0, 2}, of 1 among {1, 3} */
    uint32_t children[4];
} ppmi_glow_node;

typedef struct ppmi_glow {
    ppmi_glow_node *nodes;
    uint32_t count, capacity;
} ppmi_glow;

/* Draws a place (u and v as in ppmi_hit) with two numbers in [0, 1). *out_density: by that of even
 * places; above 0. */
ppmi_vec2 ppmi_glow_sample(const ppmi_glow *glow, uint32_t root, double u, double v,
                           float *out_density);

/* The density of a place. */
float ppmi_glow_density(const ppmi_glow *glow, uint32_t root, float u, float v);

/* What a triangle's tree is made of: values, not below 0, of side * side small triangles (side a
 * power of two). */
typedef struct ppmi_glow_lattice {
    uint32_t side;
    float *corners; /* row by row along u: side + 1 values in the first row, 1 in the last */
    float *middles; /* side * side, see ppmi_glow_middle_at */
} ppmi_glow_lattice;

static inline size_t ppmi_glow_corner_count(uint32_t side)
{
    return ((size_t)side + 1) * ((size_t)side + 2) / 2;
}

/* The first of a row of corners. */
static inline size_t ppmi_glow_row_start(uint32_t side, uint32_t row)
{
    return (size_t)row * (side + 1) - (size_t)row * (row - 1) / 2;
}

/* Where the small triangle is kept whose first corner is at a column and row of corners: the
 * upright ones at their own place, those that are turned round at the opposite one. */
static inline size_t ppmi_glow_middle_at(uint32_t side, uint32_t column, uint32_t row,
                                         bool is_turned)
{
    return is_turned ? (size_t)(side - row) * side + (side - column) : (size_t)row * side + column;
}

/* Means over the triangle, by the middles and by the corners. */
double ppmi_glow_mean_of_middles(const ppmi_glow_lattice *lattice);
double ppmi_glow_mean_of_corners(const ppmi_glow_lattice *lattice);

/* Adds a tree; *out_root may be PPMI_GLOW_EVEN. node_cost: a node is cut where this lowers the mean
 * of f^2/p by more than that for each part. Returns OK, OUT_OF_MEMORY. */
ppm_status ppmi_glow_add(ppm_context *context, ppmi_glow *glow, const ppmi_glow_lattice *lattice,
                         double node_cost, uint32_t *out_root);
void ppmi_glow_deinit(ppm_context *context, ppmi_glow *glow);

#endif
