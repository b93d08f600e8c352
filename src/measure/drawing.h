// SPDX-License-Identifier: MIT
/*
 * drawing.h - smooth lines, dots and text in a frame
 *
 * Units:     pixels, y down, whole numbers at the corners of pixels; colours
 *            are 0xRRGGBB
 * Threads:   one for each frame
 *
 * Drawings are clipped to the frame.
 */
#ifndef GLIM_DRAWING_H
#define GLIM_DRAWING_H

#include <stdint.h>

#include "picture/frame.h"

void drawing_box(struct frame *frame, int x, int y, int width, int height,
                 uint32_t color);

/* Draws a line through the points with round ends and corners. One point gives
 * a dot. */
void drawing_line(struct frame *frame, int count, const double *x,
                  const double *y, double thickness, uint32_t color);

/* Place of a text: x is its left end, middle or right end. */
enum drawing_align { DRAWING_LEFT, DRAWING_CENTRE, DRAWING_RIGHT };

/* Draws text whose capitals have this height and stand on y. */
void drawing_text(struct frame *frame, double x, double y, double height,
                  enum drawing_align align, const char *text, uint32_t color);

double drawing_text_width(double height, const char *text);

#endif
