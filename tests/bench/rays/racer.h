// SPDX-License-Identifier: MIT
/*
 * racer.h - what traces rays and is timed against others that do
 *
 * Units:     normalised scene units
 * Ownership: the tree belongs to who made the racer
 * Threads:   queries from any
 */
#ifndef RAYS_RACER_H
#define RAYS_RACER_H

#include "kernels/types.h"

#include "spent.h"

struct answer {
    float t;      /* of a nearest hit */
    uint32_t tri; /* NO_INDEX: nothing hit; 0 if anything is enough */
};

/* Answers `count` rays. */
typedef void racer_query(const void *tree, const struct ray *rays,
                         uint32_t count, struct answer *answers);

struct racer {
    const void *tree;
    racer_query *closest;
    racer_query *any;
    racer_query *coherent; /* nearest hits of neighbours */
    struct spent build;
    double bytes; /* of the tree */
};

/* glim's queries for a set of instructions; the tree is a struct bvh8_world. */
extern const struct racer racer_plain;
extern const struct racer racer_avx2; /* x86-64 only */
extern const struct racer racer_avx512;

#endif
