/* Context, reporting and memory. */
#include "base/context.h"
#include "base/printable.h"

#include <malloc.h>
#include <pthread.h>
#include <stdatomic.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

enum { MESSAGE_SIZE = 2048 };

/* A message of a fork. */
typedef struct waiting_message {
    struct waiting_message *next;
    ppm_log_level level;
    char text[];
} waiting_message;

struct ppm_context {
    ppm_log_fn log;
    void *log_user;
    pthread_mutex_t lock; /* guards the log callback and last_error */
    char last_error[MESSAGE_SIZE];
    atomic_size_t live_blocks;
    atomic_size_t live_bytes;
    size_t most_bytes; /* live_bytes stays below */
    atomic_size_t fail_countdown;
    ppm_context *parent; /* of a fork, whose memory it uses; else NULL */
    waiting_message *first, *last;
};

/* What the process may reasonably hold: the machine's memory, or the limit of its control group.
 * Linux promises more than there is and ends the process when the promise is called in; an error
 * that can be read is better. */
static size_t memory_of_machine(void)
{
    const long pages = sysconf(_SC_PHYS_PAGES), page_size = sysconf(_SC_PAGE_SIZE);
    size_t bytes = pages > 0 && page_size > 0 ? (size_t)pages * (size_t)page_size : SIZE_MAX;
    FILE *file = fopen("/sys/fs/cgroup/memory.max", "re");
    if (file) {
        unsigned long long limit;
        if (fscanf(file, "%llu", &limit) == 1 && limit > 0 && limit < bytes) bytes = (size_t)limit;
        fclose(file);
    }
    return bytes;
}

ppm_status ppm_context_create(const ppm_context_desc *desc, ppm_context **out_context)
{
    if (!out_context || (desc && desc->size < sizeof(ppm_context_desc))) {
        return PPM_STATUS_INVALID_ARGUMENT;
    }
    ppm_context *context = calloc(1, sizeof *context);
    if (!context) return PPM_STATUS_OUT_OF_MEMORY;
    if (pthread_mutex_init(&context->lock, NULL) != 0) {
        free(context);
        return PPM_STATUS_OUT_OF_MEMORY;
    }
    context->most_bytes = memory_of_machine();
    if (desc) {
        context->log = desc->log;
        context->log_user = desc->log_user;
    }
    *out_context = context;
    return PPM_STATUS_OK;
}

void ppm_context_destroy(ppm_context *context)
{
    if (!context) return;
    pthread_mutex_destroy(&context->lock);
    free(context);
}

size_t ppm_context_last_error(ppm_context *context, char *buffer, size_t buffer_size)
{
    if (!context) return 0;
    pthread_mutex_lock(&context->lock);
    const size_t length = strlen(context->last_error);
    if (buffer && buffer_size > 0) {
        const size_t copied = length < buffer_size - 1 ? length : buffer_size - 1;
        memcpy(buffer, context->last_error, copied);
        buffer[copied] = '\0';
    }
    pthread_mutex_unlock(&context->lock);
    return length;
}

/* A fork's message waits. One that there is no memory for comes at once. */
static bool wait_with(ppm_context *fork, ppm_log_level level, const char *text)
{
    const size_t bytes = strlen(text) + 1;
    waiting_message *message = malloc(sizeof *message + bytes);
    if (!message) return false;
    message->next = NULL;
    message->level = level;
    memcpy(message->text, text, bytes);
    *(fork->last ? &fork->last->next : &fork->first) = message;
    fork->last = message;
    return true;
}

/* Names and what libraries say of files come from strangers. */
static void escape_controls(char message[MESSAGE_SIZE])
{
    char shown[MESSAGE_SIZE];
    ppmi_printable(message, shown, sizeof shown);
    memcpy(message, shown, strlen(shown) + 1);
}

static void deliver(ppm_context *context, ppm_log_level level, const char *message)
{
    if (context->parent) {
        if (wait_with(context, level, message)) return;
        context = context->parent;
    }
    pthread_mutex_lock(&context->lock);
    if (level == PPM_LOG_ERROR) {
        snprintf(context->last_error, sizeof context->last_error, "%s", message);
    }
    if (context->log) context->log(context->log_user, level, message);
    pthread_mutex_unlock(&context->lock);
}

void ppmi_log(ppm_context *context, ppm_log_level level, const char *format, ...)
{
    if (!context) return;
    char message[MESSAGE_SIZE];
    va_list arguments;
    va_start(arguments, format);
    vsnprintf(message, sizeof message, format, arguments);
    va_end(arguments);
    escape_controls(message);
    deliver(context, level, message);
}

ppm_status ppmi_fail(ppm_context *context, ppm_status status, const char *format, ...)
{
    if (!context) return status;
    char message[MESSAGE_SIZE];
    va_list arguments;
    va_start(arguments, format);
    vsnprintf(message, sizeof message, format, arguments);
    va_end(arguments);
    escape_controls(message);
    deliver(context, PPM_LOG_ERROR, message);
    return status;
}

ppm_context *ppmi_context_fork(ppm_context *parent)
{
    ppm_context *fork = NULL;
    const ppm_context_desc desc = {.size = sizeof desc};
    if (ppm_context_create(&desc, &fork) != PPM_STATUS_OK) return NULL;
    fork->parent = parent->parent ? parent->parent : parent;
    return fork;
}

static void join(ppm_context *fork, ppm_log_level worst)
{
    if (!fork) return;
    while (fork->first) {
        waiting_message *const message = fork->first;
        deliver(fork->parent, message->level < worst ? worst : message->level, message->text);
        fork->first = message->next;
        free(message);
    }
    ppm_context_destroy(fork);
}

void ppmi_context_join(ppm_context *fork)
{
    join(fork, PPM_LOG_ERROR);
}

void ppmi_context_join_as_warnings(ppm_context *fork)
{
    join(fork, PPM_LOG_WARNING);
}

/* Who keeps the books of memory. */
static ppm_context *bookkeeper(ppm_context *context)
{
    return context && context->parent ? context->parent : context;
}

static bool fault_is_due(ppm_context *context)
{
    if (!context || atomic_load_explicit(&context->fail_countdown, memory_order_relaxed) == 0) {
        return false;
    }
    return atomic_fetch_sub(&context->fail_countdown, 1) == 1;
}

/* Books bytes against the limit; false beyond it. */
static bool book(ppm_context *context, size_t bytes)
{
    const size_t before = atomic_fetch_add(&context->live_bytes, bytes);
    if (bytes <= context->most_bytes && before <= context->most_bytes - bytes) {
        atomic_fetch_add(&context->live_blocks, 1);
        return true;
    }
    atomic_fetch_sub(&context->live_bytes, bytes);
    return false;
}

static void unbook(ppm_context *context, size_t bytes)
{
    atomic_fetch_sub(&context->live_bytes, bytes);
    atomic_fetch_sub(&context->live_blocks, 1);
}

void *ppmi_alloc(ppm_context *context, size_t count, size_t element_size)
{
    enum { ALIGNMENT = 64 };
    if (count == 0 || element_size == 0) return NULL;
    context = bookkeeper(context);
    if (count > (SIZE_MAX - ALIGNMENT) / element_size || fault_is_due(context)) return NULL;
    /* aligned_alloc wants a multiple of the alignment */
    const size_t bytes = (count * element_size + ALIGNMENT - 1) / ALIGNMENT * ALIGNMENT;
    if (context && !book(context, bytes)) return NULL;
    void *memory = aligned_alloc(ALIGNMENT, bytes);
    if (!context) return memory;
    if (!memory) {
        unbook(context, bytes);
        return NULL;
    }
    /* blocks are booked by their real size: that is what can be asked for when they are freed */
    atomic_fetch_add(&context->live_bytes, malloc_usable_size(memory) - bytes);
    return memory;
}

void *ppmi_alloc_zeroed(ppm_context *context, size_t count, size_t element_size)
{
    void *memory = ppmi_alloc(context, count, element_size);
    if (memory) memset(memory, 0, count * element_size);
    return memory;
}

void ppmi_free(ppm_context *context, void *memory)
{
    if (!memory) return;
    context = bookkeeper(context);
    if (context) unbook(context, malloc_usable_size(memory));
    free(memory);
}

char *ppmi_string_copy(ppm_context *context, const char *text)
{
    if (!text) return NULL;
    const size_t bytes = strlen(text) + 1;
    char *copy = ppmi_alloc(context, bytes, 1);
    if (copy) memcpy(copy, text, bytes);
    return copy;
}

void ppmi_alloc_fail_at(ppm_context *context, size_t n)
{
    atomic_store(&context->fail_countdown, n);
}

size_t ppmi_alloc_live(const ppm_context *context)
{
    return atomic_load(&context->live_blocks);
}
