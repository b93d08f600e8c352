// SPDX-License-Identifier: MIT
/*
 * selftest.h - compares the pictures of a device and the CPU
 *
 * Both render a small room that has every material which needs no further
 * features.
 *
 * Ownership: both backends stay the caller's, with another scene loaded
 * Threads:   one at a time
 * Errors:    a device that fails, or whose picture differs
 */
#ifndef GLIM_SELFTEST_H
#define GLIM_SELFTEST_H

#include <stdbool.h>
#include <stdint.h>

#include "render/backend.h"

#define SELFTEST_VERDICT_BYTES 64

/* Runs the test. The verdict is "the CPU's bits", or the number of pixels with
 * small differences. */
bool selftest_run(struct backend *cpu, struct backend *device,
                  uint32_t features, char verdict[SELFTEST_VERDICT_BYTES],
                  struct error *err);

#endif
