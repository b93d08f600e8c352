// SPDX-License-Identifier: MIT
/*
 * isa.h - which of the CPU's samples run: those for the best instructions that
 * the processor has, or those that the person names
 *
 * Units:     none
 * Ownership: static
 * Threads:   any
 * Errors:    isa_named() says which there are
 */
#ifndef GLIM_ISA_H
#define GLIM_ISA_H

#include "glim/paths.h"

/* The i-th that this processor can run, the fastest first; NULL behind the
 * last, which is paths_plain. */
const struct paths *isa_at(int i);

const struct paths *isa_best(void);

/* NULL if there is none of this name, or the processor cannot run it. */
const struct paths *isa_named(const char *name, struct error *err);

#endif
