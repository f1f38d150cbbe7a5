/* Every allocation fails in turn: each failure is reported, nothing leaks, and a render goes on as
 * if nothing had happened. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <string.h>

#include <cmocka.h>

#include "ppm/render.h"
#include "support/scenes.h"

static ppm_status add_material(ppm_scene *scene, float emission, ppm_image_id image,
                               ppm_material_id *out_id)
{
    ppm_material_desc desc;
    ppm_material_desc_init(&desc);
    desc.name = "material";
    desc.emission[1] = emission;
    desc.base_color_texture.image = image;
    return ppm_scene_add_material(scene, &desc, out_id);
}

static ppm_status add_triangles(ppm_scene *scene, ppm_material_id material, ppm_mesh_id *out_id)
{
    static const float positions[12] = {0, 0, 0, 1, 0, 0, 0, 1, 0, 1, 1, 1};
    static const float normals[12] = {0, 0, 1, 0, 0, 1, 0, 0, 1, 0, 0, 1};
    static const float tangents[16] = {1, 0, 0, 1, 1, 0, 0, 1, 1, 0, 0, 1, 1, 0, 0, 1};
    static const float uvs[8] = {0, 0, 1, 0, 0, 1, 1, 1};
    static const float colors[16] = {1, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1};
    static const uint32_t indices[6] = {0, 1, 2, 1, 3, 2};
    const ppm_primitive_desc primitives[2] = {
        {.vertex_count = 4,
         .triangle_count = 2,
         .positions = positions,
         .normals = normals,
         .tangents = tangents,
         .uvs = {uvs, NULL, uvs},
         .colors = colors,
         .indices = indices,
         .material = material},
        {.vertex_count = 4, .triangle_count = 2, .positions = positions, .indices = indices}};
    const ppm_mesh_desc desc = {
        .size = sizeof desc, .name = "mesh", .primitive_count = 2, .primitives = primitives};
    return ppm_scene_add_mesh(scene, &desc, out_id);
}

#define TRY(call)                                                                                  \
    do {                                                                                           \
        const ppm_status try_status = (call);                                                      \
        if (try_status != PPM_STATUS_OK) return try_status;                                        \
    } while (0)

/* Every kind of thing, most of them often enough for their arrays to grow. */
static ppm_status fill(ppm_scene *scene)
{
    static const uint8_t pixels[4] = {0, 255, 255, 0};
    const ppm_image_desc image = {.size = sizeof image,
                                  .name = "image",
                                  .role = PPM_IMAGE_COLOR,
                                  .pixels = pixels,
                                  .pixel_type = PPM_PIXELS_U8,
                                  .width = 2,
                                  .height = 2,
                                  .channels = 1};
    ppm_instance_desc instance = {.size = sizeof instance,
                                  .transform = {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1}};
    const ppm_light_desc light = {.size = sizeof light,
                                  .intensity = {1, 1, 1},
                                  .transform = {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 5, 1}};
    ppm_image_id image_id;
    ppm_material_id material_id;
    uint32_t id;
    for (int i = 0; i < 9; i++) {
        TRY(ppm_scene_add_image(scene, &image, &image_id));
        TRY(add_material(scene, i == 8 ? 1.0f : 0.0f, image_id, &material_id));
        TRY(add_triangles(scene, material_id, &instance.mesh));
        instance.transform[12] = (float)i;
        TRY(ppm_scene_add_instance(scene, &instance, &id));
        TRY(ppm_scene_add_light(scene, &light, &id));
        TRY(ppm_scene_add_framing_camera(scene, 1.0f, &id));
    }
    const ppm_environment_desc environment = {
        .size = sizeof environment, .radiance = {1, 1, 1}, .image = image_id};
    return ppm_scene_set_environment(scene, &environment);
}

static ppm_context *make_context(void)
{
    ppm_context *context = NULL;
    assert_int_equal(ppm_context_create(NULL, &context), PPM_STATUS_OK);
    return context;
}

static void building_a_scene_bears_any_failed_allocation(void **state)
{
    (void)state;
    ppm_context *context = make_context();
    ppm_status status = PPM_STATUS_OUT_OF_MEMORY;
    size_t n = 1;
    for (; status != PPM_STATUS_OK; n++) {
        ppm_scene *scene = NULL;
        ppmi_alloc_fail_at(context, n);
        status = ppm_scene_create(context, NULL, &scene);
        if (status == PPM_STATUS_OK) status = fill(scene);
        ppmi_alloc_fail_at(context, 0);
        assert_true(status == PPM_STATUS_OK || status == PPM_STATUS_OUT_OF_MEMORY);
        ppm_scene_destroy(scene);
        assert_int_equal(ppmi_alloc_live(context), 0);
    }
    assert_true(n > 150); /* so many allocations were there to fail */
    ppm_context_destroy(context);
}

/* What a caller may do after a failure: look at the scene, add more, render. */
static void a_scene_is_usable_after_a_failed_call(void **state)
{
    (void)state;
    ppm_context *context = make_context();
    for (size_t n = 2; n < 40; n++) {
        ppm_scene *scene = NULL;
        assert_int_equal(ppm_scene_create(context, NULL, &scene), PPM_STATUS_OK);
        ppmi_alloc_fail_at(context, n);
        assert_int_equal(fill(scene), PPM_STATUS_OUT_OF_MEMORY);
        ppmi_alloc_fail_at(context, 0);
        assert_int_equal(fill(scene), PPM_STATUS_OK);
        ppm_scene_info info = {.size = sizeof info};
        assert_int_equal(ppm_scene_get_info(scene, &info), PPM_STATUS_OK);
        assert_true(info.instances >= 9);
        ppm_scene_destroy(scene);
        assert_int_equal(ppmi_alloc_live(context), 0);
    }
    ppm_context_destroy(context);
}

enum { SIDE = 20, FLOATS = 4 * SIDE * SIDE };

static ppm_render_options small(int32_t integrator)
{
    return (ppm_render_options){.size = sizeof(ppm_render_options),
                                .integrator = integrator,
                                .width = SIDE,
                                .height = SIDE,
                                .photons_per_pass = 3000,
                                .threads = 3};
}

static void creating_a_render_bears_any_failed_allocation(void **state)
{
    (void)state;
    for (int32_t integrator = PPM_INTEGRATOR_SPPM; integrator <= PPM_INTEGRATOR_PATH;
         integrator++) {
        ppm_context *context = make_context();
        const ppm_render_options options = small(integrator);
        ppm_status status = PPM_STATUS_OUT_OF_MEMORY;
        size_t n = 1;
        for (; status != PPM_STATUS_OK; n++) {
            /* a new one each time: what a session leaves with it needs no memory again */
            ppm_scene *scene = NULL;
            assert_int_equal(ppm_scene_create(context, NULL, &scene), PPM_STATUS_OK);
            assert_int_equal(fill(scene), PPM_STATUS_OK);
            ppm_render *render = NULL;
            ppmi_alloc_fail_at(context, n);
            status = ppm_render_create(scene, &options, &render);
            ppmi_alloc_fail_at(context, 0);
            assert_true(status == PPM_STATUS_OK || status == PPM_STATUS_OUT_OF_MEMORY);
            assert_int_equal(render == NULL, status != PPM_STATUS_OK);
            ppm_render_destroy(render);
            ppm_scene_destroy(scene);
            assert_int_equal(ppmi_alloc_live(context), 0);
        }
        assert_true(n > 10);
        ppm_context_destroy(context);
    }
}

static void read_after(ppm_render *render, uint32_t passes, float *rgba)
{
    for (uint32_t i = 0; i < passes; i++)
        assert_int_equal(ppm_render_advance(render), PPM_STATUS_OK);
    assert_int_equal(ppm_render_read_image(render, rgba, FLOATS), PPM_STATUS_OK);
}

static void a_pass_that_runs_out_of_memory_leaves_no_trace(void **state)
{
    (void)state;
    ppm_context *context = make_context();
    ppm_scene *scene = NULL;
    assert_int_equal(ppm_scene_create(context, NULL, &scene), PPM_STATUS_OK);
    assert_int_equal(fill(scene), PPM_STATUS_OK);
    const ppm_render_options options = small(PPM_INTEGRATOR_SPPM);
    ppm_render *render = NULL;
    static float undisturbed[FLOATS], disturbed[FLOATS];
    assert_int_equal(ppm_render_create(scene, &options, &render), PPM_STATUS_OK);
    read_after(render, 2, undisturbed);
    ppm_render_destroy(render);
    bool failed = true;
    size_t n = 1;
    for (; failed; n++) {
        assert_int_equal(ppm_render_create(scene, &options, &render), PPM_STATUS_OK);
        ppmi_alloc_fail_at(context, n);
        const ppm_status status = ppm_render_advance(render);
        ppmi_alloc_fail_at(context, 0);
        failed = status != PPM_STATUS_OK;
        if (failed) assert_int_equal(status, PPM_STATUS_OUT_OF_MEMORY);
        ppm_render_stats stats = {.size = sizeof stats};
        assert_int_equal(ppm_render_get_stats(render, &stats), PPM_STATUS_OK);
        assert_int_equal(stats.passes, failed ? 0 : 1);
        read_after(render, failed ? 2 : 1, disturbed);
        assert_memory_equal(disturbed, undisturbed, sizeof disturbed);
        ppm_render_destroy(render);
    }
    assert_true(n > 10);
    ppm_scene_destroy(scene);
    assert_int_equal(ppmi_alloc_live(context), 0);
    ppm_context_destroy(context);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(building_a_scene_bears_any_failed_allocation),
        cmocka_unit_test(a_scene_is_usable_after_a_failed_call),
        cmocka_unit_test(creating_a_render_bears_any_failed_allocation),
        cmocka_unit_test(a_pass_that_runs_out_of_memory_leaves_no_trace),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
