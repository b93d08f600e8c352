// SPDX-License-Identifier: MIT
/*
 * batch_compare.h - glim compare: two pictures, their errors as text, and a
 * picture of the differences
 *
 * Threads:   main only
 * Errors:    unreadable pictures, different sizes, unwritable output, memory
 */
#ifndef GLIM_BATCH_COMPARE_H
#define GLIM_BATCH_COMPARE_H

#include "picture/image_read.h"
#include "session/command_line.h"

/* Compares and prints. *status becomes 0 if the pictures differ by noise alone,
 * 1 if a tile differs by more. */
bool batch_compare_run(const struct options *o, int *status, struct error *err);

/* Reads a picture as linear floats, and warns of values that were clamped.
 * held_bytes are those of other pictures. */
bool batch_compare_read(struct image *image, const char *path,
                        uint64_t held_bytes, struct error *err);

#endif
