/* Closed solids that are inside out. */
#ifndef PPMI_SCENE_ORIENT_H
#define PPMI_SCENE_ORIENT_H

#include "scene/scene.h"

/* Turns the triangles of solid materials in shells of a mesh that are closed (their edges fit, up
 * to coincident vertices), wound one way, and inside out: of negative volume, and not inside of
 * another shell of the mesh; and with such a shell all that are inside of it, so that its cavities
 * stay cavities. Open surfaces and all else stay as they are. Counts what it turned in
 * mesh->turned_count. In time that is linear in the mesh. Returns OK, OUT_OF_MEMORY. */
ppm_status ppmi_mesh_orient(const ppm_scene *scene, ppmi_mesh *mesh);

/* The same for all meshes whose vertices, or materials, have changed since. */
ppm_status ppmi_scene_orient(ppm_scene *scene);

#endif
