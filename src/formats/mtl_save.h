// SPDX-License-Identifier: MIT
/*
 * mtl_save.h - writes what was changed of materials into the text of their file
 *
 * Only statements whose values have changed are written anew, in their place;
 * comments, order, blanks, line ends and statements that glim does not know
 * stay as they are. Of blocks with the same name the last counts, as in
 * reading. A map that is off becomes a comment, and the same comment a map when
 * it is on again.
 *
 * Units:     bytes
 * Ownership: texts that come out are for free()
 * Threads:   one thread
 * Errors:    memory; the file
 */
#ifndef GLIM_MTL_SAVE_H
#define GLIM_MTL_SAVE_H

#include "base/file.h"
#include "scene/scene.h"

struct mtl_change {
    const char *name;
    /* A new material begins as a copy of this one's block; NULL: the material
     * is in the file. */
    const char *copied_from;
    const struct mtl_source *before; /* what the file says of it */
    const struct mtl_source *after;
};

/* The text of the MTL file `path` after the changes. Maps that the text does
 * not have come from the scene's textures. */
bool mtl_rewrite(const struct scene *scene, const char *path, const char *text,
                 size_t size_bytes, const struct mtl_change *changes,
                 size_t change_count, char **new_text, size_t *new_size_bytes,
                 struct error *err);

/* Reads the file as it is now and replaces it atomically. *change says what was
 * replaced by what; what someone else writes at the same time is not. */
bool mtl_save(const struct scene *scene, const char *path,
              const struct mtl_change *changes, size_t change_count,
              struct file_change *change, struct error *err);

#endif
