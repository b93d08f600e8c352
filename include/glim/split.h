// SPDX-License-Identifier: MIT
/*
 * split.h - where to split a set of boxes: binned surface area heuristic
 *
 * Wald 2007, "On fast construction of SAH-based bounding volume hierarchies".
 * Boxes are put into bins by their centres, on all three axes at once; of the
 * planes between bins the one with the least expected cost is taken. Nothing
 * depends on the order in which boxes come, so bins that threads filled can be
 * joined.
 *
 * Units:     normalised scene units
 * Ownership: none
 * Threads:   any, on bins of their own
 * Errors:    none
 */
#ifndef GLIM_SPLIT_H
#define GLIM_SPLIT_H

#include <stdbool.h>
#include <string.h>

#include "glim/simd.h"
#include "kernels/vec.h"

#define SPLIT_BINS 32

/* The low corner, then the high one negated: a minimum joins boxes. The fourth
 * number of the first half holds the bits of a triangle's number. */
struct box {
    _Alignas(16) float planes[8];
};

static inline struct box box_empty(void)
{
    struct box b;

    f4_store(b.planes, f4_all(FLOAT_MAX));
    f4_store(b.planes + 4, f4_all(FLOAT_MAX));
    return b;
}

static inline void box_join(struct box *a, const struct box *b)
{
    for (int i = 0; i < 8; i += 4)
        f4_store(a->planes + i,
                 f4_min(f4_load(a->planes + i), f4_load(b->planes + i)));
}

static inline struct box box_of_point(struct vec3 p)
{
    struct box b = {{p.x, p.y, p.z, 0.0f, -p.x, -p.y, -p.z, 0.0f}};

    return b;
}

/* Half of the surface; 0 for an empty box. */
static inline float box_area(const struct box *b)
{
    float x = -b->planes[4] - b->planes[0];
    float y = -b->planes[5] - b->planes[1];
    float z = -b->planes[6] - b->planes[2];

    return x >= 0.0f ? x * y + y * z + z * x : 0.0f;
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

/* Twice the centre, as a box. */
static inline struct box box_center(const struct box *b)
{
    f4 center = f4_sub(f4_load(b->planes), f4_load(b->planes + 4));
    struct box c;

    f4_store(c.planes, center);
    f4_store(c.planes + 4, f4_sub(f4_all(0.0f), center));
    return c;
}

/* How centres fall into bins: of each axis the first centre and bins a unit, 0
 * where all centres agree. */
struct binning {
    _Alignas(16) float first[4], scale[4];
    uint32_t count;
};

struct bins {
    struct binning binning;
    struct box boxes[3][SPLIT_BINS];
    uint32_t counts[3][SPLIT_BINS];
};

/* So many triangles are tested at once: 1 << block_bits. */
static inline float blocks_of(uint32_t count, uint32_t block_bits)
{
    return (float)((count + (1u << block_bits) - 1) >> block_bits);
}

struct split {
    struct binning binning;
    float cost;   /* blocks of both sides, each times its area */
    int axis;     /* -1: no plane parts the centres */
    uint32_t bin; /* the first that goes right */
};

/* The bins in which a box is. */
static inline void bins_of(const struct binning *b, const struct box *box,
                           float at[4])
{
    f4 center = f4_sub(f4_load(box->planes), f4_load(box->planes + 4));
    f4 bin = f4_mul(f4_sub(center, f4_load(b->first)), f4_load(b->scale));

    f4_store(at, f4_min(bin, f4_all((float)(b->count - 1))));
}

/* As bins_of() of that axis says. */
static inline bool split_goes_right(const struct split *s,
                                    const struct box *box)
{
    float center = box->planes[s->axis] - box->planes[4 + s->axis];

    return (center - s->binning.first[s->axis]) * s->binning.scale[s->axis] >=
           (float)s->bin;
}

/* Empty bins for so many boxes with such centres (joined by box_join()). */
void bins_clear(struct bins *bins, uint32_t count, const struct box *centers);
void bins_add(struct bins *bins, const struct box *boxes, uint32_t count);
void bins_join(struct bins *bins, const struct bins *other);

/* The cheapest plane, and the boxes of both sides. */
struct split bins_split(const struct bins *bins, uint32_t count,
                        uint32_t block_bits, struct box sides[2]);

/* How many boxes go left. */
uint32_t bins_left(const struct bins *bins, const struct split *s);

#endif
