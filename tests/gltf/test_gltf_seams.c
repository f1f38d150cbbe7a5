/* Parts of glTF that meet in one file: each pair against the same file without the one. */
#include <math.h>
#include <meshoptimizer.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#if PPM_WITH_DRACO
#include "draco_encoder.h"
#endif
#include "gltf_motion.h"

enum { SIDE = 8, VERTICES = SIDE * SIDE, TRIANGLES = 2 * (SIDE - 1) * (SIDE - 1), ROOM = 1 << 15 };

/* A bent sheet that hangs between two joints, with a target. Its numbers are those that the
 * quantised columns stand for. */
static struct rig {
    float positions[VERTICES][3], normals[VERTICES][3], uvs[VERTICES][2], weights[VERTICES][4];
    float targets[VERTICES][3];
    int16_t short_positions[VERTICES][4], short_targets[VERTICES][4];
    int8_t byte_normals[VERTICES][4];
    uint16_t short_uvs[VERTICES][2];
    uint8_t byte_weights[VERTICES][4], joints[VERTICES][4];
    uint32_t indices[TRIANGLES][3];
    float binds[32], times[2], turns[8], steps[2];
} rig;

static void fill_vertex(uint32_t i)
{
    const int x = (int)(i % SIDE), y = (int)(i / SIDE);
    const int position[3] = {100 * x, 100 * y, 3 * x * y - 5 * x};
    const int target[3] = {x * x, -7 * y, 20 + x};
    const int normal[3] = {-3 * y + 5, -3 * x, 100};
    const int first = 255 * x / (SIDE - 1);
    const double length = sqrt(normal[0] * normal[0] + normal[1] * normal[1] + 1e4);
    for (int k = 0; k < 3; ++k) {
        rig.short_positions[i][k] = (int16_t)position[k];
        rig.short_targets[i][k] = (int16_t)target[k];
        rig.byte_normals[i][k] = (int8_t)lround(127 * normal[k] / length);
        rig.positions[i][k] = (float)position[k];
        rig.targets[i][k] = (float)target[k];
        rig.normals[i][k] = (float)rig.byte_normals[i][k] / 127.0f;
    }
    rig.short_uvs[i][0] = (uint16_t)(8000 * x + 100 * y);
    rig.short_uvs[i][1] = (uint16_t)(9000 * y + 50 * x);
    for (int k = 0; k < 2; ++k)
        rig.uvs[i][k] = (float)rig.short_uvs[i][k] / 65535.0f;
    rig.byte_weights[i][0] = (uint8_t)(255 - first);
    rig.byte_weights[i][1] = (uint8_t)first;
    for (int k = 0; k < 2; ++k)
        rig.weights[i][k] = (float)rig.byte_weights[i][k] / 255.0f;
    rig.joints[i][1] = 1;
}

static void fill_rig(void)
{
    static const float turns[8] = {0, 0, 0, 1, 0.6f, 0, 0, 0.8f};
    memset(&rig, 0, sizeof rig);
    for (uint32_t i = 0; i < VERTICES; ++i)
        fill_vertex(i);
    for (uint32_t i = 0, t = 0; i < VERTICES; ++i) {
        if (i % SIDE == SIDE - 1 || i / SIDE == SIDE - 1) continue;
        const uint32_t two[2][3] = {{i, i + 1, i + SIDE}, {i + SIDE, i + 1, i + SIDE + 1}};
        memcpy(rig.indices[t], two, sizeof two);
        t += 2;
    }
    for (int i = 0; i < 8; ++i)
        rig.binds[5 * (i % 4) + 16 * (i / 4)] = 1.0f;
    rig.binds[16 + 12] = -350.0f; /* the second joint stands at (350 0 0) */
    rig.times[1] = rig.steps[1] = 1.0f;
    memcpy(rig.turns, turns, sizeof turns);
}

/* ---- documents ------------------------------------------------------------------------------- */

/* An attribute: where it is in the rig. */
typedef struct column {
    const char *name;
    size_t offset, stride;
    int component;
    const char *type;
    bool is_normalized;
} column;

#define FLOATS(name, member, type)                                                                 \
    {                                                                                              \
        name, offsetof(struct rig, member), sizeof rig.member[0], 5126, type, false                \
    }
#define WHOLE(name, member, component, type, normalized)                                           \
    {                                                                                              \
        name, offsetof(struct rig, member), sizeof rig.member[0], component, type, normalized      \
    }
enum { POSITION, NORMAL, TEXCOORD, WEIGHTS, JOINTS, TARGET, COLUMNS };
static const column plain[COLUMNS] = {
    FLOATS("POSITION", positions, "VEC3"),
    FLOATS("NORMAL", normals, "VEC3"),
    FLOATS("TEXCOORD_0", uvs, "VEC2"),
    FLOATS("WEIGHTS_0", weights, "VEC4"),
    WHOLE("JOINTS_0", joints, 5121, "VEC4", false),
    FLOATS("", targets, "VEC3"),
};
static const column quantised[COLUMNS] = {
    WHOLE("POSITION", short_positions, 5122, "VEC3", false),
    WHOLE("NORMAL", byte_normals, 5120, "VEC3", true),
    WHOLE("TEXCOORD_0", short_uvs, 5123, "VEC2", true),
    WHOLE("WEIGHTS_0", byte_weights, 5121, "VEC4", true),
    WHOLE("JOINTS_0", joints, 5121, "VEC4", false),
    WHOLE("", short_targets, 5122, "VEC3", false),
};

enum { PLAIN, MESHOPT, DRACO };

/* What a file has besides its columns. */
typedef struct parts {
    bool is_skinned, is_morphed, is_instanced;
    int packing;
} parts;

/* A document on its way: text of views and accessors, and the bytes of packed ones. */
typedef struct document {
    char views[8192], accessors[4096], attributes[512], packed_attributes[512];
    unsigned char packed[ROOM];
    size_t packed_count;
} document;

static bool is_used(const parts *p, int c)
{
    if (c == TARGET) return p->is_morphed;
    return p->is_skinned || (c != WEIGHTS && c != JOINTS);
}

static char *end_of(char *text)
{
    return text + strlen(text);
}

#define APPEND(text, ...) snprintf(end_of(text), sizeof(text) - strlen(text), __VA_ARGS__)

/* A view of count elements from offset on, or of what they are packed to. */
static void add_view(document *d, int packing, size_t offset, size_t count, size_t stride,
                     bool is_vertices)
{
    const char *comma = d->views[0] ? "," : "";
    const unsigned char *bytes = (const unsigned char *)&rig + offset;
    if (packing != MESHOPT) {
        APPEND(d->views, "%s{'buffer':0,'byteOffset':%zu,'byteLength':%zu", comma, offset,
               count * stride);
        if (is_vertices) APPEND(d->views, ",'byteStride':%zu", stride);
        APPEND(d->views, "}");
        return;
    }
    unsigned char *out = d->packed + d->packed_count;
    const size_t room = ROOM - d->packed_count;
    const size_t length =
        is_vertices
            ? meshopt_encodeVertexBuffer(out, room, bytes, count, stride)
            : meshopt_encodeIndexBuffer(out, room, (const unsigned *)(const void *)bytes, count);
    assert_true(length > 0);
    APPEND(d->views, "%s{'buffer':2,'byteLength':%zu", comma, count * stride);
    if (is_vertices) APPEND(d->views, ",'byteStride':%zu", stride);
    APPEND(d->views,
           ",'extensions':{'EXT_meshopt_compression':{'buffer':1,'byteOffset':%zu,"
           "'byteLength':%zu,'byteStride':%zu,'count':%zu,'mode':'%s'}}}",
           d->packed_count, length, stride, count, is_vertices ? "ATTRIBUTES" : "TRIANGLES");
    d->packed_count += (length + 3) / 4 * 4;
}

static void add_columns(document *d, const column *columns, const parts *p)
{
    for (int c = 0, n = 0; c < COLUMNS; ++c) {
        if (!is_used(p, c)) continue;
        const bool has_view = p->packing != DRACO || c == TARGET;
        APPEND(d->accessors, "%s{'componentType':%d,'count':%d,'type':'%s'%s", n ? "," : "",
               columns[c].component, (int)VERTICES, columns[c].type,
               columns[c].is_normalized ? ",'normalized':true" : "");
        if (has_view) APPEND(d->accessors, ",'bufferView':%d", n);
        APPEND(d->accessors, "}");
        add_view(d, p->packing, columns[c].offset, VERTICES, columns[c].stride, true);
        if (c != TARGET) {
            APPEND(d->attributes, "%s'%s':%d", n ? "," : "", columns[c].name, n);
            APPEND(d->packed_attributes, "%s'%s':%d", n ? "," : "", columns[c].name, n);
        }
        ++n;
    }
}

#if PPM_WITH_DRACO
static void encode_draco(document *d, const column *columns, const parts *p)
{
    draco_column out[COLUMNS];
    size_t count = 0;
    for (int c = 0; c < TARGET; ++c) {
        if (!is_used(p, c)) continue;
        out[count++] = (draco_column){.values = (const unsigned char *)&rig + columns[c].offset,
                                      .component = columns[c].component,
                                      .components = columns[c].type[3] - '0',
                                      .is_normalized = columns[c].is_normalized,
                                      .is_position = c == POSITION};
    }
    d->packed_count = draco_encode_columns(DRACO_EDGEBREAKER, out, count, VERTICES, rig.indices[0],
                                           TRIANGLES, d->packed, ROOM);
    assert_true(d->packed_count > 0);
}
#else
static void encode_draco(document *d, const column *columns, const parts *p)
{
    (void)d, (void)columns, (void)p;
}
#endif

/* Node 0 has the sheet, nodes 1 and 2 are the joints; both animations reach their end at 1 s. */
static void open_sheet(gltf_fixture *f, const column *columns, const parts *p,
                       ppmi_gltf_asset **asset)
{
    static char text[1 << 16];
    static document d;
    const int attributes = p->is_skinned ? 5 : 3, targets = attributes;
    const int indices = attributes + p->is_morphed, binds = indices + 1;
    char extension[1024] = "", node[160] = "", target[64] = "", channels[512] = "";
    memset(&d, 0, sizeof d);
    add_columns(&d, columns, p);
    APPEND(d.accessors, ",{'componentType':5125,'count':%d,'type':'SCALAR'", 3 * (int)TRIANGLES);
    if (p->packing != DRACO) APPEND(d.accessors, ",'bufferView':%d", indices);
    APPEND(d.accessors, "}");
    add_view(&d, p->packing, offsetof(struct rig, indices), 3 * (size_t)TRIANGLES, 4, false);
    const struct {
        size_t offset, bytes;
        int count;
        const char *type;
    } rest[] = {{offsetof(struct rig, binds), sizeof rig.binds, 2, "MAT4"},
                {offsetof(struct rig, times), sizeof rig.times, 2, "SCALAR"},
                {offsetof(struct rig, turns), sizeof rig.turns, 2, "VEC4"},
                {offsetof(struct rig, steps), sizeof rig.steps, 2, "SCALAR"}};
    for (int i = 0; i < 4; ++i) {
        APPEND(d.accessors, ",{'bufferView':%d,'componentType':5126,'count':%d,'type':'%s'}",
               binds + i, rest[i].count, rest[i].type);
        add_view(&d, PLAIN, rest[i].offset, rest[i].bytes, 1, false);
    }
    if (p->packing == DRACO) {
        encode_draco(&d, columns, p);
        APPEND(d.views, ",{'buffer':1,'byteLength':%zu}", d.packed_count);
        snprintf(extension, sizeof extension,
                 ",'extensions':{'KHR_draco_mesh_compression':{'bufferView':%d,'attributes':{%s}}}",
                 binds + 4, d.packed_attributes);
    }
    if (p->is_morphed) snprintf(target, sizeof target, ",'targets':[{'POSITION':%d}]", targets);
    if (p->is_skinned) snprintf(node, sizeof node, ",'skin':0");
    if (p->is_instanced) {
        APPEND(node, ",'extensions':{'EXT_mesh_gpu_instancing':{'attributes':{'TRANSLATION':1}}}");
    }
    snprintf(channels, sizeof channels, "{'sampler':0,'target':{'node':2,'path':'rotation'}}%s",
             p->is_morphed ? ",{'sampler':1,'target':{'node':0,'path':'weights'}}" : "");
    gltf_write(f, "sub/rig.bin", &rig, sizeof rig);
    if (d.packed_count == 0) d.packed_count = 4;
    gltf_write(f, "sub/packed.bin", d.packed, d.packed_count);
    snprintf(text, sizeof text,
             "{'asset':{'version':'2.0'},'scenes':[{'nodes':[0,1]}],"
             "'nodes':[{'mesh':0%s},{'children':[2],'translation':[0,0,40]},"
             "{'translation':[350,0,0]}],"
             "'skins':[{'joints':[1,2],'inverseBindMatrices':%d}],"
             "'materials':[{'normalTexture':{'index':0}}],'textures':[{'source':0}],"
             "'images':[{'uri':'data:image/png;base64,iVBORw0KGgoAAAANSUhEUgAAAAEAAAABCAIAAACQd1Pe"
             "AAAADElEQVR4nGP4//8/AAX+Av4N70a4AAAAAElFTkSuQmCC'}],"
             "'meshes':[{'primitives':[{'attributes':{%s},'indices':%d,'material':0%s%s}]}],"
             "'animations':[{'channels':[%s],'samplers':[{'input':%d,'output':%d},"
             "{'input':%d,'output':%d}]}],"
             "'accessors':[%s],'bufferViews':[%s],"
             "'buffers':[{'byteLength':%zu,'uri':'rig.bin'},{'byteLength':%zu,'uri':'packed.bin'},"
             "{'byteLength':65536,'extensions':{'EXT_meshopt_compression':{'fallback':true}}}]}",
             node, binds, d.attributes, indices, target, extension, channels, binds + 1, binds + 2,
             binds + 1, binds + 3, d.accessors, d.views, sizeof rig, d.packed_count);
    f->options.pose = gltf_at(1.0);
    assert_gltf_status(f, gltf_open_text(f, text, asset), PPM_STATUS_OK);
}

/* ---- comparison ------------------------------------------------------------------------------ */

typedef struct corner {
    float position[3], normal[3], tangent[4], uv[2];
} corner;

/* The triangles as they are now, whatever their vertices are numbered. */
typedef struct snapshot {
    corner corners[TRIANGLES][3];
} snapshot;

static void take(const gltf_fixture *f, snapshot *out)
{
    assert_int_equal(f->scene->mesh_count, 1);
    assert_int_equal(f->scene->instance_count, 1);
    const ppmi_primitive *p = &f->scene->meshes[0].primitives[0];
    assert_int_equal(p->triangle_count, TRIANGLES);
    assert_non_null(p->tangents);
    for (uint32_t i = 0; i < 3 * TRIANGLES; ++i) {
        corner *c = &out->corners[i / 3][i % 3];
        const uint32_t v = p->indices[i];
        memcpy(c->position, p->positions + 3 * v, sizeof c->position);
        memcpy(c->normal, p->normals + 3 * v, sizeof c->normal);
        memcpy(c->tangent, p->tangents + 4 * v, sizeof c->tangent);
        memcpy(c->uv, p->uvs[0] + 2 * v, sizeof c->uv);
    }
}

static bool are_near(const float *a, const float *b, int count, float tolerance)
{
    for (int i = 0; i < count; ++i) {
        if (!(fabsf(a[i] - b[i]) <= tolerance)) return false;
    }
    return true;
}

/* positions are up to 700 */
static bool are_same(const corner a[3], const corner b[3], int turn)
{
    for (int k = 0; k < 3; ++k) {
        const corner *one = &a[k], *other = &b[(k + turn) % 3];
        if (!are_near(one->position, other->position, 3, 2e-3f)) return false;
        if (!are_near(one->uv, other->uv, 2, 1e-6f)) return false;
        if (!are_near(one->normal, other->normal, 3, 1e-4f)) return false;
        if (!are_near(one->tangent, other->tangent, 4, 1e-3f)) return false;
    }
    return true;
}

static void assert_same(const snapshot *a, const snapshot *b)
{
    for (int i = 0; i < TRIANGLES; ++i) {
        bool is_found = false;
        for (int k = 0; k < TRIANGLES && !is_found; ++k) {
            for (int turn = 0; turn < 3 && !is_found; ++turn)
                is_found = are_same(a->corners[i], b->corners[k], turn);
        }
        if (!is_found) fail_msg("triangle %d has no twin", i);
    }
}

/* Both files in the pose of their import, in one of the middle, and at rest. */
static void compare(gltf_fixture *f, const column *columns, const parts *p)
{
    static snapshot expected[3], got[3];
    const parts twin = {.is_skinned = p->is_skinned, .is_morphed = p->is_morphed};
    const ppm_pose poses[2] = {gltf_at(0.4), {0}};
    fill_rig();
    for (int file = 0; file < 2; ++file) {
        ppmi_gltf_asset *asset;
        snapshot *taken = file == 0 ? expected : got;
        gltf_reset(f);
        open_sheet(f, file == 0 ? plain : columns, file == 0 ? &twin : p, &asset);
        take(f, &taken[0]);
        for (int i = 0; i < 2; ++i) {
            assert_int_equal(ppmi_gltf_asset_set_pose(asset, &poses[i]), PPM_STATUS_OK);
            take(f, &taken[i + 1]);
        }
        ppmi_gltf_asset_close(asset);
    }
    /* the poses differ, so that they are compared at all */
    assert_true(memcmp(&expected[0], &expected[1], sizeof(snapshot)) != 0);
    assert_true(memcmp(&expected[1], &expected[2], sizeof(snapshot)) != 0);
    for (int i = 0; i < 3; ++i)
        assert_same(&expected[i], &got[i]);
}

/* ---- geometry -------------------------------------------------------------------------------- */

static void a_skinned_draco_mesh_gets_the_tangents_of_its_plain_twin(void **state)
{
#if PPM_WITH_DRACO
    compare(*state, plain, &(parts){.is_skinned = true, .packing = DRACO});
#else
    (void)state;
    skip();
#endif
}

static void a_quantised_draco_mesh_follows_its_joints(void **state)
{
#if PPM_WITH_DRACO
    compare(*state, quantised, &(parts){.is_skinned = true, .packing = DRACO});
#else
    (void)state;
    skip();
#endif
}

static void morph_targets_may_be_packed_by_meshopt(void **state)
{
    compare(*state, plain, &(parts){.is_morphed = true, .packing = MESHOPT});
    compare(*state, plain, &(parts){.is_morphed = true, .is_skinned = true, .packing = MESHOPT});
}

static void quantised_meshes_follow_their_joints(void **state)
{
    compare(*state, quantised, &(parts){.is_skinned = true});
}

static void quantised_targets_move_quantised_meshes(void **state)
{
    compare(*state, quantised, &(parts){.is_morphed = true});
    compare(*state, quantised,
            &(parts){.is_morphed = true, .is_skinned = true, .packing = MESHOPT});
}

/* ---- nodes, scenes, materials ---------------------------------------------------------------- */

/* Joints say where the vertices of a skinned mesh are, and not its node (specification, 3.7.3.3):
 * so there is one of it, whatever places EXT_mesh_gpu_instancing names. */
static void a_skinned_mesh_stays_one_under_instancing(void **state)
{
    static snapshot expected, got;
    gltf_fixture *f = *state;
    const parts skinned = {.is_skinned = true};
    ppmi_gltf_asset *asset;
    fill_rig();
    open_sheet(f, plain, &skinned, &asset);
    take(f, &expected);
    ppmi_gltf_asset_close(asset);
    gltf_reset(f);
    open_sheet(f, plain, &(parts){.is_skinned = true, .is_instanced = true}, &asset);
    take(f, &got); /* which wants one instance */
    ppmi_gltf_asset_close(asset);
    assert_same(&expected, &got);
    assert_gltf_logged(f, 'W', "EXT_mesh_gpu_instancing");
}

#define VARIANTS                                                                                   \
    "'extensions':{'KHR_materials_variants':{'variants':[{'name':'day'},{'name':'night'}]}},"      \
    "'materials':[{},{'name':'moving','pbrMetallicRoughness':{'roughnessFactor':0.25}}],"
#define MOVING                                                                                     \
    "'animations':[{'channels':[{'sampler':0,'target':{'path':'pointer','extensions':{"            \
    "'KHR_animation_pointer':{'pointer':'/materials/1/pbrMetallicRoughness/roughnessFactor'}}}}]," \
    "'samplers':[{'input':1,'output':2}]}],"

/* Opens a triangle of material number plain, which a variant may replace by the moving one. */
static void open_variant(gltf_fixture *f, const char *variant, int material,
                         ppmi_gltf_asset **asset)
{
    static const float data[13] = {0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 1, 0, 1};
    char text[4096];
    gltf_reset(f);
    f->options.variant = variant;
    f->options.pose = gltf_at(0.5);
    snprintf(text, sizeof text,
             "{" GLTF_HEAD VARIANTS MOVING "'nodes':[{'mesh':0}],"
             "'meshes':[{'primitives':[{'attributes':{'POSITION':0},'material':%d,"
             "'extensions':{'KHR_materials_variants':{'mappings':[{'material':1,"
             "'variants':[1]}]}}}]}],"
             "'accessors':[{'bufferView':0,'componentType':5126,'count':3,'type':'VEC3'},"
             "{'bufferView':0,'byteOffset':36,'componentType':5126,'count':2,'type':'SCALAR'},"
             "{'bufferView':0,'byteOffset':44,'componentType':5126,'count':2,'type':'SCALAR'}],"
             "'bufferViews':[{'buffer':0,'byteLength':52}],"
             "'buffers':[{'byteLength':52,'uri':'%s'}]}",
             material, gltf_data_uri(data, sizeof data));
    assert_gltf_status(f, gltf_open_text(f, text, asset), PPM_STATUS_OK);
}

static void a_variant_moves_as_its_plain_twin_does(void **state)
{
    gltf_fixture *f = *state;
    static const struct {
        const char *variant;
        int material;
    } cases[2] = {{"night", 0}, {NULL, 1}};
    for (int i = 0; i < 2; ++i) {
        ppmi_gltf_asset *asset;
        open_variant(f, cases[i].variant, cases[i].material, &asset);
        assert_int_equal(f->scene->material_count, 1);
        assert_float_equal(f->scene->materials[0].desc.roughness, 0.5f, 1e-6f);
        const ppm_pose when = gltf_at(0.75), rest = {0};
        assert_int_equal(ppmi_gltf_asset_set_pose(asset, &when), PPM_STATUS_OK);
        assert_float_equal(f->scene->materials[0].desc.roughness, 0.75f, 1e-6f);
        assert_int_equal(ppmi_gltf_asset_set_pose(asset, &rest), PPM_STATUS_OK);
        assert_float_equal(f->scene->materials[0].desc.roughness, 0.25f, 1e-6f);
        ppmi_gltf_asset_close(asset);
    }
}

static void a_material_that_no_variant_shows_may_be_animated(void **state)
{
    gltf_fixture *f = *state;
    ppmi_gltf_asset *asset;
    open_variant(f, "day", 0, &asset);
    assert_int_equal(f->scene->material_count, 1);
    const float roughness = f->scene->materials[0].desc.roughness;
    const ppm_pose when = gltf_at(0.75);
    assert_int_equal(ppmi_gltf_asset_set_pose(asset, &when), PPM_STATUS_OK);
    assert_int_equal(f->scene->material_count, 1);
    assert_float_equal(f->scene->materials[0].desc.roughness, roughness, 0.0f);
    ppmi_gltf_asset_close(asset);
}

#define TEST(name) cmocka_unit_test_setup_teardown(name, gltf_setup, gltf_teardown)

int main(void)
{
    const struct CMUnitTest tests[] = {
        TEST(a_skinned_draco_mesh_gets_the_tangents_of_its_plain_twin),
        TEST(a_quantised_draco_mesh_follows_its_joints),
        TEST(morph_targets_may_be_packed_by_meshopt),
        TEST(quantised_meshes_follow_their_joints),
        TEST(quantised_targets_move_quantised_meshes),
        TEST(a_skinned_mesh_stays_one_under_instancing),
        TEST(a_variant_moves_as_its_plain_twin_does),
        TEST(a_material_that_no_variant_shows_may_be_animated),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
