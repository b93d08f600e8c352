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

/* Plastic above a medium, or clear glass if depth is 0. */
struct substance {
    const char *name;
    double ior, abbe; /* of glass; an Abbe number of 0: no dispersion */
    double roughness;
    double depth;                 /* width of the body in mean free paths */
    double scatter[3], absorb[3]; /* coefficients in any unit of length */
};

/* The substance of choice i from 1 on, or NULL. Choice 0 is any other. */
const struct substance *substance_at(uint32_t i);

/* Finds the color of a thick body of a substance. */
void substance_color(const struct substance *substance, double rgb[3]);

/* Finds the mean free paths in a body of this width. */
void substance_path(const struct substance *substance, double width,
                    double rgb[3]);

/* Returns the largest side of the first object with the selected material, or
 * of the scene if it has none, in units of the file. */
double body_size(const struct selection *selection);

/* Names of fogs: none, those of the table, and any other one. */
const char *fog_name(const struct owner *owner, uint32_t i);

/* Returns the index of the name of this fog. */
uint32_t fog_find(const struct fog *fog);

/* Returns the fog of index i, which lies on the ground of the scene. */
struct fog fog_preset(uint32_t i, const struct selection *selection);

#endif
