// SPDX-License-Identifier: MIT
/*
 * statement.h - values of MTL statements, checked for their ranges
 *
 * Threads:   any
 * Errors:    values out of range are replaced, with a warning
 */
#ifndef GLIM_STATEMENT_H
#define GLIM_STATEMENT_H

#include "base/warnings.h"
#include "scene/material_values.h"
#include "kernels/types.h"

/* Where warnings go. */
struct statement_place {
    const char *path;
    struct warnings *report;
};

/* Clamps a number to [0, 1]; NaN becomes 0. */
double statement_clamped(double x);

/* Returns a reflectance with each channel clamped to [0, 1], with a warning, or
 * `missing` in all channels if the file does not give it. */
struct vec3 statement_reflectance(const struct mtl_color *color,
                                  const char *key, float missing,
                                  const struct statement_place *at);

/* Returns a radiance. Channels that are negative or no floats become 0, with a
 * warning. */
struct vec3 statement_radiance(const struct mtl_color *color,
                               const struct statement_place *at);

/* Returns the number if it is in [lo, hi], else `missing`; a number out of
 * range is reported. */
double statement_within(const struct mtl_number *n, const char *key, double lo,
                        double hi, double missing,
                        const struct statement_place *at);

/* Returns a number from 0 to 1; others are clamped, with a warning. */
double statement_unit(const struct mtl_number *n, const char *key,
                      const struct statement_place *at);

#endif
