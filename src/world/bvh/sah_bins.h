// SPDX-License-Identifier: MIT
/*
 * sah_bins.h - binned surface area heuristic: where to split a set of boxes
 *
 * Wald 2007, "On fast construction of SAH-based bounding volume hierarchies".
 * Boxes are put into bins by their centres, on all three axes at once. Of the
 * planes between bins the one of least expected cost is chosen. A subset of the
 * boxes is enough to find it. Apart from that choice, the order of boxes does
 * not matter.
 *
 * Units:     normalised scene units
 * Threads:   any, on bins of their own
 */
#ifndef GLIM_SAH_BINS_H
#define GLIM_SAH_BINS_H

#include <stdbool.h>
#include <string.h>

#include "base/simd4.h"
#include "kernels/vec.h"

#define SPLIT_BINS 32

/* A box: the low corner, then the negated high one, so that a componentwise
 * minimum joins boxes. planes[3] holds the bits of a triangle's index. */
struct box {
    _Alignas(16) float planes[8];
};

static inline struct box box_empty(void)
{
    struct box b;

    f4_store(b.planes, f4_set1(FLOAT_MAX));
    f4_store(b.planes + 4, f4_set1(FLOAT_MAX));
    return b;
}

static inline void box_join(struct box *a, const struct box *b)
{
    for (int i = 0; i < 8; i += 4)
        f4_store(a->planes + i,
                 f4_min(f4_load(a->planes + i), f4_load(b->planes + i)));
}

static inline struct box box_of_corners(struct vec3 lo, struct vec3 hi)
{
    struct box b;

    f4_store(b.planes, f4_set3(lo.x, lo.y, lo.z));
    f4_store(b.planes + 4, f4_sub(f4_set1(0.0f), f4_set3(hi.x, hi.y, hi.z)));
    return b;
}

static inline struct box box_of_point(struct vec3 p)
{
    return box_of_corners(p, p);
}

/* Half of the surface area of the union of two boxes that are not empty. */
static inline float box_joined_area(const struct box *a, const struct box *b)
{
    f4 lo = f4_min(f4_load(a->planes), f4_load(b->planes));
    f4 hi = f4_min(f4_load(a->planes + 4), f4_load(b->planes + 4));

    return f4_pairs3(f4_sub(f4_sub(f4_set1(0.0f), hi), lo));
}

/* Half of the surface area of a box. */
static inline float box_area(const struct box *b)
{
    return box_joined_area(b, b);
}

static inline uint32_t box_tri(const struct box *b)
{
    uint32_t tri;

    memcpy(&tri, &b->planes[3], sizeof tri);
    return tri;
}

static inline void box_set_tri(struct box *b, uint32_t tri)
{
    memcpy(&b->planes[3], &tri, sizeof tri);
}

/* The union of boxes, and the bounds of their doubled centres. */
struct extent {
    struct box bounds, centers;
};

static inline struct extent extent_empty(void)
{
    return (struct extent){box_empty(), box_empty()};
}

static inline void extent_join(struct extent *a, const struct extent *b)
{
    box_join(&a->bounds, &b->bounds);
    box_join(&a->centers, &b->centers);
}

/* Maps doubled centres to bins: of each axis the first centre, and bins a unit,
 * which is 0 where all centres agree. */
struct binning {
    _Alignas(16) float first[4], scale[4];
    uint32_t count;
};

/* Bin i of each axis, in two cache lines. */
struct bin {
    _Alignas(128) struct box boxes[3];
    _Alignas(16) uint32_t counts[4]; /* the last is unused */
};

struct bins {
    struct binning binning;
    uint32_t box_count;
    struct bin bins[SPLIT_BINS];
};

struct split {
    struct binning binning;
    float cost;   /* blocks of both sides, times their areas */
    int axis;     /* -1: no plane separates the centres */
    uint32_t bin; /* first bin of the right side */
};

/* Number of blocks, of 1 << block_bits triangles each. */
static inline float blocks_of(uint32_t count, uint32_t block_bits)
{
    return (float)((count + (1u << block_bits) - 1) >> block_bits);
}

/* Returns the extent of all boxes. */
struct extent extent_of(const struct box *boxes, uint32_t count);

/* Empties the bins, for `count` boxes with these bounds of centres. */
void bins_clear(struct bins *bins, uint32_t count, const struct box *centers);

/* Adds every stride-th box. */
void bins_add(struct bins *bins, const struct box *boxes, uint32_t count,
              uint32_t stride);

/* Finds the cheapest plane. */
struct split bins_split(const struct bins *bins, uint32_t block_bits);

/* Returns how many boxes go right. */
uint32_t split_count(const struct split *s, const struct box *boxes,
                     uint32_t count);

/* Copies boxes: those of the left side to `left` and on, the others to before
 * `right` and backwards. Returns the count of the left side. */
uint32_t split_part(const struct split *s, const struct box *boxes,
                    uint32_t count, struct box *left, struct box *right);

#endif
