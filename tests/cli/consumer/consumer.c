/* A host program at its smallest: prints the library's version. */
#include <stdio.h>

#include <ppm/ppm.h>

int main(void)
{
    ppm_context *context = NULL;
    ppm_scene *scene = NULL;
    ppm_status status = ppm_context_create(NULL, &context);
    if (status == PPM_STATUS_OK) status = ppm_scene_create(context, NULL, &scene);
    if (status == PPM_STATUS_OK) puts(ppm_version());
    ppm_scene_destroy(scene);
    ppm_context_destroy(context);
    return status == PPM_STATUS_OK ? 0 : 1;
}
