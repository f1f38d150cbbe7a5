/* Growing arrays and hash tables; a table that numbers what it holds needs no removal. */
#include "obj/obj_tables.h"

#include <string.h>

void *ppmi_obj_push(ppm_context *context, ppmi_obj_array *array, size_t n, size_t element_size)
{
    if (n > array->capacity - array->count) {
        const size_t doubled = array->capacity > 0 ? 2 * array->capacity : 16;
        const size_t capacity = doubled - array->count >= n ? doubled : array->count + n;
        void *items = ppmi_alloc(context, capacity, element_size);
        if (!items) return NULL;
        if (array->count > 0) memcpy(items, array->items, array->count * element_size);
        ppmi_free(context, array->items);
        array->items = items;
        array->capacity = capacity;
    }
    void *added = (char *)array->items + array->count * element_size;
    array->count += n;
    return added;
}

void ppmi_obj_array_deinit(ppm_context *context, ppmi_obj_array *array)
{
    ppmi_free(context, array->items);
    *array = (ppmi_obj_array){0};
}

/* ---- hashing --------------------------------------------------------------------------------- */

/* The finaliser of MurmurHash3 (Appleby, public domain): every bit in changes every bit out. */
static uint32_t mix(uint32_t h)
{
    h ^= h >> 16;
    h *= 0x85ebca6bu;
    h ^= h >> 13;
    h *= 0xc2b2ae35u;
    return h ^ h >> 16;
}

static uint32_t hash_text(const char *text, size_t length)
{
    uint32_t h = 2166136261u; /* FNV-1a */
    for (size_t i = 0; i < length; ++i) {
        h = (h ^ (unsigned char)text[i]) * 16777619u;
    }
    return mix(h);
}

static uint32_t hash_triple(ppmi_obj_triple t)
{
    const uint32_t a = mix((uint32_t)t.a), b = (uint32_t)t.b, c = (uint32_t)t.c;
    return mix(mix(a + b * 0x9e3779b9u) + c * 0x7feb352du);
}

/* Room for one more than count: at most half full. */
static bool reserve(ppm_context *context, ppmi_obj_hash *hash, size_t count)
{
    if (count >= UINT32_MAX - 1) return false;
    if (2 * (count + 1) <= hash->capacity) return true;
    const size_t capacity = hash->capacity > 0 ? 2 * hash->capacity : 64;
    ppmi_obj_slot *slots = ppmi_alloc_zeroed(context, capacity, sizeof *slots);
    if (!slots) return false;
    for (size_t i = 0; i < hash->capacity; ++i) {
        if (hash->slots[i].index == 0) continue;
        size_t at = hash->slots[i].hash & (capacity - 1);
        while (slots[at].index != 0) {
            at = (at + 1) & (capacity - 1);
        }
        slots[at] = hash->slots[i];
    }
    ppmi_free(context, hash->slots);
    *hash = (ppmi_obj_hash){slots, capacity};
    return true;
}

/* ---- names ----------------------------------------------------------------------------------- */

const char *ppmi_obj_names_get(const ppmi_obj_names *names, uint32_t index)
{
    return (const char *)names->text.items + ((const size_t *)names->offsets.items)[index];
}

uint32_t ppmi_obj_names_count(const ppmi_obj_names *names)
{
    return (uint32_t)names->offsets.count;
}

/* The slot that holds the text or could. */
static ppmi_obj_slot *probe_name(const ppmi_obj_names *names, const char *text, size_t length,
                                 uint32_t hash)
{
    const size_t mask = names->hash.capacity - 1;
    for (size_t at = hash & mask;; at = (at + 1) & mask) {
        ppmi_obj_slot *slot = &names->hash.slots[at];
        if (slot->index == 0) return slot;
        if (slot->hash != hash) continue;
        const char *other = ppmi_obj_names_get(names, slot->index - 1);
        if (strlen(other) == length && memcmp(other, text, length) == 0) return slot;
    }
}

bool ppmi_obj_names_find(const ppmi_obj_names *names, const char *text, uint32_t *out_index)
{
    if (names->hash.capacity == 0) return false;
    const size_t length = strlen(text);
    const ppmi_obj_slot *slot = probe_name(names, text, length, hash_text(text, length));
    if (slot->index == 0) return false;
    *out_index = slot->index - 1;
    return true;
}

bool ppmi_obj_names_add(ppm_context *context, ppmi_obj_names *names, const char *text,
                        size_t length, uint32_t *out_index)
{
    const uint32_t hash = hash_text(text, length);
    if (!reserve(context, &names->hash, names->offsets.count)) return false;
    ppmi_obj_slot *slot = probe_name(names, text, length, hash);
    if (slot->index == 0) {
        const size_t at = names->text.count;
        char *copy = ppmi_obj_push(context, &names->text, length + 1, 1);
        size_t *offset = copy ? ppmi_obj_push(context, &names->offsets, 1, sizeof *offset) : NULL;
        if (!offset) return false;
        memcpy(copy, text, length);
        copy[length] = 0;
        *offset = at;
        *slot = (ppmi_obj_slot){hash, (uint32_t)names->offsets.count};
    }
    *out_index = slot->index - 1;
    return true;
}

void ppmi_obj_names_deinit(ppm_context *context, ppmi_obj_names *names)
{
    ppmi_free(context, names->hash.slots);
    ppmi_obj_array_deinit(context, &names->offsets);
    ppmi_obj_array_deinit(context, &names->text);
    names->hash = (ppmi_obj_hash){0};
}

/* ---- triples --------------------------------------------------------------------------------- */

bool ppmi_obj_triples_add(ppm_context *context, ppmi_obj_triples *triples, ppmi_obj_triple triple,
                          uint32_t *out_index)
{
    if (!reserve(context, &triples->hash, triples->items.count)) return false;
    const uint32_t hash = hash_triple(triple);
    const size_t mask = triples->hash.capacity - 1;
    ppmi_obj_slot *slot;
    for (size_t at = hash & mask;; at = (at + 1) & mask) {
        slot = &triples->hash.slots[at];
        if (slot->index == 0) break;
        const ppmi_obj_triple *other =
            (const ppmi_obj_triple *)triples->items.items + slot->index - 1;
        if (other->a == triple.a && other->b == triple.b && other->c == triple.c) {
            *out_index = slot->index - 1;
            return true;
        }
    }
    ppmi_obj_triple *item = ppmi_obj_push(context, &triples->items, 1, sizeof *item);
    if (!item) return false;
    *item = triple;
    *slot = (ppmi_obj_slot){hash, (uint32_t)triples->items.count};
    *out_index = slot->index - 1;
    return true;
}

void ppmi_obj_triples_deinit(ppm_context *context, ppmi_obj_triples *triples)
{
    ppmi_free(context, triples->hash.slots);
    ppmi_obj_array_deinit(context, &triples->items);
    triples->hash = (ppmi_obj_hash){0};
}

/* ---- text ------------------------------------------------------------------------------------ */

/* Bytes of the UTF-8 character at text, 0 if it is none (RFC 3629). */
static size_t utf8_length(const unsigned char *text, size_t left)
{
    const unsigned char c = text[0];
    const size_t count = c < 0x80   ? 1
                         : c < 0xc2 ? 0
                         : c < 0xe0 ? 2
                         : c < 0xf0 ? 3
                         : c < 0xf5 ? 4
                                    : 0;
    if (count == 0 || count > left) return 0;
    for (size_t i = 1; i < count; ++i) {
        if ((text[i] & 0xc0) != 0x80) return 0;
    }
    const bool is_overlong = (c == 0xe0 && text[1] < 0xa0) || (c == 0xf0 && text[1] < 0x90);
    const bool is_no_character = (c == 0xed && text[1] >= 0xa0) || (c == 0xf4 && text[1] >= 0x90);
    return is_overlong || is_no_character ? 0 : count;
}

static bool is_utf8(const unsigned char *text, size_t length)
{
    for (size_t i = 0; i < length;) {
        const size_t count = utf8_length(text + i, length - i);
        if (count == 0) return false;
        i += count;
    }
    return true;
}

char *ppmi_obj_utf8(ppm_context *context, const char *text, size_t length)
{
    const unsigned char *from = (const unsigned char *)text;
    const bool is_latin1 = !is_utf8(from, length);
    char *out = ppmi_alloc(context, 2 * length + 1, 1);
    if (!out) return NULL;
    size_t count = 0;
    for (size_t i = 0; i < length; ++i) {
        const unsigned char c = from[i];
        if (is_latin1 && c >= 0x80) {
            out[count++] = (char)(0xc0 | c >> 6);
            out[count++] = (char)(0x80 | (c & 0x3f));
        } else {
            out[count++] = (char)(c < 0x20 || c == 0x7f ? '?' : c);
        }
    }
    out[count] = 0;
    return out;
}
