// SPDX-License-Identifier: MIT
/*
 * cpu_kernel.h - path_samples() compiled for the CPU, for several instruction
 * sets and sets of features
 *
 * kernels.mk compiles src/render/cpu_kernel.c several times (SETS). All builds
 * give the same bits. cpu_dispatch.h chooses one.
 *
 * Units:     as kernels/path.h
 * Ownership: static
 * Threads:   any, on one world
 */
#ifndef GLIM_CPU_KERNEL_H
#define GLIM_CPU_KERNEL_H

#include "base/error.h"
#include "kernels/first_surface.h"
#include "kernels/path_types.h"

struct cpu_kernel {
    const char *name;  /* name of the instruction set */
    uint64_t features; /* features it has, a set of features.h */

    /* path_samples() of path_stream.h. */
    void (*samples)(const struct world *w, const struct sample_id *places,
                    uint32_t count, struct path_sample *out,
                    struct first_surface *surfaces,
                    struct cell_estimates *estimates);
};

#endif
