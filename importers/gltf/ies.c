/* A reader of IESNA LM-63.
 *
 * Keyword lines are passed over up to TILT=; numbers follow, separated by white space or commas:
 * lamps, lumens, multiplier, counts of vertical and horizontal angles, photometric type, units,
 * three sizes, ballast factor, ballast-lamp factor, watts, the angles, and a row of candela for
 * each horizontal angle. Tilt is not applied: it is about lamps that are mounted askew.
 *
 * Type C (polar axis down) is kept as it is. Types B (polar axis level) and A (polar axis up) are
 * resampled; their photometric axis is (0, 0), and by the convention of EXT_lights_ies vertical
 * angles rise towards +X and horizontal ones towards -Y. */
#include "gltf/ies.h"

#include <math.h>
#include <string.h>

#define PI 3.14159265358979323846
enum { TYPE_C = 1, TYPE_B = 2, TYPE_A = 3 };
enum { MOST_ANGLES = 8192, MOST_VALUES = 1 << 22 };

/* Resampled: half a degree to the axis, three degrees around it. */
enum { POLAR_STEPS = 180, AZIMUTH_STEPS = 120 };

typedef struct scanner {
    const char *at, *end;
} scanner;

static bool is_space(char c)
{
    return c == ' ' || c == '\t' || c == '\r' || c == '\n' || c == ',' || c == '\f' || c == '\v';
}

static bool is_digit(char c)
{
    return c >= '0' && c <= '9';
}

static double take_digits(scanner *s, double value, int *count, int *places)
{
    for (; s->at < s->end && is_digit(*s->at); ++s->at) {
        value = 10.0 * value + (*s->at - '0');
        ++*count;
        ++*places;
    }
    return value;
}

static bool take_sign(scanner *s)
{
    if (s->at == s->end || (*s->at != '-' && *s->at != '+')) return false;
    return *s->at++ == '-';
}

/* A decimal number; no locale has a say in it. */
static bool take_number(scanner *s, double *out)
{
    while (s->at < s->end && is_space(*s->at))
        ++s->at;
    const bool is_negative = take_sign(s);
    int count = 0, before = 0, places = 0;
    double value = take_digits(s, 0.0, &count, &before);
    if (s->at < s->end && *s->at == '.') {
        ++s->at;
        value = take_digits(s, value, &count, &places);
    }
    if (count == 0) return false;
    double exponent = -(double)places;
    if (s->at < s->end && (*s->at == 'e' || *s->at == 'E')) {
        int digits = 0, ignored = 0;
        ++s->at;
        const bool is_small = take_sign(s);
        const double power = take_digits(s, 0.0, &digits, &ignored);
        if (digits == 0) return false;
        exponent += is_small ? -power : power;
    }
    value *= pow(10.0, exponent);
    *out = is_negative ? -value : value;
    return isfinite(value) && (s->at == s->end || is_space(*s->at));
}

static bool skip_numbers(scanner *s, double count)
{
    double ignored;
    if (!(count >= 0.0 && count <= MOST_ANGLES)) return false;
    for (int i = 0; i < (int)count; ++i) {
        if (!take_number(s, &ignored)) return false;
    }
    return true;
}

/* Past the line that begins with TILT=, and past what TILT=INCLUDE includes. */
static const char *pass_head(scanner *s)
{
    while (s->at < s->end) {
        const char *line = s->at;
        while (s->at < s->end && *s->at != '\n' && *s->at != '\r')
            ++s->at;
        const size_t length = (size_t)(s->at - line);
        if (length < 5 || memcmp(line, "TILT=", 5) != 0) {
            if (s->at < s->end) ++s->at;
            continue;
        }
        if (length < 12 || memcmp(line, "TILT=INCLUDE", 12) != 0) return NULL;
        double geometry, pairs;
        const bool is_read = take_number(s, &geometry) && take_number(s, &pairs) &&
                             skip_numbers(s, pairs) && skip_numbers(s, pairs);
        return is_read ? NULL : "TILT=INCLUDE is not followed by its angles and factors";
    }
    return "no line begins with TILT=: not an IES LM-63 file";
}

/* ---- the numbers ----------------------------------------------------------------------------- */

/* The file's own angles, in degrees, and candela. */
typedef struct table {
    int type;
    uint32_t vertical_count, horizontal_count;
    double *vertical, *horizontal, *candela;
    double factor; /* on the candela */
} table;

static bool is_count(double value)
{
    return value >= 1.0 && value <= MOST_ANGLES && value == floor(value);
}

static const char *read_sizes(scanner *s, table *t)
{
    double v[13];
    for (int i = 0; i < 13; ++i) {
        if (!take_number(s, &v[i]))
            return "the 13 numbers after TILT= are incomplete or no numbers";
    }
    if (!is_count(v[3]) || !is_count(v[4]) || v[3] * v[4] > MOST_VALUES) {
        return "the numbers of angles must be within 1 .. 8192";
    }
    if (v[5] != TYPE_C && v[5] != TYPE_B && v[5] != TYPE_A) {
        return "the photometric type must be 1 (C), 2 (B) or 3 (A)";
    }
    t->vertical_count = (uint32_t)v[3];
    t->horizontal_count = (uint32_t)v[4];
    t->type = (int)v[5];
    t->factor = v[2] * v[10] * v[11];
    return t->factor >= 0.0 ? NULL : "the multiplier must not be negative";
}

static bool read_list(scanner *s, size_t count, double *out)
{
    for (size_t i = 0; i < count; ++i) {
        if (!take_number(s, &out[i])) return false;
    }
    return true;
}

static bool is_rising(const double *angles, uint32_t count, double least, double most)
{
    for (uint32_t i = 0; i < count; ++i) {
        if (!(angles[i] >= least && angles[i] <= most)) return false;
        if (i > 0 && !(angles[i] > angles[i - 1])) return false;
    }
    return true;
}

static const char *read_table(scanner *s, table *t)
{
    const bool is_c = t->type == TYPE_C;
    const size_t count = (size_t)t->vertical_count * t->horizontal_count;
    if (!read_list(s, t->vertical_count, t->vertical) ||
        !read_list(s, t->horizontal_count, t->horizontal) || !read_list(s, count, t->candela)) {
        return "the file ends within its angles or candela, or they are no numbers";
    }
    if (!is_rising(t->vertical, t->vertical_count, is_c ? 0.0 : -90.0, is_c ? 180.0 : 90.0)) {
        return is_c ? "vertical angles must rise within 0 .. 180"
                    : "vertical angles must rise within -90 .. 90";
    }
    if (!is_rising(t->horizontal, t->horizontal_count, is_c ? 0.0 : -90.0, is_c ? 360.0 : 90.0)) {
        return is_c ? "horizontal angles must rise within 0 .. 360"
                    : "horizontal angles must rise within -90 .. 90";
    }
    for (size_t i = 0; i < count; ++i) {
        t->candela[i] *= t->factor;
        if (!(t->candela[i] < 1e18)) return "an intensity is too large";
        /* noise of the measurement goes below 0 */
        if (t->candela[i] < 0.0) t->candela[i] = 0.0;
    }
    return NULL;
}

/* ---- type C ---------------------------------------------------------------------------------- */

static bool allocate(ppm_context *context, uint32_t polar, uint32_t azimuths,
                     ppmi_ies_profile *profile)
{
    profile->polar_count = polar;
    profile->azimuth_count = azimuths;
    profile->polar_rad = ppmi_alloc(context, polar, sizeof(float));
    profile->azimuth_rad = ppmi_alloc(context, azimuths, sizeof(float));
    profile->candela = ppmi_alloc(context, (size_t)polar * azimuths, sizeof(float));
    return profile->polar_rad && profile->azimuth_rad && profile->candela;
}

static float radians(double degrees)
{
    return (float)(degrees * (PI / 180.0));
}

/* Files may begin at 90 degrees (LM-63-1995: mirrored by the plane through 90 and 270): azimuths
 * are then counted from there. One that stops short of 360 goes on to its beginning. */
static const char *convert_c(ppm_context *context, const table *t, ppmi_ies_profile *out)
{
    const uint32_t count = t->horizontal_count, polar = t->vertical_count;
    const double first = t->horizontal[0], last = t->horizontal[count - 1] - first;
    const bool is_known = count == 1 || last == 90.0 || last == 180.0 || last > 180.0;
    if ((count > 1 && first != 0.0 && !(first == 90.0 && last == 180.0)) || !is_known) {
        return "horizontal angles must be 0 alone, or reach from 0 to 90, 180 or 360, or from 90 "
               "to "
               "270";
    }
    const bool is_open = last > 180.0 && last < 360.0;
    if (!allocate(context, polar, count + is_open, out)) return "out of memory";
    out->turn_rad = count > 1 ? radians(first) : 0.0f;
    for (uint32_t i = 0; i < polar; ++i)
        out->polar_rad[i] = radians(t->vertical[i]);
    for (uint32_t k = 0; k < count; ++k) {
        out->azimuth_rad[k] = radians(t->horizontal[k] - first);
        for (uint32_t i = 0; i < polar; ++i) {
            out->candela[(size_t)k * polar + i] = (float)t->candela[(size_t)k * polar + i];
        }
    }
    if (is_open) {
        out->azimuth_rad[count] = radians(360.0);
        memcpy(out->candela + (size_t)count * polar, out->candela, polar * sizeof(float));
    }
    return NULL;
}

/* ---- types A and B --------------------------------------------------------------------------- */

/* The place of x among rising angles; false outside of them. One side alone stands for both. */
static bool locate(const double *angles, uint32_t count, double x, uint32_t *out_index,
                   double *out_fraction)
{
    const double slack = 1e-9;
    if (angles[0] >= 0.0) x = fabs(x);
    if (x < angles[0] - slack || x > angles[count - 1] + slack) return false;
    uint32_t i = 0;
    while (i + 2 < count && angles[i + 1] <= x)
        ++i;
    *out_index = i;
    *out_fraction =
        count > 1 ? fmin(fmax((x - angles[i]) / (angles[i + 1] - angles[i]), 0.0), 1.0) : 0.0;
    return true;
}

static double look_up(const table *t, double vertical, double horizontal)
{
    uint32_t i, k;
    double f, g;
    if (!locate(t->vertical, t->vertical_count, vertical, &i, &f)) return 0.0;
    /* a single horizontal angle: the same at all of them */
    if (t->horizontal_count == 1) horizontal = t->horizontal[0];
    if (!locate(t->horizontal, t->horizontal_count, horizontal, &k, &g)) return 0.0;
    const double *row = t->candela + (size_t)k * t->vertical_count + i;
    const size_t up = t->vertical_count > 1, next = t->horizontal_count > 1 ? t->vertical_count : 0;
    return (row[0] * (1.0 - f) + row[up] * f) * (1.0 - g) +
           (row[next] * (1.0 - f) + row[next + up] * f) * g;
}

/* Type A: the horizontal angle turns about the vertical axis, the vertical one rises from there.
 * Type B: the vertical angle turns about the level axis, the horizontal one goes aside from there.
 */
static double value_towards(const table *t, double x, double y, double forward)
{
    const double degrees = 180.0 / PI;
    if (t->type == TYPE_A) {
        return look_up(t, asin(fmin(fmax(x, -1.0), 1.0)) * degrees, atan2(-y, forward) * degrees);
    }
    return look_up(t, atan2(x, forward) * degrees, asin(fmin(fmax(-y, -1.0), 1.0)) * degrees);
}

static const char *resample(ppm_context *context, const table *t, ppmi_ies_profile *out)
{
    if (!allocate(context, POLAR_STEPS + 1, AZIMUTH_STEPS + 1, out)) return "out of memory";
    for (uint32_t i = 0; i <= POLAR_STEPS; ++i)
        out->polar_rad[i] = radians(90.0 * i / POLAR_STEPS);
    for (uint32_t k = 0; k <= AZIMUTH_STEPS; ++k) {
        const double azimuth = 2.0 * PI * (k % AZIMUTH_STEPS) / AZIMUTH_STEPS;
        out->azimuth_rad[k] = radians(360.0 * k / AZIMUTH_STEPS);
        for (uint32_t i = 0; i <= POLAR_STEPS; ++i) {
            const double polar = 0.5 * PI * i / POLAR_STEPS, side = sin(polar);
            out->candela[(size_t)k * out->polar_count + i] = (float)value_towards(
                t, side * cos(azimuth), side * sin(azimuth), fmax(cos(polar), 1e-12));
        }
    }
    return NULL;
}

/* ---- the file -------------------------------------------------------------------------------- */

static const char *parse(ppm_context *context, scanner *s, table *t, ppmi_ies_profile *out)
{
    const char *reason = pass_head(s);
    if (!reason) reason = read_sizes(s, t);
    if (reason) return reason;
    const size_t count = (size_t)t->vertical_count * t->horizontal_count;
    t->vertical = ppmi_alloc(context, t->vertical_count, sizeof(double));
    t->horizontal = ppmi_alloc(context, t->horizontal_count, sizeof(double));
    t->candela = ppmi_alloc(context, count, sizeof(double));
    if (!t->vertical || !t->horizontal || !t->candela) return "out of memory";
    reason = read_table(s, t);
    if (reason) return reason;
    return t->type == TYPE_C ? convert_c(context, t, out) : resample(context, t, out);
}

ppm_status ppmi_ies_parse(ppm_context *context, const char *text, size_t count,
                          ppmi_ies_profile *out_profile, const char **out_reason)
{
    scanner s = {text, text + count};
    table t = {0};
    *out_profile = (ppmi_ies_profile){0};
    const char *reason = parse(context, &s, &t, out_profile);
    ppmi_free(context, t.vertical);
    ppmi_free(context, t.horizontal);
    ppmi_free(context, t.candela);
    if (!reason) return PPM_STATUS_OK;
    *out_reason = reason;
    return strcmp(reason, "out of memory") == 0 ? PPM_STATUS_OUT_OF_MEMORY
                                                : PPM_STATUS_INPUT_INVALID;
}

void ppmi_ies_deinit(ppm_context *context, ppmi_ies_profile *profile)
{
    ppmi_free(context, profile->polar_rad);
    ppmi_free(context, profile->azimuth_rad);
    ppmi_free(context, profile->candela);
    *profile = (ppmi_ies_profile){0};
}
