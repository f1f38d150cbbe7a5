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
    bool is_layered;
    ppmi_layer_point layers;
    float diffuse_roughness;
    ppmi_vec3 edge_color; /* black: not given */
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
    [KIND_DENSE_GLASS] = {"dense glass", 0, 1, 1, 2.4f, {1, 1, 1}, false, false},
    [KIND_DENSE_GLASS_INSIDE] = {"dense glass from inside", 0, 1, 1, 2.4f, {1, 1, 1}, false, true},
    [KIND_ROUGH_LAMBERT] = {.name = "rough lambert",
                            .ior = 1.5f,
                            .color = {0.8f, 0.5f, 0.2f},
                            .diffuse_roughness = 0.7f},
    [KIND_WHITE_ROUGH_LAMBERT] = {.name = "white rough lambert",
                                  .ior = 1.5f,
                                  .color = {1, 1, 1},
                                  .diffuse_roughness = 1.0f},
    [KIND_WHITE_ROUGH_PLASTIC] = {.name = "white rough plastic",
                                  .specular = 1,
                                  .ior = 1.5f,
                                  .color = {1, 1, 1},
                                  .diffuse_roughness = 0.8f},
    [KIND_EDGE_COLORED_PLASTIC] = {.name = "edge-coloured plastic",
                                   .specular = 0.8f,
                                   .ior = 1.5f,
                                   .color = {0.7f, 0.4f, 0.1f},
                                   .edge_color = {0.2f, 1.5f, 0.5f}},
#define LAYERED false, false, 0, true
    [KIND_COATED_LAMBERT] =
        {"coated lambert", 0, 0, 0, 1.5f, {0.8f, 0.5f, 0.2f}, LAYERED, {.coat = 1.0f}},
    [KIND_WHITE_COATED_PLASTIC] = {"white coated plastic",
                                   0,
                                   0,
                                   1,
                                   1.5f,
                                   {1, 1, 1},
                                   LAYERED,
                                   {.coat = 1.0f, .coat_roughness = 0.3f}},
    [KIND_WHITE_COATED_METAL] =
        {"white coated metal", 1, 0, 1, 1.5f, {1, 1, 1}, LAYERED, {.coat = 0.8f}},
    [KIND_WHITE_ROUGH_COATED_METAL] = {"white metal, rough coat",
                                       1,
                                       0,
                                       1,
                                       1.5f,
                                       {1, 1, 1},
                                       LAYERED,
                                       {.coat = 1.0f, .coat_roughness = 0.8f}},
    [KIND_WHITE_SHEEN] = {"white sheen",
                          0,
                          0,
                          1,
                          1.5f,
                          {1, 1, 1},
                          LAYERED,
                          {.sheen_color = {1, 1, 1}, .sheen_roughness = 0.5f}},
    [KIND_WHITE_SMOOTH_SHEEN] = {"white smooth sheen",
                                 0,
                                 0,
                                 0,
                                 1.5f,
                                 {1, 1, 1},
                                 LAYERED,
                                 {.sheen_color = {1, 1, 1}, .sheen_roughness = 0.12f}},
    [KIND_WHITE_COATED_SHEEN_METAL] = {"white metal, coat, sheen",
                                       1,
                                       0,
                                       1,
                                       1.5f,
                                       {1, 1, 1},
                                       LAYERED,
                                       {.coat = 1.0f,
                                        .sheen_color = {1, 1, 1},
                                        .sheen_roughness = 0.3f}},
    [KIND_WHITE_BRUSHED_METAL] = {"white brushed metal",
                                  1,
                                  0,
                                  1,
                                  1.5f,
                                  {1, 1, 1},
                                  LAYERED,
                                  {.anisotropy = 0.7f, .tangent = {0.8f, 0.6f, 0.0f}}},
    [KIND_BRUSHED_PLASTIC] = {"brushed plastic",
                              0,
                              0,
                              1,
                              1.5f,
                              {0.7f, 0.4f, 0.1f},
                              LAYERED,
                              {.anisotropy = 0.5f, .tangent = {0.0f, 1.0f, 0.0f}}},
    [KIND_FILM_METAL] = {"film on metal",
                         1,
                         0,
                         1,
                         1.5f,
                         {1.0f, 0.8f, 0.3f},
                         LAYERED,
                         {.film = 1.0f, .film_ior = 1.6f, .film_nm = 300.0f}},
    [KIND_FILM_PLASTIC] = {"film on plastic",
                           0,
                           0,
                           1,
                           1.5f,
                           {1, 1, 1},
                           LAYERED,
                           {.film = 0.9f, .film_ior = 2.0f, .film_nm = 350.0f}},
    [KIND_FILM_GLASS] = {"film on glass",
                         0,
                         1,
                         1,
                         1.5f,
                         {1, 1, 1},
                         LAYERED,
                         {.film = 1.0f, .film_ior = 1.8f, .film_nm = 450.0f}},
    [KIND_FILM_THIN_GLASS] = {"film on thin glass",
                              0,
                              1,
                              1,
                              1.5f,
                              {1, 1, 1},
                              true,
                              false,
                              0,
                              true,
                              {.film = 1.0f, .film_ior = 1.3f, .film_nm = 400.0f}},
    [KIND_WHITE_LEAF] = {"white leaf",
                         0,
                         0,
                         1,
                         1.5f,
                         {1, 1, 1},
                         LAYERED,
                         {.through = 0.4f, .through_color = {1, 1, 1}}},
    [KIND_COATED_LEAF] =
        {"coated leaf",
         0,
         0,
         1,
         1.5f,
         {0.2f, 0.5f, 0.1f},
         LAYERED,
         {.through = 0.7f,
          .through_color = {0.4f, 0.8f, 0.2f},
          .coat = 0.5f,
          .coat_roughness = 0.2f}},
    [KIND_WHITE_RETRO_METAL] =
        {"white retroreflective metal", 1, 0, 1, 1.5f, {1, 1, 1}, LAYERED, {.retro = 1.0f}},
    [KIND_RETRO_PLASTIC] = {"retroreflective plastic",
                            0,
                            0,
                            1,
                            1.5f,
                            {0.7f, 0.4f, 0.1f},
                            LAYERED,
                            {.retro = 1.0f, .anisotropy = 0.5f, .tangent = {0.6f, 0.8f, 0.0f}}},
    [KIND_COATED_GLASS] = {"coated glass", 0, 0.7f, 1, 1.5f, {1, 1, 1}, LAYERED, {.coat = 1.0f}},
    [KIND_WHITE_EVERYTHING] = {"everything, white",
                               0.5f,
                               0,
                               1,
                               1.5f,
                               {1, 1, 1},
                               LAYERED,
                               {.coat = 0.7f,
                                .coat_roughness = 0.4f,
                                .sheen_color = {0.7f, 0.7f, 0.7f},
                                .sheen_roughness = 0.6f,
                                .anisotropy = 0.6f,
                                .tangent = {0.6f, 0.8f, 0.0f},
                                .through = 0.3f,
                                .through_color = {1, 1, 1},
                                .retro = 0.4f}},
#undef LAYERED
    [KIND_ROUGH_LEAF] = {.name = "rough leaf",
                         .ior = 1.5f,
                         .color = {0.2f, 0.5f, 0.1f},
                         .diffuse_roughness = 0.9f,
                         .is_layered = true,
                         .layers = {.through = 0.7f, .through_color = {0.4f, 0.8f, 0.2f}}},
    [KIND_TINTED_COAT] = {.name = "tinted coat on plastic",
                          .specular = 1,
                          .ior = 1.5f,
                          .color = {0.7f, 0.8f, 0.1f},
                          .is_layered = true,
                          .layers = {.coat = 0.9f,
                                     .coat_ior = 1.7f,
                                     .coat_roughness = 0.3f,
                                     .coat_tint = {0.9f, 0.5f, 0.2f},
                                     .coat_darkening = 1.0f}},
    [KIND_DARKENED_METAL] = {.name = "metal under a tinted coat",
                             .metallic = 1,
                             .specular = 1,
                             .ior = 1.5f,
                             .color = {1.0f, 0.8f, 0.3f},
                             .is_layered = true,
                             .layers = {.coat = 1.0f,
                                        .coat_tint = {0.9f, 0.6f, 0.6f},
                                        .coat_darkening = 0.5f,
                                        .sheen_color = {0.3f, 0.3f, 0.3f},
                                        .sheen_roughness = 0.4f}},
    [KIND_TINTED_GLASS] = {.name = "glass under a tinted coat",
                           .transmission = 0.8f,
                           .specular = 1,
                           .ior = 1.5f,
                           .color = {1, 1, 1},
                           .is_layered = true,
                           .layers = {.coat = 1.0f, .coat_tint = {0.3f, 0.6f, 0.9f}}},
    [KIND_WHITE_BRUSHED_COAT] = {.name = "white plastic, brushed coat",
                                 .specular = 1,
                                 .ior = 1.5f,
                                 .color = {1, 1, 1},
                                 .is_layered = true,
                                 .layers = {.coat = 1.0f,
                                            .coat_roughness = 0.4f,
                                            .coat_anisotropy = 0.6f,
                                            .coat_tangent = {0.6f, 0.8f, 0.0f}}},
    [KIND_WHITE_FUZZ] = {.name = "white fuzz",
                         .specular = 1,
                         .ior = 1.5f,
                         .color = {1, 1, 1},
                         .is_layered = true,
                         .layers = {.sheen_color = {0.8f, 0.8f, 0.8f},
                                    .sheen_share = 0.8f,
                                    .sheen_roughness = 0.5f,
                                    .sheen_is_on_top = true}},
    [KIND_WHITE_FUZZ_ON_COAT] = {.name = "white fuzz on a coat",
                                 .specular = 1,
                                 .ior = 1.5f,
                                 .color = {1, 1, 1},
                                 .is_layered = true,
                                 .layers = {.coat = 1.0f,
                                            .coat_ior = 1.8f,
                                            .coat_roughness = 0.5f,
                                            .sheen_color = {1, 1, 1},
                                            .sheen_share = 1.0f,
                                            .sheen_roughness = 0.4f,
                                            .sheen_is_on_top = true}},
    [KIND_DARK_FUZZ] = {.name = "dark fuzz on a coat",
                        .specular = 1,
                        .ior = 1.5f,
                        .color = {0.9f, 0.5f, 0.1f},
                        .is_layered = true,
                        .layers = {.coat = 0.8f,
                                   .sheen_color = {0.1f, 0.0f, 0.0f},
                                   .sheen_share = 1.0f,
                                   .sheen_roughness = 0.6f,
                                   .sheen_is_on_top = true}},
    [KIND_EDGE_COLORED_METAL] = {.name = "edge-coloured metal",
                                 .metallic = 0.9f,
                                 .specular = 1,
                                 .ior = 1.5f,
                                 .color = {0.9f, 0.6f, 0.3f},
                                 .edge_color = {0.9f, 0.3f, 0.6f},
                                 .is_layered = true},
};

const ppmi_albedo_table *bsdf_albedo(void)
{
    static ppmi_albedo_table table;
    static ppmi_lobe_table lobes;
    static ppmi_glass_table glass;
    if (table.lobes) return &table;
    ppmi_albedo_table_init(&table);
    ppmi_lobe_table_init(&lobes);
    ppmi_glass_table_init(&glass);
    table.lobes = &lobes;
    table.glass = &glass;
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
                                        .ns = up,
                                        .is_layered = kinds[kind].is_layered,
                                        .layers = kinds[kind].layers};
    item->point.diffuse_roughness = kinds[kind].diffuse_roughness;
    item->point.edge_color = !vec3_is_black(kinds[kind].edge_color);
    if (item->point.edge_color) item->point.specular_color = kinds[kind].edge_color;
    ppmi_layer_point *layers = &item->point.layers;
    layers->coat_normal = up;
    if (layers->coat_ior == 0.0f) layers->coat_ior = 1.5f;
    if (vec3_is_black(layers->coat_tint)) layers->coat_tint = vec3_splat(1.0f);
    if (!layers->sheen_is_on_top) layers->sheen_share = vec3_max_component(layers->sheen_color);
    const ppmi_surface surface = {.ng = up, .ns = up};
    const float sine = sqrtf(1.0f - cosine * cosine);
    const ppmi_vec3 wo = vec3(sine, 0.0f, kinds[kind].from_back ? -cosine : cosine);
    ppmi_bsdf_make(bsdf_albedo(), &surface, &item->point, wo, bsdf);
}

void bsdf_for_all(bsdf_check check, void *user)
{
    for (int kind = 0; kind < KINDS; kind++) {
        /* the many layered ones with every second roughness */
        for (int r = 0; r < ROUGHNESSES; r += kinds[kind].is_layered ? 2 : 1) {
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
