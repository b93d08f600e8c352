// SPDX-License-Identifier: MIT
/*
 * medium_parameters.h - density, colour and coefficients of a medium, as the
 * panel shows and changes them
 *
 * The medium of a solid has the members of a fog, without base and falloff.
 * Density is the largest extinction of the three channels. The colour is that
 * of a thick layer under white light. A change of one keeps the other.
 *
 * Units:     coefficients per unit of length of the file
 * Threads:   any
 */
#ifndef GLIM_MEDIUM_PARAMETERS_H
#define GLIM_MEDIUM_PARAMETERS_H

#include "studio/parameter_table.h"

/* Values of a medium, as parameter_row.member. */
enum medium_value {
    MEDIUM_DENSITY,
    MEDIUM_COLOR,
    MEDIUM_SCATTER,
    MEDIUM_ABSORB
};

double medium_density(const struct fog *medium);

/* Multiplies the coefficients, so that the medium has this density. A medium of
 * density 0 becomes a white one. */
void medium_set_density(struct fog *medium, double density);

/* True if the coefficients are the same but for a factor. */
bool medium_is_alike(struct fog a, struct fog b);

/* Reads a value. Returns false for all but the density if that is 0. */
bool medium_read(const struct fog *medium, size_t which, struct value *value);
void medium_change(struct fog *medium, size_t which, const struct value *value);

#endif
