/* The surroundings: an even radiance, a picture, or a clear sky with its sun; and fog. */
#include <math.h>
#include <string.h>

#include "setup/setup_file.h"

static const double radians = 3.14159265358979323846 / 180.0;

/* ---- sun and sky ----------------------------------------------------------------------------- */

typedef struct sky_words {
    double elevation, azimuth, turbidity, intensity, ground_albedo;
    uint32_t is_given;
} sky_words;

#define FIELD(member) .field = offsetof(sky_words, member)
static const ppmi_setup_key sky_keys[] = {
    {"elevation", PPMI_SETUP_REAL, FIELD(elevation), 0, 90},
    {"azimuth", PPMI_SETUP_REAL, FIELD(azimuth), -360, 360},
    {"turbidity", PPMI_SETUP_REAL, FIELD(turbidity), 2, 10},
    {"intensity", PPMI_SETUP_REAL, FIELD(intensity), 0, 1e9},
    {"ground_albedo", PPMI_SETUP_REAL, FIELD(ground_albedo), 0, 1},
};
#undef FIELD

static ppm_status read_sky(const ppmi_setup_value *value, const ppmi_setup_key *key, void *target)
{
    sky_words *words = (sky_words *)((char *)target + key->field);
    const size_t count = sizeof sky_keys / sizeof sky_keys[0];
    uint64_t given = 0;
    *words = (sky_words){.turbidity = 3.0, .intensity = 1.0, .ground_albedo = 0.2, .is_given = 1};
    const ppm_status status = ppmi_setup_read_object(value, sky_keys, count, words, &given);
    if (status != PPM_STATUS_OK || (given & 3) == 3) return status;
    return ppmi_setup_fail(value, "\"elevation\" and \"azimuth\" of the sun expected, in degrees");
}

/* ---- the environment ------------------------------------------------------------------------- */

typedef struct environment_words {
    const char *image;
    double rotation, intensity;
    float color[3], backdrop[3];
    sky_words sky;
} environment_words;

enum { IMAGE = 1, ROTATION = 2, INTENSITY = 4, COLOR = 8, BACKDROP = 16, SKY = 32 };

#define FIELD(member) .field = offsetof(environment_words, member)
static const ppmi_setup_key keys[] = {
    {"image", PPMI_SETUP_TEXT, FIELD(image)},
    {"rotation", PPMI_SETUP_REAL, FIELD(rotation), -360, 360},
    {"intensity", PPMI_SETUP_REAL, FIELD(intensity), 0, 1e9},
    {"color", PPMI_SETUP_COLOR, FIELD(color), 0, 1e15},
    {"backdrop", PPMI_SETUP_COLOR, FIELD(backdrop), 0, 1e15},
    {"sun_sky", PPMI_SETUP_OWN, FIELD(sky), .read = read_sky},
};
#undef FIELD
enum { KEY_COUNT = sizeof keys / sizeof keys[0] };

static ppm_status read_environment(const ppmi_setup_value *environment, environment_words *words,
                                   uint64_t *given)
{
    *words = (environment_words){.intensity = 1.0, .color = {1.0f, 1.0f, 1.0f}};
    ppm_status status = ppmi_setup_read_object(environment, keys, KEY_COUNT, words, given);
    if (status == PPM_STATUS_OK && !(*given & IMAGE)) {
        status = ppmi_setup_check_none(environment, keys, KEY_COUNT, *given, ROTATION | INTENSITY,
                                       "of an \"image\", which is not there");
    }
    if (status == PPM_STATUS_OK && *given & SKY && !(*given & IMAGE)) {
        status = ppmi_setup_check_none(environment, keys, KEY_COUNT, *given, COLOR,
                                       "the sky of \"sun_sky\" has its own");
    }
    if (status == PPM_STATUS_OK && *given == 0) {
        status = ppmi_setup_fail(environment, "it is empty: expected image, color, sun_sky or "
                                              "backdrop");
    }
    return status;
}

/* What the scene has stays where the file says nothing of it. */
static ppm_status set_environment(const ppmi_setup_value *environment,
                                  const environment_words *words, uint64_t given)
{
    ppm_environment_desc desc = {.size = sizeof desc};
    ppm_status status = ppm_scene_get_environment(environment->setup->scene, &desc);
    if (status != PPM_STATUS_OK) return status;
    if (given & (IMAGE | COLOR)) {
        desc.image = 0;
        desc.rotation_rad = (float)(words->rotation * radians);
        for (int i = 0; i < 3; i++)
            desc.radiance[i] = (float)words->intensity * words->color[i];
    }
    if (given & IMAGE) {
        const ppmi_setup_value place = ppmi_setup_member(environment, "image", NULL);
        status = ppmi_setup_use_image(&place, words->image, PPM_IMAGE_COLOR, &desc.image);
        if (status != PPM_STATUS_OK) return status;
    }
    if (given & BACKDROP) {
        desc.has_backdrop = 1;
        memcpy(desc.backdrop, words->backdrop, sizeof desc.backdrop);
    }
    return ppm_scene_set_environment(environment->setup->scene, &desc);
}

static ppm_status add_sky(const ppmi_setup_value *environment, const sky_words *words,
                          bool sun_only)
{
    ppm_sun_sky_desc desc;
    ppm_sun_sky_desc_init(&desc);
    desc.elevation_rad = (float)(words->elevation * radians);
    desc.azimuth_rad = (float)(words->azimuth * radians);
    desc.turbidity = (float)words->turbidity;
    desc.factor = (float)words->intensity;
    desc.ground_albedo = (float)words->ground_albedo;
    desc.sun_only = sun_only;
    return ppm_scene_add_sun_sky(environment->setup->scene, &desc, NULL);
}

ppm_status ppmi_setup_environment_section(const ppmi_setup_value *environment)
{
    environment_words words;
    uint64_t given = 0;
    ppm_status status = read_environment(environment, &words, &given);
    if (status != PPM_STATUS_OK) return status;
    if (!environment->setup->scene) {
        const ppmi_setup_value place = ppmi_setup_member(environment, "image", NULL);
        ppm_image_id none;
        return given & IMAGE ? ppmi_setup_use_image(&place, words.image, PPM_IMAGE_COLOR, &none)
                             : PPM_STATUS_OK;
    }
    status = set_environment(environment, &words, given);
    if (status == PPM_STATUS_OK && words.sky.is_given) {
        status = add_sky(environment, &words.sky, given & IMAGE);
    }
    return status;
}

/* ---- fog ------------------------------------------------------------------------------------- */

#define FIELD(member) .field = offsetof(ppm_fog_desc, member)
static const ppmi_setup_key fog_keys[] = {
    {"sigma_s", PPMI_SETUP_COLOR, FIELD(sigma_s), 0, 1e9},
    {"sigma_a", PPMI_SETUP_COLOR, FIELD(sigma_a), 0, 1e9},
    {"g", PPMI_SETUP_FLOAT, FIELD(asymmetry_g), -0.999999, 0.999999},
};
#undef FIELD

ppm_status ppmi_setup_fog_section(const ppmi_setup_value *fog)
{
    ppm_fog_desc desc = {.size = sizeof desc};
    const size_t count = sizeof fog_keys / sizeof fog_keys[0];
    const ppm_status status = ppmi_setup_read_object(fog, fog_keys, count, &desc, NULL);
    if (status != PPM_STATUS_OK || !fog->setup->scene) return status;
    return ppm_scene_set_fog(fog->setup->scene, &desc);
}
