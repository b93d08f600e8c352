// SPDX-License-Identifier: MIT
/*
 * frame.h - a picture of 8-bit pixels, drawing into it, and the overlaps of the
 * cells of two grids, by which pictures are scaled
 *
 * Units:     pixels; (0, 0) is the top left corner of the first one; colours
 *            are 0xRRGGBB; cells and their lengths
 * Ownership: frame_free() frees
 * Threads:   any; one thread at a time for each frame
 * Errors:    out of memory; drawings are clipped to the frame
 */
#ifndef GLIM_FRAME_H
#define GLIM_FRAME_H

#include <stdbool.h>
#include <stdint.h>

#include "base/thread_pool.h"

/* ---- areas of cells ---- */

/*
 * Along one axis, both grids have the same ends. The walk visits the pieces
 * into which the borders of both cut the axis. Lengths are integers, so that
 * none is rounded: the length of a cell of `from` is the number of cells of
 * `to`, and vice versa.
 */

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

/* ---- frames ---- */

/* Picture of 8-bit sRGB, 3 bytes per pixel, row 0 at the top. */
struct frame {
    int width, height;
    uint8_t *rgb;
    const struct cancel *cancel; /* ends what goes over its rows; NULL: none */
};

static inline bool frame_is_cancelled(const struct frame *frame)
{
    return frame->cancel && cancel_requested(frame->cancel);
}

/* Returns true if row y is to be filled. After a cancel the last rows keep the
 * pixels that they had. */
static inline bool frame_has_row(const struct frame *frame, int y)
{
    return y < frame->height && !frame_is_cancelled(frame);
}

/* Allocates the pixels without clearing them. */
bool frame_init(struct frame *frame, int width, int height, struct error *err);
void frame_free(struct frame *frame);

/* Fills a frame with another one in its size: each pixel is the mean over its
 * area, of the bytes. */
void frame_scale(const struct frame *from, struct frame *to);

void frame_dot(struct frame *frame, double x, double y, uint32_t rgb);

/* Draws a line one pixel wide, with both ends. */
void frame_line(struct frame *frame, double x0, double y0, double x1, double y1,
                uint32_t rgb);

/* Draws the outline of the rectangle between two corners. */
void frame_box(struct frame *frame, double x0, double y0, double x1, double y1,
               uint32_t rgb);

/* Returns the colour scaled by the brightness: black at 0, unchanged at 1. */
uint32_t frame_dim(uint32_t rgb, double brightness);

#endif
