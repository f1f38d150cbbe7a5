/* A setup file is often somebody else's: it says how the model is rendered, not which files are
 * read and written, nor what the program tells. */
#include "setup_file.h"

#include <stdio.h>
#include <string.h>

/* ---- opening --------------------------------------------------------------------------------- */

static void say_opened(cli_console *console, const ppm_setup *setup, bool is_beside)
{
    console_message(console, PPM_LOG_INFO, "setup file: %s%s", ppm_setup_path(setup),
                    is_beside ? ", found beside the model; --setup none leaves it out" : "");
}

int setup_file_open(cli_console *console, ppm_context *context, const cli_options *options,
                    ppm_setup **out_setup)
{
    const ppm_setup_options wanted = {.size = sizeof wanted,
                                      .allow_outside = options->allows_outside != 0};
    const bool is_beside = !options->setup;
    if (options->setup && strcmp(options->setup, "none") == 0) return EXIT_DONE;
    const ppm_status status =
        is_beside ? ppm_setup_open_beside(context, options->input, &wanted, out_setup)
                  : ppm_setup_open(context, options->setup, &wanted, out_setup);
    if (status != PPM_STATUS_OK) {
        if (is_beside) {
            console_message(console, PPM_LOG_ERROR,
                            "that setup file lies beside the model; --setup none leaves it out");
        }
        return exit_status_of(status, EXIT_INPUT);
    }
    if (*out_setup) say_opened(console, *out_setup, is_beside);
    return EXIT_DONE;
}

/* ---- render options -------------------------------------------------------------------------- */

/* Why an option has no place in a setup file; NULL: it has. */
static const char *refusal(const char *name)
{
    static const char files[] = "which files are read and written is said on the command line";
    static const char talk[] = "it is for the command line alone";
    static const char section[] = "the setup file has sections \"environment\" and \"fog\" for it";
    static const struct {
        const char *name, *reason;
    } rows[] = {
        {"output", files},
        {"stats", files},
        {"skip-existing", files},
        {"allow-outside", files},
        {"setup", files},
        {"ocio", files},
        {"texture-path", files},
        {"texture-space", files},
        {"catcher", "the section \"nodes\" has \"catcher\" for it"},
        {"list", talk},
        {"list-views", talk},
        {"quiet", talk},
        {"verbose", talk},
        {"version", talk},
        {"help", talk},
        {"env", section},
        {"env-rotation", section},
        {"env-intensity", section},
        {"sun", section},
        {"background", section},
        {"fog", section},
    };
    for (size_t i = 0; i < sizeof rows / sizeof rows[0]; i++) {
        if (strcmp(rows[i].name, name) == 0) return rows[i].reason;
    }
    return NULL;
}

/* Whether the command line has something in the place of an option, under that or another name;
 * the same name needs no care, as it is stored afterwards. */
static bool is_replaced(const char *name, const cli_options *words)
{
    static const char *const stops[] = {"passes", "epochs", "time"};
    if (strcmp(name, "frame") == 0 || strcmp(name, "frames") == 0) return words->frames.is_given;
    for (size_t i = 0; i < sizeof stops / sizeof stops[0]; i++) {
        if (strcmp(name, stops[i]) != 0) continue;
        return words->passes > 0 || words->epochs > 0 || words->seconds > 0.0;
    }
    return false;
}

int setup_file_store(const option_table *table, const ppm_setup *setup, const cli_options *words,
                     cli_options *options)
{
    option_table here = *table;
    here.source = ppm_setup_path(setup);
    int result = EXIT_DONE;
    for (uint32_t i = 0; i < ppm_setup_option_count(setup) && result == EXIT_DONE; i++) {
        const char *name, *value;
        char message[512];
        ppm_setup_get_option(setup, i, &name, &value);
        const char *const reason = refusal(name);
        if (reason) {
            snprintf(message, sizeof message, "render.%s: %s", name, reason);
            return option_complain_of_all(&here, message);
        }
        if (!is_replaced(name, words)) result = option_table_store(&here, name, value, options);
    }
    return result;
}

/* ---- what is applied ------------------------------------------------------------------------- */

uint32_t setup_file_parts(const cli_options *options)
{
    uint32_t parts = PPM_SETUP_ALL;
    if (options->environment || options->sun.is_given) parts &= ~(uint32_t)PPM_SETUP_ENVIRONMENT;
    if (options->fog.is_given) parts &= ~(uint32_t)PPM_SETUP_FOG;
    return parts;
}

bool setup_file_has_cameras(const ppm_setup *setup)
{
    for (uint32_t i = 0; i < ppm_setup_count(setup); i++) {
        ppm_setup_item item = {.size = sizeof item};
        if (ppm_setup_get_item(setup, i, &item) != PPM_STATUS_OK) continue;
        if (item.part == PPM_SETUP_CAMERAS) return true;
    }
    return false;
}
