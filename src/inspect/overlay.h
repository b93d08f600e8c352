// SPDX-License-Identifier: MIT
/*
 * overlay.h - drawings of what cannot be seen, over a picture: the tree's
 * boxes, a path, the directions in which a surface scatters
 *
 * Units:     cameras of the frame's pixels, see projection.h
 * Threads:   any; one owner of the frame
 * Errors:    memory: overlay_boxes() draws nothing then
 */
#ifndef GLIM_OVERLAY_H
#define GLIM_OVERLAY_H

#include <stdint.h>

#include "picture/film.h"
#include "bvh/bvh.h"
#include "inspect/path_record.h"

/* More are not drawn, but the nearest of them. */
#define OVERLAY_BOXES_MAX 4096

/* The boxes of the nodes so far below the root, nearer ones brighter and over
 * the others. Returns how many nodes there are. */
uint32_t overlay_boxes(struct frame *frame, const struct camera *camera,
                       const struct bvh *bvh, uint32_t level);

/* The first `count` steps, the last of them bright. */
void overlay_trail(struct frame *frame, const struct camera *camera,
                   const struct path_record *trail, int count);

/* The normal green, the tangents red and blue, the eye's ray orange; directions
 * in the colour of their weight, as long as their density is large, or as all
 * others where they have none. */
void overlay_lobes(struct frame *frame, const struct camera *camera,
                   const struct path_record_lobes *lobes);

#endif
