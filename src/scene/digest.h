/* Digests of what is rendered, for headers of pictures. */
#ifndef PPMI_SCENE_DIGEST_H
#define PPMI_SCENE_DIGEST_H

#include "base/digest.h"
#include "scene/scene.h"

/* All of a frozen scene but its cameras: shapes, materials, images, lights, and names, which
 * Cryptomattes show. */
void ppmi_scene_digest(const ppm_scene *scene, ppmi_digest *digest);

/* Of one camera, without its name. */
void ppmi_camera_digest(const ppmi_camera *camera, ppmi_digest *digest);

#endif
