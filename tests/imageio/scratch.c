#include "imageio/scratch.h"

#include <dirent.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cmocka.h>

enum { PATH_SIZE = 1024, PATH_COUNT = 8 };

static char folder[PATH_SIZE / 2];

const char *scratch_create(void)
{
    const char *const base = getenv("TMPDIR");
    snprintf(folder, sizeof folder, "%s/ppm-test-XXXXXX", base && *base ? base : "/tmp");
    assert_non_null(mkdtemp(folder));
    assert_int_equal(chmod(folder, 0755), 0);
    return folder;
}

const char *scratch_path(const char *name)
{
    static char paths[PATH_COUNT][PATH_SIZE];
    static int next;
    char *const path = paths[next++ % PATH_COUNT];
    snprintf(path, PATH_SIZE, "%s/%s", folder, name);
    return path;
}

void scratch_write(const char *name, const void *bytes, size_t byte_count)
{
    FILE *const file = fopen(scratch_path(name), "wb");
    assert_non_null(file);
    assert_int_equal(fwrite(bytes, 1, byte_count, file), byte_count);
    assert_int_equal(fclose(file), 0);
}

void scratch_write_text(const char *name, const char *text)
{
    scratch_write(name, text, strlen(text));
}

/* Calls remove_each on the files, or only counts them. */
static int visit(int (*remove_each)(const char *path))
{
    DIR *const entries = opendir(folder);
    assert_non_null(entries);
    int count = 0;
    for (const struct dirent *entry; (entry = readdir(entries)) != NULL;) {
        if (strcmp(entry->d_name, ".") == 0 || strcmp(entry->d_name, "..") == 0) continue;
        count++;
        if (remove_each) remove_each(scratch_path(entry->d_name));
    }
    closedir(entries);
    return count;
}

int scratch_count(void)
{
    return visit(NULL);
}

void scratch_remove(void)
{
    visit(remove);
    rmdir(folder);
}
