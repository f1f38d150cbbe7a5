// The only file that sees Draco.
//
// Draco makes room for as many triangles and vertices as a stream claims to have before it reads
// them. So the claim is read here first and compared with what its length allows.
#include "gltf/gltf_draco_shim.h"

#include <exception>
#include <memory>
#include <new>

#include <draco/compression/decode.h>
#include <draco/core/varint_decoding.h>
#include <draco/metadata/metadata_decoder.h>

struct ppmi_gltf_draco {
    std::unique_ptr<draco::Mesh> mesh;
};

namespace
{
// The counts at the head of a mesh's stream (Draco bitstream specification, 2.2: sections "Header",
// "Metadata", "Connectivity data").
struct Claim {
    uint32_t faces = 0, vertices = 0;
};

uint16_t version(const draco::DracoHeader &header)
{
    return static_cast<uint16_t>(header.version_major << 8 | header.version_minor);
}

bool read_header(draco::DecoderBuffer *buffer, draco::DracoHeader *header)
{
    static const char magic[] = "DRACO";
    for (int i = 0; i < 5; ++i) {
        int8_t letter;
        if (!buffer->Decode(&letter) || letter != magic[i]) return false;
    }
    return buffer->Decode(&header->version_major) && buffer->Decode(&header->version_minor) &&
           buffer->Decode(&header->encoder_type) && buffer->Decode(&header->encoder_method) &&
           buffer->Decode(&header->flags);
}

bool skip_metadata(draco::DecoderBuffer *buffer)
{
    draco::MetadataDecoder decoder;
    draco::GeometryMetadata metadata;
    return decoder.DecodeGeometryMetadata(buffer, &metadata);
}

// Counts have a fixed size up to some version, and a variable one from then on.
bool read_count(draco::DecoderBuffer *buffer, bool is_variable, uint32_t *out)
{
    return is_variable ? draco::DecodeVarint(out, buffer) : buffer->Decode(out);
}

bool read_claim(const char *bytes, size_t length, Claim *out)
{
    draco::DecoderBuffer buffer;
    draco::DracoHeader header;
    buffer.Init(bytes, length);
    if (!read_header(&buffer, &header)) return false;
    const uint16_t v = version(header);
    buffer.set_bitstream_version(v);
    if (v >= 0x0103 && header.flags & METADATA_FLAG_MASK && !skip_metadata(&buffer)) return false;
    if (header.encoder_method == draco::MESH_SEQUENTIAL_ENCODING) {
        return read_count(&buffer, v >= 0x0202, &out->faces) &&
               read_count(&buffer, v >= 0x0202, &out->vertices);
    }
    uint8_t traversal;
    uint32_t new_vertices;
    if (!buffer.Decode(&traversal)) return false;
    if (v < 0x0202 && !read_count(&buffer, v >= 0x0200, &new_vertices)) return false;
    return read_count(&buffer, v >= 0x0200, &out->vertices) &&
           read_count(&buffer, v >= 0x0200, &out->faces);
}

ppm_status decode(const char *bytes, size_t length, uint32_t max_faces, const char **out_reason,
                  ppmi_gltf_draco **out)
{
    Claim claim;
    if (!read_claim(bytes, length, &claim)) {
        *out_reason = "not a Draco stream";
        return PPM_STATUS_INPUT_INVALID;
    }
    // every vertex belongs to a triangle, but for those of a stream without connectivity
    const bool is_too_much = claim.faces > max_faces || claim.vertices / 3 > max_faces;
    if (is_too_much) {
        *out_reason = "the Draco stream claims more triangles than its length allows";
        return PPM_STATUS_INPUT_INVALID;
    }
    draco::DecoderBuffer buffer;
    draco::Decoder decoder;
    buffer.Init(bytes, length);
    auto decoded = decoder.DecodeMeshFromBuffer(&buffer);
    if (!decoded.ok()) {
        *out_reason = "the Draco stream is broken, or holds no mesh";
        return PPM_STATUS_INPUT_INVALID;
    }
    auto draco = std::make_unique<ppmi_gltf_draco>();
    draco->mesh = std::move(decoded).value();
    *out = draco.release();
    return PPM_STATUS_OK;
}

// The values of one attribute, with integers that fit any of its types.
template <typename Number>
bool copy_values(const draco::PointAttribute &attribute, uint32_t points, uint32_t components,
                 double *out)
{
    Number values[4];
    for (uint32_t i = 0; i < points; ++i) {
        const draco::AttributeValueIndex value = attribute.mapped_index(draco::PointIndex(i));
        if (value.value() >= attribute.size()) return false;
        if (!attribute.ConvertValue<Number>(value, static_cast<int8_t>(components), values)) {
            return false;
        }
        for (uint32_t k = 0; k < components; ++k) {
            out[static_cast<size_t>(i) * components + k] = static_cast<double>(values[k]);
        }
    }
    return true;
}
} // namespace

ppm_status ppmi_gltf_draco_create(const unsigned char *stream, size_t length, uint32_t max_faces,
                                  const char **out_reason, ppmi_gltf_draco **out_draco)
{
    *out_reason = "";
    try {
        return decode(reinterpret_cast<const char *>(stream), length, max_faces, out_reason,
                      out_draco);
    } catch (const std::bad_alloc &) {
        return PPM_STATUS_OUT_OF_MEMORY;
    } catch (...) { // std::length_error and the like, of counts that no allocation has
        *out_reason = "the Draco stream is broken";
        return PPM_STATUS_INPUT_INVALID;
    }
}

void ppmi_gltf_draco_destroy(ppmi_gltf_draco *draco)
{
    delete draco;
}

uint32_t ppmi_gltf_draco_point_count(const ppmi_gltf_draco *draco)
{
    return draco->mesh->num_points();
}

uint32_t ppmi_gltf_draco_face_count(const ppmi_gltf_draco *draco)
{
    return draco->mesh->num_faces();
}

void ppmi_gltf_draco_indices(const ppmi_gltf_draco *draco, uint32_t *out_indices)
{
    for (uint32_t i = 0; i < draco->mesh->num_faces(); ++i) {
        const draco::Mesh::Face &face = draco->mesh->face(draco::FaceIndex(i));
        for (int k = 0; k < 3; ++k) {
            *out_indices++ = face[k].value();
        }
    }
}

bool ppmi_gltf_draco_values(const ppmi_gltf_draco *draco, int32_t id, uint32_t components,
                            double *out_values)
{
    if (id < 0 || components < 1 || components > 4) return false;
    const draco::PointAttribute *attribute =
        draco->mesh->GetAttributeByUniqueId(static_cast<uint32_t>(id));
    if (!attribute || attribute->num_components() < components) return false;
    const uint32_t points = draco->mesh->num_points();
    const draco::DataType type = attribute->data_type();
    const bool is_real = type == draco::DT_FLOAT32 || type == draco::DT_FLOAT64;
    return is_real ? copy_values<float>(*attribute, points, components, out_values)
                   : copy_values<int64_t>(*attribute, points, components, out_values);
}
