#include "setup/setup_fixture.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>

#include "support/renders.h"
#include "support/shapes.h"

static void keep_message(void *user, ppm_log_level level, const char *message)
{
    setup_fixture *f = user;
    const size_t room = sizeof f->log - f->log_length;
    const int n = snprintf(f->log + f->log_length, room, "%c %s\n", "?EWID"[level], message);
    if (n > 0 && (size_t)n < room) f->log_length += (size_t)n;
}

int setup_setup(void **state)
{
    setup_fixture *f = calloc(1, sizeof *f);
    if (!f) return -1;
    const ppm_context_desc desc = {.size = sizeof desc, .log = keep_message, .log_user = f};
    snprintf(f->folder, sizeof f->folder, "/tmp/ppm-setup-XXXXXX");
    if (!mkdtemp(f->folder) || mkdir(setup_path(f, "inner"), 0700) != 0) return -1;
    assert_int_equal(ppm_context_create(&desc, &f->context), PPM_STATUS_OK);
    *state = f;
    return 0;
}

int setup_teardown(void **state)
{
    setup_fixture *f = *state;
    char command[128];
    snprintf(command, sizeof command, "rm -rf -- '%s'", f->folder);
    const int removed = system(command);
    ppm_setup_close(f->setup);
    ppm_scene_destroy(f->scene);
    const size_t live = ppmi_alloc_live(f->context);
    ppm_context_destroy(f->context);
    free(f);
    return removed == 0 && live == 0 ? 0 : -1;
}

/* ---- the scene ------------------------------------------------------------------------------- */

static ppm_material_id add_material(ppm_scene *scene, const char *name, float grey)
{
    ppm_material_desc desc;
    ppm_material_id id;
    ppm_material_desc_init(&desc);
    desc.name = name;
    for (int i = 0; i < 3; i++)
        desc.base_color[i] = grey;
    assert_int_equal(ppm_scene_add_material(scene, &desc, &id), PPM_STATUS_OK);
    return id;
}

static void place(ppm_scene *scene, ppm_mesh_id mesh, const char *name, float x)
{
    ppm_instance_id id;
    const ppm_instance_desc desc = {
        .size = sizeof desc,
        .name = name,
        .mesh = mesh,
        .transform = {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, x, 0, 0, 1},
    };
    assert_int_equal(ppm_scene_add_instance(scene, &desc, &id), PPM_STATUS_OK);
}

ppm_scene *setup_make_room(ppm_context *context)
{
    ppm_scene *scene = NULL;
    assert_int_equal(ppm_scene_create(context, NULL, &scene), PPM_STATUS_OK);
    const ppm_material_id floor = add_material(scene, "Floor", 0.5f);
    const ppm_material_id glass = add_material(scene, "Glass", 0.8f);
    add_material(scene, "Glass clear", 0.9f);
    add_material(scene, "Lamp", 0.3f);
    place(scene, shape_quad(scene, floor, vec3(-2, 0, 2), vec3(4, 0, 0), vec3(0, 0, -4)), "Floor",
          0.0f);
    const ppm_mesh_id box =
        shape_box(scene, glass, vec3(-0.3f, 0.1f, -0.3f), vec3(0.3f, 0.7f, 0.3f), 1, false);
    place(scene, box, "Box", 0.0f);
    place(scene, box, "Copy", 1.0f);
    return scene;
}

/* ---- files ----------------------------------------------------------------------------------- */

const char *setup_path(const setup_fixture *f, const char *name)
{
    static char path[256];
    snprintf(path, sizeof path, "%s/%s", f->folder, name);
    return path;
}

void setup_write(const setup_fixture *f, const char *name, const char *text)
{
    FILE *file = fopen(setup_path(f, name), "wb");
    assert_non_null(file);
    assert_int_equal(fwrite(text, 1, strlen(text), file), strlen(text));
    assert_int_equal(fclose(file), 0);
}

/* Radiance's format, flat: 4 x 2 pixels of mantissas and one exponent. */
void setup_write_picture(const setup_fixture *f, const char *name)
{
    FILE *file = fopen(setup_path(f, name), "wb");
    assert_non_null(file);
    fputs("#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y 2 +X 4\n", file);
    for (unsigned char i = 0; i < 8; i++) {
        const unsigned char pixel[4] = {(unsigned char)(30 * i + 20), 128, (unsigned char)(250 - i),
                                        129};
        assert_int_equal(fwrite(pixel, 1, 4, file), 4);
    }
    assert_int_equal(fclose(file), 0);
}

ppm_status setup_open(setup_fixture *f, const char *text)
{
    ppm_setup_close(f->setup);
    f->setup = NULL;
    f->log_length = 0;
    f->log[0] = 0;
    setup_write(f, "inner/s.ppm.json", text);
    return ppm_setup_open(f->context, setup_path(f, "inner/s.ppm.json"), NULL, &f->setup);
}

ppm_status setup_apply(setup_fixture *f, const char *text)
{
    ppm_scene_destroy(f->scene);
    f->scene = setup_make_room(f->context);
    if (setup_open(f, text) != PPM_STATUS_OK) fail_msg("%s\n%s", text, f->log);
    return ppm_setup_apply(f->setup, f->scene, PPM_SETUP_ALL);
}

/* ---- assertions ------------------------------------------------------------------------------ */

int setup_logged(const setup_fixture *f, char level, const char *text)
{
    for (const char *line = f->log; *line; line += strcspn(line, "\n") + 1) {
        char copy[1024];
        snprintf(copy, sizeof copy, "%.*s", (int)strcspn(line, "\n"), line);
        if (copy[0] == level && strstr(copy, text)) return 1;
    }
    return 0;
}

void assert_refused(setup_fixture *f, const char *text, const char *expected)
{
    const ppm_status status = setup_open(f, text);
    if (status != PPM_STATUS_INPUT_INVALID && status != PPM_STATUS_INPUT_NOT_FOUND) {
        fail_msg("%s\nstatus %d", text, (int)status);
    }
    if (!setup_logged(f, 'E', expected) || !setup_logged(f, 'E', "inner/s.ppm.json: ")) {
        fail_msg("%s\nexpected: %s\nlog:\n%s", text, expected, f->log);
    }
}

void assert_same_picture(setup_fixture *f, ppm_scene *other, ppm_camera_id camera)
{
    ppm_render_options options = render_options(PPM_INTEGRATOR_PATH, 24, 0);
    const size_t count = 4 * 24 * 24;
    double sum = 0.0;
    options.camera = camera;
    float *a = render_picture(f->scene, &options, 2), *b = render_picture(other, &options, 2);
    for (size_t i = 0; i < count; i++) {
        if (memcmp(&a[i], &b[i], sizeof *a) != 0) {
            fail_msg("value %zu is %.9g, and %.9g by calls", i, (double)a[i], (double)b[i]);
        }
        sum += i % 4 < 3 ? a[i] : 0.0f;
    }
    if (!(sum > 1.0)) fail_msg("the picture is black");
    free(a);
    free(b);
    ppm_scene_destroy(other);
}
