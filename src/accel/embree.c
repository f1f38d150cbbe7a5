/* Rays through the acceleration structure, on Embree 3.13 or 4. */
#include "accel/embree.h"

#include "accel/round.h"

#define PPMI_STRINGIZE_(x) #x
#define PPMI_STRINGIZE(x) PPMI_STRINGIZE_(x)

const char *ppmi_accel_version(void)
{
    return "Embree " PPMI_STRINGIZE(RTC_VERSION_MAJOR) "." PPMI_STRINGIZE(
        RTC_VERSION_MINOR) "." PPMI_STRINGIZE(RTC_VERSION_PATCH);
}

/* Embree asserts that rays are within what it takes (FLT_LARGE, 1.8e18), in the world and where a
 * mesh was modelled. What ppmi_scene_freeze leaves keeps the latter; this the former, also for
 * directions of what overflowed on the way. */
static bool is_within_reach(const ppmi_ray *ray)
{
    const float most = 1e18f;
    return vec3_max_abs(ray->origin) < most && vec3_max_abs(ray->direction) < most &&
           ray->t_max >= 0.0f && vec3_is_finite(ray->origin) && vec3_is_finite(ray->direction);
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

/* Round elements are told from triangles by their geometry number: their places are by angles. */
static inline void load_hit(const ppmi_accel *accel, const struct RTCHit *found, float t,
                            float time, ppmi_hit *out_hit)
{
    *out_hit = (ppmi_hit){
        .instance = found->instID[0],
        .primitive = found->geomID,
        .triangle = found->primID,
        .u = found->u,
        .v = found->v,
        .t = t,
        .time = time,
    };
    if (accel->has_round) {
        const ppmi_vec3 normal = vec3(found->Ng_x, found->Ng_y, found->Ng_z);
        ppmi_round_place(accel->scene, normal, out_hit);
    }
}

bool ppmi_accel_intersect(const ppmi_accel *accel, const ppmi_ray *ray, ppmi_hit *out_hit)
{
    struct RTCRayHit query;
    if (!is_within_reach(ray)) return false;
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
    load_hit(accel, &query.hit, query.ray.tfar, ray->time, out_hit);
    return true;
}

/* ---- filtered hits --------------------------------------------------------------------------- */

#if RTC_VERSION_MAJOR >= 4
typedef struct RTCRayQueryContext query_context;
#else
typedef struct RTCIntersectContext query_context;
#endif

static void intersect_with(const ppmi_accel *accel, struct RTCRayHit *query, query_context *context,
                           RTCFilterFunctionN filter)
{
    query->hit.geomID = RTC_INVALID_GEOMETRY_ID;
    query->hit.instID[0] = RTC_INVALID_GEOMETRY_ID;
#if RTC_VERSION_MAJOR >= 4
    rtcInitRayQueryContext(context);
    struct RTCIntersectArguments arguments;
    rtcInitIntersectArguments(&arguments);
    arguments.flags = RTC_RAY_QUERY_FLAG_INVOKE_ARGUMENT_FILTER;
    arguments.context = context;
    arguments.filter = filter;
    rtcIntersect1(accel->top, query, &arguments);
#else
    rtcInitIntersectContext(context);
    context->filter = filter;
    rtcIntersect1(accel->top, context, query);
#endif
}

/* Embree's own context, and behind it ours: a filter is given the former. */
typedef struct filtered {
    query_context context;
    const ppmi_accel *accel;
    ppmi_hit_filter *filter;
} filtered;

/* Of single rays the packets of N are plain structs. */
static void ask(const struct RTCFilterFunctionNArguments *arguments)
{
    const filtered *query = (const filtered *)arguments->context;
    const struct RTCRay *ray = (const struct RTCRay *)arguments->ray;
    const struct RTCHit *found = (const struct RTCHit *)arguments->hit;
    ppmi_hit hit;
    load_hit(query->accel, found, ray->tfar, ray->time, &hit);
    if (query->filter->passes(query->filter, &hit)) arguments->valid[0] = 0;
}

bool ppmi_accel_intersect_filtered(const ppmi_accel *accel, const ppmi_ray *ray,
                                   ppmi_hit_filter *filter, ppmi_hit *out_hit)
{
    struct RTCRayHit query;
    if (!is_within_reach(ray)) return false;
    query.ray = embree_ray(ray);
    filtered with = {.accel = accel, .filter = filter};
    intersect_with(accel, &query, &with.context, ask);
    if (query.hit.geomID == RTC_INVALID_GEOMETRY_ID) return false;
    load_hit(accel, &query.hit, query.ray.tfar, ray->time, out_hit);
    return true;
}

bool ppmi_accel_occluded_filtered(const ppmi_accel *accel, const ppmi_ray *ray,
                                  ppmi_hit_filter *filter)
{
    if (!is_within_reach(ray)) return false;
    struct RTCRay query = embree_ray(ray);
    filtered with = {.accel = accel, .filter = filter};
#if RTC_VERSION_MAJOR >= 4
    rtcInitRayQueryContext(&with.context);
    struct RTCOccludedArguments arguments;
    rtcInitOccludedArguments(&arguments);
    arguments.flags = RTC_RAY_QUERY_FLAG_INVOKE_ARGUMENT_FILTER;
    arguments.context = &with.context;
    arguments.filter = ask;
    rtcOccluded1(accel->top, &query, &arguments);
#else
    rtcInitIntersectContext(&with.context);
    with.context.filter = ask;
    rtcOccluded1(accel->top, &with.context, &query);
#endif
    return query.tfar < 0.0f;
}

/* ---- all hits -------------------------------------------------------------------------------- */

typedef struct collection {
    query_context context;
    const ppmi_accel *accel;
    ppmi_hit *hits;
    uint32_t count, max;
} collection;

/* Notes a hit in its place by distance, and lets the ray go on. */
static void collect(const struct RTCFilterFunctionNArguments *arguments)
{
    collection *all = (collection *)arguments->context;
    const struct RTCRay *ray = (const struct RTCRay *)arguments->ray;
    const struct RTCHit *found = (const struct RTCHit *)arguments->hit;
    arguments->valid[0] = 0;
    if (all->count == all->max) return;
    ppmi_hit hit;
    load_hit(all->accel, found, ray->tfar, ray->time, &hit);
    uint32_t place = all->count++;
    for (; place > 0 && all->hits[place - 1].t > hit.t; place--)
        all->hits[place] = all->hits[place - 1];
    all->hits[place] = hit;
}

uint32_t ppmi_accel_intersect_all(const ppmi_accel *accel, const ppmi_ray *ray, ppmi_hit *out_hits,
                                  uint32_t max)
{
    struct RTCRayHit query;
    if (!is_within_reach(ray)) return 0;
    query.ray = embree_ray(ray);
    collection all = {.accel = accel, .hits = out_hits, .max = max};
    intersect_with(accel, &query, &all.context, collect);
    return all.count;
}

bool ppmi_accel_occluded(const ppmi_accel *accel, const ppmi_ray *ray)
{
    if (!is_within_reach(ray)) return false;
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
