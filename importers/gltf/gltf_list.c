/* Phrases for people, from the document and, for what the document leaves out (images, variants,
 * bounds of accessors), from the file's JSON. */
#include "gltf/gltf_list.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "gltf/gltf_light.h"
#include "gltf/gltf_scan.h"

#define PI 3.14159265358979323846

enum { PHRASE = 512 };

static double degrees(double radians)
{
    return radians * 180.0 / PI;
}

/* Appends to a phrase of PHRASE bytes; what does not fit is cut. */
static void append(char phrase[PHRASE], const char *format, ...) PPMI_PRINTF(2, 3);
static void append(char phrase[PHRASE], const char *format, ...)
{
    const size_t length = strlen(phrase);
    va_list arguments;
    va_start(arguments, format);
    vsnprintf(phrase + length, PHRASE - length, format, arguments);
    va_end(arguments);
}

static bool is_usable(const ppmi_gltf_reader *r, int list, int32_t index)
{
    char reason[2 * PPMI_GLTF_PLACE];
    return ppmi_gltf_is_usable(r, list, index, reason, sizeof reason);
}

/* "broken" in place of what an item is, where it cannot be used. */
static bool add_broken(const ppmi_gltf_reader *r, ppmi_catalog *catalog, int list, size_t index,
                       int32_t kind)
{
    const char *why = r->outline.lists[list].broken[index];
    char phrase[PHRASE] = "";
    if (!why) return false;
    append(phrase, "broken: %s", why);
    ppmi_catalog_add(catalog, kind, "", phrase);
    return true;
}

/* Parts of the JSON, found in one walk over what may be a large text. */
typedef struct json_parts {
    ppmi_gltf_span accessors, extensions, images;
} json_parts;

static json_parts find_parts(const ppmi_gltf_reader *r)
{
    static const char *const keys[] = {"accessors", "extensions", "images"};
    ppmi_gltf_span spans[3];
    ppmi_gltf_scan_members(r->json, ppmi_gltf_scan_root(r->json_length), keys, 3, spans);
    return (json_parts){.accessors = spans[0], .extensions = spans[1], .images = spans[2]};
}

static const char *name_in(const ppmi_gltf_reader *r, ppmi_gltf_span object, char *buffer)
{
    const ppmi_gltf_span name = ppmi_gltf_scan_member(r->json, object, "name");
    return ppmi_gltf_scan_string(r->json, name, buffer, PPMI_GLTF_PLACE);
}

/* The scene that is asked for, or else the default; one that does not exist is refused on import.
 */
static size_t chosen_scene(const ppmi_gltf_reader *r)
{
    const ppmi_gltf_document *d = r->document;
    const char *wanted = r->options->scene;
    char *end = NULL;
    for (size_t i = 0; wanted && i < d->scene_count; ++i) {
        if (strcmp(d->scenes[i].name, wanted) == 0) return i;
    }
    const unsigned long number = wanted ? strtoul(wanted, &end, 10) : 0;
    if (wanted && *wanted && *end == 0) return number;
    return d->default_scene < 0 ? 0 : (size_t)d->default_scene;
}

/* ---- scenes ---------------------------------------------------------------------------------- */

static void list_scenes(const ppmi_gltf_reader *r, ppmi_catalog *catalog)
{
    const ppmi_gltf_document *d = r->document;
    const int32_t chosen = d->default_scene < 0 ? 0 : d->default_scene;
    for (size_t i = 0; i < d->scene_count; ++i) {
        char phrase[PHRASE] = "";
        if (add_broken(r, catalog, PPMI_GLTF_SCENES, i, PPM_ASSET_SCENES)) continue;
        append(phrase, "%u root node%s%s", d->scenes[i].node_count,
               d->scenes[i].node_count == 1 ? "" : "s",
               (size_t)chosen == i ? ", the file's default" : "");
        ppmi_catalog_add(catalog, PPM_ASSET_SCENES, d->scenes[i].name, phrase);
    }
}

/* ---- nodes ----------------------------------------------------------------------------------- */

/* Writes the parent of each node, or -1. False when memory is out. */
static bool find_parents(const ppmi_gltf_reader *r, int32_t **out_parents)
{
    const ppmi_gltf_document *d = r->document;
    int32_t *parents = ppmi_alloc(r->context, d->node_count + 1, sizeof *parents);
    if (!parents) return false;
    for (size_t i = 0; i < d->node_count; ++i) {
        parents[i] = -1;
    }
    for (size_t i = 0; i < d->node_count; ++i) {
        for (uint32_t k = 0; k < d->nodes[i].child_count; ++k) {
            const int32_t child = d->nodes[i].children[k];
            if (child >= 0 && (size_t)child < d->node_count) parents[child] = (int32_t)i;
        }
    }
    *out_parents = parents;
    return true;
}

/* "mesh 'Cube'", or "mesh 3" for one without a name. */
static void append_use(char phrase[PHRASE], const char *what, const char *name, int32_t index)
{
    append(phrase, "%s%s ", phrase[0] ? ", " : "", what);
    if (name[0]) {
        append(phrase, "'%s'", name);
    } else {
        append(phrase, "%d", (int)index + 1);
    }
}

static void describe_node(const ppmi_gltf_reader *r, const int32_t *parents, size_t index,
                          char phrase[PHRASE])
{
    const ppmi_gltf_document *d = r->document;
    const ppmi_gltf_node *node = &d->nodes[index];
    if (is_usable(r, PPMI_GLTF_MESHES, node->mesh)) {
        append_use(phrase, "mesh", d->meshes[node->mesh].name, node->mesh);
        if (node->is_instanced) append(phrase, " (instanced)");
    }
    if (is_usable(r, PPMI_GLTF_CAMERAS, node->camera)) {
        append_use(phrase, "camera", d->cameras[node->camera].name, node->camera);
    }
    if (is_usable(r, PPMI_GLTF_LIGHTS, node->light)) {
        append_use(phrase, "light", d->lights[node->light].name, node->light);
    }
    if (node->skin >= 0) append_use(phrase, "skin", "", node->skin);
    if (parents[index] >= 0) {
        append_use(phrase, "below", d->nodes[parents[index]].name, parents[index]);
    }
    if (node->child_count > 0) {
        append(phrase, "%s%u child%s", phrase[0] ? ", " : "", node->child_count,
               node->child_count == 1 ? "" : "ren");
    }
}

static void list_nodes(const ppmi_gltf_reader *r, ppmi_catalog *catalog, const int32_t *parents)
{
    for (size_t i = 0; i < r->document->node_count; ++i) {
        char phrase[PHRASE] = "";
        if (add_broken(r, catalog, PPMI_GLTF_NODES, i, PPM_ASSET_NODES)) continue;
        describe_node(r, parents, i, phrase);
        ppmi_catalog_add(catalog, PPM_ASSET_NODES, r->document->nodes[i].name, phrase);
    }
}

/* ---- cameras and lights of the chosen scene -------------------------------------------------- */

static void add_camera(const ppmi_gltf_reader *r, ppmi_catalog *catalog, int32_t index)
{
    const ppmi_gltf_node *node = &r->document->nodes[index];
    char phrase[PHRASE] = "", name[PPMI_GLTF_PLACE];
    if (!is_usable(r, PPMI_GLTF_CAMERAS, node->camera)) return;
    const ppmi_gltf_camera *camera = &r->document->cameras[node->camera];
    const char *own = camera->name[0] ? camera->name : node->name;
    if (camera->is_orthographic) {
        append(phrase, "orthographic, %g x %g m", 2.0 * fabs(camera->x_mag),
               2.0 * fabs(camera->y_mag));
    } else {
        append(phrase, "perspective, %.1f degrees high", degrees(camera->y_fov_rad));
        if (camera->aspect > 0.0) append(phrase, ", %.3g:1", camera->aspect);
    }
    ppmi_catalog_add(catalog, PPM_ASSET_CAMERAS,
                     ppmi_gltf_printable(own, strlen(own), name, sizeof name), phrase);
}

static void add_light(const ppmi_gltf_reader *r, ppmi_catalog *catalog, int32_t index)
{
    static const char *const kinds[] = {[PPMI_GLTF_LIGHT_POINT] = "point",
                                        [PPMI_GLTF_LIGHT_SPOT] = "spot",
                                        [PPMI_GLTF_LIGHT_DIRECTIONAL] = "directional"};
    const ppmi_gltf_node *node = &r->document->nodes[index];
    char phrase[PHRASE] = "";
    if (!is_usable(r, PPMI_GLTF_LIGHTS, node->light)) return;
    const ppmi_gltf_light *light = &r->document->lights[node->light];
    const bool is_sun = light->kind == PPMI_GLTF_LIGHT_DIRECTIONAL;
    append(phrase, "%s, %.4g %s", kinds[light->kind],
           light->intensity * ppmi_gltf_unit_factor(ppmi_gltf_light_units(r), light->kind),
           is_sun ? "lux" : "cd");
    if (light->kind == PPMI_GLTF_LIGHT_SPOT) {
        append(phrase, ", %.1f degrees wide", 2.0 * degrees(light->outer_cone_rad));
    }
    ppmi_catalog_add(catalog, PPM_ASSET_LIGHTS, light->name[0] ? light->name : node->name, phrase);
}

/* EXT_lights_area, and the extras for files that cannot have it: sizes without the node's scale. */
static void add_area_lights(const ppmi_gltf_reader *r, ppmi_catalog *catalog, int32_t index)
{
    const ppmi_gltf_node *node = &r->document->nodes[index];
    char phrase[PHRASE] = "";
    if (is_usable(r, PPMI_GLTF_AREA_LIGHTS, node->area_light)) {
        const ppmi_gltf_area_light *light = &r->document->area_lights[node->area_light];
        append(phrase, "area, %s, %.4g nit", light->is_disk ? "disk" : "rect", light->intensity);
        ppmi_catalog_add(catalog, PPM_ASSET_LIGHTS, light->name[0] ? light->name : node->name,
                         phrase);
    }
    if (!node->area.is_given) return;
    phrase[0] = 0;
    append(phrase, "area, %s, %.4g x %.4g m", node->area.shape, node->area.size[0],
           node->area.size[1]);
    ppmi_catalog_add(catalog, PPM_ASSET_LIGHTS, node->name, phrase);
}

/* Nodes in the order of the import: parents first, children in their order. The number of steps is
 * bounded, for cyclic files, which the import refuses. */
typedef struct walk {
    const ppmi_gltf_reader *reader;
    ppmi_catalog *catalog;
    const int32_t *parents;
    int32_t *stack;
    size_t depth, steps_left;
} walk;

static void walk_from(walk *w, int32_t root)
{
    const ppmi_gltf_document *d = w->reader->document;
    if (root < 0 || (size_t)root >= d->node_count) return;
    w->stack[0] = root;
    w->depth = 1;
    while (w->depth > 0 && w->steps_left > 0) {
        const int32_t index = w->stack[--w->depth];
        const ppmi_gltf_node *node = &d->nodes[index];
        --w->steps_left;
        add_camera(w->reader, w->catalog, index);
        add_light(w->reader, w->catalog, index);
        add_area_lights(w->reader, w->catalog, index);
        for (uint32_t i = node->child_count; i > 0; --i) {
            const int32_t child = node->children[i - 1];
            const bool is_own = child >= 0 && (size_t)child < d->node_count &&
                                w->parents[child] == index && w->depth < d->node_count;
            if (is_own) w->stack[w->depth++] = child;
        }
    }
}

static void list_scene(const ppmi_gltf_reader *r, ppmi_catalog *catalog, const int32_t *parents)
{
    const ppmi_gltf_document *d = r->document;
    walk w = {.reader = r,
              .catalog = catalog,
              .parents = parents,
              .steps_left = d->node_count,
              .stack = ppmi_alloc(r->context, d->node_count + 1, sizeof *w.stack)};
    if (!w.stack) catalog->is_out_of_memory = true;
    const size_t index = chosen_scene(r);
    if (w.stack && index < d->scene_count) {
        for (uint32_t i = 0; i < d->scenes[index].node_count; ++i) {
            walk_from(&w, d->scenes[index].nodes[i]);
        }
    } else if (w.stack && d->scene_count == 0) {
        for (size_t i = 0; i < d->node_count; ++i) {
            if (parents[i] < 0) walk_from(&w, (int32_t)i);
        }
    }
    ppmi_free(r->context, w.stack);
}

/* ---- meshes and materials -------------------------------------------------------------------- */

static const char *ending(size_t count)
{
    return count == 1 ? "" : "s";
}

static size_t element_count(const ppmi_gltf_reader *r, const ppmi_gltf_primitive *primitive)
{
    int32_t accessor = primitive->indices;
    for (uint32_t i = 0; accessor < 0 && i < primitive->attribute_count; ++i) {
        if (strcmp(primitive->attributes[i].name, "POSITION") == 0) {
            accessor = primitive->attributes[i].accessor;
        }
    }
    return is_usable(r, PPMI_GLTF_ACCESSORS, accessor) ? r->document->accessors[accessor].count : 0;
}

static size_t triangle_count(int32_t mode, size_t elements)
{
    if (mode == PPMI_GLTF_TRIANGLES) return elements / 3;
    return elements < 3 ? 0 : elements - 2;
}

static void describe_mesh(const ppmi_gltf_reader *r, const ppmi_gltf_mesh *mesh,
                          char phrase[PHRASE])
{
    size_t triangles = 0, points = 0, lines = 0;
    bool has_targets = false;
    for (uint32_t i = 0; i < mesh->primitive_count; ++i) {
        const ppmi_gltf_primitive *primitive = &mesh->primitives[i];
        const size_t elements = element_count(r, primitive);
        has_targets = has_targets || primitive->target_count > 0;
        if (primitive->mode >= PPMI_GLTF_TRIANGLES) {
            triangles += triangle_count(primitive->mode, elements);
        } else if (primitive->mode == 0) {
            points += elements;
        } else {
            ++lines;
        }
    }
    if (triangles > 0 || points + lines == 0)
        append(phrase, "%zu triangle%s", triangles, ending(triangles));
    if (points > 0) append(phrase, "%s%zu point%s", phrase[0] ? ", " : "", points, ending(points));
    if (lines > 0)
        append(phrase, "%s%zu set%s of lines", phrase[0] ? ", " : "", lines, ending(lines));
    append(phrase, ", %u primitive%s%s", mesh->primitive_count, ending(mesh->primitive_count),
           has_targets ? ", morph targets" : "");
}

static void list_meshes(const ppmi_gltf_reader *r, ppmi_catalog *catalog)
{
    for (size_t i = 0; i < r->document->mesh_count; ++i) {
        char phrase[PHRASE] = "";
        if (add_broken(r, catalog, PPMI_GLTF_MESHES, i, PPM_ASSET_MESHES)) continue;
        describe_mesh(r, &r->document->meshes[i], phrase);
        ppmi_catalog_add(catalog, PPM_ASSET_MESHES, r->document->meshes[i].name, phrase);
    }
}

/* What it looks like first of all; all of its extensions are in the report. */
static void describe_material(const ppmi_gltf_material *m, char phrase[PHRASE])
{
    const bool is_emissive = m->emissive[0] + m->emissive[1] + m->emissive[2] > 0.0;
    const bool has_metal_map = m->metallic_roughness_texture.texture >= 0;
    if (m->is_unlit) {
        append(phrase, "unlit");
    } else if (m->transmission > 0.0) {
        append(phrase, "glass, ior %.3g%s", m->ior, m->thickness > 0.0 ? ", solid" : "");
    } else if (has_metal_map) {
        append(phrase, "metal and roughness by texture");
    } else {
        append(phrase, "%s, roughness %.2g",
               m->metallic >= 1.0  ? "metal"
               : m->metallic > 0.0 ? "partly metal"
                                   : "dielectric",
               m->roughness);
    }
    if (is_emissive) append(phrase, ", emissive");
    if (m->base_color_texture.texture >= 0) append(phrase, ", textured");
    if (strcmp(m->alpha_mode, "OPAQUE") != 0) append(phrase, ", alpha %s", m->alpha_mode);
    if (m->double_sided) append(phrase, ", double-sided");
}

static void list_materials(const ppmi_gltf_reader *r, ppmi_catalog *catalog)
{
    for (size_t i = 0; i < r->document->material_count; ++i) {
        char phrase[PHRASE] = "";
        if (add_broken(r, catalog, PPMI_GLTF_MATERIALS, i, PPM_ASSET_MATERIALS)) continue;
        describe_material(&r->document->materials[i], phrase);
        ppmi_catalog_add(catalog, PPM_ASSET_MATERIALS, r->document->materials[i].name, phrase);
    }
}

/* ---- variants, animations, images --------------------------------------------- */

static void list_variants(const ppmi_gltf_reader *r, ppmi_catalog *catalog,
                          ppmi_gltf_span extensions)
{
    const ppmi_gltf_span extension =
        ppmi_gltf_scan_member(r->json, extensions, "KHR_materials_variants");
    const ppmi_gltf_span variants = ppmi_gltf_scan_member(r->json, extension, "variants");
    ppmi_gltf_span variant;
    char name[PPMI_GLTF_PLACE];
    for (size_t cursor = 0; ppmi_gltf_scan_next(r->json, variants, &cursor, &variant);) {
        ppmi_catalog_add(catalog, PPM_ASSET_VARIANTS, name_in(r, variant, name), "");
    }
}

/* The first and last key of each accessor that says so. */
typedef struct key_times {
    double *first, *last; /* one per accessor; first > last where it does not say */
    size_t count;
} key_times;

/* The first element of a list of numbers, such as an accessor's min. */
static double first_number(const ppmi_gltf_reader *r, ppmi_gltf_span object, const char *key,
                           double otherwise)
{
    const ppmi_gltf_span list = ppmi_gltf_scan_member(r->json, object, key);
    ppmi_gltf_span element;
    size_t cursor = 0;
    if (!ppmi_gltf_scan_next(r->json, list, &cursor, &element)) return otherwise;
    return ppmi_gltf_scan_number(r->json, element, otherwise);
}

static bool key_times_init(const ppmi_gltf_reader *r, ppmi_gltf_span accessors, key_times *times)
{
    size_t cursor = 0;
    times->count = r->document->accessor_count;
    times->first = ppmi_alloc(r->context, 2 * times->count + 1, sizeof *times->first);
    if (!times->first) return false;
    times->last = times->first + times->count;
    for (size_t i = 0; i < times->count; ++i) {
        ppmi_gltf_span accessor = {0, 0};
        ppmi_gltf_scan_next(r->json, accessors, &cursor, &accessor);
        times->first[i] = first_number(r, accessor, "min", INFINITY);
        times->last[i] = first_number(r, accessor, "max", -INFINITY);
    }
    return true;
}

/* From the first key of any sampler to the last; false when no accessor says so. */
static bool animation_range(const ppmi_gltf_animation *animation, const key_times *times,
                            double *out_begin, double *out_end)
{
    double begin = INFINITY, end = -INFINITY;
    for (uint32_t i = 0; i < animation->sampler_count; ++i) {
        const int32_t input = animation->samplers[i].input;
        if (input < 0 || (size_t)input >= times->count) continue;
        begin = fmin(begin, times->first[input]);
        end = fmax(end, times->last[input]);
    }
    if (!(isfinite(begin) && isfinite(end) && begin <= end)) return false;
    *out_begin = begin;
    *out_end = end;
    return true;
}

static void add_animation(ppmi_catalog *catalog, const ppmi_gltf_animation *animation,
                          const key_times *times)
{
    char phrase[PHRASE] = "";
    double begin = 0.0, end = 0.0;
    if (animation_range(animation, times, &begin, &end)) {
        append(phrase, "%.4g .. %.4g s, ", begin, end);
    }
    append(phrase, "%u channel%s", animation->channel_count,
           animation->channel_count == 1 ? "" : "s");
    ppmi_catalog_item *item =
        ppmi_catalog_add(catalog, PPM_ASSET_ANIMATIONS, animation->name, phrase);
    if (!item) return;
    item->begin_s = begin;
    item->end_s = end;
}

static void list_animations(const ppmi_gltf_reader *r, ppmi_catalog *catalog,
                            ppmi_gltf_span accessors)
{
    const ppmi_gltf_document *d = r->document;
    key_times times = {0};
    if (d->animation_count == 0) return;
    if (!key_times_init(r, accessors, &times)) {
        catalog->is_out_of_memory = true;
        return;
    }
    for (size_t i = 0; i < d->animation_count; ++i) {
        if (add_broken(r, catalog, PPMI_GLTF_ANIMATIONS, i, PPM_ASSET_ANIMATIONS)) continue;
        add_animation(catalog, &d->animations[i], &times);
    }
    ppmi_free(r->context, times.first);
}

/* "textures/wood%20floor.png", or what is before the data of a data URI. */
static void describe_image(const ppmi_gltf_reader *r, ppmi_gltf_span image, char phrase[PHRASE])
{
    char uri[PPMI_GLTF_PLACE], mime[64];
    ppmi_gltf_scan_string(r->json, ppmi_gltf_scan_member(r->json, image, "uri"), uri, sizeof uri);
    ppmi_gltf_scan_string(r->json, ppmi_gltf_scan_member(r->json, image, "mimeType"), mime,
                          sizeof mime);
    if (strncmp(uri, "data:", 5) == 0) {
        append(phrase, "in the JSON, %.*s", (int)strcspn(uri + 5, ";,"), uri + 5);
    } else if (uri[0]) {
        append(phrase, "file %s", uri);
        if (mime[0]) append(phrase, ", %s", mime);
    } else {
        append(phrase, "embedded, %s", mime[0] ? mime : "of a kind that is not said");
    }
}

static void list_images(const ppmi_gltf_reader *r, ppmi_catalog *catalog, ppmi_gltf_span images)
{
    ppmi_gltf_span image;
    char name[PPMI_GLTF_PLACE];
    for (size_t cursor = 0; ppmi_gltf_scan_next(r->json, images, &cursor, &image);) {
        char phrase[PHRASE] = "";
        describe_image(r, image, phrase);
        ppmi_catalog_add(catalog, PPM_ASSET_IMAGES, name_in(r, image, name), phrase);
    }
}

/* ---- all of it ------------------------------------------------------------------------------- */

static void say_light_units(const ppmi_gltf_reader *r, ppmi_catalog *catalog)
{
    static const char *const readings[] = {
        [PPM_LIGHT_UNITS_GLTF] = "candela and lux as written",
        [PPM_LIGHT_UNITS_BLENDER] = "divided by 683 lm/W, as Blender's Cycles shows them",
        [PPM_LIGHT_UNITS_RAW] = "watts as Blender's raw mode writes them"};
    if (catalog->lists[PPM_ASSET_LIGHTS].count == 0) return;
    catalog->light_units = ppmi_catalog_text(catalog, readings[ppmi_gltf_light_units(r)]);
}

void ppmi_gltf_fill_catalog(const ppmi_gltf_reader *reader, ppmi_catalog *catalog)
{
    const json_parts parts = find_parts(reader);
    int32_t *parents = NULL;
    catalog->generator = ppmi_catalog_text(catalog, reader->document->generator);
    list_scenes(reader, catalog);
    if (find_parents(reader, &parents)) {
        list_nodes(reader, catalog, parents);
        list_scene(reader, catalog, parents);
        ppmi_free(reader->context, parents);
    } else {
        catalog->is_out_of_memory = true;
    }
    list_meshes(reader, catalog);
    list_materials(reader, catalog);
    list_variants(reader, catalog, parts.extensions);
    list_animations(reader, catalog, parts.accessors);
    list_images(reader, catalog, parts.images);
    say_light_units(reader, catalog);
}
