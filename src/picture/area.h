// SPDX-License-Identifier: MIT
/*
 * area.h - how much of each cell of one grid lies in each cell of another
 *
 * Along one axis, both grids from end to end: the walk goes over the pieces
 * that the borders of both cut. Lengths are whole numbers, so that none is
 * rounded: a cell of `from` is as long as there are cells of `to`.
 *
 * Units:     cells, and lengths as above
 * Threads:   any
 */
#ifndef GLIM_AREA_H
#define GLIM_AREA_H

#include <stdbool.h>
#include <stdint.h>

struct area_walk {
    int from, to; /* cells that the next piece is of */
    int64_t at, last;
    int64_t from_end, to_end;
    int64_t from_step, to_step;
};

/* Of cells [first, first + count) of `to` cells. */
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

/* Goes on to the next piece; how long this one is. */
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
