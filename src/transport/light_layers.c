/* Classes and groups of light. */
#include "transport/light_layers.h"

/* Lobes that reflect diffusely in the sense of the layers DIFFUSE_. */
enum { DIFFUSE_LOBES = PPMI_LOBE_WIDE | PPMI_LOBE_SHEEN };

/* ---- lobes ----------------------------------------------------------------------------------- */

static float channel_share(float part, float whole)
{
    return whole > 0.0f ? ppmi_clampf(part / whole, 0.0f, 1.0f) : 0.0f;
}

/* What part of f the lobes in part have, of those in mask that are not delta. */
static ppmi_vec3 lobe_share(const ppmi_bsdf *bsdf, const ppmi_albedo_table *albedo, ppmi_vec3 wi,
                            uint32_t part, uint32_t mask, ppmi_transport transport)
{
    mask &= (uint32_t)(bsdf->lobes & ~bsdf->delta_lobes);
    part &= mask;
    if (part == mask) return vec3_splat(1.0f);
    if (part == 0) return vec3_splat(0.0f);
    const ppmi_vec3 f = ppmi_bsdf_eval(bsdf, albedo, wi, mask, transport);
    const ppmi_vec3 of_part = ppmi_bsdf_eval(bsdf, albedo, wi, part, transport);
    return vec3(channel_share(of_part.x, f.x), channel_share(of_part.y, f.y),
                channel_share(of_part.z, f.z));
}

static ppmi_vec3 rest_of(ppmi_vec3 share)
{
    return vec3_sub(vec3_splat(1.0f), share);
}

/* ---- eye paths ------------------------------------------------------------------------------- */

/* Shares of the lobes at a vertex along wi: all that gather, and those of them that are diffuse. */
typedef struct scattering {
    ppmi_vec3 gathering, diffuse;
    bool is_transmission;
} scattering;

static scattering scattering_of(const ppmi_bsdf *bsdf, const ppmi_albedo_table *albedo,
                                ppmi_vec3 wi, uint32_t mask, bool is_delta)
{
    scattering s = {.is_transmission = vec3_dot(wi, bsdf->ng) < 0.0f};
    if (is_delta) return s;
    s.gathering = lobe_share(bsdf, albedo, wi, bsdf->gather_lobes, mask, PPMI_TRANSPORT_RADIANCE);
    if (!s.is_transmission) {
        s.diffuse = lobe_share(bsdf, albedo, wi, DIFFUSE_LOBES, mask, PPMI_TRANSPORT_RADIANCE);
        s.diffuse = vec3(ppmi_min(s.diffuse.x, s.gathering.x), ppmi_min(s.diffuse.y, s.gathering.y),
                         ppmi_min(s.diffuse.z, s.gathering.z));
    }
    return s;
}

/* Light goes on through a thin sheet as if it were not there. */
static bool goes_straight(const ppmi_bsdf *bsdf, ppmi_vec3 wi, bool is_delta)
{
    return is_delta && bsdf->is_thin && vec3_dot(wi, bsdf->ng) < 0.0f;
}

static void scatter_first(ppmi_eye_history *history, const scattering *s)
{
    history->vertices = 1;
    if (s->is_transmission) {
        history->classes[0] = PPM_LAYER_TRANSMISSION;
        history->share[0][PPMI_EYE_DIFFUSE] = s->gathering;
        history->share[0][PPMI_EYE_SPECULAR] = rest_of(s->gathering);
        return;
    }
    history->classes[0] = PPM_LAYER_DIFFUSE_DIRECT;
    history->classes[1] = PPM_LAYER_GLOSSY_DIRECT;
    history->share[0][PPMI_EYE_DIFFUSE] = s->diffuse;
    history->share[1][PPMI_EYE_DIFFUSE] = vec3_sub(s->gathering, s->diffuse);
    history->share[1][PPMI_EYE_SPECULAR] = rest_of(s->gathering);
}

static void scatter_on(ppmi_vec3 share[PPMI_EYE_TAILS], const scattering *s)
{
    const ppmi_vec3 before = share[PPMI_EYE_SPECULAR];
    const ppmi_vec3 diffuse = vec3_add(share[PPMI_EYE_DIFFUSE], share[PPMI_EYE_DIFFUSE_SPECULAR]);
    const ppmi_vec3 specular = rest_of(s->gathering);
    share[PPMI_EYE_SPECULAR] = vec3_mul(before, specular);
    share[PPMI_EYE_DIFFUSE] = vec3_mul(vec3_add(before, diffuse), s->gathering);
    share[PPMI_EYE_DIFFUSE_SPECULAR] = vec3_mul(diffuse, specular);
}

/* Light that comes to a vertex in a medium is no caustic. */
static void scatter_in_medium(ppmi_eye_history *history)
{
    if (history->vertices == 0) {
        history->classes[0] = PPM_LAYER_VOLUME;
        history->share[0][PPMI_EYE_SPECULAR] = vec3_splat(1.0f);
        history->vertices = 1;
        return;
    }
    history->vertices = 2;
    for (int i = 0; i < 2; i++) {
        ppmi_vec3 *share = history->share[i];
        share[PPMI_EYE_SPECULAR] =
            vec3_add(share[PPMI_EYE_SPECULAR],
                     vec3_add(share[PPMI_EYE_DIFFUSE], share[PPMI_EYE_DIFFUSE_SPECULAR]));
        share[PPMI_EYE_DIFFUSE] = share[PPMI_EYE_DIFFUSE_SPECULAR] = vec3_splat(0.0f);
    }
}

void ppmi_eye_history_scatter(ppmi_eye_history *history, const ppmi_bsdf *bsdf,
                              const ppmi_albedo_table *albedo, ppmi_vec3 wi, uint32_t mask,
                              bool is_delta)
{
    if (ppmi_bsdf_is_phase(bsdf)) {
        scatter_in_medium(history);
        return;
    }
    const scattering s = scattering_of(bsdf, albedo, wi, mask, is_delta);
    if (history->vertices == 0) {
        scatter_first(history, &s);
        return;
    }
    if (goes_straight(bsdf, wi, is_delta)) return;
    history->vertices = 2;
    scatter_on(history->share[0], &s);
    scatter_on(history->share[1], &s);
}

/* ---- planes ---------------------------------------------------------------------------------- */

static void add_to(const ppmi_light_sink *sink, int32_t plane, ppmi_vec3 radiance)
{
    if (plane >= 0 && vec3_is_finite(radiance)) {
        sink->values[plane] = vec3_add(sink->values[plane], radiance);
    }
}

static void add_to_class(const ppmi_light_sink *sink, int32_t kind, ppmi_vec3 radiance)
{
    add_to(sink, sink->planes->of_class[kind], radiance);
}

static void add_to_group(const ppmi_light_sink *sink, uint32_t group, ppmi_vec3 radiance,
                         ppmi_vec3 caustic)
{
    const ppmi_light_planes *planes = sink->planes;
    if (!planes->groups || group >= planes->groups->count) return;
    if (planes->of_group >= 0) add_to(sink, planes->of_group + (int32_t)group, radiance);
    if (planes->of_group_caustics >= 0) {
        add_to(sink, planes->of_group_caustics + (int32_t)group, vec3_mul(radiance, caustic));
    }
}

static int32_t indirect(int32_t kind)
{
    if (kind == PPM_LAYER_DIFFUSE_DIRECT) return PPM_LAYER_DIFFUSE_INDIRECT;
    return kind == PPM_LAYER_GLOSSY_DIRECT ? PPM_LAYER_GLOSSY_INDIRECT : kind;
}

static ppmi_vec3 caustic_share(const ppmi_eye_history *history)
{
    return vec3_add(history->share[0][PPMI_EYE_DIFFUSE_SPECULAR],
                    history->share[1][PPMI_EYE_DIFFUSE_SPECULAR]);
}

void ppmi_light_sink_add_classes(const ppmi_light_sink *sink, const ppmi_eye_history *history,
                                 int32_t seen, ppmi_vec3 radiance)
{
    if (history->vertices == 0) {
        add_to_class(sink, seen, radiance);
        return;
    }
    add_to_class(sink, PPM_LAYER_CAUSTICS, vec3_mul(radiance, caustic_share(history)));
    for (int i = 0; i < 2 && history->classes[i] != 0; i++) {
        const int32_t kind =
            history->vertices == 1 ? history->classes[i] : indirect(history->classes[i]);
        const ppmi_vec3 share =
            vec3_add(history->share[i][PPMI_EYE_SPECULAR], history->share[i][PPMI_EYE_DIFFUSE]);
        add_to_class(sink, kind, vec3_mul(radiance, share));
    }
}

void ppmi_light_sink_add_group(const ppmi_light_sink *sink, const ppmi_eye_history *history,
                               uint32_t group, ppmi_vec3 radiance)
{
    add_to_group(sink, group, radiance, caustic_share(history));
}

void ppmi_light_sink_add_emission(const ppmi_light_sink *sink, const ppmi_eye_history *history,
                                  const ppmi_vertex *vertex, ppmi_vec3 radiance)
{
    ppmi_light_sink_add_classes(sink, history, PPM_LAYER_EMISSION, radiance);
    if (!sink->planes->groups) return;
    const uint32_t group = sink->planes->groups->of_instance[vertex->hit.instance];
    ppmi_light_sink_add_group(sink, history, group, radiance);
}

void ppmi_light_sink_add_far(const ppmi_light_sink *sink, const ppmi_eye_history *history,
                             ppmi_vec3 direction, ppmi_vec3 weight, ppmi_vec3 light)
{
    ppmi_light_sink_add_classes(sink, history, PPM_LAYER_ENVIRONMENT, light);
    const ppmi_light_planes *planes = sink->planes;
    if (!planes->groups) return;
    ppmi_vec3 radiance;
    uint32_t emitter;
    for (uint32_t i = 0; ppmi_lights_far_part(planes->lights, direction, i, &radiance, &emitter);
         i++) {
        if (vec3_is_black(radiance)) continue;
        const uint32_t group = ppmi_light_groups_of(planes->groups, planes->lights, emitter);
        ppmi_light_sink_add_group(sink, history, group, vec3_mul(radiance, weight));
    }
}

void ppmi_light_sink_add_backdrop(const ppmi_light_sink *sink, const ppmi_eye_history *history,
                                  ppmi_vec3 direction, ppmi_vec3 weight, ppmi_vec3 light)
{
    if (!ppmi_lights_has_backdrop(sink->planes->lights)) {
        ppmi_light_sink_add_far(sink, history, direction, weight, light);
        return;
    }
    ppmi_light_sink_add_classes(sink, history, PPM_LAYER_ENVIRONMENT, light);
    if (!sink->planes->groups) return;
    ppmi_light_sink_add_group(sink, history, sink->planes->groups->of_environment, light);
}

void ppmi_light_sink_add_sample(const ppmi_light_sink *sink, const ppmi_eye_history *history,
                                const ppmi_bsdf *bsdf, const ppmi_albedo_table *albedo,
                                const ppmi_lit *lit, ppmi_vec3 throughput, ppmi_vec3 radiance)
{
    const ppmi_light_planes *planes = sink->planes;
    const ppmi_light_sample *light = &lit->light;
    ppmi_eye_history here = *history;
    ppmi_eye_history_scatter(&here, bsdf, albedo, light->wi, PPMI_LOBE_ALL, false);
    if (light->is_far && !light->is_delta) {
        ppmi_light_sink_add_far(sink, &here, light->wi, vec3_mul(throughput, lit->weight),
                                radiance);
        return;
    }
    ppmi_light_sink_add_classes(sink, &here, 0, radiance);
    if (!planes->groups) return;
    const uint32_t group = ppmi_light_groups_of(planes->groups, planes->lights, light->emitter);
    ppmi_light_sink_add_group(sink, &here, group, radiance);
}

static void see_lamp(const ppmi_lamp_witness *witness, uint32_t emitter, ppmi_vec3 light)
{
    const ppmi_lamp_deposit *deposit = (const ppmi_lamp_deposit *)witness;
    const ppmi_light_planes *planes = deposit->sink->planes;
    const uint32_t group = ppmi_light_groups_of(planes->groups, planes->lights, emitter);
    ppmi_light_sink_add_group(deposit->sink, deposit->history, group,
                              vec3_mul(deposit->throughput, light));
}

void ppmi_lamp_deposit_begin(ppmi_lamp_deposit *deposit, ppmi_walker *walker,
                             const ppmi_light_sink *sink, const ppmi_eye_history *history,
                             ppmi_vec3 throughput)
{
    if (!sink->planes->groups) return;
    *deposit = (ppmi_lamp_deposit){{see_lamp}, sink, history, throughput};
    walker->lamp_witness = &deposit->witness;
}

/* ---- photons --------------------------------------------------------------------------------- */

void ppmi_photon_history_scatter(ppmi_photon_history *history, const ppmi_bsdf *bsdf,
                                 const ppmi_albedo_table *albedo, ppmi_vec3 wi, bool is_delta)
{
    if (goes_straight(bsdf, wi, is_delta)) return;
    const bool was_straight = history->is_straight;
    history->is_straight = false;
    if (ppmi_bsdf_is_phase(bsdf)) {
        history->specular = vec3_splat(0.0f);
        return;
    }
    if (is_delta) return;
    const ppmi_vec3 gathering =
        lobe_share(bsdf, albedo, wi, bsdf->gather_lobes, PPMI_LOBE_ALL, PPMI_TRANSPORT_POWER);
    if (!was_straight) {
        history->caustic = vec3_add(history->caustic, vec3_mul(history->specular, gathering));
    }
    history->specular = vec3_mul(history->specular, rest_of(gathering));
}

ppmi_vec3 ppmi_photon_history_caustic(const ppmi_photon_history *history, bool is_in_medium)
{
    if (history->is_straight) return vec3_splat(0.0f);
    return is_in_medium ? history->caustic : vec3_add(history->caustic, history->specular);
}

static void add_first_vertex(const ppmi_light_sink *sink, const ppmi_bsdf *bsdf,
                             const ppmi_albedo_table *albedo, const ppmi_photon_light *light,
                             ppmi_vec3 radiance)
{
    if (ppmi_bsdf_is_phase(bsdf)) {
        add_to_class(sink, PPM_LAYER_VOLUME, radiance);
        return;
    }
    if (vec3_dot(light->wi, bsdf->ng) < 0.0f) {
        add_to_class(sink, PPM_LAYER_TRANSMISSION, radiance);
        return;
    }
    const ppmi_vec3 diffuse = lobe_share(bsdf, albedo, light->wi, DIFFUSE_LOBES, bsdf->gather_lobes,
                                         PPMI_TRANSPORT_RADIANCE);
    const int32_t diffuse_class =
        light->is_straight ? PPM_LAYER_DIFFUSE_DIRECT : PPM_LAYER_DIFFUSE_INDIRECT;
    const int32_t glossy_class =
        light->is_straight ? PPM_LAYER_GLOSSY_DIRECT : PPM_LAYER_GLOSSY_INDIRECT;
    add_to_class(sink, diffuse_class, vec3_mul(radiance, diffuse));
    add_to_class(sink, glossy_class, vec3_mul(radiance, rest_of(diffuse)));
}

void ppmi_light_sink_add_photon(const ppmi_light_sink *sink, int32_t eye_class,
                                const ppmi_bsdf *bsdf, const ppmi_albedo_table *albedo,
                                const ppmi_photon_light *light)
{
    const ppmi_vec3 other = vec3_mul(light->radiance, rest_of(light->caustic));
    add_to_class(sink, PPM_LAYER_CAUSTICS, vec3_mul(light->radiance, light->caustic));
    if (eye_class == 0) {
        add_first_vertex(sink, bsdf, albedo, light, other);
    } else {
        add_to_class(sink, indirect(eye_class), other);
    }
    add_to_group(sink, light->group, light->radiance, light->caustic);
}
