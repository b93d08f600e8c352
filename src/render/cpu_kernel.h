// SPDX-License-Identifier: MIT
/*
 * cpu_kernel.h - the CPU's samples, compiled for sets of instructions and of
 * features
 *
 * src/render/cpu_kernel.c is built several times, as the Makefile says; all
 * give the same bits. cpu_dispatch.h chooses.
 *
 * Units:     as kernels/path.h
 * Ownership: static
 * Threads:   any, on one world
 */
#ifndef GLIM_CPU_KERNEL_H
#define GLIM_CPU_KERNEL_H

#include "bvh/bvh8.h"
#include "kernels/path_types.h"

struct cpu_kernel {
    const char *name;  /* of the instructions */
    uint32_t features; /* enum feature: those of worlds that it can do */

    /* path_samples() of kernels/path.h; w is within a struct bvh8_world. */
    void (*samples)(const struct world *w, const struct sample_id *places,
                    uint32_t count, struct path_sample *out);
};

#endif
