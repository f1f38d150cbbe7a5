/* The handler may run on any thread. It only touches lock-free atomics and calls write, _exit and
 * ppm_render_cancel, all of which are allowed there. */
#include "signals.h"

#include <errno.h>
#include <sched.h>
#include <signal.h>
#include <stdatomic.h>
#include <stddef.h>
#include <string.h>
#include <unistd.h>

#include "options.h"

enum { STEP_STARTING, STEP_FIRST_PASS, STEP_PASSES, STEP_BETWEEN, STEP_ENDING };

/* A handler can be reached only through globals. */
static _Atomic(ppm_render *) watched_render;
static atomic_int step;
static atomic_int signal_count;
static atomic_int handlers_running;

static void say(const char *text)
{
    const ssize_t written = write(STDERR_FILENO, text, strlen(text));
    (void)written; /* nobody is left to tell */
}

/* Ctrl-C lets the first pass finish, for something to look at. Who sends the others, a batch system
 * or a shell that closes, ends the program soon in any case. */
static void stop_first_pass(int number)
{
    if (number == SIGINT) {
        say("\nppm-render: stopping after the first pass; once more to end at once\n");
    } else {
        ppm_render_cancel(atomic_load(&watched_render));
    }
}

static void stop(int number)
{
    if (atomic_fetch_add(&signal_count, 1) > 0) _exit(EXIT_SIGNAL);
    switch (atomic_load(&step)) {
    case STEP_STARTING:
        say("\nppm-render: stopped before the first pass; there is no picture\n");
        _exit(EXIT_SIGNAL);
    case STEP_FIRST_PASS:
        stop_first_pass(number);
        break;
    case STEP_BETWEEN:
        say("\nppm-render: stopped between two pictures; those before are complete\n");
        _exit(EXIT_SIGNAL);
    case STEP_PASSES:
        ppm_render_cancel(atomic_load(&watched_render));
        break;
    }
}

static void on_signal(int number)
{
    const int saved_errno = errno;
    atomic_fetch_add(&handlers_running, 1);
    if (atomic_load(&step) != STEP_ENDING) stop(number);
    atomic_fetch_sub(&handlers_running, 1);
    errno = saved_errno;
}

void signals_install(void)
{
    struct sigaction action;
    memset(&action, 0, sizeof action);
    action.sa_handler = on_signal;
    action.sa_flags = SA_RESTART;
    sigemptyset(&action.sa_mask);
    sigaction(SIGINT, &action, NULL);
    sigaction(SIGTERM, &action, NULL);
    struct sigaction hangup; /* nohup's programs do not hear it */
    if (sigaction(SIGHUP, NULL, &hangup) == 0 && hangup.sa_handler != SIG_IGN) {
        sigaction(SIGHUP, &action, NULL);
    }
    /* A reader of the messages that goes away must not take the render with it. */
    action.sa_handler = SIG_IGN;
    sigaction(SIGPIPE, &action, NULL);
    sigaction(SIGXFSZ, &action, NULL); /* a file that grows too large is an error to be told */
}

void signals_enter_first_pass(ppm_render *render)
{
    atomic_store(&watched_render, render);
    atomic_store(&step, STEP_FIRST_PASS);
}

void signals_enter_passes(ppm_render *render)
{
    atomic_store(&watched_render, render);
    atomic_store(&step, STEP_PASSES);
}

/* A handler that began before may still hold the render, on another thread. */
static void leave_for(int next)
{
    atomic_store(&step, next);
    while (atomic_load(&handlers_running) > 0)
        sched_yield();
}

void signals_leave_picture(void)
{
    leave_for(STEP_BETWEEN);
}

void signals_leave_render(void)
{
    leave_for(STEP_ENDING);
}

bool signals_stop_requested(void)
{
    return atomic_load(&signal_count) > 0;
}
