/* The acceleration structure and Embree's headers: seen by the files of this folder only. */
#ifndef PPMI_ACCEL_EMBREE_H
#define PPMI_ACCEL_EMBREE_H

#include "accel/accel.h"
#include "scene/scene.h"

#if __has_include(<embree4/rtcore.h>)
#include <embree4/rtcore.h>
#else
#include <embree3/rtcore.h>
#endif

/* Of one session. */
struct ppmi_accel {
    ppm_context *context;
    const ppm_scene *scene;
    RTCScene top;
    bool has_round; /* some instance has points or lines */
};

#endif
