// SPDX-License-Identifier: MIT
/*
 * mesh_finish.h - completes the scenes of files without MTL files
 *
 * An MTL file beside the scene, such as model.ply.mtl for model.ply, may define
 * their materials anew; glim writes edits there. All faces of PLY and STL files
 * have the material "clay", those of OBJ files without MTL files "material" or
 * the names that they use.
 *
 * Ownership: everything belongs to the scene
 * Threads:   one for each scene
 * Errors:    memory; those of the MTL file
 */
#ifndef GLIM_MESH_FINISH_H
#define GLIM_MESH_FINISH_H

#include "base/lexer.h"
#include "scene/scene.h"

/* Number of the material of all faces. */
#define MESH_MATERIAL 1u

/* Begins a model: sets the scene's path and adds the object of all faces, named
 * "". */
bool mesh_begin(struct scene *scene, const char *path, struct error *err);

/* Adds normals that are smooth below a crease if the scene has none. */
bool mesh_add_normals(struct scene *scene, struct error *err);

/* Returns sRGB clay: the colour of faces and vertices that have none in a file
 * with colours. */
struct vec3 mesh_clay(void);

/* Names the MTL file beside the scene, which the materials of the text are
 * taken to be from; then reads the file, if it is there. */
bool mesh_mtl_begin(struct scene *scene, const char *text,
                    struct warnings *report, struct error *err);
bool mesh_mtl_read(struct scene *scene, struct warnings *report,
                   struct error *err);

/* Image files of a mesh. "<this>" in a name stands for that of the scene file,
 * without its ending. Faces have the material MESH_MATERIAL plus the number of
 * their image, and behind the last one, with has_plain, that without an
 * image. */
struct mesh_textures {
    const struct word *names;
    uint32_t count;
    bool has_plain;
};

/* Adds the materials, smooth normals if there are none, and the linear colours
 * of faces, if face_colors is not NULL, to the vertices: those with several
 * colours are doubled. */
bool mesh_finish(struct scene *scene, const struct vec3 *face_colors,
                 const struct mesh_textures *textures, struct warnings *report,
                 struct error *err);

#endif
