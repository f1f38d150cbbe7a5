/* The acceleration structure, on Embree 3.13 or 4. */
#include <stdio.h>

#include "accel/accel.h"
#include "scene/scene.h"

#if __has_include(<embree4/rtcore.h>)
#include <embree4/rtcore.h>
#else
#include <embree3/rtcore.h>
#endif

struct ppmi_accel {
    ppm_context *context;
    RTCDevice device;
    RTCScene *meshes; /* one per mesh; NULL for a mesh without triangles */
    uint32_t mesh_count;
    RTCScene top;
};

#define PPMI_STRINGIZE_(x) #x
#define PPMI_STRINGIZE(x) PPMI_STRINGIZE_(x)

const char *ppmi_accel_version(void)
{
    return "Embree " PPMI_STRINGIZE(RTC_VERSION_MAJOR) "." PPMI_STRINGIZE(
        RTC_VERSION_MINOR) "." PPMI_STRINGIZE(RTC_VERSION_PATCH);
}

static void on_error(void *user, enum RTCError code, const char *text)
{
    const ppmi_accel *accel = user;
    ppmi_log(accel->context, PPM_LOG_DEBUG, "Embree: error %d: %s", (int)code, text ? text : "");
}

static ppm_status check_device(ppmi_accel *accel, const char *step)
{
    switch (rtcGetDeviceError(accel->device)) {
    case RTC_ERROR_NONE:
        return PPM_STATUS_OK;
    case RTC_ERROR_OUT_OF_MEMORY:
        return ppmi_fail(accel->context, PPM_STATUS_OUT_OF_MEMORY, "out of memory: %s", step);
    default:
        return ppmi_fail(accel->context, PPM_STATUS_INTERNAL, "Embree failed: %s", step);
    }
}

/* Shares the scene's arrays with Embree: nothing is copied. */
static void attach_primitive(ppmi_accel *accel, RTCScene mesh_scene, unsigned id,
                             const ppmi_primitive *primitive)
{
    RTCGeometry geometry = rtcNewGeometry(accel->device, RTC_GEOMETRY_TYPE_TRIANGLE);
    rtcSetSharedGeometryBuffer(geometry, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3,
                               primitive->positions, 0, 3 * sizeof(float), primitive->vertex_count);
    rtcSetSharedGeometryBuffer(geometry, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3,
                               primitive->indices, 0, 3 * sizeof(uint32_t),
                               primitive->triangle_count);
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
static RTCScene new_scene(ppmi_accel *accel)
{
    RTCScene scene = rtcNewScene(accel->device);
    rtcSetSceneFlags(scene, RTC_SCENE_FLAG_ROBUST | FILTER_FLAG);
    rtcSetSceneBuildQuality(scene, RTC_BUILD_QUALITY_MEDIUM);
    return scene;
}

static void build_mesh(ppmi_accel *accel, const ppmi_mesh *mesh, uint32_t index)
{
    bool has_triangles = false;
    for (uint32_t i = 0; i < mesh->primitive_count; i++) {
        has_triangles = has_triangles || mesh->primitives[i].triangle_count > 0;
    }
    if (!has_triangles) return;
    accel->meshes[index] = new_scene(accel);
    for (uint32_t i = 0; i < mesh->primitive_count; i++) {
        if (mesh->primitives[i].triangle_count > 0) {
            attach_primitive(accel, accel->meshes[index], i, &mesh->primitives[i]);
        }
    }
    rtcCommitScene(accel->meshes[index]);
}

static void attach_instance(ppmi_accel *accel, const ppmi_instance *instance, uint32_t index)
{
    if (!accel->meshes[instance->mesh] || !ppmi_instance_is_there(instance)) return;
    const ppmi_transform *m = &instance->to_world;
    const float columns[12] = {m->x.x, m->x.y, m->x.z, m->y.x,      m->y.y,      m->y.z,
                               m->z.x, m->z.y, m->z.z, m->origin.x, m->origin.y, m->origin.z};
    RTCGeometry geometry = rtcNewGeometry(accel->device, RTC_GEOMETRY_TYPE_INSTANCE);
    rtcSetGeometryInstancedScene(geometry, accel->meshes[instance->mesh]);
    rtcSetGeometryTimeStepCount(geometry, 1);
    rtcSetGeometryTransform(geometry, 0, RTC_FORMAT_FLOAT3X4_COLUMN_MAJOR, columns);
    rtcCommitGeometry(geometry);
    rtcAttachGeometryByID(accel->top, geometry, index);
    rtcReleaseGeometry(geometry);
}

static ppm_status build(ppmi_accel *accel, const ppm_scene *scene)
{
    for (uint32_t i = 0; i < scene->mesh_count; i++) {
        build_mesh(accel, &scene->meshes[i], i);
        const ppm_status status =
            check_device(accel, "building the acceleration structure of a mesh");
        if (status != PPM_STATUS_OK) return status;
    }
    accel->top = new_scene(accel);
    for (uint32_t i = 0; i < scene->instance_count; i++) {
        attach_instance(accel, &scene->instances[i], i);
    }
    rtcCommitScene(accel->top);
    return check_device(accel, "building the acceleration structure of the instances");
}

ppm_status ppmi_accel_create(ppm_context *context, const ppm_scene *scene, ppmi_accel **out_accel)
{
    ppmi_accel *accel = ppmi_alloc_zeroed(context, 1, sizeof *accel);
    if (!accel) return ppmi_fail(context, PPM_STATUS_OUT_OF_MEMORY, "out of memory: ray tracing");
    accel->context = context;
    accel->mesh_count = scene->mesh_count;
    accel->meshes = ppmi_alloc_zeroed(context, scene->mesh_count, sizeof *accel->meshes);
    ppm_status status = PPM_STATUS_OK;
    if (scene->mesh_count > 0 && !accel->meshes) {
        status = ppmi_fail(context, PPM_STATUS_OUT_OF_MEMORY, "out of memory: ray tracing");
    }
    if (status == PPM_STATUS_OK) {
        accel->device = rtcNewDevice(NULL);
        if (accel->device) {
            rtcSetDeviceErrorFunction(accel->device, on_error, accel);
            status = build(accel, scene);
        } else {
            status = ppmi_fail(context, PPM_STATUS_INTERNAL, "Embree does not start (error %d)",
                               (int)rtcGetDeviceError(NULL));
        }
    }
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
    if (accel->top) rtcReleaseScene(accel->top);
    for (uint32_t i = 0; accel->meshes && i < accel->mesh_count; i++) {
        if (accel->meshes[i]) rtcReleaseScene(accel->meshes[i]);
    }
    if (accel->device) rtcReleaseDevice(accel->device);
    ppmi_free(accel->context, accel->meshes);
    ppmi_free(accel->context, accel);
}

static struct RTCRay embree_ray(const ppmi_ray *ray)
{
    return (struct RTCRay){
        .org_x = ray->origin.x,
        .org_y = ray->origin.y,
        .org_z = ray->origin.z,
        .dir_x = ray->direction.x,
        .dir_y = ray->direction.y,
        .dir_z = ray->direction.z,
        .tfar = ray->t_max,
        .time = ray->time,
        .mask = ~0u,
    };
}

bool ppmi_accel_intersect(const ppmi_accel *accel, const ppmi_ray *ray, ppmi_hit *out_hit)
{
    struct RTCRayHit query;
    query.ray = embree_ray(ray);
    query.hit.geomID = RTC_INVALID_GEOMETRY_ID;
    query.hit.instID[0] = RTC_INVALID_GEOMETRY_ID;
#if RTC_VERSION_MAJOR >= 4
    rtcIntersect1(accel->top, &query, NULL);
#else
    struct RTCIntersectContext context;
    rtcInitIntersectContext(&context);
    rtcIntersect1(accel->top, &context, &query);
#endif
    if (query.hit.geomID == RTC_INVALID_GEOMETRY_ID) return false;
    *out_hit = (ppmi_hit){
        .instance = query.hit.instID[0],
        .primitive = query.hit.geomID,
        .triangle = query.hit.primID,
        .u = query.hit.u,
        .v = query.hit.v,
        .t = query.ray.tfar,
    };
    return true;
}

/* ---- all hits -------------------------------------------------------------------------------- */

/* Embree's own context, and behind it ours: a filter is given the former. */
typedef struct collection {
#if RTC_VERSION_MAJOR >= 4
    struct RTCRayQueryContext context;
#else
    struct RTCIntersectContext context;
#endif
    ppmi_hit *hits;
    uint32_t count, max;
} collection;

/* Notes a hit in its place by distance, and lets the ray go on. Of single rays the packets of N are
 * plain structs. */
static void collect(const struct RTCFilterFunctionNArguments *arguments)
{
    collection *all = (collection *)arguments->context;
    const struct RTCRay *ray = (const struct RTCRay *)arguments->ray;
    const struct RTCHit *found = (const struct RTCHit *)arguments->hit;
    arguments->valid[0] = 0;
    if (all->count == all->max) return;
    const ppmi_hit hit = {
        .instance = found->instID[0],
        .primitive = found->geomID,
        .triangle = found->primID,
        .u = found->u,
        .v = found->v,
        .t = ray->tfar,
    };
    uint32_t place = all->count++;
    for (; place > 0 && all->hits[place - 1].t > hit.t; place--)
        all->hits[place] = all->hits[place - 1];
    all->hits[place] = hit;
}

uint32_t ppmi_accel_intersect_all(const ppmi_accel *accel, const ppmi_ray *ray, ppmi_hit *out_hits,
                                  uint32_t max)
{
    struct RTCRayHit query;
    query.ray = embree_ray(ray);
    query.hit.geomID = RTC_INVALID_GEOMETRY_ID;
    query.hit.instID[0] = RTC_INVALID_GEOMETRY_ID;
    collection all = {.hits = out_hits, .max = max};
#if RTC_VERSION_MAJOR >= 4
    rtcInitRayQueryContext(&all.context);
    struct RTCIntersectArguments arguments;
    rtcInitIntersectArguments(&arguments);
    arguments.flags = RTC_RAY_QUERY_FLAG_INVOKE_ARGUMENT_FILTER;
    arguments.context = &all.context;
    arguments.filter = collect;
    rtcIntersect1(accel->top, &query, &arguments);
#else
    rtcInitIntersectContext(&all.context);
    all.context.filter = collect;
    rtcIntersect1(accel->top, &all.context, &query);
#endif
    return all.count;
}

bool ppmi_accel_occluded(const ppmi_accel *accel, const ppmi_ray *ray)
{
    struct RTCRay query = embree_ray(ray);
#if RTC_VERSION_MAJOR >= 4
    rtcOccluded1(accel->top, &query, NULL);
#else
    struct RTCIntersectContext context;
    rtcInitIntersectContext(&context);
    rtcOccluded1(accel->top, &context, &query);
#endif
    return query.tfar < 0.0f;
}
