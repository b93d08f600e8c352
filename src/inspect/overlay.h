// SPDX-License-Identifier: MIT
/*
 * overlay.h - drawings over a picture: boxes of the tree, a path, directions
 * of scattering
 *
 * Units:     cameras of the frame's pixels, see projection.h
 * Threads:   any; the caller owns the frame
 * Errors:    overlay_boxes() draws nothing if memory is out
 */
#ifndef GLIM_OVERLAY_H
#define GLIM_OVERLAY_H

#include <stdint.h>

#include "picture/frame.h"
#include "bvh/bvh.h"
#include "inspect/path_record.h"

/* Most boxes that are drawn; the nearest are chosen. */
#define OVERLAY_BOXES_MAX 4096

/* Draws the boxes of all nodes at this level below the root. Near ones are
 * brighter and cover far ones. Returns the number of nodes. */
uint32_t overlay_boxes(struct frame *frame, const struct camera *camera,
                       const struct bvh *bvh, uint32_t level);

/* Draws the first `count` steps of a path, the last of them bright. What is
 * behind surfaces of the world is dashed; NULL: nothing is. The world has a
 * binary tree. */
void overlay_path(struct frame *frame, const struct camera *camera,
                  const struct world *world, const struct path_record *path,
                  int count);

/* Draws the frame of a surface (normal green, tangents red and blue), the ray
 * to the eye in orange, and directions of scattering. The colour of a direction
 * is its weight and its length the density; directions of a delta distribution
 * have equal lengths. */
void overlay_lobes(struct frame *frame, const struct camera *camera,
                   const struct path_record_lobes *lobes);

#endif
