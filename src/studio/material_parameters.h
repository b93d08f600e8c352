// SPDX-License-Identifier: MIT
/*
 * material_parameters.h - the parameters of a material, on its MTL statements
 *
 * A material has one kind, one colour, one roughness and one emission on the
 * screen. Its kind decides which statements hold them, as in
 * material_from_source(), which finds the same values after a change.
 *
 * Units:     those of MTL
 * Threads:   any
 */
#ifndef GLIM_MATERIAL_PARAMETERS_H
#define GLIM_MATERIAL_PARAMETERS_H

#include "studio/parameter_table.h"
#include "world/world.h"

/* The rows of all kinds of material; the last one has no label. */
extern const struct parameter_row material_parameters[];

/* The row of each map, and that which adds an image as a map. */
extern const struct parameter_row map_parameter, new_map_parameter;

/* Fills the owner with the material of these statements, as the world renders
 * it. Without a world (NULL), all images are there. */
void material_parameters_open(struct owner *owner,
                              const struct material_values *source,
                              const struct host_world *world);

/* Returns the name of the material's kind. The swatch is the colour of its
 * emission if it emits light, else the colour of the material. */
const char *material_parameters_summary(const struct material_values *source,
                                        const struct host_world *world,
                                        double swatch[3]);

#endif
