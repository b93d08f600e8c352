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

/* Fills the owner with a material of these statements. */
void material_parameters_open(struct owner *owner,
                              const struct mtl_source *source);

/* Returns the name of the kind. The swatch is the colour of the light if the
 * material emits any, else the colour of the material. */
const char *material_parameters_summary(const struct mtl_source *source,
                                        double swatch[3]);

#endif
