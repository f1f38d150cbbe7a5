/* Imports of OBJ and MTL text that a test writes itself, into a scene of its own. */
#ifndef PPM_TESTS_OBJ_FIXTURE_H
#define PPM_TESTS_OBJ_FIXTURE_H

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#include "base/context.h"
#include "obj/obj_import.h"
#include "scene/scene.h"

enum { OBJ_LOG_SIZE = 1 << 16 };

typedef struct obj_fixture {
    ppm_context *context;
    ppm_scene *scene;
    ppm_import_options options;
    char folder[64]; /* a folder of its own, with "sub" and "sub/Maps" in it */
    size_t log_length;
    char log[OBJ_LOG_SIZE]; /* lines "W text", "E text", "I text" */
} obj_fixture;

/* cmocka's setup and teardown. Teardown fails when memory is left over. */
int obj_setup(void **state);
int obj_teardown(void **state);

/* Forgets scene and log, for another import in the same test. */
void obj_reset(obj_fixture *f);

/* The path of a file in the folder. Valid until the next call. */
const char *obj_path(obj_fixture *f, const char *name);
void obj_write(obj_fixture *f, const char *name, const void *bytes, size_t count);
void obj_write_text(obj_fixture *f, const char *name, const char *text);

/* Writes text to sub/scene.obj and imports it into an empty scene. */
ppm_status obj_import(obj_fixture *f, const char *text);
ppm_status obj_import_bytes(obj_fixture *f, const char *text, size_t length);
/* Imports a triangle whose material "m" has these statements, from sub/scene.mtl. */
const ppm_material_desc *obj_import_material(obj_fixture *f, const char *statements);
ppm_status obj_import_file(obj_fixture *f, const char *name);

/* The primitive of a scene that has just one instance of one primitive. */
const ppmi_primitive *obj_only_primitive(const obj_fixture *f);

/* Whether a line of the log begins with level ('E', 'W', 'I') and holds text. */
int obj_logged(const obj_fixture *f, char level, const char *text);

#define assert_obj_logged(f, level, text)                                                          \
    do {                                                                                           \
        if (!obj_logged(f, level, text))                                                           \
            fail_msg("not logged: %c %s\nlog:\n%s", level, text, (f)->log);                        \
    } while (0)
#define assert_obj_quiet(f)                                                                        \
    do {                                                                                           \
        if (obj_logged(f, 'W', "") || obj_logged(f, 'E', "")) fail_msg("log:\n%s", (f)->log);      \
    } while (0)
#define assert_obj_status(f, status, expected)                                                     \
    do {                                                                                           \
        const ppm_status got = (status);                                                           \
        if (got != (expected)) {                                                                   \
            fail_msg("status %s, expected %s\nlog:\n%s", ppm_status_name(got),                     \
                     ppm_status_name(expected), (f)->log);                                         \
        }                                                                                          \
    } while (0)
#define assert_obj_near(value, expected)                                                           \
    do {                                                                                           \
        const double got = (double)(value), wanted = (double)(expected);                           \
        if (!(got - wanted < 1e-5 && wanted - got < 1e-5))                                         \
            fail_msg("%s is %g, expected %g", #value, got, wanted);                                \
    } while (0)

#define OBJ_TRIANGLE "v 0 0 0\nv 1 0 0\nv 0 1 0\n"
#define OBJ_SQUARE "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\n"

#endif
