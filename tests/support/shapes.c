/* Meshes by calls. */
#include "support/shapes.h"

#include <setjmp.h>
#include <stdarg.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

ppm_mesh_id shape_mesh(ppm_scene *scene, const ppm_primitive_desc *primitive)
{
    const ppm_mesh_desc desc = {
        .size = sizeof desc, .name = "shape", .primitive_count = 1, .primitives = primitive};
    ppm_mesh_id id = 0;
    assert_int_equal(ppm_scene_add_mesh(scene, &desc, &id), PPM_STATUS_OK);
    return id;
}

ppm_mesh_id shape_quad(ppm_scene *scene, ppm_material_id material, ppmi_vec3 origin,
                       ppmi_vec3 edge_u, ppmi_vec3 edge_v)
{
    static const float uvs[8] = {0.0f, 0.0f, 1.0f, 0.0f, 1.0f, 1.0f, 0.0f, 1.0f};
    static const uint32_t indices[6] = {0, 1, 2, 0, 2, 3};
    float positions[12];
    vec3_store(positions, origin);
    vec3_store(positions + 3, vec3_add(origin, edge_u));
    vec3_store(positions + 6, vec3_add(vec3_add(origin, edge_u), edge_v));
    vec3_store(positions + 9, vec3_add(origin, edge_v));
    const ppm_primitive_desc primitive = {.vertex_count = 4,
                                          .triangle_count = 2,
                                          .positions = positions,
                                          .uvs = {uvs},
                                          .indices = indices,
                                          .material = material};
    return shape_mesh(scene, &primitive);
}

/* One face of the box as a grid of its own vertices: axis is its normal, side 0 or 1. */
static uint32_t box_face(ppmi_vec3 low, ppmi_vec3 high, uint32_t axis, uint32_t side,
                         uint32_t steps, bool inward, uint32_t first, float *positions,
                         uint32_t *indices)
{
    const float lows[3] = {low.x, low.y, low.z}, highs[3] = {high.x, high.y, high.z};
    const uint32_t u = (axis + 1) % 3, v = (axis + 2) % 3;
    for (uint32_t j = 0; j <= steps; j++) {
        for (uint32_t i = 0; i <= steps; i++) {
            float *p = positions + 3 * (first + j * (steps + 1) + i);
            const float tu = (float)i / (float)steps, tv = (float)j / (float)steps;
            p[axis] = side ? highs[axis] : lows[axis];
            p[u] = lows[u] * (1.0f - tu) + highs[u] * tu;
            p[v] = lows[v] * (1.0f - tv) + highs[v] * tv;
        }
    }
    const bool flip = (side == 0) != inward;
    uint32_t count = 0;
    for (uint32_t j = 0; j < steps; j++) {
        for (uint32_t i = 0; i < steps; i++) {
            const uint32_t a = first + j * (steps + 1) + i, b = a + 1, c = b + steps + 1, d = c - 1;
            const uint32_t two[6] = {a, flip ? c : b, flip ? b : c, a, flip ? d : c, flip ? c : d};
            memcpy(indices + count, two, sizeof two);
            count += 6;
        }
    }
    return count;
}

ppm_mesh_id shape_box(ppm_scene *scene, ppm_material_id material, ppmi_vec3 low, ppmi_vec3 high,
                      uint32_t steps, bool inward)
{
    const uint32_t face_vertices = (steps + 1) * (steps + 1);
    float *positions = malloc(6 * 3 * (size_t)face_vertices * sizeof *positions);
    uint32_t *indices = malloc(36 * (size_t)steps * steps * sizeof *indices);
    assert_non_null(positions);
    assert_non_null(indices);
    uint32_t count = 0;
    for (uint32_t face = 0; face < 6; face++) {
        count += box_face(low, high, face / 2, face % 2, steps, inward, face * face_vertices,
                          positions, indices + count);
    }
    const ppm_primitive_desc primitive = {.vertex_count = 6 * face_vertices,
                                          .triangle_count = count / 3,
                                          .positions = positions,
                                          .indices = indices,
                                          .material = material};
    const ppm_mesh_id id = shape_mesh(scene, &primitive);
    free(positions);
    free(indices);
    return id;
}

ppm_mesh_id shape_sphere(ppm_scene *scene, ppm_material_id material, float radius, uint32_t rings,
                         bool smooth)
{
    const uint32_t columns = 2 * rings, vertices = (rings + 1) * columns;
    float *normals = malloc(3 * (size_t)vertices * sizeof *normals);
    float *positions = malloc(3 * (size_t)vertices * sizeof *positions);
    uint32_t *indices = malloc(6 * (size_t)rings * columns * sizeof *indices);
    assert_non_null(normals);
    assert_non_null(positions);
    assert_non_null(indices);
    uint32_t count = 0;
    for (uint32_t r = 0; r <= rings; r++) {
        const double theta = M_PI * r / rings;
        for (uint32_t c = 0; c < columns; c++) {
            const double phi = 2.0 * M_PI * c / columns;
            const bool is_pole = r == 0 || r == rings;
            const ppmi_vec3 n =
                vec3(is_pole ? 0.0f : (float)(sin(theta) * cos(phi)), (float)cos(theta),
                     is_pole ? 0.0f : (float)(sin(theta) * sin(phi)));
            vec3_store(normals + 3 * (r * columns + c), n);
            vec3_store(positions + 3 * (r * columns + c), vec3_scale(n, radius));
            if (r == rings) continue;
            const uint32_t next = (c + 1) % columns;
            const uint32_t a = r * columns + c, b = r * columns + next;
            const uint32_t d = a + columns, e = b + columns;
            const uint32_t two[6] = {a, b, e, a, e, d};
            memcpy(indices + count, two, sizeof two);
            count += 6;
        }
    }
    const ppm_primitive_desc primitive = {.vertex_count = vertices,
                                          .triangle_count = count / 3,
                                          .positions = positions,
                                          .normals = smooth ? normals : NULL,
                                          .indices = indices,
                                          .material = material};
    const ppm_mesh_id id = shape_mesh(scene, &primitive);
    free(normals);
    free(positions);
    free(indices);
    return id;
}

ppm_instance_id shape_place_by(ppm_scene *scene, ppm_mesh_id mesh, const float transform[16])
{
    ppm_instance_desc desc = {.size = sizeof desc, .name = "shape", .mesh = mesh};
    memcpy(desc.transform, transform, sizeof desc.transform);
    ppm_instance_id id = 0;
    assert_int_equal(ppm_scene_add_instance(scene, &desc, &id), PPM_STATUS_OK);
    return id;
}

ppm_instance_id shape_place_at(ppm_scene *scene, ppm_mesh_id mesh, ppmi_vec3 p)
{
    const float transform[16] = {1.0f, 0.0f, 0.0f, 0.0f, 0.0f, 1.0f, 0.0f, 0.0f,
                                 0.0f, 0.0f, 1.0f, 0.0f, p.x,  p.y,  p.z,  1.0f};
    return shape_place_by(scene, mesh, transform);
}

ppm_instance_id shape_place(ppm_scene *scene, ppm_mesh_id mesh)
{
    return shape_place_at(scene, mesh, vec3(0.0f, 0.0f, 0.0f));
}

void add_quad(ppm_scene *scene, ppm_material_id material, ppmi_vec3 origin, ppmi_vec3 edge_u,
              ppmi_vec3 edge_v)
{
    shape_place(scene, shape_quad(scene, material, origin, edge_u, edge_v));
}

void shape_add_board(ppm_scene *scene, const ppm_material_desc *desc, const float m[6],
                     bool has_tangents)
{
    static const float positions[12] = {-1, -1, 0, 1, -1, 0, 1, 1, 0, -1, 1, 0};
    static const float normals[12] = {0, 0, 1, 0, 0, 1, 0, 0, 1, 0, 0, 1};
    static const float tangents[16] = {1, 0, 0, 1, 1, 0, 0, 1, 1, 0, 0, 1, 1, 0, 0, 1};
    static const uint32_t indices[6] = {0, 1, 2, 0, 2, 3};
    float uvs[8] = {0, 1, 1, 1, 1, 0, 0, 0};
    for (int i = 0; i < 4 && m; i++) {
        const float u = uvs[2 * i], v = uvs[2 * i + 1];
        uvs[2 * i] = m[0] * u + m[1] * v + m[2];
        uvs[2 * i + 1] = m[3] * u + m[4] * v + m[5];
    }
    ppm_primitive_desc primitive = {.vertex_count = 4,
                                    .triangle_count = 2,
                                    .positions = positions,
                                    .normals = normals,
                                    .tangents = has_tangents ? tangents : NULL,
                                    .uvs = {uvs},
                                    .indices = indices};
    assert_int_equal(ppm_scene_add_material(scene, desc, &primitive.material), PPM_STATUS_OK);
    shape_place(scene, shape_mesh(scene, &primitive));
}
