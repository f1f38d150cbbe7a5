/* Lights and their profiles: checked and turned into unit vectors. */
#include <string.h>

#include "scene/scene.h"

/* Smaller disks could not be told from their middle in single precision. */
static const float least_angular_radius = 1e-4f;
/* Smaller balls would need radiances that single precision does not hold. */
static const float least_radius_m = 1e-6f;
static const float most_m = 1e15f;

static ppm_status fail_memory(ppm_scene *scene)
{
    return ppmi_fail(scene->context, PPM_STATUS_OUT_OF_MEMORY, "out of memory for scene arrays");
}

/* ---- profiles -------------------------------------------------------------------------------- */

static bool is_rising(const float *angles, uint32_t count, float most)
{
    for (uint32_t i = 0; i < count; i++) {
        const bool is_above = i == 0 ? angles[i] >= 0.0f : angles[i] > angles[i - 1];
        if (!is_above || !(angles[i] <= most)) return false;
    }
    return true;
}

static const char *profile_fault(const ppm_light_profile_desc *desc)
{
    const float slack = 1e-5f; /* pi in single precision may lie above */
    const uint32_t most = 1u << 14;
    if (desc->polar_count == 0 || desc->azimuth_count == 0 || desc->polar_count > most ||
        desc->azimuth_count > most || !desc->polar_rad || !desc->azimuth_rad || !desc->candela) {
        return "it needs 1 to 16384 polar angles and azimuths each";
    }
    if (!is_rising(desc->polar_rad, desc->polar_count, PPMI_PI + slack)) {
        return "polar angles must rise within 0 .. pi";
    }
    if (!is_rising(desc->azimuth_rad, desc->azimuth_count, 2.0f * PPMI_PI + slack) ||
        desc->azimuth_rad[0] != 0.0f) {
        return "azimuths must rise from 0, to 2 pi at most";
    }
    const size_t count = (size_t)desc->polar_count * desc->azimuth_count;
    for (size_t i = 0; i < count; i++) {
        if (!(desc->candela[i] >= 0.0f && desc->candela[i] < 1e18f)) {
            return "intensities must be at least 0 and finite";
        }
    }
    return NULL;
}

static float *copy_floats(ppm_scene *scene, const float *values, size_t count)
{
    float *copy = ppmi_alloc(scene->context, count, sizeof *copy);
    if (copy) memcpy(copy, values, count * sizeof *copy);
    return copy;
}

void ppmi_light_profile_deinit(ppm_context *context, ppmi_light_profile *profile)
{
    ppmi_free(context, profile->name);
    ppmi_free(context, profile->polar_rad);
    ppmi_free(context, profile->azimuth_rad);
    ppmi_free(context, profile->candela);
}

ppm_status ppm_scene_add_light_profile(ppm_scene *scene, const ppm_light_profile_desc *desc,
                                       ppm_light_profile_id *out_id)
{
    const ppm_status status = ppmi_scene_check_open(scene);
    if (status != PPM_STATUS_OK) return status;
    if (!desc || !out_id || desc->size < sizeof *desc) return PPM_STATUS_INVALID_ARGUMENT;
    const char *name = desc->name ? desc->name : "", *fault = profile_fault(desc);
    if (fault) {
        return ppmi_fail(scene->context, PPM_STATUS_INVALID_ARGUMENT, "light profile '%s': %s",
                         name, fault);
    }
    ppmi_light_profile *profiles =
        ppmi_scene_grow(scene->context, scene->profiles, scene->profile_count, sizeof *profiles);
    if (!profiles) return PPM_STATUS_OUT_OF_MEMORY;
    scene->profiles = profiles;
    const size_t count = (size_t)desc->polar_count * desc->azimuth_count;
    ppmi_light_profile profile = {
        .name = ppmi_string_copy(scene->context, name),
        .polar_rad = copy_floats(scene, desc->polar_rad, desc->polar_count),
        .azimuth_rad = copy_floats(scene, desc->azimuth_rad, desc->azimuth_count),
        .candela = copy_floats(scene, desc->candela, count),
        .polar_count = desc->polar_count,
        .azimuth_count = desc->azimuth_count,
    };
    if (!profile.name || !profile.polar_rad || !profile.azimuth_rad || !profile.candela) {
        ppmi_light_profile_deinit(scene->context, &profile);
        return fail_memory(scene);
    }
    profiles[scene->profile_count] = profile;
    *out_id = ++scene->profile_count;
    return PPM_STATUS_OK;
}

/* ---- lights ---------------------------------------------------------------------------------- */

static bool is_length(float value, bool may_be_zero)
{
    return value < most_m && (may_be_zero ? value >= 0.0f : value >= least_radius_m);
}

static const char *spot_fault(const ppm_light_desc *desc)
{
    const bool is_valid = desc->inner_cone_rad >= 0.0f && desc->outer_cone_rad > 0.0f &&
                          desc->inner_cone_rad <= desc->outer_cone_rad &&
                          desc->outer_cone_rad <= 0.5f * PPMI_PI + 1e-5f;
    return is_valid ? NULL : "cones must be 0 <= inner <= outer <= pi/2, outer above 0";
}

static const char *light_fault(const ppm_scene *scene, const ppm_light_desc *desc)
{
    for (uint32_t i = 0; i < 3; i++) {
        if (!(desc->intensity[i] >= 0.0f && desc->intensity[i] < 1e18f)) {
            return "intensity must be at least 0 and finite";
        }
    }
    const char *fault = NULL;
    switch (desc->kind) {
    case PPM_LIGHT_DIRECTIONAL:
        return desc->angular_radius_rad >= 0.0f && desc->angular_radius_rad < 0.5f * PPMI_PI
                   ? NULL
                   : "the angular radius must be within 0 .. pi/2";
    case PPM_LIGHT_RECTANGLE:
    case PPM_LIGHT_DISK:
        return is_length(desc->width_m, false) && is_length(desc->height_m, false)
                   ? NULL
                   : "width and height must be within 1e-6 .. 1e15 m";
    case PPM_LIGHT_SPOT:
        fault = spot_fault(desc);
        break;
    case PPM_LIGHT_POINT:
        break;
    default:
        return "its kind is unknown";
    }
    if (!fault && !is_length(desc->radius_m, true)) fault = "the radius must be within 0 .. 1e15 m";
    if (!fault && desc->profile > scene->profile_count) fault = "there is no such profile";
    return fault;
}

/* The axes of a transform as an orthonormal frame; scale and shear are dropped. */
static bool unit_axes(const ppmi_transform *m, ppmi_vec3 *right, ppmi_vec3 *up, ppmi_vec3 *back)
{
    if (!ppmi_transform_is_finite(m) || vec3_max_abs(m->origin) > PPMI_FARTHEST_M) return false;
    *back = vec3_normalize(m->z);
    *right = vec3_normalize(vec3_cross(m->y, *back));
    *up = vec3_cross(*back, *right);
    return vec3_length2(*back) > 0.5f && vec3_length2(*right) > 0.5f;
}

bool ppmi_light_group_copy(ppm_context *context, const char *group, char **out_group)
{
    const bool is_given = group && group[0] != '\0';
    *out_group = is_given ? ppmi_string_copy(context, group) : NULL;
    return !is_given || *out_group;
}

/* A checked desc as what rendering reads, without a place; name is taken. */
static void fill(const ppm_light_desc *desc, char *name, ppmi_vec3 right, ppmi_vec3 up,
                 ppmi_vec3 back, ppmi_punctual *light)
{
    const bool is_flat = desc->kind == PPM_LIGHT_RECTANGLE || desc->kind == PPM_LIGHT_DISK;
    const bool is_lamp = desc->kind == PPM_LIGHT_POINT || desc->kind == PPM_LIGHT_SPOT;
    const bool has_disk =
        desc->kind == PPM_LIGHT_DIRECTIONAL && desc->angular_radius_rad >= least_angular_radius;
    *light = (ppmi_punctual){
        .name = name,
        .kind = desc->kind,
        .direction = vec3_neg(back),
        .intensity = vec3_load(desc->intensity),
        .cos_inner = cosf(desc->inner_cone_rad),
        .cos_outer = cosf(desc->outer_cone_rad),
        .angular_radius_rad = has_disk ? desc->angular_radius_rad : 0.0f,
        .right = right,
        .up = up,
        .radius_m = is_lamp && desc->radius_m >= least_radius_m ? desc->radius_m : 0.0f,
        .half_width_m = is_flat ? 0.5f * desc->width_m : 0.0f,
        .half_height_m = is_flat ? 0.5f * desc->height_m : 0.0f,
        .is_hidden = desc->is_hidden != 0,
        .profile = is_lamp ? desc->profile : 0,
    };
}

/* Checks desc and makes a light of it, with a copy of the name. */
static ppm_status make_light(ppm_scene *scene, const ppm_light_desc *desc, ppmi_punctual *out_light)
{
    const char *name = desc->name ? desc->name : "", *fault = light_fault(scene, desc);
    float intensity[3];
    const ppmi_transform to_world = ppmi_transform_load(desc->transform);
    ppmi_vec3 right, up, back;
    if (!fault && !unit_axes(&to_world, &right, &up, &back)) {
        fault = "its transform is singular or not finite";
    }
    if (fault) {
        return ppmi_fail(scene->context, PPM_STATUS_INVALID_ARGUMENT, "light '%s': %s", name,
                         fault);
    }
    char *name_copy = ppmi_string_copy(scene->context, name);
    char *group;
    if (!name_copy || !ppmi_light_group_copy(scene->context, desc->light_group, &group)) {
        ppmi_free(scene->context, name_copy);
        return fail_memory(scene);
    }
    fill(desc, name_copy, right, up, back, out_light);
    out_light->light_group = group;
    ppmi_working_light(&scene->working, desc->intensity, intensity);
    out_light->intensity = vec3_load(intensity);
    out_light->position = out_light->given_position = to_world.origin;
    return PPM_STATUS_OK;
}

ppm_status ppm_scene_add_light(ppm_scene *scene, const ppm_light_desc *desc, ppm_light_id *out_id)
{
    ppm_status status = ppmi_scene_check_open(scene);
    if (status != PPM_STATUS_OK) return status;
    if (!desc || !out_id || desc->size < sizeof *desc) return PPM_STATUS_INVALID_ARGUMENT;
    ppmi_punctual *punctuals =
        ppmi_scene_grow(scene->context, scene->punctuals, scene->punctual_count, sizeof *punctuals);
    if (!punctuals) return PPM_STATUS_OUT_OF_MEMORY;
    scene->punctuals = punctuals;
    status = make_light(scene, desc, &punctuals[scene->punctual_count]);
    if (status == PPM_STATUS_OK) *out_id = ++scene->punctual_count;
    return status;
}

ppm_status ppm_scene_set_light(ppm_scene *scene, ppm_light_id id, const ppm_light_desc *desc)
{
    ppm_status status = ppmi_scene_check_open(scene);
    if (status != PPM_STATUS_OK) return status;
    if (!desc || desc->size < sizeof *desc) return PPM_STATUS_INVALID_ARGUMENT;
    if (id == 0 || id > scene->punctual_count) {
        return ppmi_fail(scene->context, PPM_STATUS_INVALID_ARGUMENT, "light %u of %u", id,
                         scene->punctual_count);
    }
    ppmi_punctual light;
    status = make_light(scene, desc, &light);
    if (status != PPM_STATUS_OK) return status;
    ppmi_free(scene->context, scene->punctuals[id - 1].name);
    ppmi_free(scene->context, scene->punctuals[id - 1].light_group);
    scene->punctuals[id - 1] = light;
    return PPM_STATUS_OK;
}
