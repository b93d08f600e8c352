// SPDX-License-Identifier: MIT
/*
 * racer.h - ray queries that are timed against others
 *
 * Units:     normalised scene units
 * Ownership: the tree belongs to the racer's maker
 * Threads:   queries from any
 */
#ifndef RAYS_RACER_H
#define RAYS_RACER_H

#include <string.h>

#include "kernels/types.h"

#include "render/cpu_dispatch.h"
#include "spent.h"

struct answer {
    float t;      /* distance of the nearest hit */
    uint32_t tri; /* NO_INDEX: no hit; 0 if any hit is enough */
};

/* Traces `count` rays. */
typedef void racer_query(const void *tree, const struct ray *rays,
                         uint32_t count, struct answer *answers);

struct racer {
    const void *tree;
    racer_query *closest;
    racer_query *any;
    racer_query *coherent; /* nearest hits of neighbouring rays */
    struct spent build;
    double bytes; /* size of the tree */
};

/* Queries of glim for an instruction set; the tree is a struct world. */
extern const struct racer racer_plain;
extern const struct racer racer_avx2; /* x86-64 only */
extern const struct racer racer_avx512;

/* Returns the racer for the instruction set of these kernels. */
static inline const struct racer *racer_of(const struct cpu_kernel *paths)
{
#if defined(__x86_64__)
    if (strcmp(paths->name, "avx512") == 0)
        return &racer_avx512;
    if (strcmp(paths->name, "avx2") == 0)
        return &racer_avx2;
#endif
    (void)paths;
    return &racer_plain;
}

#endif
