// SPDX-License-Identifier: MIT
/*
 * material_params.h - what a material's MTL statements mean to a person who
 * changes them
 *
 * One colour, one roughness, one light, whichever statements have them; which
 * these are follows from material_from_source(). What is set through here is
 * what material_from_source() then finds.
 *
 * Units:     those of MTL
 * Threads:   any
 */
#ifndef GLIM_MATERIAL_PARAMS_H
#define GLIM_MATERIAL_PARAMS_H

#include <stdbool.h>

#include "scene/material.h"

/* What glim makes of it; nothing is reported. */
struct material material_params_material(const struct mtl_source *source);
bool material_params_is_glass(const struct material *material);

/* "diffuse", "plastic", "metal", "glass", "thin glass". */
const char *material_params_kind(const struct mtl_source *source);

/* The next kind of these, or the one before, with the same colour. */
void material_params_turn_kind(struct mtl_source *source, int step);

/* Kd, Ks or Tf: the colour of what it is. */
void material_params_color(const struct mtl_source *source, double rgb[3]);
void material_params_set_color(struct mtl_source *source, const double rgb[3]);

/* Pr, or Kd_roughness of what is diffuse. */
double material_params_roughness(const struct mtl_source *source);
void material_params_set_roughness(struct mtl_source *source, double roughness);

/* Luminance of a black body, or the largest channel of Ke. */
double material_params_strength(const struct mtl_source *source);
void material_params_set_strength(struct mtl_source *source, double strength);

/* The light's colour, its largest channel 1; white if it is dark. */
void material_params_light_color(const struct mtl_source *source,
                                 double rgb[3]);
void material_params_set_light_color(struct mtl_source *source,
                                     const double rgb[3]);

/* The light becomes that of a black body, as bright as it was. */
void material_params_set_kelvin(struct mtl_source *source, double kelvin);

/* The colour that stands for it in a list: its light if it shines. */
void material_params_swatch(const struct mtl_source *source, double rgb[3]);

/* Rounds a colour as floats are, to what a file has in few digits: what a
 * person sets is what will be read. */
void material_params_shorten(double rgb[3]);

/* A statement gets this value, and is there. */
void material_params_put_number(struct mtl_number *number, double value);
void material_params_put_color(struct mtl_color *color, const double rgb[3]);

double material_params_largest(const double rgb[3]);

#endif
