/* Layers of light: whose every bit of light is, and which part of a picture it goes to.
 *
 * A class of light is one of PPM_LAYER_DIFFUSE_DIRECT .. VOLUME. It is told by the light's path
 * from the lamp to the eye. At a vertex a lobe is diffuse in the sense of CAUSTICS if it gathers
 * (ppmi_bsdf.gather_lobes), else specular: mirrors, smooth glass, and lobes too narrow for photons.
 *
 *   EMISSION, ENVIRONMENT  no vertex between: seen straight, or through alpha
 *   CAUSTICS               from the light on, the path meets one or more specular lobes and then a
 *                          diffuse one on a surface, whatever comes after: L S+ D .* E
 *
 * and else by the eye's first vertex:
 *
 *   VOLUME                 in a medium
 *   TRANSMISSION           a surface, to its other side (diffuse transmission too)
 *   DIFFUSE_               a surface, by the lobes WIDE and SHEEN to the same side
 *   GLOSSY_                a surface, by any other lobe to the same side; a mirror too
 *
 * _DIRECT if that vertex is the only one, _INDIRECT if not. Light whose first vertex is in a medium
 * is no caustic.
 *
 * What goes straight through a thin sheet, as shadow rays do, meets no vertex there; but the first
 * that the eye sees is one.
 *
 * Where a surface has several lobes, their shares in f part the light, colour by colour: layers
 * neither depend on which lobe a direction was drawn from, nor on the integrator. */
#ifndef PPMI_TRANSPORT_LIGHT_LAYERS_H
#define PPMI_TRANSPORT_LIGHT_LAYERS_H

#include "light/light_groups.h"
#include "ppm/render.h"
#include "transport/world.h"

/* Which planes a pixel has; -1: is not there. */
typedef struct ppmi_light_planes {
    const ppmi_lights *lights;
    const ppmi_light_groups *groups;        /* NULL: none are wanted */
    int32_t of_class[PPM_LAYER_VOLUME + 1]; /* by PPM_LAYER_ */
    int32_t of_group;                       /* of the first; the others follow */
    int32_t of_group_caustics;
    uint32_t count;
} ppmi_light_planes;

/* What the camera sees straight by a path. */
typedef struct ppmi_light_seen {
    float through;   /* share of the path that sees the environment */
    bool is_catcher; /* its first surface is a catcher's */
} ppmi_light_seen;

/* Where a path's light goes beside the picture. */
typedef struct ppmi_light_sink {
    const ppmi_light_planes *planes;
    ppmi_vec3 *values;     /* planes->count, of the pixel */
    ppmi_light_seen *seen; /* filled in */
    bool is_transparent;   /* the environment that is seen straight is left out */
} ppmi_light_sink;

/* ---- eye paths ------------------------------------------------------------------------------- */

/* What an eye path has met, as far as light's class depends on it. share: of its throughput, by the
 * class at the first vertex and what came after. */
enum { PPMI_EYE_SPECULAR, PPMI_EYE_DIFFUSE, PPMI_EYE_DIFFUSE_SPECULAR, PPMI_EYE_TAILS };
typedef struct ppmi_eye_history {
    uint32_t vertices;                  /* 0, 1, more: 2 */
    int32_t classes[2];                 /* PPM_LAYER_, direct where there is a choice; 0: none */
    ppmi_vec3 share[2][PPMI_EYE_TAILS]; /* of classes[0] and [1], by the latest vertex: specular, or
                                           in a medium; diffuse; specular after diffuse */
} ppmi_eye_history;

static inline ppmi_eye_history ppmi_eye_history_start(void)
{
    return (ppmi_eye_history){0};
}

/* The class at the first vertex of a path that came over lobes of one side that do not gather, as a
 * photon mapper's do; 0: it has no vertex yet. */
static inline int32_t ppmi_eye_history_class(const ppmi_eye_history *history)
{
    return history->classes[1] != 0 ? history->classes[1] : history->classes[0];
}

/* The path goes on at a surface or in a medium along wi, by the lobes in mask of which none, or the
 * one that was drawn, is delta. */
void ppmi_eye_history_scatter(ppmi_eye_history *history, const ppmi_bsdf *bsdf,
                              const ppmi_albedo_table *albedo, ppmi_vec3 wi, uint32_t mask,
                              bool is_delta);

/* The path meets its first surface. */
static inline void ppmi_light_sink_see(const ppmi_light_sink *sink, const ppmi_world *world,
                                       const ppmi_vertex *vertex)
{
    sink->seen->is_catcher = world->scene->instances[vertex->hit.instance].is_catcher;
}

/* ---- deposits -------------------------------------------------------------------------------- */

/* Light that the path meets now; seen: its class if it is seen straight. */
void ppmi_light_sink_add_classes(const ppmi_light_sink *sink, const ppmi_eye_history *history,
                                 int32_t seen, ppmi_vec3 radiance);
void ppmi_light_sink_add_group(const ppmi_light_sink *sink, const ppmi_eye_history *history,
                               uint32_t group, ppmi_vec3 radiance);

/* Both, of a surface's emission. */
void ppmi_light_sink_add_emission(const ppmi_light_sink *sink, const ppmi_eye_history *history,
                                  const ppmi_vertex *vertex, ppmi_vec3 radiance);

/* Both, of the backdrop or environment in a direction. weight: of its radiance in light. */
void ppmi_light_sink_add_backdrop(const ppmi_light_sink *sink, const ppmi_eye_history *history,
                                  ppmi_vec3 direction, ppmi_vec3 weight, ppmi_vec3 light);
void ppmi_light_sink_add_far(const ppmi_light_sink *sink, const ppmi_eye_history *history,
                             ppmi_vec3 direction, ppmi_vec3 weight, ppmi_vec3 light);

/* Both, of a light sample at a vertex that the history ends before; radiance: all of it, that is
 * throughput * lit->weight * lit->light.radiance. */
void ppmi_light_sink_add_sample(const ppmi_light_sink *sink, const ppmi_eye_history *history,
                                const ppmi_bsdf *bsdf, const ppmi_albedo_table *albedo,
                                const ppmi_lit *lit, ppmi_vec3 throughput, ppmi_vec3 radiance);

/* A witness of lamps that gives each its group's part of what the path meets with throughput. */
typedef struct ppmi_lamp_deposit {
    ppmi_lamp_witness witness;
    const ppmi_light_sink *sink;
    const ppmi_eye_history *history;
    ppmi_vec3 throughput;
} ppmi_lamp_deposit;

/* Begins to watch the walker's next way; the deposit must live as long. */
void ppmi_lamp_deposit_begin(ppmi_lamp_deposit *deposit, ppmi_walker *walker,
                             const ppmi_light_sink *sink, const ppmi_eye_history *history,
                             ppmi_vec3 throughput);

/* ---- photons --------------------------------------------------------------------------------- */

/* What a photon has met since it left its light: share of its power that came over specular
 * vertices only, and that of caustics. */
typedef struct ppmi_photon_history {
    ppmi_vec3 specular, caustic;
    bool is_straight; /* no vertex yet */
} ppmi_photon_history;

static inline ppmi_photon_history ppmi_photon_history_start(void)
{
    return (ppmi_photon_history){.specular = {1.0f, 1.0f, 1.0f}, .is_straight = true};
}

/* The photon goes on along wi; it was drawn from all lobes. */
void ppmi_photon_history_scatter(ppmi_photon_history *history, const ppmi_bsdf *bsdf,
                                 const ppmi_albedo_table *albedo, ppmi_vec3 wi, bool is_delta);

/* The share of a photon's light that is a caustic where it is gathered. */
ppmi_vec3 ppmi_photon_history_caustic(const ppmi_photon_history *history, bool is_in_medium);

/* What a photon brings to an eye path that gathers it with bsdf. */
typedef struct ppmi_photon_light {
    ppmi_vec3 radiance;
    ppmi_vec3 wi;      /* where the photon came from */
    ppmi_vec3 caustic; /* share */
    bool is_straight;  /* from the light */
    uint32_t group;
} ppmi_photon_light;

/* eye_class: of the path's first vertex (PPM_LAYER_); 0: it is here. */
void ppmi_light_sink_add_photon(const ppmi_light_sink *sink, int32_t eye_class,
                                const ppmi_bsdf *bsdf, const ppmi_albedo_table *albedo,
                                const ppmi_photon_light *light);

#endif
