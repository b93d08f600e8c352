// SPDX-License-Identifier: MIT
/*
 * frame.h - a picture of 8-bit pixels, and drawing into it
 *
 * Units:     pixels; (0, 0) is the top left corner of the first one; colours
 *            are 0xRRGGBB
 * Ownership: frame_free() frees
 * Threads:   any; one thread at a time for each frame
 * Errors:    out of memory; drawings are clipped to the frame
 */
#ifndef GLIM_FRAME_H
#define GLIM_FRAME_H

#include <stdbool.h>
#include <stdint.h>

#include "base/thread_pool.h"

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
