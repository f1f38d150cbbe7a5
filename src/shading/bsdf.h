/* The BSDF at one point, as lobes that can be evaluated, sampled and measured one by one.
 *
 *   WIDE   the diffuse base under the coat, and the multiple scattering of a rough metal: always
 *          gathers
 *   SPEC   GGX reflection of the coat or the metal; a mirror when smooth
 *   GLASS  dielectric interface or thin sheet: reflection and refraction; smooth or rough
 *   PHASE  no surface at all but a point in a medium: sigma_s times the phase function, without
 *          cosine; always gathers, and stands alone
 *
 * and, of materials with layers (docs/materials.md),
 *   COAT     GGX reflection of the clearcoat, around a normal of its own; a mirror when smooth
 *   SHEEN    fibres on top of the base: always gathers
 *   THROUGH  Lambert to the other side: always gathers
 *   RETRO    the part of SPEC that goes back where the light came from
 *
 * Directions point away from the surface, in world space. wo is the side the BSDF was made for: the
 * eye on eye paths, where the light came from on photon paths. */
#ifndef PPMI_SHADING_BSDF_H
#define PPMI_SHADING_BSDF_H

#include "shading/albedo.h"
#include "shading/material.h"
#include "shading/medium.h"

enum {
    PPMI_LOBE_WIDE = 1,
    PPMI_LOBE_SPEC = 2,
    PPMI_LOBE_GLASS = 4,
    PPMI_LOBE_PHASE = 8,
    PPMI_LOBE_COAT = 16,
    PPMI_LOBE_SHEEN = 32,
    PPMI_LOBE_THROUGH = 64,
    PPMI_LOBE_RETRO = 128,
    PPMI_LOBE_ALL = 255
};
enum { PPMI_LOBE_COUNT = 8 };

/* What a path carries. Radiance is scaled by the square of the index ratio where it is refracted,
 * photon power is not (Veach 1997, section 5.2). */
typedef enum ppmi_transport { PPMI_TRANSPORT_RADIANCE, PPMI_TRANSPORT_POWER } ppmi_transport;

/* What layered materials have beyond the others. Directions are local. */
typedef struct ppmi_bsdf_layers {
    /* COAT: over all else but fuzz */
    ppmi_vec3 coat_normal;
    ppmi_vec3 coat_tangent;
    float coat; /* share of the surface */
    float coat_f0, coat_ior;
    ppmi_vec2 coat_alpha;    /* along the tangent and across */
    float coat_roughness;    /* across */
    float coat_anisotropy;   /* strength */
    bool is_coat_tinted;     /* the next two are not white */
    ppmi_vec3 coat_tint;     /* of light that has gone through it twice, straight */
    ppmi_vec3 coat_darkened; /* what reflections to and fro below it leave of the base */
    /* SHEEN: over the base, as fuzz over the coat too */
    ppmi_vec3 sheen_color;
    float sheen_share; /* of the surface that the fibres cover */
    float sheen_roughness;
    bool sheen_is_on_top;
    float passing; /* share of light from wo that coat and sheen leave to what lies below */
    /* THROUGH: like coat_base, to the other side */
    ppmi_vec3 through, through_color;
    /* film on the base's speculars */
    float film, film_ior, film_nm;
    const ppmi_working_space *space; /* NULL: linear Rec.709 */
    ppmi_vec3 film_f0;               /* of the dielectric below */
    ppmi_vec2 alpha;                 /* of SPEC, along the frame's axes */
    float anisotropy;                /* strength */
    float retro;                     /* share of RETRO in the base's speculars */
    float opaque, metallic;          /* share of what is not glass; metal's share of that */
    bool has_metal_edge;
    ppmi_vec3 metal_edge; /* what metals lack of Schlick's curve, by ppmi_f82_shape */
} ppmi_bsdf_layers;

typedef struct ppmi_bsdf {
    ppmi_frame frame; /* around the shading normal, on wo's side */
    ppmi_vec3 ng;     /* geometric normal, on wo's side */
    ppmi_vec3 wo;     /* local */

    /* WIDE: f = (coat_base (1 - E(i)) + metal_base (1 - Em(i))) / pi; the parts that depend on wo
     * only are folded into the colours */
    ppmi_vec3 coat_base;
    ppmi_vec3 metal_base;
    float coat_f0, coat_f90; /* for E */
    float diffuse_roughness; /* above 0: coat_base is multiplied (rough_diffuse.h), where */
    float diffuse_lost;      /* single scattering loses so much of light from wo */

    /* SPEC: (f0 + (f90 - f0) schlick) D G / 4 cos cos */
    ppmi_vec3 f0, f90;
    float alpha;
    float roughness;

    /* GLASS */
    ppmi_vec3 tint;     /* of what is transmitted */
    float glass_weight; /* share of the surface */
    float glass_alpha;
    float eta; /* index on the far side by the one on wo's side */
    bool is_thin;

    bool is_layered;

    /* in the lobes' order; sums to 1, or all 0 for black */
    float lobe_probability[PPMI_LOBE_COUNT];
    uint8_t lobes;        /* mask of lobes that are there */
    uint8_t delta_lobes;  /* those of them that are infinitely narrow */
    uint8_t gather_lobes; /* those wide enough for density estimation */

    union { /* set where it applies */
        struct {
            /* PHASE; frame.n is the direction of flight */
            ppmi_vec3 sigma_s;
            float asymmetry_g;
        };
        ppmi_bsdf_layers layers;
    };

    /* Set where GLASS is rough: what single scattering loses of light from wo, the share of it that
     * comes back on wo's side, and f by 1 - E(i), for power: back and through. */
    float glass_lost, glass_returned, glass_back, glass_through;
} ppmi_bsdf;

typedef struct ppmi_bsdf_sample {
    ppmi_vec3 wi;
    ppmi_vec3 weight; /* f |cos| / pdf, with the shading normal's cosine */
    float pdf;        /* by solid angle, of the lobes in the mask; 0 for a delta lobe */
    float eta_scale;  /* factor of radiance by refraction that is in weight, 1 / eta^2; else 1 */
    bool is_delta;
    bool is_transmission;
} ppmi_bsdf_sample;

/* The index of KHR_materials_ior; its 0 means a Fresnel term of 1 throughout, which a huge index
 * comes close to. */
static inline float ppmi_dielectric_index(float ior)
{
    return ior == 0.0f ? 1e4f : ppmi_max(ior, 1.0f);
}

/* wo: unit, away from the surface. */
void ppmi_bsdf_make(const ppmi_albedo_table *albedo, const ppmi_surface *surface,
                    const ppmi_material_point *point, ppmi_vec3 wo, ppmi_bsdf *out_bsdf);

/* The scattering at a point of a medium that scatters. wo: unit, towards where the path came from.
 */
void ppmi_bsdf_make_phase(const ppmi_medium *medium, ppmi_vec3 wo, ppmi_bsdf *out_bsdf);

/* f without cosine, of the non-delta lobes in mask. */
ppmi_vec3 ppmi_bsdf_eval(const ppmi_bsdf *bsdf, const ppmi_albedo_table *albedo, ppmi_vec3 wi,
                         uint32_t mask, ppmi_transport transport);

/* The same for light that arrived on a neighbouring facet of a smooth surface: that facet's
 * geometric normal ng, on the side of bsdf->ng, says on which side wi is. */
ppmi_vec3 ppmi_bsdf_eval_from(const ppmi_bsdf *bsdf, const ppmi_albedo_table *albedo, ppmi_vec3 wi,
                              ppmi_vec3 ng, uint32_t mask, ppmi_transport transport);

/* Density by solid angle with which ppmi_bsdf_sample draws wi, given that it draws from mask: the
 * lobes' probabilities are normalised over the mask, delta lobes included. */
float ppmi_bsdf_pdf(const ppmi_bsdf *bsdf, ppmi_vec3 wi, uint32_t mask);

/* Probability, over all lobes, of those in mask. */
float ppmi_bsdf_probability(const ppmi_bsdf *bsdf, uint32_t mask);

/* Albedo for light that goes to wo, by channel: the share that the lobes in mask return or let
 * through of light that is even over all directions; without what radiance gains by refraction. 1
 * for clear glass. Rough glass has the Fresnel term of the smooth surface; all else is exact to
 * what the tables of albedos are. Not for media. */
ppmi_vec3 ppmi_bsdf_albedo(const ppmi_bsdf *bsdf, const ppmi_albedo_table *albedo, uint32_t mask);

/* Draws a direction from the lobes in mask; u_lobe, u, v in [0, 1). False when nothing leaves. */
bool ppmi_bsdf_draw(const ppmi_bsdf *bsdf, const ppmi_albedo_table *albedo, uint32_t mask,
                    ppmi_transport transport, float u_lobe, float u, float v,
                    ppmi_bsdf_sample *out_sample);

/* All directions of the delta lobes in mask, each with its whole weight, for paths that follow
 * every branch. Returns their number. */
enum { PPMI_BSDF_MAX_BRANCHES = 5 };
uint32_t ppmi_bsdf_branches(const ppmi_bsdf *bsdf, const ppmi_albedo_table *albedo, uint32_t mask,
                            ppmi_transport transport,
                            ppmi_bsdf_sample out_samples[PPMI_BSDF_MAX_BRANCHES]);

/* Whether a sample goes straight on through a thin sheet, as shadow rays do. */
static inline bool ppmi_bsdf_goes_straight(const ppmi_bsdf *bsdf, const ppmi_bsdf_sample *sample)
{
    return bsdf->is_thin && sample->is_delta && sample->is_transmission;
}

/* The share of radiance towards wo that comes straight through a thin sheet, by channel: all that
 * samples which go straight bring. 0 for anything else. */
ppmi_vec3 ppmi_bsdf_straight(const ppmi_bsdf *bsdf, const ppmi_albedo_table *albedo);

static inline bool ppmi_bsdf_is_phase(const ppmi_bsdf *bsdf)
{
    return (bsdf->lobes & PPMI_LOBE_PHASE) != 0;
}

/* Cosine of a direction to the shading normal; 1 in a medium. */
static inline float ppmi_bsdf_cosine(const ppmi_bsdf *bsdf, ppmi_vec3 wi)
{
    return ppmi_bsdf_is_phase(bsdf) ? 1.0f : vec3_dot(wi, bsdf->frame.n);
}

/* The normal that light is sampled for; the zero vector in a medium. */
static inline ppmi_vec3 ppmi_bsdf_normal(const ppmi_bsdf *bsdf)
{
    return ppmi_bsdf_is_phase(bsdf) ? vec3_splat(0.0f) : bsdf->frame.n;
}

#endif
