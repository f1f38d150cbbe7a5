/* Patterns: a name as it stands, or a glob of the shell ("Glass*", "[ab]?"), with letter case. */
#include <fnmatch.h>
#include <string.h>

#include "base/suggest.h"
#include "setup/setup_file.h"

static bool is_pattern(const json_t *json)
{
    const char *text = json_string_value(json);
    return text && *text && strlen(text) == json_string_length(json);
}

ppm_status ppmi_setup_read_match(const ppmi_setup_value *value, const ppmi_setup_key *key,
                                 void *target)
{
    ppmi_setup_match *match = (ppmi_setup_match *)((char *)target + key->field);
    const size_t count = json_array_size(value->json);
    bool is_valid = is_pattern(value->json) || count > 0;
    for (size_t i = 0; i < count; i++)
        is_valid = is_valid && is_pattern(json_array_get(value->json, i));
    if (!is_valid) return ppmi_setup_refuse(value, "a name or pattern, or a list of them");
    match->value = *value;
    return PPM_STATUS_OK;
}

static bool fits_one(const char *pattern, const char *name)
{
    return strcmp(pattern, name) == 0 || fnmatch(pattern, name, 0) == 0;
}

bool ppmi_setup_fits(const ppmi_setup_match *match, const char *name)
{
    const json_t *json = match->value.json;
    if (json_is_string(json)) return fits_one(json_string_value(json), name);
    for (size_t i = 0; i < json_array_size(json); i++) {
        if (fits_one(json_string_value(json_array_get(json, i)), name)) return true;
    }
    return false;
}

/* The name that the text of json was most likely meant to be, or NULL. */
static ppm_status nearest_name(ppm_setup *setup, const char *text,
                               const char *(*name_of)(const ppm_scene *scene, uint32_t id),
                               uint32_t count, const char **out)
{
    *out = NULL;
    if (count == 0) return PPM_STATUS_OK;
    const char **names = ppmi_alloc(setup->context, count, sizeof *names);
    if (!names) return ppmi_setup_out_of_memory(setup);
    for (uint32_t i = 0; i < count; i++)
        names[i] = name_of(setup->scene, i + 1);
    *out = ppmi_suggest(text, names, count);
    ppmi_free(setup->context, names);
    return PPM_STATUS_OK;
}

ppm_status ppmi_setup_no_such(const ppmi_setup_value *value, const char *thing,
                              const char *(*name_of)(const ppm_scene *scene, uint32_t id),
                              uint32_t count)
{
    const char *nearest, *text = json_string_value(value->json);
    const ppm_status status = nearest_name(value->setup, text, name_of, count, &nearest);
    if (status != PPM_STATUS_OK) return status;
    return ppmi_setup_fail(value, "there is no %s \"%s\"%s%s%s", thing, text,
                           nearest ? "; did you mean \"" : "", nearest ? nearest : "",
                           nearest ? "\"?" : "");
}

ppm_status ppmi_setup_warn_no_match(const ppmi_setup_match *match, const char *thing,
                                    const char *(*name_of)(const ppm_scene *scene, uint32_t id),
                                    uint32_t count)
{
    const ppmi_setup_value *value = &match->value;
    const char *nearest = NULL, *text = json_string_value(value->json);
    if (text) {
        const ppm_status status = nearest_name(value->setup, text, name_of, count, &nearest);
        if (status != PPM_STATUS_OK) return status;
    } else {
        text = "(a list)";
    }
    ppmi_setup_warn(value, "\"%s\" fits no %s: nothing changes%s%s%s", text, thing,
                    nearest ? "; did you mean \"" : "", nearest ? nearest : "",
                    nearest ? "\"?" : "");
    return PPM_STATUS_OK;
}
