// SPDX-License-Identifier: MIT
/* Compiled once for each instruction set and each set of features (kernels.mk).
 * PATHS is the name of the result, PATHS_NAME that of the instruction set, and
 * SET the name of the features in feature_sets.h; without it, the build has
 * all. */
#ifdef SET
#include "render/feature_sets.h"

#define FEATURES_OF(set) FEATURES_##set
#define NAMED(set)       FEATURES_OF(set)
#define FEATURES         NAMED(SET)
#endif

#include "render/cpu_kernel.h"

#include "world/bvh/ray_queries.h"

#include "render/path_stream.h"

#ifndef PATHS
#define PATHS      paths_plain
#define PATHS_NAME "plain"
#endif

/* Builds with few features are 6 % faster if everything is inlined into one
 * function; the others are not. */
#ifdef FLATTEN
__attribute__((flatten))
#endif
static bool
samples(const struct world *w, const struct sample_id *places, uint32_t count,
        struct path_sample *out, struct first_surface *surfaces,
        const struct sample_options *options)
{
    return path_samples(w, places, count, out, surfaces, options);
}

const struct cpu_kernel PATHS = {PATHS_NAME, FEATURES, samples};
