#include "draco_encoder.h"

#include <cstring>

#include <draco/compression/expert_encode.h>
#include <draco/mesh/mesh.h>

namespace
{
void add_attribute(draco::Mesh *mesh, draco::GeometryAttribute::Type kind, draco::DataType type,
                   int components, bool normalized, const void *values, size_t count)
{
    const auto size = components * draco::DataTypeLength(type);
    draco::GeometryAttribute attribute;
    attribute.Init(kind, nullptr, static_cast<uint8_t>(components), type, normalized, size, 0);
    const int id = mesh->AddAttribute(attribute, true, static_cast<uint32_t>(count));
    for (size_t i = 0; i < count; ++i) {
        mesh->attribute(id)->SetAttributeValue(draco::AttributeValueIndex(static_cast<uint32_t>(i)),
                                               static_cast<const unsigned char *>(values) +
                                                   i * static_cast<size_t>(size));
    }
    mesh->attribute(id)->set_unique_id(static_cast<uint32_t>(id));
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
    for (size_t i = 0; i < triangle_count; ++i) {
        draco::Mesh::Face face;
        for (int k = 0; k < 3; ++k) {
            face[k] = draco::PointIndex(indices[3 * i + k]);
        }
        mesh.AddFace(face);
    }
    draco::ExpertEncoder encoder(mesh);
    encoder.SetEncodingMethod(method == DRACO_SEQUENTIAL ? draco::MESH_SEQUENTIAL_ENCODING
                                                         : draco::MESH_EDGEBREAKER_ENCODING);
    draco::EncoderBuffer buffer;
    if (!encoder.EncodeToBuffer(&buffer).ok() || buffer.size() > size) return 0;
    std::memcpy(out, buffer.data(), buffer.size());
    return buffer.size();
}
