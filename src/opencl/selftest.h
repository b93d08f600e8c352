// SPDX-License-Identifier: MIT
/*
 * selftest.h - does a backend compute what the CPU computes?
 *
 * A small room with every kind of material that needs no other features is
 * rendered by both.
 *
 * Ownership: both backends stay the caller's, with another scene loaded
 * Threads:   one at a time
 * Errors:    a device that fails, or computes something else
 */
#ifndef GLIM_SELFTEST_H
#define GLIM_SELFTEST_H

#include <stdbool.h>
#include <stdint.h>

#include "render/backend.h"

#define SELFTEST_VERDICT_BYTES 64

/* The verdict is "the CPU's bits", or how many pixels differ a little. */
bool selftest_run(struct backend *cpu, struct backend *device,
                  uint32_t features, char verdict[SELFTEST_VERDICT_BYTES],
                  struct error *err);

#endif
