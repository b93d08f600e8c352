// SPDX-License-Identifier: MIT
/*
 * kinds.h - changes the kind of a material as the panel does
 */
#ifndef TESTS_KINDS_H
#define TESTS_KINDS_H

#include <stdlib.h>

#include "studio/material_parameters.h"

/* Steps forward by this many kinds, or back. */
static inline void step_kind(struct material_values *source, int steps)
{
    struct owner o = {.row = &material_parameters[0]};
    struct value v;

    for (int i = abs(steps); i > 0; i--) {
        material_parameters_open(&o, source, NULL);
        parameter_read(&o, &v);
        v.number = ((int)v.number + (steps > 0 ? 1 : 4)) % 5;
        o.row->set(&o, &v);
        *source = o.source;
    }
}

#endif
