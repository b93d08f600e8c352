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

#include "session/command_line.h"

/* Compares and prints. *status becomes 0 if the pictures differ by noise alone,
 * 1 if a tile differs by more. */
bool batch_compare_run(const struct options *o, int *status, struct error *err);

#endif
