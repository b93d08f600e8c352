// SPDX-License-Identifier: MIT
/*
 * batch_reference.h - glim reference: the mean of renders with several seeds,
 * and its own error beside it
 *
 * Threads:   main only
 * Errors:    unreadable scene, unwritable output, memory, a failing device
 */
#ifndef GLIM_BATCH_REFERENCE_H
#define GLIM_BATCH_REFERENCE_H

#include "session/command_line.h"

/* Renders and writes. *status becomes 0, or 128 + signal after the output of
 * the seeds that were complete. start_ns is that of the program. */
bool batch_reference_run(const struct options *o, uint64_t start_ns,
                         int *status, struct error *err);

#endif
