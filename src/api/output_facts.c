/* The spaces are those of OpenEXR's ImfStandardAttributes.h, which are RenderMan's: the camera
 * looks along +z, with x to the right and y up, so its space is left-handed; NDC is 0,0 in the
 * upper left corner of the whole picture and 1,1 in the lower right. Matrices are for row vectors:
 * p' = p M. */
#include "api/output_facts.h"

#include <math.h>
#include <stdio.h>

#include "camera/camera.h"
#include "render/render.h"
#include "scene/digest.h"

/* NDC's z is discarded by all who use it. It is 0 at this distance and 1 far away. */
static const double NEAR_M = 1e-3;

/* Sets a column of a matrix: the plane a.x + b.y + c.z + offset. */
static void set_column(float matrix[16], int column, const double plane[4])
{
    for (int row = 0; row < 4; row++)
        matrix[4 * row + column] = (float)plane[row] + 0.0f; /* no negative zeros */
}

/* Distance along axis from the camera, times factor. Positions are those that were given, before
 * the scene was moved to where floats are finest. */
static void distance_along(ppmi_vec3 axis, ppmi_vec3 origin, ppmi_vec3 shift, double factor,
                           double plane[4])
{
    const double x = axis.x, y = axis.y, z = axis.z;
    plane[0] = factor * x;
    plane[1] = factor * y;
    plane[2] = factor * z;
    plane[3] = -factor * (x * ((double)origin.x + (double)shift.x) +
                          y * ((double)origin.y + (double)shift.y) +
                          z * ((double)origin.z + (double)shift.z));
}

static void set_matrices(const ppmi_camera_view *view, ppmi_vec3 shift, ppmi_output_facts *facts)
{
    const double half_width = (double)vec3_length(view->right);
    const double half_height = (double)vec3_length(view->up);
    double right[4], up[4], forward[4], x[4], y[4], z[4], w[4] = {0, 0, 0, 1};
    const double one[4] = {0, 0, 0, 1};
    distance_along(vec3_normalize(view->right), view->origin, shift, 1, right);
    distance_along(vec3_normalize(view->up), view->origin, shift, 1, up);
    distance_along(view->forward, view->origin, shift, 1, forward);
    for (int i = 0; i < 4; i++) {
        w[i] = view->is_perspective ? forward[i] : one[i];
        x[i] = 0.5 * (right[i] / half_width + (1 - (double)view->shift_x) * w[i]);
        y[i] = 0.5 * (-up[i] / half_height + (1 + (double)view->shift_y) * w[i]);
        z[i] = view->is_perspective ? forward[i] - NEAR_M * one[i] : forward[i];
    }
    set_column(facts->world_to_camera, 0, right);
    set_column(facts->world_to_camera, 1, up);
    set_column(facts->world_to_camera, 2, forward);
    set_column(facts->world_to_camera, 3, one);
    set_column(facts->world_to_ndc, 0, x);
    set_column(facts->world_to_ndc, 1, y);
    set_column(facts->world_to_ndc, 2, z);
    set_column(facts->world_to_ndc, 3, w);
}

static void add(ppmi_output_header *header, const char *name, int32_t type, const float *floats,
                uint32_t count)
{
    ppmi_image_attribute *const attribute = ppmi_output_header_add(header, name, type);
    attribute->floats = floats;
    attribute->float_count = count;
}

static void add_lens(ppmi_output_header *header, const ppmi_camera_view *view,
                     const ppm_render_options *options, ppmi_output_facts *facts)
{
    const float half_width = vec3_length(view->right), half_height = vec3_length(view->up);
    facts->window_center[0] = view->shift_x * half_width;
    facts->window_center[1] = view->shift_y * half_height;
    facts->window_width = 2 * half_width;
    facts->focal_length_mm = 1000 * ppmi_camera_view_focal_length(view);
    facts->sensor_mm = 1000 * PPMI_SENSOR_SIDE_M;
    add(header, "screenWindowCenter", PPMI_ATTRIBUTE_PAIR, facts->window_center, 2);
    add(header, "screenWindowWidth", PPMI_ATTRIBUTE_FLOAT, &facts->window_width, 1);
    add(header, "nominalFocalLength", PPMI_ATTRIBUTE_FLOAT, &facts->focal_length_mm, 1);
    add(header, "ppm:sensor_mm", PPMI_ATTRIBUTE_FLOAT, &facts->sensor_mm, 1);
    if (!view->has_lens) return;
    facts->f_number = options->aperture_f_number;
    facts->focus_distance_m = options->focus_distance_m;
    add(header, "aperture", PPMI_ATTRIBUTE_FLOAT, &facts->f_number, 1);
    add(header, "focus", PPMI_ATTRIBUTE_FLOAT, &facts->focus_distance_m, 1);
}

static void add_digests(ppmi_output_header *header, const ppm_render *render,
                        ppmi_output_facts *facts)
{
    const ppm_scene *const scene = ppmi_render_scene(render);
    const uint32_t camera = ppm_render_get_options(render)->camera;
    ppmi_digest what = {0}, view = {0};
    ppmi_scene_digest(scene, &what);
    ppmi_camera_digest(&scene->cameras[camera - 1], &view);
    ppmi_digest_write(&what, facts->scene);
    ppmi_digest_write(&view, facts->view);
    ppmi_output_header_add(header, "ppm:sceneDigest", PPMI_ATTRIBUTE_STRING)->text = facts->scene;
    ppmi_output_header_add(header, "ppm:cameraDigest", PPMI_ATTRIBUTE_STRING)->text = facts->view;
}

/* Cryptomatte specification 1.2, "metadata". */
static void add_cryptomatte(ppmi_output_header *header, const ppm_render *render, int32_t kind,
                            char names[4][48])
{
    static const char *const fields[4] = {"name", "hash", "conversion", "manifest"};
    const char *manifest = NULL;
    char key[8];
    if (!(ppm_render_get_options(render)->layers & PPM_LAYER_BIT(kind))) return;
    if (ppm_render_cryptomatte_manifest(render, kind, &manifest) != PPM_STATUS_OK) return;
    ppm_cryptomatte_key(ppm_layer_kind_name(kind), key);
    const char *const values[4] = {ppm_layer_kind_name(kind), "MurmurHash3_32", "uint32_to_float32",
                                   manifest};
    for (int i = 0; i < 4; i++) {
        snprintf(names[i], sizeof names[i], "cryptomatte/%s/%s", key, fields[i]);
        ppmi_output_header_add(header, names[i], PPMI_ATTRIBUTE_STRING)->text = values[i];
    }
}

void ppmi_output_header_add_facts(ppmi_output_header *header, const ppm_render *render,
                                  ppmi_output_facts *facts)
{
    *facts = (ppmi_output_facts){0};
    const float middle = 0.5f; /* of the shutter */
    const ppmi_camera_view view = ppmi_camera_view_at(ppmi_render_view(render), middle);
    set_matrices(&view, ppmi_render_scene(render)->shift, facts);
    add(header, "worldToCamera", PPMI_ATTRIBUTE_MATRIX, facts->world_to_camera, 16);
    add(header, "worldToNDC", PPMI_ATTRIBUTE_MATRIX, facts->world_to_ndc, 16);
    if (view.is_perspective) add_lens(header, &view, ppm_render_get_options(render), facts);
    add_digests(header, render, facts);
    ppm_render_stats stats = {.size = sizeof stats};
    if (ppm_render_get_stats(render, &stats) != PPM_STATUS_OK) return;
    facts->seconds = (float)stats.seconds_render;
    add(header, "ppm:seconds", PPMI_ATTRIBUTE_FLOAT, &facts->seconds, 1);
}

void ppmi_output_header_add_mattes(ppmi_output_header *header, const ppm_render *render,
                                   ppmi_output_facts *facts)
{
    for (int32_t i = 0; i < 3; i++)
        add_cryptomatte(header, render, PPM_LAYER_CRYPTO_OBJECT + i, facts->crypto_names[i]);
}
