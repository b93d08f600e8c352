// SPDX-License-Identifier: MIT
/*
 * paths.h - the functions of kernels/path.h and of path_stream.h for tests,
 * compiled once
 *
 * The instruction set is the host's.
 *
 * Units and errors as in kernels/path.h.
 */
#ifndef TESTS_PATHS_H
#define TESTS_PATHS_H

#include "world/bvh/ray_queries.h"

#include "kernels/path.h"

/* path_trace() */
struct path_sample trace_path(const struct world *w, struct ray r,
                              struct sampler sampler,
                              struct first_surface *surface);

/* path_samples() of path_stream.h */
void trace_samples(const struct world *w, const struct sample_id *places,
                   uint32_t count, struct path_sample *out,
                   struct first_surface *surfaces);

#endif
