/* The eye pass of progressive photon mapping (Hachisuka, Ogaki, Jensen 2008) and of its stochastic
 * form (Hachisuka and Jensen 2009).
 *
 * The choice between gathering and going on is made lobe by lobe: at each surface the path draws
 * either the group of lobes that gather (and ends there) or the group that goes on, by their
 * albedos. A plastic thus shows its diffuse base by photons and its reflections by tracing. While
 * it may split a path draws nothing: it gathers and goes on by each lobe, through glass and off it.
 */
#include "photon/eye.h"

#include "transport/roulette.h"

/* Paths are not ended by chance before this depth: chains of glass need them. */
enum { ROULETTE_DEPTH = 6 };

/* What a split leaves for later at most: the delta lobes' directions, and one of narrow lobes. */
enum { SPLIT_BRANCHES = PPMI_BSDF_MAX_BRANCHES + 1 };
enum { MAX_BRANCHES = SPLIT_BRANCHES * PPMI_MAX_SPLIT_DEPTH + 1 };

/* Points in the first medium that a path crosses: light in fog is seen best as a sum over the way.
 */
enum { MEDIA_POINTS = 4 };

/* Branches that carry less than this are drawn by chance again. */
static const float least_split_throughput = 1e-3f;

typedef struct eye_branch {
    ppmi_ray ray;
    ppmi_origin origin;
    ppmi_vec3 throughput;       /* for what the path meets next by going on */
    ppmi_vec3 light_throughput; /* for emission that it meets next: all lobes, not the group's */
    float eta_scale;            /* of radiance by refraction, in both */
    float cone_width;
    uint32_t depth, splits, media_splits;
    float merging; /* at the last vertex with narrow lobes, where only mirrors followed; else 0 */
    ppmi_interior interior; /* the walker's, while the branch waits */
    float wavelength_nm;
} eye_branch;

typedef struct eye_path {
    ppm_context *context;
    ppmi_walker *walker;
    const ppmi_eye_settings *settings;
    float cone_spread;
    uint32_t owner;
    ppmi_visible_points *points;
    ppmi_vec3 *radiance;
    const ppmi_light_sink *sink;    /* or NULL; of the branch that is followed: */
    ppmi_eye_history history;       /* of its throughput */
    ppmi_eye_history light_history; /* of its light_throughput */
    ppmi_lamp_deposit lamp_deposit;
    ppmi_eye_history histories[MAX_BRANCHES]; /* of those that wait */
    ppmi_eye_history light_histories[MAX_BRANCHES];
    eye_branch waiting[MAX_BRANCHES];
    ppmi_differential differentials[MAX_BRANCHES]; /* the walker's, of those that wait */
    uint32_t waiting_count;
    bool is_out_of_memory;
} eye_path;

/* A vertex of a branch with what is there. */
typedef struct eye_vertex {
    ppmi_vertex vertex;
    ppmi_bsdf bsdf;
} eye_vertex;

/* False for light that is not finite: it is left out. */
static bool add(eye_path *path, ppmi_vec3 throughput, ppmi_vec3 radiance, ppmi_vec3 *out_added)
{
    *out_added = vec3_mul(throughput, radiance);
    if (!vec3_is_finite(*out_added)) return false;
    *path->radiance = vec3_add(*path->radiance, *out_added);
    return true;
}

static void add_emission(eye_path *path, const ppmi_eye_history *history, const ppmi_vertex *vertex,
                         ppmi_vec3 throughput, ppmi_vec3 radiance)
{
    ppmi_vec3 added;
    if (add(path, throughput, radiance, &added) && path->sink) {
        ppmi_light_sink_add_emission(path->sink, history, vertex, added);
    }
}

static void add_environment(eye_path *path, const ppmi_eye_history *history, ppmi_vec3 direction,
                            ppmi_vec3 throughput, const ppmi_origin *origin)
{
    float mis;
    const ppmi_vec3 radiance = ppmi_walk_environment_weighed(path->walker, direction, origin, &mis);
    ppmi_vec3 added;
    if (add(path, throughput, radiance, &added) && path->sink) {
        ppmi_light_sink_add_far(path->sink, history, direction, vec3_scale(throughput, mis), added);
    }
}

/* What the camera sees behind everything. */
static void add_backdrop(eye_path *path, ppmi_vec3 direction, ppmi_vec3 throughput)
{
    const ppmi_light_sink *sink = path->sink;
    if (sink && sink->is_transparent) {
        sink->seen->through += vec3_mean(throughput);
        return;
    }
    const ppmi_vec3 radiance = ppmi_lights_backdrop(path->walker->world->lights, direction);
    ppmi_vec3 added;
    if (add(path, throughput, radiance, &added) && sink) {
        ppmi_light_sink_add_backdrop(sink, &path->light_history, direction, throughput, added);
    }
}

static void sample_light(eye_path *path, const eye_vertex *at, ppmi_vec3 throughput)
{
    ppmi_light_turn turn = {0};
    do {
        ppmi_lit lit;
        const ppmi_vec3 radiance =
            ppmi_walk_light_sample_of(path->walker, &at->vertex, &at->bsdf, &turn, &lit);
        ppmi_vec3 added;
        if (add(path, throughput, radiance, &added) && path->sink && !vec3_is_black(added)) {
            ppmi_light_sink_add_sample(path->sink, &path->history, &at->bsdf,
                                       path->walker->world->albedo, &lit, throughput, added);
        }
    } while (turn.has_another);
}

/* Around a walk that meets lamps: what it meets goes into lamplight, and one by one to groups. */
static void watch_lamps(eye_path *path, const ppmi_eye_history *history, ppmi_vec3 throughput)
{
    if (!path->sink) return;
    ppmi_lamp_deposit_begin(&path->lamp_deposit, path->walker, path->sink, history, throughput);
}

static void add_lamps(eye_path *path, const ppmi_eye_history *history, ppmi_vec3 throughput,
                      ppmi_vec3 lamplight)
{
    ppmi_vec3 added;
    path->walker->lamp_witness = NULL;
    if (add(path, throughput, lamplight, &added) && path->sink) {
        ppmi_light_sink_add_classes(path->sink, history, PPM_LAYER_EMISSION, added);
    }
}

static void scatter(const eye_path *path, const eye_vertex *at, const ppmi_bsdf_sample *sample,
                    uint32_t mask, ppmi_eye_history *history)
{
    if (!path->sink) return;
    ppmi_eye_history_scatter(history, &at->bsdf, path->walker->world->albedo, sample->wi, mask,
                             sample->is_delta);
}

/* ---- gathering ------------------------------------------------------------------------------- */

/* Side of a square with the area of the pixel's footprint on the surface. */
static float footprint(const eye_branch *branch, const ppmi_bsdf *bsdf)
{
    if (ppmi_bsdf_is_phase(bsdf)) return branch->cone_width;
    const float cosine = fabsf(vec3_dot(branch->ray.direction, bsdf->ng));
    return branch->cone_width / sqrtf(ppmi_max(cosine, 0.1f));
}

static void record(eye_path *path, const eye_branch *branch, const eye_vertex *at,
                   float probability)
{
    const ppmi_visible_point point = {
        .position = at->vertex.surface.position,
        .footprint = footprint(branch, &at->bsdf),
        .throughput = vec3_scale(branch->throughput, 1.0f / probability),
        .owner = path->owner,
        .eye_class = path->sink ? ppmi_eye_history_class(&path->history) : 0,
        .bsdf = at->bsdf,
    };
    if (!ppmi_visible_points_push(path->context, path->points, &point)) {
        path->is_out_of_memory = true;
    }
}

/* Lobes that the path goes on by, and that gather what it may miss on the way: light that comes to
 * them over mirrors or smooth glass. Where colours part by going through, the path has no
 * wavelength yet to gather with. */
static uint32_t narrow_lobes(const eye_path *path, const eye_vertex *at)
{
    if (!(path->settings->photons > 0.0f)) return 0;
    const bool parts = at->vertex.drawn_wavelength > 0.0f;
    return ppmi_narrow_lobes(&at->bsdf) & ~(uint32_t)(parts ? PPMI_LOBE_GLASS : 0);
}

/* Photons of a pass by the area of a disk, of a size as they are gathered in. It only decides who
 * brings which share of the light. */
static float merge_area(const eye_path *path, const eye_branch *branch, const ppmi_bsdf *bsdf)
{
    const float given_m = path->settings->radius_m;
    const float radius_m = given_m > 0.0f ? given_m : 2.0f * footprint(branch, bsdf);
    return path->settings->photons * PPMI_PI * radius_m * radius_m;
}

static void record_narrow(eye_path *path, const eye_branch *branch, const eye_vertex *at)
{
    const uint32_t narrow = narrow_lobes(path, at);
    if (narrow == 0) return;
    eye_vertex only = *at;
    only.bsdf.gather_lobes = (uint8_t)narrow;
    record(path, branch, &only, 1.0f);
    if (path->is_out_of_memory) return;
    path->points->points[path->points->count - 1].merge_area_m2 =
        merge_area(path, branch, &at->bsdf);
}

/* A ray from where the path gathers to the first surface that is more than a thin sheet to it. */
typedef struct light_probe {
    ppmi_origin origin;
    ppmi_ray ray;
    ppmi_vec3 throughput;
} light_probe;

/* Adds the light that a probe meets on its way to the next surface. True if it goes on behind it:
 * straight through a sheet, as the shadow rays that share the light with it. */
static bool meet_light(eye_path *path, const ppmi_eye_history *history, light_probe *probe)
{
    ppmi_walker *walker = path->walker;
    const ppmi_vec3 direction = probe->ray.direction;
    eye_vertex next;
    walker->origin = &probe->origin;
    watch_lamps(path, history, probe->throughput);
    const ppmi_arrival arrival = ppmi_walk(walker, probe->ray, PPMI_RAY_OTHER, &next.vertex);
    walker->origin = NULL;
    add_lamps(path, history, probe->throughput, next.vertex.lamplight);
    probe->throughput = vec3_mul(probe->throughput, next.vertex.transmittance);
    if (arrival == PPMI_ESCAPED) {
        add_environment(path, history, direction, probe->throughput, &probe->origin);
    }
    if (arrival != PPMI_AT_SURFACE) return false;
    add_emission(path, history, &next.vertex, probe->throughput,
                 ppmi_walk_emission(walker, &next.vertex, direction, &probe->origin));
    if (!next.vertex.surface.material->is_sheet) return false;
    ppmi_walk_bsdf(walker, &next.vertex, direction, &next.bsdf);
    const ppmi_vec3 passing = ppmi_bsdf_straight(&next.bsdf, walker->world->albedo);
    probe->throughput = vec3_mul(probe->throughput, passing);
    probe->origin = ppmi_origin_beyond(&probe->origin, &next.vertex);
    probe->ray = ppmi_surface_ray(&next.vertex.surface, direction);
    return !vec3_is_black(probe->throughput);
}

/* The other half of MIS where the path gathers: a direction from the gathering lobes may meet a
 * light. A path that draws its group weighs with all lobes and their whole density, since the group
 * is part of the draw; one that splits with the group's own. */
static void add_bsdf_sampled_light(eye_path *path, const eye_branch *branch, const eye_vertex *at,
                                   bool is_split)
{
    ppmi_walker *walker = path->walker;
    const ppmi_bsdf *bsdf = &at->bsdf;
    const float u_lobe = ppmi_walker_float(walker), u = ppmi_walker_float(walker),
                v = ppmi_walker_float(walker);
    ppmi_bsdf_sample sample;
    if (!ppmi_bsdf_draw(bsdf, walker->world->albedo, bsdf->gather_lobes, PPMI_TRANSPORT_RADIANCE,
                        u_lobe, u, v, &sample)) {
        return;
    }
    const float pdf = ppmi_bsdf_pdf(bsdf, sample.wi, PPMI_LOBE_ALL);
    if (!(pdf > 0.0f)) return;
    ppmi_vec3 weight = sample.weight;
    if (!is_split) {
        const ppmi_vec3 f = ppmi_bsdf_eval(bsdf, walker->world->albedo, sample.wi, PPMI_LOBE_ALL,
                                           PPMI_TRANSPORT_RADIANCE);
        weight = vec3_scale(f, fabsf(ppmi_bsdf_cosine(bsdf, sample.wi)) / pdf);
    }
    ppmi_vec3 throughput = vec3_mul(branch->throughput, weight);
    ppmi_eye_history history;
    if (path->sink) history = path->history;
    scatter(path, at, &sample, is_split ? bsdf->gather_lobes : PPMI_LOBE_ALL, &history);
    const ppmi_interior interior = walker->interior;
    const float wavelength = walker->wavelength_nm;
    ppmi_differential differential;
    ppmi_differential_copy(&differential, &walker->differential);
    light_probe probe = {
        .origin = {.receiver = ppmi_walk_receiver(&at->vertex, bsdf), .pdf = pdf},
        .ray = ppmi_walk_leave(walker, &at->vertex, &sample, &throughput),
    };
    probe.throughput = throughput;
    while (meet_light(path, &history, &probe))
        continue;
    walker->interior = interior;
    walker->wavelength_nm = wavelength;
    ppmi_differential_copy(&walker->differential, &differential);
}

static void gather(eye_path *path, const eye_branch *branch, const eye_vertex *at,
                   float probability, bool is_split)
{
    if (path->settings->samples_lights) add_bsdf_sampled_light(path, branch, at, is_split);
    record(path, branch, at, probability);
}

/* ---- going on -------------------------------------------------------------------------------- */

/* The branch beyond a vertex in a sampled direction. weight: of the direction for what is met by
 * going on, light_weight: for emission that is met next. */
static eye_branch branch_beyond(eye_path *path, const eye_branch *branch, const eye_vertex *at,
                                const ppmi_bsdf_sample *sample, ppmi_vec3 weight,
                                ppmi_vec3 light_weight)
{
    ppmi_walker *walker = path->walker;
    const bool is_weighed = path->settings->samples_lights && !sample->is_delta;
    eye_branch next = *branch;
    ppmi_vec3 cost = vec3_splat(1.0f);
    next.ray = ppmi_walk_leave(walker, &at->vertex, sample, &cost);
    next.throughput = vec3_mul(vec3_mul(branch->throughput, weight), cost);
    next.light_throughput = vec3_mul(vec3_mul(branch->throughput, light_weight), cost);
    next.eta_scale *= sample->eta_scale;
    next.origin = (ppmi_origin){.receiver = ppmi_walk_receiver(&at->vertex, &at->bsdf),
                                .is_delta = !is_weighed};
    if (is_weighed) next.origin.pdf = ppmi_bsdf_pdf(&at->bsdf, sample->wi, PPMI_LOBE_ALL);
    if (!sample->is_delta) {
        const uint32_t narrow = narrow_lobes(path, at);
        next.merging =
            ppmi_merging(&at->bsdf, narrow, merge_area(path, branch, &at->bsdf), sample->wi);
    }
    /* light that comes straight to a vertex is sampled there, unless photons bring it too */
    if (sample->is_delta || !path->settings->samples_lights) next.origin.merging = next.merging;
    if (ppmi_bsdf_goes_straight(&at->bsdf, sample)) {
        next.origin = ppmi_origin_beyond(&branch->origin, &at->vertex);
        next.light_throughput = vec3_mul(vec3_mul(branch->light_throughput, light_weight), cost);
    }
    next.interior = walker->interior;
    next.wavelength_nm = walker->wavelength_nm;
    next.depth = branch->depth + 1;
    return next;
}

static bool draw(eye_path *path, const eye_vertex *at, uint32_t mask, ppmi_bsdf_sample *sample)
{
    ppmi_walker *walker = path->walker;
    const float u_lobe = ppmi_walker_float(walker), u = ppmi_walker_float(walker),
                v = ppmi_walker_float(walker);
    return ppmi_bsdf_draw(&at->bsdf, walker->world->albedo, mask, PPMI_TRANSPORT_RADIANCE, u_lobe,
                          u, v, sample);
}

/* Goes on by the lobes that do not gather. Emission met next is weighed with all lobes and their
 * full density, since light sampling here stood for all of them. */
static bool go_on(eye_path *path, eye_branch *branch, const eye_vertex *at, uint32_t mask,
                  float probability)
{
    ppmi_bsdf_sample sample;
    if (!draw(path, at, mask, &sample)) return false;
    const ppmi_vec3 weight = vec3_scale(sample.weight, 1.0f / probability);
    ppmi_vec3 light_weight = weight;
    if (path->sink && !ppmi_bsdf_goes_straight(&at->bsdf, &sample)) {
        path->light_history = path->history;
    }
    const bool is_weighed = !sample.is_delta && path->settings->samples_lights;
    scatter(path, at, &sample, mask, &path->history);
    scatter(path, at, &sample, is_weighed ? PPMI_LOBE_ALL : mask, &path->light_history);
    if (is_weighed) {
        const ppmi_vec3 f = ppmi_bsdf_eval(&at->bsdf, path->walker->world->albedo, sample.wi,
                                           PPMI_LOBE_ALL, PPMI_TRANSPORT_RADIANCE);
        const float pdf = ppmi_bsdf_pdf(&at->bsdf, sample.wi, PPMI_LOBE_ALL);
        light_weight = vec3_scale(f, fabsf(ppmi_bsdf_cosine(&at->bsdf, sample.wi)) / pdf);
    }
    *branch = branch_beyond(path, branch, at, &sample, weight, light_weight);
    return true;
}

/* Those of a branch that is put off. */
static void keep_histories(eye_path *path, const eye_vertex *at, const ppmi_bsdf_sample *sample,
                           uint32_t mask)
{
    ppmi_eye_history *history = &path->histories[path->waiting_count];
    ppmi_eye_history *light_history = &path->light_histories[path->waiting_count];
    const bool goes_straight = ppmi_bsdf_goes_straight(&at->bsdf, sample);
    *history = path->history;
    *light_history = goes_straight ? path->light_history : path->history;
    scatter(path, at, sample, mask, history);
    scatter(path, at, sample, mask, light_history);
}

static void put_off(eye_path *path, const eye_branch *branch, const eye_vertex *at, uint32_t mask,
                    const ppmi_bsdf_sample *sample)
{
    const ppmi_interior interior = path->walker->interior;
    const float wavelength = path->walker->wavelength_nm;
    ppmi_differential differential;
    ppmi_differential_copy(&differential, &path->walker->differential);
    eye_branch next = branch_beyond(path, branch, at, sample, sample->weight, sample->weight);
    next.splits++;
    path->walker->interior = interior;
    path->walker->wavelength_nm = wavelength;
    if (!vec3_is_black(next.throughput) || !vec3_is_black(next.light_throughput)) {
        ppmi_differential_copy(&path->differentials[path->waiting_count],
                               &path->walker->differential);
        if (path->sink) {
            keep_histories(path, at, sample, mask);
        }
        path->waiting[path->waiting_count++] = next;
    }
    ppmi_differential_copy(&path->walker->differential, &differential);
}

/* Puts off one branch for each direction of the delta lobes, and one for the narrow lobes. */
static void split(eye_path *path, const eye_branch *branch, const eye_vertex *at, uint32_t mask)
{
    ppmi_bsdf_sample samples[PPMI_BSDF_MAX_BRANCHES];
    const uint32_t count = ppmi_bsdf_branches(&at->bsdf, path->walker->world->albedo, mask,
                                              PPMI_TRANSPORT_RADIANCE, samples);
    for (uint32_t i = 0; i < count; i++)
        put_off(path, branch, at, mask, &samples[i]);
    const uint32_t narrow = mask & (uint32_t)~at->bsdf.delta_lobes;
    ppmi_bsdf_sample sample;
    if (narrow != 0 && draw(path, at, narrow, &sample)) put_off(path, branch, at, narrow, &sample);
}

static bool may_split(const eye_path *path, const eye_branch *branch)
{
    return branch->splits < path->settings->split_depth &&
           path->waiting_count + SPLIT_BRANCHES <= MAX_BRANCHES &&
           vec3_max_component(branch->throughput) > least_split_throughput;
}

/* ---- a path ---------------------------------------------------------------------------------- */

static bool survives_roulette(ppmi_walker *walker, eye_branch *branch)
{
    if (branch->depth < ROULETTE_DEPTH) return true;
    const float importance = vec3_max_component(branch->throughput) / branch->eta_scale;
    const float survival = ppmi_roulette_survival(importance, branch->depth, PPMI_ROULETTE_OF_EYE);
    if (ppmi_rng_float(&walker->rng) >= survival) return false;
    branch->throughput = vec3_scale(branch->throughput, 1.0f / survival);
    branch->light_throughput = vec3_scale(branch->light_throughput, 1.0f / survival);
    return true;
}

/* Gathers where a medium scatters the path on the way to its next vertex. */
static void scatter_on_the_way(eye_path *path, const eye_branch *branch,
                               const ppmi_vertex *scattered)
{
    eye_vertex at = {.vertex = *scattered};
    eye_branch in_medium = *branch;
    in_medium.throughput = vec3_mul(branch->throughput, scattered->transmittance);
    in_medium.cone_width += path->cone_spread * scattered->distance;
    ppmi_walk_bsdf(path->walker, &at.vertex, branch->ray.direction, &at.bsdf);
    if (path->settings->samples_lights) {
        sample_light(path, &at, in_medium.throughput);
    }
    gather(path, &in_medium, &at, 1.0f, false);
}

/* Follows the branch's ray. A path in media goes both ways at first: what it meets in the medium is
 * gathered at once. */
static ppmi_arrival walk(eye_path *path, eye_branch *branch, ppmi_vertex *vertex)
{
    ppmi_walker *walker = path->walker;
    const ppmi_ray_kind kind = branch->depth == 0 ? PPMI_RAY_CAMERA : PPMI_RAY_OTHER;
    walker->origin = &branch->origin;
    watch_lamps(path, &path->light_history, branch->light_throughput);
    if (!walker->world->has_scattering || branch->media_splits >= path->settings->media_depth) {
        const ppmi_arrival arrival = ppmi_walk(walker, branch->ray, kind, vertex);
        walker->origin = NULL;
        walker->lamp_witness = NULL;
        return arrival;
    }
    ppmi_vertex scattered[MEDIA_POINTS];
    const uint32_t count = branch->media_splits == 0 ? MEDIA_POINTS : 1;
    const ppmi_interior before = walker->interior;
    const ppmi_arrival arrival =
        ppmi_walk_both_ways(walker, branch->ray, kind, vertex, scattered, count);
    walker->origin = NULL;
    walker->lamp_witness = NULL;
    const ppmi_interior after = walker->interior;
    walker->interior = before;
    for (uint32_t i = 0; i < count; i++) {
        if (scattered[i].medium) scatter_on_the_way(path, branch, &scattered[i]);
    }
    if (scattered[0].medium) branch->media_splits++;
    walker->interior = after;
    return arrival;
}

/* To the branch's next vertex, with the light that is met there. False where the branch ends. */
static bool arrive(eye_path *path, eye_branch *branch, eye_vertex *at)
{
    ppmi_walker *walker = path->walker;
    const ppmi_arrival arrival = walk(path, branch, &at->vertex);
    const ppmi_vec3 transmittance = at->vertex.transmittance;
    add_lamps(path, &path->light_history, branch->light_throughput, at->vertex.lamplight);
    branch->throughput = vec3_mul(branch->throughput, transmittance);
    branch->light_throughput = vec3_mul(branch->light_throughput, transmittance);
    if (arrival == PPMI_ESCAPED) {
        const ppmi_vec3 direction = branch->ray.direction;
        if (branch->depth == 0) {
            add_backdrop(path, direction, branch->light_throughput);
        } else {
            add_environment(path, &path->light_history, direction, branch->light_throughput,
                            &branch->origin);
        }
        return false;
    }
    branch->cone_width += path->cone_spread * at->vertex.distance;
    if (arrival == PPMI_AT_SURFACE) {
        if (branch->depth == 0 && path->sink) {
            ppmi_light_sink_see(path->sink, walker->world, &at->vertex);
        }
        add_emission(
            path, &path->light_history, &at->vertex, branch->light_throughput,
            ppmi_walk_emission(walker, &at->vertex, branch->ray.direction, &branch->origin));
    }
    if (!survives_roulette(walker, branch)) return false;
    ppmi_walk_bsdf(walker, &at->vertex, branch->ray.direction, &at->bsdf);
    return at->bsdf.lobes != 0;
}

/* Follows a branch to its end. */
static void follow(eye_path *path, eye_branch branch)
{
    eye_vertex at;
    while (branch.depth < path->settings->max_depth && arrive(path, &branch, &at)) {
        if (path->settings->samples_lights) sample_light(path, &at, branch.throughput);
        record_narrow(path, &branch, &at);
        const uint32_t others = (uint32_t)(at.bsdf.lobes & ~at.bsdf.gather_lobes);
        const float gathering = ppmi_bsdf_probability(&at.bsdf, at.bsdf.gather_lobes);
        if (may_split(path, &branch)) {
            const bool is_split = others != 0;
            split(path, &branch, &at, others);
            if (gathering > 0.0f) gather(path, &branch, &at, 1.0f, is_split);
            return;
        }
        if (gathering > 0.0f && ppmi_walker_float(path->walker) < gathering) {
            gather(path, &branch, &at, gathering, false);
            return;
        }
        if (!go_on(path, &branch, &at, others, 1.0f - gathering)) return;
    }
}

bool ppmi_eye_path(ppm_context *context, ppmi_walker *walker, const ppmi_camera_ray *camera_ray,
                   const ppmi_eye_settings *settings, uint32_t owner, ppmi_visible_points *points,
                   ppmi_vec3 *radiance, const ppmi_light_sink *sink)
{
    eye_path path;
    path.context = context;
    path.walker = walker;
    path.settings = settings;
    path.cone_spread = camera_ray->spread;
    path.owner = owner;
    path.points = points;
    path.radiance = radiance;
    path.sink = sink;
    path.waiting_count = 1;
    path.is_out_of_memory = false;
    path.waiting[0] = (eye_branch){
        .ray = camera_ray->ray,
        .origin = {.is_delta = true},
        .throughput = vec3_splat(1.0f),
        .light_throughput = vec3_splat(1.0f),
        .eta_scale = 1.0f,
        .cone_width = camera_ray->base_width,
        .interior = walker->interior,
        .wavelength_nm = walker->wavelength_nm,
    };
    if (sink) path.histories[0] = path.light_histories[0] = ppmi_eye_history_start();
    ppmi_differential_copy(&path.differentials[0], &walker->differential);
    while (path.waiting_count > 0) {
        const eye_branch branch = path.waiting[--path.waiting_count];
        walker->interior = branch.interior;
        walker->wavelength_nm = branch.wavelength_nm;
        ppmi_differential_copy(&walker->differential, &path.differentials[path.waiting_count]);
        if (sink) {
            path.history = path.histories[path.waiting_count];
            path.light_history = path.light_histories[path.waiting_count];
        }
        follow(&path, branch);
    }
    return !path.is_out_of_memory;
}
