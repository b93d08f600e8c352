// SPDX-License-Identifier: MIT
/*
 * import_material.h - materials of libassimp as MTL text
 *
 * Threads:   one
 * Errors:    memory, as false
 */
#ifndef GLIM_IMPORT_MATERIAL_H
#define GLIM_IMPORT_MATERIAL_H

#include <stdio.h>

#include "base/name_table.h"
#include "read/child/assimp_api.h"
#include "read/child/import_view.h"

#if HAS_ASSIMP

struct import_materials {
    const struct assimp_api *api;
    const struct aiScene *scene; /* with embedded images */
    const char *path;            /* of the scene's file */
    const struct import_source *source;
    FILE *to;
    uint32_t *clamped_count; /* materials with an impossible roughness */
};

/* Writes the statements of a material. Its name is made unique with
 * `names`. */
bool import_material_write(const struct import_materials *m,
                           const struct aiMaterial *material,
                           struct name_table *names);

#endif

#endif
