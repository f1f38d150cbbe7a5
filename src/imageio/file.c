/* Whole files. A replaced file is never seen half-written: the new one is complete and on the disk
 * before it takes the name (rename in one folder is atomic, POSIX.1-2017). */
#include "imageio/file.h"

#include <errno.h>
#include <fcntl.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

/* ---- reading --------------------------------------------------------------------------------- */

static ppm_status read_all(ppm_context *context, int descriptor, const char *name, char *bytes,
                           size_t byte_count)
{
    size_t done = 0;
    while (done < byte_count) {
        const ssize_t got = read(descriptor, bytes + done, byte_count - done);
        if (got < 0 && errno == EINTR) continue;
        if (got < 0) {
            return ppmi_fail(context, PPM_STATUS_INPUT_INVALID, "%s: cannot be read: %s", name,
                             strerror(errno));
        }
        if (got == 0) {
            return ppmi_fail(context, PPM_STATUS_INPUT_INVALID,
                             "%s: the file became shorter while it was read", name);
        }
        done += (size_t)got;
    }
    return PPM_STATUS_OK;
}

static ppm_status read_opened(ppm_context *context, int descriptor, const char *name,
                              void **out_bytes, size_t *out_byte_count)
{
    struct stat facts;
    if (fstat(descriptor, &facts) != 0 || !S_ISREG(facts.st_mode)) {
        return ppmi_fail(context, PPM_STATUS_INPUT_INVALID, "%s: not a regular file", name);
    }
    if (facts.st_size == 0) {
        return ppmi_fail(context, PPM_STATUS_INPUT_INVALID, "%s: the file is empty", name);
    }
    const size_t byte_count = (size_t)facts.st_size;
    char *const bytes = ppmi_alloc(context, byte_count, 1);
    if (!bytes) {
        return ppmi_fail(context, PPM_STATUS_OUT_OF_MEMORY, "%s: no memory for its %zu bytes", name,
                         byte_count);
    }
    const ppm_status status = read_all(context, descriptor, name, bytes, byte_count);
    if (status != PPM_STATUS_OK) {
        ppmi_free(context, bytes);
        return status;
    }
    *out_bytes = bytes;
    *out_byte_count = byte_count;
    return PPM_STATUS_OK;
}

ppm_status ppmi_imageio_file_read(ppm_context *context, const char *path, const char *name,
                                  void **out_bytes, size_t *out_byte_count)
{
    /* without O_NONBLOCK a pipe of that name would wait for a writer */
    const int descriptor = open(path, O_RDONLY | O_CLOEXEC | O_NONBLOCK);
    if (descriptor < 0) {
        return ppmi_fail(context, PPM_STATUS_INPUT_NOT_FOUND, "%s: cannot be opened: %s", name,
                         strerror(errno));
    }
    const ppm_status status = read_opened(context, descriptor, name, out_bytes, out_byte_count);
    close(descriptor);
    return status;
}

/* ---- replacing ------------------------------------------------------------------------------- */

/* A file that is being replaced. */
struct ppmi_file_replacement {
    char *path;      /* as it was given */
    char *target;    /* where it goes: the path with symbolic links followed */
    char *temporary; /* beside target */
    int descriptor;  /* of temporary */
};
typedef ppmi_file_replacement replacement;

static ppm_status fail_output(ppm_context *context, const char *path, const char *reason)
{
    return ppmi_fail(context, PPM_STATUS_OUTPUT_NOT_WRITABLE, "%s: cannot be written: %s", path,
                     reason);
}

/* Makes *path, of PATH_ROOM bytes, what the symbolic link there says. False when it is no link. */
enum { PATH_ROOM = 4096, LINKS_MAX = 40 };
static bool follow_link(char *path)
{
    char text[PATH_ROOM];
    const ssize_t length = readlink(path, text, sizeof text - 1);
    if (length <= 0) return false;
    text[length] = 0;
    const char *const slash = strrchr(path, '/');
    const size_t folder = slash && text[0] != '/' ? (size_t)(slash + 1 - path) : 0;
    if (folder + (size_t)length >= PATH_ROOM) return false;
    memcpy(path + folder, text, (size_t)length + 1);
    return true;
}

/* Where a path leads whose file is not there: behind links that wait for one. */
static char *find_missing(ppm_context *context, const char *path)
{
    char at[PATH_ROOM];
    if (strlen(path) >= sizeof at) return ppmi_string_copy(context, path);
    strcpy(at, path);
    for (int i = 0; i < LINKS_MAX && follow_link(at); i++) {
    }
    return ppmi_string_copy(context, at);
}

static ppm_status find_existing(ppm_context *context, const char *path, const struct stat *facts,
                                char **out_target)
{
    const mode_t writable = S_IWUSR | S_IWGRP | S_IWOTH;
    if (!S_ISREG(facts->st_mode)) return fail_output(context, path, "not a regular file");
    if (!(facts->st_mode & writable)) return fail_output(context, path, "the file is read-only");
    if (access(path, W_OK) != 0) return fail_output(context, path, strerror(errno));
    char *const resolved = realpath(path, NULL);
    if (!resolved) return fail_output(context, path, strerror(errno));
    *out_target = ppmi_string_copy(context, resolved);
    free(resolved);
    return PPM_STATUS_OK;
}

/* path itself, or what it links to; *out_mode is that of an existing file. One that may not be
 * written is not replaced either, though its folder would allow it. */
static ppm_status find_target(ppm_context *context, const char *path, char **out_target,
                              mode_t *out_mode)
{
    struct stat facts;
    if (stat(path, &facts) == 0) {
        const ppm_status status = find_existing(context, path, &facts, out_target);
        if (status != PPM_STATUS_OK) return status;
        *out_mode = facts.st_mode & 0777;
    } else if (errno == ENOENT) {
        *out_target = find_missing(context, path);
    } else {
        return fail_output(context, path, strerror(errno));
    }
    if (*out_target) return PPM_STATUS_OK;
    return ppmi_fail(context, PPM_STATUS_OUT_OF_MEMORY, "%s: no memory to write it", path);
}

/* Creates a new file beside target. Its name begins with a dot and ends in .tmp: a file browser
 * hides it and nobody takes it for a picture. */
static ppm_status create_temporary(ppm_context *context, const char *path, replacement *file)
{
    enum { ATTEMPTS = 1000, NAME_PART = 100, SUFFIX_SIZE = 64 };
    const char *const slash = strrchr(file->target, '/');
    const int folder_length = slash ? (int)(slash + 1 - file->target) : 0;
    const size_t size = (size_t)folder_length + NAME_PART + SUFFIX_SIZE;
    file->temporary = ppmi_alloc(context, size, 1);
    if (!file->temporary) {
        return ppmi_fail(context, PPM_STATUS_OUT_OF_MEMORY, "%s: no memory to write it", path);
    }
    for (int attempt = 0; attempt < ATTEMPTS; attempt++) {
        snprintf(file->temporary, size, "%.*s.%.*s.%ld.%d.tmp", folder_length, file->target,
                 NAME_PART, file->target + folder_length, (long)getpid(), attempt);
        file->descriptor = open(file->temporary, O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0666);
        if (file->descriptor >= 0) return PPM_STATUS_OK;
        if (errno != EEXIST) break;
    }
    return fail_output(context, path, strerror(errno));
}

static ppm_status replacement_begin(ppm_context *context, const char *path, replacement *file)
{
    *file = (replacement){.descriptor = -1};
    mode_t mode = 0;
    file->path = ppmi_string_copy(context, path);
    ppm_status status = PPM_STATUS_OK;
    if (!file->path) {
        status = ppmi_fail(context, PPM_STATUS_OUT_OF_MEMORY, "%s: no memory to write it", path);
    }
    if (status == PPM_STATUS_OK) status = find_target(context, path, &file->target, &mode);
    if (status == PPM_STATUS_OK) status = create_temporary(context, path, file);
    /* a replaced file keeps its permissions; a file system without them is no reason to fail */
    if (status == PPM_STATUS_OK && mode != 0) (void)fchmod(file->descriptor, mode);
    return status;
}

/* Flushes and closes; some file systems report a full disk only here. */
static ppm_status finish_temporary(ppm_context *context, const char *path, replacement *file)
{
    /* EINVAL: the file system has nothing to flush */
    const bool is_flushed = fsync(file->descriptor) == 0 || errno == EINVAL;
    const int flush_error = errno;
    const bool is_closed = close(file->descriptor) == 0;
    file->descriptor = -1;
    if (!is_flushed) return fail_output(context, path, strerror(flush_error));
    if (!is_closed) return fail_output(context, path, strerror(errno));
    return PPM_STATUS_OK;
}

/* Frees; the temporary file itself stays. */
static void replacement_end(ppm_context *context, replacement *file)
{
    if (file->descriptor >= 0) close(file->descriptor);
    ppmi_free(context, file->temporary);
    ppmi_free(context, file->target);
    ppmi_free(context, file->path);
}

ppm_status ppmi_imageio_file_begin(ppm_context *context, const char *path,
                                   ppmi_file_replacement **out_replacement)
{
    replacement *const file = ppmi_alloc_zeroed(context, 1, sizeof *file);
    if (!file) {
        return ppmi_fail(context, PPM_STATUS_OUT_OF_MEMORY, "%s: no memory to write it", path);
    }
    const ppm_status status = replacement_begin(context, path, file);
    if (status == PPM_STATUS_OK) {
        *out_replacement = file;
    } else {
        replacement_end(context, file);
        ppmi_free(context, file);
    }
    return status;
}

int ppmi_imageio_file_write_at(const ppmi_file_replacement *file, const void *bytes,
                               size_t byte_count, uint64_t offset)
{
    const char *const all = bytes;
    size_t done = 0;
    while (done < byte_count) {
        const ssize_t written = pwrite(file->descriptor, all + done, byte_count - done,
                                       (off_t)(offset + (uint64_t)done));
        if (written < 0 && errno == EINTR) continue;
        if (written < 0) return errno;
        if (written == 0) return ENOSPC;
        done += (size_t)written;
    }
    return 0;
}

const char *ppmi_imageio_file_temporary(const ppmi_file_replacement *file)
{
    return file->temporary;
}

void ppmi_imageio_file_cancel(ppm_context *context, ppmi_file_replacement *file)
{
    unlink(file->temporary);
    replacement_end(context, file);
    ppmi_free(context, file);
}

ppm_status ppmi_imageio_file_finish(ppm_context *context, ppmi_file_replacement *file)
{
    ppm_status status = finish_temporary(context, file->path, file);
    if (status == PPM_STATUS_OK && rename(file->temporary, file->target) != 0) {
        status = fail_output(context, file->path, strerror(errno));
    }
    if (status != PPM_STATUS_OK) {
        ppmi_imageio_file_cancel(context, file);
        return status;
    }
    replacement_end(context, file);
    ppmi_free(context, file);
    return PPM_STATUS_OK;
}

ppm_status ppmi_imageio_file_replace(ppm_context *context, const char *path, const void *bytes,
                                     size_t byte_count)
{
    replacement *file = NULL;
    const ppm_status status = ppmi_imageio_file_begin(context, path, &file);
    if (status != PPM_STATUS_OK) return status;
    const int fault = ppmi_imageio_file_write_at(file, bytes, byte_count, 0);
    if (fault == 0) return ppmi_imageio_file_finish(context, file);
    ppmi_imageio_file_cancel(context, file);
    return fail_output(context, path, strerror(fault));
}

ppm_status ppmi_imageio_file_check(ppm_context *context, const char *path)
{
    replacement file;
    const ppm_status status = replacement_begin(context, path, &file);
    if (status == PPM_STATUS_OK) unlink(file.temporary);
    replacement_end(context, &file);
    return status;
}
