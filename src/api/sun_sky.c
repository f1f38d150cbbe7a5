/* A clear sky as an environment image, and its sun as a directional light. */
#include "color/color.h"
#include "light/sky.h"
#include "scene/scene.h"

/* The sky is smooth; the horizon, between two rows, is blurred by a third of a degree. */
enum { SKY_WIDTH = 1024, SKY_HEIGHT = 512 };

void ppm_sun_sky_desc_init(ppm_sun_sky_desc *desc)
{
    if (!desc) return;
    *desc = (ppm_sun_sky_desc){
        .size = sizeof *desc,
        .elevation_rad = 0.25f * PPMI_PI,
        .azimuth_rad = 0.75f * PPMI_PI,
        .turbidity = 3.0f,
        .factor = 1.0f,
        .ground_albedo = 0.2f,
    };
}

static bool is_in(float value, float low, float high)
{
    return value >= low && value <= high;
}

static bool is_valid(const ppm_sun_sky_desc *desc)
{
    return is_in(desc->elevation_rad, 0.0f, 0.5f * PPMI_PI + 1e-6f) &&
           isfinite(desc->azimuth_rad) && is_in(desc->turbidity, 2.0f, 10.0f) &&
           is_in(desc->factor, 0.0f, 1e9f) && is_in(desc->ground_albedo, 0.0f, 1.0f);
}

static ppm_status add_sky_image(ppm_scene *scene, const ppmi_sky *sky, float ground_albedo,
                                ppm_image_id *out_id)
{
    ppm_context *context = scene->context;
    ppmi_image image = {
        .name = ppmi_string_copy(context, "sky"),
        .width = SKY_WIDTH,
        .height = SKY_HEIGHT,
        .channels = 3,
        .f32 = ppmi_alloc(context, (size_t)3 * SKY_WIDTH * SKY_HEIGHT, sizeof(float)),
    };
    ppm_status status = PPM_STATUS_OUT_OF_MEMORY;
    if (image.name && image.f32) {
        const ppmi_vec3 lux = vec3_add(ppmi_sky_ground_lux(sky), ppmi_sky_sun_ground_lux(sky));
        const ppmi_vec3 ground = vec3_scale(lux, ground_albedo * PPMI_INV_PI);
        ppmi_sky_fill(sky, ground, SKY_WIDTH, SKY_HEIGHT, image.f32);
        ppmi_color_from_rec709(scene->color, image.f32, (size_t)SKY_WIDTH * SKY_HEIGHT, 3);
        image.is_working = scene->working.differs;
        status = ppmi_scene_take_image(scene, &image, out_id);
    } else {
        ppmi_fail(context, status, "out of memory for the sky");
    }
    if (status != PPM_STATUS_OK) {
        ppmi_free(context, image.name);
        ppmi_free(context, image.f32);
    }
    return status;
}

static ppm_status set_sky(ppm_scene *scene, const ppmi_sky *sky, const ppm_sun_sky_desc *desc)
{
    const ppmi_environment before = scene->environment;
    ppm_environment_desc environment = {
        .size = sizeof environment,
        .radiance = {desc->factor, desc->factor, desc->factor},
        .light_group = before.light_group,
    };
    ppm_status status = add_sky_image(scene, sky, desc->ground_albedo, &environment.image);
    if (status == PPM_STATUS_OK) status = ppm_scene_set_environment(scene, &environment);
    if (status != PPM_STATUS_OK) return status;
    scene->environment.has_backdrop = before.has_backdrop; /* is in the working space already */
    scene->environment.backdrop = before.backdrop;
    return PPM_STATUS_OK;
}

static ppm_status add_sun(ppm_scene *scene, const ppmi_sky *sky, float factor, ppm_light_id *out_id)
{
    const ppmi_frame frame = ppmi_frame_from_normal(sky->to_sun); /* lights shine along -Z */
    ppm_light_desc light = {.size = sizeof light,
                            .name = "sun",
                            .kind = PPM_LIGHT_DIRECTIONAL,
                            .angular_radius_rad = PPMI_SUN_ANGULAR_RADIUS_RAD};
    vec3_store(light.transform, frame.s);
    vec3_store(light.transform + 4, frame.t);
    vec3_store(light.transform + 8, frame.n);
    light.transform[15] = 1.0f;
    vec3_store(light.intensity, vec3_scale(sky->sun_lux, factor));
    return ppm_scene_add_light(scene, &light, out_id);
}

ppm_status ppm_scene_add_sun_sky(ppm_scene *scene, const ppm_sun_sky_desc *desc,
                                 ppm_light_id *out_sun)
{
    ppm_status status = ppmi_scene_check_open(scene);
    if (status != PPM_STATUS_OK) return status;
    if (!desc || desc->size < sizeof *desc || !is_valid(desc)) {
        return ppmi_fail(scene->context, PPM_STATUS_INVALID_ARGUMENT,
                         "sun: elevation must be 0 .. pi/2, turbidity 2 .. 10, the ground's albedo "
                         "0 .. 1, the factor 0 .. 1e9");
    }
    const ppmi_sky sky = ppmi_sky_of(desc->elevation_rad, desc->azimuth_rad, desc->turbidity);
    if (!desc->sun_only) status = set_sky(scene, &sky, desc);
    ppm_light_id id;
    if (status == PPM_STATUS_OK) status = add_sun(scene, &sky, desc->factor, &id);
    if (status == PPM_STATUS_OK && out_sun) *out_sun = id;
    return status;
}
