// SPDX-License-Identifier: MIT
/*
 * models.h - the models in glTF, each with a view file beside it
 *
 * Threads:   one
 * Errors:    stop the program with a message
 */
#ifndef SCENES_MODELS_H
#define SCENES_MODELS_H

/* Pieces on a board: meshes that nodes share, a texture of 2x2 pixels that is
 * repeated, clearcoat. */
void model_chess(const char *folder);

/* Bottles of coloured glass: transmission and volume, spot lights. */
void model_bottles(const char *folder);

/* Soap: iridescence whose thickness has a texture. */
void model_bubbles(const char *folder);

/* A knot of brushed metal on velvet: anisotropy, sheen. */
void model_knot(const char *folder);

/* Trees: instances of EXT_mesh_gpu_instancing. */
void model_forest(const char *folder);

/* A jellyfish: skins, morph targets, an animation, emissive textures. */
void model_jellyfish(const char *folder);

#endif
