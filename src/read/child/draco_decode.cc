// SPDX-License-Identifier: MIT
#include "read/child/draco_decode.h"

#include <cstring>
#include <memory>
#include <new>
#include <string>
#include <vector>

#include <draco/compression/decode.h>

#include "read/gltf/draco_stream.h"

namespace
{

/* The componentType of glTF for a type of Draco, or 0. */
uint32_t component_of(draco::DataType type)
{
    switch (type) {
    case draco::DT_INT8: return 5120;
    case draco::DT_UINT8: return 5121;
    case draco::DT_INT16: return 5122;
    case draco::DT_UINT16: return 5123;
    case draco::DT_UINT32: return 5125;
    case draco::DT_FLOAT32: return 5126;
    default: return 0;
    }
}

/* A mesh that was unpacked, as it is sent. */
struct answer {
    draco_answer head = {};
    std::vector<char> bytes; /* behind the head */

    void append(const void *from, size_t size_bytes)
    {
        const char *p = static_cast<const char *>(from);

        bytes.insert(bytes.end(), p, p + size_bytes);
    }
};

/* Appends an attribute. Returns the reason of a failure, or "". */
std::string add_attribute(const draco::Mesh &mesh, uint32_t id, answer *to)
{
    const draco::PointAttribute *a = mesh.GetAttributeByUniqueId(id);
    draco_attribute head = {};
    size_t element_bytes;

    if (a == nullptr)
        return "found no attribute " + std::to_string(id);
    head.component = component_of(a->data_type());
    head.component_count = a->num_components();
    if (head.component == 0 || head.component_count < 1 ||
        head.component_count > 4)
        return "found " + std::to_string(head.component_count) +
               " numbers of type " + std::to_string(a->data_type()) +
               " in attribute " + std::to_string(id);
    to->append(&head, sizeof head);
    element_bytes = head.component_count *
                    static_cast<size_t>(draco::DataTypeLength(a->data_type()));
    for (draco::PointIndex i(0); i < mesh.num_points(); ++i) {
        int64_t at = a->GetBytePos(a->mapped_index(i));

        if (at < 0 ||
            at + element_bytes > static_cast<size_t>(a->buffer()->data_size()))
            return "found no value of attribute " + std::to_string(id) +
                   " at vertex " + std::to_string(i.value());
        to->append(a->buffer()->data() + at, element_bytes);
    }
    to->bytes.resize((to->bytes.size() + 3) / 4 * 4);
    return "";
}

void add_faces(const draco::Mesh &mesh, answer *to)
{
    for (draco::FaceIndex i(0); i < mesh.num_faces(); ++i)
        for (int k = 0; k < 3; k++) {
            uint32_t vertex = mesh.face(i)[k].value();

            to->append(&vertex, sizeof vertex);
        }
}

std::string unpack(const draco_request &request, const char *ids,
                   const char *packed, answer *to)
{
    draco::DecoderBuffer buffer;
    draco::Decoder decoder;
    std::string failure;

    buffer.Init(packed, request.size_bytes);
    auto type = draco::Decoder::GetEncodedGeometryType(&buffer);
    if (!type.ok())
        return type.status().error_msg_string();
    if (type.value() != draco::TRIANGULAR_MESH)
        return "found points, expected triangles";
    auto result = decoder.DecodeMeshFromBuffer(&buffer);
    if (!result.ok())
        return result.status().error_msg_string();
    std::unique_ptr<draco::Mesh> mesh = std::move(result).value();
    to->head.vertex_count = mesh->num_points();
    to->head.tri_count = mesh->num_faces();
    for (uint32_t i = 0; failure.empty() && i < request.attribute_count; i++) {
        uint32_t id;

        memcpy(&id, ids + i * sizeof id, sizeof id);
        failure = add_attribute(*mesh, id, to);
    }
    add_faces(*mesh, to);
    return failure;
}

/* Answers a request. Returns false after a failure. */
bool answer_one(const draco_request &request, const char *ids,
                const char *packed, FILE *to)
{
    answer a;
    std::string failure;

    try {
        failure = unpack(request, ids, packed, &a);
    } catch (const std::exception &e) {
        failure = e.what();
    }
    if (!failure.empty()) {
        a.bytes.clear();
        strncpy(a.head.failure, failure.c_str(), sizeof a.head.failure - 1);
    }
    fwrite(&a.head, sizeof a.head, 1, to);
    fwrite(a.bytes.data(), 1, a.bytes.size(), to);
    fflush(to);
    return failure.empty();
}

} // namespace

bool draco_decode(const char *requests, size_t size_bytes, FILE *to)
{
    draco_request request;

    while (size_bytes >= sizeof request) {
        memcpy(&request, requests, sizeof request);
        requests += sizeof request;
        size_bytes -= sizeof request;

        uint64_t id_bytes =
            sizeof(uint32_t) * uint64_t{request.attribute_count};
        const char *packed = requests + id_bytes;

        if (id_bytes > size_bytes || request.size_bytes > size_bytes - id_bytes)
            break;
        if (!answer_one(request, requests, packed, to))
            break;
        requests = packed + request.size_bytes;
        size_bytes -= id_bytes + request.size_bytes;
    }
    return true;
}
