// SPDX-License-Identifier: MIT
#include "gltf/gltf.h"

#include "formats/mesh_finish.h"
#include "gltf/gltf_material.h"
#include "gltf/gltf_mesh.h"
#include "gltf/gltf_node.h"
#include "gltf/gltf_view.h"

bool gltf_parse(struct scene *scene, const char *bytes, size_t size_bytes,
                const char *path, struct warnings *report, struct error *err)
{
    struct gltf_document document = {.path = path};
    struct gltf_nodes nodes = {.count = 0};
    bool ok =
        mesh_begin(scene, path, err) &&
        gltf_document_open(&document, bytes, size_bytes, path, report, err) &&
        mesh_mtl_begin(scene, "", report, err) &&
        gltf_materials_read(&document, scene, report, err) &&
        mesh_mtl_read(scene, report, err) &&
        gltf_nodes_read(&document, &nodes, err) &&
        gltf_nodes_place(&document, NO_INDEX, &nodes, err) &&
        gltf_view_read(&document, &nodes, scene, report, err) &&
        gltf_meshes_add(&document, &nodes, scene, report, err);

    gltf_nodes_free(&nodes);
    gltf_document_close(&document);
    return ok;
}
