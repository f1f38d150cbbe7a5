/* Closed solids that are inside out. */
#ifndef PPMI_SCENE_ORIENT_H
#define PPMI_SCENE_ORIENT_H

#include "scene/scene.h"

/* Turns the triangles of solid materials in shells of a mesh that are closed (their edges fit, up
 * to coincident vertices), wound one way, and inside out: of negative volume, and neither inside of
 * another shell of the mesh nor of a solid of another mesh; and with such a shell all that are
 * inside of it, so that its cavities stay cavities. Open surfaces and all else stay as they are.
 *
 * For all meshes of an open scene whose vertices or materials have changed since the last call, in
 * time that is linear in each, beside the search of solids around what is inside out. *out_meshes:
 * how many of them have such shells. Returns OK, OUT_OF_MEMORY. */
ppm_status ppmi_scene_orient(ppm_scene *scene, uint32_t *out_meshes);

#endif
