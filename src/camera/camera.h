/* Camera rays: perspective, with or without a lens, and orthographic. */
#ifndef PPMI_CAMERA_H
#define PPMI_CAMERA_H

#include "accel/accel.h"
#include "math/sampling.h"
#include "scene/scene.h"

/* The longer side of the sensor that f-numbers are for: that of 35 mm film. Blender's default with
 * sensor fit "auto" too. */
#define PPMI_SENSOR_SIDE_M 0.036f

/* A camera set up for an image. */
typedef struct ppmi_camera_view {
    ppmi_vec3 origin, forward;
    ppmi_vec3 right, up; /* half the image plane at distance 1 (or, orthographic, in metres) */
    ppmi_vec3 lens_right, lens_up; /* the lens's radius, metres; 0: a pinhole */
    float inverse_focus;           /* 1 / distance of the plane that is sharp, 1/m */
    float width, height;           /* pixels */
    float shift_x, shift_y;        /* of the picture, in its half width and height */
    float near_m, far_m;           /* what it sees, along forward; far_m may be infinite */
    float spread;                  /* perspective: angle of a pixel, radians */
    float base_width;              /* orthographic: width of a pixel, metres */
    bool is_perspective;
    bool has_lens;
    uint32_t motion_steps;          /* 1: at rest, and all above is what it is at the opening */
    const ppmi_camera_pose *motion; /* the camera's */
} ppmi_camera_view;

/* The vertical extent is the camera's; the horizontal follows the aspect of the image. The view is
 * that of a pinhole, all in focus. */
void ppmi_camera_view_init(const ppmi_camera *camera, uint32_t width, uint32_t height,
                           ppmi_camera_view *out_view);

/* The view at a time within the shutter: between motion steps the place moves on a straight line,
 * and the camera turns evenly about one axis (Shoemake 1985, "Animating Rotation with Quaternion
 * Curves"). */
ppmi_camera_view ppmi_camera_view_at(const ppmi_camera_view *view, float time);

/* The middle of the near plane: where what the camera sees begins. */
ppmi_vec3 ppmi_camera_view_start(const ppmi_camera_view *view);

/* Focal length, metres, that gives a view its angle on a sensor of PPMI_SENSOR_SIDE_M. Perspective
 * only. */
float ppmi_camera_view_focal_length(const ppmi_camera_view *view);

/* Gives a perspective view a thin lens (Cook, Porter, Carpenter 1984) of radius focal length /
 * (2 f_number), with everything sharp in the plane at focus_distance_m along the axis. Both above
 * 0; an infinite f_number leaves the pinhole. The picture's scale is the pinhole's whatever the
 * distance: no breathing. */
void ppmi_camera_view_set_lens(ppmi_camera_view *view, float f_number, float focus_distance_m);

/* A camera ray with its cone: the width of the pixel's footprint is base_width + spread * t. The
 * cone is that of the pinhole with a lens too: where the picture is sharp it is the right one, and
 * where it is not, gather radii that follow it are smaller than the blur, not larger. */
typedef struct ppmi_camera_ray {
    ppmi_ray ray; /* unit direction */
    float base_width, spread;
    ppmi_vec3 position_dx, position_dy;   /* change by one pixel to the right and one down, for one
                                             point of the lens, metres */
    ppmi_vec3 direction_dx, direction_dy; /* of the unit direction */
} ppmi_camera_ray;

/* The ray through the middle of the lens, which begins at the near plane and ends at the far one. x
 * to the right in 0 .. width, y down in 0 .. height, in pixels; pixel centres are at halves, and
 * places outside the picture are fine. */
ppmi_camera_ray ppmi_camera_view_ray(const ppmi_camera_view *view, float x, float y);

/* The ray through a point of the lens, which is given on the unit disk; it does not matter without
 * a lens. */
ppmi_camera_ray ppmi_camera_view_lens_ray(const ppmi_camera_view *view, float x, float y,
                                          ppmi_vec2 lens);

#endif
