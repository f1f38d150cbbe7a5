#include "catchers.h"

#include <stdlib.h>
#include <string.h>

#include "layer_values.h"
#include "nodes.h"

/* ---- choice ---------------------------------------------------------------------------------- */

static int choose_node(cli_console *console, ppm_scene *scene, const char *text)
{
    bool is_found = false;
    for (ppm_instance_id id = 1; id <= ppm_scene_instance_count(scene); id++) {
        if (strcmp(ppm_scene_instance_name(scene, id), text) != 0) continue;
        if (ppm_scene_set_instance_catcher(scene, id, 1) != PPM_STATUS_OK) return EXIT_RESOURCES;
        is_found = true;
    }
    return is_found ? EXIT_DONE : nodes_complain(console, scene, "--catcher", "no node", text);
}

/* By its name, not by "all". */
static bool asks_for_layer(const cli_options *options)
{
    const uint64_t wanted = PPM_LAYER_BIT(PPM_LAYER_CATCHER);
    const uint64_t all = layer_bits_of_all();
    return options->layers & wanted && (options->layers & all) != all;
}

int catchers_choose(cli_console *console, ppm_scene *scene, const cli_options *options)
{
    int result = EXIT_DONE;
    for (size_t i = 0; i < options->catcher_count && result == EXIT_DONE; i++)
        result = choose_node(console, scene, options->catchers[i]);
    const uint32_t count = ppm_scene_catcher_count(scene);
    if (result == EXIT_DONE && count == 0 && asks_for_layer(options)) {
        console_message(console, PPM_LOG_ERROR,
                        "--aov catcher: there is no catcher in the scene; --catcher makes one");
        return EXIT_USAGE;
    }
    if (result == EXIT_DONE && count > 0) {
        console_message(console, PPM_LOG_INFO,
                        "%u catcher%s: rendered alone first, then with all else", count,
                        count == 1 ? "" : "s");
    }
    return result;
}

/* ---- plate ----------------------------------------------------------------------------------- */

static bool find_layer(const ppm_render *render, uint32_t *out_index)
{
    for (uint32_t i = 0; i < ppm_render_layer_count(render); i++) {
        ppm_layer_info info = {.size = sizeof info};
        if (ppm_render_get_layer(render, i, &info) != PPM_STATUS_OK) return false;
        *out_index = i;
        if (info.kind == PPM_LAYER_CATCHER) return true;
    }
    return false;
}

int catchers_read(const ppm_render *render, float **out_values, size_t *out_count)
{
    uint32_t layer = 0;
    const uint32_t *const crop = ppm_render_get_options(render)->crop;
    const size_t count = 4 * (size_t)(crop[2] - crop[0]) * (crop[3] - crop[1]);
    float *const values = find_layer(render, &layer) ? malloc(count * sizeof *values) : NULL;
    if (!values) return EXIT_RESOURCES;
    const ppm_status status = ppm_render_read_layer(render, layer, values, count);
    if (status != PPM_STATUS_OK) {
        free(values);
        return exit_status_of(status, EXIT_RESOURCES);
    }
    *out_values = values;
    *out_count = count;
    return EXIT_DONE;
}
