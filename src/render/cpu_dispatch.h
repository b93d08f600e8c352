// SPDX-License-Identifier: MIT
/*
 * cpu_dispatch.h - which of the CPU's samples run: those for the best
 * instructions that the processor has, or those that the person names, without
 * what the scene does not need
 *
 * Ownership: static
 * Threads:   any
 * Errors:    cpu_kernel_named() says which there are
 */
#ifndef GLIM_CPU_DISPATCH_H
#define GLIM_CPU_DISPATCH_H

#include <stdint.h>

#include "render/cpu_kernel.h"

/* For the i-th set of instructions of this processor, the fastest first, with
 * all features; NULL behind the last. */
const struct cpu_kernel *cpu_kernel_at(int i);

const struct cpu_kernel *cpu_kernel_best(void);

/* NULL if there is none of this name, or the processor cannot run it. */
const struct cpu_kernel *cpu_kernel_named(const char *name, struct error *err);

/* The smallest build for the instructions of `paths` that does all features of
 * a world; paths itself if there is none. */
const struct cpu_kernel *cpu_kernel_fit(const struct cpu_kernel *paths,
                                        uint32_t features);

#endif
