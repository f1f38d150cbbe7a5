/* What lies around a place: Embree's point queries.
 *
 * Embree's similarity scale is not needed: corners are brought to world space, where whoever asks
 * compares distances itself. */
#include "accel/embree.h"
#include "scene/motion.h"

typedef struct near_query {
    const ppmi_accel *accel;
    float time;
    uint32_t instance; /* that to_world is of */
    ppmi_transform to_world;
    bool is_mirrored;
    bool is_done;
    ppmi_near_visit visit;
    void *user;
} near_query;

static void enter_instance(near_query *query, uint32_t index)
{
    if (query->instance == index) return;
    query->instance = index;
    query->to_world = ppmi_instance_at(&query->accel->scene->instances[index], query->time);
    query->is_mirrored = ppmi_transform_determinant(&query->to_world) < 0.0f;
}

static bool show(near_query *query, const ppmi_near_triangle *triangle)
{
    if (!query->is_done) query->is_done = !query->visit(query->user, triangle);
    return !query->is_done;
}

static void show_triangle(near_query *query, const ppmi_primitive *primitive,
                          ppmi_near_triangle *triangle)
{
    const uint32_t *vertices = primitive->indices + 3 * (size_t)triangle->element;
    for (int i = 0; i < 3; i++) {
        const int corner = query->is_mirrored && i > 0 ? 3 - i : i;
        triangle->corners[corner] = ppmi_transform_point(
            &query->to_world, ppmi_position_at(primitive, vertices[i], query->time));
    }
    show(query, triangle);
}

static bool on_primitive(struct RTCPointQueryFunctionArguments *arguments)
{
    near_query *query = arguments->userPtr;
    ppmi_near_triangle triangle = {.instance = arguments->context->instID[0],
                                   .primitive = arguments->geomID,
                                   .element = arguments->primID};
    if (query->is_done) return false;
    enter_instance(query, triangle.instance);
    const ppm_scene *scene = query->accel->scene;
    const ppmi_mesh *mesh = &scene->meshes[scene->instances[triangle.instance].mesh];
    const ppmi_primitive *primitive = &mesh->primitives[triangle.primitive];
    if (primitive->kind == PPM_PRIMITIVE_TRIANGLES &&
        !ppmi_accel_is_clear(&scene->materials[primitive->material])) {
        show_triangle(query, primitive, &triangle);
    }
    if (query->is_done) arguments->query->radius = 0.0f;
    return query->is_done;
}

void ppmi_accel_nearby(const ppmi_accel *accel, ppmi_vec3 p, float radius, float time,
                       ppmi_near_visit visit, void *user)
{
    near_query query = {
        .accel = accel, .time = time, .instance = UINT32_MAX, .visit = visit, .user = user};
    struct RTCPointQuery ball = {.x = p.x, .y = p.y, .z = p.z, .time = time, .radius = radius};
    struct RTCPointQueryContext context;
    rtcInitPointQueryContext(&context);
    rtcPointQuery(accel->solid, &ball, &context, on_primitive, &query);
}
