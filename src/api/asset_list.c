/* What is in an opened file, and what of it is understood. */
#include "api/asset.h"

#include "gltf/gltf_list.h"
#include "obj/obj_list.h"

/* The report of a glTF file, or NULL. */
static const ppmi_gltf_report *report_of(const ppm_asset *asset)
{
    return asset && asset->gltf ? &ppmi_gltf_asset_reader(asset->gltf)->report : NULL;
}

ppm_status ppmi_asset_fill_catalog(ppm_asset *asset)
{
    const ppmi_gltf_report *report = report_of(asset);
    asset->catalog.context = asset->context;
    if (asset->gltf) ppmi_gltf_fill_catalog(ppmi_gltf_asset_reader(asset->gltf), &asset->catalog);
    if (asset->obj) ppmi_obj_fill_catalog(asset->obj, &asset->catalog);
    if (!asset->catalog.is_out_of_memory && !(report && report->out_of_memory)) {
        return PPM_STATUS_OK;
    }
    return ppmi_fail(asset->context, PPM_STATUS_OUT_OF_MEMORY,
                     "%s: out of memory for the list of what is in it", asset->path);
}

uint32_t ppm_asset_count(const ppm_asset *asset, int32_t kind)
{
    if (!asset || kind < 0 || kind >= PPM_ASSET_KINDS) return 0;
    return (uint32_t)asset->catalog.lists[kind].count;
}

ppm_status ppm_asset_get_item(const ppm_asset *asset, int32_t kind, uint32_t index,
                              ppm_asset_item *out_item)
{
    if (!asset || !out_item || out_item->size < sizeof *out_item) {
        return PPM_STATUS_INVALID_ARGUMENT;
    }
    if (index >= ppm_asset_count(asset, kind)) {
        return ppmi_fail(asset->context, PPM_STATUS_INVALID_ARGUMENT,
                         "%s: no item %u of kind %d: there are %u", asset->path, index, (int)kind,
                         ppm_asset_count(asset, kind));
    }
    const ppmi_catalog_item *item = &asset->catalog.lists[kind].items[index];
    *out_item = (ppm_asset_item){.size = out_item->size,
                                 .name = item->name,
                                 .detail = item->detail,
                                 .begin_s = item->begin_s,
                                 .end_s = item->end_s};
    return PPM_STATUS_OK;
}

const char *ppm_asset_generator(const ppm_asset *asset)
{
    return asset && asset->catalog.generator ? asset->catalog.generator : "";
}

const char *ppm_asset_light_units(const ppm_asset *asset)
{
    return asset && asset->catalog.light_units ? asset->catalog.light_units : "";
}

uint32_t ppm_asset_feature_count(const ppm_asset *asset)
{
    const ppmi_gltf_report *report = report_of(asset);
    return report ? (uint32_t)report->count : 0;
}

ppm_status ppm_asset_get_feature(const ppm_asset *asset, uint32_t index,
                                 ppm_asset_feature *out_feature)
{
    if (!asset || !out_feature || out_feature->size < sizeof *out_feature) {
        return PPM_STATUS_INVALID_ARGUMENT;
    }
    if (index >= ppm_asset_feature_count(asset)) {
        return ppmi_fail(asset->context, PPM_STATUS_INVALID_ARGUMENT,
                         "%s: no feature %u: there are %u", asset->path, index,
                         ppm_asset_feature_count(asset));
    }
    const ppmi_gltf_feature *feature = &report_of(asset)->items[index];
    *out_feature = (ppm_asset_feature){.size = out_feature->size,
                                       .name = feature->name,
                                       .verdict = feature->verdict,
                                       .note = feature->note ? feature->note : ""};
    return PPM_STATUS_OK;
}

const char *ppm_asset_copyright(const ppm_asset *asset)
{
    if (!asset || !asset->gltf) return "";
    const char *copyright = ppmi_gltf_asset_reader(asset->gltf)->document->copyright;
    return copyright ? copyright : "";
}

const char *ppm_asset_xmp(const ppm_asset *asset)
{
    if (!asset || !asset->gltf) return "";
    const char *xmp = ppmi_gltf_asset_reader(asset->gltf)->xmp;
    return xmp ? xmp : "";
}
