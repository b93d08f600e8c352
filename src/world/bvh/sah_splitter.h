// SPDX-License-Identifier: MIT
/*
 * sah_splitter.h - splits sets of boxes in two, by one thread or by all
 *
 * The boxes of a set lie side by side in one of two buffers. A split copies
 * them to the other. For large sets a subset chooses the plane. Results do not
 * depend on the order of threads.
 *
 * Units:     normalised scene units
 * Ownership: splitter_free() frees; a zeroed struct is empty
 * Threads:   splitter_split() from all workers of the pool, on ranges of their
 *            own; the others from one thread, and use those of the pool
 * Errors:    memory
 */
#ifndef GLIM_SAH_SPLITTER_H
#define GLIM_SAH_SPLITTER_H

#include <stdbool.h>
#include <stdint.h>

#include "world/bvh/bvh.h"
#include "world/bvh/sah_bins.h"

/* A set of consecutive boxes in a buffer. */
struct range {
    uint32_t first, count, depth;
    uint32_t buffer; /* index of the buffer */
    struct extent extent;
};

/* Scratch memory of a thread. */
struct splitter_worker {
    struct bins bins;
    struct extent extents[2]; /* of both sides */
};

struct splitter {
    const struct bvh_leaves *leaves;
    struct pool *pool;
    struct box *buffers[2];
    struct splitter_worker *workers;
    uint32_t worker_count;
    float large_area; /* least area of a large node */
    bool drops_copies;
    /* shared by all threads in a split together */
    const struct world *world;
    const struct range *range;
    struct split split;
    struct range *sides;
    uint32_t (*chunk_sides)[2]; /* counts of both sides, then destinations */
};

/* Prepares for the triangles of a world. Returns false if memory is out. */
bool splitter_init(struct splitter *s, const struct world *world,
                   const struct bvh_leaves *leaves, struct pool *pool);

/* Returns the range of all triangles. */
struct range splitter_all(struct splitter *s);

/* Splits a range. Returns false if it is to be a leaf. Where no plane separates
 * the triangles it drops copies, which no ray can tell from the first of them:
 * range->count becomes less. */
bool splitter_split(struct splitter *s, int worker, struct range *range,
                    struct range sides[2]);

/* Splits a range that is too large for a leaf, by all threads. */
void splitter_split_together(struct splitter *s, const struct range *range,
                             struct range sides[2]);

void splitter_free(struct splitter *s);

#endif
