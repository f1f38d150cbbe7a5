/* Imports every OBJ of the development assets: nothing crashes, and what is sound is read. Skipped
 * where they are absent. */
#include <dirent.h>
#include <stdio.h>
#include <string.h>
#include <strings.h>
#include <sys/stat.h>

#include "obj_fixture.h"

enum { MAX_PATH = 512 };

typedef void (*visit_fn)(obj_fixture *f, const char *path);

/* Calls visit for every OBJ below a folder of the assets. Returns how many there were. */
static size_t visit_all(obj_fixture *f, const char *folder, visit_fn visit)
{
    char path[MAX_PATH];
    size_t count = 0;
    DIR *directory = opendir(folder);
    assert_non_null(directory);
    for (const struct dirent *entry; (entry = readdir(directory));) {
        struct stat info;
        const char *dot = strrchr(entry->d_name, '.');
        if (entry->d_name[0] == '.') continue;
        assert_true((size_t)snprintf(path, sizeof path, "%s/%s", folder, entry->d_name) <
                    sizeof path);
        if (stat(path, &info) != 0) continue;
        if (S_ISDIR(info.st_mode)) {
            count += visit_all(f, path, visit);
        } else if (dot && strcasecmp(dot, ".obj") == 0) {
            obj_reset(f);
            visit(f, path);
            ++count;
        }
    }
    closedir(directory);
    return count;
}

static void import_broken(obj_fixture *f, const char *path)
{
    const ppm_status status = ppmi_obj_import(f->context, f->scene, path, &f->options);
    const bool is_known = status == PPM_STATUS_OK || status == PPM_STATUS_INPUT_INVALID ||
                          status == PPM_STATUS_INPUT_UNSUPPORTED;
    if (!is_known) fail_msg("%s: %s\n%s", path, ppm_status_name(status), f->log);
    if (status != PPM_STATUS_OK && !obj_logged(f, 'E', path)) {
        fail_msg("%s: no error names it\n%s", path, f->log);
    }
}

static bool ends_with(const char *path, const char *end)
{
    const size_t length = strlen(path), count = strlen(end);
    return length >= count && strcmp(path + length - count, end) == 0;
}

/* A broken one, and one of lines only, lie among the sound ones. */
static void import_sound(obj_fixture *f, const char *path)
{
    const ppm_status status = ppmi_obj_import(f->context, f->scene, path, &f->options);
    if (ends_with(path, "box-incomplete-positions.obj")) {
        assert_obj_status(f, status, PPM_STATUS_INPUT_INVALID);
        return;
    }
    if (status != PPM_STATUS_OK) fail_msg("%s: %s\n%s", path, ppm_status_name(status), f->log);
    ppm_scene_info info = {.size = sizeof info};
    assert_int_equal(ppm_scene_get_info(f->scene, &info), PPM_STATUS_OK);
    if (info.triangles == 0 && !ends_with(path, "line-prim.obj"))
        fail_msg("%s: no triangles\n%s", path, f->log);
    if (obj_logged(f, 'W', "split as well as possible")) fail_msg("%s\n%s", path, f->log);
}

static void broken_files_end_in_a_status_and_a_message(void **state)
{
    assert_true(visit_all(*state, PPM_ASSETS_DIR "/bad/obj", import_broken) > 5);
}

static void sound_files_are_read(void **state)
{
    assert_true(visit_all(*state, PPM_ASSETS_DIR "/obj", import_sound) > 40);
}

int main(void)
{
    struct stat info;
    if (stat(PPM_ASSETS_DIR "/obj", &info) != 0) {
        printf("skipped: no development assets at %s\n", PPM_ASSETS_DIR);
        return 77;
    }
    const struct CMUnitTest tests[] = {
        cmocka_unit_test_setup_teardown(broken_files_end_in_a_status_and_a_message, obj_setup,
                                        obj_teardown),
        cmocka_unit_test_setup_teardown(sound_files_are_read, obj_setup, obj_teardown),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
