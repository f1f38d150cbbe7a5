#include "render/facts.h"

#include <string.h>

#include "transport/solid.h"

uint32_t ppmi_fact_channels(int32_t kind)
{
    static const uint32_t channels[PPMI_FACT_COUNT] = {
        [PPM_LAYER_POSITION - PPMI_FACT_FIRST] = 3,
        [PPM_LAYER_DEPTH - PPMI_FACT_FIRST] = 1,
        [PPM_LAYER_UV - PPMI_FACT_FIRST] = 2,
        [PPM_LAYER_OBJECT_INDEX - PPMI_FACT_FIRST] = 1,
        [PPM_LAYER_MATERIAL_INDEX - PPMI_FACT_FIRST] = 1,
        [PPM_LAYER_MOTION - PPMI_FACT_FIRST] = 4};
    return channels[kind - PPMI_FACT_FIRST];
}

/* ---- motion ---------------------------------------------------------------------------------- */

/* Where a point is in the picture: pixels from its middle, to the right and up. False behind the
 * camera. */
static bool project(const ppmi_camera_view *view, ppmi_vec3 point, ppmi_vec2 *out_place)
{
    const ppmi_vec3 way = vec3_sub(point, view->origin);
    const float depth = view->is_perspective ? vec3_dot(way, view->forward) : 1.0f;
    if (!(depth > 0.0f)) return false;
    const float right = vec3_dot(way, view->right) / (vec3_length2(view->right) * depth);
    const float up = vec3_dot(way, view->up) / (vec3_length2(view->up) * depth);
    *out_place = (ppmi_vec2){0.5f * view->width * right, 0.5f * view->height * up};
    return true;
}

/* Where the point that was hit is at another time. */
static bool project_at(const ppmi_job *job, const ppmi_hit *hit, float time, ppmi_vec2 *out_place)
{
    const ppmi_camera_view view = ppmi_camera_view_at(&job->view, time);
    ppmi_hit moved = *hit;
    ppmi_surface surface;
    moved.time = time;
    ppmi_surface_from_hit(job->world.scene, &moved, &surface);
    return project(&view, surface.position, out_place);
}

/* As Blender's vector pass: the way to where the point was at the opening of the shutter, and the
 * way from where it is at the closing, both as if they took a frame. Even motion has the same in
 * both. */
static void find_motion(const ppmi_job *job, const ppmi_hit *hit, float motion[4])
{
    const float half = 0.5f * (job->options->shutter_close - job->options->shutter_open);
    ppmi_vec2 now, then;
    if (!ppmi_shutter_is_open(job) || !project_at(job, hit, 0.5f, &now)) return;
    for (int i = 0; i < 2; i++) {
        const float scale = (i == 0 ? 1.0f : -1.0f) / half;
        if (!project_at(job, hit, (float)i, &then)) continue;
        motion[2 * i] = scale * (then.x - now.x);
        motion[2 * i + 1] = scale * (then.y - now.y);
    }
}

/* ---- a pixel --------------------------------------------------------------------------------- */

/* Where layer kind of the pixel is, or NULL. */
static float *place_of(const ppmi_facts *facts, int32_t kind, size_t pixel)
{
    float *values = facts->values[kind - PPMI_FACT_FIRST];
    return values ? values + pixel * ppmi_fact_channels(kind) : NULL;
}

static void store_nothing(const ppmi_facts *facts, size_t pixel)
{
    for (int32_t kind = PPMI_FACT_FIRST; kind <= PPMI_FACT_LAST; kind++) {
        float *value = place_of(facts, kind, pixel);
        if (value) memset(value, 0, ppmi_fact_channels(kind) * sizeof *value);
    }
    float *depth = place_of(facts, PPM_LAYER_DEPTH, pixel);
    if (depth) *depth = PPMI_FAR_DEPTH_M;
}

/* In the coordinates of the file. */
static void store_position(const ppm_scene *scene, ppmi_vec3 position, float out[3])
{
    float shift[3];
    vec3_store(out, position);
    vec3_store(shift, scene->shift);
    for (int i = 0; i < 3; i++)
        out[i] = (float)((double)out[i] + (double)shift[i] + scene->origin_m[i]);
}

static void store(const ppmi_job *job, const ppmi_facts *facts, size_t pixel,
                  const ppmi_camera_view *view, const ppmi_vertex *vertex)
{
    const ppm_scene *scene = job->world.scene;
    const ppmi_surface *surface = &vertex->surface;
    float *value = place_of(facts, PPM_LAYER_POSITION, pixel);
    if (value) store_position(scene, surface->position, value);
    value = place_of(facts, PPM_LAYER_DEPTH, pixel);
    if (value) *value = vec3_dot(vec3_sub(surface->position, view->origin), view->forward);
    value = place_of(facts, PPM_LAYER_UV, pixel);
    if (value && surface->primitive->uvs[0]) {
        const ppmi_vec2 uv = ppmi_surface_uv(surface, 0);
        value[0] = uv.x;
        value[1] = 1.0f - uv.y; /* up, as compositors look textures up */
    }
    value = place_of(facts, PPM_LAYER_OBJECT_INDEX, pixel);
    if (value) *value = (float)(vertex->hit.instance + 1);
    value = place_of(facts, PPM_LAYER_MATERIAL_INDEX, pixel);
    if (value) *value = (float)(surface->primitive->material + 1);
    value = place_of(facts, PPM_LAYER_MOTION, pixel);
    if (value) find_motion(job, &vertex->hit, value);
}

uint64_t ppmi_facts_find(const ppmi_job *job, const ppmi_facts *facts, uint32_t x, uint32_t y)
{
    const float time = ppmi_shutter_is_open(job) ? 0.5f : 0.0f;
    const ppmi_camera_view view = ppmi_camera_view_at(&job->view, time);
    ppmi_ray ray = ppmi_camera_view_ray(&view, (float)(x + job->film.x0) + 0.5f,
                                        (float)(y + job->film.y0) + 0.5f)
                       .ray;
    ppmi_walker walker = {.world = &job->world};
    ppmi_walker_start(&walker, ppmi_rng_start(0, PPMI_STREAM_EYE, 0), 0, 0, 0, 0);
    walker.rounds_opacity = true;
    walker.time = ray.time = time;
    walker.interior = job->around_camera_changes
                          ? ppmi_solids_around_at(&job->world, ppmi_camera_view_start(&view), time)
                          : job->around_camera;
    const size_t pixel = (size_t)y * job->film.width + x;
    ppmi_vertex vertex;
    store_nothing(facts, pixel);
    if (ppmi_walk_both_ways(&walker, ray, PPMI_RAY_CAMERA, &vertex, NULL, 0) == PPMI_AT_SURFACE) {
        store(job, facts, pixel, &view, &vertex);
    }
    return walker.rays;
}
