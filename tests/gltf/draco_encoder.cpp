#include "draco_encoder.h"

#include <cstring>

#include <draco/compression/expert_encode.h>
#include <draco/mesh/mesh.h>

namespace
{
void add_attribute(draco::Mesh *mesh, draco::GeometryAttribute::Type kind, draco::DataType type,
                   int components, bool normalized, const void *values, size_t count,
                   size_t stride = 0)
{
    const auto size = components * draco::DataTypeLength(type);
    if (stride == 0) stride = static_cast<size_t>(size);
    draco::GeometryAttribute attribute;
    attribute.Init(kind, nullptr, static_cast<uint8_t>(components), type, normalized, size, 0);
    const int id = mesh->AddAttribute(attribute, true, static_cast<uint32_t>(count));
    for (size_t i = 0; i < count; ++i) {
        mesh->attribute(id)->SetAttributeValue(draco::AttributeValueIndex(static_cast<uint32_t>(i)),
                                               static_cast<const unsigned char *>(values) +
                                                   i * stride);
    }
    mesh->attribute(id)->set_unique_id(static_cast<uint32_t>(id));
}

size_t encode(draco::Mesh *mesh, int method, const uint32_t *indices, size_t triangle_count,
              unsigned char *out, size_t size)
{
    for (size_t i = 0; i < triangle_count; ++i) {
        draco::Mesh::Face face;
        for (int k = 0; k < 3; ++k) {
            face[k] = draco::PointIndex(indices[3 * i + k]);
        }
        mesh->AddFace(face);
    }
    draco::ExpertEncoder encoder(*mesh);
    encoder.SetEncodingMethod(method == DRACO_SEQUENTIAL ? draco::MESH_SEQUENTIAL_ENCODING
                                                         : draco::MESH_EDGEBREAKER_ENCODING);
    draco::EncoderBuffer buffer;
    if (!encoder.EncodeToBuffer(&buffer).ok() || buffer.size() > size) return 0;
    std::memcpy(out, buffer.data(), buffer.size());
    return buffer.size();
}

draco::DataType data_type(int component)
{
    switch (component) {
    case 5120:
        return draco::DT_INT8;
    case 5121:
        return draco::DT_UINT8;
    case 5122:
        return draco::DT_INT16;
    case 5123:
        return draco::DT_UINT16;
    default:
        return draco::DT_FLOAT32;
    }
}
} // namespace

size_t draco_encode(int method, const float *positions, const uint8_t *colors,
                    const uint16_t *joints, size_t vertex_count, const uint32_t *indices,
                    size_t triangle_count, unsigned char *out, size_t size)
{
    draco::Mesh mesh;
    mesh.set_num_points(static_cast<uint32_t>(vertex_count));
    using Kind = draco::GeometryAttribute;
    add_attribute(&mesh, Kind::POSITION, draco::DT_FLOAT32, 3, false, positions, vertex_count);
    add_attribute(&mesh, Kind::COLOR, draco::DT_UINT8, 4, true, colors, vertex_count);
    add_attribute(&mesh, Kind::GENERIC, draco::DT_UINT16, 4, false, joints, vertex_count);
    return encode(&mesh, method, indices, triangle_count, out, size);
}

size_t draco_encode_columns(int method, const draco_column *columns, size_t count,
                            size_t vertex_count, const uint32_t *indices, size_t triangle_count,
                            unsigned char *out, size_t size)
{
    draco::Mesh mesh;
    mesh.set_num_points(static_cast<uint32_t>(vertex_count));
    for (size_t i = 0; i < count; ++i) {
        const draco_column &c = columns[i];
        const auto type = data_type(c.component);
        const size_t bytes = static_cast<size_t>(c.components * draco::DataTypeLength(type));
        add_attribute(
            &mesh,
            c.is_position ? draco::GeometryAttribute::POSITION : draco::GeometryAttribute::GENERIC,
            type, c.components, c.is_normalized != 0, c.values, vertex_count, (bytes + 3) / 4 * 4);
    }
    return encode(&mesh, method, indices, triangle_count, out, size);
}
