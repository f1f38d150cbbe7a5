/* The same model as OBJ and as glTF gives the same picture, where both formats can say it. */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "obj_fixture.h"
#include "support/renders.h"

enum { QUADS = 10, SIDE = 24, BLOCKS = 4, SEEDS = 10, PASSES = 8 };

typedef struct quad {
    int material;
    float corners[4][3]; /* counter-clockwise from outside; texture (0,0) (1,0) (1,1) (0,1) */
} quad;

/* A room of floor, wall and lamp, with a closed block of glass before it. */
static const quad quads[QUADS] = {
    {0, {{-1, 0, 1}, {1, 0, 1}, {1, 0, -1}, {-1, 0, -1}}},
    {1, {{-1, 0, -1}, {0, 0, -1}, {0, 1.5, -1}, {-1, 1.5, -1}}},
    {2, {{0, 0, -1}, {1, 0, -1}, {1, 1.5, -1}, {0, 1.5, -1}}},
    {3, {{-0.5, 2, 0.5}, {-0.5, 2, -0.5}, {0.5, 2, -0.5}, {0.5, 2, 0.5}}},
    {4, {{-0.25, 0.125, 0.25}, {0.25, 0.125, 0.25}, {0.25, 0.75, 0.25}, {-0.25, 0.75, 0.25}}},
    {4,
     {{0.25, 0.125, -0.125}, {-0.25, 0.125, -0.125}, {-0.25, 0.75, -0.125}, {0.25, 0.75, -0.125}}},
    {4, {{0.25, 0.125, 0.25}, {0.25, 0.125, -0.125}, {0.25, 0.75, -0.125}, {0.25, 0.75, 0.25}}},
    {4, {{-0.25, 0.125, -0.125}, {-0.25, 0.125, 0.25}, {-0.25, 0.75, 0.25}, {-0.25, 0.75, -0.125}}},
    {4, {{-0.25, 0.75, 0.25}, {0.25, 0.75, 0.25}, {0.25, 0.75, -0.125}, {-0.25, 0.75, -0.125}}},
    {4, {{-0.25, 0.125, -0.125}, {0.25, 0.125, -0.125}, {0.25, 0.125, 0.25}, {-0.25, 0.125, 0.25}}},
};

/* Each material in both formats: a coated matt one, one with an image and a normal map, a rough
 * metal, a lamp, tinted glass. Ks 0.5 is glTF's own reflection, Ks 0 its specularFactor 0. */
static const struct {
    const char *mtl, *gltf;
} materials[] = {
    {"Kd 0.8 0.3 0.2\nKs 0.5 0.5 0.5\nPr 0.6\nPc 1\nPcr 0.1\nPs 0.2\n",
     "'pbrMetallicRoughness':{'baseColorFactor':[0.8,0.3,0.2,1],'metallicFactor':0,"
     "'roughnessFactor':0.6},'extensions':{'KHR_materials_clearcoat':{'clearcoatFactor':1,"
     "'clearcoatRoughnessFactor':0.1},'KHR_materials_sheen':{'sheenColorFactor':[0.2,0.2,0.2],"
     "'sheenRoughnessFactor':0.5}}"},
    {"Kd 1 1 1\nKs 0 0 0\nmap_Kd -s 2 1 paint.ppm\nnorm -bm 0.5 relief.ppm\n",
     "'pbrMetallicRoughness':{'baseColorTexture':{'index':0,'extensions':{'KHR_texture_transform':{"
     "'scale':[2,1]}}},'metallicFactor':0,'roughnessFactor':0.5},'normalTexture':{'index':1,"
     "'scale':0.5},'extensions':{'KHR_materials_specular':{'specularFactor':0}}"},
    {"Kd 0.9 0.7 0.3\nKs 0.5 0.5 0.5\nPm 1\nPr 0.3\naniso 0.5\nanisor 0.25\n",
     "'pbrMetallicRoughness':{'baseColorFactor':[0.9,0.7,0.3,1],'roughnessFactor':0.3},"
     "'extensions':{'KHR_materials_anisotropy':{'anisotropyStrength':0.5,"
     "'anisotropyRotation':1.5707963}}"},
    {"Kd 0 0 0\nKs 0 0 0\nKe 8 6 4\n",
     "'pbrMetallicRoughness':{'baseColorFactor':[0,0,0,1],'metallicFactor':0},"
     "'emissiveFactor':[1,0.75,0.5],'extensions':{'KHR_materials_specular':{'specularFactor':0},"
     "'KHR_materials_emissive_strength':{'emissiveStrength':8}}"},
    {"illum 7\nNi 1.4\nTf 0.8 1 0.8\n",
     "'pbrMetallicRoughness':{'baseColorFactor':[0.8,1,0.8,1],'metallicFactor':0,"
     "'roughnessFactor':0},'extensions':{'KHR_materials_ior':{'ior':1.4},"
     "'KHR_materials_transmission':{'transmissionFactor':1},"
     "'KHR_materials_volume':{'thicknessFactor':1}}"},
};
enum { MATERIALS = sizeof materials / sizeof materials[0] };

static void write_obj(obj_fixture *f)
{
    char text[8192];
    size_t used = (size_t)snprintf(text, sizeof text,
                                   "mtllib room.mtl\nvt 0 0\nvt 1 0\nvt 1 1\n"
                                   "vt 0 1\n");
    for (int i = 0; i < QUADS; ++i) {
        used += (size_t)snprintf(text + used, sizeof text - used, "o quad%d\nusemtl m%d\n", i,
                                 quads[i].material);
        for (int k = 0; k < 4; ++k) {
            const float *p = quads[i].corners[k];
            used += (size_t)snprintf(text + used, sizeof text - used, "v %.9g %.9g %.9g\n",
                                     (double)p[0], (double)p[1], (double)p[2]);
        }
        used += (size_t)snprintf(text + used, sizeof text - used, "f -4/1 -3/2 -2/3 -1/4\n");
    }
    obj_write_text(f, "sub/room.obj", text);
    used = 0;
    for (int i = 0; i < MATERIALS; ++i) {
        used += (size_t)snprintf(text + used, sizeof text - used, "newmtl m%d\n%s", i,
                                 materials[i].mtl);
    }
    obj_write_text(f, "sub/room.mtl", text);
}

/* Positions of all quads, then the coordinates and the indices that they share. */
static void write_buffer(obj_fixture *f)
{
    static const float uvs[8] = {0, 1, 1, 1, 1, 0, 0, 0};
    static const uint16_t indices[6] = {0, 1, 2, 0, 2, 3};
    unsigned char bytes[QUADS * 48 + sizeof uvs + sizeof indices];
    for (int i = 0; i < QUADS; ++i) {
        memcpy(bytes + i * 48, quads[i].corners, 48);
    }
    memcpy(bytes + QUADS * 48, uvs, sizeof uvs);
    memcpy(bytes + QUADS * 48 + sizeof uvs, indices, sizeof indices);
    obj_write(f, "sub/room.bin", bytes, sizeof bytes);
}

typedef struct text_buffer {
    char text[16384];
    size_t used;
} text_buffer;

#define append(t, ...)                                                                             \
    ((t)->used += (size_t)snprintf((t)->text + (t)->used, sizeof(t)->text - (t)->used, __VA_ARGS__))

static void write_gltf(obj_fixture *f)
{
    static text_buffer t;
    const int total = QUADS * 48 + 32 + 12;
    t.used = 0;
    append(&t,
           "{'asset':{'version':'2.0'},'extensionsUsed':['KHR_texture_transform'],"
           "'buffers':[{'uri':'room.bin','byteLength':%d}],'bufferViews':["
           "{'buffer':0,'byteLength':%d},{'buffer':0,'byteOffset':%d,'byteLength':32},"
           "{'buffer':0,'byteOffset':%d,'byteLength':12}],'accessors':["
           "{'bufferView':1,'componentType':5126,'type':'VEC2','count':4},"
           "{'bufferView':2,'componentType':5123,'type':'SCALAR','count':6}",
           total, QUADS * 48, QUADS * 48, QUADS * 48 + 32);
    for (int i = 0; i < QUADS; ++i) {
        float low[3], high[3];
        for (int k = 0; k < 3; ++k) {
            low[k] = high[k] = quads[i].corners[0][k];
            for (int c = 1; c < 4; ++c) {
                if (quads[i].corners[c][k] < low[k]) low[k] = quads[i].corners[c][k];
                if (quads[i].corners[c][k] > high[k]) high[k] = quads[i].corners[c][k];
            }
        }
        append(&t,
               ",{'bufferView':0,'byteOffset':%d,'componentType':5126,'type':'VEC3','count':4,"
               "'min':[%.9g,%.9g,%.9g],'max':[%.9g,%.9g,%.9g]}",
               i * 48, (double)low[0], (double)low[1], (double)low[2], (double)high[0],
               (double)high[1], (double)high[2]);
    }
    append(&t, "],'images':[{'uri':'paint.ppm'},{'uri':'relief.ppm'}],"
               "'textures':[{'source':0},{'source':1}],'materials':[");
    for (int i = 0; i < MATERIALS; ++i) {
        append(&t, "%s{'doubleSided':true,%s}", i > 0 ? "," : "", materials[i].gltf);
    }
    append(&t, "],'meshes':[");
    for (int i = 0; i < QUADS; ++i) {
        append(&t,
               "%s{'primitives':[{'attributes':{'POSITION':%d,'TEXCOORD_0':0},'indices':1,"
               "'material':%d}]}",
               i > 0 ? "," : "", i + 2, quads[i].material);
    }
    append(&t, "],'nodes':[");
    for (int i = 0; i < QUADS; ++i) {
        append(&t, "%s{'mesh':%d}", i > 0 ? "," : "", i);
    }
    append(&t, "],'scenes':[{'nodes':[");
    for (int i = 0; i < QUADS; ++i) {
        append(&t, "%s%d", i > 0 ? "," : "", i);
    }
    append(&t, "]}],'scene':0}");
    for (size_t i = 0; i < t.used; ++i) {
        if (t.text[i] == '\'') t.text[i] = '"';
    }
    obj_write_text(f, "sub/room.gltf", t.text);
}

static void write_images(obj_fixture *f)
{
    static const char paint[] = "P6 2 2 255\n\xff\x40\x40\x20\xff\x20\x10\x10\xff\x20\x20\x10";
    static const char relief[] = "P6 2 1 255\n\xc0\x80\xe0\x40\x90\xe0";
    obj_write(f, "sub/paint.ppm", paint, sizeof paint - 1);
    obj_write(f, "sub/relief.ppm", relief, sizeof relief - 1);
}

/* The file in a scene of its own, seen from before it. */
static ppm_scene *load(obj_fixture *f, const char *name)
{
    ppm_scene *scene = NULL;
    const ppm_camera_desc camera = {
        .size = sizeof camera,
        .transform = {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0.1f, 0.9f, 3.2f, 1},
        .y_fov_rad = 0.8f};
    ppm_camera_id id;
    f->log_length = 0;
    assert_int_equal(ppm_scene_create(f->context, NULL, &scene), PPM_STATUS_OK);
    assert_obj_status(f, ppm_scene_import(scene, obj_path(f, name), NULL), PPM_STATUS_OK);
    assert_obj_quiet(f);
    assert_int_equal(ppm_scene_add_camera(scene, &camera, &id), PPM_STATUS_OK);
    return scene;
}

/* Means of blocks of pixels, by block and channel. */
static void measure_blocks(ppm_scene *scene, uint64_t seed, double out[BLOCKS * BLOCKS][3])
{
    ppm_render_options options = render_options(PPM_INTEGRATOR_SPPM, SIDE, 20000);
    options.seed = seed;
    float *rgba = render_picture(scene, &options, TEST_EFFORT(PASSES));
    memset(out, 0, BLOCKS * BLOCKS * sizeof *out);
    for (size_t i = 0; i < SIDE * SIDE; ++i) {
        const size_t block = i / SIDE * BLOCKS / SIDE * BLOCKS + i % SIDE * BLOCKS / SIDE;
        for (size_t k = 0; k < 3; ++k) {
            out[block][k] += (double)rgba[4 * i + k] * BLOCKS * BLOCKS / (SIDE * SIDE);
        }
    }
    free(rgba);
}

static void the_same_model_gives_the_same_picture(void **state)
{
    obj_fixture *f = *state;
    static test_mean differences[BLOCKS * BLOCKS][3], means[BLOCKS * BLOCKS][3];
    test_family family = {0};
    write_images(f);
    write_obj(f);
    write_buffer(f);
    write_gltf(f);
    ppm_scene *obj = load(f, "sub/room.obj"), *gltf = load(f, "sub/room.gltf");
    for (uint64_t seed = 1; seed <= SEEDS; ++seed) {
        double a[BLOCKS * BLOCKS][3], b[BLOCKS * BLOCKS][3];
        measure_blocks(obj, seed, a);
        /* the same random numbers: there is little noise in the difference */
        measure_blocks(gltf, seed, b);
        for (size_t i = 0; i < BLOCKS * BLOCKS; ++i) {
            for (size_t k = 0; k < 3; ++k) {
                mean_add(&differences[i][k], a[i][k] - b[i][k]);
                mean_add(&means[i][k], 0.5 * (a[i][k] + b[i][k]));
            }
        }
    }
    for (size_t i = 0; i < BLOCKS * BLOCKS; ++i) {
        for (size_t k = 0; k < 3; ++k) {
            family_add_mean(&family, &differences[i][k], 0.0, 1e-6, "block %zu, channel %zu", i, k);
            if (means[i][k].mean > 0.05) mean_check_power(&means[i][k], 0.03);
        }
    }
    family_check(&family);
    ppm_scene_destroy(obj);
    ppm_scene_destroy(gltf);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test_setup_teardown(the_same_model_gives_the_same_picture, obj_setup,
                                        obj_teardown),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
