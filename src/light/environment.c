/* The environment: lookup and sampling in proportion to power. */
#include "light/environment.h"

#include "math/sampling.h"
#include "shading/texture.h"

/* Larger images are summed into blocks for the sampling table. */
enum { MAX_COLUMNS = 1024, MAX_ROWS = 512 };

/* Share of samples that ignores the image: it keeps the density above zero where filtering lets
 * light into a black cell. */
static const float even_share = 0.05f;

static ppmi_vec3 rotate(const ppmi_environment_map *map, ppmi_vec3 d, float sign)
{
    const float c = map->cos_rotation, s = sign * map->sin_rotation;
    return vec3(c * d.x + s * d.z, d.y, c * d.z - s * d.x);
}

/* Column 0.5 is -Z, columns run to the right (+X); row 0 is +Y. */
static ppmi_vec2 direction_to_uv(const ppmi_environment_map *map, ppmi_vec3 direction)
{
    const ppmi_vec3 d = rotate(map, direction, -1.0f);
    const float u = 0.5f + atan2f(d.x, -d.z) * (0.5f * PPMI_INV_PI);
    const float v = acosf(ppmi_clampf(d.y, -1.0f, 1.0f)) * PPMI_INV_PI;
    return (ppmi_vec2){u, v};
}

static ppmi_vec3 uv_to_direction(const ppmi_environment_map *map, ppmi_vec2 uv)
{
    const float phi = (uv.x - 0.5f) * 2.0f * PPMI_PI, theta = uv.y * PPMI_PI;
    const float sin_theta = sinf(theta);
    const ppmi_vec3 d = vec3(sin_theta * sinf(phi), cosf(theta), -sin_theta * cosf(phi));
    return rotate(map, d, 1.0f);
}

static ppmi_vec3 lookup(const ppmi_environment_map *map, ppmi_vec2 uv)
{
    const ppmi_texel texel = ppmi_texture_lookup(map->scene, &map->texture, uv);
    return vec3_mul(map->radiance, vec3(ppmi_max(texel.r, 0.0f), ppmi_max(texel.g, 0.0f),
                                        ppmi_max(texel.b, 0.0f)));
}

/* Solid angle of a cell in a row. */
static float cell_solid_angle(const ppmi_environment_map *map, uint32_t row)
{
    const float top = cosf(PPMI_PI * (float)row / (float)map->rows);
    const float bottom = cosf(PPMI_PI * (float)(row + 1) / (float)map->rows);
    return ppmi_max(top - bottom, 0.0f) * 2.0f * PPMI_PI / (float)map->columns;
}

/* Mean radiance over a cell, by two lookups a side for each pixel that the image has there (at most
 * 8). Radiance is linear between the middles of pixels, so that two are exact: a cell beside the
 * sun's has an eighth of its light, and would be met a thousand times too rarely without. */
static ppmi_vec3 cell_radiance(const ppmi_environment_map *map, uint32_t column, uint32_t row)
{
    const ppmi_image *image = &map->scene->images[map->texture.image - 1];
    uint32_t taps = 2 * ((image->width + map->columns - 1) / map->columns);
    taps = taps > 8 ? 8 : taps;
    ppmi_vec3 sum = vec3_splat(0.0f);
    for (uint32_t y = 0; y < taps; y++) {
        for (uint32_t x = 0; x < taps; x++) {
            const ppmi_vec2 uv = {
                ((float)column + ((float)x + 0.5f) / (float)taps) / (float)map->columns,
                ((float)row + ((float)y + 0.5f) / (float)taps) / (float)map->rows};
            sum = vec3_add(sum, lookup(map, uv));
        }
    }
    return vec3_scale(sum, 1.0f / (float)(taps * taps));
}

/* Weights by power plus the even share; the integral on the way. */
static void weigh_cells(ppmi_environment_map *map, float *weights)
{
    double total[3] = {0.0, 0.0, 0.0};
    double power = 0.0;
    for (uint32_t row = 0; row < map->rows; row++) {
        const float solid_angle = cell_solid_angle(map, row);
        for (uint32_t column = 0; column < map->columns; column++) {
            const ppmi_vec3 radiance = vec3_scale(cell_radiance(map, column, row), solid_angle);
            weights[(size_t)row * map->columns + column] = vec3_mean(radiance);
            power += (double)vec3_mean(radiance);
            total[0] += (double)radiance.x;
            total[1] += (double)radiance.y;
            total[2] += (double)radiance.z;
        }
    }
    map->integral = vec3((float)total[0], (float)total[1], (float)total[2]);
    const float density = (float)(power / (4.0 * (double)PPMI_PI));
    for (uint32_t row = 0; row < map->rows; row++) {
        const float even = even_share * density * cell_solid_angle(map, row);
        for (uint32_t column = 0; column < map->columns; column++) {
            float *weight = &weights[(size_t)row * map->columns + column];
            *weight = *weight * (1.0f - even_share) + even;
        }
    }
}

ppm_status ppmi_environment_map_init(ppm_context *context, const ppm_scene *scene,
                                     ppmi_environment_map *map)
{
    const ppmi_environment *environment = &scene->environment;
    *map = (ppmi_environment_map){
        .scene = scene,
        .texture = {.image = environment->image, .wrap_v = PPM_WRAP_CLAMP},
        .radiance = environment->is_set ? environment->radiance : vec3_splat(0.0f),
        .cos_rotation = cosf(environment->rotation_rad),
        .sin_rotation = sinf(environment->rotation_rad),
    };
    map->integral = vec3_scale(map->radiance, 4.0f * PPMI_PI);
    if (map->texture.image == 0) return PPM_STATUS_OK;
    const ppmi_image *image = &scene->images[map->texture.image - 1];
    map->columns = image->width < MAX_COLUMNS ? image->width : MAX_COLUMNS;
    map->rows = image->height < MAX_ROWS ? image->height : MAX_ROWS;
    const uint32_t count = map->columns * map->rows;
    float *weights = ppmi_alloc(context, count, sizeof *weights);
    if (!weights) {
        return ppmi_fail(context, PPM_STATUS_OUT_OF_MEMORY, "out of memory: environment map");
    }
    weigh_cells(map, weights);
    const ppm_status status = ppmi_alias_init(context, &map->cells, weights, count);
    ppmi_free(context, weights);
    return status;
}

void ppmi_environment_map_deinit(ppm_context *context, ppmi_environment_map *map)
{
    ppmi_alias_deinit(context, &map->cells);
}

ppmi_vec3 ppmi_environment_map_radiance(const ppmi_environment_map *map, ppmi_vec3 direction)
{
    if (ppmi_environment_map_is_constant(map)) return map->radiance;
    return lookup(map, direction_to_uv(map, direction));
}

float ppmi_environment_map_sample(const ppmi_environment_map *map, double u_cell, float u, float v,
                                  ppmi_vec3 *out_direction)
{
    if (ppmi_environment_map_is_constant(map)) {
        *out_direction = ppmi_sample_sphere(u, v);
        return 1.0f / (4.0f * PPMI_PI);
    }
    return ppmi_environment_map_sample_cell(map, ppmi_alias_sample(&map->cells, u_cell, NULL), u, v,
                                            out_direction);
}

float ppmi_environment_map_sample_cell(const ppmi_environment_map *map, uint32_t cell, float u,
                                       float v, ppmi_vec3 *out_direction)
{
    const uint32_t row = cell / map->columns, column = cell % map->columns;
    /* even in solid angle within the cell: even in the cosine of the polar angle */
    const float top = cosf(PPMI_PI * (float)row / (float)map->rows);
    const float bottom = cosf(PPMI_PI * (float)(row + 1) / (float)map->rows);
    const float cos_theta = ppmi_clampf(top + (bottom - top) * v, -1.0f, 1.0f);
    const ppmi_vec2 uv = {((float)column + u) / (float)map->columns,
                          acosf(cos_theta) * PPMI_INV_PI};
    *out_direction = vec3_normalize(uv_to_direction(map, uv));
    return ppmi_alias_probability(&map->cells, cell) / ppmi_max(cell_solid_angle(map, row), 1e-20f);
}

float ppmi_environment_map_pdf(const ppmi_environment_map *map, ppmi_vec3 direction)
{
    if (ppmi_environment_map_is_constant(map)) return 1.0f / (4.0f * PPMI_PI);
    const ppmi_vec2 uv = direction_to_uv(map, direction);
    uint32_t column = (uint32_t)(ppmi_clampf(uv.x, 0.0f, 1.0f) * (float)map->columns);
    uint32_t row = (uint32_t)(uv.y * (float)map->rows);
    column = column < map->columns ? column : map->columns - 1;
    row = row < map->rows ? row : map->rows - 1;
    return ppmi_alias_probability(&map->cells, row * map->columns + column) /
           ppmi_max(cell_solid_angle(map, row), 1e-20f);
}
