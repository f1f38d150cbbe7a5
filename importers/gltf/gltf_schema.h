/* Tables of the members of glTF 2.0 that the importer uses, for gltf_check.c. */
#ifndef PPMI_GLTF_SCHEMA_H
#define PPMI_GLTF_SCHEMA_H

#include <stdint.h>

typedef enum gltf_kind {
    GLTF_ANY = 0,   /* not looked at */
    GLTF_INTEGER,   /* 0 or more, min..max */
    GLTF_NUMBER,    /* min..max */
    GLTF_BOOLEAN,   /* */
    GLTF_STRING,    /* one of choices, if there are any */
    GLTF_OBJECT,    /* with fields */
    GLTF_LIST,      /* of objects with fields; its elements are counted and may break one by one */
    GLTF_OBJECTS,   /* array of objects with fields; in which one is vital where the field is */
    GLTF_NUMBERS,   /* array of min_items..max_items numbers */
    GLTF_INTEGERS,  /* array of integers, min..max */
    GLTF_STRINGS,   /* array of strings */
    GLTF_INDEX_MAP, /* object whose values are integers */
    GLTF_INDEX_MAPS /* array of such objects */
} gltf_kind;

enum {
    GLTF_REQUIRED = 1,
    GLTF_VITAL = 2,        /* a wrong value breaks the element; otherwise it becomes null */
    GLTF_NAMES_MEMBER = 4, /* the chosen string names another member, which is then required */
    GLTF_EMPTY_FOR_TINYGLTF = 8, /* tinygltf gets [] */
    GLTF_FREE_FORM = 16,      /* OBJECT: a value of any other kind is as good, and not looked at */
    GLTF_COMPONENT_TYPE = 64, /* INTEGER: the componentType of an accessor */
    GLTF_KEEPS_EMPTY = 32 /* LIST in an extension: tinygltf drops what has no members, and so shifts
                             the indices; each element gets one more */
};

typedef struct gltf_field {
    const char *key;
    gltf_kind kind;
    uint8_t flags;
    uint8_t list;                    /* LIST: PPMI_GLTF_ */
    uint8_t min_items, max_items;    /* NUMBERS; OBJECTS: min_items */
    double min, max;                 /* INTEGER, NUMBER, INTEGERS; both 0: any */
    double step;                     /* INTEGER: a multiple of this; 0: any */
    const char *choices;             /* STRING: " ONE TWO ", with spaces around each */
    const char *rename;              /* tinygltf gets this key instead */
    const char *placeholder;         /* LIST: what replaces a broken element */
    const struct gltf_field *fields; /* OBJECT, LIST, OBJECTS; ends with a NULL key */
} gltf_field;

/* The members of the root object. */
extern const gltf_field ppmi_gltf_schema[];

#endif
