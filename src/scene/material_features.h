// SPDX-License-Identifier: MIT
/*
 * material_features.h - the kernel features that a material needs
 *
 * Threads:   any
 */
#ifndef GLIM_MATERIAL_FEATURES_H
#define GLIM_MATERIAL_FEATURES_H

#include <stdbool.h>

#include "kernels/types.h"

/* Returns a set of enum feature. */
uint32_t material_features(const struct material *material,
                           const struct texture *textures);

/* Returns true if materials of these features use the tangents of vertices. */
bool features_use_tangents(uint32_t features);

#endif
