/* The tables behind ppmi_lights: seen by the files of this folder only. */
#ifndef PPMI_LIGHT_TABLES_H
#define PPMI_LIGHT_TABLES_H

#include "light/extent.h"
#include "light/lights.h"
#include "light/sun.h"

#define PPMI_NO_EMITTER UINT32_MAX

typedef enum ppmi_emitter_kind {
    PPMI_EMITTER_TRIANGLE,
    PPMI_EMITTER_PUNCTUAL,
    PPMI_EMITTER_SUN,
    PPMI_EMITTER_ENVIRONMENT
} ppmi_emitter_kind;

/* One light. For triangles, and points and lines of meshes (kind TRIANGLE too), instance,
 * primitive, triangle; for punctual lights triangle is the index among them, for suns that among
 * the suns. */
typedef struct ppmi_emitter {
    uint32_t instance, primitive, triangle;
    uint16_t kind; /* ppmi_emitter_kind */
    uint8_t sides;
    bool has_own_area; /* area depends on the place or the time */
    float area;        /* world, of triangles; else about that */
} ppmi_emitter;

struct ppmi_lights {
    ppm_context *context;
    const ppm_scene *scene;
    ppmi_light_extent extent;
    ppmi_environment_map environment;
    bool has_environment;

    uint32_t count; /* emitters: near lights, directional lights, the environment */
    ppmi_emitter *emitters;
    ppmi_alias by_power;     /* all emitters, for photons */
    ppmi_alias near_lights;  /* the first near_count emitters, for light sampling: by power */
    ppmi_alias directionals; /* the next directional_count: by illuminance */
    uint32_t triangle_count, near_count, directional_count;
    ppmi_sun *suns; /* the directional lights that have a size */
    uint32_t sun_count;
    float class_share;       /* of light samples, for each class that is there */
    uint32_t *first_slot;    /* per instance: where its primitives start in first_emitter */
    uint32_t *first_emitter; /* per instance and primitive: emitter of triangle 0, or
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

/* Draws a place of it; 1 over the result is the density by area. */
float ppmi_emitter_sample(const ppmi_lights *lights, const ppmi_emitter *e, float u, float v,
                          float time, ppmi_surface *out_surface);

/* That area, at a place that has been met. */
static inline float ppmi_emitter_area(const ppmi_emitter *e, const ppmi_surface *surface)
{
    return e->has_own_area ? ppmi_surface_area(surface) : e->area;
}

/* Emission of such a surface, as far as it is opaque: rays meet a surface with alpha as often as it
 * is opaque, and see its emission then. */
static inline ppmi_vec3 ppmi_emitter_radiance(const ppmi_lights *lights,
                                              const ppmi_surface *surface, ppmi_vec3 wo)
{
    return vec3_scale(ppmi_surface_emission(lights->scene, surface, wo),
                      ppmi_surface_opacity(lights->scene, surface));
}

/* Integral of the falloff of a spot over its cone: full inside, squared ramp of the cosine between
 * the cones (KHR_lights_punctual). */
static inline float ppmi_spot_solid_angle(const ppmi_punctual *light)
{
    return 2.0f * PPMI_PI *
           ((1.0f - light->cos_inner) + (light->cos_inner - light->cos_outer) / 3.0f);
}

#endif
