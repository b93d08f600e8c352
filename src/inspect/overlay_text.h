// SPDX-License-Identifier: MIT
/*
 * overlay_text.h - tables of a path and of the directions at a surface
 *
 * Lines that are too long are cut.
 *
 * Units:     file units, radiance, densities per solid angle
 * Threads:   any
 */
#ifndef GLIM_OVERLAY_TEXT_H
#define GLIM_OVERLAY_TEXT_H

#include "scene/scene.h"
#include "inspect/path_record.h"

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
