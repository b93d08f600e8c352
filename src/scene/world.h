// SPDX-License-Identifier: MIT
/*
 * world.h - a scene as a view sees it: what samples read
 *
 * Units:     the view's are the file's, the world's normalised
 * Ownership: a world borrows the scene's arrays
 * Threads:   one, while nobody renders the scene
 * Errors:    impossible cameras; memory
 */
#ifndef GLIM_WORLD_H
#define GLIM_WORLD_H

#include "scene/scene.h"

/* Makes the table that leads paths to light that is hard to find, if there is
 * none yet for the scene as it is and the view's sky. Without it pictures are
 * as bright, and noisier. So many threads make it, and the scene's tree for it
 * if there is none yet. */
bool scene_guide(struct scene *scene, const struct view *view, int thread_count,
                 struct error *err);

/* Sets eye and at so that the whole scene is seen, keeping fovy, size and up.
 */
void scene_frame(const struct scene *scene, struct view *view);

/* Fills all of *world but nodes and leaf_tris. False for an impossible camera.
 */
bool scene_world(const struct scene *scene, const struct view *view,
                 uint32_t seed, struct world *world, struct error *err);

#endif
