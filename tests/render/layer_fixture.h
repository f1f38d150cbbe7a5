/* Layers of sessions, read by their kinds. */
#ifndef TEST_RENDER_LAYER_FIXTURE_H
#define TEST_RENDER_LAYER_FIXTURE_H

#include "support/renders.h"
#include "support/scenes.h"

/* A session of the path tracer with these layers after some passes; to be destroyed. */
ppm_render *layers_render(ppm_scene *scene, const ppm_render_options *options, uint32_t passes);

/* The number-th layer of a kind: channel_count floats a pixel, to be freed by free(). */
float *layers_read(const ppm_render *render, int32_t kind, uint32_t number);

/* Both at once, for one layer. */
float *layers_picture(ppm_scene *scene, const ppm_render_options *options, uint32_t passes,
                      int32_t kind);

/* The options of most tests: the path tracer, square, of a box filter, with one layer. */
ppm_render_options layers_options(uint32_t width, int32_t kind);

/* A quad with a name, at rest. */
ppm_instance_id layers_add_quad(ppm_scene *scene, const char *name, ppm_material_id material,
                                ppmi_vec3 origin, ppmi_vec3 edge_u, ppmi_vec3 edge_v);

/* The transform that moves to a place. */
void layers_at_place(ppmi_vec3 place, float columns[16]);

/* A wall of 80 m that faces +z and goes from one place to the other while the shutter is open. */
ppm_instance_id layers_add_moving_wall(ppm_scene *scene, ppmi_vec3 from, ppmi_vec3 to);

#endif
