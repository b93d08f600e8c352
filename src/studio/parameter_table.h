// SPDX-License-Identifier: MIT
/*
 * parameter_table.h - one row for each parameter: its label, its scale, how it
 * is read and written
 *
 * A new parameter is a new row. A number that one MTL statement sets needs
 * nothing else; other values have a function that reads them and one that
 * writes them. Rows are listed on the screen in the order of the table.
 *
 * Units:     those of MTL and view files
 * Ownership: names live as long as edit and scene do not change
 * Threads:   one thread at a time
 */
#ifndef GLIM_PARAMETER_TABLE_H
#define GLIM_PARAMETER_TABLE_H

#include <stddef.h>

#include "studio/parameter.h"

struct value_scale {
    double least, most; /* limits of a typed number */
    double from, to;    /* ends of the scale, and limits of steps */
    double step; /* 0: a tenth of the value, and only 0 lies below `from` */
    int digits;  /* of the text */
    bool wraps;  /* a step beyond `to` goes to 0 */
    bool is_positive;   /* steps do not reach 0 */
    const char *suffix; /* after the number; NULL: none */
    const char *zero;   /* text of 0; NULL: the number */
    const char *expected;
};

/* Largest channel of a colour that is radiance. */
#define RADIANCE_MAX 1e30

extern const struct value_scale scale_unit;
extern const struct value_scale scale_coat; /* without 0, which is no coat */
extern const struct value_scale scale_hue;
extern const struct value_scale scale_ior;
extern const struct value_scale scale_emission;
extern const struct value_scale scale_kelvin;

struct parameter_row;

/* The owner of parameters: a copy of the values of a target. */
struct owner {
    const struct parameter_target *target;
    const struct parameter_row *row;
    struct mtl_source source; /* of a material, */
    struct material material; /* and what glim makes of it */
    uint32_t assigned;        /* of an object: its material, or NO_INDEX */
    struct lighting lighting; /* of the light; its sky_path is lent */
    uint32_t kind; /* enum material_kind; of the light: 1 if there is a sky */
};

enum value_type {
    VALUE_NUMBER,
    VALUE_CHOICE,
    VALUE_COLOR,      /* its three channels are listed as parameters, too */
    VALUE_LIGHT_COLOR /* with largest channel 1, or a temperature */
};

struct value {
    double number; /* or index of a choice, or kelvins of a colour; 0: none */
    double rgb[3]; /* linear */
    const char *note; /* after the text of a choice; NULL: none */
};

/* For `kinds`: every owner has the parameter. */
#define ALL 0xffffffffu

struct parameter_row {
    const char *label;
    uint32_t kinds; /* bits 1 << owner.kind of those that have it */
    enum value_type type;
    const struct value_scale *scale; /* of the number, channels or kelvins */

    /* False if the owner has no such parameter now. */
    bool (*get)(const struct owner *owner, struct value *value);
    void (*set)(struct owner *owner, const struct value *value);
    size_t member; /* offset in mtl_source or lighting, for get and set */
    size_t result; /* offset of a float in struct material, for get */
    enum mtl_map map;

    const char *const *names; /* of the choices; NULL: see name() */
    uint32_t name_count;
    /* Name of choice i: "" if it is not offered, NULL after the last. */
    const char *(*name)(const struct owner *owner, uint32_t i);
    /* Index of the choice for a text; NULL: the one of this name. */
    uint32_t (*find)(const struct owner *owner, const char *text);
    const char *expected; /* text; NULL: the choice is not typed */
};

/* Members of a row whose choices have these names. */
#define CHOICES(array) \
    .names = array, .name_count = sizeof array / sizeof array[0]

/* The rows of a page. */
const struct parameter_row *parameter_table(enum parameter_page page,
                                            int *count);

/* Copies the values of the target from a state of the edit. */
struct owner parameter_owner(const struct parameter_target *target,
                             const struct edit_state *state);

/* Reads the value of owner->row. False if the owner has none. */
bool parameter_read(const struct owner *owner, struct value *value);

#endif
