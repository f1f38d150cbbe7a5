/* Scene: creation, destruction, images, materials and facts. */
#include "scene/scene.h"

#include <string.h>

#include "scene/instance.h"

ppm_status ppmi_scene_check_open(const ppm_scene *scene)
{
    if (!scene) return PPM_STATUS_INVALID_ARGUMENT;
    if (scene->is_frozen) {
        return ppmi_fail(scene->context, PPM_STATUS_WRONG_STATE,
                         "the scene is frozen: a render session of it is alive");
    }
    return PPM_STATUS_OK;
}

void *ppmi_scene_grow(ppm_context *context, void *array, uint32_t count, size_t element_size)
{
    /* capacities are the powers of two from 8: growth is due exactly at a full power of two */
    enum { FIRST_CAPACITY = 8 };
    const bool is_full = count == 0 || (count >= FIRST_CAPACITY && (count & (count - 1)) == 0);
    if (is_full) {
        const size_t capacity = count == 0 ? FIRST_CAPACITY : 2 * (size_t)count;
        void *larger = count < UINT32_MAX / 2 ? ppmi_alloc(context, capacity, element_size) : NULL;
        if (!larger) {
            ppmi_fail(context, PPM_STATUS_OUT_OF_MEMORY, "out of memory for scene arrays");
            return NULL;
        }
        if (array) memcpy(larger, array, count * element_size);
        ppmi_free(context, array);
        array = larger;
    }
    memset((char *)array + count * element_size, 0, element_size);
    return array;
}

static void primitive_deinit(ppm_context *context, ppmi_primitive *primitive)
{
    ppmi_free(context, primitive->positions);
    ppmi_free(context, primitive->normals);
    ppmi_free(context, primitive->tangents);
    for (uint32_t i = 0; i < PPM_MAX_UV_SETS; i++)
        ppmi_free(context, primitive->uvs[i]);
    ppmi_free(context, primitive->colors);
    ppmi_free(context, primitive->indices);
    ppmi_free(context, primitive->given_indices);
}

static void mesh_deinit(ppm_context *context, ppmi_mesh *mesh)
{
    for (uint32_t i = 0; i < mesh->primitive_count; i++) {
        primitive_deinit(context, &mesh->primitives[i]);
    }
    ppmi_free(context, mesh->primitives);
    ppmi_free(context, mesh->name);
}

void ppm_scene_destroy(ppm_scene *scene)
{
    if (!scene) return;
    ppm_context *context = scene->context;
    if (scene->accel.data) scene->accel.destroy(scene->accel.data);
    for (uint32_t i = 0; i < scene->image_count; i++) {
        ppmi_free(context, scene->images[i].u8);
        ppmi_free(context, scene->images[i].f32);
        ppmi_free(context, scene->images[i].mips);
        ppmi_free(context, scene->images[i].mip_pixels);
        ppmi_free(context, scene->images[i].name);
    }
    for (uint32_t i = 0; i < scene->material_count; i++) {
        ppmi_free(context, scene->materials[i].name);
    }
    for (uint32_t i = 0; i < scene->mesh_count; i++)
        mesh_deinit(context, &scene->meshes[i]);
    for (uint32_t i = 0; i < scene->instance_count; i++)
        ppmi_instance_deinit(context, &scene->instances[i]);
    for (uint32_t i = 0; i < scene->camera_count; i++) {
        ppmi_free(context, scene->cameras[i].name);
        ppmi_free(context, scene->cameras[i].motion);
    }
    for (uint32_t i = 0; i < scene->punctual_count; i++) {
        ppmi_free(context, scene->punctuals[i].name);
        ppmi_free(context, scene->punctuals[i].light_group);
    }
    for (uint32_t i = 0; i < scene->profile_count; i++) {
        ppmi_light_profile_deinit(context, &scene->profiles[i]);
    }
    ppmi_free(context, scene->environment.light_group);
    ppmi_free(context, scene->profiles);
    ppmi_free(context, scene->images);
    ppmi_free(context, scene->materials);
    ppmi_free(context, scene->meshes);
    ppmi_free(context, scene->instances);
    ppmi_free(context, scene->cameras);
    ppmi_free(context, scene->punctuals);
    ppmi_free(context, scene);
}

ppm_status ppmi_scene_take_image(ppm_scene *scene, const ppmi_image *image, ppm_image_id *out_id)
{
    ppmi_image *images =
        ppmi_scene_grow(scene->context, scene->images, scene->image_count, sizeof *images);
    if (!images) return PPM_STATUS_OUT_OF_MEMORY;
    scene->images = images;
    images[scene->image_count] = *image;
    *out_id = ++scene->image_count;
    return PPM_STATUS_OK;
}

/* ---- materials ------------------------------------------------------------------------------- */

void ppm_material_desc_init(ppm_material_desc *desc)
{
    *desc = (ppm_material_desc){
        .size = sizeof *desc,
        .base_color = {1.0f, 1.0f, 1.0f, 1.0f},
        .roughness = 0.5f,
        .normal_scale = 1.0f,
        .ior = 1.5f,
        .specular = 1.0f,
        .specular_color = {1.0f, 1.0f, 1.0f},
        .attenuation_color = {1.0f, 1.0f, 1.0f},
        .alpha_cutoff = 0.5f,
        .double_sided = 1,
        .clearcoat_normal_scale = 1.0f,
        .iridescence_ior = 1.3f,
        .coat_ior = 1.5f,
        .coat_color = {1.0f, 1.0f, 1.0f},
        .iridescence_thickness_min_nm = 100.0f,
        .iridescence_thickness_max_nm = 400.0f,
        .diffuse_transmission_color = {1.0f, 1.0f, 1.0f},
    };
}

static bool all_in(const float *values, uint32_t count, float low, float high)
{
    for (uint32_t i = 0; i < count; i++) {
        if (!(values[i] >= low && values[i] <= high)) return false;
    }
    return true;
}

static ppm_status check_texture(const ppm_scene *scene, const char *slot,
                                const ppm_texture *texture)
{
    if (texture->image > scene->image_count || texture->uv_set >= PPM_MAX_UV_SETS) {
        return ppmi_fail(scene->context, PPM_STATUS_INVALID_ARGUMENT,
                         "material: %s texture: image %u of %u, uv set %u of %u", slot,
                         texture->image, scene->image_count, texture->uv_set, PPM_MAX_UV_SETS);
    }
    const bool modes_are_known =
        texture->wrap_u >= PPM_WRAP_REPEAT && texture->wrap_u <= PPM_WRAP_MIRROR &&
        texture->wrap_v >= PPM_WRAP_REPEAT && texture->wrap_v <= PPM_WRAP_MIRROR &&
        texture->filter >= PPM_FILTER_LINEAR && texture->filter <= PPM_FILTER_NEAREST;
    if (!modes_are_known) {
        return ppmi_fail(scene->context, PPM_STATUS_INVALID_ARGUMENT,
                         "material: %s texture: unknown wrap mode or filter", slot);
    }
    if (texture->has_transform && !all_in(texture->uv_transform, 6, -1e18f, 1e18f)) {
        return ppmi_fail(scene->context, PPM_STATUS_INVALID_ARGUMENT,
                         "material: %s texture: the uv transform is not finite", slot);
    }
    return PPM_STATUS_OK;
}

static ppm_status check_textures(const ppm_scene *scene, const ppm_material_desc *desc)
{
    const struct {
        const char *slot;
        const ppm_texture *texture;
    } slots[] = {
        {"base colour", &desc->base_color_texture},
        {"metallic-roughness", &desc->metallic_roughness_texture},
        {"normal", &desc->normal_texture},
        {"emission", &desc->emission_texture},
        {"specular", &desc->specular_texture},
        {"specular colour", &desc->specular_color_texture},
        {"transmission", &desc->transmission_texture},
        {"clearcoat", &desc->clearcoat_texture},
        {"clearcoat roughness", &desc->clearcoat_roughness_texture},
        {"clearcoat normal", &desc->clearcoat_normal_texture},
        {"sheen colour", &desc->sheen_color_texture},
        {"sheen roughness", &desc->sheen_roughness_texture},
        {"iridescence", &desc->iridescence_texture},
        {"iridescence thickness", &desc->iridescence_thickness_texture},
        {"anisotropy", &desc->anisotropy_texture},
        {"diffuse transmission", &desc->diffuse_transmission_texture},
        {"diffuse transmission colour", &desc->diffuse_transmission_color_texture},
        {"retroreflection", &desc->retroreflection_texture},
        {"diffuse roughness", &desc->diffuse_roughness_texture},
        {"coat colour", &desc->coat_color_texture},
        {"coat anisotropy", &desc->coat_anisotropy_texture},
        {"fuzz", &desc->fuzz_texture},
    };
    for (size_t i = 0; i < sizeof slots / sizeof slots[0]; i++) {
        const ppm_status status = check_texture(scene, slots[i].slot, slots[i].texture);
        if (status != PPM_STATUS_OK) return status;
    }
    return PPM_STATUS_OK;
}

static ppm_status check_factors(const ppm_scene *scene, const ppm_material_desc *desc)
{
    const float huge = 1e18f;
    const struct {
        const char *name;
        const float *values;
        uint32_t count;
        float low, high;
    } ranges[] = {
        {"base_color", desc->base_color, 4, 0.0f, 1.0f},
        {"metallic", &desc->metallic, 1, 0.0f, 1.0f},
        {"roughness", &desc->roughness, 1, 0.0f, 1.0f},
        {"normal_scale", &desc->normal_scale, 1, -huge, huge},
        {"emission", desc->emission, 3, 0.0f, huge},
        {"ior", &desc->ior, 1, 0.0f, 1e3f},
        {"specular", &desc->specular, 1, 0.0f, 1.0f},
        {"specular_color", desc->specular_color, 3, 0.0f, huge},
        {"transmission", &desc->transmission, 1, 0.0f, 1.0f},
        {"attenuation_color", desc->attenuation_color, 3, 0.0f, 1.0f},
        {"attenuation_distance_m", &desc->attenuation_distance_m, 1, 0.0f, INFINITY},
        {"dispersion", &desc->dispersion, 1, 0.0f, 1e3f},
        {"alpha_cutoff", &desc->alpha_cutoff, 1, 0.0f, huge},
        {"clearcoat", &desc->clearcoat, 1, 0.0f, 1.0f},
        {"clearcoat_roughness", &desc->clearcoat_roughness, 1, 0.0f, 1.0f},
        {"clearcoat_normal_scale", &desc->clearcoat_normal_scale, 1, -huge, huge},
        {"sheen_color", desc->sheen_color, 3, 0.0f, 1.0f},
        {"sheen_roughness", &desc->sheen_roughness, 1, 0.0f, 1.0f},
        {"iridescence", &desc->iridescence, 1, 0.0f, 1.0f},
        {"iridescence_ior", &desc->iridescence_ior, 1, 1.0f, 1e3f},
        {"iridescence_thickness_min_nm", &desc->iridescence_thickness_min_nm, 1, 0.0f, 1e9f},
        {"iridescence_thickness_max_nm", &desc->iridescence_thickness_max_nm, 1, 0.0f, 1e9f},
        {"anisotropy", &desc->anisotropy, 1, 0.0f, 1.0f},
        {"anisotropy_rotation_rad", &desc->anisotropy_rotation_rad, 1, -1e6f, 1e6f},
        {"diffuse_transmission", &desc->diffuse_transmission, 1, 0.0f, 1.0f},
        {"diffuse_transmission_color", desc->diffuse_transmission_color, 3, 0.0f, 1.0f},
        {"multiscatter_color", desc->multiscatter_color, 3, 0.0f, 1.0f},
        {"scatter_anisotropy_g", &desc->scatter_anisotropy_g, 1, -0.999999f, 0.999999f},
        {"retroreflection", &desc->retroreflection, 1, 0.0f, 1.0f},
        {"diffuse_roughness", &desc->diffuse_roughness, 1, 0.0f, 1.0f},
        {"coat_ior", &desc->coat_ior, 1, 0.0f, 1e3f},
        {"coat_color", desc->coat_color, 3, 0.0f, 1.0f},
        {"coat_darkening", &desc->coat_darkening, 1, 0.0f, 1.0f},
        {"coat_anisotropy", &desc->coat_anisotropy, 1, 0.0f, 1.0f},
        {"coat_anisotropy_rotation_rad", &desc->coat_anisotropy_rotation_rad, 1, -1e6f, 1e6f},
        {"fuzz", &desc->fuzz, 1, 0.0f, 1.0f},
    };
    for (size_t i = 0; i < sizeof ranges / sizeof ranges[0]; i++) {
        if (!all_in(ranges[i].values, ranges[i].count, ranges[i].low, ranges[i].high)) {
            return ppmi_fail(scene->context, PPM_STATUS_INVALID_ARGUMENT,
                             "material '%s': %s is not within %g .. %g",
                             desc->name ? desc->name : "", ranges[i].name, (double)ranges[i].low,
                             (double)ranges[i].high);
        }
    }
    if (desc->alpha_mode < PPM_ALPHA_OPAQUE || desc->alpha_mode > PPM_ALPHA_BLEND ||
        desc->transmission_kind < PPM_TRANSMISSION_SOLID ||
        desc->transmission_kind > PPM_TRANSMISSION_THIN) {
        return ppmi_fail(scene->context, PPM_STATUS_INVALID_ARGUMENT,
                         "material '%s': unknown alpha mode or kind of transmission",
                         desc->name ? desc->name : "");
    }
    return PPM_STATUS_OK;
}

/* The share of what a medium takes from a beam that it scatters, by its albedo after all
 * scattering: Kulla and Conty 2017, "Revisiting Physically Based Shading at Imageworks", as
 * KHR_materials_volume_scatter has it. */
static float single_scattering_albedo(float multiscatter)
{
    const float c = multiscatter;
    if (!(c > 0.0f)) return 0.0f; /* the fit leaves 6e-6 */
    const float s = 4.09712f + 4.20863f * c - sqrtf(9.59217f + (41.6808f + 17.7126f * c) * c);
    return ppmi_clampf(1.0f - s * s, 0.0f, 1.0f);
}

/* Beer-Lambert by KHR_materials_volume: sigma_t = -ln(attenuationColor) / attenuationDistance, all
 * of it absorption unless KHR_materials_volume_scatter makes a part of it scattering. */
static ppmi_medium medium_inside(const ppm_material_desc *desc)
{
    const float distance = desc->attenuation_distance_m;
    if (!(distance > 0.0f) || isinf(distance)) return (ppmi_medium){0};
    float sigma_a[3], sigma_s[3];
    for (int i = 0; i < 3; i++) { /* black would be infinite */
        const float sigma_t = -logf(ppmi_max(desc->attenuation_color[i], 1e-30f)) / distance;
        sigma_s[i] = sigma_t * single_scattering_albedo(desc->multiscatter_color[i]);
        sigma_a[i] = sigma_t - sigma_s[i];
    }
    return (ppmi_medium){.sigma_s = vec3_load(sigma_s),
                         .sigma_a = vec3_load(sigma_a),
                         .asymmetry_g = desc->scatter_anisotropy_g};
}

static bool is_empty(const ppmi_medium *medium)
{
    return vec3_is_black(medium->sigma_s) && vec3_is_black(medium->sigma_a);
}

/* The colours of a material, factors as reflectances (KHR_materials_specular's may be above 1). */
static void to_working_space(const ppmi_working_space *space, ppm_material_desc *desc)
{
    float *const reflectances[] = {desc->base_color,  desc->attenuation_color,
                                   desc->sheen_color, desc->multiscatter_color,
                                   desc->coat_color,  desc->diffuse_transmission_color};
    for (size_t i = 0; i < sizeof reflectances / sizeof reflectances[0]; i++)
        ppmi_working_reflectance(space, reflectances[i], reflectances[i]);
    ppmi_working_light(space, desc->emission, desc->emission);
    ppmi_working_light(space, desc->specular_color, desc->specular_color);
}

/* What rendering asks of a material again and again. A surface that transmits diffusely bounds a
 * solid where there is something inside: it is no border for anything else. */
static void derive(ppmi_material *material)
{
    const ppm_material_desc *desc = &material->desc;
    const bool is_solid = desc->transmission_kind == PPM_TRANSMISSION_SOLID;
    const ppmi_medium inside = medium_inside(desc);
    material->emits = !vec3_is_black(vec3_load(desc->emission));
    material->has_alpha = desc->alpha_mode != PPM_ALPHA_OPAQUE;
    material->is_solid_glass =
        is_solid &&
        (desc->transmission > 0.0f || (desc->diffuse_transmission > 0.0f && !is_empty(&inside)));
    material->is_sheet = !is_solid && desc->transmission > 0.0f;
    material->inside = material->is_solid_glass ? inside : (ppmi_medium){0};
    material->is_layered = desc->clearcoat > 0.0f || desc->iridescence > 0.0f ||
                           !vec3_is_black(vec3_load(desc->sheen_color)) ||
                           desc->anisotropy > 0.0f || desc->diffuse_transmission > 0.0f ||
                           desc->retroreflection > 0.0f || desc->fuzz > 0.0f ||
                           (desc->specular_is_edge_color && desc->metallic > 0.0f);
}

ppm_status ppm_scene_add_material(ppm_scene *scene, const ppm_material_desc *desc,
                                  ppm_material_id *out_id)
{
    ppm_status status = ppmi_scene_check_open(scene);
    if (status != PPM_STATUS_OK) return status;
    if (!desc || !out_id || desc->size < sizeof *desc) return PPM_STATUS_INVALID_ARGUMENT;
    status = check_factors(scene, desc);
    if (status == PPM_STATUS_OK) status = check_textures(scene, desc);
    if (status != PPM_STATUS_OK) return status;

    ppmi_material *materials =
        ppmi_scene_grow(scene->context, scene->materials, scene->material_count, sizeof *materials);
    if (!materials) return PPM_STATUS_OUT_OF_MEMORY;
    scene->materials = materials;
    ppmi_material *material = &materials[scene->material_count];
    material->name = ppmi_string_copy(scene->context, desc->name ? desc->name : "");
    if (!material->name) {
        return ppmi_fail(scene->context, PPM_STATUS_OUT_OF_MEMORY, "out of memory for a material");
    }
    material->desc = *desc;
    material->desc.name = NULL;
    to_working_space(&scene->working, &material->desc);
    derive(material);
    *out_id = ++scene->material_count;
    return PPM_STATUS_OK;
}

/* Made and checked as an added one, which then takes the old one's place. */
ppm_status ppm_scene_set_material(ppm_scene *scene, ppm_material_id id,
                                  const ppm_material_desc *desc)
{
    ppm_status status = ppmi_scene_check_open(scene);
    if (status != PPM_STATUS_OK) return status;
    if (id == 0 || id > scene->material_count) {
        return ppmi_fail(scene->context, PPM_STATUS_INVALID_ARGUMENT, "material %u of %u", id,
                         scene->material_count);
    }
    ppm_material_id added;
    status = ppm_scene_add_material(scene, desc, &added);
    if (status != PPM_STATUS_OK) return status;
    ppmi_material *last = &scene->materials[--scene->material_count];
    ppmi_free(scene->context, last->name);
    last->name = scene->materials[id - 1].name;
    if (last->is_solid_glass && !scene->materials[id - 1].is_solid_glass) {
        for (uint32_t i = 0; i < scene->mesh_count; i++)
            scene->meshes[i].oriented_version = 0;
    }
    scene->materials[id - 1] = *last;
    return PPM_STATUS_OK;
}

/* ---- environment and facts ------------------------------------------------------------------- */

ppm_status ppm_scene_set_environment(ppm_scene *scene, const ppm_environment_desc *desc)
{
    const ppm_status status = ppmi_scene_check_open(scene);
    if (status != PPM_STATUS_OK) return status;
    if (!desc || desc->size < sizeof *desc || !all_in(desc->radiance, 3, 0.0f, 1e18f) ||
        !all_in(desc->backdrop, 3, 0.0f, 1e18f) || desc->image > scene->image_count ||
        !isfinite(desc->rotation_rad)) {
        return ppmi_fail(scene->context, PPM_STATUS_INVALID_ARGUMENT,
                         "environment: radiance, backdrop, image or rotation out of range");
    }
    char *group;
    if (!ppmi_light_group_copy(scene->context, desc->light_group, &group)) {
        return ppmi_fail(scene->context, PPM_STATUS_OUT_OF_MEMORY,
                         "out of memory for the environment");
    }
    ppmi_free(scene->context, scene->environment.light_group);
    float radiance[3], backdrop[3];
    ppmi_working_light(&scene->working, desc->radiance, radiance);
    ppmi_working_light(&scene->working, desc->backdrop, backdrop);
    scene->environment = (ppmi_environment){
        .is_set = true,
        .radiance = vec3_load(radiance),
        .image = desc->image,
        .rotation_rad = desc->rotation_rad,
        .has_backdrop = desc->has_backdrop != 0,
        .backdrop = vec3_load(backdrop),
        .light_group = group,
    };
    return PPM_STATUS_OK;
}

ppm_status ppm_scene_set_fog(ppm_scene *scene, const ppm_fog_desc *desc)
{
    const ppm_status status = ppmi_scene_check_open(scene);
    if (status != PPM_STATUS_OK) return status;
    if (!desc || desc->size < sizeof *desc || !all_in(desc->sigma_s, 3, 0.0f, 1e12f) ||
        !all_in(desc->sigma_a, 3, 0.0f, 1e12f) || !(fabsf(desc->asymmetry_g) < 1.0f)) {
        return ppmi_fail(scene->context, PPM_STATUS_INVALID_ARGUMENT,
                         "fog: coefficients must be at least 0 per metre, g between -1 and 1");
    }
    float sigma_s[3], sigma_a[3];
    ppmi_working_medium(&scene->working, desc->sigma_s, desc->sigma_a, sigma_s, sigma_a);
    scene->fog = (ppmi_medium){
        .sigma_s = vec3_load(sigma_s),
        .sigma_a = vec3_load(sigma_a),
        .asymmetry_g = desc->asymmetry_g,
    };
    return PPM_STATUS_OK;
}

ppm_status ppm_scene_set_origin(ppm_scene *scene, const double origin_m[3])
{
    const ppm_status status = ppmi_scene_check_open(scene);
    if (status != PPM_STATUS_OK) return status;
    if (!origin_m || !isfinite(origin_m[0] + origin_m[1] + origin_m[2])) {
        return ppmi_fail(scene->context, PPM_STATUS_INVALID_ARGUMENT,
                         "the scene's origin is not finite");
    }
    if (scene->instance_count + scene->camera_count + scene->punctual_count > 0) {
        return ppmi_fail(scene->context, PPM_STATUS_WRONG_STATE,
                         "the scene's origin has to be set before anything is placed");
    }
    for (int i = 0; i < 3; i++)
        scene->origin_m[i] = origin_m[i];
    return PPM_STATUS_OK;
}

void ppm_scene_get_origin(const ppm_scene *scene, double out_origin_m[3])
{
    for (int i = 0; i < 3; i++)
        out_origin_m[i] = scene ? scene->origin_m[i] : 0.0;
}

static bool is_decoration(const ppmi_material *material)
{
    const float one = 1.00001f; /* a working space rounds */
    return material->desc.emission_texture.image > 0 &&
           vec3_max_component(vec3_load(material->desc.emission)) <= one;
}

/* for_picture: what is visible, and decoration; else what brings light, in this frame or another.
 */
static uint64_t emissive_element_count(const ppm_scene *scene, bool for_picture)
{
    uint64_t count = 0;
    for (uint32_t i = 0; i < scene->instance_count; i++) {
        if (for_picture && !ppmi_instance_is_there(&scene->instances[i])) continue;
        const ppmi_mesh *mesh = &scene->meshes[scene->instances[i].mesh];
        for (uint32_t k = 0; k < mesh->primitive_count; k++) {
            const ppmi_primitive *primitive = &mesh->primitives[k];
            const ppmi_material *material = &scene->materials[primitive->material];
            if (!material->emits || (is_decoration(material) && !for_picture)) continue;
            count += primitive->element_count;
        }
    }
    return count;
}

bool ppmi_scene_has_light(const ppm_scene *scene)
{
    if (scene->environment.is_set && !vec3_is_black(scene->environment.radiance)) return true;
    if (scene->punctual_count > 0) return true;
    return emissive_element_count(scene, false) > 0;
}

ppm_status ppm_scene_get_info(const ppm_scene *scene, ppm_scene_info *out_info)
{
    if (!scene || !out_info || out_info->size < sizeof *out_info) {
        return PPM_STATUS_INVALID_ARGUMENT;
    }
    ppm_scene_info info = {
        .size = sizeof info,
        .instances = scene->instance_count,
        .meshes = scene->mesh_count,
        .materials = scene->material_count,
        .textures = scene->image_count,
        .cameras = scene->camera_count,
        .lights = scene->punctual_count + emissive_element_count(scene, true),
        .has_light = ppmi_scene_has_light(scene),
    };
    if (scene->environment.is_set && !vec3_is_black(scene->environment.radiance)) info.lights++;
    for (uint32_t i = 0; i < scene->mesh_count; i++) {
        for (uint32_t k = 0; k < scene->meshes[i].primitive_count; k++) {
            info.triangles += scene->meshes[i].primitives[k].triangle_count;
        }
    }
    ppmi_vec3 low, high;
    ppmi_scene_bounds(scene, &low, &high);
    vec3_store(info.bounds_min, vec3_add(low, scene->shift));
    vec3_store(info.bounds_max, vec3_add(high, scene->shift));
    *out_info = info;
    return PPM_STATUS_OK;
}
