/* importers/gltf/gltf_track.c, gltf_animation.c, gltf_pose.c: values against closed forms. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "gltf/gltf_animation.h"
#include "gltf_motion.h"

#define CLOSE(a, b) assert_float_equal((double)(a), (double)(b), 1e-5)

static ppmi_vec3 put(const gltf_fixture *f, float x, float y, float z)
{
    assert_int_equal(f->scene->instance_count, 1);
    return ppmi_transform_point(&f->scene->instances[0].to_world, vec3(x, y, z));
}

static void pose(ppmi_gltf_asset *asset, double time_s)
{
    const ppm_pose when = gltf_at(time_s);
    assert_int_equal(ppmi_gltf_asset_set_pose(asset, &when), PPM_STATUS_OK);
}

static void assert_x(gltf_fixture *f, ppmi_gltf_asset *asset, double time_s, double x)
{
    pose(asset, time_s);
    CLOSE(put(f, 0, 0, 0).x, x);
}

static const float ramp_times[2] = {1, 3}, ramp_values[6] = {0, 0, 0, 4, 0, 0};
static const gltf_keys ramp = {"LINEAR", "VEC3", ramp_times, 2, ramp_values, 2, 3};

/* ---- broken files ---------------------------------------------------------------------------- */

static void refuse(gltf_fixture *f, const gltf_keys *keys, const char *message)
{
    ppmi_gltf_asset *asset;
    f->options.pose = gltf_at(0.0);
    assert_gltf_status(f, gltf_open_channel(f, keys, "translation", "", &asset),
                       PPM_STATUS_INPUT_INVALID);
    assert_gltf_logged(f, 'E', message);
    gltf_reset(f);
    /* the same file without its animation is fine */
    f->options.pose = (ppm_pose){0};
    assert_gltf_status(f, gltf_open_channel(f, keys, "translation", "", &asset), PPM_STATUS_OK);
    ppmi_gltf_asset_close(asset);
    gltf_reset(f);
}

static void broken_keys_are_refused(void **state)
{
    gltf_fixture *f = *state;
    static const float back[2] = {3, 1}, nan_times[2] = {NAN, 1};
    static const float nan_values[6] = {0, 0, 0, 0, INFINITY, 0};
    gltf_keys keys = ramp;
    keys.times = back;
    refuse(f, &keys, "times must increase: key 1 is at 1 s, the one before at 3 s");
    keys.times = nan_times;
    refuse(f, &keys, "the time of key 0 is not a finite number");
    keys = ramp;
    keys.values = nan_values;
    refuse(f, &keys, "element 1 is not a finite number");
    keys = ramp;
    keys.value_count = 1;
    refuse(f, &keys, "1 elements, expected 2 for 2 keys");
    keys = ramp;
    keys.interpolation = "CUBICSPLINE";
    refuse(f, &keys, "2 elements, expected 6 for 2 keys");
    keys = ramp;
    keys.type = "SCALAR";
    refuse(f, &keys, "animations[0].samplers[0].output (accessors[2]): type: 1 components");
    keys = ramp;
    keys.interpolation = "BEZIER";
    refuse(f, &keys, "animations[0].samplers[0].interpolation: unknown value");
}

static void broken_references_are_refused(void **state)
{
    gltf_fixture *f = *state;
    static const struct {
        const char *channel, *message;
    } cases[] = {
        {"'sampler':1,'target':{'node':0,'path':'translation'}", "sampler 1 does not exist"},
        {"'sampler':0,'target':{'node':9,'path':'translation'}", "nodes[9] does not exist"},
        {"'sampler':0,'target':{'node':0}", "target.path: missing"},
        {"'sampler':0,'target':{'path':'pointer','extensions':{'KHR_animation_pointer':{"
         "'pointer':'/nodes/9/translation'}}}",
         "the pointer leads nowhere"},
    };
    for (size_t i = 0; i < sizeof cases / sizeof cases[0]; ++i) {
        ppmi_gltf_asset *asset;
        char middle[512];
        snprintf(middle, sizeof middle,
                 "'nodes':[{'mesh':0}],'animations':[{'channels':[{%s}],"
                 "'samplers':[{'input':1,'output':2}]}]",
                 cases[i].channel);
        f->options.pose = gltf_at(0.0);
        assert_gltf_status(f, gltf_open_keys(f, &ramp, middle, &asset), PPM_STATUS_INPUT_INVALID);
        assert_gltf_logged(f, 'E', cases[i].message);
        gltf_reset(f);
    }
}

static void an_unknown_animation_is_refused_with_the_nearest_name(void **state)
{
    gltf_fixture *f = *state;
    ppmi_gltf_asset *asset;
    f->options.animation = "B";
    assert_gltf_status(f, gltf_open_channel(f, &ramp, "translation", "", &asset),
                       PPM_STATUS_INVALID_ARGUMENT);
    assert_gltf_logged(f, 'E', "no animation 'B'; did you mean 'A'?; there are 1: 'A'");
}

static void targets_that_nothing_shows_are_left_out(void **state)
{
    gltf_fixture *f = *state;
    ppmi_gltf_asset *asset;
    f->options.pose = gltf_at(0.0);
    assert_gltf_status(f, gltf_open_channel(f, &ramp, "colour", "", &asset), PPM_STATUS_OK);
    assert_gltf_logged(f, 'W', "animations[0].channels[0]: left out");
    ppmi_gltf_asset_close(asset);
}

/* ---- interpolation --------------------------------------------------------------------------- */

static void linear_values_lie_between_keys_and_stay_outside_of_them(void **state)
{
    gltf_fixture *f = *state;
    ppmi_gltf_asset *asset;
    f->options.pose = gltf_at(1.5);
    assert_gltf_status(f, gltf_open_channel(f, &ramp, "translation", "", &asset), PPM_STATUS_OK);
    CLOSE(put(f, 0, 0, 0).x, 1.0);
    assert_x(f, asset, -7.0, 0.0);
    assert_x(f, asset, 1.0, 0.0);
    assert_x(f, asset, 2.75, 3.5);
    assert_x(f, asset, 3.0, 4.0);
    assert_x(f, asset, 1e9, 4.0);
    ppmi_gltf_asset_close(asset);
}

static void steps_hold_until_the_next_key(void **state)
{
    gltf_fixture *f = *state;
    ppmi_gltf_asset *asset;
    gltf_keys keys = ramp;
    keys.interpolation = "STEP";
    assert_gltf_status(f, gltf_open_channel(f, &keys, "translation", "", &asset), PPM_STATUS_OK);
    assert_x(f, asset, 0.0, 0.0);
    assert_x(f, asset, 2.999, 0.0);
    assert_x(f, asset, 3.0, 4.0);
    assert_x(f, asset, 5.0, 4.0);
    ppmi_gltf_asset_close(asset);
}

static void splines_follow_the_cubic_through_their_tangents(void **state)
{
    gltf_fixture *f = *state;
    /* x = t^3 - t: its values and slopes at -1 and 2 */
    static const float times[2] = {-1, 2};
    static const float values[18] = {99, 0, 0, 0, 0, 0, 2, 0, 0, 11, 0, 0, 6, 0, 0, 99, 0, 0};
    const gltf_keys keys = {"CUBICSPLINE", "VEC3", times, 2, values, 6, 3};
    ppmi_gltf_asset *asset;
    assert_gltf_status(f, gltf_open_channel(f, &keys, "translation", "", &asset), PPM_STATUS_OK);
    for (double t = -1.0; t <= 2.0; t += 0.25) {
        assert_x(f, asset, t, t * t * t - t);
    }
    assert_x(f, asset, -3.0, 0.0);
    assert_x(f, asset, 4.0, 6.0);
    ppmi_gltf_asset_close(asset);
}

static void rotations_turn_evenly_along_the_shorter_arc(void **state)
{
    gltf_fixture *f = *state;
    /* no turn, and the negative of a quarter turn about Z: the longer arc would be 270 degrees */
    static const float times[2] = {0, 1}, r = -0.70710678f;
    const float values[8] = {0, 0, 0, 1, 0, 0, r, r};
    const gltf_keys keys = {"LINEAR", "VEC4", times, 2, values, 2, 4};
    ppmi_gltf_asset *asset;
    assert_gltf_status(f, gltf_open_channel(f, &keys, "rotation", "", &asset), PPM_STATUS_OK);
    for (double t = 0.0; t <= 1.0; t += 0.125) {
        pose(asset, t);
        CLOSE(put(f, 1, 0, 0).x, cos(t * 1.57079633));
        CLOSE(put(f, 1, 0, 0).y, sin(t * 1.57079633));
    }
    ppmi_gltf_asset_close(asset);
}

static void splines_of_rotations_keep_unit_length(void **state)
{
    gltf_fixture *f = *state;
    static const float times[2] = {0, 1};
    static const float values[24] = {0, 0, 0, 0, 0, 0, 0, 1, 0, 3, 0, 0,
                                     2, 0, 0, 0, 0, 0, 1, 0, 0, 0, 0, 0};
    const gltf_keys keys = {"CUBICSPLINE", "VEC4", times, 2, values, 6, 4};
    ppmi_gltf_asset *asset;
    assert_gltf_status(f, gltf_open_channel(f, &keys, "rotation", "", &asset), PPM_STATUS_OK);
    pose(asset, 0.5);
    const ppmi_transform *m = &f->scene->instances[0].to_world;
    CLOSE(vec3_length(m->x), 1.0);
    CLOSE(ppmi_transform_determinant(m), 1.0);
    /* halfway: 0.5 a + 0.5 b + (tangents) / 8 = (-0.25, 0.375, 0.5, 0.5), normalised */
    const double q[4] = {-0.25, 0.375, 0.5, 0.5};
    const double n = q[0] * q[0] + q[1] * q[1] + q[2] * q[2] + q[3] * q[3];
    CLOSE(m->x.x, 1.0 - 2.0 * (q[1] * q[1] + q[2] * q[2]) / n);
    CLOSE(m->x.y, 2.0 * (q[0] * q[1] + q[2] * q[3]) / n);
    ppmi_gltf_asset_close(asset);
}

static void keys_at_the_same_time_are_a_jump(void **state)
{
    gltf_fixture *f = *state;
    static const float times[4] = {0, 1, 1, 2};
    static const float values[12] = {0, 0, 0, 1, 0, 0, 5, 0, 0, 7, 0, 0};
    const gltf_keys keys = {"LINEAR", "VEC3", times, 4, values, 4, 3};
    ppmi_gltf_asset *asset;
    assert_gltf_status(f, gltf_open_channel(f, &keys, "translation", "", &asset), PPM_STATUS_OK);
    assert_x(f, asset, 0.5, 0.5);
    assert_x(f, asset, 1.0, 5.0);
    assert_x(f, asset, 1.5, 6.0);
    ppmi_gltf_asset_close(asset);
}

static void normalised_integers_are_values(void **state)
{
    gltf_fixture *f = *state;
    static const struct {
        float position[9], times[2];
        int16_t rotations[8];
        int8_t bytes[8];
    } data = {{0, 0, 0, 1, 0, 0, 0, 1, 0},
              {0, 1},
              {0, 0, 0, 32767, 0, 0, 23170, 23170},
              {0, 0, 0, 127, 0, 0, 90, 90}};
    static const int types[2] = {5122, 5120};
    for (int i = 0; i < 2; ++i) {
        ppmi_gltf_asset *asset;
        char text[2048];
        snprintf(text, sizeof text,
                 "{" GLTF_HEAD "'nodes':[{'mesh':0}],"
                 "'meshes':[{'primitives':[{'attributes':{'POSITION':0}}]}],"
                 "'animations':[{'channels':[{'sampler':0,'target':{'node':0,"
                 "'path':'rotation'}}],'samplers':[{'input':1,'output':2}]}],"
                 "'accessors':[{'bufferView':0,'componentType':5126,'count':3,'type':'VEC3'},"
                 "{'bufferView':0,'byteOffset':36,'componentType':5126,'count':2,"
                 "'type':'SCALAR'},{'bufferView':0,'byteOffset':%d,'componentType':%d,"
                 "'normalized':true,'count':2,'type':'VEC4'}],"
                 "'bufferViews':[{'buffer':0,'byteLength':%zu}],"
                 "'buffers':[{'byteLength':%zu,'uri':'%s'}]}",
                 i == 0 ? 44 : 60, types[i], sizeof data, sizeof data,
                 gltf_data_uri(&data, sizeof data));
        assert_gltf_status(f, gltf_open_text(f, text, &asset), PPM_STATUS_OK);
        pose(asset, 0.5);
        CLOSE(put(f, 1, 0, 0).y, sqrt(0.5));
        ppmi_gltf_asset_close(asset);
        gltf_reset(f);
    }
}

/* ---- what is moved --------------------------------------------------------------------------- */

static void nodes_given_as_matrices_can_be_moved(void **state)
{
    gltf_fixture *f = *state;
    ppmi_gltf_asset *asset;
    /* a quarter turn about Z, three times as large, at (5 6 7) */
    assert_gltf_status(f,
                       gltf_open_channel(f, &ramp, "translation",
                                         "'matrix':[0,3,0,0,-3,0,0,0,0,0,3,0,5,6,7,1],", &asset),
                       PPM_STATUS_OK);
    CLOSE(put(f, 1, 0, 0).y, 9.0);
    pose(asset, 2.0);
    CLOSE(put(f, 1, 0, 0).x, 2.0);
    CLOSE(put(f, 1, 0, 0).y, 3.0);
    const ppm_pose still = {0};
    assert_int_equal(ppmi_gltf_asset_set_pose(asset, &still), PPM_STATUS_OK);
    CLOSE(put(f, 1, 0, 0).x, 5.0);
    CLOSE(put(f, 1, 0, 0).y, 9.0);
    ppmi_gltf_asset_close(asset);
}

static void a_node_that_grows_from_nothing_appears(void **state)
{
    gltf_fixture *f = *state;
    static const float values[6] = {0, 0, 0, 2, 2, 2};
    gltf_keys keys = ramp;
    ppmi_gltf_asset *asset;
    keys.values = values;
    f->options.pose = gltf_at(0.0);
    assert_gltf_status(f, gltf_open_channel(f, &keys, "scale", "", &asset), PPM_STATUS_OK);
    assert_false(ppmi_instance_is_there(&f->scene->instances[0]));
    pose(asset, 2.0);
    assert_true(ppmi_instance_is_there(&f->scene->instances[0]));
    CLOSE(put(f, 1, 0, 0).x, 1.0);
    ppmi_gltf_asset_close(asset);
}

static void a_pose_does_not_depend_on_those_before_it(void **state)
{
    gltf_fixture *f = *state;
    ppmi_gltf_asset *asset;
    f->options.pose = gltf_between(1.3, 1.8);
    assert_gltf_status(f, gltf_open_channel(f, &ramp, "translation", "", &asset), PPM_STATUS_OK);
    const uint64_t fresh = gltf_scene_hash(f->scene);
    const ppm_pose still = {0};
    pose(asset, 2.5);
    assert_true(gltf_scene_hash(f->scene) != fresh);
    assert_int_equal(ppmi_gltf_asset_set_pose(asset, &still), PPM_STATUS_OK);
    assert_int_equal(ppmi_gltf_asset_set_pose(asset, &f->options.pose), PPM_STATUS_OK);
    assert_true(gltf_scene_hash(f->scene) == fresh);
    ppmi_gltf_asset_close(asset);
}

/* ---- motion ---------------------------------------------------------------------------------- */

static uint32_t steps_of_turn(gltf_fixture *f, double radians)
{
    /* about Z, within a second */
    const float times[3] = {0, 0.5f, 1};
    const float values[12] = {0,
                              0,
                              0,
                              1,
                              0,
                              0,
                              (float)sin(radians / 4),
                              (float)cos(radians / 4),
                              0,
                              0,
                              (float)sin(radians / 2),
                              (float)cos(radians / 2)};
    const gltf_keys keys = {"LINEAR", "VEC4", times, 3, values, 3, 4};
    ppmi_gltf_asset *asset;
    f->options.pose = gltf_between(0.0, 1.0);
    gltf_reset(f);
    assert_gltf_status(f, gltf_open_channel(f, &keys, "rotation", "", &asset), PPM_STATUS_OK);
    ppmi_gltf_asset_close(asset);
    return f->scene->instances[0].motion_steps;
}

static void a_turn_has_as_many_steps_as_its_angle_needs(void **state)
{
    gltf_fixture *f = *state;
    assert_int_equal(steps_of_turn(f, 0.0), 1);
    assert_int_equal(steps_of_turn(f, 0.1), 2);
    assert_true(steps_of_turn(f, 1.0) > 4);
    assert_true(steps_of_turn(f, 3.0) > steps_of_turn(f, 1.0));
    /* every step is a rotation, and lines between them shrink it by less than 1 % */
    steps_of_turn(f, 3.0);
    const ppmi_instance *i = &f->scene->instances[0];
    for (uint32_t k = 1; k < i->motion_steps; ++k) {
        CLOSE(vec3_length(i->motion[k].x), 1.0);
        const ppmi_vec3 middle = vec3_scale(vec3_add(i->motion[k - 1].x, i->motion[k].x), 0.5f);
        assert_true(vec3_length(middle) > 0.99f);
    }
}

static void a_straight_way_has_two_steps_and_rest_has_none(void **state)
{
    gltf_fixture *f = *state;
    ppmi_gltf_asset *asset;
    f->options.pose = gltf_between(1.0, 2.0);
    assert_gltf_status(f, gltf_open_channel(f, &ramp, "translation", "", &asset), PPM_STATUS_OK);
    const ppmi_instance *i = &f->scene->instances[0];
    assert_int_equal(i->motion_steps, 2);
    CLOSE(i->motion[0].origin.x, 0.0);
    CLOSE(i->motion[1].origin.x, 2.0);
    ppm_pose when = gltf_between(4.0, 5.0); /* after the last key */
    assert_int_equal(ppmi_gltf_asset_set_pose(asset, &when), PPM_STATUS_OK);
    assert_int_equal(i->motion_steps, 1);
    when = gltf_between(2.0, 4.0); /* stops halfway: a corner */
    assert_int_equal(ppmi_gltf_asset_set_pose(asset, &when), PPM_STATUS_OK);
    assert_int_equal(i->motion_steps, 3);
    when.motion_steps = 7; /* as asked for */
    assert_int_equal(ppmi_gltf_asset_set_pose(asset, &when), PPM_STATUS_OK);
    assert_int_equal(i->motion_steps, 7);
    CLOSE(i->motion[3].origin.x, 4.0);
    CLOSE(i->motion[2].origin.x, 2.0 + 4.0 / 3.0);
    ppmi_gltf_asset_close(asset);
}

/* ---- whole frames ---------------------------------------------------------------------------- */

enum { FRAME_KEYS = 40 };

/* Key k has the value k at frame first + k, as writers round its time: once, or as a product of
 * rounded numbers. */
static void assert_frames_have_their_keys(gltf_fixture *f, const char *interpolation, double fps,
                                          int first, bool is_product)
{
    float times[FRAME_KEYS], values[FRAME_KEYS * 9] = {0};
    const bool is_cubic = strcmp(interpolation, "CUBICSPLINE") == 0;
    ppmi_gltf_asset *asset;
    for (int k = 0; k < FRAME_KEYS; ++k) {
        times[k] =
            is_product ? (float)(first + k) * (float)(1.0 / fps) : (float)((first + k) / fps);
        values[is_cubic ? 9 * k + 3 : 3 * k] = (float)k;
    }
    const gltf_keys keys = {interpolation,
                            "VEC3",
                            times,
                            FRAME_KEYS,
                            values,
                            is_cubic ? 3 * FRAME_KEYS : FRAME_KEYS,
                            3};
    assert_gltf_status(f, gltf_open_channel(f, &keys, "translation", "", &asset), PPM_STATUS_OK);
    for (int k = 0; k < FRAME_KEYS; ++k) {
        pose(asset, (first + k) / fps);
        const float x = put(f, 0, 0, 0).x;
        if (x != (float)k) {
            fail_msg("%s at %g fps: frame %d is at %.9g, key at %d", interpolation, fps, first + k,
                     (double)x, k);
        }
    }
    ppmi_gltf_asset_close(asset);
    gltf_reset(f);
}

static void a_frame_on_a_key_has_its_value_to_the_bit(void **state)
{
    static const double rates[] = {23.976, 24000.0 / 1001.0,
                                   24.0,   25.0,
                                   29.97,  30000.0 / 1001.0,
                                   30.0,   48.0,
                                   59.94,  60.0,
                                   100.0,  120.0};
    static const char *const interpolations[] = {"STEP", "LINEAR", "CUBICSPLINE"};
    for (size_t i = 0; i < sizeof rates / sizeof rates[0]; ++i) {
        for (size_t k = 0; k < 3; ++k) {
            assert_frames_have_their_keys(*state, interpolations[k], rates[i], 0, false);
            assert_frames_have_their_keys(*state, interpolations[k], rates[i], 1001, k == 1);
        }
        assert_frames_have_their_keys(*state, "STEP", rates[i], 100000, i % 2 == 1);
    }
}

static void half_a_frame_before_its_key_a_step_has_not_come(void **state)
{
    gltf_fixture *f = *state;
    static const float times[2] = {0, (float)(23 / 24.0)}, values[6] = {0, 0, 0, 4, 0, 0};
    static const gltf_keys keys = {"STEP", "VEC3", times, 2, values, 2, 3};
    ppmi_gltf_asset *asset;
    assert_gltf_status(f, gltf_open_channel(f, &keys, "translation", "", &asset), PPM_STATUS_OK);
    assert_x(f, asset, 22.5 / 24.0, 0.0);
    assert_x(f, asset, 22.999 / 24.0, 0.0);
    assert_x(f, asset, 23.0 / 24.0, 4.0);
    ppmi_gltf_asset_close(asset);
}

/* KHR_accessor_float64: in single precision the keys are at most half a metre apart here. */
static void keys_in_doubles_are_interpolated_in_doubles(void **state)
{
    gltf_fixture *f = *state;
    static const struct {
        double times[2], places[2][3];
        float triangle[9];
    } data = {{0.0, 1.0},
              {{4202123.0625, 171456.0, 4780333.5}, {4202123.3125, 171456.25, 4780333.5}},
              {0, 0, 0, 1, 0, 0, 0, 1, 0}};
    ppmi_gltf_asset *asset = NULL;
    char json[4096];
    snprintf(json, sizeof json,
             "{" GLTF_HEAD "'extensionsRequired':['KHR_accessor_float64'],"
             "'nodes':[{'mesh':0,'translation':[4202123,171456,4780333]}],"
             "'meshes':[{'primitives':[{'attributes':{'POSITION':2}}]}],"
             "'animations':[{'samplers':[{'input':0,'output':1}],'channels':[{'sampler':0,"
             "'target':{'node':0,'path':'translation'}}]}],"
             "'accessors':[{'bufferView':0,'componentType':5130,'count':2,'type':'SCALAR'},"
             "{'bufferView':1,'componentType':5130,'count':2,'type':'VEC3'},"
             "{'bufferView':2,'componentType':5126,'count':3,'type':'VEC3'}],"
             "'bufferViews':[{'buffer':0,'byteLength':16},"
             "{'buffer':0,'byteOffset':16,'byteLength':48},"
             "{'buffer':0,'byteOffset':64,'byteLength':36}],"
             "'buffers':[{'byteLength':%zu,'uri':'%s'}]}",
             sizeof data, gltf_data_uri(&data, sizeof data));
    f->options.pose = gltf_at(0.25);
    assert_gltf_status(f, gltf_open_text(f, json, &asset), PPM_STATUS_OK);
    double origin[3];
    ppm_scene_get_origin(f->scene, origin);
    const ppmi_vec3 at = f->scene->instances[0].to_world.origin;
    CLOSE(origin[0] - 4202123.0 + (double)at.x, 0.125);
    CLOSE(origin[1] - 171456.0 + (double)at.y, 0.0625);
    CLOSE(origin[2] - 4780333.0 + (double)at.z, 0.5);
    ppmi_gltf_asset_close(asset);
}

/* ---- many channels --------------------------------------------------------------------------- */

/* A chain of text that grows. */
typedef struct text {
    char *at;
    size_t length, room;
} text;

static void add(text *t, const char *format, ...)
{
    va_list arguments;
    if (t->room - t->length < 256) {
        t->room = 2 * t->room + 1024;
        t->at = realloc(t->at, t->room);
        assert_non_null(t->at);
    }
    va_start(arguments, format);
    t->length += (size_t)vsnprintf(t->at + t->length, t->room - t->length, format, arguments);
    va_end(arguments);
}

/* nodes nodes with a triangle each, of a mesh of their own, whose place, rotation and size move,
 * and by pointer the weights of their meshes. */
static void write_many(text *t, uint32_t nodes)
{
    static const char *const paths[] = {"translation", "rotation", "scale"};
    static const float data[] = {0, 1, 0, 0, 0, 1, 1, 1, 0, 0, 0, 1, 0, 0, 0, 1, 0, 1};
    add(t, "{'asset':{'version':'2.0'},'extensionsUsed':['KHR_animation_pointer'],'nodes':[");
    for (uint32_t i = 0; i < nodes; ++i)
        add(t, "%s{'mesh':%u}", i ? "," : "", i);
    add(t, "],'meshes':[");
    for (uint32_t i = 0; i < nodes; ++i)
        add(t,
            "%s{'primitives':[{'attributes':{'POSITION':0},'targets':[{'POSITION':0}]}],'weights':["
            "0]}",
            i ? "," : "");
    add(t, "],'animations':[{'samplers':[{'input':1,'output':2},{'input':1,'output':3},"
           "{'input':1,'output':1}],'channels':[");
    for (uint32_t i = 0; i < nodes; ++i) {
        for (int k = 0; k < 3; ++k)
            add(t, "{'sampler':%d,'target':{'node':%u,'path':'%s'}},", k == 1, i, paths[k]);
        add(t,
            "{'sampler':2,'target':{'path':'pointer','extensions':{'KHR_animation_pointer':"
            "{'pointer':'/meshes/%u/weights'}}}}%s",
            i, i + 1 < nodes ? "," : "");
    }
    add(t,
        "]}],'accessors':[{'componentType':5126,'count':1,'type':'VEC3'},"
        "{'bufferView':0,'componentType':5126,'count':2,'type':'SCALAR'},"
        "{'bufferView':0,'byteOffset':8,'componentType':5126,'count':2,'type':'VEC3'},"
        "{'bufferView':0,'byteOffset':32,'componentType':5126,'count':2,'type':'VEC4'}],"
        "'bufferViews':[{'buffer':0,'byteLength':72}],"
        "'buffers':[{'byteLength':72,'uri':'%s'}]}",
        gltf_data_uri(data, sizeof data));
}

/* What is looked at for each channel while channels find their properties; no clock, which would
 * measure the machine. */
static double look_ups_per_channel(gltf_fixture *f, uint32_t nodes)
{
    text t = {0};
    ppmi_gltf_asset *asset = NULL;
    write_many(&t, nodes);
    f->options.pose = gltf_at(0.5);
    assert_gltf_status(f, gltf_open_text(f, t.at, &asset), PPM_STATUS_OK);
    const ppmi_gltf_animations *all = ppmi_gltf_asset_reader(asset)->animations;
    assert_int_equal(all->count, 4 * nodes);
    const double per_channel = (double)all->look_ups / (double)all->count;
    ppmi_gltf_asset_close(asset);
    gltf_reset(f);
    free(t.at);
    return per_channel;
}

/* A list that is gone through for each channel has half as many look-ups as there are channels. */
static void finding_what_channels_change_is_linear_work(void **state)
{
    gltf_fixture *f = *state;
    for (uint32_t nodes = 500; nodes <= 8000; nodes *= 4) {
        const double per_channel = look_ups_per_channel(f, nodes);
        if (!(per_channel < 10.0)) fail_msg("%u nodes: %g for each channel", nodes, per_channel);
    }
}

#define TEST(name) cmocka_unit_test_setup_teardown(name, gltf_setup, gltf_teardown)

int main(void)
{
    const struct CMUnitTest tests[] = {
        TEST(finding_what_channels_change_is_linear_work),
        TEST(keys_in_doubles_are_interpolated_in_doubles),
        TEST(broken_keys_are_refused),
        TEST(broken_references_are_refused),
        TEST(an_unknown_animation_is_refused_with_the_nearest_name),
        TEST(targets_that_nothing_shows_are_left_out),
        TEST(linear_values_lie_between_keys_and_stay_outside_of_them),
        TEST(steps_hold_until_the_next_key),
        TEST(splines_follow_the_cubic_through_their_tangents),
        TEST(a_frame_on_a_key_has_its_value_to_the_bit),
        TEST(half_a_frame_before_its_key_a_step_has_not_come),
        TEST(rotations_turn_evenly_along_the_shorter_arc),
        TEST(splines_of_rotations_keep_unit_length),
        TEST(keys_at_the_same_time_are_a_jump),
        TEST(normalised_integers_are_values),
        TEST(nodes_given_as_matrices_can_be_moved),
        TEST(a_node_that_grows_from_nothing_appears),
        TEST(a_pose_does_not_depend_on_those_before_it),
        TEST(a_turn_has_as_many_steps_as_its_angle_needs),
        TEST(a_straight_way_has_two_steps_and_rest_has_none),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
