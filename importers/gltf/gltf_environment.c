/* EXT_lights_image_based: the surroundings of a scene. Their specular cube at its sharpest is the
 * radiance itself; the blurred levels and the harmonics are for renderers that cannot integrate.
 * Where an image of the cube is missing, the harmonics give what they can. */
#include <math.h>
#include <string.h>

#include "gltf/gltf_light.h"

enum { HARMONICS = 9, SMOOTH_ROWS = 32 };

/* The images of the cube; false when one cannot be had. */
static ppm_status use_faces(ppmi_gltf_reader *reader, const ppmi_gltf_image_light *light,
                            const char *place, ppm_image_id faces[6], bool *out_all)
{
    char inner[PPMI_GLTF_PLACE];
    ppm_status status = PPM_STATUS_OK;
    *out_all = light->has_faces;
    for (int i = 0; i < 6 && *out_all && status == PPM_STATUS_OK; ++i) {
        ppmi_gltf_place(inner, "%s.specularImages[0][%d]", place, i);
        status = ppmi_gltf_use_image(reader, light->faces[i], PPM_IMAGE_COLOR, inner, &faces[i]);
        *out_all = faces[i] != 0;
    }
    return status;
}

static ppm_status set_cube(ppmi_gltf_reader *reader, const ppmi_gltf_image_light *light,
                           const ppm_image_id faces[6])
{
    const float intensity = (float)light->intensity;
    ppm_cube_environment_desc desc = {
        .size = sizeof desc, .is_rgbd = 1, .radiance = {intensity, intensity, intensity}};
    memcpy(desc.faces, faces, sizeof desc.faces);
    for (int i = 0; i < 4; ++i)
        desc.rotation[i] = (float)light->rotation[i];
    return ppm_scene_set_cube_environment(reader->scene, &desc);
}

/* ---- from harmonics -------------------------------------------------------------------------- */

/* Real spherical harmonics of the first three bands, and what a cosine lobe makes of each
 * (Ramamoorthi, Hanrahan 2001, "An Efficient Representation for Irradiance Environment Maps", their
 * equations 3 and 8). The file has irradiance: dividing by the latter gives the radiance back. */
static void harmonics(double x, double y, double z, double out[HARMONICS])
{
    const double pi = 3.14159265358979323846;
    const double bands[3] = {pi, 2.0 * pi / 3.0, 0.25 * pi};
    const double values[HARMONICS] = {0.282095,
                                      0.488603 * y,
                                      0.488603 * z,
                                      0.488603 * x,
                                      1.092548 * x * y,
                                      1.092548 * y * z,
                                      0.315392 * (3.0 * z * z - 1.0),
                                      1.092548 * x * z,
                                      0.546274 * (x * x - y * y)};
    for (int i = 0; i < HARMONICS; ++i)
        out[i] = values[i] / bands[i == 0 ? 0 : i < 4 ? 1 : 2];
}

/* Turns a direction back by a quaternion of any length. */
static void turn_back(const double rotation[4], const double d[3], double out[3])
{
    const double *q = rotation;
    const double length2 = q[0] * q[0] + q[1] * q[1] + q[2] * q[2] + q[3] * q[3];
    const double twice = length2 > 0.0 ? 2.0 / length2 : 0.0;
    const double side[3] = {d[1] * q[2] - d[2] * q[1], d[2] * q[0] - d[0] * q[2],
                            d[0] * q[1] - d[1] * q[0]};
    out[0] = d[0] + twice * (q[3] * side[0] + side[1] * q[2] - side[2] * q[1]);
    out[1] = d[1] + twice * (q[3] * side[1] + side[2] * q[0] - side[0] * q[2]);
    out[2] = d[2] + twice * (q[3] * side[2] + side[0] * q[1] - side[1] * q[0]);
}

static void fill_smooth(const ppmi_gltf_image_light *light, uint32_t width, uint32_t height,
                        float *pixels)
{
    const double pi = 3.14159265358979323846;
    for (uint32_t i = 0; i < width * height; ++i) {
        const double phi = 2.0 * pi * ((i % width + 0.5) / width - 0.5);
        const double theta = pi * (i / width + 0.5) / height;
        const double d[3] = {sin(theta) * sin(phi), cos(theta), -sin(theta) * cos(phi)};
        double local[3], basis[HARMONICS];
        turn_back(light->rotation, d, local);
        harmonics(local[0], local[1], local[2], basis);
        for (int k = 0; k < 3; ++k) {
            double sum = 0.0;
            for (int j = 0; j < HARMONICS; ++j)
                sum += light->irradiance[j][k] * basis[j];
            pixels[3 * i + k] = (float)fmin(fmax(sum, 0.0), 1e18);
        }
    }
}

ppm_status ppmi_gltf_set_harmonics(ppmi_gltf_reader *reader, const ppmi_gltf_image_light *light)
{
    float pixels[3 * 2 * SMOOTH_ROWS * SMOOTH_ROWS];
    const float intensity = (float)light->intensity;
    ppm_image_desc image = {.size = sizeof image,
                            .name = "irradiance",
                            .role = PPM_IMAGE_COLOR,
                            .pixels = pixels,
                            .pixel_type = PPM_PIXELS_F32,
                            .width = 2 * SMOOTH_ROWS,
                            .height = SMOOTH_ROWS,
                            .channels = 3};
    ppm_environment_desc desc = {.size = sizeof desc,
                                 .radiance = {intensity, intensity, intensity}};
    fill_smooth(light, image.width, image.height, pixels);
    const ppm_status status = ppm_scene_add_image(reader->scene, &image, &desc.image);
    return status == PPM_STATUS_OK ? ppm_scene_set_environment(reader->scene, &desc) : status;
}

/* ---- the light ------------------------------------------------------------------------------- */

static const char *light_fault(const ppmi_gltf_image_light *light)
{
    if (!(light->intensity >= 0.0 && light->intensity < 1e18)) {
        return "intensity must be at least 0, and finite";
    }
    for (int i = 0; i < 4; ++i) {
        if (!(fabs(light->rotation[i]) < 1e15)) return "rotation is no quaternion";
    }
    return light->has_faces || light->has_irradiance
               ? NULL
               : "it has neither six specularImages nor nine irradianceCoefficients";
}

ppm_status ppmi_gltf_import_environment(ppmi_gltf_reader *reader)
{
    const ppmi_gltf_document *document = reader->document;
    const int32_t scene = reader->chosen_scene;
    char place[PPMI_GLTF_PLACE], inner[PPMI_GLTF_PLACE];
    if ((size_t)scene >= document->scene_count) return PPM_STATUS_OK;
    const int32_t index = document->scenes[scene].image_light;
    if (index < 0) return ppmi_gltf_import_environment_map(reader);
    ppmi_gltf_place(place, "scenes[%d].extensions.EXT_lights_image_based.light", (int)scene);
    if (!ppmi_gltf_accept(reader, PPMI_GLTF_IMAGE_LIGHTS, index, place)) return PPM_STATUS_OK;
    const ppmi_gltf_image_light *light = &document->image_lights[index];
    ppmi_gltf_place(inner, "extensions.EXT_lights_image_based.lights[%d]", (int)index);
    const char *fault = light_fault(light);
    if (fault) {
        ppmi_gltf_warn(reader, inner, "left out: %s", fault);
        return PPM_STATUS_OK;
    }
    ppm_image_id faces[6] = {0};
    bool has_all = false;
    ppm_status status = use_faces(reader, light, inner, faces, &has_all);
    if (status != PPM_STATUS_OK) return status;
    if (has_all) return set_cube(reader, light, faces);
    if (light->has_irradiance) {
        ppmi_gltf_warn(reader, inner, "its images are not complete: lit by its harmonics");
        return ppmi_gltf_set_harmonics(reader, light);
    }
    ppmi_gltf_warn(reader, inner, "left out: its images are not complete");
    return PPM_STATUS_OK;
}
