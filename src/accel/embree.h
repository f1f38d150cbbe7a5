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
    RTCScene solid; /* instances of meshes that are not clear glass only; top where all are */
    bool has_round; /* some instance has points or lines */
};

/* Glass through and through: no photon stays on it. */
static inline bool ppmi_accel_is_clear(const ppmi_material *material)
{
    const ppm_material_desc *desc = &material->desc;
    return desc->transmission > 0.99f && desc->transmission_texture.image == 0 &&
           desc->metallic == 0.0f && desc->diffuse_transmission == 0.0f;
}

#endif
