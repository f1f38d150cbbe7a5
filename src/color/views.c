/* From the working space to a display: which display, view and look are meant, and the way there.
 *
 * In this order: exposure, look, view, gamma; as in Blender and in OpenColorIO's own viewers, so
 * that their settings can be taken over. */
#include <math.h>
#include <stdio.h>
#include <string.h>
#include <strings.h>

#include "base/suggest.h"
#include "color/handle.h"
#include "color/tone.h"

enum { NAMES_MAX = 256 };

ppm_status ppmi_color_fail_not_found(ppm_context *context, const ppm_color *color,
                                     const char *thing, const char *place, const char *word,
                                     const char *const *names, uint32_t count)
{
    char listing[1024] = "";
    size_t length = 0;
    for (uint32_t i = 0; i < count && length < sizeof listing; i++) {
        const int written = snprintf(listing + length, sizeof listing - length, "%s\"%s\"",
                                     i > 0 ? ", " : "", names[i] ? names[i] : "");
        length += written > 0 ? (size_t)written : 0;
    }
    const char *const nearest = ppmi_suggest(word, names, count);
    return ppmi_fail(context, PPM_STATUS_NOT_FOUND, "%s: no %s \"%s\"%s%s%s%s; there %s %s",
                     color->source, thing, word, place, nearest ? " (did you mean \"" : "",
                     nearest ? nearest : "", nearest ? "\"?)" : "", count == 1 ? "is" : "are",
                     count ? listing : "none");
}

/* ---- names ----------------------------------------------------------------------------------- */

enum { LIST_DISPLAYS, LIST_VIEWS, LIST_LOOKS };

/* Names of one list; display: whose views. Returns how many. */
static uint32_t list_names(const ppm_color *color, int list, const char *display,
                           const char *names[NAMES_MAX])
{
    const uint32_t found = list == LIST_DISPLAYS ? ppm_color_display_count(color)
                           : list == LIST_VIEWS  ? ppm_color_view_count(color, display)
                                                 : ppm_color_look_count(color);
    const uint32_t count = found < NAMES_MAX ? found : NAMES_MAX;
    for (uint32_t i = 0; i < count; i++) {
        names[i] = list == LIST_DISPLAYS ? ppm_color_display_name(color, i)
                   : list == LIST_VIEWS  ? ppm_color_view_name(color, display, i)
                                         : ppm_color_look_name(color, i);
    }
    return count;
}

/* word as the configuration writes it: in any letter case. */
static ppm_status choose_name(ppm_context *context, const ppm_color *color, int list,
                              const char *display, const char *word, const char **out_name)
{
    static const char *const things[] = {"display", "view", "look"};
    const char *names[NAMES_MAX] = {NULL};
    const uint32_t count = list_names(color, list, display, names);
    for (uint32_t i = 0; i < count; i++) {
        if (!names[i] || strcasecmp(names[i], word) != 0) continue;
        *out_name = names[i];
        return PPM_STATUS_OK;
    }
    char place[256] = "";
    if (list == LIST_VIEWS) snprintf(place, sizeof place, " for display \"%s\"", display);
    return ppmi_color_fail_not_found(context, color, things[list], place, word, names, count);
}

static ppm_status choose_default(ppm_context *context, const ppm_color *color, const char *display,
                                 const char **out_name)
{
    *out_name = display ? ppm_color_default_view(color, display) : ppm_color_default_display(color);
    if (*out_name) return PPM_STATUS_OK;
    return ppmi_fail(context, PPM_STATUS_INPUT_INVALID, "%s: the colour configuration has no %s",
                     color->source, display ? "view" : "display");
}

/* Several looks may be asked for as "one, +two, -three" (OpenColorIO's syntax): only a plain name
 * can be looked up. */
static ppm_status choose_look(ppm_context *context, const ppm_color *color, const char *look,
                              const char **out_look)
{
    *out_look = NULL;
    if (!look || !*look) return PPM_STATUS_OK;
    *out_look = strcasecmp(look, "none") == 0 ? "" : look;
    if (!**out_look || *look == '+' || *look == '-' || strpbrk(look, ",:|")) {
        const char *names[NAMES_MAX] = {NULL};
        const uint32_t count = list_names(color, LIST_LOOKS, NULL, names);
        for (uint32_t i = 0; i < count; i++) { /* a name may hold such letters */
            if (names[i] && strcasecmp(names[i], look) == 0) *out_look = names[i];
        }
        return PPM_STATUS_OK;
    }
    return choose_name(context, color, LIST_LOOKS, NULL, look, out_look);
}

ppm_status ppmi_color_choose_view(ppm_context *context, const ppm_color *color,
                                  const ppmi_view_choice *choice, ppmi_view_names *out_names)
{
    const bool has_display = choice->display && *choice->display;
    const bool has_view = choice->view && *choice->view;
    ppm_status status = has_display ? choose_name(context, color, LIST_DISPLAYS, NULL,
                                                  choice->display, &out_names->display)
                                    : choose_default(context, color, NULL, &out_names->display);
    if (status != PPM_STATUS_OK) return status;
    status = has_view ? choose_name(context, color, LIST_VIEWS, out_names->display, choice->view,
                                    &out_names->view)
                      : choose_default(context, color, out_names->display, &out_names->view);
    if (status != PPM_STATUS_OK) return status;
    return choose_look(context, color, choice->look, &out_names->look);
}

/* ---- the way --------------------------------------------------------------------------------- */

/* A tone map of our own begins where Rec.709 is; OpenColorIO does what is behind it. */
static ppmi_tone_map *tone_of(const ppm_color *color, const ppmi_view_names *names)
{
    return color->is_builtin ? ppmi_tone_of_view(names->view) : NULL;
}

static ppm_status make_view(ppm_context *context, const ppm_color *color,
                            const ppmi_view_names *names, ppmi_ocio_conversion **out_conversion)
{
    const char *const from = tone_of(color, names) ? color->rec709.name : color->working_space.name;
    return ppmi_ocio_make_view(context, color->config, color->source, from, names->display,
                               names->view, names->look, out_conversion);
}

ppm_status ppm_color_check_look(ppm_context *context, const ppm_color *color, const char *display,
                                const char *view, const char *look)
{
    if (!context || !color) return PPM_STATUS_INVALID_ARGUMENT;
    const ppmi_view_choice choice = {.display = display, .view = view, .look = look};
    ppmi_view_names names;
    ppm_status status = ppmi_color_choose_view(context, color, &choice, &names);
    if (status != PPM_STATUS_OK) return status;
    ppmi_ocio_conversion *conversion = NULL;
    status = make_view(context, color, &names, &conversion);
    ppmi_ocio_conversion_destroy(conversion);
    return status;
}

ppm_status ppm_color_check_view(ppm_context *context, const ppm_color *color, const char *display,
                                const char *view)
{
    return ppm_color_check_look(context, color, display, view, NULL);
}

static void apply_matrix(const float matrix[9], float *rgba, size_t pixel_count)
{
    for (size_t i = 0; i < pixel_count; i++)
        ppmi_matrix_apply(matrix, rgba + 4 * i, rgba + 4 * i);
}

/* Between working spaces, which are the same as a rule. */
static void change_space(const ppmi_working_space *from, const ppmi_working_space *to, float *rgba,
                         size_t pixel_count)
{
    if (memcmp(from->from_rec709, to->from_rec709, sizeof from->from_rec709) == 0) return;
    if (from->differs) apply_matrix(from->to_rec709, rgba, pixel_count);
    if (to->differs) apply_matrix(to->from_rec709, rgba, pixel_count);
}

static void expose(float exposure_ev, float *rgba, size_t pixel_count)
{
    if (exposure_ev == 0) return;
    const float factor = exp2f(exposure_ev);
    for (size_t i = 0; i < pixel_count; i++) {
        for (int c = 0; c < 3; c++)
            rgba[4 * i + c] *= factor;
    }
}

static void raise_to(float power, float *rgba, size_t pixel_count)
{
    for (size_t i = 0; i < pixel_count; i++) {
        for (int c = 0; c < 3; c++) {
            float *const value = &rgba[4 * i + (size_t)c];
            *value = *value > 0 ? powf(*value, power) : 0;
        }
    }
}

ppm_status ppmi_color_show(ppm_context *context, const ppm_color *color,
                           const ppmi_view_choice *choice, const ppmi_working_space *from,
                           float *rgba, size_t pixel_count)
{
    ppmi_view_names names;
    ppm_status status = ppmi_color_choose_view(context, color, choice, &names);
    ppmi_ocio_conversion *conversion = NULL;
    if (status == PPM_STATUS_OK) status = make_view(context, color, &names, &conversion);
    if (status != PPM_STATUS_OK) return status;
    ppmi_tone_map *const tone = tone_of(color, &names);
    change_space(from, tone ? &ppmi_working_space_rec709 : &color->working, rgba, pixel_count);
    expose(choice->exposure_ev, rgba, pixel_count);
    if (tone) tone(rgba, pixel_count);
    status = ppmi_ocio_apply(context, conversion, color->source, rgba, pixel_count, 4);
    ppmi_ocio_conversion_destroy(conversion);
    const bool has_gamma = choice->gamma > 0 && choice->gamma != 1;
    if (status == PPM_STATUS_OK && has_gamma) raise_to(1 / choice->gamma, rgba, pixel_count);
    return status;
}
