/* Camera rays: perspective and orthographic. */
#ifndef PPMI_CAMERA_H
#define PPMI_CAMERA_H

#include "accel/accel.h"
#include "scene/scene.h"

/* A camera set up for an image. */
typedef struct ppmi_camera_view {
    ppmi_vec3 origin, forward;
    ppmi_vec3 right, up; /* half the image plane at distance 1 (or, orthographic, in metres) */
    float width, height; /* pixels */
    float spread;        /* perspective: angle of a pixel, radians */
    float base_width;    /* orthographic: width of a pixel, metres */
    bool is_perspective;
} ppmi_camera_view;

/* The vertical extent is the camera's; the horizontal follows the aspect of the image. */
void ppmi_camera_view_init(const ppmi_camera *camera, uint32_t width, uint32_t height,
                           ppmi_camera_view *out_view);

/* A camera ray with its cone: the width of the pixel's footprint is base_width + spread * t. */
typedef struct ppmi_camera_ray {
    ppmi_ray ray; /* unit direction */
    float base_width, spread;
} ppmi_camera_ray;

/* x to the right in 0 .. width, y down in 0 .. height, in pixels; pixel centres are at halves. */
ppmi_camera_ray ppmi_camera_view_ray(const ppmi_camera_view *view, float x, float y);

#endif
