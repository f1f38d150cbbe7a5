/* Lists that double as they grow. */
#include "base/catalog.h"

#include <string.h>

/* The bytes of the letter of UTF-8 at text (RFC 3629); 0 when there is none, or a control
 * character. */
static size_t letter_bytes(const unsigned char *text)
{
    static const unsigned least[] = {0, 0, 0x80, 0x800, 0x10000};
    if (text[0] < 0x80) return text[0] >= 0x20 && text[0] != 0x7f;
    const size_t count = text[0] >= 0xf0 ? 4 : text[0] >= 0xe0 ? 3 : 2;
    if (text[0] < 0xc2 || text[0] > 0xf4) return 0;
    unsigned code = text[0] & (0x7fu >> count);
    for (size_t i = 1; i < count; i++) {
        if ((text[i] & 0xc0) != 0x80) return 0;
        code = code << 6 | (text[i] & 0x3fu);
    }
    const bool is_surrogate = code >= 0xd800 && code <= 0xdfff;
    const bool is_control = code < 0xa0;
    return code < least[count] || code > 0x10ffff || is_surrogate || is_control ? 0 : count;
}

char *ppmi_catalog_text(ppmi_catalog *catalog, const char *text)
{
    char *copy = ppmi_string_copy(catalog->context, text);
    if (!copy) catalog->is_out_of_memory = true;
    for (unsigned char *at = (unsigned char *)copy; at && *at;) {
        const size_t bytes = letter_bytes(at);
        if (bytes == 0) *at = '?';
        at += bytes > 0 ? bytes : 1;
    }
    return copy;
}

static bool make_room(ppmi_catalog *catalog, ppmi_catalog_list *list)
{
    if (list->count < list->capacity) return true;
    const size_t capacity = list->capacity > 0 ? 2 * list->capacity : 16;
    ppmi_catalog_item *items = ppmi_alloc(catalog->context, capacity, sizeof *items);
    if (!items) return false;
    if (list->count > 0) memcpy(items, list->items, list->count * sizeof *items);
    ppmi_free(catalog->context, list->items);
    list->items = items;
    list->capacity = capacity;
    return true;
}

ppmi_catalog_item *ppmi_catalog_add(ppmi_catalog *catalog, int32_t kind, const char *name,
                                    const char *detail)
{
    ppmi_catalog_list *list = &catalog->lists[kind];
    ppmi_catalog_item item = {.name = ppmi_catalog_text(catalog, name),
                              .detail = ppmi_catalog_text(catalog, detail)};
    if (item.name && item.detail && make_room(catalog, list)) {
        list->items[list->count] = item;
        return &list->items[list->count++];
    }
    ppmi_free(catalog->context, item.name);
    ppmi_free(catalog->context, item.detail);
    catalog->is_out_of_memory = true;
    return NULL;
}

void ppmi_catalog_deinit(ppmi_catalog *catalog)
{
    for (int kind = 0; kind < PPM_ASSET_KINDS; kind++) {
        ppmi_catalog_list *list = &catalog->lists[kind];
        for (size_t i = 0; i < list->count; i++) {
            ppmi_free(catalog->context, list->items[i].name);
            ppmi_free(catalog->context, list->items[i].detail);
        }
        ppmi_free(catalog->context, list->items);
    }
    ppmi_free(catalog->context, catalog->generator);
    ppmi_free(catalog->context, catalog->light_units);
    *catalog = (ppmi_catalog){0};
}
