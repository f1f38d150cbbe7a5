/* Lights: one quantity of light, in the unit that its key says, becomes what the scene keeps.
 *
 * Luminous flux in lumen: a point sends I 4 pi; a spot I 2 pi ((1 - cos inner) + (cos inner -
 * cos outer) / 3), the integral of the scene's falloff, which is the square of a ramp in the cosine
 * (KHR_lights_punctual); a flat light of radiance L and area A sends pi A L. A watt is taken as 683
 * lm, the definition of the candela, as Khronos' exporters do (docs/light-units.md). */
#include <errno.h>
#include <math.h>
#include <stdio.h>
#include <string.h>

#include "gltf/ies.h"
#include "setup/setup_file.h"

#define PI 3.14159265358979323846
static const double lumens_per_watt = 683.0;

enum { SUN = PPM_LIGHT_DIRECTIONAL };

typedef struct light_words {
    ppmi_setup_pose pose;
    const char *name, *profile, *light_group;
    int32_t kind;
    double candela, lumen, watt, lux, nit, factor, kelvin;
    float color[3];
    double inner_cone, outer_cone, angular_diameter, elevation, azimuth;
    double radius, width, height;
    uint32_t visible;
} light_words;

/* In the order of keys; the first five are those of the pose. */
enum {
    PROFILE = 1 << 6,
    KIND = 1 << 7,
    CANDELA = 1 << 8,
    LUMEN = 1 << 9,
    WATT = 1 << 10,
    LUX = 1 << 11,
    NIT = 1 << 12,
    FACTOR = 1 << 13,
    KELVIN = 1 << 14,
    COLOR = 1 << 15,
    INNER = 1 << 16,
    OUTER = 1 << 17,
    DIAMETER = 1 << 18,
    ELEVATION = 1 << 19,
    AZIMUTH = 1 << 20,
    RADIUS = 1 << 21,
    WIDTH = 1 << 22,
    HEIGHT = 1 << 23,
    QUANTITIES = CANDELA | LUMEN | WATT | LUX | NIT | FACTOR
};

static const ppmi_setup_word kinds[] = {{"point", PPM_LIGHT_POINT},
                                        {"spot", PPM_LIGHT_SPOT},
                                        {"sun", SUN},
                                        {"directional", SUN},
                                        {"rectangle", PPM_LIGHT_RECTANGLE},
                                        {"disk", PPM_LIGHT_DISK},
                                        {NULL, 0}};
#define FIELD(member) .field = offsetof(light_words, member)
static const ppmi_setup_key keys[] = {
    PPMI_SETUP_POSE_KEYS,
    {"name", PPMI_SETUP_TEXT, FIELD(name)},
    {"profile", PPMI_SETUP_TEXT, FIELD(profile)},
    {"kind", PPMI_SETUP_WORD, FIELD(kind), .words = kinds},
    {"candela", PPMI_SETUP_REAL, FIELD(candela), 0, 1e15},
    {"lumen", PPMI_SETUP_REAL, FIELD(lumen), 0, 1e15},
    {"watt", PPMI_SETUP_REAL, FIELD(watt), 0, 1e12},
    {"lux", PPMI_SETUP_REAL, FIELD(lux), 0, 1e15},
    {"nit", PPMI_SETUP_REAL, FIELD(nit), 0, 1e15},
    {"factor", PPMI_SETUP_REAL, FIELD(factor), 0, 1e9},
    {"kelvin", PPMI_SETUP_REAL, FIELD(kelvin), 800, 40000},
    {"color", PPMI_SETUP_COLOR, FIELD(color), 0, 1e6},
    {"inner_cone", PPMI_SETUP_REAL, FIELD(inner_cone), 0, 90},
    {"outer_cone", PPMI_SETUP_REAL, FIELD(outer_cone), 0.001, 90},
    {"angular_diameter", PPMI_SETUP_REAL, FIELD(angular_diameter), 0, 179},
    {"elevation", PPMI_SETUP_REAL, FIELD(elevation), -90, 90},
    {"azimuth", PPMI_SETUP_REAL, FIELD(azimuth), -360, 360},
    {"radius", PPMI_SETUP_REAL, FIELD(radius), 0, 1e12},
    {"width", PPMI_SETUP_REAL, FIELD(width), 1e-6, 1e12},
    {"height", PPMI_SETUP_REAL, FIELD(height), 1e-6, 1e12},
    {"visible", PPMI_SETUP_FLAG, FIELD(visible)},
    {"light_group", PPMI_SETUP_TEXT, FIELD(light_group)},
};
#undef FIELD
enum { KEY_COUNT = sizeof keys / sizeof keys[0] };

/* What each kind has besides position, name, colour and visible. */
static const struct {
    uint64_t allowed, quantities;
    bool needs_direction;
    const char *reason; /* against what is not allowed */
} rules[] = {
    [PPM_LIGHT_POINT] = {RADIUS | PROFILE, CANDELA | LUMEN | WATT | FACTOR, false,
                         "not of a point light, which has \"candela\", \"lumen\" or \"watt\", and "
                         "\"radius\""},
    [PPM_LIGHT_SPOT] = {RADIUS | PROFILE | INNER | OUTER, CANDELA | LUMEN | WATT | FACTOR, true,
                        "not of a spot, which has \"candela\", \"lumen\" or \"watt\", cones, and "
                        "\"radius\""},
    [SUN] = {DIAMETER | ELEVATION | AZIMUTH, LUX, true,
             "not of a sun, which has \"lux\" and \"angular_diameter\""},
    [PPM_LIGHT_RECTANGLE] = {WIDTH | HEIGHT, NIT | CANDELA | LUMEN | WATT, true,
                             "not of a rectangle, which has \"nit\", \"candela\", \"lumen\" or "
                             "\"watt\", \"width\" and \"height\""},
    [PPM_LIGHT_DISK] = {WIDTH | HEIGHT | RADIUS, NIT | CANDELA | LUMEN | WATT, true,
                        "not of a disk, which has \"nit\", \"candela\", \"lumen\" or \"watt\", and "
                        "\"radius\" or \"width\" and \"height\""},
};

/* ---- which keys go together ------------------------------------------------------------------ */

static ppm_status check_quantity(const ppmi_setup_value *light, const light_words *words,
                                 uint64_t given)
{
    const uint64_t quantities = rules[words->kind].quantities;
    if (given & PROFILE) {
        return ppmi_setup_check_none(light, keys, KEY_COUNT, given, QUANTITIES & ~FACTOR,
                                     "the profile has the candela; \"factor\" multiplies it");
    }
    const ppm_status status = ppmi_setup_check_none(light, keys, KEY_COUNT, given, FACTOR,
                                                    "multiplies a \"profile\", which is not there");
    if (status != PPM_STATUS_OK) return status;
    return ppmi_setup_check_one(light, keys, KEY_COUNT, given, quantities & ~FACTOR, false);
}

static ppm_status check_shape(const ppmi_setup_value *light, const light_words *words,
                              uint64_t given)
{
    const bool has_both = given & WIDTH && given & HEIGHT, has_any = given & (WIDTH | HEIGHT);
    const bool is_disk = words->kind == PPM_LIGHT_DISK;
    if (is_disk && given & RADIUS) {
        if (!has_any && words->radius >= 1e-6) return PPM_STATUS_OK;
        return ppmi_setup_fail(light, "a disk has either a \"radius\" of at least 1e-06 or "
                                      "\"width\" and \"height\"");
    }
    if ((is_disk || words->kind == PPM_LIGHT_RECTANGLE) && !has_both) {
        return ppmi_setup_fail(light, "\"width\" and \"height\" expected%s",
                               is_disk ? ", or \"radius\"" : "");
    }
    if (words->kind == PPM_LIGHT_SPOT && words->inner_cone > words->outer_cone) {
        return ppmi_setup_fail(light, "inner_cone %g is wider than outer_cone %g",
                               words->inner_cone, words->outer_cone);
    }
    return PPM_STATUS_OK;
}

static ppm_status check_keys(const ppmi_setup_value *light, const light_words *words,
                             uint64_t given)
{
    if (!(given & KIND)) {
        return ppmi_setup_fail(light, "no \"kind\": expected point, spot, sun, rectangle or disk");
    }
    const uint64_t special = QUANTITIES | PROFILE | INNER | OUTER | DIAMETER | ELEVATION | AZIMUTH |
                             RADIUS | WIDTH | HEIGHT;
    const uint64_t foreign =
        special & ~(rules[words->kind].allowed | rules[words->kind].quantities);
    ppm_status status =
        ppmi_setup_check_none(light, keys, KEY_COUNT, given, foreign, rules[words->kind].reason);
    if (status == PPM_STATUS_OK) status = check_quantity(light, words, given);
    if (status == PPM_STATUS_OK) status = check_shape(light, words, given);
    return status;
}

/* ---- numbers --------------------------------------------------------------------------------- */

static double area_m2(const light_words *words)
{
    if (words->kind == PPM_LIGHT_RECTANGLE) return words->width * words->height;
    return 0.25 * PI * words->width * words->height;
}

/* What the scene wants for one lumen. */
static double per_lumen(const light_words *words)
{
    const double inner = cos(words->inner_cone * PI / 180.0);
    const double outer = cos(words->outer_cone * PI / 180.0);
    switch (words->kind) {
    case PPM_LIGHT_POINT:
        return 1.0 / (4.0 * PI);
    case PPM_LIGHT_SPOT:
        return 1.0 / (2.0 * PI * ((1.0 - inner) + (inner - outer) / 3.0));
    default:
        return 1.0 / (PI * area_m2(words));
    }
}

static double quantity_of(const light_words *words, uint64_t given)
{
    const bool is_flat = words->kind == PPM_LIGHT_RECTANGLE || words->kind == PPM_LIGHT_DISK;
    if (given & PROFILE) return given & FACTOR ? words->factor : 1.0;
    if (given & LUMEN) return words->lumen * per_lumen(words);
    if (given & WATT) return words->watt * lumens_per_watt * per_lumen(words);
    if (given & CANDELA) return is_flat ? words->candela / area_m2(words) : words->candela;
    return given & LUX ? words->lux : words->nit;
}

static ppm_status fill_intensity(const ppmi_setup_value *light, const light_words *words,
                                 uint64_t given, float out[3])
{
    const double quantity = quantity_of(words, given);
    double white[3] = {1.0, 1.0, 1.0};
    if (given & KELVIN) ppmi_setup_black_body(words->kelvin, white);
    for (int i = 0; i < 3; i++) {
        const double value = quantity * white[i] * words->color[i];
        if (!(value < 1e18))
            return ppmi_setup_fail(light, "its intensity, %g, is too large", value);
        out[i] = (float)value;
    }
    return PPM_STATUS_OK;
}

/* Where a sun of an elevation and an azimuth shines: clockwise seen from above, from north (-Z) by
 * east (+X), as --sun. */
static ppm_status take_sun_angles(const ppmi_setup_value *light, light_words *words,
                                  uint64_t *given)
{
    const uint64_t angles = *given & (ELEVATION | AZIMUTH);
    if (!angles) return PPM_STATUS_OK;
    if (angles != (ELEVATION | AZIMUTH) ||
        *given & (PPMI_SETUP_TARGET | PPMI_SETUP_DIRECTION | PPMI_SETUP_MATRIX)) {
        return ppmi_setup_fail(light, "\"elevation\" and \"azimuth\" go together, and stand in "
                                      "place of \"direction\", \"target\" and \"matrix\"");
    }
    const double h = words->elevation * PI / 180.0, a = words->azimuth * PI / 180.0;
    words->pose.direction[0] = -cos(h) * sin(a);
    words->pose.direction[1] = -sin(h);
    words->pose.direction[2] = cos(h) * cos(a);
    *given |= PPMI_SETUP_DIRECTION;
    return PPM_STATUS_OK;
}

static void fill_shape(light_words *words, uint64_t given, ppm_light_desc *desc)
{
    desc->inner_cone_rad = (float)(words->inner_cone * PI / 180.0);
    desc->outer_cone_rad = (float)(words->outer_cone * PI / 180.0);
    desc->angular_radius_rad = (float)(0.5 * words->angular_diameter * PI / 180.0);
    desc->width_m = (float)words->width;
    desc->height_m = (float)words->height;
    if (words->kind != PPM_LIGHT_DISK && given & RADIUS) desc->radius_m = (float)words->radius;
}

static ppm_status read_light(const ppmi_setup_value *light, light_words *words,
                             ppm_light_desc *desc)
{
    uint64_t given = 0;
    *words = (light_words){.color = {1.0f, 1.0f, 1.0f}, .outer_cone = 45.0, .visible = 1};
    ppm_status status = ppmi_setup_read_object(light, keys, KEY_COUNT, words, &given);
    if (status == PPM_STATUS_OK) status = check_keys(light, words, given);
    if (status == PPM_STATUS_OK) status = take_sun_angles(light, words, &given);
    if (status != PPM_STATUS_OK) return status;
    if (words->kind == PPM_LIGHT_DISK && given & RADIUS) {
        words->width = words->height = 2.0 * words->radius;
    }
    *desc = (ppm_light_desc){.size = sizeof *desc,
                             .name = words->name ? words->name : "",
                             .kind = words->kind,
                             .is_hidden = !words->visible,
                             .light_group = words->light_group};
    fill_shape(words, given, desc);
    status = fill_intensity(light, words, given, desc->intensity);
    if (status != PPM_STATUS_OK) return status;
    const uint64_t turned = PPMI_SETUP_TARGET | PPMI_SETUP_DIRECTION | PPMI_SETUP_MATRIX;
    if (given & PROFILE && !(given & turned)) { /* luminaires are measured hanging */
        words->pose.direction[1] = -1.0;
        given |= PPMI_SETUP_DIRECTION;
    }
    return ppmi_setup_pose_transform(light, &words->pose, given, words->kind != SUN,
                                     rules[words->kind].needs_direction, desc->transform);
}

/* ---- profiles -------------------------------------------------------------------------------- */

/* The whole file; the caller's. */
static ppm_status read_file(const ppmi_setup_value *place, const char *path, char **out_bytes,
                            size_t *out_count)
{
    enum { MOST = 16 << 20 };
    ppm_context *context = place->setup->context;
    FILE *file = fopen(path, "rb");
    const long size = file && fseek(file, 0, SEEK_END) == 0 ? ftell(file) : -1;
    ppm_status status = PPM_STATUS_OK;
    if (size <= 0 || size > MOST) {
        status =
            ppmi_setup_fail(place, "%s is empty, larger than %d bytes or unreadable", path, MOST);
    } else {
        *out_bytes = ppmi_alloc(context, (size_t)size, 1);
        if (!*out_bytes) status = ppmi_setup_out_of_memory(place->setup);
    }
    if (status == PPM_STATUS_OK) {
        rewind(file);
        *out_count = fread(*out_bytes, 1, (size_t)size, file);
    }
    if (file) fclose(file);
    return status;
}

/* Turns a light about the axis that it shines along, from +X towards +Y. */
static void turn(float transform[16], float angle)
{
    const float c = cosf(angle), s = sinf(angle);
    for (int i = 0; i < 3; i++) {
        const float x = transform[i], y = transform[4 + i];
        transform[i] = c * x + s * y;
        transform[4 + i] = c * y - s * x;
    }
}

static ppm_status add_profile(const ppmi_setup_value *place, const char *name,
                              const ppmi_ies_profile *parsed, ppm_light_desc *light)
{
    const ppm_light_profile_desc desc = {.size = sizeof desc,
                                         .name = name,
                                         .polar_count = parsed->polar_count,
                                         .azimuth_count = parsed->azimuth_count,
                                         .polar_rad = parsed->polar_rad,
                                         .azimuth_rad = parsed->azimuth_rad,
                                         .candela = parsed->candela};
    turn(light->transform, parsed->turn_rad);
    if (!place->setup->scene) return PPM_STATUS_OK;
    return ppm_scene_add_light_profile(place->setup->scene, &desc, &light->profile);
}

static ppm_status parse_profile(const ppmi_setup_value *place, const char *name, const char *bytes,
                                size_t count, ppm_light_desc *desc)
{
    ppm_setup *setup = place->setup;
    ppmi_ies_profile parsed = {0};
    const char *reason = "";
    ppm_status status = ppmi_ies_parse(setup->context, bytes, count, &parsed, &reason);
    if (status == PPM_STATUS_OK) {
        status = add_profile(place, name, &parsed, desc);
    } else if (status == PPM_STATUS_OUT_OF_MEMORY) {
        ppmi_setup_out_of_memory(setup);
    } else {
        status = ppmi_setup_fail(place, "\"%s\" is no IES profile: %s", name, reason);
    }
    ppmi_ies_deinit(setup->context, &parsed);
    return status;
}

static ppm_status use_profile(const ppmi_setup_value *light, const char *name, ppm_light_desc *desc)
{
    const ppmi_setup_value place =
        ppmi_setup_member(light, "profile", json_object_get(light->json, "profile"));
    char *path = NULL, *bytes = NULL;
    size_t count = 0;
    ppm_status status = ppmi_setup_find_file(&place, name, &path);
    if (status == PPM_STATUS_OK) status = read_file(&place, path, &bytes, &count);
    if (status == PPM_STATUS_OK) status = parse_profile(&place, name, bytes, count, desc);
    ppmi_free(light->setup->context, bytes);
    ppmi_free(light->setup->context, path);
    return status;
}

ppm_status ppmi_setup_light_section(const ppmi_setup_value *light)
{
    light_words words;
    ppm_light_desc desc;
    ppm_light_id id;
    ppm_status status = read_light(light, &words, &desc);
    if (status == PPM_STATUS_OK && words.profile) status = use_profile(light, words.profile, &desc);
    if (status != PPM_STATUS_OK || !light->setup->scene) return status;
    status = ppm_scene_add_light(light->setup->scene, &desc, &id);
    if (status == PPM_STATUS_INVALID_ARGUMENT) {
        return ppmi_setup_fail(light, "see the message above");
    }
    return status;
}
