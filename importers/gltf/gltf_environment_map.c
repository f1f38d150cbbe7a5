/* KHR_environment_map (a draft, KhronosGroup/glTF pull request 1956): the surroundings of a scene
 * as a cube in a KTX file, in nit. Its harmonics are the irradiance of the same cube; here the cube
 * itself lights, and they stand in where it cannot be read. */
#include <math.h>
#include <string.h>

#include "gltf/gltf_light.h"

/* A cube of a KTX file is stored as graphics interfaces sample it (KTX 2.0, "faceCount"; Vulkan
 * 1.3, 16.5.4): mirrored, when it is looked at from inside. */
static ppm_status set_cube(ppmi_gltf_reader *reader, const ppmi_gltf_cubemap *cubemap,
                           const ppm_image_id faces[6])
{
    const float intensity = (float)cubemap->intensity;
    ppm_cube_environment_desc desc = {
        .size = sizeof desc, .radiance = {intensity, intensity, intensity}, .is_mirrored = 1};
    memcpy(desc.faces, faces, sizeof desc.faces);
    return ppm_scene_set_cube_environment(reader->scene, &desc);
}

/* Sets the environment to the cube; *out_set says whether there is one. */
static ppm_status import_cube(ppmi_gltf_reader *reader, const ppmi_gltf_environment_map *map,
                              const char *place, bool *out_set)
{
    char inner[PPMI_GLTF_PLACE];
    ppm_image_id faces[6];
    *out_set = false;
    if (map->cubemap < 0 && map->has_irradiance) return PPM_STATUS_OK;
    if (!ppmi_gltf_accept(reader, PPMI_GLTF_CUBEMAPS, map->cubemap, place)) return PPM_STATUS_OK;
    const ppmi_gltf_cubemap *cubemap = &reader->document->cubemaps[map->cubemap];
    ppmi_gltf_place(inner, "extensions.KHR_environment_map.cubemaps[%d]", (int)map->cubemap);
    if (!(cubemap->intensity >= 0.0 && cubemap->intensity < 1e18) || cubemap->layer < 0) {
        ppmi_gltf_warn(reader, inner, "left out: intensity and layer must be at least 0");
        return PPM_STATUS_OK;
    }
    const ppm_status status =
        ppmi_gltf_use_cube(reader, cubemap->source, (uint32_t)cubemap->layer, inner, faces);
    if (status != PPM_STATUS_OK || faces[0] == 0) return status;
    *out_set = true;
    return set_cube(reader, cubemap, faces);
}

static ppm_status import_harmonics(ppmi_gltf_reader *reader, const ppmi_gltf_environment_map *map,
                                   const char *place)
{
    ppmi_gltf_image_light light = {.intensity = map->irradiance_factor,
                                   .rotation = {0.0, 0.0, 0.0, 1.0}};
    if (!map->has_irradiance) {
        ppmi_gltf_warn(reader, place, "left out: it has neither a cube nor irradianceCoefficients");
        return PPM_STATUS_OK;
    }
    if (!(light.intensity >= 0.0 && light.intensity < 1e18)) {
        ppmi_gltf_warn(reader, place, "left out: irradianceFactor must be at least 0, and finite");
        return PPM_STATUS_OK;
    }
    ppmi_gltf_warn(reader, place, "it has no cube that can be read: lit by its harmonics");
    memcpy(light.irradiance, map->irradiance, sizeof light.irradiance);
    return ppmi_gltf_set_harmonics(reader, &light);
}

ppm_status ppmi_gltf_import_environment_map(ppmi_gltf_reader *reader)
{
    const ppmi_gltf_document *document = reader->document;
    const int32_t scene = reader->chosen_scene;
    char place[PPMI_GLTF_PLACE];
    bool is_set;
    const int32_t index = document->scenes[scene].environment_map;
    if (index < 0) return PPM_STATUS_OK;
    ppmi_gltf_place(place, "scenes[%d].extensions.KHR_environment_map.environment_map", (int)scene);
    if (!ppmi_gltf_accept(reader, PPMI_GLTF_ENVIRONMENT_MAPS, index, place)) return PPM_STATUS_OK;
    const ppmi_gltf_environment_map *map = &document->environment_maps[index];
    ppmi_gltf_place(place, "extensions.KHR_environment_map.environment_maps[%d]", (int)index);
    if (map->has_box) {
        ppmi_gltf_warn(reader, place, "its bounding box is not used: it is infinitely far away");
    }
    if (map->has_other_ior) {
        ppmi_gltf_warn(reader, place, "its ior is not used: it is filled with air");
    }
    const ppm_status status = import_cube(reader, map, place, &is_set);
    return status == PPM_STATUS_OK && !is_set ? import_harmonics(reader, map, place) : status;
}
