/* Processes for the tests of the program. */
#include "cli/program.h"

#include <ftw.h>
#include <poll.h>
#include <setjmp.h>
#include <signal.h>
#include <stdarg.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cmocka.h>

#include "cli/tiny_scene.h"

/* Nothing here takes longer, even under sanitizers on a busy machine. */
enum { PATIENCE_MS = 300000 };

static char folder[] = "ppm-cli-test-XXXXXX";

int folder_setup(void **state)
{
    (void)state;
    if (!mkdtemp(folder) || chdir(folder) != 0) return -1;
    return tiny_scene_write("tiny.gltf") ? 0 : -1;
}

static int remove_entry(const char *path, const struct stat *info, int kind, struct FTW *place)
{
    (void)info;
    (void)kind;
    (void)place;
    return remove(path);
}

int folder_teardown(void **state)
{
    (void)state;
    if (chdir("..") != 0) return -1;
    return nftw(folder, remove_entry, 16, FTW_DEPTH | FTW_PHYS);
}

static int status_of(int wait_status)
{
    return WIFEXITED(wait_status) ? WEXITSTATUS(wait_status) : 1000 + WTERMSIG(wait_status);
}

static size_t read_file(const char *path, char *buffer, size_t buffer_size)
{
    FILE *const file = fopen(path, "r");
    assert_non_null(file);
    const size_t length = fread(buffer, 1, buffer_size - 1, file);
    buffer[length] = '\0';
    fclose(file);
    return length;
}

outcome run_program(const char *arguments)
{
    static outcome result;
    char command[4096];
    snprintf(command, sizeof command, "'%s' >.out 2>.err </dev/null %s", PPM_RENDER_PROGRAM,
             arguments);
    result.status = status_of(system(command));
    read_file(".out", result.out, sizeof result.out);
    read_file(".err", result.err, sizeof result.err);
    return result;
}

/* "exec" makes the program take the place of the shell, so that signals reach it. */
void start_wrapped_program(test_process *process, const char *before, const char *arguments)
{
    memset(process, 0, sizeof *process);
    char command[4096];
    snprintf(command, sizeof command, "%s exec '%s' %s", before, PPM_RENDER_PROGRAM, arguments);
    int ends[2];
    assert_int_equal(pipe(ends), 0);
    process->pid = fork();
    assert_true(process->pid >= 0);
    if (process->pid == 0) {
        dup2(ends[1], STDERR_FILENO);
        close(ends[0]);
        close(ends[1]);
        execl("/bin/sh", "sh", "-c", command, (char *)NULL);
        _exit(126);
    }
    close(ends[1]);
    process->err_fd = ends[0];
}

void start_program(test_process *process, const char *arguments)
{
    start_wrapped_program(process, "", arguments);
}

/* Takes what is there, waiting for it. Returns 0 at the end of the stream. */
static size_t take_some(test_process *process)
{
    struct pollfd watched = {.fd = process->err_fd, .events = POLLIN};
    const int ready = poll(&watched, 1, PATIENCE_MS);
    if (ready <= 0) fail_msg("nothing for too long after:\n%s", process->err);
    const size_t room = sizeof process->err - 1 - process->err_length;
    const ssize_t length = read(process->err_fd, process->err + process->err_length, room);
    if (length <= 0) return 0;
    process->err_length += (size_t)length;
    process->err[process->err_length] = '\0';
    return (size_t)length;
}

void wait_for_text(test_process *process, const char *text)
{
    while (!strstr(process->err, text)) {
        if (take_some(process) == 0) fail_msg("no '%s' in:\n%s", text, process->err);
    }
}

bool has_ended(const test_process *process)
{
    siginfo_t info = {0};
    const int flags = WEXITED | WNOHANG | WNOWAIT;
    return waitid(P_PID, (id_t)process->pid, &info, flags) != 0 || info.si_pid == process->pid;
}

int wait_for_end(test_process *process)
{
    while (take_some(process) > 0)
        continue;
    close(process->err_fd);
    int wait_status = 0;
    assert_int_equal(waitpid(process->pid, &wait_status, 0), process->pid);
    return status_of(wait_status);
}

void assert_contains(const char *text, const char *part)
{
    if (!strstr(text, part)) fail_msg("no '%s' in:\n%s", part, text);
}
