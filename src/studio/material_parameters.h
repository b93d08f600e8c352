// SPDX-License-Identifier: MIT
/*
 * material_parameters.h - the parameters of a material, on its MTL statements
 *
 * A person sees one kind, one colour, one roughness and one light; the
 * statements that have them follow from the kind, as in
 * material_from_source(). After a change it finds the value that was set.
 *
 * Units:     those of MTL
 * Threads:   any
 */
#ifndef GLIM_MATERIAL_PARAMETERS_H
#define GLIM_MATERIAL_PARAMETERS_H

#include "studio/parameter_table.h"

#define MATERIAL_PARAMETERS 17

extern const struct parameter_row material_parameters[MATERIAL_PARAMETERS];

/* Makes the material with these statements the owner. */
void material_parameters_open(struct owner *owner,
                              const struct mtl_source *source);

/* Name of the kind, and the colour that stands for the material in a list: that
 * of its light if it emits any. */
const char *material_parameters_summary(const struct mtl_source *source,
                                        double swatch[3]);

#endif
