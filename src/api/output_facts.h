/* What the header of a scene-linear picture says of the camera, and of what was rendered. */
#ifndef PPMI_API_OUTPUT_FACTS_H
#define PPMI_API_OUTPUT_FACTS_H

#include "api/output_header.h"
#include "base/digest.h"

/* What the attributes point to: must outlive the header's use, and not move. */
typedef struct ppmi_output_facts {
    float world_to_camera[16], world_to_ndc[16]; /* for row vectors */
    float window_center[2], window_width;
    float focal_length_mm, sensor_mm, f_number, focus_distance_m;
    float seconds;
    char crypto_names[3][4][48]; /* of the attributes of each Cryptomatte */
    char scene[PPMI_DIGEST_TEXT_SIZE], view[PPMI_DIGEST_TEXT_SIZE];
} ppmi_output_facts;

/* Adds OpenEXR's standard attributes of a camera (worldToCamera, worldToNDC, screenWindowCenter,
 * screenWindowWidth, nominalFocalLength, aperture, focus), the digests ppm:sceneDigest and
 * ppm:cameraDigest, and ppm:seconds. */
void ppmi_output_header_add_facts(ppmi_output_header *header, const ppm_render *render,
                                  ppmi_output_facts *facts);

/* Adds what Cryptomatte 1.2 asks for: cryptomatte/KEY/name, hash, conversion and manifest. facts
 * has been filled in. */
void ppmi_output_header_add_mattes(ppmi_output_header *header, const ppm_render *render,
                                   ppmi_output_facts *facts);

#endif
