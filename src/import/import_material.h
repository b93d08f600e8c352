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
#include "import/assimp_api.h"

#if HAS_ASSIMP

/* Writes the statements of a material. Its name is made unique with `names`.
 * Images inside the file are counted in *image_count instead. */
bool import_material_write(const struct assimp_api *api,
                           const struct aiMaterial *material,
                           struct name_table *names, uint32_t *image_count,
                           FILE *to);

#endif

#endif
