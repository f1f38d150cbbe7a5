/* The glTF 2.0 importer: file -> check -> parse -> nodes, which pull in what they use. */
#include "gltf/gltf_import.h"

#include <string.h>

#include "gltf/gltf_decoded.h"
#include "gltf/gltf_extensions.h"
#include "gltf/gltf_reader.h"

/* The tables that remember what has been added already. */
static ppm_status allocate_tables(ppmi_gltf_reader *r)
{
    const ppmi_gltf_list *lists = r->outline.lists;
    /* one more each: an empty list is no case of its own */
    r->buffers =
        ppmi_alloc_zeroed(r->context, lists[PPMI_GLTF_BUFFERS].count + 1, sizeof *r->buffers);
    r->images =
        ppmi_alloc_zeroed(r->context, 2 * lists[PPMI_GLTF_IMAGES].count + 1, sizeof *r->images);
    r->materials =
        ppmi_alloc_zeroed(r->context, lists[PPMI_GLTF_MATERIALS].count + 1, sizeof *r->materials);
    r->meshes = ppmi_alloc_zeroed(r->context, lists[PPMI_GLTF_MESHES].count + 1, sizeof *r->meshes);
    r->empty_meshes =
        ppmi_alloc_zeroed(r->context, lists[PPMI_GLTF_MESHES].count + 1, sizeof *r->empty_meshes);
    if (!r->buffers || !r->images || !r->materials || !r->meshes || !r->empty_meshes) {
        return ppmi_fail(r->context, PPM_STATUS_OUT_OF_MEMORY, "%s: out of memory", r->path);
    }
    return PPM_STATUS_OK;
}

/* Both counted the same text; a difference would let an index pass that the other does not have. */
static ppm_status check_counts(ppmi_gltf_reader *r)
{
    const ppmi_gltf_document *d = r->document;
    const struct {
        int list;
        size_t count;
    } pairs[] = {{PPMI_GLTF_SCENES, d->scene_count},
                 {PPMI_GLTF_NODES, d->node_count},
                 {PPMI_GLTF_MESHES, d->mesh_count},
                 {PPMI_GLTF_ACCESSORS, d->accessor_count},
                 {PPMI_GLTF_BUFFER_VIEWS, d->buffer_view_count},
                 {PPMI_GLTF_MATERIALS, d->material_count},
                 {PPMI_GLTF_TEXTURES, d->texture_count},
                 {PPMI_GLTF_SAMPLERS, d->sampler_count},
                 {PPMI_GLTF_CAMERAS, d->camera_count},
                 {PPMI_GLTF_LIGHTS, d->light_count}};
    for (size_t i = 0; i < sizeof pairs / sizeof pairs[0]; ++i) {
        if (r->outline.lists[pairs[i].list].count != pairs[i].count) {
            return ppmi_fail(r->context, PPM_STATUS_INTERNAL,
                             "%s: the JSON parser found %zu items where there are %zu", r->path,
                             pairs[i].count, r->outline.lists[pairs[i].list].count);
        }
    }
    return PPM_STATUS_OK;
}

static ppm_status parse(ppmi_gltf_reader *r)
{
    ppm_status status = ppmi_gltf_check(r->context, r->path, r->json, r->json_length, &r->outline);
    if (status != PPM_STATUS_OK) return status;
    status = ppmi_gltf_document_create(r->context, r->path, r->outline.text, r->outline.text_length,
                                       &r->document);
    if (status != PPM_STATUS_OK) return status;
    r->from_blender = strstr(r->document->generator, "Khronos glTF Blender I/O") != NULL;
    return check_counts(r);
}

/* ---- the report ------------------------------------------------------------------------------ */

static void report_light_units(const ppmi_gltf_reader *r)
{
    static const char *const readings[] = {
        [PPM_LIGHT_UNITS_GLTF] = "candela and lux as written",
        [PPM_LIGHT_UNITS_BLENDER] = "divided by 683 lm/W, as Blender's Cycles shows them",
        [PPM_LIGHT_UNITS_RAW] = "watts as Blender's raw mode writes them"};
    const bool is_auto = r->options->light_units == PPM_LIGHT_UNITS_AUTO;
    const char *why = !is_auto          ? "asked for"
                      : r->from_blender ? "asset.generator is Blender's exporter"
                                        : "asset.generator is not Blender's exporter";
    if (r->tally.punctual_lights == 0) return;
    ppmi_log(r->context, PPM_LOG_INFO,
             "%s: %zu punctual lights: %s (%s); --light-units gltf|blender|raw changes it", r->path,
             r->tally.punctual_lights, readings[ppmi_gltf_light_units(r)], why);
}

static void report_glass(const ppmi_gltf_reader *r)
{
    const bool is_auto = r->options->transmission == PPM_TRANSMISSION_POLICY_AUTO;
    const char *why = !is_auto          ? "asked for"
                      : r->from_blender ? "asset.generator is Blender's exporter"
                                        : "solid where there is a thickness";
    if (r->tally.solid_glass + r->tally.thin_glass == 0) return;
    ppmi_log(r->context, PPM_LOG_INFO,
             "%s: transmissive materials: %zu solid, %zu thin (%s); --transmission solid|thin "
             "changes it",
             r->path, r->tally.solid_glass, r->tally.thin_glass, why);
}

static void report_count(const ppmi_gltf_reader *r, size_t count, const char *what)
{
    if (count > 0) ppmi_log(r->context, PPM_LOG_WARNING, "%s: %zu %s", r->path, count, what);
}

static void report(const ppmi_gltf_reader *r)
{
    const ppmi_gltf_tally *tally = &r->tally;
    report_light_units(r);
    report_glass(r);
    report_count(
        r, tally->points_or_lines,
        "primitives of points or lines: drawn as balls and round segments of 0.2 % of their "
        "mesh's diagonal");
    report_count(r, tally->unused_colors, "sets of vertex colours beyond COLOR_0: not used");
    report_count(r, tally->unused_uvs, "sets of texture coordinates beyond TEXCOORD_7: not used");
    report_count(r, tally->no_positions, "primitives without POSITION left out");
    report_count(r, tally->broken_counts, "triangle lists end in an incomplete triangle");
    report_count(r, tally->skins, "skinned nodes: skins are not applied");
    report_count(r, tally->morph_targets, "primitives with morph targets: not applied");
    report_count(r, r->outline.lists[PPMI_GLTF_ANIMATIONS].count,
                 "animations: the file's static pose is shown");
    if (tally->instances == 0) {
        ppmi_log(r->context, PPM_LOG_WARNING, "%s: nothing to render: %s", r->path,
                 r->outline.lists[PPMI_GLTF_MESHES].count == 0
                     ? "the file has no meshes"
                     : "no node of the scene has a mesh with anything to draw");
    }
}

/* ---- the import ------------------------------------------------------------------------------ */

static ppm_status run(ppmi_gltf_reader *r)
{
    ppm_status status = ppmi_gltf_read_file(r);
    if (status == PPM_STATUS_OK) status = parse(r);
    if (status == PPM_STATUS_OK) status = ppmi_gltf_check_extensions(r);
    if (status == PPM_STATUS_OK) status = allocate_tables(r);
    if (status == PPM_STATUS_OK) status = ppmi_gltf_import_nodes(r);
    if (status == PPM_STATUS_OK) report(r);
    return status;
}

static void deinit(ppmi_gltf_reader *r)
{
    ppmi_gltf_close_files(r);
    ppmi_free(r->context, r->buffers);
    ppmi_free(r->context, r->images);
    ppmi_free(r->context, r->materials);
    ppmi_free(r->context, r->meshes);
    ppmi_free(r->context, r->empty_meshes);
    ppmi_gltf_decoded_deinit(r);
    ppmi_gltf_document_destroy(r->document);
    ppmi_gltf_outline_deinit(r->context, &r->outline);
}

ppm_status ppmi_gltf_import(ppm_context *context, ppm_scene *scene, const char *path,
                            const ppm_import_options *options)
{
    ppmi_gltf_reader reader = {
        .context = context, .scene = scene, .options = options, .path = path};
    if (options->light_units < PPM_LIGHT_UNITS_AUTO || options->light_units > PPM_LIGHT_UNITS_RAW ||
        options->transmission < PPM_TRANSMISSION_POLICY_AUTO ||
        options->transmission > PPM_TRANSMISSION_POLICY_THIN) {
        return ppmi_fail(context, PPM_STATUS_INVALID_ARGUMENT,
                         "import: light_units or transmission is none of the constants");
    }
    const ppm_status status = run(&reader);
    deinit(&reader);
    return status;
}
