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

struct cancel;

/* What samples may have besides; each may be NULL. */
struct sample_options {
    struct cell_estimates *estimates; /* one for each sample */
    const struct cancel *cancel;      /* halts walks below surfaces */
};

struct cpu_kernel {
    const char *name;  /* name of the instruction set */
    uint64_t features; /* features it has, a set of features.h */

    /* path_samples() of path_stream.h. options: may be NULL */
    bool (*samples)(const struct world *w, const struct sample_id *places,
                    uint32_t count, struct path_sample *out,
                    struct first_surface *surfaces,
                    const struct sample_options *options);
};

#endif
