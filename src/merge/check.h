/* Whether files show the same, each with noise of its own. */
#ifndef PPMI_MERGE_CHECK_H
#define PPMI_MERGE_CHECK_H

#include "merge/source.h"

/* Scene, camera, options, frame, windows and layers are to be equal, seeds to differ. Returns OK,
 * INPUT_INVALID: both files and both values have been named. */
ppm_status merge_check(ppm_context *context, const merge_source *sources, size_t count);

#endif
