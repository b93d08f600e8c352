// SPDX-License-Identifier: MIT
/*
 * overlay.h - drawings over a picture: boxes of the tree, a path, directions of
 * scattering; and their tables
 *
 * Units:     cameras of the frame's pixels, see projection.h; file units,
 *            radiance, densities per solid angle
 * Threads:   any; the caller owns the frame
 * Errors:    overlay_boxes() draws nothing if memory is out; lines that are too
 *            long are cut
 */
#ifndef GLIM_OVERLAY_H
#define GLIM_OVERLAY_H

#include <stdint.h>

#include "image/frame.h"
#include "inspect/path_record.h"
#include "scene/scene.h"
#include "kernels/types.h"

/* ---- drawings ---- */

/* Most boxes that are drawn; the nearest are chosen. */
#define OVERLAY_BOXES_MAX 4096

/* Draws the boxes of all nodes and leaves at this level; level 0 has the
 * children of the root. Near ones are brighter and cover far ones. Returns
 * their number. With instances the tree is that of their stand-ins. */
uint32_t overlay_boxes(struct frame *frame, const struct camera *camera,
                       const struct world *world, uint32_t level);

/* Returns the number of levels of the world's tree. */
uint32_t overlay_levels(const struct world *world);

/* Draws the first `count` steps of a path, the last of them bright. What is
 * behind surfaces of the world is dashed; NULL: nothing is. The world has its
 * tree. */
void overlay_path(struct frame *frame, const struct camera *camera,
                  const struct world *world, const struct path_record *path,
                  int count);

/* Draws the frame of a surface (normal green, tangents red and blue), the ray
 * to the eye in orange, and directions of scattering. The colour of a direction
 * is its weight and its length the density; directions of a delta distribution
 * have equal lengths. */
void overlay_lobes(struct frame *frame, const struct camera *camera,
                   const struct path_record_lobes *lobes);

/* ---- tables ---- */

/*
 * Lines that are too long are cut.
 */

/* Most lines of a path's table: the window must leave room for the picture at
 * 80x24. */
#define OVERLAY_TEXT_STEPS 6
#define OVERLAY_TEXT_LINES (OVERLAY_TEXT_STEPS + 2)
#define OVERLAY_TEXT_BYTES 256

struct overlay_text {
    char lines[OVERLAY_TEXT_LINES][OVERLAY_TEXT_BYTES];
    int count;
};

/* Names of the materials of a world's triangles. */
struct overlay_names {
    const struct world *world;
    char *const *materials;
};

/* Return the name of a material, or of that of a triangle, or words for none.
 */
const char *overlay_material(const struct overlay_names *names,
                             uint32_t material);
const char *overlay_material_of(const struct overlay_names *names,
                                uint32_t tri);

/* Finds a place in the scene's units; rounding errors around 0 become 0. */
void overlay_place(const struct scene *scene, struct vec3 p, double place[3]);

/* Formats numbers with 3 digits, or 4 in more than 17 columns, or with as many
 * as fit into `cols` columns: numbers must not be cut. */
#define OVERLAY_NUMBERS_BYTES 64
void overlay_numbers(char text[OVERLAY_NUMBERS_BYTES], const double *values,
                     int count, int cols);

/* Says what happens in the first `count` steps, or in the last ones of them
 * that fit, and which light the whole path brings: in words, or as a table of
 * numbers with places in the scene's units (NULL: words). */
void overlay_text_path(struct overlay_text *l, const struct scene *scene,
                       const struct overlay_names *names,
                       const struct path_record *path, int count);

void overlay_text_lobes(struct overlay_text *l,
                        const struct overlay_names *names,
                        const struct path_record_lobes *lobes);

#endif
