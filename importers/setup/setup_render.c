/* Render options, as texts of the command line: what they mean is the program's to know. */
#include <math.h>
#include <stdio.h>
#include <string.h>

#include "setup/setup_file.h"

enum { TEXT_MAX = 512 };

/* Numbers of a list stand between commas; one that has a point in the file keeps it, as --crop
 * tells pixels from shares by it. False for what cannot be on a command line. */
static bool write_scalar(const json_t *json, char *buffer, size_t size)
{
    if (json_is_string(json)) {
        const char *text = json_string_value(json);
        if (strlen(text) != json_string_length(json) || strlen(text) >= size) return false;
        strcpy(buffer, text);
        return *text != '\0';
    }
    if (json_is_integer(json)) {
        snprintf(buffer, size, "%lld", (long long)json_integer_value(json));
        return true;
    }
    if (!json_is_real(json)) return false;
    snprintf(buffer, size, "%.17g", json_real_value(json));
    if (!strpbrk(buffer, ".e")) strncat(buffer, ".0", size - strlen(buffer) - 1);
    return true;
}

static bool write_value(const json_t *json, char *buffer, size_t size)
{
    size_t used = 0;
    if (!json_is_array(json)) return write_scalar(json, buffer, size);
    for (size_t i = 0; i < json_array_size(json); i++) {
        if (used + 64 >= size) return false;
        if (i > 0) buffer[used++] = ',';
        if (!write_scalar(json_array_get(json, i), buffer + used, size - used)) return false;
        used += strlen(buffer + used);
    }
    return used > 0;
}

ppm_status ppmi_setup_render_section(const ppmi_setup_value *render)
{
    const char *name;
    json_t *json;
    if (!json_is_object(render->json)) {
        return ppmi_setup_refuse(render, "an object: { \"key\": value, ... }");
    }
    json_object_foreach((json_t *)render->json, name, json)
    {
        char text[TEXT_MAX] = "";
        const ppmi_setup_value value = ppmi_setup_member(render, name, json);
        if (name[0] == '_' || json_is_false(json)) continue;
        if (!json_is_true(json) && !write_value(json, text, sizeof text)) {
            return ppmi_setup_refuse(&value, "a text, a number, true, false, or a list of numbers");
        }
        const ppm_status status = ppmi_setup_add_entry(render->setup, 0, name, text);
        if (status != PPM_STATUS_OK) return status;
    }
    return PPM_STATUS_OK;
}
