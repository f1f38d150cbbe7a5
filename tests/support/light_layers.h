/* Renders with their layers of light. */
#ifndef TEST_SUPPORT_LIGHT_LAYERS_H
#define TEST_SUPPORT_LIGHT_LAYERS_H

#include "ppm/render.h"

#define ALL_LIGHT_LAYERS                                                                           \
    (PPM_LAYER_BIT(PPM_LAYER_VOLUME + 1) - PPM_LAYER_BIT(PPM_LAYER_DIFFUSE_DIRECT))
#define ALL_GROUP_LAYERS                                                                           \
    (PPM_LAYER_BIT(PPM_LAYER_LIGHT_GROUP) | PPM_LAYER_BIT(PPM_LAYER_GROUP_CAUSTICS))

/* A session after some passes, read layer by layer. */
typedef struct layered_picture {
    ppm_render *render;
    size_t pixels;
} layered_picture;

layered_picture layered_open(ppm_scene *scene, const ppm_render_options *options, uint32_t passes);
void layered_close(layered_picture *picture);

/* The number-th layer of a kind (from 0), 3 floats a pixel (1 of single channels; 4 of combined);
 * to be freed by free(). NULL where there is none. */
float *layered_read(const layered_picture *picture, int32_t kind, uint32_t number);

/* The sum of all layers of kinds first .. last, 3 floats a pixel. */
float *layered_sum(const layered_picture *picture, int32_t first, int32_t last);

/* The mean of a channel of a layer over the picture; 0 where there is none. */
double layered_mean(const layered_picture *picture, int32_t kind, uint32_t number,
                    uint32_t channel);

#endif
