/* Counting by lamps, by instances that shine, and the environment. */
#include "render/light_use.h"

typedef struct counts {
    uint32_t sent, used;
} counts;

static const char *name_of(const ppm_scene *scene, size_t slot)
{
    if (slot < scene->punctual_count) return scene->punctuals[slot].name;
    slot -= scene->punctual_count;
    return slot < scene->instance_count ? scene->instances[slot].name : "environment";
}

static void count_photons(const ppmi_job *job, const ppmi_aim *aim, const ppmi_photon_walk *walk,
                          const uint64_t *sums, counts *slots)
{
    const ppmi_lights *lights = job->world.lights;
    if (ppmi_lights_count(lights) == 0) return;
    for (uint32_t i = 0; i < walk->count; i++) {
        ppmi_emission_sample sample;
        ppmi_photon_walk_sample(walk, i, &sample);
        const uint32_t emitter = ppmi_aim_emitter(aim, sample.x[0]);
        counts *slot = &slots[ppmi_lights_source(lights, emitter)];
        slot->sent++;
        slot->used += sums[i] > 0;
    }
}

bool ppmi_light_uses_count(const ppmi_job *job, const ppmi_aim *aim, const ppmi_photon_walk *walk,
                           const uint64_t *sums, ppm_light_use **out_uses, uint32_t *out_count)
{
    const ppm_scene *scene = job->world.scene;
    const size_t slot_count = (size_t)scene->punctual_count + scene->instance_count + 1;
    counts *slots = ppmi_alloc_zeroed(job->context, slot_count, sizeof *slots);
    if (!slots) return false;
    count_photons(job, aim, walk, sums, slots);
    uint32_t count = 0;
    for (size_t i = 0; i < slot_count; i++)
        count += slots[i].sent > 0;
    ppm_light_use *uses = ppmi_alloc(job->context, (size_t)count + 1, sizeof *uses);
    uint32_t filled = 0;
    for (size_t i = 0; uses && i < slot_count; i++) {
        if (slots[i].sent == 0) continue;
        uses[filled++] = (ppm_light_use){.name = name_of(scene, i),
                                         .sent_share = (double)slots[i].sent / walk->count,
                                         .used_share = (double)slots[i].used / slots[i].sent};
    }
    ppmi_free(job->context, slots);
    if (!uses) return false;
    ppmi_free(job->context, *out_uses);
    *out_uses = uses;
    *out_count = count;
    return true;
}
