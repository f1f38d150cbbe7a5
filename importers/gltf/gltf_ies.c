/* EXT_lights_ies: point lights with a measured profile. One whose profile cannot be had shines
 * evenly, with its multiplier as candela. */
#include <math.h>
#include <stdio.h>
#include <string.h>

#include "gltf/gltf_belong.h"
#include "gltf/gltf_light.h"
#include "gltf/gltf_placement.h"
#include "gltf/gltf_rigid.h"
#include "gltf/ies.h"

/* The bytes of a profile; *out_owned is the caller's, NULL for those of a buffer. */
static ppm_status find_bytes(ppmi_gltf_reader *reader, const ppmi_gltf_light_profile *from,
                             const char *place, const char **out_text, size_t *out_count,
                             unsigned char **out_owned, const char **reason)
{
    const unsigned char *bytes = NULL;
    ppm_status status;
    *out_owned = NULL;
    if (from->uri_length > 0) {
        status =
            ppmi_gltf_read_uri(reader, from->uri, from->uri_length, out_owned, out_count, reason);
        bytes = *out_owned;
    } else if (from->buffer_view >= 0) {
        *reason = "see the message above";
        status = ppmi_gltf_view_bytes(reader, from->buffer_view, place, &bytes, out_count);
    } else {
        *reason = "it has neither uri nor bufferView";
        status = PPM_STATUS_INPUT_INVALID;
    }
    *out_text = (const char *)bytes;
    if (status == PPM_STATUS_OK && !bytes) {
        *reason = "it is empty";
        status = PPM_STATUS_INPUT_INVALID;
    }
    return status;
}

static ppm_status add_profile(ppmi_gltf_reader *reader, const char *name,
                              const ppmi_ies_profile *parsed, ppm_light_profile_id *out_id)
{
    const ppm_light_profile_desc desc = {.size = sizeof desc,
                                         .name = name,
                                         .polar_count = parsed->polar_count,
                                         .azimuth_count = parsed->azimuth_count,
                                         .polar_rad = parsed->polar_rad,
                                         .azimuth_rad = parsed->azimuth_rad,
                                         .candela = parsed->candela};
    return ppm_scene_add_light_profile(reader->scene, &desc, out_id);
}

/* Reads a profile at its first use; use->id stays 0 when it cannot be had. */
static ppm_status load_profile(ppmi_gltf_reader *reader, int32_t index, ppmi_gltf_profile_use *use)
{
    const ppmi_gltf_light_profile *from = &reader->document->profiles[index];
    char place[PPMI_GLTF_PLACE], name[PPMI_GLTF_PLACE], shown[80];
    const char *text = NULL, *reason = "";
    unsigned char *owned;
    size_t count;
    ppmi_ies_profile parsed = {0};
    ppmi_gltf_place(place, "extensions.EXT_lights_ies.lights[%d]", (int)index);
    use->is_tried = true;
    ppm_status status = find_bytes(reader, from, place, &text, &count, &owned, &reason);
    if (status == PPM_STATUS_OK) {
        status = ppmi_ies_parse(reader->context, text, count, &parsed, &reason);
    }
    if (status == PPM_STATUS_OK) {
        use->turn_rad = parsed.turn_rad;
        status = add_profile(reader, ppmi_gltf_choose_name(from->name, "", name, sizeof name),
                             &parsed, &use->id);
        reason = "see the message above";
    }
    ppmi_ies_deinit(reader->context, &parsed);
    ppmi_free(reader->context, owned);
    if (status == PPM_STATUS_OK || status == PPM_STATUS_OUT_OF_MEMORY) return status;
    ppmi_gltf_warn(reader, place, "its lights shine evenly%s%s%s: %s",
                   from->uri_length > 0 ? " (\"" : "",
                   ppmi_gltf_printable(from->uri, from->uri_length, shown, sizeof shown),
                   from->uri_length > 0 ? "\")" : "", reason);
    return PPM_STATUS_OK;
}

/* Turns a light about the axis that it shines along, from +X towards +Y. */
static void turn(float transform[16], float angle)
{
    const float c = cosf(angle), s = sinf(angle);
    for (int i = 0; i < 3; ++i) {
        const float x = transform[i], y = transform[4 + i];
        transform[i] = c * x + s * y;
        transform[4 + i] = c * y - s * x;
    }
}

ppm_status ppmi_gltf_add_ies_light(ppmi_gltf_reader *reader, int32_t node, const double world[16])
{
    const ppmi_gltf_node *from = &reader->document->nodes[node];
    char place[PPMI_GLTF_PLACE], name[PPMI_GLTF_PLACE], group[PPMI_GLTF_PLACE];
    ppmi_gltf_place(place, "nodes[%d].extensions.EXT_lights_ies.light", (int)node);
    if (!ppmi_gltf_accept(reader, PPMI_GLTF_LIGHT_PROFILES, from->profile, place)) {
        return PPM_STATUS_OK;
    }
    ppmi_gltf_profile_use *use = &reader->profiles[from->profile];
    ppm_status status = PPM_STATUS_OK;
    if (!use->is_tried) status = load_profile(reader, from->profile, use);
    if (status != PPM_STATUS_OK) return status;
    const ppmi_gltf_light_profile *profile = &reader->document->profiles[from->profile];
    ppm_light_desc desc = {
        .size = sizeof desc,
        .name = ppmi_gltf_choose_name(from->name, profile->name, name, sizeof name),
        .kind = PPM_LIGHT_POINT,
        .profile = use->id,
        .is_hidden = ppmi_gltf_is_hidden(&from->lamp),
        .light_group = ppmi_gltf_light_group(reader, node, "", group, sizeof group)};
    double color[3];
    for (int i = 0; i < 3; ++i) /* by the extension */
        color[i] = fmin(fmax(from->profile_color[i], 0.0), 1.0);
    const double factor = ppmi_gltf_candela_factor(ppmi_gltf_light_units(reader));
    const char *fault =
        ppmi_gltf_light_intensity(color, from->profile_factor * factor, desc.intensity);
    if (!fault) fault = ppmi_gltf_rigid_transform(world, true, desc.transform);
    if (fault) {
        ppmi_gltf_warn(reader, place, "left out: lights[%d]: %s", (int)from->profile, fault);
        return ppmi_gltf_darken_light(reader, node, PPMI_GLTF_WAY_IES);
    }
    if (from->lamp.radius_m >= 0.0 && from->lamp.radius_m < 1e15) {
        desc.radius_m = (float)from->lamp.radius_m;
    }
    turn(desc.transform, use->turn_rad);
    reader->tally.punctual_lights++;
    return ppmi_gltf_put_light(reader, node, PPMI_GLTF_WAY_IES, &desc);
}
