/* Light profiles. The table to draw from has cells that are even in solid angle: rows even in the
 * cosine. u and v are used up by the choice of row and column and what is left of them, so that
 * stratified numbers stay so. */
#include "light/profile.h"

enum { ROWS = 128, COLUMNS = 256, TAPS = 4 };

/* Share of draws that ignores the profile, as far as it reaches: a narrow peak between the lookups
 * must be able to send photons. */
static const float even_share = 0.1f;

/* The place of x among rising angles: index of the one below, and how far to the next. */
static uint32_t locate(const float *angles, uint32_t count, float x, float *out_fraction)
{
    *out_fraction = 0.0f;
    if (count < 2 || x <= angles[0]) return 0;
    if (x >= angles[count - 1]) {
        *out_fraction = 1.0f;
        return count - 2;
    }
    uint32_t low = 0, high = count - 1;
    while (high - low > 1) {
        const uint32_t middle = (low + high) / 2;
        if (angles[middle] <= x) {
            low = middle;
        } else {
            high = middle;
        }
    }
    *out_fraction = (x - angles[low]) / (angles[high] - angles[low]);
    return low;
}

/* Folds an azimuth into the range that the profile has, by its mirror planes. */
static float fold(const ppmi_light_profile *profile, float azimuth)
{
    const float slack = 1e-3f, last = profile->azimuth_rad[profile->azimuth_count - 1];
    if (last > PPMI_PI + slack) return azimuth;
    if (azimuth > PPMI_PI) azimuth = 2.0f * PPMI_PI - azimuth;
    if (last > 0.5f * PPMI_PI + slack) return azimuth;
    return azimuth > 0.5f * PPMI_PI ? PPMI_PI - azimuth : azimuth;
}

static float value_at(const ppmi_light_profile *profile, float polar, float azimuth)
{
    const float slack = 1e-5f;
    const float *angles = profile->polar_rad;
    const uint32_t count = profile->polar_count;
    if (polar < angles[0] - slack || polar > angles[count - 1] + slack) return 0.0f;
    float across, around = 0.0f;
    const uint32_t i = locate(angles, count, polar, &across);
    uint32_t k = 0;
    if (profile->azimuth_count > 1) {
        k = locate(profile->azimuth_rad, profile->azimuth_count, fold(profile, azimuth), &around);
    }
    const uint32_t next = count > 1 ? 1 : 0;
    const float *row = profile->candela + (size_t)k * count + i;
    const float value = row[0] + (row[next] - row[0]) * across;
    if (around == 0.0f) return value;
    row += count;
    return value + (row[0] + (row[next] - row[0]) * across - value) * around;
}

float ppmi_light_profile_value(const ppmi_light_profile *profile, ppmi_vec3 local)
{
    /* by the tangent: the arc cosine is coarse at the poles */
    const float polar = atan2f(sqrtf(local.x * local.x + local.y * local.y), -local.z);
    float azimuth = 0.0f;
    if (profile->azimuth_count > 1) {
        azimuth = atan2f(local.y, local.x);
        if (azimuth < 0.0f) azimuth += 2.0f * PPMI_PI;
    }
    return value_at(profile, polar, azimuth);
}

/* The direction at a place of the unit square, even in solid angle: -z at y = 0. */
static ppmi_vec3 direction_at(float x, float y)
{
    const float down = 1.0f - 2.0f * y;
    const float across = sqrtf(ppmi_max(0.0f, 4.0f * y * (1.0f - y)));
    const float phi = 2.0f * PPMI_PI * x;
    return vec3(across * cosf(phi), across * sinf(phi), -down);
}

static float cell_mean(const ppmi_light_profile *profile, const ppmi_profile_table *table,
                       uint32_t row, uint32_t column)
{
    float sum = 0.0f;
    for (uint32_t i = 0; i < TAPS * TAPS; i++) {
        const float x = ((float)column + ((float)(i % TAPS) + 0.5f) / TAPS) / (float)table->columns;
        const float y = ((float)row + ((float)(i / TAPS) + 0.5f) / TAPS) / (float)table->rows;
        sum += ppmi_light_profile_value(profile, direction_at(x, y));
    }
    return sum / (TAPS * TAPS);
}

ppm_status ppmi_profile_table_init(ppm_context *context, const ppmi_light_profile *profile,
                                   ppmi_profile_table *out_table)
{
    ppmi_profile_table table = {.rows = ROWS, .columns = COLUMNS};
    if (profile->azimuth_count == 1) table.columns = 1;
    const uint32_t count = table.rows * table.columns;
    float *weights = ppmi_alloc(context, count, sizeof *weights);
    if (!weights) {
        return ppmi_fail(context, PPM_STATUS_OUT_OF_MEMORY, "out of memory: light profile");
    }
    double sum = 0.0;
    for (uint32_t i = 0; i < count; i++) {
        weights[i] = cell_mean(profile, &table, i / table.columns, i % table.columns);
        sum += (double)weights[i];
    }
    const float mean = (float)(sum / count);
    for (uint32_t i = 0; i < count; i++) {
        weights[i] = weights[i] * (1.0f - even_share) + mean * even_share;
    }
    table.flux = 4.0f * PPMI_PI * mean;
    const ppm_status status = ppmi_alias_init(context, &table.cells, weights, count);
    ppmi_free(context, weights);
    if (status == PPM_STATUS_OK) *out_table = table;
    return status;
}

void ppmi_profile_table_deinit(ppm_context *context, ppmi_profile_table *table)
{
    ppmi_alias_deinit(context, &table->cells);
}

float ppmi_profile_table_sample(const ppmi_profile_table *table, float u, float v,
                                ppmi_vec3 *out_local)
{
    double rest;
    const uint32_t cell = ppmi_alias_sample(&table->cells, (double)u, &rest);
    const float x = ((float)(cell % table->columns) + v) / (float)table->columns;
    const float y = ((float)(cell / table->columns) + (float)rest) / (float)table->rows;
    *out_local = direction_at(x, y);
    return ppmi_alias_probability(&table->cells, cell) * (float)table->cells.count /
           (4.0f * PPMI_PI);
}
