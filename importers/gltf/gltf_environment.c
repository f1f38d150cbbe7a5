/* EXT_lights_image_based (placeholder). */
#include "gltf/gltf_light.h"
ppm_status ppmi_gltf_import_environment(ppmi_gltf_reader *reader)
{
    (void)reader;
    return PPM_STATUS_OK;
}
