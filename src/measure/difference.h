// SPDX-License-Identifier: MIT
/*
 * difference.h - the picture of the differences between two pictures
 *
 * Units:     linear radiance; 8-bit sRGB
 * Threads:   any
 */
#ifndef GLIM_DIFFERENCE_H
#define GLIM_DIFFERENCE_H

#include "measure/tile_test.h"
#include "picture/frame.h"

/* Draws the relative difference of each pixel in false colours, red where the
 * picture is brighter than the reference and blue where it is darker, and a
 * white frame around each tile that differs. The frame has the size of the
 * pictures. Returns the relative difference that has the brightest colour. */
double difference_draw(const struct picture_pair *pair,
                       const struct tile_test *test, struct frame *frame);

#endif
