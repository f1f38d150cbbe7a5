/* What light from far away has to cover: the box around everything, or in fog the ball. */
#ifndef PPMI_LIGHT_EXTENT_H
#define PPMI_LIGHT_EXTENT_H

#include "accel/accel.h"
#include "scene/scene.h"

typedef struct ppmi_light_extent {
    ppmi_vec3 center;
    ppmi_vec3 half; /* of the box */
    float radius;   /* of the ball around the box */
    bool is_ball;   /* fog fills the ball: its air has to be lit too */
} ppmi_light_extent;

/* Empty (radius 0) for a scene without instances. */
ppmi_light_extent ppmi_light_extent_of(const ppm_scene *scene);

/* Area of the shadow that parallel light along direction (unit) casts of the extent. */
float ppmi_light_extent_shadow(const ppmi_light_extent *extent, ppmi_vec3 direction);

/* Mean of that area over all directions. */
float ppmi_light_extent_mean_shadow(const ppmi_light_extent *extent);

/* A ray of parallel light along direction, from outside, drawn evenly over the shadow's area. */
ppmi_ray ppmi_light_extent_ray(const ppmi_light_extent *extent, ppmi_vec3 direction, float u,
                               float v);

/* Cosine of the cone from position that holds the ball, enlarged by margin; -1 from inside. */
float ppmi_light_extent_cone(const ppmi_light_extent *extent, ppmi_vec3 position, float margin);

#endif
