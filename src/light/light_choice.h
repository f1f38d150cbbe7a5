/* The first decision of light sampling: which cluster of near lights, or which kind of far light.
 */
#ifndef PPMI_LIGHT_LIGHT_CHOICE_H
#define PPMI_LIGHT_LIGHT_CHOICE_H

#include "light/tables.h"

/* Sets up clusters and choices over finished tables. */
void ppmi_light_choices_init(ppmi_lights *lights);

/* What a choice may bring to a receiver, in lux before visibility (in a medium without cosines);
 * 0 only if it brings nothing. */
float ppmi_light_choice_importance(const ppmi_lights *lights, uint32_t choice,
                                   const ppmi_receiver *receiver);

/* How often each choice is made at most once, choice_count of them, up to 1. They add up to 1 or,
 * where something is known, a little more; or to 0 where no light arrives. Returns the sum. */
float ppmi_light_choice_shares(const ppmi_lights *lights, const ppmi_receiver *receiver,
                               float *out_shares);

/* Choice of an emitter among the near lights, with the depth of its cluster; choice_count for one
 * that is never drawn. */
uint32_t ppmi_light_choice_of(const ppmi_lights *lights, uint32_t emitter, uint32_t *out_depth);

#endif
