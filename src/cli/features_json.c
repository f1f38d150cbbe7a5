/* Both --stats and --list=json tell what of a file is understood. */
#include "features_json.h"

#include <stdlib.h>
#include <string.h>

const char *feature_verdict(int32_t verdict)
{
    if (verdict == PPM_FEATURE_HONOURED) return "honoured";
    return verdict == PPM_FEATURE_APPROXIMATED ? "approximated" : "ignored";
}

/* Each byte as the letter of that number. */
static json_t *latin1_json(const char *text)
{
    char *const buffer = malloc(2 * strlen(text) + 1);
    if (!buffer) return NULL;
    char *end = buffer;
    for (const unsigned char *letter = (const unsigned char *)text; *letter; letter++) {
        if (*letter < 0x80) {
            *end++ = (char)*letter;
        } else {
            *end++ = (char)(0xc0 | *letter >> 6);
            *end++ = (char)(0x80 | (*letter & 0x3f));
        }
    }
    *end = '\0';
    json_t *const result = json_string(buffer);
    free(buffer);
    return result;
}

json_t *text_json(const char *text)
{
    json_t *const result = json_string(text ? text : "");
    return result ? result : latin1_json(text);
}

json_t *features_json(const ppm_asset *asset)
{
    const uint32_t count = ppm_asset_feature_count(asset);
    json_t *const list = json_array();
    for (uint32_t i = 0; list && i < count; i++) {
        ppm_asset_feature feature = {.size = sizeof feature};
        if (ppm_asset_get_feature(asset, i, &feature) != PPM_STATUS_OK) continue;
        json_t *const item = json_object();
        json_object_set_new(item, "name", text_json(feature.name));
        json_object_set_new(item, "verdict", json_string(feature_verdict(feature.verdict)));
        json_object_set_new(item, "note", text_json(feature.note));
        json_array_append_new(list, item);
    }
    return list;
}
