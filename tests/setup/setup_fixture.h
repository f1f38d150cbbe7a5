/* Setup files that a test writes itself, opened and applied in a folder of its own. */
#ifndef PPM_TESTS_SETUP_FIXTURE_H
#define PPM_TESTS_SETUP_FIXTURE_H

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#include "base/context.h"
#include "ppm/ppm.h"
#include "scene/scene.h"

enum { SETUP_LOG_SIZE = 1 << 15 };

typedef struct setup_fixture {
    ppm_context *context;
    ppm_scene *scene; /* a room by setup_make_room */
    ppm_setup *setup; /* NULL: not opened */
    char folder[64];  /* a folder of its own, with "inner" in it, in which setup files lie */
    size_t log_length;
    char log[SETUP_LOG_SIZE]; /* lines "W text", "E text", "I text" */
} setup_fixture;

/* cmocka's setup and teardown. Teardown fails when memory is left over. */
int setup_setup(void **state);
int setup_teardown(void **state);

/* A scene with materials "Floor", "Glass", "Glass clear", "Lamp"; nodes "Floor" and "Box", of which
 * "Box" is of "Glass", and "Copy", which shows the mesh of "Box". No camera, no lamp. */
ppm_scene *setup_make_room(ppm_context *context);

/* The path of a file in the folder. Valid until the next call. */
const char *setup_path(const setup_fixture *f, const char *name);
void setup_write(const setup_fixture *f, const char *name, const char *text);
/* A picture of 4 x 2 pixels. */
void setup_write_picture(const setup_fixture *f, const char *name);

/* Writes text to inner/s.ppm.json and opens it, with what was open before closed. */
ppm_status setup_open(setup_fixture *f, const char *text);
/* Opens text, which must be right, and applies it to a new room. */
ppm_status setup_apply(setup_fixture *f, const char *text);

/* Fails unless text is refused as it is opened, with expected in the message. */
void assert_refused(setup_fixture *f, const char *text, const char *expected);
/* Fails unless the scene renders to the same bits as other, and the picture is not black. other is
 * destroyed. options may be NULL. */
void assert_same_picture(setup_fixture *f, ppm_scene *other, ppm_camera_id camera);

/* Whether a line of the log begins with level ('E', 'W', 'I') and holds text. */
int setup_logged(const setup_fixture *f, char level, const char *text);
#define assert_setup_logged(f, level, text)                                                        \
    do {                                                                                           \
        if (!setup_logged(f, level, text))                                                         \
            fail_msg("not logged: %c %s\nlog:\n%s", level, text, (f)->log);                        \
    } while (0)

#endif
