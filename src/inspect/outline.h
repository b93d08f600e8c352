// SPDX-License-Identifier: MIT
/*
 * outline.h - the outline of the surfaces with one material, or of one object,
 * as the camera sees them
 *
 * A mask of the picture is found by one ray for each of its places, and kept
 * while camera, scene and selection stay. It has fewer places than a large
 * frame has pixels, since the caller waits for it.
 *
 * Ownership: outline_free() frees; a zeroed struct has no mask
 * Threads:   one
 * Errors:    without memory nothing is drawn
 */
#ifndef GLIM_OUTLINE_H
#define GLIM_OUTLINE_H

#include "image/frame.h"
#include "scene/scene.h"
#include "world/bvh/bvh8.h"

/* Places of a mask at most: rays of some ten milliseconds. */
#define OUTLINE_PLACES 20000

struct outline_choice {
    bool is_object; /* an object; else a material */
    uint32_t index;
};

struct outline {
    bool *mask;
    int width, height;
    /* what the mask was found for */
    struct camera camera;
    struct outline_choice choice;
    uint64_t version;
};

/* Finds the mask. `world` has the camera of the frame's pixels; `version`
 * changes with its triangles. */
void outline_find(struct outline *outline, const struct world *world,
                  const struct scene *scene, uint64_t version,
                  struct outline_choice choice, const struct frame *frame);

/* Draws the outline around the mask. */
void outline_draw(const struct outline *outline, struct frame *frame);

void outline_free(struct outline *outline);

#endif
