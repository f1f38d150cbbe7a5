/* Meshes by calls: quads, boxes, spheres. */
#ifndef TEST_SUPPORT_SHAPES_H
#define TEST_SUPPORT_SHAPES_H

#include "math/vec.h"
#include "ppm/scene.h"

/* A parallelogram; its front is the side of cross(edge_u, edge_v). Texture coordinates run from
 * (0, 0) at origin along the edges. */
ppm_mesh_id shape_quad(ppm_scene *scene, ppm_material_id material, ppmi_vec3 origin,
                       ppmi_vec3 edge_u, ppmi_vec3 edge_v);

/* A closed box of 12 * steps^2 triangles; its front is outside unless inward. */
ppm_mesh_id shape_box(ppm_scene *scene, ppm_material_id material, ppmi_vec3 low, ppmi_vec3 high,
                      uint32_t steps, bool inward);

/* A closed ball around the origin of 4 * rings^2 triangles, with smooth normals or without. */
ppm_mesh_id shape_sphere(ppm_scene *scene, ppm_material_id material, float radius, uint32_t rings,
                         bool smooth);

/* Any triangles, one primitive. */
ppm_mesh_id shape_mesh(ppm_scene *scene, const ppm_primitive_desc *primitive);

/* Puts a mesh into the scene: at its own coordinates, moved, or by a matrix. */
ppm_instance_id shape_place(ppm_scene *scene, ppm_mesh_id mesh);
ppm_instance_id shape_place_at(ppm_scene *scene, ppm_mesh_id mesh, ppmi_vec3 position);
ppm_instance_id shape_place_by(ppm_scene *scene, ppm_mesh_id mesh, const float transform[16]);

/* A quad that is placed at once. */
void add_quad(ppm_scene *scene, ppm_material_id material, ppmi_vec3 origin, ppmi_vec3 edge_u,
              ppmi_vec3 edge_v);

/* The square from -1 to 1 in the plane z = 0, facing +z, with normals, placed at once. Texture
 * coordinates run from (0, 0) at the upper left, v down, and then through m (as uv_transform in
 * ppm_texture; NULL: not). Tangents are +x where wanted. */
void shape_add_board(ppm_scene *scene, const ppm_material_desc *desc, const float m[6],
                     bool has_tangents);

#endif
