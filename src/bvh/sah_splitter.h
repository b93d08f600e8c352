// SPDX-License-Identifier: MIT
/*
 * sah_splitter.h - splits sets of boxes in two, by one thread or by all
 *
 * Boxes of a set lie side by side in one of two buffers; a split copies them to
 * the other. Some of a large set choose the plane for all. What threads join
 * does not depend on who came first.
 *
 * Units:     normalised scene units
 * Ownership: splitter_free() frees; a zeroed struct is none
 * Threads:   splitter_split() from all workers of the pool, on ranges of their
 *            own; the others from one thread, and use those of the pool
 * Errors:    memory
 */
#ifndef GLIM_SAH_SPLITTER_H
#define GLIM_SAH_SPLITTER_H

#include <stdbool.h>
#include <stdint.h>

#include "bvh/bvh.h"
#include "bvh/sah_bins.h"

/* Boxes that lie side by side. */
struct range {
    uint32_t first, count, depth;
    uint32_t buffer; /* which of the two they are in */
    struct extent extent;
};

/* What a thread needs for itself. */
struct splitter_worker {
    struct bins bins;
    struct extent extents[2]; /* of sides */
};

struct splitter {
    const struct bvh_leaves *leaves;
    struct pool *pool;
    struct box *buffers[2];
    struct splitter_worker *workers;
    uint32_t worker_count;
    float large_area; /* of what is a large node */
    /* what all threads work on */
    const struct world *world;
    const struct range *range;
    struct split split;
    struct range *sides;
    uint32_t (*chunk_sides)[2]; /* how many go to each side, then where */
};

/* For the world's triangles. False if memory is out. */
bool splitter_init(struct splitter *s, const struct world *world,
                   const struct bvh_leaves *leaves, struct pool *pool);

/* The range of all triangles. */
struct range splitter_all(struct splitter *s);

/* False if the range is to be a leaf. */
bool splitter_split(struct splitter *s, int worker, const struct range *range,
                    struct range sides[2]);

/* By all threads, a range that is too large for a leaf. */
void splitter_split_together(struct splitter *s, const struct range *range,
                             struct range sides[2]);

void splitter_free(struct splitter *s);

#endif
