/* Spots with Blender's falloff (extras.ppm_blend). What the exporter writes for it, an inner cone
 * of (1 - blend) times the outer one, is another falloff: docs/lights.md, "Spots of Blender". Here
 * it is a profile of the light, within a cone that ends at once. */
#include <math.h>

#include "gltf/gltf_light.h"

enum { ANGLES = 257 };

/* One for all spots of the same cone and blend. */
typedef struct ppmi_gltf_blend {
    struct ppmi_gltf_blend *next;
    float outer_rad;
    double blend;
    ppm_light_profile_id id;
} ppmi_gltf_blend;

/* Cycles 3.4: the cosine, times a smooth step over the blend's share of 1 - cos(outer). */
static double falloff(double angle, double outer, double blend)
{
    const double cosine = cos(angle), width = blend * (1.0 - cos(outer));
    const double above = cosine - cos(outer);
    const double x = above >= width ? 1.0 : fmax(above, 0.0) / width;
    return fmax(cosine, 0.0) * x * x * (3.0 - 2.0 * x);
}

static ppm_status add_profile(ppmi_gltf_reader *reader, ppmi_gltf_blend *blend)
{
    float polar[ANGLES], candela[ANGLES];
    const float around = 0.0f;
    for (int i = 0; i < ANGLES; i++) {
        polar[i] = blend->outer_rad * (float)i / (float)(ANGLES - 1);
        candela[i] = (float)falloff(polar[i], blend->outer_rad, blend->blend);
    }
    const ppm_light_profile_desc desc = {.size = sizeof desc,
                                         .name = "Blend",
                                         .polar_count = ANGLES,
                                         .azimuth_count = 1,
                                         .polar_rad = polar,
                                         .azimuth_rad = &around,
                                         .candela = candela};
    return ppm_scene_add_light_profile(reader->scene, &desc, &blend->id);
}

static ppm_status find_profile(ppmi_gltf_reader *reader, float outer_rad, double blend,
                               ppm_light_profile_id *out_id)
{
    for (const ppmi_gltf_blend *b = reader->blends; b; b = b->next) {
        *out_id = b->id;
        if (b->outer_rad == outer_rad && b->blend == blend) return PPM_STATUS_OK;
    }
    ppmi_gltf_blend *b = ppmi_alloc_zeroed(reader->context, 1, sizeof *b);
    if (!b) return ppmi_gltf_out_of_memory(reader, "extras.ppm_blend");
    *b = (ppmi_gltf_blend){.next = reader->blends, .outer_rad = outer_rad, .blend = blend};
    reader->blends = b;
    const ppm_status status = add_profile(reader, b);
    *out_id = b->id;
    return status;
}

ppm_status ppmi_gltf_blend_spot(ppmi_gltf_reader *reader, const char *place, double blend,
                                ppm_light_desc *desc)
{
    if (desc->kind != PPM_LIGHT_SPOT || blend < 0.0) return PPM_STATUS_OK;
    if (blend > 1.0) {
        ppmi_gltf_warn(reader, place, "extras.ppm_blend %g left out: it must be in 0 .. 1", blend);
        return PPM_STATUS_OK;
    }
    desc->inner_cone_rad = desc->outer_cone_rad;
    return find_profile(reader, desc->outer_cone_rad, blend, &desc->profile);
}

void ppmi_gltf_free_blends(ppmi_gltf_reader *reader)
{
    while (reader->blends) {
        ppmi_gltf_blend *b = reader->blends;
        reader->blends = b->next;
        ppmi_free(reader->context, b);
    }
}
