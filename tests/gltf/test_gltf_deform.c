/* importers/gltf/gltf_deform.c: skins and morph targets against sums that are done here. */
#include <math.h>
#include <stdio.h>
#include <string.h>

#include "gltf_motion.h"

#define CLOSE(a, b) assert_float_equal((double)(a), (double)(b), 1e-5)

/* Five vertices, of which the triangles use all but the second; two joints. */
static const struct rig {
    float positions[15], normals[15], tangents[20];
    float weights[20], more_weights[20];
    float inverse_binds[32]; /* joint 0: as it is; joint 1: from (1 0 0) */
    float times[2], turns[8], morph_weights[2];
    float targets[15], target_normals[15];
    uint8_t joints[20], more_joints[20];
    uint8_t byte_weights[20];
    uint16_t indices[6];
} rig = {
    {0, 0, 0, 9, 9, 9, 1, 0, 0, 2, 1, 0, 2, 0, 1},
    {0, 0, 1, 0, 0, 1, 0, 0, 1, 0, 1, 0, 1, 0, 0},
    {1, 0, 0, 1, 1, 0, 0, 1, 1, 0, 0, -1, 1, 0, 0, 1, 0, 1, 0, 1},
    {1, 0, 0, 0, 1, 0, 0, 0, 0.25f, 0.75f, 0, 0, 0, 1, 0, 0, 0.5f, 0.5f, 0, 0},
    {1, 0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 3, 0, 0, 0, 1, 0, 0, 0},
    {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0,  0, 0, 1,
     1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, -1, 0, 0, 1},
    {0, 1},
    {0, 0, 0, 1, 0, 0, 0.70710678f, 0.70710678f}, /* joint 1: a quarter turn about Z */
    {0, 1},
    {0, 0, 3, 7, 7, 7, 0, 0, 0, 0, 2, 0, 0, 0, 0},
    {0, 1, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0},
    {0, 0, 0, 0, 1, 1, 1, 1, 0, 1, 0, 0, 0, 1, 0, 0, 0, 1, 0, 0},
    {1, 0, 0, 0, 1, 1, 1, 1, 0, 1, 0, 0, 0, 1, 0, 0, 0, 1, 0, 0},
    {200, 0, 0, 0, 9, 9, 9, 9, 51, 102, 0, 0, 0, 0, 0, 0, 0, 255, 0, 0},
    {0, 2, 3, 0, 3, 4},
};

enum { /* accessors */
       POSITIONS,
       NORMALS,
       TANGENTS,
       WEIGHTS,
       MORE_WEIGHTS,
       INVERSE_BINDS,
       TIMES,
       TURNS,
       MORPH_WEIGHTS,
       TARGETS,
       TARGET_NORMALS,
       JOINTS,
       MORE_JOINTS,
       BYTE_WEIGHTS,
       INDICES,
       FEW_BINDS
};

#define AT(member) offsetof(struct rig, member)
#define FLOATS(member, count, type)                                                                \
    {                                                                                              \
        AT(member), 5126, count, type, 0                                                           \
    }
static const struct {
    size_t offset;
    int component, count;
    const char *type;
    int normalized;
} accessors[] = {
    FLOATS(positions, 5, "VEC3"),
    FLOATS(normals, 5, "VEC3"),
    FLOATS(tangents, 5, "VEC4"),
    FLOATS(weights, 5, "VEC4"),
    FLOATS(more_weights, 5, "VEC4"),
    FLOATS(inverse_binds, 2, "MAT4"),
    FLOATS(times, 2, "SCALAR"),
    FLOATS(turns, 2, "VEC4"),
    FLOATS(morph_weights, 2, "SCALAR"),
    FLOATS(targets, 5, "VEC3"),
    FLOATS(target_normals, 5, "VEC3"),
    {AT(joints), 5121, 5, "VEC4", 0},
    {AT(more_joints), 5121, 5, "VEC4", 0},
    {AT(byte_weights), 5121, 5, "VEC4", 1},
    {AT(indices), 5123, 6, "SCALAR", 0},
    {AT(inverse_binds), 5126, 1, "MAT4", 0},
    {AT(positions), 5126, 5, "VEC2", 0},
};

/* What differs between the documents: members of node 0, attributes of the primitive, members of
 * the primitive and of the mesh, each with a comma before it; and of the document, with one behind
 * it. NULL for none. */
typedef struct parts {
    const char *node, *attributes, *primitive, *mesh, *document;
    const char *joint; /* members of node 1, the first joint */
} parts;

static const char *or_none(const char *text)
{
    return text ? text : "";
}

/* The mesh's node 0 and the joints 1 and 2, the second at (1 0 0) in the first; node 3 is not in
 * the scene and node 4 has the mesh, too. */
static ppm_status open_parts(gltf_fixture *f, const parts *p, ppmi_gltf_asset **asset)
{
    static char text[1 << 14];
    char list[4096] = "";
    for (size_t i = 0; i < sizeof accessors / sizeof accessors[0]; ++i) {
        snprintf(list + strlen(list), sizeof list - strlen(list),
                 "%s{'bufferView':0,'byteOffset':%zu,'componentType':%d,'count':%d,'type':'%s'%s}",
                 i > 0 ? "," : "", accessors[i].offset, accessors[i].component, accessors[i].count,
                 accessors[i].type, accessors[i].normalized ? ",'normalized':true" : "");
    }
    snprintf(text, sizeof text,
             "{'asset':{'version':'2.0'},'scenes':[{'nodes':[0,1]},{'nodes':[0,1,4]}],"
             "'nodes':[{'mesh':0,'translation':[50,60,70]%s},{'children':[2],"
             "'translation':[0,0,4]%s},{'translation':[1,0,0]},{'name':'outside'},{'mesh':0}],%s"
             "'meshes':[{'primitives':[{'indices':%d,'attributes':{'POSITION':%d%s}%s}]%s}],"
             "'accessors':[%s],'bufferViews':[{'buffer':0,'byteLength':%zu}],"
             "'buffers':[{'byteLength':%zu,'uri':'%s'}]}",
             or_none(p->node), or_none(p->joint), or_none(p->document), INDICES, POSITIONS,
             or_none(p->attributes), or_none(p->primitive), or_none(p->mesh), list, sizeof rig,
             sizeof rig, gltf_data_uri(&rig, sizeof rig));
    return gltf_open_text(f, text, asset);
}

static ppm_status open_rig(gltf_fixture *f, const char *node, const char *attributes,
                           const char *primitive, const char *document, ppmi_gltf_asset **asset)
{
    const parts p = {
        .node = node, .attributes = attributes, .primitive = primitive, .document = document};
    return open_parts(f, &p, asset);
}

#define SKIN "'skins':[{'joints':[1,2],'inverseBindMatrices':5}],"
#define INFLUENCES ",'JOINTS_0':11,'WEIGHTS_0':3"
#define TURN                                                                                       \
    "'animations':[{'channels':[{'sampler':0,'target':{'node':2,'path':'rotation'}}],"             \
    "'samplers':[{'input':6,'output':7}]}],"

static const ppmi_primitive *only_primitive(const gltf_fixture *f)
{
    assert_int_equal(f->scene->mesh_count, 1);
    assert_int_equal(f->scene->meshes[0].primitive_count, 1);
    assert_int_equal(f->scene->meshes[0].primitives[0].vertex_count, 4);
    return &f->scene->meshes[0].primitives[0];
}

/* The vertices that are kept, as they are numbered in the file. */
static const size_t kept[4] = {0, 2, 3, 4};

/* Joint 0 adds (0 0 4); joint 1 turns about Z through (1 0 0), too. */
static ppmi_vec3 follow(int joint, double angle, ppmi_vec3 p)
{
    if (joint == 0) return vec3(p.x, p.y, p.z + 4);
    const double x = (double)p.x - 1.0, y = (double)p.y, c = cos(angle), s = sin(angle);
    return vec3((float)(1.0 + c * x - s * y), (float)(s * x + c * y), p.z + 4);
}

static void assert_near(ppmi_vec3 got, ppmi_vec3 expected)
{
    if (vec3_length(vec3_sub(got, expected)) < 1e-5f) return;
    fail_msg("%g %g %g, expected %g %g %g", (double)got.x, (double)got.y, (double)got.z,
             (double)expected.x, (double)expected.y, (double)expected.z);
}

static ppmi_vec3 blended(double angle, double share, ppmi_vec3 p)
{
    return vec3_add(vec3_scale(follow(0, angle, p), (float)(1.0 - share)),
                    vec3_scale(follow(1, angle, p), (float)share));
}

static ppmi_vec3 rest_position(size_t i)
{
    return vec3_load(rig.positions + 3 * kept[i]);
}

/* What each kept vertex takes of joint 1. */
static const double shares[4] = {0.0, 0.75, 1.0, 0.5};

/* ---- broken files ---------------------------------------------------------------------------- */

static void broken_skins_are_refused(void **state)
{
    gltf_fixture *f = *state;
    static const struct {
        const char *attributes, *rest, *message;
    } cases[] = {
        {INFLUENCES, "", "nodes[0].skin: skins[0] does not exist"},
        {INFLUENCES, "'skins':[{}],", "skins[0].joints: missing"},
        {INFLUENCES, "'skins':[{'joints':[]}],", "skins[0].joints: there are none"},
        {INFLUENCES, "'skins':[{'joints':[9]}],", "skins[0].joints[0]: nodes[9] does not exist"},
        {INFLUENCES, "'skins':[{'joints':[1,2],'inverseBindMatrices':15}],",
         "1 matrices for 2 joints"},
        {INFLUENCES, "'skins':[{'joints':[1],'inverseBindMatrices':5}],",
         "joint 1, the skin has 1"},
        {",'JOINTS_0':11", SKIN, "attributes.WEIGHTS_0: missing beside JOINTS_0"},
        {",'JOINTS_0':11,'WEIGHTS_0':6", SKIN, "type: 1 components"},
    };
    for (size_t i = 0; i < sizeof cases / sizeof cases[0]; ++i) {
        ppmi_gltf_asset *asset;
        gltf_reset(f);
        assert_gltf_status(f,
                           open_rig(f, ",'skin':0", cases[i].attributes, "", cases[i].rest, &asset),
                           PPM_STATUS_INPUT_INVALID);
        assert_gltf_logged(f, 'E', cases[i].message);
    }
}

static void broken_targets_are_refused(void **state)
{
    gltf_fixture *f = *state;
    static const struct {
        const char *primitive, *message;
    } cases[] = {
        {",'targets':[{'POSITION':99}]", "targets[0].POSITION: accessors[99] does not exist"},
        {",'targets':[{'POSITION':5}]", "targets[0].POSITION (accessors[5]): type"},
        {",'targets':[{'POSITION':14}]", "targets[0].POSITION (accessors[14]): type"},
        {",'targets':{}", "targets: expected an array"},
        {",'targets':[3]", "targets[0]: expected an object"},
    };
    for (size_t i = 0; i < sizeof cases / sizeof cases[0]; ++i) {
        ppmi_gltf_asset *asset;
        gltf_reset(f);
        assert_gltf_status(f, open_rig(f, ",'weights':[1]", "", cases[i].primitive, "", &asset),
                           PPM_STATUS_INPUT_INVALID);
        assert_gltf_logged(f, 'E', cases[i].message);
    }
}

/* ---- skins ----------------------------------------------------------------------------------- */

/* Joint 0 adds (0 0 4), joint 1 is at the point 0. */
static void joints_outside_of_the_scene_move_their_skin(void **state)
{
    gltf_fixture *f = *state;
    for (int i = 0; i < 2; ++i) {
        ppmi_gltf_asset *asset;
        gltf_reset(f);
        f->options.strict = i == 1;
        assert_gltf_status(
            f, open_rig(f, ",'skin':0", INFLUENCES, "", "'skins':[{'joints':[1,3]}],", &asset),
            i == 0 ? PPM_STATUS_OK : PPM_STATUS_INPUT_UNSUPPORTED);
        assert_gltf_logged(f, 'W', "skins[0].joints[1]: nodes[3] is not in the scene");
        if (i == 1) break;
        const ppmi_primitive *p = only_primitive(f);
        for (size_t k = 0; k < 4; ++k) {
            const float z = (float)(4.0 * (1.0 - shares[k]));
            assert_near(vec3_load(p->positions + 3 * k), vec3_add(rest_position(k), vec3(0, 0, z)));
        }
        ppmi_gltf_asset_close(asset);
    }
}

static void vertices_follow_their_joints_and_not_the_node(void **state)
{
    gltf_fixture *f = *state;
    ppmi_gltf_asset *asset;
    f->options.pose = gltf_at(0.5);
    assert_gltf_status(
        f, open_rig(f, ",'skin':0", INFLUENCES ",'NORMAL':1,'TANGENT':2", "", SKIN TURN, &asset),
        PPM_STATUS_OK);
    const ppmi_primitive *p = only_primitive(f);
    const double angle = 0.25 * 3.14159265358979;
    for (size_t i = 0; i < 4; ++i) {
        assert_near(vec3_load(p->positions + 3 * i), blended(angle, shares[i], rest_position(i)));
    }
    const ppmi_transform *m = &f->scene->instances[0].to_world;
    assert_near(m->origin, vec3(0, 0, 0));
    /* vertex 3 hangs on joint 1 alone: +Y and +X are turned by 45 degrees */
    const float r = 0.70710678f;
    assert_near(vec3_load(p->normals + 6), vec3(-r, r, 0));
    assert_near(vec3_load(p->tangents + 8), vec3(r, r, 0));
    CLOSE(p->tangents[7], -1.0); /* the bitangent's sign stays */
    ppmi_gltf_asset_close(asset);
}

/* A blend that squeezes: normals go with the inverse transpose, not with the blend itself. */
static void normals_stay_perpendicular_to_the_surface(void **state)
{
    gltf_fixture *f = *state;
    ppmi_gltf_asset *asset;
    f->options.pose = gltf_at(1.0);
    assert_gltf_status(
        f, open_rig(f, ",'skin':0", INFLUENCES ",'NORMAL':1,'TANGENT':2", "", SKIN TURN, &asset),
        PPM_STATUS_OK);
    const ppmi_primitive *p = only_primitive(f);
    /* vertex 4: half of joint 1, a quarter turn. Blend of identity and turn, columns
     * (0.5 0.5 0) (-0.5 0.5 0) (0 0 1): +X as a normal goes to its cofactors (0.5 0.5 0) */
    const float r = 0.70710678f;
    assert_near(vec3_load(p->normals + 9), vec3(r, r, 0));
    for (size_t i = 0; i < 4; ++i) {
        CLOSE(vec3_length(vec3_load(p->normals + 3 * i)), 1.0);
        CLOSE(vec3_length(vec3_load(p->tangents + 4 * i)), 1.0);
    }
    ppmi_gltf_asset_close(asset);
}

static void a_skin_without_matrices_has_identities(void **state)
{
    gltf_fixture *f = *state;
    ppmi_gltf_asset *asset;
    assert_gltf_status(
        f, open_rig(f, ",'skin':0", INFLUENCES, "", "'skins':[{'joints':[1,2]}],", &asset),
        PPM_STATUS_OK);
    /* joint 1 at (1 0 4) */
    assert_near(vec3_load(only_primitive(f)->positions + 6), vec3(3, 1, 4));
    ppmi_gltf_asset_close(asset);
}

static void further_sets_of_joints_count_too(void **state)
{
    gltf_fixture *f = *state;
    ppmi_gltf_asset *asset;
    f->options.pose = gltf_at(1.0);
    assert_gltf_status(
        f,
        open_rig(f, ",'skin':0", INFLUENCES ",'JOINTS_1':12,'WEIGHTS_1':4", "", SKIN TURN, &asset),
        PPM_STATUS_OK);
    const ppmi_primitive *p = only_primitive(f);
    /* sums of both sets, by joint 1: 1 of 2; 0.75 of 2; 1 of 4; 0.5 of 2 */
    static const double both[4] = {0.5, 0.375, 0.25, 0.25};
    for (size_t i = 0; i < 4; ++i) {
        assert_near(vec3_load(p->positions + 3 * i),
                    blended(1.57079632679, both[i], rest_position(i)));
    }
    ppmi_gltf_asset_close(asset);
}

static void weights_are_brought_to_a_sum_of_one(void **state)
{
    gltf_fixture *f = *state;
    ppmi_gltf_asset *asset;
    f->options.pose = gltf_at(1.0);
    assert_gltf_status(
        f, open_rig(f, ",'skin':0", ",'JOINTS_0':11,'WEIGHTS_0':13", "", SKIN TURN, &asset),
        PPM_STATUS_OK);
    assert_gltf_logged(f, 'W', "1 vertices without weights follow their first joint");
    static const double by_bytes[4] = {0.0, 2.0 / 3.0, 0.0, 1.0};
    const ppmi_primitive *p = only_primitive(f);
    for (size_t i = 0; i < 4; ++i) {
        assert_near(vec3_load(p->positions + 3 * i),
                    blended(1.57079632679, by_bytes[i], rest_position(i)));
    }
    ppmi_gltf_asset_close(asset);
}

static void a_mesh_without_joints_follows_its_node(void **state)
{
    gltf_fixture *f = *state;
    ppmi_gltf_asset *asset;
    assert_gltf_status(f, open_rig(f, ",'skin':0", "", "", SKIN, &asset), PPM_STATUS_OK);
    assert_gltf_logged(f, 'W', "no JOINTS_0");
    assert_near(vec3_load(only_primitive(f)->positions + 3), vec3(51, 60, 70));
    ppmi_gltf_asset_close(asset);
}

/* As with any mirrored mesh, so that faces point outwards still. */
static void a_mirrored_armature_turns_triangles_round(void **state)
{
    gltf_fixture *f = *state;
    const parts p = {.node = ",'skin':0",
                     .attributes = INFLUENCES ",'NORMAL':1",
                     .joint = ",'scale':[-1,1,1]",
                     .document = SKIN};
    ppmi_gltf_asset *asset;
    assert_gltf_status(f, open_parts(f, &p, &asset), PPM_STATUS_OK);
    const ppmi_primitive *primitive = only_primitive(f);
    assert_near(vec3_load(primitive->positions + 6), vec3(-2, 1, 4));
    assert_int_equal(primitive->indices[1], 2);
    assert_int_equal(primitive->indices[2], 1);
    assert_near(vec3_load(primitive->normals + 6), vec3(0, 1, 0));
    assert_near(vec3_load(primitive->normals + 9), vec3(-1, 0, 0));
    ppmi_gltf_asset_close(asset);
}

/* ---- morph targets --------------------------------------------------------------------------- */

#define MORPH ",'targets':[{'POSITION':9,'NORMAL':10}]"

static void targets_are_added_by_their_weights(void **state)
{
    gltf_fixture *f = *state;
    ppmi_gltf_asset *asset;
    assert_gltf_status(f, open_rig(f, ",'weights':[0.5]", ",'NORMAL':1", MORPH, "", &asset),
                       PPM_STATUS_OK);
    const ppmi_primitive *p = only_primitive(f);
    assert_near(vec3_load(p->positions), vec3(0, 0, 1.5f));
    assert_near(vec3_load(p->positions + 3), vec3(1, 0, 0));
    assert_near(vec3_load(p->positions + 6), vec3(2, 2, 0));
    const float r = 1.0f / sqrtf(1.25f); /* (0 0.5 1), normalised */
    assert_near(vec3_load(p->normals), vec3(0, 0.5f * r, r));
    /* the node's transform holds as for any mesh */
    assert_near(f->scene->instances[0].to_world.origin, vec3(50, 60, 70));
    ppmi_gltf_asset_close(asset);
}

static void the_mesh_has_weights_for_nodes_without(void **state)
{
    gltf_fixture *f = *state;
    const parts p = {.primitive = MORPH, .mesh = ",'weights':[0.25]"};
    ppmi_gltf_asset *asset;
    assert_gltf_status(f, open_parts(f, &p, &asset), PPM_STATUS_OK);
    assert_near(vec3_load(only_primitive(f)->positions), vec3(0, 0, 0.75f));
    ppmi_gltf_asset_close(asset);
}

static void weights_are_animated_by_node_and_by_pointer(void **state)
{
    gltf_fixture *f = *state;
    static const char *const targets[] = {
        "'node':0,'path':'weights'",
        "'path':'pointer','extensions':{'KHR_animation_pointer':{'pointer':'/nodes/0/weights'}}",
        "'path':'pointer','extensions':{'KHR_animation_pointer':{'pointer':'/meshes/0/weights'}}",
        "'path':'pointer','extensions':{'KHR_animation_pointer':{'pointer':'/nodes/0/weights/0'}}"};
    for (size_t i = 0; i < 4; ++i) {
        ppmi_gltf_asset *asset;
        char rest[512];
        snprintf(rest, sizeof rest,
                 "'animations':[{'channels':[{'sampler':0,'target':{%s}}],"
                 "'samplers':[{'input':6,'output':8}]}],",
                 targets[i]);
        gltf_reset(f);
        f->options.pose = gltf_at(0.25);
        assert_gltf_status(f, open_rig(f, "", "", MORPH, rest, &asset), PPM_STATUS_OK);
        assert_near(vec3_load(only_primitive(f)->positions), vec3(0, 0, 0.75f));
        const ppm_pose when = gltf_at(1.0);
        assert_int_equal(ppmi_gltf_asset_set_pose(asset, &when), PPM_STATUS_OK);
        assert_near(vec3_load(only_primitive(f)->positions), vec3(0, 0, 3));
        ppmi_gltf_asset_close(asset);
    }
}

static void targets_change_colours_and_texture_coordinates(void **state)
{
    gltf_fixture *f = *state;
    static const float weights[3] = {0.25f, 1.0f, 0.5f};
    /* vertex 3: (0 1 0 0) + w (3 0 0 0), within 0 .. 1; and (1 0) + w (1 0) */
    static const float reds[3] = {0.75f, 1.0f, 1.0f}, us[3] = {1.25f, 2.0f, 1.5f};
    ppmi_gltf_asset *asset;
    f->options.pose = gltf_at(0.25);
    assert_gltf_status(f,
                       open_rig(f, "", ",'COLOR_0':3,'TEXCOORD_0':16",
                                ",'targets':[{'COLOR_0':4,'TEXCOORD_0':16}]",
                                "'animations':[{'channels':[{'sampler':0,'target':{'node':0,"
                                "'path':'weights'}}],'samplers':[{'input':6,'output':8}]}],",
                                &asset),
                       PPM_STATUS_OK);
    for (size_t i = 0; i < 3; ++i) {
        const ppm_pose when = gltf_at((double)weights[i]);
        if (i > 0) assert_int_equal(ppmi_gltf_asset_set_pose(asset, &when), PPM_STATUS_OK);
        const ppmi_primitive *p = only_primitive(f);
        CLOSE(p->colors[8], reds[i]);
        CLOSE(p->colors[9], 1.0);
        CLOSE(p->uvs[0][4], us[i]);
        CLOSE(p->uvs[0][5], 0.0);
        assert_near(vec3_load(p->positions + 6), rest_position(2));
    }
    ppmi_gltf_asset_close(asset);
}

static void targets_come_before_the_skin(void **state)
{
    gltf_fixture *f = *state;
    ppmi_gltf_asset *asset;
    f->options.pose = gltf_at(1.0);
    assert_gltf_status(f,
                       open_rig(f, ",'skin':0,'weights':[1]", INFLUENCES, MORPH, SKIN TURN, &asset),
                       PPM_STATUS_OK);
    /* (2 1 0) + (0 2 0), then a quarter turn about (1 0 0) */
    assert_near(vec3_load(only_primitive(f)->positions + 6), vec3(-2, 1, 4));
    ppmi_gltf_asset_close(asset);
}

/* ---- poses ----------------------------------------------------------------------------------- */

static void a_pose_keeps_the_mesh_and_returns(void **state)
{
    gltf_fixture *f = *state;
    ppmi_gltf_asset *asset;
    f->options.pose = gltf_at(0.3);
    assert_gltf_status(f,
                       open_rig(f, ",'skin':0", INFLUENCES ",'NORMAL':1", MORPH, SKIN TURN, &asset),
                       PPM_STATUS_OK);
    const uint64_t fresh = gltf_scene_hash(f->scene);
    ppm_pose when = gltf_between(0.5, 0.9);
    assert_int_equal(ppmi_gltf_asset_set_pose(asset, &when), PPM_STATUS_OK);
    assert_true(gltf_scene_hash(f->scene) != fresh);
    assert_int_equal(f->scene->mesh_count, 1);
    assert_int_equal(f->scene->instance_count, 1);
    assert_int_equal(ppmi_gltf_asset_set_pose(asset, &f->options.pose), PPM_STATUS_OK);
    assert_true(gltf_scene_hash(f->scene) == fresh);
    /* the same time once more touches nothing */
    const uint64_t version = f->scene->meshes[0].shape_version;
    assert_int_equal(ppmi_gltf_asset_set_pose(asset, &f->options.pose), PPM_STATUS_OK);
    assert_true(f->scene->meshes[0].shape_version == version);
    ppmi_gltf_asset_close(asset);
}

static void vertices_move_while_the_shutter_is_open(void **state)
{
    gltf_fixture *f = *state;
    ppmi_gltf_asset *asset;
    f->options.pose = gltf_between(0.0, 1.0);
    assert_gltf_status(f, open_rig(f, ",'skin':0", INFLUENCES, "", SKIN TURN, &asset),
                       PPM_STATUS_OK);
    const ppmi_primitive *p = only_primitive(f);
    assert_true(p->motion_steps > 4);
    for (uint32_t k = 0; k < p->motion_steps; ++k) {
        const double angle = 1.57079632679 * k / (p->motion_steps - 1);
        for (size_t i = 0; i < 4; ++i) {
            assert_near(vec3_load(p->positions + 3 * (4 * k + i)),
                        blended(angle, shares[i], rest_position(i)));
        }
    }
    ppmi_gltf_asset_close(asset);
}

static void only_meshes_that_keep_their_shape_are_shared(void **state)
{
    gltf_fixture *f = *state;
    ppmi_gltf_asset *asset;
    f->options.scene = "1"; /* nodes 0 and 4 have the mesh */
    assert_gltf_status(f, open_rig(f, "", "", MORPH, "", &asset), PPM_STATUS_OK);
    assert_int_equal(f->scene->mesh_count, 1);
    assert_int_equal(f->scene->instance_count, 2);
    ppmi_gltf_asset_close(asset);
    gltf_reset(f);
    assert_gltf_status(f, open_rig(f, ",'weights':[1]", "", MORPH, "", &asset), PPM_STATUS_OK);
    assert_int_equal(f->scene->mesh_count, 2);
    assert_int_equal(f->scene->instance_count, 2);
    ppmi_gltf_asset_close(asset);
}

static void every_allocation_may_fail(void **state)
{
    gltf_fixture *f = *state;
    ppm_status status = PPM_STATUS_OUT_OF_MEMORY;
    const ppm_pose later = gltf_between(0.5, 1.0);
    size_t n = 0;
    f->options.pose = gltf_between(0.0, 0.5);
    while (status == PPM_STATUS_OUT_OF_MEMORY) {
        ppmi_gltf_asset *asset;
        gltf_reset(f);
        ppmi_alloc_fail_at(f->context, ++n);
        status = open_rig(f, ",'skin':0", INFLUENCES ",'NORMAL':1,'TANGENT':2", MORPH, SKIN TURN,
                          &asset);
        if (status == PPM_STATUS_OK) status = ppmi_gltf_asset_set_pose(asset, &later);
        ppmi_alloc_fail_at(f->context, 0);
        ppmi_gltf_asset_close(asset);
        assert_true(n < 2000);
    }
    assert_gltf_status(f, status, PPM_STATUS_OK);
    assert_true(n > 80);
}

static ppm_status open_whole_rig(gltf_fixture *f, ppmi_gltf_asset **out_asset)
{
    return open_rig(f, ",'skin':0", INFLUENCES ",'NORMAL':1,'TANGENT':2", MORPH, SKIN TURN,
                    out_asset);
}

static void a_pose_that_failed_can_be_taken_again(void **state)
{
    gltf_fixture *f = *state;
    const ppm_pose later = gltf_between(0.5, 1.0);
    f->options.pose = gltf_between(0.0, 0.5);
    ppmi_gltf_asset *asset;
    assert_gltf_status(f, open_whole_rig(f, &asset), PPM_STATUS_OK);
    assert_gltf_status(f, ppmi_gltf_asset_set_pose(asset, &later), PPM_STATUS_OK);
    const uint64_t expected = gltf_scene_hash(f->scene);
    ppmi_gltf_asset_close(asset);
    ppm_status status = PPM_STATUS_OUT_OF_MEMORY;
    for (size_t n = 1; status == PPM_STATUS_OUT_OF_MEMORY; ++n) {
        gltf_reset(f);
        assert_gltf_status(f, open_whole_rig(f, &asset), PPM_STATUS_OK);
        ppmi_alloc_fail_at(f->context, n);
        status = ppmi_gltf_asset_set_pose(asset, &later);
        ppmi_alloc_fail_at(f->context, 0);
        assert_gltf_status(f, ppmi_gltf_asset_set_pose(asset, &later), PPM_STATUS_OK);
        assert_true(gltf_scene_hash(f->scene) == expected);
        ppmi_gltf_asset_close(asset);
        assert_true(n < 200);
    }
    assert_gltf_status(f, status, PPM_STATUS_OK);
}

#define TEST(name) cmocka_unit_test_setup_teardown(name, gltf_setup, gltf_teardown)

int main(void)
{
    const struct CMUnitTest tests[] = {
        TEST(broken_skins_are_refused),
        TEST(broken_targets_are_refused),
        TEST(joints_outside_of_the_scene_move_their_skin),
        TEST(vertices_follow_their_joints_and_not_the_node),
        TEST(normals_stay_perpendicular_to_the_surface),
        TEST(a_skin_without_matrices_has_identities),
        TEST(further_sets_of_joints_count_too),
        TEST(weights_are_brought_to_a_sum_of_one),
        TEST(a_mesh_without_joints_follows_its_node),
        TEST(a_mirrored_armature_turns_triangles_round),
        TEST(targets_are_added_by_their_weights),
        TEST(the_mesh_has_weights_for_nodes_without),
        TEST(weights_are_animated_by_node_and_by_pointer),
        TEST(targets_change_colours_and_texture_coordinates),
        TEST(targets_come_before_the_skin),
        TEST(a_pose_keeps_the_mesh_and_returns),
        TEST(vertices_move_while_the_shutter_is_open),
        TEST(only_meshes_that_keep_their_shape_are_shared),
        TEST(every_allocation_may_fail),
        TEST(a_pose_that_failed_can_be_taken_again),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
