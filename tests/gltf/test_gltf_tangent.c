/* importers/gltf/gltf_tangent.c, and importers/tangent against tangents that Blender exported */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>

#include "gltf_fixture.h"
#include "tangent/tangent.h"

static const float quad[] = {
    0, 0, 0, 1, 0, 0, 1, 1, 0, 0, 1, 0, /* positions */
    0, 0, 1, 0, 0, 1, 0, 0, 1, 0, 0, 1, /* normals */
    0, 0, 1, 0, 1, 1, 0, 1,             /* coordinates */
    0, 1, 2, 3,                         /* an attribute that counts vertices: colour, red */
    0, 0, 0, 0, 0, 0, 0, 0,
};

/* A square of two triangles; attributes and materials are JSON with '. */
static ppm_status import_quad(gltf_fixture *f, const char *attributes, const char *materials)
{
    static const uint16_t indices[6] = {0, 1, 2, 0, 2, 3};
    unsigned char bytes[sizeof quad + sizeof indices];
    memcpy(bytes, quad, sizeof quad);
    memcpy(bytes + sizeof quad, indices, sizeof indices);
    return gltf_importf(
        f,
        "{" GLTF_HEAD "'nodes':[{'mesh':0}],"
        "'meshes':[{'primitives':[{'attributes':{'POSITION':0%s},'indices':3,'material':0}]}],"
        "'materials':[{%s}],'textures':[{'source':0}],"
        "'images':[{'uri':'data:image/png;base64,AAAA'}],"
        "'accessors':[{'bufferView':0,'componentType':5126,'count':4,'type':'VEC3'},"
        "{'bufferView':0,'byteOffset':48,'componentType':5126,'count':4,'type':'VEC3'},"
        "{'bufferView':0,'byteOffset':96,'componentType':5126,'count':4,'type':'VEC2'},"
        "{'bufferView':0,'byteOffset':%zu,'componentType':5123,'count':6,'type':'SCALAR'}],"
        "'bufferViews':[{'buffer':0,'byteLength':%zu}],"
        "'buffers':[{'byteLength':%zu,'uri':'%s'}]}",
        attributes, materials, sizeof quad, sizeof bytes, sizeof bytes,
        gltf_data_uri(bytes, sizeof bytes));
}

static const ppmi_primitive *first(const gltf_fixture *f)
{
    assert_int_equal(f->scene->mesh_count, 1);
    return &f->scene->meshes[0].primitives[0];
}

static void without_a_normal_map_there_are_none(void **state)
{
    gltf_fixture *f = *state;
    assert_gltf_status(f, import_quad(f, ",'NORMAL':1,'TEXCOORD_0':2", "'name':'plain'"),
                       PPM_STATUS_OK);
    assert_null(first(f)->tangents);
}

static void without_normals_or_coordinates_there_are_none(void **state)
{
    gltf_fixture *f = *state;
    assert_gltf_status(f, import_quad(f, ",'TEXCOORD_0':2", "'normalTexture':{'index':0}"),
                       PPM_STATUS_OK);
    assert_null(first(f)->tangents);
    gltf_reset(f);
    assert_gltf_status(f, import_quad(f, ",'NORMAL':1", "'normalTexture':{'index':0}"),
                       PPM_STATUS_OK);
    assert_null(first(f)->tangents);
    gltf_reset(f);
    assert_gltf_status(
        f, import_quad(f, ",'NORMAL':1,'TEXCOORD_0':2", "'normalTexture':{'index':0,'texCoord':3}"),
        PPM_STATUS_OK);
    assert_null(first(f)->tangents);
}

static void the_coordinates_are_those_of_the_normal_map(void **state)
{
    gltf_fixture *f = *state;
    assert_gltf_status(
        f, import_quad(f, ",'NORMAL':1,'TEXCOORD_2':2", "'normalTexture':{'index':0,'texCoord':2}"),
        PPM_STATUS_OK);
    assert_non_null(first(f)->tangents);
    for (uint32_t v = 0; v < 4; ++v) { /* u along x; v runs down, so the bitangent is against y */
        static const float expected[] = {1, 0, 0, -1};
        assert_memory_equal(first(f)->tangents + 4 * v, expected, sizeof expected);
    }
}

/* Two triangles about the edge x = 0 with mirrored coordinates. */
static const struct {
    float positions[12], normals[12], uvs[8], colors[16];
    uint16_t indices[6];
} mirrored = {{0, 0, 0, 1, 0, 0, 0, 1, 0, -1, 0, 0},
              {0, 0, 1, 0, 0, 1, 0, 0, 1, 0, 0, 1},
              {0, 0, 1, 0, 0, 1, 1, 0},
              {.1f, 0, 0, 1, .2f, 0, 0, 1, .3f, 0, 0, 1, .4f, 0, 0, 1},
              {0, 1, 2, 0, 2, 3}};

static ppm_status import_mirrored(gltf_fixture *f)
{
    return gltf_importf(
        f,
        "{" GLTF_HEAD "'nodes':[{'mesh':0}],'meshes':[{'primitives':[{'attributes':{"
        "'POSITION':0,'NORMAL':1,'TEXCOORD_0':2,'COLOR_0':3},'indices':4,'material':0}]}],"
        "'materials':[{'normalTexture':{'index':0}}],'textures':[{'source':0}],"
        "'images':[{'uri':'data:image/png;base64,AAAA'}],"
        "'accessors':[{'bufferView':0,'componentType':5126,'count':4,'type':'VEC3'},"
        "{'bufferView':0,'byteOffset':48,'componentType':5126,'count':4,'type':'VEC3'},"
        "{'bufferView':0,'byteOffset':96,'componentType':5126,'count':4,'type':'VEC2'},"
        "{'bufferView':0,'byteOffset':128,'componentType':5126,'count':4,'type':'VEC4'},"
        "{'bufferView':0,'byteOffset':192,'componentType':5123,'count':6,'type':'SCALAR'}],"
        "'bufferViews':[{'buffer':0,'byteLength':204}],"
        "'buffers':[{'byteLength':204,'uri':'%s'}]}",
        gltf_data_uri(&mirrored, 204));
}

static void memory_that_is_out_is_told(void **state)
{
    gltf_fixture *f = *state;
    ppm_status status = PPM_STATUS_OUT_OF_MEMORY;
    size_t n = 0;
    while (status == PPM_STATUS_OUT_OF_MEMORY) {
        gltf_reset(f);
        ppmi_alloc_fail_at(f->context, ++n);
        status = import_mirrored(f);
        ppmi_alloc_fail_at(f->context, 0);
    }
    assert_gltf_status(f, status, PPM_STATUS_OK);
    assert_true(n > 30);
    assert_int_equal(first(f)->vertex_count, 6);
}

static void split_vertices_keep_their_attributes(void **state)
{
    gltf_fixture *f = *state;
    assert_gltf_status(f, import_mirrored(f), PPM_STATUS_OK);
    const ppmi_primitive *p = first(f);
    assert_int_equal(p->vertex_count, 6);
    for (uint32_t i = 0; i < 6; ++i) {
        const uint32_t got = p->indices[i], wanted = mirrored.indices[i];
        assert_memory_equal(p->positions + 3 * got, mirrored.positions + 3 * wanted, 12);
        assert_memory_equal(p->uvs[0] + 2 * got, mirrored.uvs + 2 * wanted, 8);
        assert_memory_equal(p->colors + 4 * got, mirrored.colors + 4 * wanted, 16);
        assert_float_equal(p->tangents[4 * got], i < 3 ? 1.0f : -1.0f, 1e-6f);
        assert_float_equal(p->tangents[4 * got + 3], i < 3 ? -1.0f : 1.0f, 0.0f);
    }
}

/* ---- against others -------------------------------------------------------------------------- */

/* Corners of a mesh by how far our tangent is from the file's. */
typedef struct agreement {
    size_t corners, within_1, within_5, same_w;
} agreement;

static float angle_deg(const float *a, const float *b)
{
    const double x = a[0], y = a[1], z = a[2], u = b[0], v = b[1], w = b[2];
    const double cross[3] = {y * w - z * v, z * u - x * w, x * v - y * u};
    const double sine = sqrt(cross[0] * cross[0] + cross[1] * cross[1] + cross[2] * cross[2]);
    return (float)(atan2(sine, x * u + y * v + z * w) * 57.29577951308232);
}

static void compare(gltf_fixture *f, const ppmi_primitive *p, agreement *sum)
{
    const ppmi_tangent_mesh mesh = {.positions = p->positions,
                                    .normals = p->normals,
                                    .uvs = p->uvs[0],
                                    .v_runs_down = true,
                                    .vertex_count = p->vertex_count,
                                    .indices = p->indices,
                                    .triangle_count = p->triangle_count};
    ppmi_tangent_result result;
    assert_int_equal(ppmi_tangent_compute(f->context, &mesh, &result), PPM_STATUS_OK);
    for (size_t i = 0; i < 3 * (size_t)p->triangle_count; ++i) {
        const float *got = result.tangents + 4 * (size_t)result.indices[i];
        const float *given = p->tangents + 4 * (size_t)p->indices[i];
        const float angle = angle_deg(got, given);
        sum->corners++;
        sum->within_1 += angle < 1.0f;
        sum->within_5 += angle < 5.0f;
        sum->same_w += got[3] == given[3];
    }
    ppmi_tangent_result_deinit(f->context, &result);
}

static agreement compare_file(gltf_fixture *f, const char *path)
{
    char full[512];
    agreement sum = {0};
    snprintf(full, sizeof full, PPM_ASSETS_DIR "/%s", path);
    gltf_reset(f);
    assert_gltf_status(f, ppmi_gltf_import(f->context, f->scene, full, &f->options), PPM_STATUS_OK);
    for (uint32_t m = 0; m < f->scene->mesh_count; ++m) {
        for (uint32_t i = 0; i < f->scene->meshes[m].primitive_count; ++i) {
            const ppmi_primitive *p = &f->scene->meshes[m].primitives[i];
            if (p->tangents && p->normals && p->uvs[0]) compare(f, p, &sum);
        }
    }
    return sum;
}

/* Triangles are compared as they are in the file. Blender computes tangents on polygons: on the
 * quadrilaterals of Suzanne it weighs corners by other angles than those of the triangles. The
 * others were triangles before. */
static void tangents_are_those_of_other_programs(void **state)
{
    gltf_fixture *f = *state;
    static const struct {
        const char *path;
        double within_1, within_5; /* least shares of corners */
    } files[] = {
        {"gltf-blender/02_suzanne.glb", 0.85, 0.99},
        {"gltf-blender/roundtrip/25_anisotropy/25_anisotropy.gltf", 0.9999, 0.9999},
        {"gltf/AnisotropyStrengthTest.glb", 0.9999, 0.9999},
        {"gltf/SheenCloth.glb", 0.9999, 0.9999},
        {"gltf/PBR_Spheres.glb", 0.9999, 0.9999},
        {"gltf/tangent_cube/tangent_cube.gltf", 0.9999, 0.9999},
    };
    struct stat info;
    if (stat(PPM_ASSETS_DIR "/geometry.tsv", &info) != 0) skip();
    for (size_t i = 0; i < sizeof files / sizeof files[0]; ++i) {
        const agreement a = compare_file(f, files[i].path);
        const double all = (double)a.corners;
        assert_true(a.corners >= 36);
        if (!((double)a.within_1 >= files[i].within_1 * all) ||
            !((double)a.within_5 >= files[i].within_5 * all) || a.same_w < a.corners) {
            fail_msg(
                "%s: of %zu corners %zu are within 1 degree, %zu within 5, %zu have the same w",
                files[i].path, a.corners, a.within_1, a.within_5, a.same_w);
        }
    }
}

#define TEST(name) cmocka_unit_test_setup_teardown(name, gltf_setup, gltf_teardown)

int main(void)
{
    const struct CMUnitTest tests[] = {
        TEST(without_a_normal_map_there_are_none),
        TEST(without_normals_or_coordinates_there_are_none),
        TEST(the_coordinates_are_those_of_the_normal_map),
        TEST(memory_that_is_out_is_told),
        TEST(split_vertices_keep_their_attributes),
        TEST(tangents_are_those_of_other_programs),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
