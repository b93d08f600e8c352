// SPDX-License-Identifier: MIT
/*
 * batch_curve.h - glim curve: the error of a render at doubling numbers of
 * samples, as a table, comma-separated values and diagrams
 *
 * Threads:   main only
 * Errors:    unreadable reference or scene, unwritable output, memory, a
 *            failing device
 */
#ifndef GLIM_BATCH_CURVE_H
#define GLIM_BATCH_CURVE_H

#include "session/command_line.h"

/* Measures and prints. *status becomes 0, or 128 + signal after the output of
 * the points measured before it. */
bool batch_curve_run(const struct options *o, uint64_t start_ns, int *status,
                     struct error *err);

#endif
