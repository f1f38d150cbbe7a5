/* The glTF 2.0 importer: file -> check -> parse -> nodes, which pull in what they use. */
#include "gltf/gltf_import.h"

#include <string.h>

#include "gltf/gltf_animation.h"
#include "gltf/gltf_asset.h"
#include "gltf/gltf_decoded.h"
#include "gltf/gltf_extensions.h"
#include "gltf/gltf_light.h"
#include "gltf/gltf_placement.h"
#include "gltf/gltf_pose.h"
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
    r->animations = ppmi_alloc_zeroed(r->context, 1, sizeof *r->animations);
    r->profiles = ppmi_alloc_zeroed(r->context, lists[PPMI_GLTF_LIGHT_PROFILES].count + 1,
                                    sizeof *r->profiles);
    if (!r->animations || !r->profiles || !r->buffers || !r->images || !r->materials ||
        !r->meshes || !r->empty_meshes) {
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
                 {PPMI_GLTF_LIGHTS, d->light_count},
                 {PPMI_GLTF_VARIANTS, d->variant_count},
                 {PPMI_GLTF_SKINS, d->skin_count},
                 {PPMI_GLTF_ANIMATIONS, d->animation_count},

                 {PPMI_GLTF_AREA_LIGHTS, d->area_light_count},
                 {PPMI_GLTF_LIGHT_PROFILES, d->profile_count},
                 {PPMI_GLTF_IMAGE_LIGHTS, d->image_light_count},
                 {PPMI_GLTF_CUBEMAPS, d->cubemap_count},
                 {PPMI_GLTF_ENVIRONMENT_MAPS, d->environment_map_count}};
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

static void report_turned(const ppmi_gltf_reader *r)
{
    if (r->tally.turned_meshes == 0) return;
    ppmi_log(r->context, PPM_LOG_INFO,
             "%s: %u meshes of solid glass are closed and wound inside out: turned", r->path,
             r->tally.turned_meshes);
}

static void report_count(const ppmi_gltf_reader *r, size_t count, const char *what)
{
    if (count > 0) ppmi_log(r->context, PPM_LOG_WARNING, "%s: %zu %s", r->path, count, what);
}

static void report(const ppmi_gltf_reader *r)
{
    const ppmi_gltf_tally *tally = &r->tally;
    ppmi_gltf_report_lights(r);
    report_glass(r);
    report_turned(r);
    report_count(r, tally->no_positions, "primitives without POSITION left out");
    report_count(r, tally->broken_counts, "triangle lists end in an incomplete triangle");
    if (tally->instances == 0) {
        ppmi_log(r->context, PPM_LOG_WARNING, "%s: nothing to render: %s", r->path,
                 r->outline.lists[PPMI_GLTF_MESHES].count == 0
                     ? "the file has no meshes"
                     : "no node of the scene has a mesh with anything to draw");
    }
}

/* ---- the asset ------------------------------------------------------------------------------- */

struct ppmi_gltf_asset {
    ppmi_gltf_reader reader;
};

static ppm_status open_reader(ppmi_gltf_reader *r)
{
    ppm_status status = ppmi_gltf_read_file(r);
    if (status == PPM_STATUS_OK) status = parse(r);
    if (status == PPM_STATUS_OK) status = allocate_tables(r);
    if (status == PPM_STATUS_OK) status = ppmi_gltf_check_extensions(r);
    if (status == PPM_STATUS_OK) ppmi_gltf_note_core_features(r);
    if (status == PPM_STATUS_OK) status = ppmi_gltf_choose_variant(r);
    if (status == PPM_STATUS_OK) status = ppmi_gltf_read_xmp(r);
    return status;
}

static void deinit(ppmi_gltf_reader *r)
{
    ppmi_gltf_close_files(r);
    ppmi_free(r->context, r->buffers);
    ppmi_free(r->context, r->images);
    ppmi_gltf_free_blends(r);
    ppmi_free(r->context, r->profiles);
    ppmi_free(r->context, r->materials);
    ppmi_free(r->context, r->meshes);
    ppmi_free(r->context, r->empty_meshes);
    ppmi_gltf_report_deinit(r->context, &r->report);
    ppmi_free(r->context, r->xmp);
    ppmi_gltf_decoded_deinit(r);
    ppmi_gltf_animations_deinit(r->context, r->animations);
    ppmi_gltf_pose_destroy(r->context, r->pose);
    ppmi_gltf_placements_destroy(r);
    ppmi_gltf_document_destroy(r->document);
    ppmi_gltf_outline_deinit(r->context, &r->outline);
}

ppm_status ppmi_gltf_asset_open(ppm_context *context, const char *path,
                                const ppm_import_options *options, ppmi_gltf_asset **out_asset)
{
    if (options->light_units < PPM_LIGHT_UNITS_AUTO || options->light_units > PPM_LIGHT_UNITS_RAW ||
        options->transmission < PPM_TRANSMISSION_POLICY_AUTO ||
        options->transmission > PPM_TRANSMISSION_POLICY_THIN) {
        return ppmi_fail(context, PPM_STATUS_INVALID_ARGUMENT,
                         "import: light_units or transmission is none of the constants");
    }
    if (!(options->line_radius_m >= 0.0f && options->line_radius_m <= 1e9f)) {
        return ppmi_fail(context, PPM_STATUS_INVALID_ARGUMENT,
                         "import: line_radius_m is not within 0 .. 1e9");
    }
    ppmi_gltf_asset *asset = ppmi_alloc_zeroed(context, 1, sizeof *asset);
    if (!asset) return ppmi_fail(context, PPM_STATUS_OUT_OF_MEMORY, "%s: out of memory", path);
    asset->reader.context = context;
    asset->reader.options = options;
    asset->reader.path = path;
    const ppm_status status = open_reader(&asset->reader);
    if (status != PPM_STATUS_OK) {
        ppmi_gltf_asset_close(asset);
        return status;
    }
    *out_asset = asset;
    return PPM_STATUS_OK;
}

void ppmi_gltf_asset_close(ppmi_gltf_asset *asset)
{
    if (!asset) return;
    ppm_context *context = asset->reader.context;
    deinit(&asset->reader);
    ppmi_free(context, asset);
}

ppm_status ppmi_gltf_asset_import(ppmi_gltf_asset *asset, ppm_scene *scene)
{
    ppmi_gltf_reader *r = &asset->reader;
    r->scene = scene;
    ppm_status status = ppmi_gltf_choose_scene(r);
    if (status == PPM_STATUS_OK) status = ppmi_gltf_load_images(r);
    if (status == PPM_STATUS_OK) status = ppmi_gltf_import_nodes(r);
    if (status == PPM_STATUS_OK) status = ppmi_gltf_import_environment(r);
    if (status == PPM_STATUS_OK) {
        status = ppm_scene_turn_solids(r->scene, &r->tally.turned_meshes);
    }
    if (status == PPM_STATUS_OK) report(r);
    if (status == PPM_STATUS_OK) status = ppmi_gltf_report_finish(r);
    return status;
}

ppm_status ppmi_gltf_asset_set_pose(ppmi_gltf_asset *asset, const ppm_pose *pose)
{
    return ppmi_gltf_pose_nodes(&asset->reader, pose);
}

const ppmi_gltf_reader *ppmi_gltf_asset_reader(const ppmi_gltf_asset *asset)
{
    return &asset->reader;
}

ppm_status ppmi_gltf_import(ppm_context *context, ppm_scene *scene, const char *path,
                            const ppm_import_options *options)
{
    ppmi_gltf_asset *asset = NULL;
    ppm_status status = ppmi_gltf_asset_open(context, path, options, &asset);
    if (status == PPM_STATUS_OK) status = ppmi_gltf_asset_import(asset, scene);
    ppmi_gltf_asset_close(asset);
    return status;
}
