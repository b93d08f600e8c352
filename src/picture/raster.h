// SPDX-License-Identifier: MIT
/*
 * raster.h - lines on a frame
 *
 * Units:     pixels, (0, 0) is the top left corner of the first; 0xRRGGBB
 * Threads:   any; one owner of the frame
 * Errors:    none; what is outside of the frame is not drawn
 */
#ifndef GLIM_RASTER_H
#define GLIM_RASTER_H

#include <stdint.h>

#include "picture/film.h"

void raster_dot(struct frame *frame, double x, double y, uint32_t rgb);

/* Both ends and all between, a pixel wide. */
void raster_line(struct frame *frame, double x0, double y0, double x1,
                 double y1, uint32_t rgb);

/* The outline between two corners. */
void raster_box(struct frame *frame, double x0, double y0, double x1, double y1,
                uint32_t rgb);

/* Between black at 0 and the colour at 1. */
uint32_t raster_dim(uint32_t rgb, double brightness);

#endif
