/* The tables behind ppmi_lights: seen by the files of this folder only. */
#ifndef PPMI_LIGHT_TABLES_H
#define PPMI_LIGHT_TABLES_H

#include "light/extent.h"
#include "light/glow.h"
#include "light/lamp.h"
#include "light/light_cells.h"
#include "light/light_tree.h"
#include "light/lights.h"
#include "light/sun.h"

#define PPMI_NO_EMITTER UINT32_MAX

typedef enum ppmi_emitter_kind {
    PPMI_EMITTER_TRIANGLE,
    PPMI_EMITTER_PUNCTUAL,
    PPMI_EMITTER_LAMP, /* with an extent */
    PPMI_EMITTER_SUN,
    PPMI_EMITTER_ENVIRONMENT
} ppmi_emitter_kind;

/* One light. For triangles, and points and lines of meshes (kind TRIANGLE too), instance,
 * primitive, triangle; for the others triangle is the index among the punctual lights, primitive
 * that among the suns or lamps. */
typedef struct ppmi_emitter {
    uint32_t instance, primitive, triangle;
    uint16_t kind; /* ppmi_emitter_kind */
    uint8_t sides;
    bool has_own_area; /* area depends on the place or the time */
    float area;        /* world, of triangles; else about that */
    float radiance;    /* of triangles: mean over the triangle, of all channels */
    uint32_t glow;     /* root of the tree by which places are drawn; PPMI_GLOW_EVEN */
} ppmi_emitter;

/* A node of the light tree that is chosen as one. */
typedef struct ppmi_light_cluster {
    uint32_t node, depth;
} ppmi_light_cluster;

struct ppmi_lights {
    ppm_context *context;
    const ppm_scene *scene;
    ppmi_light_extent extent;
    ppmi_environment_map environment;
    bool has_environment;

    uint32_t count; /* emitters: near lights, directional lights, the environment */
    ppmi_emitter *emitters;
    ppmi_alias by_power;         /* all emitters, for photons */
    float power;                 /* of all that by_power holds */
    ppmi_light_tree near_lights; /* the first near_count emitters, for light sampling */
    ppmi_alias directionals;     /* the next directional_count: by illuminance */
    ppmi_glow glow;              /* places on triangles whose emission varies */
    float directional_lux;       /* of all of them, on planes that face them */

    /* choices: the clusters, and behind them far light where there is any */
    uint32_t choice_count, cluster_count, directional_choice, environment_choice;
    ppmi_light_cluster clusters[PPMI_LIGHT_CLUSTERS];
    ppmi_light_cells cells; /* what is known of them by place */

    uint32_t triangle_count, near_count, directional_count;
    ppmi_sun *suns; /* the directional lights that have a size */
    uint32_t sun_count;
    ppmi_lamp *lamps; /* point, spot and area lights that have an extent */
    uint32_t lamp_count;
    ppmi_profile_table *profiles; /* as in the scene */
    uint32_t *first_slot;         /* per instance: where its primitives start in first_emitter */
    uint32_t *first_emitter;      /* per instance and primitive: emitter of triangle 0, or
                                     PPMI_NO_EMITTER */
};

/* The surface at a place of an emissive triangle, point or line (u and v as in ppmi_hit), at a time
 * within the shutter. */
static inline void ppmi_emitter_surface(const ppmi_lights *lights, const ppmi_emitter *e, float u,
                                        float v, float time, ppmi_surface *out_surface)
{
    const ppmi_hit hit = {.instance = e->instance,
                          .primitive = e->primitive,
                          .triangle = e->triangle,
                          .u = u,
                          .v = v,
                          .time = time};
    ppmi_surface_from_hit(lights->scene, &hit, out_surface);
}

/* An even place of an emitter that moves or is round. */
ppmi_vec2 ppmi_emitter_place(const ppmi_lights *lights, const ppmi_emitter *e, float u, float v,
                             float time);

/* The density by area of a place that is drawn, by density: what it is by that of even ones. */
static inline float ppmi_emitter_by_area(const ppmi_emitter *e, const ppmi_surface *surface,
                                         float density)
{
    const float area = e->has_own_area ? ppmi_surface_area(surface) : e->area;
    return area > 0.0f ? density / area : 0.0f;
}

/* Draws a place; returns its density by area, 0 where there is no area. */
static inline float ppmi_emitter_sample(const ppmi_lights *lights, const ppmi_emitter *e, float u,
                                        float v, float time, ppmi_surface *out_surface)
{
    float density = 1.0f;
    ppmi_vec2 at;
    if (e->glow != PPMI_GLOW_EVEN) {
        at = ppmi_glow_sample(&lights->glow, e->glow, (double)u, (double)v, &density);
    } else {
        at = e->has_own_area ? ppmi_emitter_place(lights, e, u, v, time)
                             : ppmi_sample_triangle(u, v);
    }
    ppmi_emitter_surface(lights, e, at.x, at.y, time, out_surface);
    return ppmi_emitter_by_area(e, out_surface, density);
}

/* The density by area with which that draws a surface of the emitter. */
static inline float ppmi_emitter_pdf(const ppmi_lights *lights, const ppmi_emitter *e,
                                     const ppmi_surface *surface)
{
    const float density = e->glow != PPMI_GLOW_EVEN
                              ? ppmi_glow_density(&lights->glow, e->glow, surface->u, surface->v)
                              : 1.0f;
    return ppmi_emitter_by_area(e, surface, density);
}

/* Fills in radiance and glow of all triangles. Returns OK, OUT_OF_MEMORY. */
ppm_status ppmi_lights_build_glow(ppmi_lights *lights);

/* Emission of such a surface, as far as it is opaque: rays meet a surface with alpha as often as it
 * is opaque, and see its emission then. */
static inline ppmi_vec3 ppmi_emitter_radiance(const ppmi_lights *lights,
                                              const ppmi_surface *surface, ppmi_vec3 wo)
{
    return vec3_scale(ppmi_surface_emission(lights->scene, surface, wo),
                      ppmi_surface_opacity(lights->scene, surface));
}

/* A photon of one emitter, whose power is the emitter's whole. u_cell: for an environment's image.
 */
bool ppmi_lights_emit_of(const ppmi_lights *lights, uint32_t emitter, float time, double u_cell,
                         const float u[4], ppmi_emission *out_emission);

#endif
