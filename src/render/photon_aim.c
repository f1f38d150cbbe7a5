/* Rounds of learning. Each round's photons are drawn by what the rounds before have told. */
#include "render/photon_aim.h"

#include <math.h>
#include <string.h>

#include "photon/seek.h"
#include "render/light_use.h"

/* Late rounds, which have found more, count for more. */
enum { ROUNDS = 4 };

void ppmi_photon_aim_deinit(ppm_context *context, ppmi_photon_aim *aim)
{
    ppmi_aim_destroy(aim->aim);
    ppmi_free(context, aim->guide);
    ppmi_free(context, aim->seen);
    ppmi_free(context, aim->uses);
    *aim = (ppmi_photon_aim){0};
}

ppm_status ppmi_photon_aim_begin(const ppmi_job *job, ppmi_photon_aim *aim, uint64_t *rays)
{
    const ppmi_seek seek = {.world = &job->world,
                            .view = &job->view,
                            .x0 = (float)job->film.x0,
                            .y0 = (float)job->film.y0,
                            .width = (float)job->film.width,
                            .height = (float)job->film.height,
                            .around_camera =
                                job->around_camera_changes ? NULL : &job->around_camera,
                            .shutter_is_open = ppmi_shutter_is_open(job)};
    ppmi_target targets[PPMI_AIM_TARGETS];
    double shares[PPMI_AIM_TARGETS + 1];
    uint32_t count = 0;
    if (!aim->guide) aim->guide = ppmi_alloc(job->context, 1, sizeof *aim->guide);
    if (!aim->guide) {
        return ppmi_fail(job->context, PPM_STATUS_OUT_OF_MEMORY, "out of memory: guide");
    }
    const ppm_status status = ppmi_seek_targets(job->context, &seek, targets, shares, &count, rays);
    if (status != PPM_STATUS_OK) return status;
    return ppmi_aim_create(job->context, job->world.lights, targets, shares, count, &aim->aim);
}

static bool reserve(ppm_context *context, ppmi_photon_aim *aim, size_t more)
{
    const size_t count = aim->seen_count + more;
    if (count <= aim->seen_capacity) return true;
    ppmi_guide_seen *larger = ppmi_alloc(context, count, sizeof *larger);
    if (!larger) return false;
    if (aim->seen_count > 0) memcpy(larger, aim->seen, aim->seen_count * sizeof *larger);
    ppmi_free(context, aim->seen);
    aim->seen = larger;
    aim->seen_capacity = count;
    return true;
}

/* Adds the photons of a round that were seen. False when memory is out. */
static bool add_round(ppm_context *context, ppmi_photon_aim *aim, const ppmi_photon_walk *walk,
                      const uint64_t *sums)
{
    size_t seen = 0;
    for (uint32_t i = 0; i < walk->count; i++)
        seen += sums[i] > 0;
    if (!reserve(context, aim, seen)) return false;
    const double of_round = ldexp(1.0, (int)aim->rounds) / walk->count;
    for (uint32_t i = 0; i < walk->count; i++) {
        if (sums[i] == 0) continue;
        ppmi_guide_seen *one = &aim->seen[aim->seen_count++];
        const double density = ppmi_photon_walk_sample(walk, i, &one->sample);
        one->volume = of_round / density;
        one->weight = of_round * (double)sums[i] / (double)PPMI_PHOTON_MARK;
    }
    aim->used_share = (double)seen / walk->count;
    return true;
}

ppm_status ppmi_photon_aim_learn(const ppmi_job *job, ppmi_photon_aim *aim, ppmi_photon_map *map,
                                 const ppmi_photon_walk *walk)
{
    const size_t seen_before = aim->seen_count;
    uint64_t *sums = ppmi_alloc_zeroed(job->context, walk->count, sizeof *sums);
    bool has_memory = sums != NULL;
    if (has_memory) {
        ppmi_photon_map_sum_marks(map, sums);
        has_memory =
            add_round(job->context, aim, walk, sums) &&
            (aim->rounds + 1 < ROUNDS ||
             ppmi_light_uses_count(job, aim->aim, walk, sums, &aim->uses, &aim->use_count));
    }
    ppmi_free(job->context, sums);
    ppmi_photon_map_end_marks(job->context, map);
    const ppm_status status =
        has_memory ? ppmi_guide_learn(job->context, aim->guide, aim->seen, aim->seen_count,
                                      ldexp(1.0, (int)aim->rounds + 1) - 1.0)
                   : ppmi_fail(job->context, PPM_STATUS_OUT_OF_MEMORY, "out of memory: guide");
    if (status != PPM_STATUS_OK) {
        aim->seen_count = seen_before; /* the round may be tried again */
        return status;
    }
    aim->rounds++;
    aim->is_learnt = aim->rounds == ROUNDS;
    if (!aim->is_learnt) return PPM_STATUS_OK;
    ppmi_free(job->context, aim->seen);
    aim->seen = NULL;
    aim->seen_count = aim->seen_capacity = 0;
    return PPM_STATUS_OK;
}
