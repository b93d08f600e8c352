// SPDX-License-Identifier: MIT
/*
 * parameter.h - the values that a person turns: of a material, of an object, of
 * the light
 *
 * A knob has a name, a text, perhaps a place on a scale and a colour; it is
 * turned by steps, or set by parameter_text.h. All goes through the edit's
 * history. What values mean for a material is material_from_source()'s to say.
 *
 * Units:     those of MTL and view files
 * Threads:   one thread at a time
 */
#ifndef GLIM_PARAMETER_H
#define GLIM_PARAMETER_H

#include <stdbool.h>
#include <stdint.h>

#include "session/edit_history.h"

enum parameter_page { PARAMETER_MATERIAL, PARAMETER_OBJECT, PARAMETER_LIGHT };

/* Whose knobs. */
struct parameter_target {
    enum parameter_page page;
    uint32_t index; /* of the material or object */
    bool by_hsv;    /* colours are turned by hue, saturation, value */
};

/* What a knob turns. */
enum parameter_id {
    PARAMETER_KIND,
    PARAMETER_COLOR,
    PARAMETER_CHANNEL, /* and the two after it */
    PARAMETER_ROUGHNESS = PARAMETER_CHANNEL + 3,
    PARAMETER_COAT,
    PARAMETER_IOR,
    PARAMETER_GLOW,
    PARAMETER_GLOW_COLOR,
    PARAMETER_COVER,
    PARAMETER_ASSIGNED,
    PARAMETER_SKY_IMAGE,
    PARAMETER_SKY_STRENGTH,
    PARAMETER_SKY_ROTATION,
    PARAMETER_EXPOSURE,
    PARAMETER_TONE,
    PARAMETER_MAP /* and the others after it */
};

struct parameter {
    int id; /* enum parameter_id */
    const char *label;
    char text[64];
    double place; /* on a scale from 0 to 1; below 0: there is none */
    bool has_color;
    double color[3]; /* linear */
};

#define PARAMETERS_MAX   24
#define PARAMETER_COARSE 10 /* steps at once */

/* The knobs of the target as they are shown now; their number. */
int parameters_list(const struct edit *edit, const struct scene *scene,
                    const struct parameter_target *target,
                    struct parameter knobs[PARAMETERS_MAX]);

/* Turns a knob by some steps; what has two states goes to the other. */
void parameter_turn(struct edit *edit, const struct parameter_target *target,
                    int id, int steps);

#endif
