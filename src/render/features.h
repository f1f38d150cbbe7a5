/* Feature layers: facts about what the camera sees, beside its light. They come from camera rays of
 * their own, the same as the integrator's in each pass, so that coverage and edges agree with the
 * picture. */
#ifndef PPMI_RENDER_FEATURES_H
#define PPMI_RENDER_FEATURES_H

#include "render/layer_list.h"

typedef struct ppmi_features ppmi_features;

static inline bool ppmi_features_have(int32_t kind)
{
    return kind >= PPM_LAYER_ALBEDO && kind <= PPM_LAYER_CRYPTO_ASSET;
}

/* Whether the options ask for any of them. */
static inline bool ppmi_features_are_wanted(const ppm_render_options *options)
{
    return ppmi_layers_have(options, PPM_LAYER_ALBEDO, PPM_LAYER_CRYPTO_ASSET);
}

/* Returns OK, INVALID_ARGUMENT. */
ppm_status ppmi_features_check(ppm_context *context, const ppm_render_options *options);

/* Returns OK, OUT_OF_MEMORY. */
ppm_status ppmi_features_create(const ppmi_job *job, ppmi_features **out_features);
void ppmi_features_destroy(const ppmi_job *job, ppmi_features *features);

/* Adds pass number pass (from 0): all of it, also when the job is cancelled. Takes no memory. */
void ppmi_features_pass(const ppmi_job *job, ppmi_features *features, uint64_t pass,
                        ppm_render_stats *stats);

/* The layer after the passes so far, at least one: channel_count floats a pixel of the film, row 0
 * on top. */
void ppmi_features_read(const ppmi_job *job, const ppmi_features *features, const ppmi_layer *layer,
                        float *values);

/* Names and ids of a Cryptomatte layer as JSON; NULL for other kinds and what is not wanted. */
const char *ppmi_features_manifest(const ppmi_features *features, int32_t kind);

#endif
