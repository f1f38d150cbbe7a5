/* As with --camera, a name wins over a number: a node may be called "2". */
#include "focus.h"

#include <math.h>
#include <string.h>

#include "nodes.h"
#include "options.h"
#include "values.h"

static const double NEAREST_M = 1e-6, FARTHEST_M = 1e18;

/* The box around all nodes of that name; false when there is none with a surface. */
static bool find_box(const ppm_scene *scene, const char *name, float low[3], float high[3])
{
    bool is_found = false;
    for (ppm_instance_id id = 1; id <= ppm_scene_instance_count(scene); id++) {
        float min[3], max[3];
        if (strcmp(ppm_scene_instance_name(scene, id), name) != 0) continue;
        if (ppm_scene_instance_bounds(scene, id, min, max) != PPM_STATUS_OK) continue;
        for (int i = 0; i < 3; i++) {
            low[i] = is_found ? fminf(low[i], min[i]) : min[i];
            high[i] = is_found ? fmaxf(high[i], max[i]) : max[i];
        }
        is_found = true;
    }
    return is_found;
}

bool focus_is_node(const ppm_scene *scene, const char *text)
{
    float low[3], high[3];
    return find_box(scene, text, low, high);
}

/* From the camera to the middle of the box, along -z of the camera. */
static double distance_along_axis(const ppm_scene *scene, ppm_camera_id camera, const float low[3],
                                  const float high[3])
{
    float transform[16];
    if (ppm_scene_camera_transform(scene, camera, transform) != PPM_STATUS_OK) return 0.0;
    double distance = 0.0;
    for (int i = 0; i < 3; i++) {
        const double middle = 0.5 * ((double)low[i] + (double)high[i]);
        distance -= (double)transform[8 + i] * (middle - (double)transform[12 + i]);
    }
    return distance;
}

int focus_find(cli_console *console, const ppm_scene *scene, ppm_camera_id camera, const char *text,
               float *out_distance_m)
{
    float low[3], high[3];
    double distance = 0.0;
    const bool is_node = find_box(scene, text, low, high);
    if (is_node) {
        distance = distance_along_axis(scene, camera, low, high);
    } else if (!value_parse_real(text, &distance)) {
        return nodes_complain(console, scene, "--focus", "neither a distance nor a node", text);
    }
    if (distance >= NEAREST_M && distance <= FARTHEST_M) {
        *out_distance_m = (float)distance;
        return EXIT_DONE;
    }
    if (is_node) {
        console_message(console, PPM_LOG_ERROR,
                        "--focus: '%s' is at %g m along the camera's axis, not before it", text,
                        distance);
    } else {
        console_message(console, PPM_LOG_ERROR, "--focus: '%s' is not a distance from %g to %g m",
                        text, NEAREST_M, FARTHEST_M);
    }
    return EXIT_USAGE;
}
