#include "gltf_fixture.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

static void keep_message(void *user, ppm_log_level level, const char *message)
{
    gltf_fixture *f = user;
    const size_t room = sizeof f->log - f->log_length;
    const int n = snprintf(f->log + f->log_length, room, "%c %s\n", "?EWID"[level], message);
    if (n > 0 && (size_t)n < room) f->log_length += (size_t)n;
}

static void open_scene(gltf_fixture *f)
{
    assert_int_equal(ppm_scene_create(f->context, NULL, &f->scene), PPM_STATUS_OK);
    f->log_length = 0;
    f->log[0] = 0;
}

int gltf_setup(void **state)
{
    gltf_fixture *f = calloc(1, sizeof *f);
    if (!f) return -1;
    const ppm_context_desc desc = {.size = sizeof desc, .log = keep_message, .log_user = f};
    snprintf(f->folder, sizeof f->folder, "/tmp/ppm-gltf-XXXXXX");
    if (!mkdtemp(f->folder) || mkdir(gltf_path(f, "sub"), 0700) != 0) return -1;
    f->options.size = sizeof f->options;
    assert_int_equal(ppm_context_create(&desc, &f->context), PPM_STATUS_OK);
    open_scene(f);
    *state = f;
    return 0;
}

int gltf_teardown(void **state)
{
    gltf_fixture *f = *state;
    char command[128];
    snprintf(command, sizeof command, "rm -rf -- '%s'", f->folder);
    const int removed = system(command);
    ppm_scene_destroy(f->scene);
    const size_t live = ppmi_alloc_live(f->context);
    ppm_context_destroy(f->context);
    free(f);
    return removed == 0 && live == 0 ? 0 : -1;
}

void gltf_reset(gltf_fixture *f)
{
    ppm_scene_destroy(f->scene);
    open_scene(f);
}

const char *gltf_path(gltf_fixture *f, const char *name)
{
    static char path[160];
    snprintf(path, sizeof path, "%s/%s", f->folder, name);
    return path;
}

void gltf_write(gltf_fixture *f, const char *name, const void *bytes, size_t count)
{
    FILE *file = fopen(gltf_path(f, name), "wb");
    assert_non_null(file);
    assert_int_equal(fwrite(bytes, 1, count, file), count);
    assert_int_equal(fclose(file), 0);
}

ppm_status gltf_import_file(gltf_fixture *f, const char *name)
{
    return ppmi_gltf_import(f->context, f->scene, gltf_path(f, name), &f->options);
}

ppm_status gltf_import(gltf_fixture *f, const char *json)
{
    const size_t length = strlen(json);
    char *text = malloc(length + 1);
    assert_non_null(text);
    for (size_t i = 0; i <= length; ++i) {
        text[i] = (char)(json[i] == '\'' ? '"' : json[i]);
    }
    gltf_write(f, "sub/scene.gltf", text, length);
    free(text);
    return gltf_import_file(f, "sub/scene.gltf");
}

ppm_status gltf_importf(gltf_fixture *f, const char *format, ...)
{
    va_list arguments;
    char *text = NULL;
    va_start(arguments, format);
    const int length = vsnprintf(NULL, 0, format, arguments);
    va_end(arguments);
    assert_true(length > 0);
    text = malloc((size_t)length + 1);
    assert_non_null(text);
    va_start(arguments, format);
    vsnprintf(text, (size_t)length + 1, format, arguments);
    va_end(arguments);
    const ppm_status status = gltf_import(f, text);
    free(text);
    return status;
}

const char *gltf_data_uri(const void *bytes, size_t count)
{
    static const char digits[] = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    static char uris[4][4096];
    static unsigned next;
    char *uri = uris[next++ % 4], *out = uri + sprintf(uri, "data:;base64,");
    const unsigned char *in = bytes;
    assert_true(count < 2900);
    for (size_t i = 0; i < count; i += 3) {
        const size_t left = count - i;
        const uint32_t bits = (uint32_t)in[i] << 16 | (left > 1 ? (uint32_t)in[i + 1] << 8 : 0) |
                              (left > 2 ? (uint32_t)in[i + 2] : 0);
        *out++ = digits[bits >> 18];
        *out++ = digits[bits >> 12 & 63];
        *out++ = (char)(left > 1 ? digits[bits >> 6 & 63] : '=');
        *out++ = (char)(left > 2 ? digits[bits & 63] : '=');
    }
    *out = 0;
    return uri;
}

ppm_status gltf_import_primitive(gltf_fixture *f, const char *primitive, const char *accessors,
                                 const char *views, const void *bytes, size_t count)
{
    return gltf_importf(f,
                        "{" GLTF_HEAD "'nodes':[{'mesh':0}],'meshes':[{'primitives':[{%s}]}],"
                        "'accessors':[%s],'bufferViews':[%s],"
                        "'buffers':[{'byteLength':%zu,'uri':'%s'}]}",
                        primitive, accessors, views, count, gltf_data_uri(bytes, count));
}

int gltf_logged(const gltf_fixture *f, char level, const char *text)
{
    for (const char *line = f->log; *line;) {
        const char *end = strchr(line, '\n');
        const char *hit = strstr(line, text);
        if (line[0] == level && hit && hit < end) return 1;
        line = end + 1;
    }
    return 0;
}
