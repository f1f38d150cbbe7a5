/* Every image of the development assets is read or refused, whatever is wrong with it. */
#include <dirent.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <string.h>
#include <sys/stat.h>

#include <cmocka.h>

#include "imageio/imageio.h"

typedef struct tally {
    int ok, refused;
} tally;

static void read_one(ppm_context *context, const char *path, tally *counts)
{
    ppmi_pixels pixels = {0};
    const ppm_status status = ppmi_imageio_read_file(context, path, path, &pixels);
    if (status != PPM_STATUS_OK) {
        counts->refused++;
        assert_null(pixels.u8);
        assert_null(pixels.f32);
        return;
    }
    counts->ok++;
    assert_in_range(pixels.channels, 1, 4);
    assert_int_equal(pixels.u8 == NULL, pixels.f32 != NULL);
    ppmi_imageio_pixels_free(context, &pixels);
}

static void read_folder(ppm_context *context, const char *folder, tally *counts)
{
    DIR *const entries = opendir(folder);
    assert_non_null(entries);
    for (const struct dirent *entry; (entry = readdir(entries)) != NULL;) {
        if (entry->d_name[0] == '.') continue;
        char path[1024];
        snprintf(path, sizeof path, "%s/%s", folder, entry->d_name);
        struct stat facts;
        assert_int_equal(stat(path, &facts), 0);
        if (S_ISDIR(facts.st_mode)) {
            read_folder(context, path, counts);
        } else {
            read_one(context, path, counts);
        }
    }
    closedir(entries);
}

static tally read_tree(const char *folder)
{
    struct stat facts;
    if (stat(folder, &facts) != 0) {
        print_message("skipped: %s is not here\n", folder);
        skip();
    }
    ppm_context *context = NULL;
    assert_int_equal(ppm_context_create(NULL, &context), PPM_STATUS_OK);
    tally counts = {0, 0};
    read_folder(context, folder, &counts);
    assert_int_equal(ppmi_alloc_live(context), 0);
    ppm_context_destroy(context);
    return counts;
}

static void good_images_are_read(void **state)
{
    (void)state;
    const tally counts = read_tree(PPM_ASSETS_DIR "/images");
    assert_true(counts.ok > 0);
    assert_int_equal(counts.refused, 1); /* KTX2 */
}

static void bad_images_do_no_harm(void **state)
{
    (void)state;
    const tally counts = read_tree(PPM_ASSETS_DIR "/bad/images");
    /* two OpenEXR files only have a wrong type attribute; in one with a displaced data window the
     * header claims more bytes than the file has */
    assert_int_equal(counts.ok, 2);
    assert_true(counts.refused > 0);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(good_images_are_read),
        cmocka_unit_test(bad_images_do_no_harm),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
