#include "obj_fixture.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>

static void keep_message(void *user, ppm_log_level level, const char *message)
{
    obj_fixture *f = user;
    const size_t room = sizeof f->log - f->log_length;
    const int n = snprintf(f->log + f->log_length, room, "%c %s\n", "?EWID"[level], message);
    if (n > 0 && (size_t)n < room) f->log_length += (size_t)n;
}

static void open_scene(obj_fixture *f)
{
    assert_int_equal(ppm_scene_create(f->context, NULL, &f->scene), PPM_STATUS_OK);
    f->log_length = 0;
    f->log[0] = 0;
}

int obj_setup(void **state)
{
    obj_fixture *f = calloc(1, sizeof *f);
    if (!f) return -1;
    const ppm_context_desc desc = {.size = sizeof desc, .log = keep_message, .log_user = f};
    snprintf(f->folder, sizeof f->folder, "/tmp/ppm-obj-XXXXXX");
    if (!mkdtemp(f->folder) || mkdir(obj_path(f, "sub"), 0700) != 0 ||
        mkdir(obj_path(f, "sub/Maps"), 0700) != 0) {
        return -1;
    }
    f->options.size = sizeof f->options;
    assert_int_equal(ppm_context_create(&desc, &f->context), PPM_STATUS_OK);
    open_scene(f);
    *state = f;
    return 0;
}

int obj_teardown(void **state)
{
    obj_fixture *f = *state;
    char command[128];
    snprintf(command, sizeof command, "rm -rf -- '%s'", f->folder);
    const int removed = system(command);
    ppm_scene_destroy(f->scene);
    const size_t live = ppmi_alloc_live(f->context);
    ppm_context_destroy(f->context);
    free(f);
    return removed == 0 && live == 0 ? 0 : -1;
}

void obj_reset(obj_fixture *f)
{
    ppm_scene_destroy(f->scene);
    open_scene(f);
}

const char *obj_path(obj_fixture *f, const char *name)
{
    static char path[160];
    snprintf(path, sizeof path, "%s/%s", f->folder, name);
    return path;
}

void obj_write(obj_fixture *f, const char *name, const void *bytes, size_t count)
{
    FILE *file = fopen(obj_path(f, name), "wb");
    assert_non_null(file);
    assert_int_equal(fwrite(bytes, 1, count, file), count);
    assert_int_equal(fclose(file), 0);
}

void obj_write_text(obj_fixture *f, const char *name, const char *text)
{
    obj_write(f, name, text, strlen(text));
}

ppm_status obj_import_file(obj_fixture *f, const char *name)
{
    obj_reset(f);
    return ppmi_obj_import(f->context, f->scene, obj_path(f, name), &f->options);
}

ppm_status obj_import_bytes(obj_fixture *f, const char *text, size_t length)
{
    obj_write(f, "sub/scene.obj", text, length);
    return obj_import_file(f, "sub/scene.obj");
}

ppm_status obj_import(obj_fixture *f, const char *text)
{
    return obj_import_bytes(f, text, strlen(text));
}

const ppm_material_desc *obj_import_material(obj_fixture *f, const char *statements)
{
    char text[2048];
    snprintf(text, sizeof text, "newmtl m\n%s", statements);
    obj_write_text(f, "sub/scene.mtl", text);
    assert_obj_status(
        f, obj_import(f, "mtllib scene.mtl\nusemtl m\nvt 0 0\n" OBJ_TRIANGLE "f 1/1 2/1 3/1\n"),
        PPM_STATUS_OK);
    assert_int_equal(f->scene->material_count, 1);
    return &f->scene->materials[0].desc;
}

const ppmi_primitive *obj_only_primitive(const obj_fixture *f)
{
    assert_int_equal(f->scene->instance_count, 1);
    assert_int_equal(f->scene->mesh_count, 1);
    assert_int_equal(f->scene->meshes[0].primitive_count, 1);
    return &f->scene->meshes[0].primitives[0];
}

int obj_logged(const obj_fixture *f, char level, const char *text)
{
    for (const char *line = f->log; *line;) {
        const char *end = strchr(line, '\n');
        const char *hit = strstr(line, text);
        if (line[0] == level && hit && hit < end) return 1;
        line = end + 1;
    }
    return 0;
}
