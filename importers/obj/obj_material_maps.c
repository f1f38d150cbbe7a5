/* Maps of materials to textures of the renderer, which has fewer of them: colour and alpha, and
 * roughness and metalness, share an image. */
#include <string.h>

#include "obj/obj_material.h"

#define TWO_PI 6.28318530718f

static void use_map(ppmi_obj_conversion *c, int32_t map, int32_t role, ppm_texture *out)
{
    if (c->status != PPM_STATUS_OK) return;
    c->status = ppmi_obj_use_map(c->reader, c->material, map, role, out);
}

static void use_mixture(ppmi_obj_conversion *c, const ppmi_obj_mixture *mixture, ppm_texture *out)
{
    if (c->status != PPM_STATUS_OK) return;
    c->status = ppmi_obj_use_mixture(c->reader, c->material, mixture, out);
}

static bool is_plain(const ppmi_obj_conversion *c, int32_t map)
{
    return ppmi_obj_map_is_plain(&c->material->maps[map]);
}

/* ---- one map --------------------------------------------------------------------------------- */

static void keep_pixel(float parameter, const float a[4], const float b[4], float out[4])
{
    (void)parameter;
    (void)b;
    memcpy(out, a, 4 * sizeof *out);
}

static void keep_luminance(float parameter, const float a[4], const float b[4], float out[4])
{
    (void)parameter;
    (void)b;
    out[0] = out[1] = out[2] = ppmi_obj_luminance(a);
    out[3] = 1.0f;
}

void ppmi_obj_use_color(ppmi_obj_conversion *c, int32_t map, ppm_texture *out)
{
    const ppmi_obj_mixture mixture = {.kind = "color",
                                      .maps = {map, -1},
                                      .missing = {1.0f, 1.0f},
                                      .role = PPM_IMAGE_COLOR,
                                      .mix = keep_pixel};
    if (is_plain(c, map)) {
        use_map(c, map, PPM_IMAGE_COLOR, out);
    } else {
        use_mixture(c, &mixture, out);
    }
}

void ppmi_obj_use_scalar(ppmi_obj_conversion *c, int32_t map, ppm_texture *out)
{
    const ppmi_obj_mixture mixture = {.kind = "scalar",
                                      .maps = {map, -1},
                                      .missing = {1.0f, 1.0f},
                                      .role = PPM_IMAGE_DATA,
                                      .channels = 1,
                                      .mix = keep_luminance};
    if (is_plain(c, map)) {
        use_map(c, map, PPM_IMAGE_DATA, out);
    } else {
        use_mixture(c, &mixture, out);
    }
}

/* ---- two in one ------------------------------------------------------------------------------ */

static bool is_one_file(const ppmi_obj_conversion *c, int32_t a, int32_t b)
{
    return ppmi_obj_has_map(c, a) && ppmi_obj_has_map(c, b) &&
           strcmp(c->material->maps[a].name, c->material->maps[b].name) == 0;
}

static void add_alpha(float parameter, const float a[4], const float b[4], float out[4])
{
    (void)parameter;
    memcpy(out, a, 3 * sizeof *out);
    out[3] = ppmi_obj_luminance(b);
}

void ppmi_obj_use_color_and_alpha(ppmi_obj_conversion *c, ppm_texture *out)
{
    const ppmi_obj_mixture mixture = {.kind = "alpha",
                                      .maps = {PPMI_OBJ_MAP_KD, PPMI_OBJ_MAP_D},
                                      .missing = {1.0f, 1.0f},
                                      .role = PPM_IMAGE_COLOR,
                                      .channels = 4,
                                      .mix = add_alpha};
    if (!ppmi_obj_has_map(c, PPMI_OBJ_MAP_D)) {
        ppmi_obj_use_color(c, PPMI_OBJ_MAP_KD, out);
    } else {
        use_mixture(c, &mixture, out);
    }
}

static void put_roughness_and_metal(float parameter, const float a[4], const float b[4],
                                    float out[4])
{
    (void)parameter;
    out[0] = out[3] = 1.0f;
    out[1] = ppmi_obj_luminance(a);
    out[2] = ppmi_obj_luminance(b);
}

/* a: shares of the exponent, which is the parameter. */
static void put_shininess_and_metal(float parameter, const float a[4], const float b[4],
                                    float out[4])
{
    out[0] = out[3] = 1.0f;
    out[1] = ppmi_obj_roughness_of(parameter * ppmi_obj_luminance(a));
    out[2] = ppmi_obj_luminance(b);
}

/* One image for both is meant so: green roughness, blue metalness. A grey image serves as it is
 * where nothing is metal. */
static bool serves_as_it_is(const ppmi_obj_conversion *c)
{
    if (!is_plain(c, PPMI_OBJ_MAP_PR) || !is_plain(c, PPMI_OBJ_MAP_PM)) return false;
    const bool is_metal = ppmi_obj_has_map(c, PPMI_OBJ_MAP_PM) || c->desc.metallic > 0.0f;
    return ppmi_obj_has_map(c, PPMI_OBJ_MAP_PR) &&
           (!is_metal || is_one_file(c, PPMI_OBJ_MAP_PR, PPMI_OBJ_MAP_PM));
}

void ppmi_obj_use_roughness_and_metal(ppmi_obj_conversion *c, bool takes_shininess)
{
    ppm_material_desc *desc = &c->desc;
    const float roughness = desc->roughness, metallic = desc->metallic;
    const bool has_pr = ppmi_obj_has_map(c, PPMI_OBJ_MAP_PR);
    const bool has_pm = ppmi_obj_has_map(c, PPMI_OBJ_MAP_PM);
    const bool has_ns = takes_shininess && !has_pr && !ppmi_obj_has(c, PPMI_OBJ_HAS_PR) &&
                        ppmi_obj_has_map(c, PPMI_OBJ_MAP_NS);
    const bool is_pr_given = ppmi_obj_has(c, PPMI_OBJ_HAS_PR);
    const bool is_pm_given = ppmi_obj_has(c, PPMI_OBJ_HAS_PM);
    const ppmi_obj_mixture mixture = {
        .kind = has_ns ? "shininess" : "roughness",
        .maps = {has_ns ? PPMI_OBJ_MAP_NS : PPMI_OBJ_MAP_PR, PPMI_OBJ_MAP_PM},
        .missing = {has_pr && !is_pr_given ? roughness : 1.0f, is_pm_given ? 1.0f : 0.0f},
        .role = PPM_IMAGE_DATA,
        .channels = 3,
        .parameter = ppmi_obj_has(c, PPMI_OBJ_HAS_NS) ? c->from->shininess : 1000.0f,
        .mix = has_ns ? put_shininess_and_metal : put_roughness_and_metal};
    if (!has_pr && !has_pm && !has_ns) return;
    if (serves_as_it_is(c)) {
        use_map(c, PPMI_OBJ_MAP_PR, PPM_IMAGE_DATA, &desc->metallic_roughness_texture);
    } else {
        use_mixture(c, &mixture, &desc->metallic_roughness_texture);
    }
    if (desc->metallic_roughness_texture.image == 0) return;
    desc->roughness = has_ns || (has_pr && !is_pr_given) ? 1.0f : roughness;
    desc->metallic = has_pm && !is_pm_given ? 1.0f : metallic;
}

/* a: strength, b: turns, of which the parameter is one whole. */
static void put_anisotropy(float parameter, const float a[4], const float b[4], float out[4])
{
    const float angle = TWO_PI * parameter * ppmi_obj_luminance(b);
    out[0] = 0.5f + 0.5f * cosf(angle);
    out[1] = 0.5f + 0.5f * sinf(angle);
    out[2] = ppmi_obj_luminance(a);
    out[3] = 1.0f;
}

void ppmi_obj_use_anisotropy(ppmi_obj_conversion *c)
{
    ppm_material_desc *desc = &c->desc;
    const bool has_rotation = ppmi_obj_has_map(c, PPMI_OBJ_MAP_ANISOR);
    const float turns = ppmi_obj_has(c, PPMI_OBJ_HAS_ANISOR) ? c->from->anisotropy_rotation : 1.0f;
    const ppmi_obj_mixture mixture = {.kind = "anisotropy",
                                      .maps = {PPMI_OBJ_MAP_ANISO, PPMI_OBJ_MAP_ANISOR},
                                      .missing = {1.0f, 1.0f},
                                      .role = PPM_IMAGE_DATA,
                                      .channels = 3,
                                      .parameter = has_rotation ? turns : 0.0f,
                                      .mix = put_anisotropy};
    const bool has_strength = ppmi_obj_has_map(c, PPMI_OBJ_MAP_ANISO);
    if (!has_strength && !(has_rotation && desc->anisotropy > 0.0f)) return;
    use_mixture(c, &mixture, &desc->anisotropy_texture);
    if (desc->anisotropy_texture.image == 0) return;
    if (!ppmi_obj_has(c, PPMI_OBJ_HAS_ANISO)) desc->anisotropy = 1.0f;
    if (has_rotation) desc->anisotropy_rotation_rad = 0.0f; /* it is in the image */
}

/* ---- relief ---------------------------------------------------------------------------------- */

void ppmi_obj_use_relief(ppmi_obj_conversion *c)
{
    static const int32_t maps[] = {PPMI_OBJ_MAP_NORM, PPMI_OBJ_MAP_BUMP, PPMI_OBJ_MAP_DISP};
    int32_t used = -1;
    for (int i = 0; i < 3; ++i) {
        if (!ppmi_obj_has_map(c, maps[i])) continue;
        if (used < 0) {
            used = maps[i];
            continue;
        }
        ppmi_obj_material_warn(c, maps[i] == PPMI_OBJ_MAP_BUMP
                                      ? "bump has no effect beside norm"
                                      : "disp has no effect beside norm or bump");
    }
    if (used < 0 || c->status != PPM_STATUS_OK) return;
    c->desc.normal_scale =
        ppmi_obj_limit(c->material->maps[used].bump, -PPMI_OBJ_HUGE, PPMI_OBJ_HUGE);
    if (used == PPMI_OBJ_MAP_NORM) {
        use_map(c, used, PPM_IMAGE_DATA, &c->desc.normal_texture);
    } else {
        c->status = ppmi_obj_use_bump(c->reader, c->material, used, &c->desc.normal_texture);
    }
    c->reader->tally.displaced += used == PPMI_OBJ_MAP_DISP;
}
