// SPDX-License-Identifier: MIT
#include "tests/unit/gltf/draco_encode.h"

#include <cstdlib>
#include <cstring>
#include <string>

#include <draco/compression/encode.h>
#include <draco/compression/expert_encode.h>

static draco::DataType type_of(uint32_t component)
{
    switch (component) {
    case 5120: return draco::DT_INT8;
    case 5121: return draco::DT_UINT8;
    case 5122: return draco::DT_INT16;
    case 5123: return draco::DT_UINT16;
    case 5125: return draco::DT_UINT32;
    default: return draco::DT_FLOAT32;
    }
}

static draco::GeometryAttribute::Type kind_of(const std::string &name)
{
    return name == "POSITION" ? draco::GeometryAttribute::POSITION
           : name == "NORMAL" ? draco::GeometryAttribute::NORMAL
           : name.compare(0, 5, "COLOR") == 0 ? draco::GeometryAttribute::COLOR
           : name.compare(0, 5, "TEXCO") == 0
               ? draco::GeometryAttribute::TEX_COORD
               : draco::GeometryAttribute::GENERIC;
}

static void add_attribute(draco::PointCloud *mesh, uint32_t vertex_count,
                          const draco_source_attribute &a)
{
    draco::GeometryAttribute g;
    draco::DataType type = type_of(a.component);
    size_t element_bytes =
        a.component_count * static_cast<size_t>(draco::DataTypeLength(type));
    const char *data = static_cast<const char *>(a.data);

    g.Init(kind_of(a.name), nullptr, static_cast<uint8_t>(a.component_count),
           type, a.is_normalized, static_cast<int64_t>(element_bytes), 0);
    int number = mesh->AddAttribute(g, true, vertex_count);
    for (uint32_t i = 0; i < vertex_count; i++)
        mesh->attribute(number)->SetAttributeValue(draco::AttributeValueIndex(
                                                       i),
                                                   data + i * element_bytes);
    mesh->attribute(number)->set_unique_id(a.id);
}

void *draco_encode(const draco_source *source, size_t *size_bytes)
{
    draco::Mesh mesh;
    draco::EncoderBuffer buffer;

    mesh.set_num_points(source->vertex_count);
    for (uint32_t i = 0; i < source->attribute_count; i++)
        add_attribute(&mesh, source->vertex_count, source->attributes[i]);
    for (uint32_t i = 0; i < source->tri_count; i++) {
        const uint32_t *v = source->indices + 3 * i;

        mesh.AddFace({draco::PointIndex(v[0]), draco::PointIndex(v[1]),
                      draco::PointIndex(v[2])});
    }
    if (source->is_cloud) {
        draco::Encoder encoder;

        if (!encoder
                 .EncodePointCloudToBuffer(
                     static_cast<draco::PointCloud &>(mesh), &buffer)
                 .ok())
            return nullptr;
    } else {
        draco::ExpertEncoder encoder(mesh);

        encoder.SetEncodingMethod(source->is_sequential
                                      ? draco::MESH_SEQUENTIAL_ENCODING
                                      : draco::MESH_EDGEBREAKER_ENCODING);
        if (!encoder.EncodeToBuffer(&buffer).ok())
            return nullptr;
    }
    *size_bytes = buffer.size();
    void *bytes = malloc(buffer.size());
    memcpy(bytes, buffer.data(), buffer.size());
    return bytes;
}
