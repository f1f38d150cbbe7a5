/* The layers of a session by number: which there are, what they are called, who keeps them. */
#ifndef PPMI_RENDER_LAYER_LIST_H
#define PPMI_RENDER_LAYER_LIST_H

#include "render/integrator.h"

/* One layer. Cryptomatte has several of a kind, a pair of ranks each, light groups one a group. */
typedef struct ppmi_layer {
    int32_t kind;    /* PPM_LAYER_ */
    uint32_t number; /* of the group, or of the pair of ranks; else 0 */
    char *name;
    uint32_t channel_count;
    const char *const *channel_names;
    bool is_exact;
} ppmi_layer;

typedef struct ppmi_layer_list {
    ppmi_layer *layers;
    uint32_t count;
} ppmi_layer_list;

/* Lists the layers that the job's options ask for, combined first. Returns OK, OUT_OF_MEMORY. */
ppm_status ppmi_layer_list_init(const ppmi_job *job, ppmi_layer_list *list);
void ppmi_layer_list_deinit(ppm_context *context, ppmi_layer_list *list);

/* What the denoised picture is made of: light layers come with their variances. */
#define PPMI_LAYERS_TO_DENOISE                                                                     \
    (PPM_LAYER_BIT(PPM_LAYER_LIGHT_VARIANCE) | PPM_LAYER_BIT(PPM_LAYER_ALBEDO) |                   \
     PPM_LAYER_BIT(PPM_LAYER_NORMAL) | PPM_LAYER_BIT(PPM_LAYER_DEPTH) |                            \
     PPM_LAYER_BIT(PPM_LAYER_RADIUS))

/* Whether any layer of kinds first..last is kept: the options ask for it, or for what needs it. */
bool ppmi_layers_have(const ppm_render_options *options, int32_t first, int32_t last);

#endif
