// SPDX-License-Identifier: MIT
/*
 * parameter.h - the values that a person turns: of a material, of an object, of the
 * light
 *
 * A knob has a name, a text, perhaps a place on a scale and a colour; it is
 * turned by steps, or set by parameter_text.h. All goes through the edit's
 * history. What values mean for a material is material_from_source()'s to say.
 *
 * Units:     those of MTL and view files
 * Ownership: none
 * Threads:   one thread at a time
 * Errors:    none
 */
#ifndef GLIM_PARAMETER_H
#define GLIM_PARAMETER_H

#include "session/edit_history.h"

enum knob_page { KNOB_MATERIAL, KNOB_OBJECT, KNOB_LIGHT };

/* Whose knobs. */
struct knob_target {
    enum knob_page page;
    uint32_t index; /* of the material or object */
    bool by_hsv;    /* colours are turned by hue, saturation, value */
};

/* What a knob turns. */
enum knob_id {
    KNOB_KIND,
    KNOB_COLOR,
    KNOB_CHANNEL, /* and the two after it */
    KNOB_ROUGHNESS = KNOB_CHANNEL + 3,
    KNOB_COAT,
    KNOB_IOR,
    KNOB_GLOW,
    KNOB_GLOW_COLOR,
    KNOB_COVER,
    KNOB_ASSIGNED,
    KNOB_SKY_IMAGE,
    KNOB_SKY_STRENGTH,
    KNOB_SKY_ROTATION,
    KNOB_EXPOSURE,
    KNOB_TONE,
    KNOB_MAP /* and the others after it */
};

struct knob {
    int id; /* enum knob_id */
    const char *label;
    char text[64];
    double place; /* on a scale from 0 to 1; below 0: there is none */
    bool has_color;
    double color[3]; /* linear */
};

#define KNOBS_MAX   24
#define KNOB_COARSE 10 /* steps at once */

/* The knobs of the target as they are shown now; their number. */
int knobs_list(const struct edit *edit, const struct scene *scene,
               const struct knob_target *target, struct knob knobs[KNOBS_MAX]);

/* Turns a knob by some steps; what has two states goes to the other. */
void knob_turn(struct edit *edit, const struct knob_target *target, int id,
               int steps);

#endif
