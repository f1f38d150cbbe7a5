#include "render/layer_fixture.h"

#include <setjmp.h>
#include <stdarg.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

ppm_render *layers_render(ppm_scene *scene, const ppm_render_options *options, uint32_t passes)
{
    ppm_render *render = NULL;
    assert_int_equal(ppm_render_create(scene, options, &render), PPM_STATUS_OK);
    for (uint32_t i = 0; i < passes; i++)
        assert_int_equal(ppm_render_advance(render), PPM_STATUS_OK);
    return render;
}

float *layers_read(const ppm_render *render, int32_t kind, uint32_t number)
{
    const uint32_t *crop = ppm_render_get_options(render)->crop;
    const size_t pixels = (size_t)(crop[2] - crop[0]) * (crop[3] - crop[1]);
    for (uint32_t i = 0; i < ppm_render_layer_count(render); i++) {
        ppm_layer_info info = {.size = sizeof info};
        assert_int_equal(ppm_render_get_layer(render, i, &info), PPM_STATUS_OK);
        if (info.kind != kind || number-- > 0) continue;
        const size_t count = info.channel_count * pixels;
        float *values = malloc(count * sizeof *values);
        assert_non_null(values);
        assert_int_equal(ppm_render_read_layer(render, i, values, count), PPM_STATUS_OK);
        return values;
    }
    fail_msg("no layer of kind %d", kind);
    return NULL;
}

float *layers_picture(ppm_scene *scene, const ppm_render_options *options, uint32_t passes,
                      int32_t kind)
{
    ppm_render *render = layers_render(scene, options, passes);
    float *values = layers_read(render, kind, 0);
    ppm_render_destroy(render);
    return values;
}

ppm_render_options layers_options(uint32_t width, int32_t kind)
{
    ppm_render_options options = render_options(PPM_INTEGRATOR_PATH, width, 1000);
    options.layers = PPM_LAYER_BIT(kind);
    return options;
}

ppm_instance_id layers_add_quad(ppm_scene *scene, const char *name, ppm_material_id material,
                                ppmi_vec3 origin, ppmi_vec3 edge_u, ppmi_vec3 edge_v)
{
    const ppm_instance_desc desc = {.size = sizeof desc,
                                    .name = name,
                                    .mesh = shape_quad(scene, material, origin, edge_u, edge_v),
                                    .transform = {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1}};
    ppm_instance_id id = 0;
    assert_int_equal(ppm_scene_add_instance(scene, &desc, &id), PPM_STATUS_OK);
    return id;
}

void layers_at_place(ppmi_vec3 p, float columns[16])
{
    const float identity[16] = {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, p.x, p.y, p.z, 1};
    memcpy(columns, identity, sizeof identity);
}

ppm_instance_id layers_add_moving_wall(ppm_scene *scene, ppmi_vec3 from, ppmi_vec3 to)
{
    float motion[32];
    layers_at_place(from, motion);
    layers_at_place(to, motion + 16);
    const ppm_instance_desc desc = {.size = sizeof desc,
                                    .mesh = shape_quad(scene, material_lambert(scene, 0.5f),
                                                       vec3(-40, -40, 0), vec3(80, 0, 0),
                                                       vec3(0, 80, 0)),
                                    .motion_steps = 2,
                                    .motion = motion};
    ppm_instance_id id = 0;
    assert_int_equal(ppm_scene_add_instance(scene, &desc, &id), PPM_STATUS_OK);
    return id;
}
