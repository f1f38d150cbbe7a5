/* What a ppm_color is made of; for the files of this folder. */
#ifndef PPMI_COLOR_HANDLE_H
#define PPMI_COLOR_HANDLE_H

#include "base/working_space.h"
#include "color/color.h"
#include "color/ocio_shim.h"

/* --texture-space: by a file's name. */
typedef struct ppmi_texture_rule {
    char *pattern;
    const char *space; /* borrowed from the configuration */
} ppmi_texture_rule;

struct ppm_color {
    ppm_context *context;
    char *source;
    bool is_builtin;
    ppmi_ocio_config *config;
    ppmi_ocio_space rec709;
    ppmi_ocio_space working_space; /* never by way of ACES2065-1 */
    ppmi_working_space working;    /* the same as numbers */
    uint32_t rule_count;
    ppmi_texture_rule *rules;
};

/* Finds rec709, and the working space that is called name (a space, an alias or a role; NULL: the
 * role scene_linear). Returns OK, NOT_FOUND (name), INPUT_INVALID. */
ppm_status ppmi_color_choose_working_space(ppm_context *context, ppm_color *color,
                                           const char *name);

/* The space that is called name. Returns OK, NOT_FOUND. */
ppm_status ppmi_color_find_space(ppm_context *context, const ppm_color *color, const char *name,
                                 const char **out_name);

/* Fails with NOT_FOUND: word is not among count names of what thing says; the nearest and all are
 * told. place completes "no view 'x'", and may be "". */
ppm_status ppmi_color_fail_not_found(ppm_context *context, const ppm_color *color,
                                     const char *thing, const char *place, const char *word,
                                     const char *const *names, uint32_t count);

#endif
