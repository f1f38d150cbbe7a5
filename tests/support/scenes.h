/* Scenes for tests: context and scene together, materials, cameras, lights; and the structures over
 * a finished scene that rendering reads. */
#ifndef TEST_SUPPORT_SCENES_H
#define TEST_SUPPORT_SCENES_H

#include "support/shapes.h"
#include "transport/world.h"

typedef struct test_scene {
    ppm_context *context;
    ppm_scene *scene;
    uint32_t warnings; /* logged so far */
} test_scene;

/* test_scene must stay where it is until it is closed. */
void scene_open(test_scene *test);
/* Also checks that every block of memory has been given back. */
void scene_close(test_scene *test);

ppm_material_id material_lambert(ppm_scene *scene, float reflectance);
ppm_material_id material_lambert_rgb(ppm_scene *scene, ppmi_vec3 reflectance);
/* Lambert that also shines with the given radiance. */
ppm_material_id material_emitter(ppm_scene *scene, float radiance, float reflectance,
                                 bool double_sided);
/* A white solid. */
ppm_material_id material_glass(ppm_scene *scene, float ior, float roughness);
/* As a new material, but for these. */
ppm_material_desc material_desc_rgb(ppmi_vec3 base_color, float metallic, float roughness);
ppm_material_id material_add(ppm_scene *scene, const ppm_material_desc *desc);

/* Looks from eye to target; angle is the full vertical one. */
ppm_camera_id camera_perspective(ppm_scene *scene, ppmi_vec3 eye, ppmi_vec3 target,
                                 float y_fov_rad);
ppm_camera_id camera_orthographic(ppm_scene *scene, ppmi_vec3 eye, ppmi_vec3 target,
                                  float half_width_m);

ppm_light_id light_point(ppm_scene *scene, ppmi_vec3 position, ppmi_vec3 intensity);
ppm_light_id light_spot(ppm_scene *scene, ppmi_vec3 position, ppmi_vec3 target, ppmi_vec3 intensity,
                        float inner_rad, float outer_rad);
ppm_light_id light_directional(ppm_scene *scene, ppmi_vec3 direction, ppmi_vec3 illuminance);
/* A disk in the sky, from which light comes along direction. */
ppm_light_id light_sun(ppm_scene *scene, ppmi_vec3 direction, ppmi_vec3 illuminance,
                       float angular_radius_rad);
void light_environment(ppm_scene *scene, ppmi_vec3 radiance, ppm_image_id image,
                       float rotation_rad);
/* Fog in the ball around the scene: scattering and absorption, 1/m, and mean cosine. */
void scene_fog(ppm_scene *scene, ppmi_vec3 sigma_s, ppmi_vec3 sigma_a, float asymmetry_g);
/* A linear RGB image of floats. */
ppm_image_id image_rgb(ppm_scene *scene, uint32_t width, uint32_t height, const float *pixels);

/* Freezes the scene and builds what rays need. */
typedef struct test_world {
    ppmi_world world;
    ppmi_accel *accel;
    ppmi_lights *lights;
    ppmi_contacts *contacts;
    ppm_context *context;
    const ppmi_albedo_table *albedo;
} test_world;

void world_open(test_world *test, const test_scene *scene);
void world_close(test_world *test);

/* The surface that a ray meets; fails the test when there is none. */
ppmi_surface world_hit(const test_world *test, ppmi_vec3 origin, ppmi_vec3 direction);

#endif
