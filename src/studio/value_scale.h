// SPDX-License-Identifier: MIT
/*
 * value_scale.h - a number that a person turns by steps or types
 *
 * Units:     those of the number
 * Ownership: strings live as long as the scale
 * Threads:   any
 * Errors:    a text that is no number of the scale: what was expected
 */
#ifndef GLIM_VALUE_SCALE_H
#define GLIM_VALUE_SCALE_H

#include <stdbool.h>
#include <stddef.h>

#include "base/error.h"

struct value_scale {
    double least, most; /* that can be typed */
    double from, to;    /* that can be turned */
    double step;
    bool wraps;     /* behind `to` comes 0 */
    bool grows;     /* each step by a tenth; below `from` there is only 0 */
    int digits;     /* that are shown */
    const char *of; /* what stands behind the number; NULL: nothing */
    const char *expected;
};

extern const struct value_scale scale_unit; /* 0 to 1 */
extern const struct value_scale scale_hue;  /* degrees */
extern const struct value_scale
    scale_light; /* radiance, or what multiplies it */
extern const struct value_scale scale_ior;
extern const struct value_scale scale_rotation; /* degrees */
extern const struct value_scale scale_exposure; /* stops */

/* The value some steps on. */
double value_scale_turned(const struct value_scale *scale, double value,
                          int steps);

/* Where the value is between `from` and `to`, 0 to 1. */
double value_scale_place(const struct value_scale *scale, double value);

void value_scale_format(const struct value_scale *scale, double value,
                        char *text, size_t size_bytes);
bool value_scale_parse(const struct value_scale *scale, const char *text,
                       double *value, struct error *err);

#endif
