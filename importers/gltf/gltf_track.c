/* Samplers of animations: reading them, and interpolation (glTF 2.0 specification, appendix C). */
#include "gltf/gltf_track.h"

#include <math.h>
#include <string.h>

/* ---- values at a time ------------------------------------------------------------------------ */

static void normalize(double *q)
{
    const double length = sqrt(q[0] * q[0] + q[1] * q[1] + q[2] * q[2] + q[3] * q[3]);
    for (int i = 0; i < 4 && length > 0.0; ++i) {
        q[i] /= length;
    }
}

/* Appendix C.4: along the shorter of the two arcs. */
static void slerp(const double *from, const double *to, double t, double *out)
{
    double a[4], b[4], cosine = 0.0;
    for (int i = 0; i < 4; ++i) {
        a[i] = from[i];
        b[i] = to[i];
    }
    normalize(a);
    normalize(b);
    for (int i = 0; i < 4; ++i) {
        cosine += a[i] * b[i];
    }
    const double sign = cosine < 0.0 ? -1.0 : 1.0;
    const double angle = acos(fmin(fabs(cosine), 1.0)), sine = sin(angle);
    /* for a small angle the chord is the arc, and sines would divide zero by zero */
    const bool is_chord = sine < 1e-6;
    const double u = is_chord ? 1.0 - t : sin(angle * (1.0 - t)) / sine;
    const double v = is_chord ? t : sin(angle * t) / sine;
    for (int i = 0; i < 4; ++i) {
        out[i] = u * a[i] + sign * v * b[i];
    }
    normalize(out);
}

static void linear(const double *from, const double *to, uint32_t width, double t, double *out)
{
    for (uint32_t i = 0; i < width; ++i) {
        out[i] = (1.0 - t) * from[i] + t * to[i];
    }
}

/* Appendix C.5: Hermite's basis; tangents are per second. */
static void cubic(const double *from, const double *to, uint32_t width, double span, double t,
                  double *out)
{
    const double t2 = t * t, t3 = t2 * t;
    for (uint32_t i = 0; i < width; ++i) {
        const double value = from[width + i], out_tangent = from[2 * width + i];
        const double in_tangent = to[i], next = to[width + i];
        out[i] = (2.0 * t3 - 3.0 * t2 + 1.0) * value + span * (t3 - 2.0 * t2 + t) * out_tangent +
                 (3.0 * t2 - 2.0 * t3) * next + span * (t3 - t2) * in_tangent;
    }
}

/* Keys are kept in single precision: that of frame N is at N / fps, rounded, and where a writer
 * multiplied by a rounded 1 / fps, at a number beside it. A time that is no further from a key than
 * two of its steps is the key's: half of the frames would else come before their own keys. */
static double slack(double key_s)
{
    return ldexp(fabs(key_s), -22);
}

/* The last key that a time has reached; 0 when all are ahead. */
static size_t find_key(const ppmi_gltf_track *track, double time_s)
{
    size_t low = 0, high = track->key_count;
    while (high - low > 1) {
        const size_t middle = low + (high - low) / 2;
        const double begin = track->times[middle];
        if (begin - slack(begin) <= time_s) {
            low = middle;
        } else {
            high = middle;
        }
    }
    return low;
}

void ppmi_gltf_track_eval(const ppmi_gltf_track *track, double time_s, double *out)
{
    const bool is_cubic = track->interpolation == PPMI_GLTF_CUBICSPLINE;
    const uint32_t width = track->width;
    const size_t stride = (size_t)width * (is_cubic ? 3 : 1), key = find_key(track, time_s);
    const double *from = track->values + key * stride, *to = from + stride;
    const double begin = track->times[key];
    const bool is_held = time_s <= begin + slack(begin) || key + 1 == track->key_count;
    if (is_held || track->interpolation == PPMI_GLTF_STEP) {
        for (uint32_t i = 0; i < width; ++i) {
            out[i] = from[(is_cubic ? width : 0) + i];
        }
        if (track->is_rotation) normalize(out);
        return;
    }
    const double span = track->times[key + 1] - begin; /* above 0: see find_key */
    const double t = (time_s - begin) / span;
    if (is_cubic) {
        cubic(from, to, width, span, t, out);
        if (track->is_rotation) normalize(out);
    } else if (track->is_rotation) {
        slerp(from, to, t, out);
    } else {
        linear(from, to, width, t, out);
    }
}

/* ---- reading --------------------------------------------------------------------------------- */

/* Equal times are met in practice, and mean a jump. */
static ppm_status check_times(ppmi_gltf_reader *reader, const ppmi_gltf_track *track,
                              const char *place)
{
    for (size_t i = 0; i < track->key_count; ++i) {
        if (!isfinite(track->times[i])) {
            return ppmi_gltf_invalid(reader, place, "the time of key %zu is not a finite number",
                                     i);
        }
        if (i == 0 || track->times[i] >= track->times[i - 1]) continue;
        return ppmi_gltf_invalid(reader, place,
                                 "times must increase: key %zu is at %g s, the one before at %g s",
                                 i, track->times[i], track->times[i - 1]);
    }
    return PPM_STATUS_OK;
}

static ppm_status read_output(ppmi_gltf_reader *reader, int32_t accessor,
                              const ppmi_gltf_track_format *format, const char *place,
                              ppmi_gltf_track *track)
{
    const uint32_t components = format->components;
    const ppmi_gltf_format wanted = {components, components, components, false};
    const size_t per_key = track->interpolation == PPMI_GLTF_CUBICSPLINE ? 3 : 1;
    const size_t expected = track->key_count * per_key * (format->width / components);
    size_t count;
    const ppm_status status =
        ppmi_gltf_read_doubles(reader, accessor, place, &wanted, &track->values, &count);
    if (status != PPM_STATUS_OK) return status;
    if (count != expected) {
        return ppmi_gltf_invalid(reader, place, "%zu elements, expected %zu for %zu keys", count,
                                 expected, track->key_count);
    }
    for (size_t i = 0; i < count * components; ++i) {
        if (isfinite(track->values[i])) continue;
        return ppmi_gltf_invalid(reader, place, "element %zu is not a finite number",
                                 i / components);
    }
    return PPM_STATUS_OK;
}

ppm_status ppmi_gltf_track_read(ppmi_gltf_reader *reader, int32_t animation, int32_t sampler,
                                const ppmi_gltf_track_format *format, const char *place,
                                ppmi_gltf_track *out)
{
    static const ppmi_gltf_format scalar = {1, 1, 1, false};
    const ppmi_gltf_animation *from = &reader->document->animations[animation];
    char inner[PPMI_GLTF_PLACE];
    *out = (ppmi_gltf_track){.width = format->width, .is_rotation = format->is_rotation};
    if (sampler < 0 || (uint32_t)sampler >= from->sampler_count) {
        return ppmi_gltf_invalid(reader, place, "sampler %d does not exist; there are %u",
                                 (int)sampler, (unsigned)from->sampler_count);
    }
    const ppmi_gltf_animation_sampler *s = &from->samplers[sampler];
    out->interpolation = format->is_flag ? PPMI_GLTF_STEP : s->interpolation;
    ppmi_gltf_place(inner, "animations[%d].samplers[%d].input", (int)animation, (int)sampler);
    ppm_status status =
        ppmi_gltf_read_doubles(reader, s->input, inner, &scalar, &out->times, &out->key_count);
    if (status == PPM_STATUS_OK) status = check_times(reader, out, inner);
    if (status != PPM_STATUS_OK) return status;
    ppmi_gltf_place(inner, "animations[%d].samplers[%d].output", (int)animation, (int)sampler);
    return read_output(reader, s->output, format, inner, out);
}

void ppmi_gltf_track_deinit(ppm_context *context, ppmi_gltf_track *track)
{
    ppmi_free(context, track->times);
    ppmi_free(context, track->values);
    *track = (ppmi_gltf_track){0};
}
