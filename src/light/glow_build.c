/* How bright emissive triangles are, and where: looked up at about each texel that they cover.
 *
 * The number of looks is bounded over the whole scene. Where textures have more texels than that,
 * and where a triangle tiles a texture many times, each look takes the mean over its part from the
 * mipmaps. */
#include "light/tables.h"

/* Small triangles of all triangles together, and of one along a side. */
static const uint64_t most_cells = (uint64_t)1 << 22;
enum { MAX_LEVEL = 11 };

/* The least that triangles are looked at, as far as the bound allows: a texel may end within one.
 */
enum { LEAST_LEVEL = 2 };

/* For a first estimate. */
enum { ROUGH_LEVEL = 1 };

/* A part of a triangle is told from others if this lowers the second moment of f / p over all
 * triangles of its mesh by more than the share. */
static const double least_gain = 4e-6;

/* Every triangle is drawn, by a share of its mesh's mean, and the mesh by one of its factor: what
 * lies between looks shines too. */
static const double floor_share = 1.0 / 64.0, factor_share = 1e-6;

/* Opacity counts as no less than this: its edges are sharper than the looks. */
static const float least_opacity = 0.1f;

/* A primitive of an instance, while its triangles are looked at. */
typedef struct glow_mesh {
    ppmi_lights *lights;
    const ppmi_primitive *primitive;
    uint32_t first;         /* emitter */
    ppmi_material material; /* without coat */
    ppmi_material blurred;  /* with a filter that reaches beyond a texel */
    ppmi_glow_lattice lattice;
} glow_mesh;

static const ppmi_primitive *primitive_of(const ppmi_lights *lights, uint32_t instance,
                                          uint32_t primitive)
{
    const ppm_scene *scene = lights->scene;
    return &scene->meshes[scene->instances[instance].mesh].primitives[primitive];
}

static bool has_opacity_texture(const ppm_material_desc *desc)
{
    return desc->alpha_mode != PPM_ALPHA_OPAQUE && desc->base_color_texture.image > 0;
}

static bool has_colors(const ppm_material_desc *desc, const ppmi_primitive *primitive)
{
    return primitive->colors &&
           (desc->emission_takes_vertex_color || desc->alpha_mode != PPM_ALPHA_OPAQUE);
}

static bool varies(const ppmi_lights *lights, const ppmi_primitive *primitive)
{
    const ppm_material_desc *desc = &lights->scene->materials[primitive->material].desc;
    return primitive->kind == PPM_PRIMITIVE_TRIANGLES &&
           (desc->emission_texture.image > 0 || has_opacity_texture(desc) ||
            has_colors(desc, primitive));
}

/* ---- how often to look ----------------------------------------------------------------------- */

/* Looks along a side of a triangle that show a texture's texels; thin triangles are looked at with
 * footprints as long as a few of them. */
static float looks_for(const ppmi_lights *lights, const ppmi_primitive *primitive,
                       uint32_t triangle, const ppm_texture *texture)
{
    if (texture->image == 0 || !primitive->uvs[texture->uv_set]) return 1.0f;
    const ppmi_image *image = &lights->scene->images[texture->image - 1];
    const uint32_t *corners = primitive->indices + 3 * (size_t)triangle;
    ppmi_vec2 at[3];
    for (int k = 0; k < 3; k++) {
        const float *uv = primitive->uvs[texture->uv_set] + 2 * (size_t)corners[k];
        at[k] = (ppmi_vec2){uv[0], uv[1]};
        if (texture->has_transform) {
            const float *m = texture->uv_transform;
            at[k] = (ppmi_vec2){m[0] * uv[0] + m[1] * uv[1], m[3] * uv[0] + m[4] * uv[1]};
        }
        at[k] = (ppmi_vec2){at[k].x * (float)image->width, at[k].y * (float)image->height};
    }
    const ppmi_vec2 ab = {at[1].x - at[0].x, at[1].y - at[0].y};
    const ppmi_vec2 ac = {at[2].x - at[0].x, at[2].y - at[0].y};
    const ppmi_vec2 bc = {ac.x - ab.x, ac.y - ab.y};
    const float longest = sqrtf(ppmi_max(
        ab.x * ab.x + ab.y * ab.y, ppmi_max(ac.x * ac.x + ac.y * ac.y, bc.x * bc.x + bc.y * bc.y)));
    const float looks = ppmi_max(sqrtf(fabsf(ab.x * ac.y - ab.y * ac.x)), 0.25f * longest);
    return looks < 1e6f ? looks : 1e6f; /* not a number too */
}

/* The binary logarithm of the number of looks along a side. */
static uint32_t level_of(const ppmi_lights *lights, const ppmi_primitive *primitive,
                         uint32_t triangle)
{
    const ppm_material_desc *desc = &lights->scene->materials[primitive->material].desc;
    float looks = looks_for(lights, primitive, triangle, &desc->emission_texture);
    if (has_opacity_texture(desc)) {
        looks = ppmi_max(looks, looks_for(lights, primitive, triangle, &desc->base_color_texture));
    }
    const float level = ceilf(log2f(ppmi_max(looks, 1.0f)) - 0.3f);
    const uint32_t wanted = level < (float)MAX_LEVEL ? (uint32_t)ppmi_max(level, 0.0f) : MAX_LEVEL;
    return wanted > LEAST_LEVEL ? wanted : LEAST_LEVEL;
}

/* The first instance of the mesh that shines: others take over what was found for it. */
static uint32_t first_of_mesh(const ppmi_lights *lights, uint32_t instance, uint32_t *firsts)
{
    const uint32_t mesh = lights->scene->instances[instance].mesh;
    if (firsts[mesh] == UINT32_MAX) firsts[mesh] = instance;
    return firsts[mesh];
}

/* Calls visit for each primitive that varies, with that of its mesh's first instance. */
typedef ppm_status (*visitor)(ppmi_lights *lights, uint32_t instance, uint32_t primitive,
                              uint32_t first_instance, void *user);

static ppm_status visit_all(ppmi_lights *lights, uint32_t *firsts, visitor visit, void *user)
{
    const ppm_scene *scene = lights->scene;
    for (uint32_t i = 0; i < scene->mesh_count; i++)
        firsts[i] = UINT32_MAX;
    ppm_status status = PPM_STATUS_OK;
    for (uint32_t i = 0; i < scene->instance_count && status == PPM_STATUS_OK; i++) {
        if (!ppmi_instance_is_there(&scene->instances[i])) continue;
        const uint32_t count = scene->meshes[scene->instances[i].mesh].primitive_count;
        const uint32_t first = first_of_mesh(lights, i, firsts);
        for (uint32_t k = 0; k < count && status == PPM_STATUS_OK; k++) {
            if (lights->first_emitter[lights->first_slot[i] + k] == PPMI_NO_EMITTER) continue;
            status = visit(lights, i, k, first, user);
        }
    }
    return status;
}

/* ---- looking --------------------------------------------------------------------------------- */

static float look(const glow_mesh *mesh, ppmi_surface *surface, float u, float v)
{
    const ppm_scene *scene = mesh->lights->scene;
    surface->u = u;
    surface->v = v;
    float value = vec3_mean(ppmi_surface_emission(scene, surface, surface->ng));
    if (value > 0.0f && mesh->material.has_alpha) {
        value *= ppmi_max(ppmi_surface_opacity(scene, surface), least_opacity);
    }
    return value > 0.0f && value < 1e30f ? value : 0.0f;
}

/* Triangles of fewer looks along a side are no work for several threads. */
enum { PARALLEL_SIDE = 128 };

static void look_at_corners(const glow_mesh *mesh, const ppmi_surface *surface)
{
    const uint32_t side = mesh->lattice.side;
    const float step = 1.0f / (float)side;
#pragma omp parallel for schedule(dynamic, 8) if (side >= PARALLEL_SIDE)
    for (uint32_t row = 0; row <= side; row++) {
        ppmi_surface at = *surface;
        at.material = &mesh->blurred;
        float *values = mesh->lattice.corners + ppmi_glow_row_start(side, row);
        for (uint32_t i = 0; i + row <= side; i++)
            values[i] = look(mesh, &at, (float)i * step, (float)row * step);
    }
}

/* shift: from a small triangle's first corner to its middle, below 0 where it is turned. */
static void look_at_middle(const glow_mesh *mesh, ppmi_surface *surface, uint32_t column,
                           uint32_t row, float shift)
{
    const uint32_t side = mesh->lattice.side;
    const float step = 1.0f / (float)side;
    mesh->lattice.middles[ppmi_glow_middle_at(side, column, row, shift < 0.0f)] =
        look(mesh, surface, ((float)column + shift) * step, ((float)row + shift) * step);
}

static void look_at_middles(const glow_mesh *mesh, const ppmi_surface *surface)
{
    const uint32_t side = mesh->lattice.side;
#pragma omp parallel for schedule(dynamic, 8) if (side >= PARALLEL_SIDE)
    for (uint32_t row = 0; row < side; row++) {
        ppmi_surface at = *surface;
        at.material = &mesh->material;
        for (uint32_t i = 0; i + row < side; i++)
            look_at_middle(mesh, &at, i, row, 1.0f / 3);
        for (uint32_t i = 1; row > 0 && i + row <= side; i++)
            look_at_middle(mesh, &at, i, row, -1.0f / 3);
    }
}

/* Fills the lattice from a triangle. */
static void look_at(glow_mesh *mesh, const ppmi_emitter *e, uint32_t level)
{
    ppmi_surface surface;
    ppmi_emitter_surface(mesh->lights, e, 1.0f / 3, 1.0f / 3, 0.0f, &surface);
    mesh->lattice.side = 1u << level;
    surface.uv_dx = (ppmi_vec2){1.0f / (float)mesh->lattice.side, 0.0f};
    surface.uv_dy = (ppmi_vec2){0.0f, surface.uv_dx.x};
    look_at_corners(mesh, &surface);
    look_at_middles(mesh, &surface);
}

/* A part by the corners: texels that reach into a triangle from beside must not be rare. */
static double mean_of(const glow_mesh *mesh)
{
    return 0.875 * ppmi_glow_mean_of_middles(&mesh->lattice) +
           0.125 * ppmi_glow_mean_of_corners(&mesh->lattice);
}

/* What all triangles of the mesh shine, by a few looks at each. */
static double rough_mass(glow_mesh *mesh)
{
    double mass = 0.0;
    for (uint32_t t = 0; t < mesh->primitive->element_count; t++) {
        const ppmi_emitter *e = &mesh->lights->emitters[mesh->first + t];
        const uint32_t level = level_of(mesh->lights, mesh->primitive, t);
        look_at(mesh, e, level < ROUGH_LEVEL ? level : ROUGH_LEVEL);
        mass += (double)e->area * mean_of(mesh);
    }
    return mass;
}

static void set_up_materials(glow_mesh *mesh)
{
    mesh->material = mesh->lights->scene->materials[mesh->primitive->material];
    mesh->material.desc.clearcoat = 0.0f;
    mesh->material.desc.double_sided = 1;
    mesh->blurred = mesh->material;
    mesh->blurred.desc.emission_texture.filter = PPM_FILTER_LINEAR;
}

static void add_floors(glow_mesh *mesh, double mass)
{
    ppmi_emitter *emitters = mesh->lights->emitters + mesh->first;
    double area = 0.0;
    for (uint32_t t = 0; t < mesh->primitive->element_count; t++)
        area += (double)emitters[t].area;
    const double mean = area > 0.0 ? mass / area : 0.0;
    const double factor = (double)vec3_mean(vec3_load(mesh->material.desc.emission));
    const float floor = (float)(floor_share * mean + factor_share * factor);
    for (uint32_t t = 0; t < mesh->primitive->element_count; t++)
        emitters[t].radiance += floor;
}

/* Of all primitives together. */
typedef struct glow_plan {
    uint32_t shift;                    /* levels less than wanted */
    uint64_t triangles[MAX_LEVEL + 1]; /* by the level that they want */
    float *corners, *middles;          /* room for the largest lattice */
} glow_plan;

static uint32_t planned_level(const glow_plan *plan, uint32_t wanted)
{
    return wanted > plan->shift ? wanted - plan->shift : 0;
}

static ppm_status look_at_mesh(ppmi_lights *lights, uint32_t instance, uint32_t primitive,
                               const glow_plan *plan)
{
    glow_mesh mesh = {.lights = lights,
                      .primitive = primitive_of(lights, instance, primitive),
                      .first = lights->first_emitter[lights->first_slot[instance] + primitive],
                      .lattice = {.corners = plan->corners, .middles = plan->middles}};
    set_up_materials(&mesh);
    const double price = least_gain * rough_mass(&mesh);
    double mass = 0.0;
    for (uint32_t t = 0; t < mesh.primitive->element_count; t++) {
        ppmi_emitter *e = &lights->emitters[mesh.first + t];
        look_at(&mesh, e, planned_level(plan, level_of(lights, mesh.primitive, t)));
        const double mean = mean_of(&mesh);
        e->radiance = (float)mean;
        if (!(e->area > 0.0f)) continue;
        mass += (double)e->area * mean;
        const ppm_status status = ppmi_glow_add(lights->context, &lights->glow, &mesh.lattice,
                                                price / (double)e->area, &e->glow);
        if (status != PPM_STATUS_OK) return status;
    }
    add_floors(&mesh, mass);
    return PPM_STATUS_OK;
}

/* ---- all primitives -------------------------------------------------------------------------- */

static ppm_status count_looks(ppmi_lights *lights, uint32_t instance, uint32_t primitive,
                              uint32_t first_instance, void *user)
{
    glow_plan *plan = user;
    const ppmi_primitive *of = primitive_of(lights, instance, primitive);
    if (instance != first_instance || !varies(lights, of)) return PPM_STATUS_OK;
    for (uint32_t t = 0; t < of->element_count; t++)
        plan->triangles[level_of(lights, of, t)]++;
    return PPM_STATUS_OK;
}

/* A constant, or for what is round that of a few places. */
static void take_few_looks(ppmi_lights *lights, const ppmi_primitive *primitive, uint32_t first)
{
    const ppmi_material *material = &lights->scene->materials[primitive->material];
    const bool is_even =
        material->desc.emission_texture.image == 0 && !material->desc.emission_takes_vertex_color;
    enum { PLACES = 4 };
    for (uint32_t t = 0; t < primitive->element_count; t++) {
        ppmi_emitter *e = &lights->emitters[first + t];
        const float factor = vec3_mean(vec3_load(material->desc.emission));
        e->radiance = is_even ? factor : 0.05f * factor;
        for (int i = 0; i < PLACES && !is_even; i++) {
            ppmi_surface surface;
            ppmi_emitter_surface(lights, e, ((float)i + 0.5f) / PLACES, 0.25f, 0.0f, &surface);
            e->radiance +=
                vec3_mean(ppmi_surface_emission(lights->scene, &surface, surface.ng)) / PLACES;
        }
    }
}

static ppm_status build_primitive(ppmi_lights *lights, uint32_t instance, uint32_t primitive,
                                  uint32_t first_instance, void *user)
{
    const glow_plan *plan = user;
    const ppmi_primitive *of = primitive_of(lights, instance, primitive);
    const uint32_t first = lights->first_emitter[lights->first_slot[instance] + primitive];
    if (!varies(lights, of)) {
        take_few_looks(lights, of, first);
        return PPM_STATUS_OK;
    }
    if (instance == first_instance) return look_at_mesh(lights, instance, primitive, plan);
    const uint32_t known = lights->first_emitter[lights->first_slot[first_instance] + primitive];
    for (uint32_t t = 0; t < of->element_count; t++) {
        lights->emitters[first + t].radiance = lights->emitters[known + t].radiance;
        lights->emitters[first + t].glow = lights->emitters[known + t].glow;
    }
    return PPM_STATUS_OK;
}

static uint64_t cells_of(const glow_plan *plan)
{
    uint64_t cells = 0;
    for (uint32_t level = 0; level <= MAX_LEVEL; level++)
        cells += plan->triangles[level] << (2 * planned_level(plan, level));
    return cells;
}

ppm_status ppmi_lights_build_glow(ppmi_lights *lights)
{
    ppm_context *context = lights->context;
    if (lights->triangle_count == 0) return PPM_STATUS_OK;
    glow_plan plan = {0};
    uint32_t *firsts = ppmi_alloc(context, lights->scene->mesh_count + 1u, sizeof *firsts);
    if (firsts) visit_all(lights, firsts, count_looks, &plan);
    while (plan.shift < MAX_LEVEL && cells_of(&plan) > most_cells)
        plan.shift++;
    uint32_t level = MAX_LEVEL;
    while (level > LEAST_LEVEL && plan.triangles[level] == 0)
        level--;
    const size_t side = (size_t)1 << level;
    plan.corners =
        ppmi_alloc(context, ppmi_glow_corner_count((uint32_t)side), sizeof *plan.corners);
    plan.middles = ppmi_alloc(context, side * side, sizeof *plan.middles);
    ppm_status status =
        firsts && plan.corners && plan.middles
            ? visit_all(lights, firsts, build_primitive, &plan)
            : ppmi_fail(context, PPM_STATUS_OUT_OF_MEMORY, "out of memory: emissive textures");
    ppmi_free(context, plan.middles);
    ppmi_free(context, plan.corners);
    ppmi_free(context, firsts);
    return status;
}
