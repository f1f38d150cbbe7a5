/* Building the acceleration structure: one Embree scene per mesh, which stays with the scene from
 * session to session, and one above them for the instances of a session.
 *
 * A mesh whose vertices have changed is built anew and not refitted: refitted trees are slower to
 * trace, and a render traces them for far longer than building takes. */
#include <string.h>

#include "accel/embree.h"

/* Meshes with fewer elements are built side by side, a thread each; in larger ones Embree's own
 * threads have work enough. */
enum { SMALL_MESH = 32768 };

typedef struct built_mesh {
    RTCScene scene;   /* NULL: nothing to hit */
    uint64_t version; /* ppmi_mesh.shape_version; 0: not built */
} built_mesh;

/* Kept with the scene. */
typedef struct accel_cache {
    ppm_context *context;
    RTCDevice device;
    built_mesh *meshes;
    uint32_t mesh_count;
    uint64_t builds;
} accel_cache;

/* ---- the cache ------------------------------------------------------------------------------- */

static void on_error(void *user, enum RTCError code, const char *text)
{
    const accel_cache *cache = user;
    ppmi_log(cache->context, PPM_LOG_DEBUG, "Embree: error %d: %s", (int)code, text ? text : "");
}

static ppm_status check_device(const accel_cache *cache, const char *step)
{
    switch (rtcGetDeviceError(cache->device)) {
    case RTC_ERROR_NONE:
        return PPM_STATUS_OK;
    case RTC_ERROR_OUT_OF_MEMORY:
        return ppmi_fail(cache->context, PPM_STATUS_OUT_OF_MEMORY, "out of memory: %s", step);
    default:
        return ppmi_fail(cache->context, PPM_STATUS_INTERNAL, "Embree failed: %s", step);
    }
}

static void cache_destroy(void *data)
{
    accel_cache *cache = data;
    for (uint32_t i = 0; i < cache->mesh_count; i++) {
        if (cache->meshes[i].scene) rtcReleaseScene(cache->meshes[i].scene);
    }
    if (cache->device) rtcReleaseDevice(cache->device);
    ppmi_free(cache->context, cache->meshes);
    ppmi_free(cache->context, cache);
}

static ppm_status open_cache(ppm_scene *scene, accel_cache **out_cache)
{
    ppm_context *context = scene->context;
    *out_cache = scene->accel.data;
    if (*out_cache) return PPM_STATUS_OK;
    accel_cache *cache = ppmi_alloc_zeroed(context, 1, sizeof *cache);
    if (!cache) return ppmi_fail(context, PPM_STATUS_OUT_OF_MEMORY, "out of memory: ray tracing");
    cache->context = context;
    cache->device = rtcNewDevice(NULL);
    if (!cache->device) {
        cache_destroy(cache);
        return ppmi_fail(context, PPM_STATUS_INTERNAL, "Embree does not start (error %d)",
                         (int)rtcGetDeviceError(NULL));
    }
    rtcSetDeviceErrorFunction(cache->device, on_error, cache);
    scene->accel = (ppmi_kept){.data = cache, .destroy = cache_destroy};
    *out_cache = cache;
    return PPM_STATUS_OK;
}

static ppm_status make_room(accel_cache *cache, uint32_t mesh_count)
{
    if (mesh_count <= cache->mesh_count) return PPM_STATUS_OK;
    built_mesh *larger = ppmi_alloc_zeroed(cache->context, mesh_count, sizeof *larger);
    if (!larger) {
        return ppmi_fail(cache->context, PPM_STATUS_OUT_OF_MEMORY, "out of memory: ray tracing");
    }
    if (cache->mesh_count > 0) {
        memcpy(larger, cache->meshes, cache->mesh_count * sizeof *larger);
    }
    ppmi_free(cache->context, cache->meshes);
    cache->meshes = larger;
    cache->mesh_count = mesh_count;
    return PPM_STATUS_OK;
}

uint64_t ppmi_accel_builds(const ppm_scene *scene)
{
    const accel_cache *cache = scene->accel.data;
    return cache ? cache->builds : 0;
}

/* ---- geometries ------------------------------------------------------------------------------ */

static const float *positions_at(const ppmi_primitive *primitive, uint32_t step)
{
    return primitive->positions + 3 * (size_t)step * primitive->vertex_count;
}

/* Shares the scene's arrays with Embree: nothing is copied. */
static RTCGeometry triangles(RTCDevice device, const ppmi_primitive *primitive)
{
    RTCGeometry geometry = rtcNewGeometry(device, RTC_GEOMETRY_TYPE_TRIANGLE);
    rtcSetGeometryTimeStepCount(geometry, primitive->motion_steps);
    for (uint32_t step = 0; step < primitive->motion_steps; step++) {
        rtcSetSharedGeometryBuffer(geometry, RTC_BUFFER_TYPE_VERTEX, step, RTC_FORMAT_FLOAT3,
                                   positions_at(primitive, step), 0, 3 * sizeof(float),
                                   primitive->vertex_count);
    }
    rtcSetSharedGeometryBuffer(geometry, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3,
                               primitive->indices, 0, 3 * sizeof(uint32_t),
                               primitive->triangle_count);
    return geometry;
}

/* Positions with the radius, as Embree wants them: one for a point, two for a line. */
static void fill_round(RTCGeometry geometry, const ppmi_primitive *primitive, uint32_t ends)
{
    const size_t count = (size_t)ends * primitive->element_count;
    for (uint32_t step = 0; step < primitive->motion_steps; step++) {
        float *vertices = rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_VERTEX, step,
                                                  RTC_FORMAT_FLOAT4, 4 * sizeof(float), count);
        if (!vertices) return; /* the device holds the error */
        const float *positions = positions_at(primitive, step);
        for (size_t i = 0; i < count; i++) {
            memcpy(vertices + 4 * i, positions + 3 * (size_t)primitive->indices[i],
                   3 * sizeof *vertices);
            vertices[4 * i + 3] = primitive->radius_m;
        }
    }
}

static RTCGeometry points(RTCDevice device, const ppmi_primitive *primitive)
{
    RTCGeometry geometry = rtcNewGeometry(device, RTC_GEOMETRY_TYPE_SPHERE_POINT);
    rtcSetGeometryTimeStepCount(geometry, primitive->motion_steps);
    fill_round(geometry, primitive, 1);
    return geometry;
}

static RTCGeometry lines(RTCDevice device, const ppmi_primitive *primitive)
{
    RTCGeometry geometry = rtcNewGeometry(device, RTC_GEOMETRY_TYPE_ROUND_LINEAR_CURVE);
    rtcSetGeometryTimeStepCount(geometry, primitive->motion_steps);
    fill_round(geometry, primitive, 2);
    uint32_t *first = rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT,
                                              sizeof *first, primitive->element_count);
    for (uint32_t i = 0; first && i < primitive->element_count; i++)
        first[i] = 2 * i;
    return geometry;
}

static void attach_primitive(RTCDevice device, RTCScene mesh_scene, unsigned id,
                             const ppmi_primitive *primitive)
{
    RTCGeometry geometry = primitive->kind == PPM_PRIMITIVE_POINTS  ? points(device, primitive)
                           : primitive->kind == PPM_PRIMITIVE_LINES ? lines(device, primitive)
                                                                    : triangles(device, primitive);
    rtcCommitGeometry(geometry);
    rtcAttachGeometryByID(mesh_scene, geometry, id);
    rtcReleaseGeometry(geometry);
}

#if RTC_VERSION_MAJOR >= 4
#define FILTER_FLAG RTC_SCENE_FLAG_FILTER_FUNCTION_IN_ARGUMENTS
#else
#define FILTER_FLAG RTC_SCENE_FLAG_CONTEXT_FILTER_FUNCTION
#endif

/* ROBUST: no ray slips through the edge between two triangles. */
static RTCScene new_scene(RTCDevice device)
{
    RTCScene scene = rtcNewScene(device);
    rtcSetSceneFlags(scene, RTC_SCENE_FLAG_ROBUST | FILTER_FLAG);
    rtcSetSceneBuildQuality(scene, RTC_BUILD_QUALITY_MEDIUM);
    return scene;
}

/* ---- meshes ---------------------------------------------------------------------------------- */

static uint64_t element_count(const ppmi_mesh *mesh)
{
    uint64_t count = 0;
    for (uint32_t i = 0; i < mesh->primitive_count; i++)
        count += mesh->primitives[i].element_count;
    return count;
}

/* Any thread; Embree's errors are the thread's own. Marks the mesh as built unless there is one. */
static void build_mesh(const accel_cache *cache, const ppmi_mesh *mesh, built_mesh *built)
{
    if (built->scene) rtcReleaseScene(built->scene);
    *built = (built_mesh){0};
    if (element_count(mesh) > 0) {
        built->scene = new_scene(cache->device);
        for (uint32_t i = 0; i < mesh->primitive_count; i++) {
            if (mesh->primitives[i].element_count > 0) {
                attach_primitive(cache->device, built->scene, i, &mesh->primitives[i]);
            }
        }
        rtcCommitScene(built->scene);
    }
    built->version = mesh->shape_version;
}

/* Marks the meshes that have to be built: seen by some instance, and new or changed. */
static ppm_status list_due(const accel_cache *cache, const ppm_scene *scene, uint32_t **out_due,
                           uint32_t *out_count)
{
    *out_count = 0;
    *out_due = ppmi_alloc(cache->context, scene->mesh_count + 1u, sizeof **out_due);
    bool *is_seen = ppmi_alloc_zeroed(cache->context, scene->mesh_count + 1u, sizeof *is_seen);
    if (!*out_due || !is_seen) {
        ppmi_free(cache->context, is_seen);
        return ppmi_fail(cache->context, PPM_STATUS_OUT_OF_MEMORY, "out of memory: ray tracing");
    }
    for (uint32_t i = 0; i < scene->instance_count; i++) {
        const ppmi_instance *instance = &scene->instances[i];
        if (ppmi_instance_is_there(instance)) is_seen[instance->mesh] = true;
    }
    for (uint32_t i = 0; i < scene->mesh_count; i++) {
        const bool is_due = cache->meshes[i].version != scene->meshes[i].shape_version;
        if (is_seen[i] && is_due) (*out_due)[(*out_count)++] = i;
    }
    ppmi_free(cache->context, is_seen);
    return PPM_STATUS_OK;
}

static ppm_status build_due(accel_cache *cache, const ppm_scene *scene, const uint32_t *due,
                            uint32_t count)
{
    const char *step = "building the acceleration structure of a mesh";
    ppm_status status = PPM_STATUS_OK;
#pragma omp parallel for schedule(dynamic, 1) if (count > 1)
    for (uint32_t i = 0; i < count; i++) {
        const ppmi_mesh *mesh = &scene->meshes[due[i]];
        if (element_count(mesh) >= SMALL_MESH) continue;
        build_mesh(cache, mesh, &cache->meshes[due[i]]);
        const ppm_status built = check_device(cache, step);
        if (built == PPM_STATUS_OK) continue;
        cache->meshes[due[i]].version = 0;
#pragma omp critical(ppmi_accel_build)
        status = built;
    }
    for (uint32_t i = 0; i < count && status == PPM_STATUS_OK; i++) {
        const ppmi_mesh *mesh = &scene->meshes[due[i]];
        if (element_count(mesh) < SMALL_MESH) continue;
        build_mesh(cache, mesh, &cache->meshes[due[i]]);
        status = check_device(cache, step);
        if (status != PPM_STATUS_OK) cache->meshes[due[i]].version = 0;
    }
    if (status == PPM_STATUS_OK) cache->builds += count;
    return status;
}

static ppm_status build_meshes(accel_cache *cache, const ppm_scene *scene)
{
    uint32_t *due = NULL, count;
    ppm_status status = make_room(cache, scene->mesh_count);
    if (status == PPM_STATUS_OK) status = list_due(cache, scene, &due, &count);
    if (status == PPM_STATUS_OK && count > 0) {
        status = build_due(cache, scene, due, count);
        ppmi_log(cache->context, PPM_LOG_DEBUG, "acceleration structures of %u of %u meshes built",
                 count, scene->mesh_count);
    }
    ppmi_free(cache->context, due);
    return status;
}

/* ---- instances ------------------------------------------------------------------------------- */

static void set_transform(RTCGeometry geometry, uint32_t step, const ppmi_transform *m)
{
    const float columns[12] = {m->x.x, m->x.y, m->x.z, m->y.x,      m->y.y,      m->y.z,
                               m->z.x, m->z.y, m->z.z, m->origin.x, m->origin.y, m->origin.z};
    rtcSetGeometryTransform(geometry, step, RTC_FORMAT_FLOAT3X4_COLUMN_MAJOR, columns);
}

static void attach_instance(const accel_cache *cache, RTCScene top, const ppmi_instance *instance,
                            uint32_t index)
{
    const RTCScene mesh = cache->meshes[instance->mesh].scene;
    if (!ppmi_instance_is_there(instance) || !mesh) return;
    RTCGeometry geometry = rtcNewGeometry(cache->device, RTC_GEOMETRY_TYPE_INSTANCE);
    rtcSetGeometryInstancedScene(geometry, mesh);
    rtcSetGeometryTimeStepCount(geometry, instance->motion_steps);
    for (uint32_t step = 0; step < instance->motion_steps; step++) {
        set_transform(geometry, step,
                      instance->motion ? &instance->motion[step] : &instance->to_world);
    }
    rtcCommitGeometry(geometry);
    rtcAttachGeometryByID(top, geometry, index);
    rtcReleaseGeometry(geometry);
}

static bool has_round(const ppm_scene *scene)
{
    for (uint32_t i = 0; i < scene->mesh_count; i++) {
        const ppmi_mesh *mesh = &scene->meshes[i];
        for (uint32_t k = 0; k < mesh->primitive_count; k++) {
            if (mesh->primitives[k].kind != PPM_PRIMITIVE_TRIANGLES) return true;
        }
    }
    return false;
}

/* Whether ppmi_accel_nearby shows something of it. */
static bool is_solid(const ppm_scene *scene, const ppmi_instance *instance)
{
    const ppmi_mesh *mesh = &scene->meshes[instance->mesh];
    for (uint32_t i = 0; i < mesh->primitive_count; i++) {
        const ppmi_primitive *primitive = &mesh->primitives[i];
        if (primitive->kind == PPM_PRIMITIVE_TRIANGLES &&
            !ppmi_accel_is_clear(&scene->materials[primitive->material])) {
            return true;
        }
    }
    return false;
}

static RTCScene build_top(const accel_cache *cache, const ppm_scene *scene, bool of_solids)
{
    const RTCScene top = new_scene(cache->device);
    for (uint32_t i = 0; i < scene->instance_count; i++) {
        const ppmi_instance *instance = &scene->instances[i];
        if (!of_solids || is_solid(scene, instance)) attach_instance(cache, top, instance, i);
    }
    rtcCommitScene(top);
    return top;
}

static ppm_status build(accel_cache *cache, const ppm_scene *scene, ppmi_accel *accel)
{
    const ppm_status status = build_meshes(cache, scene);
    if (status != PPM_STATUS_OK) return status;
    bool all_solid = true;
    for (uint32_t i = 0; i < scene->instance_count; i++)
        all_solid = all_solid && is_solid(scene, &scene->instances[i]);
    accel->top = build_top(cache, scene, false);
    accel->solid = all_solid ? accel->top : build_top(cache, scene, true);
    return check_device(cache, "building the acceleration structure of the instances");
}

ppm_status ppmi_accel_create(ppm_context *context, ppm_scene *scene, ppmi_accel **out_accel)
{
    accel_cache *cache;
    ppm_status status = open_cache(scene, &cache);
    if (status != PPM_STATUS_OK) return status;
    ppmi_accel *accel = ppmi_alloc_zeroed(context, 1, sizeof *accel);
    if (!accel) return ppmi_fail(context, PPM_STATUS_OUT_OF_MEMORY, "out of memory: ray tracing");
    accel->context = context;
    accel->scene = scene;
    accel->has_round = has_round(scene);
    status = build(cache, scene, accel);
    if (status != PPM_STATUS_OK) {
        ppmi_accel_destroy(accel);
        return status;
    }
    *out_accel = accel;
    return PPM_STATUS_OK;
}

void ppmi_accel_destroy(ppmi_accel *accel)
{
    if (!accel) return;
    if (accel->solid && accel->solid != accel->top) rtcReleaseScene(accel->solid);
    if (accel->top) rtcReleaseScene(accel->top);
    ppmi_free(accel->context, accel);
}
