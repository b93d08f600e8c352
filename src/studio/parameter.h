// SPDX-License-Identifier: MIT
/*
 * parameter.h - values of a material, of an object or of the light that the
 * user can change
 *
 * A parameter is a row of parameter_table.h. It is shown as a text with a
 * position on a scale or a colour, and changed by steps or by a typed text.
 * Every change goes through the edit's history.
 *
 * Units:     those of MTL and view files
 * Threads:   one thread at a time
 * Errors:    the text of an error says what was expected
 */
#ifndef GLIM_PARAMETER_H
#define GLIM_PARAMETER_H

#include <stdbool.h>
#include <stdint.h>

#include "studio/selection.h"

#define PARAMETER_TEXT_BYTES 64

/* Parameter with its current value. */
struct parameter {
    int id; /* for parameter_step() and parameter_set_text() */
    const char *label;
    char text[PARAMETER_TEXT_BYTES];
    double fraction; /* position on the scale, 0 to 1; negative if there is no
                        scale */
    bool takes_text;
    bool has_color;
    double color[3];  /* linear */
    uint32_t texture; /* the texture that it switches; NO_INDEX: none */
    uint32_t lamp;    /* the light that has it; NO_INDEX: none */
};

/* Lamps that are listed at most, and room for their parameters. */
#define PARAMETER_LAMPS 16
#define PARAMETERS_MAX  288

/* Lists the parameters of what is selected and returns their number. */
int parameters_list(const struct selection *selection,
                    struct parameter list[PARAMETERS_MAX]);

/* Returns a new lamp for the light: a copy of lamp `number`, or a point light
 * in the middle of the scene for NO_INDEX. */
struct lamp parameter_new_lamp(const struct selection *selection,
                               uint32_t number);

/* Changes a number by steps of its scale, and a choice to the next or previous
 * one. */
void parameter_step(const struct selection *selection, int id, int steps);

/* Sets a number to a position on its scale, 0 to 1. */
void parameter_set_fraction(const struct selection *selection, int id,
                            double fraction);

/* Finds the colour that a channel at a position on its scale makes of its
 * colour. Returns false if the parameter is no channel. */
bool parameter_color_at(const struct selection *selection, int id,
                        double fraction, double rgb[3]);

/* Sets a parameter to the value of a text. Returns false if the text does not
 * fit. */
bool parameter_set_text(const struct selection *selection, int id,
                        const char *text, struct error *err);

#endif
