// SPDX-License-Identifier: MIT
/*
 * presets.h - substances and fogs by name
 *
 * Files have no scale, so that a preset keeps the colour of measured
 * coefficients, and takes its density from the size of the body, or for a fog
 * from the distance between the eye and what it looks at.
 *
 * Units:     coefficients per unit of length of the file
 * Threads:   one thread at a time
 */
#ifndef GLIM_PRESETS_H
#define GLIM_PRESETS_H

#include "studio/parameter_table.h"

/* Solid with a surface of glass, and the medium in it. */
struct substance {
    const char *name;
    double ior, abbe; /* an Abbe number of 0: no dispersion */
    double roughness;
    double depth;      /* width of the body in mean free paths */
    struct fog medium; /* in any unit of length */
};

/* The substance of choice i from 1 on, or NULL. Choice 0 is any other. */
const struct substance *substance_at(uint32_t i);

/* Returns the medium of a substance in a body that is as large as the first
 * object with the selected material. */
struct fog substance_medium(const struct substance *substance,
                            const struct selection *selection);

/* Names of fogs: none, those of the table, and any other one. */
const char *fog_name(const struct owner *owner, uint32_t i);

/* Returns the index of the name of this fog. */
uint32_t fog_find(const struct fog *fog);

/* Returns the fog of index i, which lies on the ground of the scene. */
struct fog fog_preset(uint32_t i, const struct selection *selection);

#endif
