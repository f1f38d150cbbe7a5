/* Lines and points: `l` and `p` statements, whose corners are as those of faces, without normals.
 * tinyobjloader's stream interface does not have them. */
#include <math.h>

#include "obj/obj_reader.h"

enum { MOST_DIGITS = 9 };

/* A whole number at *at, which moves behind it. False for anything else. */
static bool read_index(const char **at, const char *end, int32_t *out)
{
    const bool is_negative = *at < end && **at == '-';
    int32_t value = 0;
    int digits = 0;
    if (is_negative) ++*at;
    for (; *at < end && **at >= '0' && **at <= '9'; ++*at) {
        if (++digits > MOST_DIGITS) return false;
        value = 10 * value + (**at - '0');
    }
    *out = is_negative ? -value : value;
    return digits > 0;
}

/* "12", "12/3" or "12/"; a normal behind that is read over. */
static bool read_corner(const char **at, const char *end, ppmi_obj_corner *out)
{
    int32_t *const parts[] = {&out->position, &out->uv, &out->normal};
    *out = (ppmi_obj_corner){0};
    for (int i = 0; i < 3; ++i) {
        const bool is_missing = i > 0 && (*at == end || **at == '/' || ppmi_obj_is_blank(**at));
        if (!is_missing && !read_index(at, end, parts[i])) return false;
        if (*at == end || **at != '/') break;
        ++*at;
    }
    out->normal = 0;
    return *at == end || ppmi_obj_is_blank(**at);
}

bool ppmi_obj_read_corners(ppmi_obj_reader *r, const char *text, size_t length, ppmi_obj_array *out,
                           bool *out_is_valid)
{
    const char *at = text, *const end = text + length;
    out->count = 0;
    *out_is_valid = true;
    while (at < end && *out_is_valid) {
        ppmi_obj_corner *corner = ppmi_obj_push(r->context, out, 1, sizeof *corner);
        if (!corner) return false;
        *out_is_valid = read_corner(&at, end, corner);
        while (at < end && ppmi_obj_is_blank(*at)) {
            ++at;
        }
    }
    return true;
}

/* Each corner a point, or each but the first the end of a segment. */
size_t ppmi_obj_element_count(int32_t kind, size_t corner_count)
{
    if (kind == PPM_PRIMITIVE_POINTS) return corner_count;
    return kind == PPM_PRIMITIVE_LINES ? corner_count - 1 : corner_count - 2;
}

static float box_diagonal(const ppmi_obj_reader *r)
{
    const float *positions = r->positions.items;
    double sum = 0.0;
    for (size_t k = 0; k < 3; ++k) {
        double low = INFINITY, high = -INFINITY;
        for (size_t i = 0; i < r->positions.count; ++i) {
            const double x = (double)positions[3 * i + k];
            if (!isfinite(x)) continue;
            low = fmin(low, x);
            high = fmax(high, x);
        }
        if (high > low) sum += (high - low) * (high - low);
    }
    return (float)fmin(sqrt(sum), 1e15);
}

float ppmi_obj_line_radius(ppmi_obj_reader *r)
{
    const float share = 0.002f, of_a_single_point = 1e-3f; /* as for glTF */
    if (r->options->line_radius_m > 0.0f) return r->options->line_radius_m;
    if (!(r->line_radius > 0.0f)) r->line_radius = share * box_diagonal(r);
    if (!(r->line_radius > 0.0f)) r->line_radius = of_a_single_point;
    return r->line_radius;
}
