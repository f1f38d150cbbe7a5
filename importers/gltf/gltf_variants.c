/* KHR_materials_variants: a list of names, and for each primitive which material it has in which of
 * them. One is chosen for the whole file. */
#include <stdio.h>
#include <string.h>

#include "gltf/gltf_choice.h"

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

ppm_status ppmi_gltf_choose_variant(ppmi_gltf_reader *reader)
{
    const ppmi_gltf_document *document = reader->document;
    const char *wanted = reader->options->variant;
    char names[400], note[512];
    reader->variant = 0;
    if (wanted) {
        int32_t index = 0;
        const ppm_status status = ppmi_gltf_choose(reader, "variant", wanted, document->variants,
                                                   document->variant_count, false, &index);
        if (status != PPM_STATUS_OK) return status;
        reader->variant = (uint32_t)index + 1;
    }
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
