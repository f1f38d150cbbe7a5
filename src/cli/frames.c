/* Frames are whole numbers; time is frame / fps. */
#include "frames.h"

#include <stdlib.h>

/* Reads a whole number with or without '-' and moves *cursor behind it. */
static bool take_frame(const char **cursor, int32_t *out_frame)
{
    enum { DIGITS_MOST = 8 };
    const char *at = *cursor;
    const bool is_negative = *at == '-';
    if (is_negative) at++;
    const char *const digits = at;
    while (*at >= '0' && *at <= '9')
        at++;
    if (at == digits || at - digits > DIGITS_MOST) return false;
    const long value = strtol(digits, NULL, 10);
    if (value > FRAME_MOST) return false;
    *out_frame = (int32_t)(is_negative ? -value : value);
    *cursor = at;
    return true;
}

bool frames_parse_one(const char *text, int32_t *out_frame)
{
    int32_t frame = 0;
    if (!take_frame(&text, &frame) || *text != '\0') return false;
    *out_frame = frame;
    return true;
}

static bool take_step(const char **cursor, int32_t *out_step)
{
    if (**cursor != '/') return true;
    ++*cursor;
    return take_frame(cursor, out_step) && *out_step > 0;
}

bool frames_parse(const char *text, frame_range *out_range)
{
    frame_range range = {.step = 1};
    if (!take_frame(&text, &range.first)) return false;
    range.last = range.first;
    if (*text == '-') {
        text++;
        if (!take_frame(&text, &range.last) || !take_step(&text, &range.step)) return false;
    }
    if (*text != '\0') return false;
    if (range.last < range.first) range.step = -range.step;
    if (frames_count(&range) > FRAMES_COUNT_MOST) return false;
    *out_range = range;
    return true;
}

size_t frames_count(const frame_range *range)
{
    return (size_t)((range->last - range->first) / range->step) + 1;
}

int32_t frames_at(const frame_range *range, size_t index)
{
    return range->first + (int32_t)index * range->step;
}

/* The finalizer of splitmix64 (Steele, Lea, Flood 2014), twice, so that neither seed + frame nor
 * seed ^ frame being the same gives two frames the same noise. */
static uint64_t scramble(uint64_t x)
{
    x += 0x9e3779b97f4a7c15u;
    x = (x ^ (x >> 30)) * 0xbf58476d1ce4e5b9u;
    x = (x ^ (x >> 27)) * 0x94d049bb133111ebu;
    return x ^ (x >> 31);
}

uint64_t frames_seed(uint64_t seed, int32_t frame)
{
    return scramble(scramble(seed) ^ (uint64_t)(int64_t)frame) & INT64_MAX;
}
