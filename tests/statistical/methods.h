/* All ways of rendering a scene, and their pictures compared block by block. */
#ifndef TEST_STATISTICAL_METHODS_H
#define TEST_STATISTICAL_METHODS_H

#include "math/vec.h"
#include "support/renders.h"

typedef struct render_method {
    const char *name;
    int32_t integrator, schedule, direct;
    bool has_epochs; /* a new one after every second pass */
} render_method;

/* The photon mapping methods: sppm progressive and memoryless, ppm, ppm with epochs, and sppm and
 * ppm with photons for direct light too. */
enum { PHOTON_METHODS = 7 };
extern const render_method photon_methods[PHOTON_METHODS];

/* Those that differ from others by their radii alone, for scenes that are about materials. */
enum { METHODS_OF_OTHER_RADII = 1 << 1 | 1 << 3 | 1 << 4 };
extern const render_method path_method;

/* Options of a method: a square picture of width pixels, one thread. */
ppm_render_options method_options(const render_method *method, uint32_t width,
                                  uint64_t photons_per_pass);

enum {
    METHOD_SIDE = 3,
    METHOD_BLOCKS = METHOD_SIDE * METHOD_SIDE,
    METHOD_VALUES = 3 * METHOD_BLOCKS
};

typedef struct method_comparison {
    uint32_t width;       /* pixels, a multiple of METHOD_SIDE */
    uint32_t path_passes; /* of the path tracer, per seed */
    uint32_t passes;      /* of the others */
    uint64_t photons;     /* per pass */
    float radius_m;       /* first */
    double bias;          /* bound of the relative bias of density estimation */
    double resolution;    /* relative standard error that each block's mean must reach */
    uint32_t seeds;
    uint32_t left_out;    /* mask of photon_methods */
    float shutter_frames; /* for which it is open; 0: a moment */
} method_comparison;

/* A closed box of 2 m around the origin with a lamp under its ceiling, looked at from its front
 * wall towards target. */
void add_lit_box(ppm_scene *scene, ppmi_vec3 reflectance, ppmi_vec3 target);

/* Means of METHOD_BLOCKS blocks in three channels. */
void method_blocks(ppm_scene *scene, const ppm_render_options *options, uint32_t passes,
                   uint32_t seeds, test_mean out_means[METHOD_VALUES]);

/* Fails the running test unless every photon method but those left out agrees with the path tracer
 * in every block: in the family of all comparisons up to the bias, and no block by more than 2 %
 * and three standard errors. */
void methods_agree(ppm_scene *scene, const method_comparison *how);

#endif
