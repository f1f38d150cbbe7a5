/* Imports of glTF text that a test writes itself, into a scene of its own. */
#ifndef PPM_TESTS_GLTF_FIXTURE_H
#define PPM_TESTS_GLTF_FIXTURE_H

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#include "base/context.h"
#include "gltf/gltf_import.h"
#include "scene/scene.h"

enum { GLTF_LOG_SIZE = 1 << 16 };

typedef struct gltf_fixture {
    ppm_context *context;
    ppm_scene *scene;
    ppm_import_options options;
    char folder[64]; /* a folder of its own, with a "sub" in it */
    size_t log_length;
    char log[GLTF_LOG_SIZE]; /* lines "W text", "E text", "I text" */
} gltf_fixture;

/* cmocka's setup and teardown. Teardown fails when memory is left over. */
int gltf_setup(void **state);
int gltf_teardown(void **state);

/* Forgets scene and log, for another import in the same test. */
void gltf_reset(gltf_fixture *f);

/* The path of a file in the folder. Valid until the next call. */
const char *gltf_path(gltf_fixture *f, const char *name);
void gltf_write(gltf_fixture *f, const char *name, const void *bytes, size_t count);

/* Writes JSON, in which ' stands for ", to sub/scene.gltf and imports it. */
ppm_status gltf_import(gltf_fixture *f, const char *json);
/* The same with printf's formatting. */
ppm_status gltf_importf(gltf_fixture *f, const char *format, ...);
/* Imports a file of the folder. */
ppm_status gltf_import_file(gltf_fixture *f, const char *name);

/* A data: URI of bytes. Valid until the fourth call after this one. */
const char *gltf_data_uri(const void *bytes, size_t count);

/* One mesh of one primitive at one node; attributes, accessors and views are JSON with '. */
ppm_status gltf_import_primitive(gltf_fixture *f, const char *primitive, const char *accessors,
                                 const char *views, const void *bytes, size_t count);

/* Whether a line of the log begins with level ('E', 'W', 'I') and holds text. */
int gltf_logged(const gltf_fixture *f, char level, const char *text);

#define assert_gltf_logged(f, level, text)                                                         \
    do {                                                                                           \
        if (!gltf_logged(f, level, text))                                                          \
            fail_msg("not logged: %c %s\nlog:\n%s", level, text, (f)->log);                        \
    } while (0)
#define assert_gltf_status(f, status, expected)                                                    \
    do {                                                                                           \
        const ppm_status got = (status);                                                           \
        if (got != (expected)) {                                                                   \
            fail_msg("status %s, expected %s\nlog:\n%s", ppm_status_name(got),                     \
                     ppm_status_name(expected), (f)->log);                                         \
        }                                                                                          \
    } while (0)

/* A mesh of one triangle, as the tail of a document after "nodes": meshes and what they need. */
#define GLTF_TRIANGLE                                                                              \
    "'meshes':[{'name':'M','primitives':[{'attributes':{'POSITION':0}}]}],"                        \
    "'accessors':[{'bufferView':0,'componentType':5126,'count':3,'type':'VEC3'}],"                 \
    "'bufferViews':[{'buffer':0,'byteLength':36}],"                                                \
    "'buffers':[{'byteLength':36,'uri':'data:;base64,"                                             \
    "AAAAAAAAAAAAAAAAAACAPwAAAAAAAAAAAAAAAAAAgD8AAAAA'}]"
#define GLTF_HEAD "'asset':{'version':'2.0'},'scenes':[{'nodes':[0]}],"

#endif
