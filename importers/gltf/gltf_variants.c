/* KHR_materials_variants: a list of names, and for each primitive which material it has in which of
 * them. One is chosen for the whole file. */
#include <stdio.h>
#include <string.h>

#include "base/suggest.h"
#include "gltf/gltf_reader.h"

/* ": 'a', 'b' and 3 more" */
static void list_names(const ppmi_gltf_document *document, char *text, size_t size)
{
    const size_t room = size - 24; /* for the end */
    size_t length = 0, i = 0;
    text[0] = 0;
    for (; i < document->variant_count; ++i) {
        char name[64], item[80];
        const char *from = document->variants[i];
        ppmi_gltf_printable(from, strlen(from), name, sizeof name);
        snprintf(item, sizeof item, "%s'%s'", i == 0 ? ": " : ", ", name);
        if (length + strlen(item) >= room) break;
        length += (size_t)snprintf(text + length, room - length, "%s", item);
    }
    if (i < document->variant_count) {
        snprintf(text + length, size - length, " and %zu more", document->variant_count - i);
    }
}

static ppm_status refuse(const ppmi_gltf_reader *reader, const char *wanted)
{
    const ppmi_gltf_document *document = reader->document;
    const char *nearest = ppmi_suggest(wanted, document->variants, document->variant_count);
    char names[400];
    list_names(document, names, sizeof names);
    return ppmi_fail(reader->context, PPM_STATUS_INVALID_ARGUMENT,
                     "%s: there is no variant '%s'; the file has %zu%s%s%s%s", reader->path, wanted,
                     document->variant_count, names, nearest ? "; did you mean '" : "",
                     nearest ? nearest : "", nearest ? "'?" : "");
}

ppm_status ppmi_gltf_choose_variant(ppmi_gltf_reader *reader)
{
    const ppmi_gltf_document *document = reader->document;
    const char *wanted = reader->options->variant;
    char names[400], note[512];
    reader->variant = 0;
    for (size_t i = 0; wanted && i < document->variant_count && reader->variant == 0; ++i) {
        if (strcmp(document->variants[i], wanted) == 0) reader->variant = (uint32_t)i + 1;
    }
    if (wanted && reader->variant == 0) return refuse(reader, wanted);
    if (document->variant_count == 0) return PPM_STATUS_OK;
    if (wanted) {
        snprintf(note, sizeof note, "'%.64s' is shown", wanted);
    } else {
        list_names(document, names, sizeof names);
        snprintf(note, sizeof note, "the plain materials are shown; --variant chooses one of %zu%s",
                 document->variant_count, names);
    }
    ppmi_gltf_note_feature(reader, "KHR_materials_variants", PPM_FEATURE_HONOURED, note);
    return PPM_STATUS_OK;
}

int32_t ppmi_gltf_variant_material(const ppmi_gltf_reader *reader,
                                   const ppmi_gltf_primitive *primitive)
{
    for (uint32_t i = 0; reader->variant > 0 && i < primitive->mapping_count; ++i) {
        const ppmi_gltf_mapping *mapping = &primitive->mappings[i];
        for (uint32_t k = 0; k < mapping->variant_count; ++k) {
            if (mapping->variants[k] == (int32_t)reader->variant - 1) return mapping->material;
        }
    }
    return primitive->material;
}
