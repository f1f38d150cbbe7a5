/* Containers of the OBJ importer: arrays that grow, and the numbering of distinct strings and of
 * distinct triples of integers. Zeroed is empty. */
#ifndef PPMI_OBJ_TABLES_H
#define PPMI_OBJ_TABLES_H

#include <stdint.h>

#include "base/context.h"

typedef struct ppmi_obj_array {
    void *items;
    size_t count, capacity;
} ppmi_obj_array;

/* Room for n more elements, counted; NULL when memory is out (not reported). */
void *ppmi_obj_push(ppm_context *context, ppmi_obj_array *array, size_t n, size_t element_size);
void ppmi_obj_array_deinit(ppm_context *context, ppmi_obj_array *array);

/* Open addressing. index is one more than what it stands for; 0: an empty slot. */
typedef struct ppmi_obj_slot {
    uint32_t hash, index;
} ppmi_obj_slot;

typedef struct ppmi_obj_hash {
    ppmi_obj_slot *slots;
    size_t capacity; /* a power of two, or 0 */
} ppmi_obj_hash;

typedef struct ppmi_obj_names {
    ppmi_obj_hash hash;
    ppmi_obj_array offsets; /* size_t, into text */
    ppmi_obj_array text;    /* each with a zero behind it */
} ppmi_obj_names;

/* The number of a string, from 0 in order of appearance. False when memory is out. */
bool ppmi_obj_names_add(ppm_context *context, ppmi_obj_names *names, const char *text,
                        size_t length, uint32_t *out_index);
/* False when it is not there. */
bool ppmi_obj_names_find(const ppmi_obj_names *names, const char *text, uint32_t *out_index);
/* Valid until the next add. */
const char *ppmi_obj_names_get(const ppmi_obj_names *names, uint32_t index);
uint32_t ppmi_obj_names_count(const ppmi_obj_names *names);
void ppmi_obj_names_deinit(ppm_context *context, ppmi_obj_names *names);

typedef struct ppmi_obj_triple {
    int32_t a, b, c;
} ppmi_obj_triple;

typedef struct ppmi_obj_triples {
    ppmi_obj_hash hash;
    ppmi_obj_array items; /* ppmi_obj_triple, by number */
} ppmi_obj_triples;

/* As for names. */
bool ppmi_obj_triples_add(ppm_context *context, ppmi_obj_triples *triples, ppmi_obj_triple triple,
                          uint32_t *out_index);
void ppmi_obj_triples_deinit(ppm_context *context, ppmi_obj_triples *triples);

/* Text as UTF-8 without control characters, in a new string: bytes that are not UTF-8 make all of
 * it Latin-1. NULL when memory is out. */
char *ppmi_obj_utf8(ppm_context *context, const char *text, size_t length);

#endif
