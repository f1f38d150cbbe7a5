/* Layers are told by their names in the file (docs/compositing.md). */
#include "merge/plan.h"

#include <string.h>

enum { MATTES_MAX = 64 };

/* ---- names ----------------------------------------------------------------------------------- */

/* "CryptoObject01.b": layer 1 of CryptoObject, whose ranks are 2 (r, g) and 3 (b, a). */
typedef struct matte_channel {
    size_t name_length; /* of "CryptoObject" */
    uint32_t rank;
    bool is_coverage;
} matte_channel;

static bool is_digit(char letter)
{
    return letter >= '0' && letter <= '9';
}

static bool parse_matte(const char *name, matte_channel *out_channel)
{
    const char *const dot = strrchr(name, '.');
    const char *const letter = dot && dot[1] && !dot[2] ? strchr("rgbaRGBA", dot[1]) : NULL;
    if (strncmp(name, "Crypto", 6) != 0 || !letter || dot - name < 3) return false;
    if (!is_digit(dot[-1]) || !is_digit(dot[-2])) return false;
    const uint32_t index = (uint32_t)(strchr("rgbaRGBA", dot[1]) - "rgbaRGBA") % 4;
    const uint32_t layer = (uint32_t)(10 * (dot[-2] - '0') + (dot[-1] - '0'));
    *out_channel = (matte_channel){.name_length = (size_t)(dot - 2 - name),
                                   .rank = 2 * layer + index / 2,
                                   .is_coverage = index % 2 == 1};
    return out_channel->rank < MERGE_RANKS_MAX;
}

static bool is_of_layer(const char *name, const char *layer)
{
    const size_t length = strlen(layer);
    return strncmp(name, layer, length) == 0 && name[length] == '.';
}

static int32_t rule_of(const char *name)
{
    static const char *const first[] = {"depth",  "position",     "uv",
                                        "motion", "object_index", "material_index"};
    matte_channel matte;
    if (parse_matte(name, &matte)) return MERGE_RANKS;
    if (is_of_layer(name, "variance")) return MERGE_VARIANCE;
    if (is_of_layer(name, "photon_density")) return MERGE_SUM;
    if (strcmp(name, "Z") == 0) return MERGE_FIRST;
    for (size_t i = 0; i < sizeof first / sizeof first[0]; i++) {
        if (is_of_layer(name, first[i])) return MERGE_FIRST;
    }
    return MERGE_MEAN;
}

/* ---- Cryptomattes ---------------------------------------------------------------------------- */

/* The matte of that name; names[i] is the name of any channel of matte i. */
static merge_matte *find_matte(merge_plan *plan, const char **names, const char *name,
                               size_t length)
{
    for (uint32_t i = 0; i < plan->matte_count; i++) {
        matte_channel other;
        if (parse_matte(names[i], &other) && other.name_length == length &&
            strncmp(names[i], name, length) == 0) {
            return &plan->mattes[i];
        }
    }
    if (plan->matte_count == MATTES_MAX) return NULL;
    merge_matte *const matte = &plan->mattes[plan->matte_count];
    names[plan->matte_count++] = name;
    memset(matte->ids, 0xff, sizeof matte->ids);
    memset(matte->coverages, 0xff, sizeof matte->coverages);
    return matte;
}

static ppm_status check_matte(ppm_context *context, const char *path, const char *name,
                              const merge_matte *matte)
{
    for (uint32_t i = 0; i < matte->rank_count; i++) {
        if (matte->ids[i] != UINT32_MAX && matte->coverages[i] != UINT32_MAX) continue;
        return ppmi_fail(context, PPM_STATUS_INPUT_INVALID,
                         "%s: the Cryptomatte with the channel '%s' lacks rank %u", path, name, i);
    }
    return PPM_STATUS_OK;
}

static ppm_status find_mattes(ppm_context *context, const merge_source *source, merge_plan *plan)
{
    const char *names[MATTES_MAX];
    for (uint32_t i = 0; i < plan->channel_count; i++) {
        const char *const name = ppmi_layered_input_channel(source->input, i);
        matte_channel channel;
        if (!parse_matte(name, &channel)) continue;
        merge_matte *const matte = find_matte(plan, names, name, channel.name_length);
        if (!matte) {
            return ppmi_fail(context, PPM_STATUS_INPUT_INVALID, "%s: more than %d Cryptomattes",
                             source->path, MATTES_MAX);
        }
        (channel.is_coverage ? matte->coverages : matte->ids)[channel.rank] = i;
        if (channel.rank >= matte->rank_count) matte->rank_count = channel.rank + 1;
    }
    ppm_status status = PPM_STATUS_OK;
    for (uint32_t i = 0; i < plan->matte_count && status == PPM_STATUS_OK; i++)
        status = check_matte(context, source->path, names[i], &plan->mattes[i]);
    return status;
}

/* ---- the plan -------------------------------------------------------------------------------- */

static bool find_places(ppm_context *context, const merge_source *sources, size_t count,
                        merge_plan *plan)
{
    for (size_t s = 0; s < count; s++) {
        plan->places[s] = ppmi_alloc(context, plan->channel_count, sizeof **plan->places);
        if (!plan->places[s]) return false;
        for (uint32_t i = 0; i < plan->channel_count; i++) {
            plan->places[s][i] =
                merge_source_channel(&sources[s], ppmi_layered_input_channel(sources[0].input, i));
        }
    }
    return true;
}

ppm_status merge_plan_init(ppm_context *context, const merge_source *sources, size_t count,
                           merge_plan *plan)
{
    *plan = (merge_plan){.channel_count = sources[0].info.channel_count, .source_count = count};
    plan->rules = ppmi_alloc(context, plan->channel_count, sizeof *plan->rules);
    plan->places = ppmi_alloc_zeroed(context, count, sizeof *plan->places);
    plan->mattes = ppmi_alloc_zeroed(context, MATTES_MAX, sizeof *plan->mattes);
    if (!plan->rules || !plan->places || !plan->mattes ||
        !find_places(context, sources, count, plan)) {
        return ppmi_fail(context, PPM_STATUS_OUT_OF_MEMORY, "out of memory: %u channels",
                         plan->channel_count);
    }
    for (uint32_t i = 0; i < plan->channel_count; i++)
        plan->rules[i] = rule_of(ppmi_layered_input_channel(sources[0].input, i));
    return find_mattes(context, &sources[0], plan);
}

void merge_plan_deinit(ppm_context *context, merge_plan *plan)
{
    for (size_t s = 0; plan->places && s < plan->source_count; s++)
        ppmi_free(context, plan->places[s]);
    ppmi_free(context, plan->places);
    ppmi_free(context, plan->rules);
    ppmi_free(context, plan->mattes);
    *plan = (merge_plan){0};
}
