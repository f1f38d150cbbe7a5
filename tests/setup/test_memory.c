/* The ways out when memory ends: the n-th allocation fails, for every n. jansson's own memory is
 * not the context's. */
#include "setup/setup_fixture.h"

static const char document[] =
    "{ \"cameras\": [ { \"position\": [0, 1, 3], \"target\": [0, 0, 0], \"fov\": 40, "
    "\"focus_node\": \"Box\" } ], \"lights\": [ { \"kind\": \"point\", \"position\": [0, 2, 0], "
    "\"profile\": \"a.ies\" } ], \"environment\": { \"image\": \"sky.hdr\" }, "
    "\"materials\": [ { \"match\": \"Glass\", \"normal_texture\": \"sky.hdr\" }, "
    "{ \"match\": \"none\", \"roughness\": 0 } ], "
    "\"nodes\": [ { \"match\": \"Box\", \"nested_priority\": 2 } ], \"fog\": { \"sigma_s\": 0.1 }, "
    "\"render\": { \"size\": \"4x4\", \"passes\": 2 } }";

static ppm_status open_and_apply(setup_fixture *f)
{
    const ppm_status status = setup_open(f, document);
    return status == PPM_STATUS_OK ? ppm_setup_apply(f->setup, f->scene, PPM_SETUP_ALL) : status;
}

static void every_allocation_may_fail(void **state)
{
    setup_fixture *f = *state;
    ppm_status status = PPM_STATUS_OUT_OF_MEMORY;
    size_t n = 0;
    setup_write_picture(f, "inner/sky.hdr");
    setup_write(f, "inner/a.ies",
                "IESNA:LM-63-2002\nTILT=NONE\n1 1000 1 3 1 1 2 0 0 0\n1 1 100\n0 45 90\n0\n"
                "100 50 10\n");
    while (status == PPM_STATUS_OUT_OF_MEMORY) {
        ppm_setup_close(f->setup);
        f->setup = NULL;
        ppm_scene_destroy(f->scene);
        f->scene = setup_make_room(f->context);
        ppmi_alloc_fail_at(f->context, ++n);
        status = open_and_apply(f);
        ppmi_alloc_fail_at(f->context, 0);
        if (status != PPM_STATUS_OK && !setup_logged(f, 'E', "memory")) {
            fail_msg("allocation %zu: status %d, nothing said\n%s", n, (int)status, f->log);
        }
        assert_true(n < 1000);
    }
    if (status != PPM_STATUS_OK) fail_msg("allocation %zu, status %d\n%s", n, (int)status, f->log);
    assert_true(n > 30);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test_setup_teardown(every_allocation_may_fail, setup_setup, setup_teardown),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
