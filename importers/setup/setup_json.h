/* Values of a setup file: JSON with its place, read by tables of keys. Every failure names file,
 * place, what was found and what was expected. */
#ifndef PPMI_SETUP_JSON_H
#define PPMI_SETUP_JSON_H

#include <jansson.h>
#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#include "base/context.h"
#include "ppm/setup.h"

enum { PPMI_SETUP_PLACE = 160 };

/* A value and where it stands, like "lights[2].color". */
typedef struct ppmi_setup_value {
    ppm_setup *setup;
    const json_t *json;
    char place[PPMI_SETUP_PLACE];
} ppmi_setup_value;

/* What a key's value is, and what it is stored as. */
enum {
    PPMI_SETUP_REAL,    /* double: low .. high */
    PPMI_SETUP_FLOAT,   /* float: low .. high */
    PPMI_SETUP_REALS,   /* count doubles: low .. high each */
    PPMI_SETUP_FLOATS,  /* count floats: low .. high each */
    PPMI_SETUP_COLOR,   /* 3 floats: low .. high each, or one number for all */
    PPMI_SETUP_INTEGER, /* int32_t: low .. high */
    PPMI_SETUP_FLAG,    /* uint32_t: true or false */
    PPMI_SETUP_TEXT,    /* const char *, not empty; valid as long as the setup */
    PPMI_SETUP_WORD,    /* int32_t, one of words */
    PPMI_SETUP_OWN      /* by read */
};

typedef struct ppmi_setup_word {
    const char *name; /* NULL ends a list */
    int32_t value;
} ppmi_setup_word;

typedef struct ppmi_setup_key {
    const char *name;
    int32_t kind; /* PPMI_SETUP_ */
    size_t field; /* offset in the target */
    double low, high;
    uint32_t count;
    const ppmi_setup_word *words;
    ppm_status (*read)(const ppmi_setup_value *value, const struct ppmi_setup_key *key,
                       void *target);
} ppmi_setup_key;

/* Reads an object into target, which keeps what the object does not name. An unknown key is an
 * error that names the nearest known one; a key that begins with "_" is a remark. *out_given has
 * the bit of each key that is there, by its number in keys; for tables of up to 64, else NULL. */
ppm_status ppmi_setup_read_object(const ppmi_setup_value *object, const ppmi_setup_key *keys,
                                  size_t key_count, void *target, uint64_t *out_given);

/* Reads one value by a key, into the key's field of target. */
ppm_status ppmi_setup_read_value(const ppmi_setup_value *value, const ppmi_setup_key *key,
                                 void *target);

ppmi_setup_value ppmi_setup_member(const ppmi_setup_value *object, const char *key,
                                   const json_t *json);
ppmi_setup_value ppmi_setup_element(const ppmi_setup_value *array, size_t index);

/* Reports "file: place: message"; returns INPUT_INVALID. */
ppm_status ppmi_setup_fail(const ppmi_setup_value *value, const char *format, ...)
    PPMI_PRINTF(2, 3);
/* As before, for a value that is not what it should be: expected completes "..., expected ...". */
ppm_status ppmi_setup_refuse(const ppmi_setup_value *value, const char *expected);
void ppmi_setup_warn(const ppmi_setup_value *value, const char *format, ...) PPMI_PRINTF(2, 3);

/* Of exactly one of several keys, given is the bits that are there: fails unless it is one bit of
 * mask, or none where that is fine. keys are those of the table, for the message. */
ppm_status ppmi_setup_check_one(const ppmi_setup_value *object, const ppmi_setup_key *keys,
                                size_t key_count, uint64_t given, uint64_t mask, bool may_lack);
/* Fails if a bit of mask is given; reason completes "'key': ...". */
ppm_status ppmi_setup_check_none(const ppmi_setup_value *object, const ppmi_setup_key *keys,
                                 size_t key_count, uint64_t given, uint64_t mask,
                                 const char *reason);

#endif
