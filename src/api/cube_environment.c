/* Surroundings given as a cube, resampled to a latitude-longitude image. */
#include "scene/scene.h"
#include "shading/texture.h"

/* The image gets about as many pixels around as the cube has, up to a limit. */
enum { MOST_ROWS = 2048, LEAST_ROWS = 16, TAPS = 2 };

/* What is right of and above a face's middle, seen from inside. */
typedef struct cube_face {
    ppmi_vec3 right, up, ahead;
} cube_face;

static const cube_face cube_faces[6] = {
    {{0, 0, 1}, {0, 1, 0}, {1, 0, 0}},   {{0, 0, -1}, {0, 1, 0}, {-1, 0, 0}},
    {{-1, 0, 0}, {0, 0, -1}, {0, 1, 0}}, {{-1, 0, 0}, {0, 0, 1}, {0, -1, 0}},
    {{-1, 0, 0}, {0, 1, 0}, {0, 0, 1}},  {{1, 0, 0}, {0, 1, 0}, {0, 0, -1}},
};

/* The pixel at a place, unpacked before anything is mixed. */
static ppmi_vec3 face_pixel(const ppm_scene *scene, const ppm_cube_environment_desc *desc,
                            uint32_t face, float x, float y)
{
    const ppm_texture texture = {.image = desc->faces[face],
                                 .wrap_u = PPM_WRAP_CLAMP,
                                 .wrap_v = PPM_WRAP_CLAMP,
                                 .filter = PPM_FILTER_NEAREST};
    const ppmi_image *image = &scene->images[texture.image - 1];
    const ppmi_vec2 uv = {(x + 0.5f) / (float)image->width, (y + 0.5f) / (float)image->height};
    const ppmi_texel texel = ppmi_texture_lookup(scene, &texture, uv);
    const ppmi_vec3 color = vec3(texel.r, texel.g, texel.b);
    if (!desc->is_rgbd || !image->u8 || image->channels != 4) return color;
    return vec3_scale(color, 1.0f / ppmi_max(texel.a, 1.0f / 255.0f));
}

static ppmi_vec3 mix(ppmi_vec3 a, ppmi_vec3 b, float t)
{
    return vec3_mad(vec3_scale(a, 1.0f - t), b, t);
}

static ppmi_vec3 face_radiance(const ppm_scene *scene, const ppm_cube_environment_desc *desc,
                               uint32_t face, float u, float v)
{
    const ppmi_image *image = &scene->images[desc->faces[face] - 1];
    const float last_x = (float)(image->width - 1), last_y = (float)(image->height - 1);
    const float x = ppmi_clampf(u * (float)image->width - 0.5f, 0.0f, last_x);
    const float y = ppmi_clampf(v * (float)image->height - 0.5f, 0.0f, last_y);
    const float x0 = floorf(x), y0 = floorf(y);
    const float x1 = ppmi_min(x0 + 1.0f, last_x), y1 = ppmi_min(y0 + 1.0f, last_y);
    const ppmi_vec3 top =
        mix(face_pixel(scene, desc, face, x0, y0), face_pixel(scene, desc, face, x1, y0), x - x0);
    const ppmi_vec3 bottom =
        mix(face_pixel(scene, desc, face, x0, y1), face_pixel(scene, desc, face, x1, y1), x - x0);
    return mix(top, bottom, y - y0);
}

static ppmi_vec3 cube_radiance(const ppm_scene *scene, const ppm_cube_environment_desc *desc,
                               ppmi_vec3 d)
{
    const ppmi_vec3 a = vec3(fabsf(d.x), fabsf(d.y), fabsf(d.z));
    uint32_t face = d.z > 0.0f ? 4 : 5;
    if (a.x >= a.y && a.x >= a.z) {
        face = d.x > 0.0f ? 0 : 1;
    } else if (a.y >= a.z) {
        face = d.y > 0.0f ? 2 : 3;
    }
    const cube_face *f = &cube_faces[face];
    const float ahead = vec3_dot(d, f->ahead);
    const float right = vec3_dot(d, f->right) / ahead;
    return face_radiance(scene, desc, face, 0.5f + 0.5f * (desc->is_mirrored ? -right : right),
                         0.5f - 0.5f * vec3_dot(d, f->up) / ahead);
}

/* Turns d back by the quaternion: v + 2 w (v x q) + 2 (v x q) x q, for unit q. */
static ppmi_vec3 turn_back(const float q[4], ppmi_vec3 d)
{
    const ppmi_vec3 axis = vec3_load(q), side = vec3_cross(d, axis);
    const ppmi_vec3 once = vec3_mad(d, side, 2.0f * q[3]);
    return vec3_mad(once, vec3_cross(side, axis), 2.0f);
}

static void fill(const ppm_scene *scene, const ppm_cube_environment_desc *desc, const float q[4],
                 uint32_t width, uint32_t height, float *pixels)
{
    for (uint32_t i = 0; i < width * height; i++) {
        ppmi_vec3 sum = vec3_splat(0.0f);
        for (uint32_t k = 0; k < TAPS * TAPS; k++) {
            const float x = (float)(i % width) + ((float)(k % TAPS) + 0.5f) / TAPS;
            const float y = (float)(i / width) + ((float)(k / TAPS) + 0.5f) / TAPS;
            const float phi = 2.0f * PPMI_PI * (x / (float)width - 0.5f);
            const float theta = PPMI_PI * y / (float)height, across = sinf(theta);
            const ppmi_vec3 d = vec3(across * sinf(phi), cosf(theta), -across * cosf(phi));
            sum = vec3_add(sum, cube_radiance(scene, desc, turn_back(q, d)));
        }
        vec3_store(pixels + 3 * (size_t)i, vec3_scale(sum, 1.0f / (TAPS * TAPS)));
    }
}

static bool is_valid(const ppm_scene *scene, const ppm_cube_environment_desc *desc)
{
    for (int i = 0; i < 6; i++) {
        if (desc->faces[i] == 0 || desc->faces[i] > scene->image_count) return false;
    }
    for (int i = 0; i < 3; i++) {
        if (!(desc->radiance[i] >= 0.0f && desc->radiance[i] < 1e18f)) return false;
    }
    for (int i = 0; i < 4; i++) {
        if (!(fabsf(desc->rotation[i]) < 1e15f)) return false;
    }
    return true;
}

/* The quaternion at unit length; none stands for no rotation. */
static void normalize(const float from[4], float q[4])
{
    const float length =
        sqrtf(from[0] * from[0] + from[1] * from[1] + from[2] * from[2] + from[3] * from[3]);
    for (int i = 0; i < 4; i++)
        q[i] = length > 0.0f ? from[i] / length : i == 3 ? 1.0f : 0.0f;
}

static ppm_status add_image(ppm_scene *scene, const ppm_cube_environment_desc *desc,
                            ppm_image_id *out_id)
{
    ppm_context *context = scene->context;
    uint32_t height = LEAST_ROWS;
    for (int i = 0; i < 6; i++) {
        const uint32_t rows = 2 * scene->images[desc->faces[i] - 1].height;
        height = rows > height ? rows : height;
    }
    if (height > MOST_ROWS) height = MOST_ROWS;
    ppmi_image image = {.name = ppmi_string_copy(context, "cube"),
                        .width = 2 * height,
                        .height = height,
                        .channels = 3,
                        .f32 = ppmi_alloc(context, (size_t)6 * height * height, sizeof(float))};
    ppm_status status = PPM_STATUS_OUT_OF_MEMORY;
    if (image.name && image.f32) {
        float q[4];
        normalize(desc->rotation, q);
        fill(scene, desc, q, image.width, image.height, image.f32);
        image.is_working = scene->working.differs;
        status = ppmi_scene_take_image(scene, &image, out_id);
    } else {
        ppmi_fail(context, status, "out of memory for the environment");
    }
    if (status != PPM_STATUS_OK) {
        ppmi_free(context, image.name);
        ppmi_free(context, image.f32);
    }
    return status;
}

ppm_status ppm_scene_set_cube_environment(ppm_scene *scene, const ppm_cube_environment_desc *desc)
{
    ppm_status status = ppmi_scene_check_open(scene);
    if (status != PPM_STATUS_OK) return status;
    if (!desc || desc->size < sizeof *desc || !is_valid(scene, desc)) {
        return ppmi_fail(scene->context, PPM_STATUS_INVALID_ARGUMENT,
                         "cube environment: a face, radiance or rotation is out of range");
    }
    const ppmi_environment before = scene->environment;
    ppm_environment_desc environment = {
        .size = sizeof environment,
        .radiance = {desc->radiance[0], desc->radiance[1], desc->radiance[2]},
        .light_group = before.light_group,
    };
    status = add_image(scene, desc, &environment.image);
    if (status == PPM_STATUS_OK) status = ppm_scene_set_environment(scene, &environment);
    if (status != PPM_STATUS_OK) return status;
    scene->environment.has_backdrop = before.has_backdrop; /* is in the working space already */
    scene->environment.backdrop = before.backdrop;
    return PPM_STATUS_OK;
}
