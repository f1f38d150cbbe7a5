/* --focus: a distance, or something in the scene. */
#ifndef PPM_CLI_FOCUS_H
#define PPM_CLI_FOCUS_H

#include "console.h"
#include "ppm/scene.h"

/* Metres along the axis of camera that text stands for: to the middle of the box around all nodes
 * of that name, or, where there is none, the number itself. Returns EXIT_DONE, EXIT_USAGE (neither,
 * not above 0, behind the camera; said on the console) or EXIT_RESOURCES. */
int focus_find(cli_console *console, const ppm_scene *scene, ppm_camera_id camera, const char *text,
               float *out_distance_m);

/* Whether a node of that name is there to focus on. */
bool focus_is_node(const ppm_scene *scene, const char *text);

#endif
