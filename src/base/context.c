/* Context, reporting and memory. */
#include "base/context.h"

#include <pthread.h>
#include <stdatomic.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { MESSAGE_SIZE = 2048 };

struct ppm_context {
    ppm_log_fn log;
    void *log_user;
    pthread_mutex_t lock; /* guards the log callback and last_error */
    char last_error[MESSAGE_SIZE];
    atomic_size_t live_blocks;
    atomic_size_t fail_countdown;
};

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

static void deliver(ppm_context *context, ppm_log_level level, const char *message)
{
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
    deliver(context, PPM_LOG_ERROR, message);
    return status;
}

static bool fault_is_due(ppm_context *context)
{
    if (!context || atomic_load_explicit(&context->fail_countdown, memory_order_relaxed) == 0) {
        return false;
    }
    return atomic_fetch_sub(&context->fail_countdown, 1) == 1;
}

void *ppmi_alloc(ppm_context *context, size_t count, size_t element_size)
{
    enum { ALIGNMENT = 64 };
    if (count == 0 || element_size == 0) return NULL;
    if (count > (SIZE_MAX - ALIGNMENT) / element_size || fault_is_due(context)) return NULL;
    /* aligned_alloc wants a multiple of the alignment */
    const size_t bytes = (count * element_size + ALIGNMENT - 1) / ALIGNMENT * ALIGNMENT;
    void *memory = aligned_alloc(ALIGNMENT, bytes);
    if (memory && context) atomic_fetch_add(&context->live_blocks, 1);
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
    if (context) atomic_fetch_sub(&context->live_blocks, 1);
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
