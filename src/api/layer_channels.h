/* What the channels of layers are called in OpenEXR files. */
#ifndef PPMI_API_LAYER_CHANNELS_H
#define PPMI_API_LAYER_CHANNELS_H

#include <stdint.h>

#include "base/context.h"
#include "imageio/layered.h"
#include "ppm/render.h"

/* The channels of all layers of a session; layer i has those from first[i] on. */
typedef struct ppmi_layer_channels {
    uint32_t layer_count;
    ppm_layer_info *layers;
    uint32_t *numbers;   /* of the layers in the session */
    uint32_t data_begin; /* from this layer on they are numbers, before it they are light */
    char **layer_names;  /* in the file */
    uint32_t *first;     /* layer_count + 1 */
    char **channel_names;
    ppmi_layered_channel *channels;
} ppmi_layer_channels;

/* is_half: layers that bear it are stored as half floats; has_layers: all, else the picture alone,
 * which is the first of them; is_sorted: those of numbers, not of light, come last, else data_begin
 * is the number of layers. Returns OK, OUT_OF_MEMORY; *out_channels is to be freed with deinit in
 * both cases. */
ppm_status ppmi_layer_channels_init(ppm_context *context, const ppm_render *render, bool is_half,
                                    bool has_layers, bool is_sorted,
                                    ppmi_layer_channels *out_channels);

/* Which layers have other names in the file than in the session, by both: {"file's":"session's"}.
 * *out_text is to be freed with ppmi_free; NULL: none has. Returns OK, OUT_OF_MEMORY. */
ppm_status ppmi_layer_channels_manifest(ppm_context *context, const ppmi_layer_channels *channels,
                                        char **out_text);

/* Whether a layer is of numbers, which a lossy compression would spoil, not of light. */
bool ppmi_layer_is_data(const ppm_layer_info *layer);
void ppmi_layer_channels_deinit(ppm_context *context, ppmi_layer_channels *channels);

#endif
