// SPDX-License-Identifier: MIT
/*
 * frame.h - a picture of 8-bit pixels, and drawing into it
 *
 * Units:     pixels, (0, 0) is the top left corner of the first; colours are
 *            0xRRGGBB
 * Ownership: frame_free() frees
 * Threads:   any; one owner of the frame
 * Errors:    memory; what is outside of the frame is not drawn
 */
#ifndef GLIM_FRAME_H
#define GLIM_FRAME_H

#include <stdbool.h>
#include <stdint.h>

#include "base/error.h"

/* 8-bit sRGB, 3 bytes a pixel, row 0 at the top. */
struct frame {
    int width, height;
    uint8_t *rgb;
};

/* The pixels are not cleared. */
bool frame_init(struct frame *frame, int width, int height, struct error *err);
void frame_free(struct frame *frame);

void frame_dot(struct frame *frame, double x, double y, uint32_t rgb);

/* Both ends and all between, a pixel wide. */
void frame_line(struct frame *frame, double x0, double y0, double x1, double y1,
                uint32_t rgb);

/* The outline between two corners. */
void frame_box(struct frame *frame, double x0, double y0, double x1, double y1,
               uint32_t rgb);

/* Between black at 0 and the colour at 1. */
uint32_t frame_dim(uint32_t rgb, double brightness);

#endif
