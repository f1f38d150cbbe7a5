/* References between parts of a document, and messages that name them. */
#include "gltf/gltf_reader.h"

#include <stdio.h>
#include <string.h>

static const char *const list_names[PPMI_GLTF_LIST_COUNT] = {
    [PPMI_GLTF_SCENES] = "scenes",
    [PPMI_GLTF_NODES] = "nodes",
    [PPMI_GLTF_MESHES] = "meshes",
    [PPMI_GLTF_ACCESSORS] = "accessors",
    [PPMI_GLTF_BUFFER_VIEWS] = "bufferViews",
    [PPMI_GLTF_BUFFERS] = "buffers",
    [PPMI_GLTF_MATERIALS] = "materials",
    [PPMI_GLTF_TEXTURES] = "textures",
    [PPMI_GLTF_IMAGES] = "images",
    [PPMI_GLTF_SAMPLERS] = "samplers",
    [PPMI_GLTF_CAMERAS] = "cameras",
    [PPMI_GLTF_LIGHTS] = "lights",
    [PPMI_GLTF_AREA_LIGHTS] = "lights",
    [PPMI_GLTF_LIGHT_PROFILES] = "lights",
    [PPMI_GLTF_IMAGE_LIGHTS] = "lights",
    [PPMI_GLTF_CUBEMAPS] = "cubemaps",
    [PPMI_GLTF_ENVIRONMENT_MAPS] = "environment_maps",
    [PPMI_GLTF_ANIMATIONS] = "animations",
    [PPMI_GLTF_SKINS] = "skins",
    [PPMI_GLTF_VARIANTS] = "variants"};

bool ppmi_gltf_is_usable(const ppmi_gltf_reader *reader, int list, int32_t index, char *reason,
                         size_t reason_size)
{
    const ppmi_gltf_list *items = &reader->outline.lists[list];
    if (index < 0 || (size_t)index >= items->count) {
        snprintf(reason, reason_size, "%s[%d] does not exist; there are %zu", list_names[list],
                 (int)index, items->count);
        return false;
    }
    if (items->broken[index]) {
        snprintf(reason, reason_size, "broken: %s", items->broken[index]);
        return false;
    }
    return true;
}

ppm_status ppmi_gltf_require(ppmi_gltf_reader *reader, int list, int32_t index, const char *place)
{
    char reason[2 * PPMI_GLTF_PLACE];
    if (ppmi_gltf_is_usable(reader, list, index, reason, sizeof reason)) return PPM_STATUS_OK;
    return ppmi_gltf_invalid(reader, place, "%s", reason);
}

bool ppmi_gltf_accept(ppmi_gltf_reader *reader, int list, int32_t index, const char *place)
{
    char reason[2 * PPMI_GLTF_PLACE];
    if (ppmi_gltf_is_usable(reader, list, index, reason, sizeof reason)) return true;
    ppmi_gltf_warn(reader, place, "left out: %s", reason);
    return false;
}

void ppmi_gltf_place(char place[PPMI_GLTF_PLACE], const char *format, ...)
{
    va_list arguments;
    va_start(arguments, format);
    vsnprintf(place, PPMI_GLTF_PLACE, format, arguments);
    va_end(arguments);
}

ppm_status ppmi_gltf_invalid(ppmi_gltf_reader *reader, const char *place, const char *format, ...)
{
    char text[2 * PPMI_GLTF_PLACE];
    va_list arguments;
    va_start(arguments, format);
    vsnprintf(text, sizeof text, format, arguments);
    va_end(arguments);
    return ppmi_fail(reader->context, PPM_STATUS_INPUT_INVALID, "%s: %s: %s", reader->path, place,
                     text);
}

void ppmi_gltf_warn(ppmi_gltf_reader *reader, const char *place, const char *format, ...)
{
    char text[2 * PPMI_GLTF_PLACE];
    va_list arguments;
    if (reader->is_posed_again) return;
    va_start(arguments, format);
    vsnprintf(text, sizeof text, format, arguments);
    va_end(arguments);
    ppmi_log(reader->context, PPM_LOG_WARNING, "%s: %s: %s", reader->path, place, text);
}

ppm_status ppmi_gltf_out_of_memory(ppmi_gltf_reader *reader, const char *place)
{
    return ppmi_fail(reader->context, PPM_STATUS_OUT_OF_MEMORY, "%s: %s: out of memory",
                     reader->path, place);
}

const char *ppmi_gltf_printable(const char *text, size_t length, char *buffer, size_t size)
{
    const size_t count = length < size ? length : size - 1;
    for (size_t i = 0; i < count; ++i) {
        const unsigned char c = (unsigned char)text[i];
        buffer[i] = (char)(c < 0x20 || c == 0x7f ? '?' : c);
    }
    buffer[count] = 0;
    /* a cut must not leave half a character */
    for (size_t end = count; count < length && end > 0 && (buffer[--end] & 0x80);) {
        const bool is_lead = (buffer[end] & 0xc0) == 0xc0;
        buffer[end] = 0;
        if (is_lead) break;
    }
    return buffer;
}

int32_t ppmi_gltf_find_attribute(const ppmi_gltf_attribute *attributes, uint32_t count,
                                 const char *name)
{
    for (uint32_t i = 0; i < count; ++i) {
        if (strcmp(attributes[i].name, name) == 0) return attributes[i].accessor;
    }
    return -1;
}
