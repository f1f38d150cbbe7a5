/* Emission of photons towards targets.
 *
 * Rays are parted by the first of the targets that they meet, from the smallest target to the
 * largest, and the rest: each part has its own share of photons, its own choice of lights and its
 * own way to draw rays, evenly over the target. A ray that is drawn for one part and belongs to
 * another carries nothing. So every ray is drawn in one way only, its density is exact, and nothing
 * is biased, whatever the targets are. */
#ifndef PPMI_LIGHT_AIM_H
#define PPMI_LIGHT_AIM_H

#include "light/lights.h"
#include "light/target.h"

enum { PPMI_AIM_TARGETS = 24 };

typedef struct ppmi_aim ppmi_aim;

/* The count (0 .. PPMI_AIM_TARGETS) targets, from the smallest on, are copied; shares: of photons,
 * for each of them and then for the rest, above 0, of sum 1. The lights must outlive it. Returns
 * OK, OUT_OF_MEMORY. */
ppm_status ppmi_aim_create(ppm_context *context, const ppmi_lights *lights,
                           const ppmi_target *targets, const double *shares, uint32_t count,
                           ppmi_aim **out_aim);
void ppmi_aim_destroy(ppmi_aim *aim);

/* The emitter that pick chooses; there is at least one. */
uint32_t ppmi_aim_emitter(const ppmi_aim *aim, double pick);

/* As ppmi_lights_emit_at, of which the mean is the same. Lights that are neighbours in the scene
 * are neighbours by pick, and near u are near places and directions. */
bool ppmi_aim_emit(const ppmi_aim *aim, float time, double pick, const float u[4],
                   ppmi_emission *out_emission);

#endif
