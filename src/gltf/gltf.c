// SPDX-License-Identifier: MIT
#include "gltf/gltf.h"

#include <stdlib.h>

#include "base/memory.h"
#include "formats/mesh_finish.h"
#include "gltf/gltf_animation.h"
#include "gltf/gltf_draco.h"
#include "gltf/gltf_material.h"
#include "gltf/gltf_mesh.h"
#include "gltf/gltf_node.h"
#include "gltf/gltf_view.h"

/* Reads the nodes, poses them and lists those of the chosen scene. */
static bool place_nodes(const struct gltf_document *document,
                        const struct scene_choice *choice,
                        struct gltf_nodes *nodes, struct error *err)
{
    uint32_t scene = NO_INDEX, animation = 0;
    bool is_animated = choice->has_time || choice->animation != NULL;

    if (choice->scene != NULL &&
        !gltf_find(document, "scenes", "scene", choice->scene, &scene, err))
        return false;
    if (is_animated &&
        !gltf_find(document, "animations", "animation",
                   choice->animation != NULL ? choice->animation : "1",
                   &animation, err))
        return false;
    return gltf_nodes_read(document, nodes, err) &&
           (!is_animated || gltf_animation_pose(document, animation,
                                                choice->time_s, nodes, err)) &&
           gltf_nodes_place(document, scene, nodes, err);
}

/* Gives the scene the names of the files of its buffers. */
static bool take_paths(struct gltf_document *document, struct scene *scene,
                       struct error *err)
{
    scene->data_paths =
        alloc_array(document->file_count, sizeof *scene->data_paths);
    if (scene->data_paths == NULL)
        return fail(err, "%s: out of memory for its buffers", scene->path);
    for (size_t i = 0; i < document->file_count; i++) {
        scene->data_paths[scene->data_path_count++] = document->files[i].path;
        document->files[i].path = NULL;
    }
    return true;
}

static bool hint(const struct gltf_document *document,
                 const struct scene *scene, struct warnings *report)
{
    gltf_materials_hint(document, scene, report);
    return true;
}

bool gltf_parse(struct scene *scene, const char *bytes, size_t size_bytes,
                const char *path, struct warnings *report, struct error *err)
{
    struct gltf_document document = {.path = path, .memory = &scene->memory};
    struct gltf_nodes nodes = {.count = 0};
    bool ok =
        mesh_begin(scene, path, err) &&
        gltf_document_open(&document, bytes, size_bytes, path, report, err) &&
        take_paths(&document, scene, err) &&
        gltf_draco_unpack(&document, scene->program, err) &&
        mesh_mtl_begin(scene, "", report, err) &&
        gltf_materials_read(&document, scene, report, err) &&
        mesh_mtl_read(scene, report, err) && hint(&document, scene, report) &&
        place_nodes(&document, &scene->choice, &nodes, err) &&
        gltf_view_read(&document, &nodes, scene, report, err) &&
        gltf_meshes_add(&document, &nodes, scene, report, err);

    gltf_nodes_free(&nodes);
    gltf_document_close(&document);
    return ok;
}
