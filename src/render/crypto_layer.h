/* One kind of Cryptomatte: how much of each pixel belongs to which name. */
#ifndef PPMI_RENDER_CRYPTO_LAYER_H
#define PPMI_RENDER_CRYPTO_LAYER_H

#include "scene/scene.h"

enum { PPMI_CRYPTO_MAX_RANKS = 32 };

/* An id and the samples that met it. */
typedef struct ppmi_crypto_count {
    uint32_t id, samples; /* id 0: none */
} ppmi_crypto_count;

typedef struct ppmi_crypto_layer {
    uint32_t *ids;             /* by instance, or by material */
    uint32_t capacity;         /* ids that a pixel can hold */
    ppmi_crypto_count *counts; /* capacity a pixel */
    char *manifest;            /* JSON, in the order of the names */
} ppmi_crypto_layer;

/* kind: PPM_LAYER_CRYPTO_. A pixel holds twice as many ids as it shows. Returns OK, OUT_OF_MEMORY
 * (nothing is left). */
ppm_status ppmi_crypto_layer_init(ppm_context *context, const ppm_scene *scene, int32_t kind,
                                  uint32_t ranks, size_t pixel_count, ppmi_crypto_layer *layer);
void ppmi_crypto_layer_deinit(ppm_context *context, ppmi_crypto_layer *layer);

/* Adds a sample of a pixel that met the instance, or the material, of this index. Where more ids
 * come to a pixel than it can hold, the newest takes the place of the least and inherits its
 * samples (Metwally, Agrawal, El Abbadi 2005, "Efficient Computation of Frequent and Top-k Elements
 * in Data Streams"): the sum stays right, and so do the ids that cover much. */
void ppmi_crypto_layer_add(ppmi_crypto_layer *layer, size_t pixel, uint32_t index);

/* Ranks 2 pair and 2 pair + 1 of all pixels, the largest first: id, coverage, id, coverage, a pixel
 * after the other. Coverage is the share of samples. */
void ppmi_crypto_layer_read(const ppmi_crypto_layer *layer, size_t pixel_count, uint32_t pair,
                            uint64_t samples, float *values);

#endif
