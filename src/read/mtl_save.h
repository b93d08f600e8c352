// SPDX-License-Identifier: MIT
/*
 * mtl_save.h - writes edited materials into the text of their MTL file
 *
 * Only statements whose values have changed are rewritten, in their place.
 * Comments, order, blanks, line ends and unknown statements stay as they are.
 * The last of several blocks with the same name counts, as in reading. A map
 * that is switched off becomes a comment; switching it on again removes the
 * comment sign.
 *
 * Units:     bytes
 * Ownership: resulting texts are for free()
 * Threads:   one thread
 * Errors:    memory; the file
 */
#ifndef GLIM_MTL_SAVE_H
#define GLIM_MTL_SAVE_H

#include "base/file.h"
#include "scene/scene.h"

struct mtl_change {
    const char *name;
    /* Name of the material whose block a new material copies; NULL if the
     * material is in the file already. */
    const char *copied_from;
    const struct material_values *before; /* the material as the file has it */
    const struct material_values *after;
};

struct mtl_changes {
    const struct mtl_change *items;
    size_t count;
};

/* Makes the text of an MTL file with the changes. The scene's textures give the
 * file names of added maps. */
bool mtl_rewrite(const struct scene *scene, const struct file_bytes *old,
                 struct mtl_changes changes, char **text, size_t *size_bytes,
                 struct error *err);

/* Reads the file as it is now, applies the changes and replaces it atomically.
 * *change tells which file was replaced by which; a file that another process
 * has changed in between is not replaced. */
bool mtl_save(const struct scene *scene, const char *path,
              struct mtl_changes changes, struct file_change *change,
              struct error *err);

#endif
