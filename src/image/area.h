// SPDX-License-Identifier: MIT
/*
 * area.h - overlaps of the cells of two grids, for scaling pictures by area
 *
 * Along one axis, both grids have the same ends. The walk visits the pieces
 * into which the borders of both cut the axis. Lengths are integers, so that
 * none is rounded: the length of a cell of `from` is the number of cells of
 * `to`, and vice versa.
 *
 * Units:     cells, and lengths as above
 * Threads:   any
 */
#ifndef GLIM_AREA_H
#define GLIM_AREA_H

#include <stdbool.h>
#include <stdint.h>

/* Returns the cell of a grid of `from` cells that contains the middle of cell i
 * of a grid of `to` cells. */
static inline int area_cell(int i, int from, int to)
{
    return from == to ? i
                      : (int)((2 * (int64_t)i + 1) * from / (2 * (int64_t)to));
}

struct area_walk {
    int from, to; /* cells of `from` and `to` that contain the next piece */
    int64_t at, last;
    int64_t from_end, to_end;
    int64_t from_step, to_step;
};

/* Begins a walk over cells [first, first + count) of a grid of `to` cells. */
static inline struct area_walk area_walk(int from, int to, int first, int count)
{
    int64_t at = (int64_t)first * from;
    struct area_walk w = {.from = (int)(at / to),
                          .to = first,
                          .at = at,
                          .last = at + (int64_t)count * from,
                          .to_end = at + from,
                          .from_step = to,
                          .to_step = from};

    w.from_end = (int64_t)(w.from + 1) * to;
    return w;
}

static inline bool area_walks(const struct area_walk *w)
{
    return w->at < w->last;
}

/* Moves to the next piece. Returns the length of the current one. */
static inline float area_step(struct area_walk *w)
{
    int64_t end = w->from_end < w->to_end ? w->from_end : w->to_end;
    int64_t length = end - w->at;

    w->at = end;
    if (w->from_end == end) {
        w->from_end += w->from_step;
        w->from++;
    }
    if (w->to_end == end) {
        w->to_end += w->to_step;
        w->to++;
    }
    return (float)length;
}

#endif
