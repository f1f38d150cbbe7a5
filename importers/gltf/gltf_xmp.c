/* KHR_xmp_json_ld: metadata about the asset, which says nothing about the picture. The packet is
 * taken from the file's own text, which has been checked to be JSON (gltf_check.c), so it keeps
 * whatever its author wrote. */
#include <string.h>

#include "gltf/gltf_json.h"
#include "gltf/gltf_reader.h"

enum { MAX_KEY = 64 };

/* Goes behind a value of any kind. */
static bool skip(ppmi_gltf_json *json)
{
    ppmi_gltf_span span;
    ppmi_gltf_number number;
    char letter;
    size_t depth = 0;
    do {
        const char next = ppmi_gltf_json_peek(json);
        bool is_fine = true;
        if (next == '"') {
            is_fine = ppmi_gltf_json_string(json, &span);
        } else if (next == '-' || (next >= '0' && next <= '9')) {
            is_fine = ppmi_gltf_json_number(json, &number);
        } else if (next == 't' || next == 'f' || next == 'n') {
            is_fine = ppmi_gltf_json_literal(json, &letter);
        } else if (next == 0) {
            is_fine = false;
        } else { /* brackets, commas, colons */
            depth += next == '{' || next == '[';
            depth -= next == '}' || next == ']';
            ++json->at;
        }
        if (!is_fine) return false;
    } while (depth > 0);
    return true;
}

/* From the { of an object to the value of a member; false when there is none of that name. */
static bool enter_member(ppmi_gltf_json *json, const char *name)
{
    char key[MAX_KEY];
    ppmi_gltf_span span;
    if (!ppmi_gltf_json_take(json, '{')) return false;
    while (ppmi_gltf_json_peek(json) == '"') {
        if (!ppmi_gltf_json_string(json, &span) || !ppmi_gltf_json_take(json, ':')) return false;
        const bool fits = span.end - span.begin <= sizeof key;
        const size_t length = fits ? ppmi_gltf_json_unescape(json->text, span, key) : 0;
        if (length == strlen(name) && memcmp(key, name, length) == 0) return true;
        if (!skip(json)) return false;
        ppmi_gltf_json_take(json, ',');
    }
    return false;
}

/* From the [ of an array to item number index. */
static bool enter_item(ppmi_gltf_json *json, int32_t index)
{
    if (!ppmi_gltf_json_take(json, '[')) return false;
    for (int32_t i = 0; ppmi_gltf_json_peek(json) != ']'; ++i) {
        if (i == index) return true;
        if (!skip(json)) return false;
        ppmi_gltf_json_take(json, ',');
    }
    return false;
}

ppm_status ppmi_gltf_read_xmp(ppmi_gltf_reader *reader)
{
    const int32_t packet = reader->document->xmp_packet;
    ppmi_gltf_json json = {.text = reader->json, .length = reader->json_length};
    if (packet < 0) return PPM_STATUS_OK;
    if (!enter_member(&json, "extensions") || !enter_member(&json, "KHR_xmp_json_ld") ||
        !enter_member(&json, "packets") || !enter_item(&json, packet) ||
        ppmi_gltf_json_peek(&json) != '{') {
        ppmi_gltf_warn(reader, "asset.extensions.KHR_xmp_json_ld.packet",
                       "packet %d does not exist, or is no object", (int)packet);
        return PPM_STATUS_OK;
    }
    const size_t begin = json.at;
    skip(&json);
    char *text = ppmi_alloc(reader->context, json.at - begin + 1, 1);
    if (!text) return ppmi_gltf_out_of_memory(reader, "extensions.KHR_xmp_json_ld");
    memcpy(text, reader->json + begin, json.at - begin);
    text[json.at - begin] = 0;
    reader->xmp = text;
    return PPM_STATUS_OK;
}
