// SPDX-License-Identifier: MIT
/*
 * overlay_text.h - what drawings of the insides say in words: tables of a path and of
 * a surface
 *
 * Units:     file units, radiance, densities per solid angle
 * Ownership: none
 * Threads:   any
 * Errors:    none; lines are cut
 */
#ifndef GLIM_OVERLAY_TEXT_H
#define GLIM_OVERLAY_TEXT_H

#include "scene/scene.h"
#include "inspect/path_record.h"

/* Lines of a path's table, at most: the window must leave room for the picture
 * at 80x24. */
#define LEGEND_STEPS 6
#define LEGEND_LINES (LEGEND_STEPS + 2)
#define LEGEND_BYTES 256

struct legend {
    char lines[LEGEND_LINES][LEGEND_BYTES];
    int count;
};

/* A table of the first `count` steps, or of the last of them if there are more,
 * and below it what the whole path has gathered. */
void legend_trail(struct legend *l, const struct scene *scene,
                  const struct trail *trail, int count);

void legend_lobes(struct legend *l, const struct scene *scene,
                  const struct trail_lobes *lobes);

#endif
