/* Kinds of material for the tests of the BSDF. */
#include "shading/bsdf_cases.h"

#include <stdio.h>

#include "math/sampling.h"

static const float roughnesses[ROUGHNESSES] = {0.0f, 0.05f, 0.1f, 0.3f, 0.5f, 0.8f, 1.0f};
static const float cosines[COSINES] = {1.0f, 0.7f, 0.3f, 0.08f};

static const struct {
    const char *name;
    float metallic, transmission, specular, ior;
    ppmi_vec3 color;
    bool is_thin, from_back;
    float relative_index; /* 0: from ior */
} kinds[KINDS] = {
    [KIND_LAMBERT] = {"lambert", 0, 0, 0, 1.5f, {0.8f, 0.5f, 0.2f}, false, false},
    [KIND_PLASTIC] = {"plastic", 0, 0, 1, 1.5f, {0.7f, 0.4f, 0.1f}, false, false},
    [KIND_WHITE_PLASTIC] = {"white plastic", 0, 0, 1, 1.5f, {1, 1, 1}, false, false},
    [KIND_METAL] = {"metal", 1, 0, 1, 1.5f, {1.0f, 0.8f, 0.3f}, false, false},
    [KIND_WHITE_METAL] = {"white metal", 1, 0, 1, 1.5f, {1, 1, 1}, false, false},
    [KIND_HALF_METAL] = {"half metal", 0.5f, 0, 1, 1.5f, {0.9f, 0.6f, 0.3f}, false, false},
    [KIND_GLASS] = {"glass", 0, 1, 1, 1.5f, {1, 1, 1}, false, false},
    [KIND_GLASS_INSIDE] = {"glass from inside", 0, 1, 1, 1.5f, {1, 1, 1}, false, true},
    [KIND_THIN_GLASS] = {"thin glass", 0, 1, 1, 1.5f, {1.0f, 0.7f, 0.4f}, true, false},
    [KIND_HALF_GLASS] = {"half glass", 0.2f, 0.5f, 1, 1.33f, {0.9f, 0.7f, 0.4f}, false, false},
    [KIND_HALF_GLASS_INSIDE] =
        {"half glass from inside", 0, 0.5f, 1, 1.33f, {0.9f, 0.7f, 0.4f}, false, true},
    [KIND_WATER_TO_GLASS] =
        {"glass in water", 0, 1, 1, 1.5f, {1, 1, 1}, false, false, 1.5f / 1.33f},
    [KIND_GLASS_TO_WATER] =
        {"water around glass, from inside", 0, 1, 1, 1.5f, {1, 1, 1}, false, true, 1.33f / 1.5f},
};

const ppmi_albedo_table *bsdf_albedo(void)
{
    static ppmi_albedo_table table;
    static bool is_made;
    if (!is_made) ppmi_albedo_table_init(&table);
    is_made = true;
    return &table;
}

void bsdf_make_case(int kind, float roughness, float cosine, bsdf_case *item, ppmi_bsdf *bsdf)
{
    const ppmi_vec3 up = vec3(0.0f, 0.0f, 1.0f);
    *item =
        (bsdf_case){.roughness = roughness, .cosine = cosine, .from_back = kinds[kind].from_back};
    snprintf(item->name, sizeof item->name, "%s, roughness %g, cosine %g", kinds[kind].name,
             (double)roughness, (double)cosine);
    item->point = (ppmi_material_point){.base_color = kinds[kind].color,
                                        .metallic = kinds[kind].metallic,
                                        .roughness = roughness,
                                        .ior = kinds[kind].ior,
                                        .specular = kinds[kind].specular,
                                        .specular_color = {1.0f, 1.0f, 1.0f},
                                        .transmission = kinds[kind].transmission,
                                        .is_thin = kinds[kind].is_thin,
                                        .relative_index = kinds[kind].relative_index,
                                        .ns = up};
    const ppmi_surface surface = {.ng = up, .ns = up};
    const float sine = sqrtf(1.0f - cosine * cosine);
    const ppmi_vec3 wo = vec3(sine, 0.0f, kinds[kind].from_back ? -cosine : cosine);
    ppmi_bsdf_make(bsdf_albedo(), &surface, &item->point, wo, bsdf);
}

void bsdf_for_all(bsdf_check check, void *user)
{
    for (int kind = 0; kind < KINDS; kind++) {
        for (int r = 0; r < ROUGHNESSES; r++) {
            for (int c = 0; c < COSINES; c++) {
                bsdf_case item;
                ppmi_bsdf bsdf;
                bsdf_make_case(kind, roughnesses[r], cosines[c], &item, &bsdf);
                check(&item, &bsdf, user);
            }
        }
    }
}

ppmi_vec3 bsdf_wo(const ppmi_bsdf *bsdf)
{
    return ppmi_frame_to_world(&bsdf->frame, bsdf->wo);
}

ppmi_vec3 bsdf_random_direction(ppmi_rng *rng)
{
    const float u = ppmi_rng_float(rng), v = ppmi_rng_float(rng);
    return vec3_normalize(ppmi_sample_sphere(u, v));
}

bool bsdf_draw(const ppmi_bsdf *bsdf, ppmi_rng *rng, ppmi_transport transport,
               ppmi_bsdf_sample *sample)
{
    const float u_lobe = ppmi_rng_float(rng), u = ppmi_rng_float(rng), v = ppmi_rng_float(rng);
    return ppmi_bsdf_draw(bsdf, bsdf_albedo(), PPMI_LOBE_ALL, transport, u_lobe, u, v, sample);
}
