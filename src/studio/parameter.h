// SPDX-License-Identifier: MIT
/*
 * parameter.h - the values that a person can change: of a material, of an
 * object, of the light
 *
 * A parameter is a row of parameter_table.h. It is shown as a text with a
 * position on a scale or a colour, and changed by steps or by a typed text.
 * Every change goes through the edit's history.
 *
 * Units:     those of MTL and view files
 * Threads:   one thread at a time
 * Errors:    a typed text that does not fit: what was expected
 */
#ifndef GLIM_PARAMETER_H
#define GLIM_PARAMETER_H

#include <stdbool.h>
#include <stdint.h>

#include "session/edit_history.h"

enum parameter_page { PARAMETER_MATERIAL, PARAMETER_OBJECT, PARAMETER_LIGHT };

/* The material, the object or the light whose parameters are meant. */
struct parameter_target {
    struct edit *edit;
    const struct scene *scene;
    enum parameter_page page;
    uint32_t index; /* of the material or object */
    bool by_hsv;    /* channels of colours are hue, saturation and value */
};

#define PARAMETER_TEXT_BYTES 64

/* A parameter as it is now. */
struct parameter {
    int id; /* for parameter_step() and parameter_set_text() */
    const char *label;
    char text[PARAMETER_TEXT_BYTES];
    double fraction; /* of its scale, 0 to 1; below 0: it has none */
    bool takes_text;
    bool has_color;
    double color[3]; /* linear */
};

#define PARAMETERS_MAX 64

/* Lists the target's parameters and returns their number. */
int parameters_list(const struct parameter_target *target,
                    struct parameter list[PARAMETERS_MAX]);

/* Moves a number by some steps of its scale, and a choice to the next one or
 * the one before. */
void parameter_step(const struct parameter_target *target, int id, int steps);

/* Gives a parameter that takes text the value that the text says. */
bool parameter_set_text(const struct parameter_target *target, int id,
                        const char *text, struct error *err);

#endif
