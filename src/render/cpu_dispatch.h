// SPDX-License-Identifier: MIT
/*
 * cpu_dispatch.h - chooses the build of the CPU kernel: the best instruction
 * set of the processor, or the one named with --isa, with only the features
 * that the scene needs
 *
 * Ownership: static
 * Threads:   any
 * Errors:    cpu_kernel_named() lists the names of this processor
 */
#ifndef GLIM_CPU_DISPATCH_H
#define GLIM_CPU_DISPATCH_H

#include <stdint.h>

#include "render/cpu_kernel.h"

/* Returns the i-th build of the kernel in this program, which may be one that
 * this processor cannot run, or NULL after the last. */
const struct cpu_kernel *cpu_kernel_build(int i);

/* Returns the kernel with all features for the i-th instruction set that this
 * processor has, fastest first, or NULL after the last. */
const struct cpu_kernel *cpu_kernel_at(int i);

/* Returns the kernel with all features for the fastest instruction set. */
const struct cpu_kernel *cpu_kernel_best(void);

/* Returns the kernel with all features for the named instruction set, or NULL
 * if the name is unknown or the processor cannot run it. */
const struct cpu_kernel *cpu_kernel_named(const char *name, struct error *err);

/* Returns the smallest build for the instruction set of `paths` that has all of
 * `features`, or `paths` itself if there is none. */
const struct cpu_kernel *cpu_kernel_fit(const struct cpu_kernel *paths,
                                        uint64_t features);

#endif
