/* The OBJ importer: statements -> libraries -> normals -> meshes, which pull in what they use. */
#include "obj/obj_import.h"

#include <stdio.h>
#include <string.h>

#include "obj/obj_reader.h"

ppm_status ppmi_obj_out_of_memory(ppmi_obj_reader *r)
{
    return ppmi_fail(r->context, PPM_STATUS_OUT_OF_MEMORY, "%s: out of memory", r->path);
}

/* ---- the report ------------------------------------------------------------------------------ */

static void report_count(const ppmi_obj_reader *r, size_t count, const char *what)
{
    if (count > 0) ppmi_log(r->context, PPM_LOG_WARNING, "%s: %zu %s", r->path, count, what);
}

/* One line for all statements of materials that are not supported. */
static void report_ignored(const ppmi_obj_reader *r)
{
    char list[256] = "";
    size_t used = 0;
    const uint32_t count = ppmi_obj_names_count(&r->ignored);
    for (uint32_t i = 0; i < count && used + 1 < sizeof list; ++i) {
        const int n = snprintf(list + used, sizeof list - used, "%s%.40s", i > 0 ? ", " : "",
                               ppmi_obj_names_get(&r->ignored, i));
        used += n > 0 ? (size_t)n : 0;
    }
    if (count > 0) {
        ppmi_log(r->context, PPM_LOG_WARNING, "%s: statements of materials that have no effect: %s",
                 r->path, list);
    }
}

static void report(const ppmi_obj_reader *r)
{
    const ppmi_obj_tally *tally = &r->tally;
    report_count(r, tally->free_forms, "free-form curves and surfaces left out");
    report_count(r, tally->small_faces, "faces of fewer than three corners left out");
    report_count(r, tally->short_lines, "lines and points of too few vertices left out");
    report_count(r, tally->no_number_uvs,
                 "texture vertices that are not finite numbers: taken as 0 0");
    report_count(r, tally->no_number_normals,
                 "vertex normals that are not finite numbers: faces have their own there");
    report_count(r, r->polygons.forced,
                 "polygons that cross themselves or are too involved: split as well as possible");
    if (tally->unknown > 0) {
        ppmi_log(r->context, PPM_LOG_WARNING,
                 "%s: %zu unknown statements left out, the first is '%s' in line %zu", r->path,
                 tally->unknown, tally->unknown_word, tally->unknown_line);
    }
    report_ignored(r);
    if (tally->glass > 0) {
        ppmi_log(r->context, PPM_LOG_INFO, "%s: %zu materials of solid glass", r->path,
                 tally->glass);
    }
    if (tally->turned_meshes > 0) {
        ppmi_log(r->context, PPM_LOG_INFO,
                 "%s: %u objects of solid glass are closed and wound inside out: turned", r->path,
                 tally->turned_meshes);
    }
    report_count(r, tally->reflections,
                 "reflection maps (refl) without effect: reflections are traced");
    report_count(r, tally->displaced,
                 "displacement maps (disp) that are shown as bumps: the surface stays where it is");
    if (tally->flat_faces > 0) {
        ppmi_log(r->context, PPM_LOG_INFO,
                 "%s: %zu faces without normals and smoothing group are flat", r->path,
                 tally->flat_faces);
    }
    if (r->faces.count == 0) {
        ppmi_log(r->context, PPM_LOG_WARNING,
                 "%s: nothing to render: it has no faces, lines or points", r->path);
    }
}

/* ---- the import ------------------------------------------------------------------------------ */

/* The file's name without folder and ending. */
static ppm_status set_stem(ppmi_obj_reader *r)
{
    const char *name = r->path + ppmi_obj_folder_length(r->path);
    const char *dot = strrchr(name, '.');
    r->stem = ppmi_obj_utf8(r->context, name, dot ? (size_t)(dot - name) : strlen(name));
    return r->stem ? PPM_STATUS_OK : ppmi_obj_out_of_memory(r);
}

static ppm_status check_content(ppmi_obj_reader *r)
{
    if (r->positions.count > 0) return PPM_STATUS_OK;
    return ppmi_fail(r->context, PPM_STATUS_INPUT_INVALID,
                     "%s: it has no vertices: it is empty or not an OBJ file", r->path);
}

static void deinit(ppmi_obj_reader *r)
{
    ppmi_obj_array *const arrays[] = {&r->positions, &r->colors,        &r->uvs,       &r->normals,
                                      &r->corners,   &r->faces,         &r->image_ids, &r->runs,
                                      &r->element,   &r->object_lengths};
    ppmi_obj_names *const names[] = {
        &r->objects,           &r->used_materials,    &r->library_names, &r->libraries,
        &r->library_materials, &r->missing_materials, &r->ignored,       &r->images,
        &r->commented};
    for (size_t i = 0; i < r->materials.count; ++i) {
        ppmi_obj_material_deinit(r->context, (ppmi_obj_material *)r->materials.items + i);
    }
    ppmi_obj_array_deinit(r->context, &r->materials);
    ppmi_obj_array_deinit(r->context, &r->commented_ids);
    for (size_t i = 0; i < sizeof arrays / sizeof arrays[0]; ++i) {
        ppmi_obj_array_deinit(r->context, arrays[i]);
    }
    for (size_t i = 0; i < sizeof names / sizeof names[0]; ++i) {
        ppmi_obj_names_deinit(r->context, names[i]);
    }
    ppmi_obj_polygon_deinit(r->context, &r->polygons);
    ppmi_free(r->context, r->object);
    ppmi_free(r->context, r->group);
    ppmi_free(r->context, r->stem);
}

/* ---- the asset ------------------------------------------------------------------------------- */

struct ppmi_obj_asset {
    ppmi_obj_reader reader;
};

ppm_status ppmi_obj_asset_open(ppm_context *context, const char *path,
                               const ppm_import_options *options, ppmi_obj_asset **out_asset)
{
    ppmi_obj_asset *asset = ppmi_alloc_zeroed(context, 1, sizeof *asset);
    if (!asset) return ppmi_fail(context, PPM_STATUS_OUT_OF_MEMORY, "%s: out of memory", path);
    ppmi_obj_reader *r = &asset->reader;
    r->context = context;
    r->path = path;
    r->options = options;
    ppm_status status = set_stem(r);
    if (status == PPM_STATUS_OK) status = ppmi_obj_read_statements(r);
    if (status == PPM_STATUS_OK) status = check_content(r);
    if (status != PPM_STATUS_OK) {
        ppmi_obj_asset_close(asset);
        return status;
    }
    *out_asset = asset;
    return PPM_STATUS_OK;
}

ppm_status ppmi_obj_asset_import(ppmi_obj_asset *asset, ppm_scene *scene)
{
    ppmi_obj_reader *r = &asset->reader;
    r->scene = scene;
    ppm_status status = ppmi_obj_read_libraries(r);
    if (status == PPM_STATUS_OK) status = ppmi_obj_smooth_normals(r);
    if (status == PPM_STATUS_OK) status = ppmi_obj_crease_normals(r);
    if (status == PPM_STATUS_OK) status = ppmi_obj_emit(r);
    if (status == PPM_STATUS_OK) {
        status = ppm_scene_turn_solids(r->scene, &r->tally.turned_meshes);
    }
    if (status == PPM_STATUS_OK) report(r);
    return status;
}

void ppmi_obj_asset_close(ppmi_obj_asset *asset)
{
    if (!asset) return;
    ppm_context *context = asset->reader.context;
    deinit(&asset->reader);
    ppmi_free(context, asset);
}

const ppmi_obj_reader *ppmi_obj_asset_reader(const ppmi_obj_asset *asset)
{
    return &asset->reader;
}

ppm_status ppmi_obj_import(ppm_context *context, ppm_scene *scene, const char *path,
                           const ppm_import_options *options)
{
    ppmi_obj_asset *asset = NULL;
    ppm_status status = ppmi_obj_asset_open(context, path, options, &asset);
    if (status == PPM_STATUS_OK) status = ppmi_obj_asset_import(asset, scene);
    ppmi_obj_asset_close(asset);
    return status;
}
