/* The render session, for other modules of the library. */
#ifndef PPMI_RENDER_H
#define PPMI_RENDER_H

#include "camera/camera.h"
#include "ppm/render.h"

ppm_context *ppmi_render_context(const ppm_render *render);
const ppm_scene *ppmi_render_scene(const ppm_render *render);

/* The camera of the whole picture, with its lens. */
const ppmi_camera_view *ppmi_render_view(const ppm_render *render);

/* "sppm", "path": the name of the integrator in use. */
const char *ppmi_render_integrator_name(const ppm_render *render);

#endif
