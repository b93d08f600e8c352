// SPDX-License-Identifier: MIT
/*
 * What a copy of the program answers after libdraco has read hostile bytes may
 * be any bytes: they give a scene that can be rendered, or one line.
 */
#include "fuzz_tris.h"
#include "read/gltf/gltf_draco.h"
#include "read/gltf/gltf_material.h"
#include "read/gltf/gltf_mesh.h"
#include "read/mesh_finish.h"

/* Two packed primitives: one with all attributes, some of them sparse, and a
 * strip. */
static const char model[] =
    "{\"asset\":{\"version\":\"2.0\"},\"nodes\":[{\"mesh\":0}],\"accessors\":["
    "{\"componentType\":5126,\"count\":3,\"type\":\"VEC3\"},"
    "{\"componentType\":5121,\"count\":3,\"type\":\"VEC4\","
    "\"normalized\":true,\"sparse\":{\"count\":1,\"indices\":{\"bufferView\":0,"
    "\"componentType\":5121},\"values\":{\"bufferView\":0}}}],"
    "\"bufferViews\":[{\"buffer\":0,\"byteLength\":4}],"
    "\"buffers\":[{\"byteLength\":4,\"uri\":\"data:;base64,AAECAw==\"}],"
    "\"meshes\":[{\"primitives\":[{\"attributes\":{\"POSITION\":0,"
    "\"NORMAL\":0,\"TEXCOORD_0\":0,\"COLOR_0\":1,\"JOINTS_0\":1,"
    "\"WEIGHTS_0\":1},\"extensions\":{\"KHR_draco_mesh_compression\":{"
    "\"bufferView\":0,\"attributes\":{\"POSITION\":0,\"NORMAL\":1,"
    "\"TEXCOORD_0\":2,\"COLOR_0\":3,\"JOINTS_0\":4,\"WEIGHTS_0\":5}}}},"
    "{\"mode\":5,\"attributes\":{\"POSITION\":0},\"indices\":0,"
    "\"extensions\":{\"KHR_draco_mesh_compression\":{\"bufferView\":0,"
    "\"attributes\":{\"POSITION\":0}}}}]}]}";

static bool parse_answers(struct scene *scene, const char *bytes,
                          size_t size_bytes, const char *path,
                          struct warnings *report, struct error *err)
{
    struct gltf_document document = {.path = path};
    struct gltf_nodes nodes = {.count = 0};
    bool ok = mesh_begin(scene, path, err) &&
              gltf_document_open(&document, model, strlen(model), path, report,
                                 err) &&
              gltf_draco_take(&document, bytes, size_bytes, "no end", err) &&
              mesh_mtl_begin(scene, "", report, err) &&
              gltf_materials_read(&document, scene, report, err) &&
              mesh_mtl_read(scene, report, err) &&
              gltf_nodes_read(&document, &nodes, err) &&
              gltf_nodes_place(&document, NO_INDEX, &nodes, err) &&
              gltf_meshes_add(&document, &nodes, scene, report, err);

    gltf_nodes_free(&nodes);
    gltf_document_close(&document);
    return ok;
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    fuzz_check_scene(parse_answers, "none/fuzz.gltf", data, size);
    return 0;
}
