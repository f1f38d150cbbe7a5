/* In place of gltf_draco_shim.cpp in builds without Draco (PPM_WITH_DRACO=OFF). */
#include "gltf/gltf_draco_shim.h"

ppm_status ppmi_gltf_draco_create(const unsigned char *stream, size_t length, uint32_t max_faces,
                                  const char **out_reason, ppmi_gltf_draco **out_draco)
{
    (void)stream, (void)length, (void)max_faces;
    *out_draco = NULL;
    *out_reason = "not supported: this program was built without Draco";
    return PPM_STATUS_INPUT_UNSUPPORTED;
}

void ppmi_gltf_draco_destroy(ppmi_gltf_draco *draco)
{
    (void)draco;
}

uint32_t ppmi_gltf_draco_point_count(const ppmi_gltf_draco *draco)
{
    (void)draco;
    return 0;
}

uint32_t ppmi_gltf_draco_face_count(const ppmi_gltf_draco *draco)
{
    (void)draco;
    return 0;
}

void ppmi_gltf_draco_indices(const ppmi_gltf_draco *draco, uint32_t *out_indices)
{
    (void)draco, (void)out_indices;
}

bool ppmi_gltf_draco_values(const ppmi_gltf_draco *draco, int32_t id, uint32_t components,
                            double *out_values)
{
    (void)draco, (void)id, (void)components, (void)out_values;
    return false;
}
