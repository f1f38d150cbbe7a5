/* Paths from the camera, and what they meet. */
#include "photon/seek.h"

#include <stdlib.h>

#include "photon/target_clusters.h"

/* Camera paths, as a raster; rays from where each is gathered; bounces; what is kept of all that.
 */
enum { SIDE = 48, IMPORTONS = 4, MAX_DEPTH = 10, MAX_FOUND = 1 << 15 };
enum { MAX_GLOSSY = 14, MAX_LEVELS = 9 };

typedef struct found_list {
    ppmi_found *found;
    uint32_t count;
} found_list;

typedef struct seek_state {
    const ppmi_seek *seek;
    found_list narrow, gathered;
    found_list lighting; /* what lights visible points by one bounce */
} seek_state;

static void keep(found_list *list, const ppmi_vertex *vertex, float spacing)
{
    if (list->count == MAX_FOUND) return;
    list->found[list->count++] =
        (ppmi_found){.target = {vertex->surface.position, vec3_splat(ppmi_max(spacing, 1e-20f))},
                     .instance = vertex->medium ? UINT32_MAX : vertex->hit.instance,
                     .primitive = vertex->medium ? 0 : vertex->hit.primitive};
}

/* Follows a path through mirrors and glass to where photons are gathered. spacing: between it and
 * its neighbours, at its start, and how that grows by the way. False if it does not come there. */
static bool follow(seek_state *state, ppmi_walker *walker, ppmi_ray ray, ppmi_ray_kind kind,
                   float spacing, float spread, ppmi_vertex *vertex, ppmi_bsdf *bsdf)
{
    for (int depth = 0; depth < MAX_DEPTH; depth++) {
        if (ppmi_walk(walker, ray, kind, vertex) == PPMI_ESCAPED) return false;
        kind = PPMI_RAY_OTHER;
        spacing += spread * vertex->distance;
        ppmi_walk_bsdf(walker, vertex, ray.direction, bsdf);
        const float gathering = ppmi_bsdf_probability(bsdf, bsdf->gather_lobes);
        if (gathering > 0.0f && ppmi_walker_float(walker) < gathering) {
            keep(&state->gathered, vertex, spacing);
            return true;
        }
        const uint32_t others = (uint32_t)(bsdf->lobes & ~bsdf->gather_lobes);
        const float u_lobe = ppmi_walker_float(walker), u = ppmi_walker_float(walker),
                    v = ppmi_walker_float(walker);
        ppmi_bsdf_sample sample;
        if (!ppmi_bsdf_draw(bsdf, walker->world->albedo, others, PPMI_TRANSPORT_RADIANCE, u_lobe, u,
                            v, &sample)) {
            return false;
        }
        keep(&state->narrow, vertex, spacing);
        ppmi_vec3 unused = vec3_splat(1.0f);
        ray = ppmi_walk_leave(walker, vertex, &sample, &unused);
    }
    return false;
}

/* What may send light to a visible point: by way of mirrors and glass, or by a bounce. */
static void send_importons(seek_state *state, const ppmi_walker *walker, const ppmi_vertex *from,
                           const ppmi_bsdf *bsdf)
{
    const float spread = 0.3f; /* of the few rays' directions */
    for (int i = 0; i < IMPORTONS; i++) {
        ppmi_walker next = *walker;
        next.rng = ppmi_rng_start(ppmi_rng_u32(&next.rng), PPMI_STREAM_EYE, (uint64_t)i);
        const float u_lobe = ppmi_rng_float(&next.rng), u = ppmi_rng_float(&next.rng),
                    v = ppmi_rng_float(&next.rng);
        ppmi_bsdf_sample sample;
        if (!ppmi_bsdf_draw(bsdf, next.world->albedo, bsdf->gather_lobes, PPMI_TRANSPORT_RADIANCE,
                            u_lobe, u, v, &sample)) {
            continue;
        }
        ppmi_vec3 unused = vec3_splat(1.0f);
        const ppmi_ray ray = ppmi_walk_leave(&next, from, &sample, &unused);
        ppmi_vertex vertex;
        ppmi_bsdf there;
        const uint32_t gathered = state->gathered.count;
        if (follow(state, &next, ray, PPMI_RAY_OTHER, 0.0f, spread, &vertex, &there)) {
            keep(&state->lighting, &vertex, 0.0f);
        }
        state->gathered.count = gathered; /* is not seen */
    }
}

static void look(seek_state *state, ppmi_walker *walker, uint32_t i)
{
    const ppmi_seek *seek = state->seek;
    ppmi_walker_start(walker, ppmi_rng_start(0, PPMI_STREAM_EYE, i), 0, i, 0, 0);
    if (seek->around_camera) walker->interior = *seek->around_camera;
    if (seek->shutter_is_open) walker->time = ppmi_rng_float(&walker->rng);
    const float x = ((float)(i % SIDE) + ppmi_rng_float(&walker->rng)) / SIDE;
    const float y = ((float)(i / SIDE) + ppmi_rng_float(&walker->rng)) / SIDE;
    const ppmi_camera_view view = ppmi_camera_view_at(seek->view, walker->time);
    const ppmi_camera_ray ray =
        ppmi_camera_view_ray(&view, seek->x0 + x * seek->width, seek->y0 + y * seek->height);
    const float stride = ppmi_max(seek->width, seek->height) / SIDE;
    ppmi_vertex vertex;
    ppmi_bsdf bsdf;
    if (follow(state, walker, ray.ray, PPMI_RAY_CAMERA, ray.base_width * stride,
               ray.spread * stride, &vertex, &bsdf)) {
        send_importons(state, walker, &vertex, &bsdf);
    }
}

/* ---- surroundings ---------------------------------------------------------------------------- */

static int by_float(const void *a, const void *b)
{
    const float left = *(const float *)a, right = *(const float *)b;
    return (left > right) - (left < right);
}

static float median(const found_list *list, int axis, float *scratch)
{
    for (uint32_t i = 0; i < list->count; i++)
        scratch[i] = vec3_component(list->found[i].target.center, axis);
    qsort(scratch, list->count, sizeof *scratch, by_float);
    return scratch[list->count / 2];
}

typedef struct place_bounds {
    ppmi_vec3 low, high;
} place_bounds;

/* Takes in the places within a radius. Returns how many they are. */
static uint32_t take_in(const found_list *list, ppmi_vec3 middle, float radius,
                        place_bounds *bounds)
{
    uint32_t count = 0;
    for (uint32_t i = 0; i < list->count; i++) {
        const ppmi_vec3 p = list->found[i].target.center;
        if (vec3_length2(vec3_sub(p, middle)) > radius * radius) continue;
        bounds->low = vec3_lower(bounds->low, p);
        bounds->high = vec3_upper(bounds->high, p);
        count++;
    }
    return count;
}

/* The visible points within a radius and what lights them by a bounce from there, with room for
 * what lights these. Returns how many places they are. */
static uint32_t surroundings(const seek_state *state, ppmi_vec3 middle, float radius,
                             ppmi_target *out_target)
{
    const float room = 1.3f, flattest = 0.2f;
    place_bounds bounds = {middle, middle};
    uint32_t count = take_in(&state->gathered, middle, radius, &bounds);
    count += take_in(&state->lighting, middle, radius, &bounds);
    const ppmi_vec3 half = vec3_scale(vec3_sub(bounds.high, bounds.low), 0.5f * room);
    const float least = ppmi_max(flattest * vec3_max_component(half), 1e-6f * radius);
    *out_target = (ppmi_target){vec3_scale(vec3_add(bounds.low, bounds.high), 0.5f),
                                vec3_upper(half, vec3_splat(least))};
    return count;
}

/* What holds half of the visible points, then four times that distance, and so on. A level that
 * adds no place would only take photons from those that do, and one that is about as large as the
 * scene narrows nothing. */
static uint32_t find_levels(const seek_state *state, float *scratch, ppmi_target *targets)
{
    const float step = 4.0f, root_2 = 1.5f, much = 0.75f;
    const found_list *list = &state->gathered;
    if (list->count == 0) return 0;
    const ppmi_vec3 middle =
        vec3(median(list, 0, scratch), median(list, 1, scratch), median(list, 2, scratch));
    for (uint32_t i = 0; i < list->count; i++)
        scratch[i] = vec3_length(vec3_sub(list->found[i].target.center, middle));
    qsort(scratch, list->count, sizeof *scratch, by_float);
    ppmi_vec3 low, high;
    ppmi_scene_bounds(state->seek->world->scene, &low, &high);
    const float whole = 0.5f * vec3_length(vec3_sub(high, low));
    const float largest = 0.5f * vec3_max_component(vec3_sub(high, low));
    float radius = scratch[list->count / 2] * root_2;
    uint32_t count = 0, held = 0;
    for (; count < MAX_LEVELS && radius > 0.0f && radius < whole; radius *= step) {
        const uint32_t holds = surroundings(state, middle, radius, &targets[count]);
        if (vec3_max_component(targets[count].half) >= much * largest) break;
        count += holds > held;
        held = holds;
    }
    return count;
}

/* ---- all ------------------------------------------------------------------------------------- */

static int by_size(const void *a, const void *b)
{
    const float left = vec3_max_component(((const ppmi_found *)a)->target.half);
    const float right = vec3_max_component(((const ppmi_found *)b)->target.half);
    return (left > right) - (left < right);
}

/* Sorted by size; each kind has a share, of which all of its targets have as much. */
static uint32_t share(const ppmi_target *glossy, uint32_t glossy_count, const ppmi_target *levels,
                      uint32_t level_count, ppmi_target *targets, double *shares)
{
    const double of_glossy = 0.5, of_levels = 0.3;
    ppmi_found all[PPMI_AIM_TARGETS];
    uint32_t count = 0;
    for (uint32_t i = 0; i < glossy_count; i++)
        all[count++] = (ppmi_found){.target = glossy[i], .instance = 1};
    for (uint32_t i = 0; i < level_count; i++)
        all[count++] = (ppmi_found){.target = levels[i], .instance = 0};
    qsort(all, count, sizeof *all, by_size);
    double rest = 1.0;
    for (uint32_t i = 0; i < count; i++) {
        targets[i] = all[i].target;
        shares[i] = all[i].instance ? of_glossy / glossy_count : of_levels / level_count;
        rest -= shares[i];
    }
    shares[count] = rest;
    return count;
}

static ppm_status choose_targets(ppm_context *context, seek_state *state, ppmi_target *out_targets,
                                 double *out_shares, uint32_t *out_count)
{
    const ppmi_seek *seek = state->seek;
    float *scratch = ppmi_alloc(context, MAX_FOUND, sizeof *scratch);
    if (!scratch) return ppmi_fail(context, PPM_STATUS_OUT_OF_MEMORY, "out of memory: targets");
    ppmi_target glossy[MAX_GLOSSY], levels[MAX_LEVELS];
    uint32_t glossy_count = 0;
    const ppm_status status =
        ppmi_cluster_found(context, seek->world->scene, state->narrow.found, state->narrow.count,
                           glossy, MAX_GLOSSY, &glossy_count);
    if (status == PPM_STATUS_OK) {
        const uint32_t level_count = find_levels(state, scratch, levels);
        *out_count = share(glossy, glossy_count, levels, level_count, out_targets, out_shares);
    }
    ppmi_free(context, scratch);
    return status;
}

ppm_status ppmi_seek_targets(ppm_context *context, const ppmi_seek *seek,
                             ppmi_target out_targets[PPMI_AIM_TARGETS],
                             double out_shares[PPMI_AIM_TARGETS + 1], uint32_t *out_count,
                             uint64_t *rays)
{
    seek_state state = {.seek = seek};
    state.narrow.found = ppmi_alloc(context, MAX_FOUND, sizeof *state.narrow.found);
    state.gathered.found = ppmi_alloc(context, MAX_FOUND, sizeof *state.gathered.found);
    state.lighting.found = ppmi_alloc(context, MAX_FOUND, sizeof *state.lighting.found);
    ppm_status status = PPM_STATUS_OK;
    if (state.narrow.found && state.gathered.found && state.lighting.found) {
        ppmi_walker walker = {.world = seek->world};
        for (uint32_t i = 0; i < SIDE * SIDE; i++)
            look(&state, &walker, i);
        *rays += walker.rays;
        status = choose_targets(context, &state, out_targets, out_shares, out_count);
    } else {
        status = ppmi_fail(context, PPM_STATUS_OUT_OF_MEMORY, "out of memory: targets");
    }
    ppmi_free(context, state.narrow.found);
    ppmi_free(context, state.gathered.found);
    ppmi_free(context, state.lighting.found);
    return status;
}
