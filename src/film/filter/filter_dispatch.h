// SPDX-License-Identifier: MIT
/*
 * filter_dispatch.h - chooses the build of the filter's loops
 *
 * Ownership: static
 * Threads:   any
 */
#ifndef GLIM_FILTER_DISPATCH_H
#define GLIM_FILTER_DISPATCH_H

#include "film/filter/filter_loops.h"

/* Returns the loops for the i-th instruction set that this processor has,
 * fastest first, or NULL after the last. */
const struct filter_loops *filter_loops_at(int i);

#endif
