// SPDX-License-Identifier: MIT
/*
 * parameter_table.h - tables of parameters: label, scale, and functions that
 * read and write the value
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
    double step;      /* 0 if a step is a tenth of the value; then 0 is the only
                         value below `from` */
    int digits;       /* digits of the text */
    bool wraps;       /* a step beyond `to` continues at 0 */
    bool is_positive; /* steps do not reach 0 */
    const char *suffix; /* text after the number, or NULL */
    const char *zero;   /* text for 0; NULL shows the number */
};

/* Limit for the channels of a colour that is radiance. */
#define RADIANCE_MAX 1e30

extern const struct value_scale scale_unit;
extern const struct value_scale scale_specular; /* 0 is outside */
extern const struct value_scale scale_hue;
extern const struct value_scale scale_ior;
extern const struct value_scale scale_abbe;
extern const struct value_scale scale_film_ior;
extern const struct value_scale scale_film_thickness; /* in nanometres */
extern const struct value_scale scale_emission;       /* and distances */
extern const struct value_scale scale_kelvin;
extern const struct value_scale scale_density;
extern const struct value_scale scale_anisotropy;

struct parameter_row;

/* Kind of sky of the light, as owner.kind. */
enum sky_kind { SKY_CONSTANT, SKY_IMAGE, SKY_SUN };

/* Owner of parameters: a copy of the values of what is selected. */
struct owner {
    const struct selection *selection;
    const struct parameter_row *row;
    struct material_values
        source; /* statements of a material, which are edited */
    struct material_values factors; /* what is rendered of them, and shown */
    struct material material;       /* material made from that */
    enum mtl_map map;               /* of the row */
    uint32_t assigned;              /* material of an object, or NO_INDEX */
    struct lighting lighting;       /* values of the light; sky_path is lent */
    const struct lamps *lamps;      /* all lamps of the light, lent */
    uint32_t lamp_number;           /* of the row's lamp; NO_INDEX: none */
    struct lamp lamp;
    const struct smokes *smokes; /* of the light, lent */
    uint32_t smoke_number;       /* of the row's smoke; NO_INDEX: none */
    struct smoke_numbers smoke;
    struct value_scale place; /* of coordinates: depends on the scene's size */
    uint32_t kind; /* enum material_kind; for the light enum sky_kind */
};

enum value_type {
    VALUE_NUMBER,
    VALUE_CHOICE,
    VALUE_TRIPLE,     /* three numbers, one for each channel */
    VALUE_COLOR,      /* the three channels are listed as parameters, too */
    VALUE_LIGHT_COLOR /* colour with largest channel 1, or a temperature */
};

struct value {
    double number;    /* number, index of a choice, or kelvins of a colour (0 if
                         none) */
    double rgb[3];    /* linear, or of a triple */
    const char *note; /* text after that of a choice, or NULL */
};

/* Value of `kinds` for parameters that every owner has. */
#define ALL 0xffffffffu

struct parameter_row {
    const char *label; /* NULL: the kind of the lamp, or the key of the map */
    /* bits 1 << owner.kind of the owners that have it; for a lamp's parameters
     * 1 << lamp.kind */
    uint32_t kinds;
    enum value_type type;
    /* of the number, channels or kelvins; NULL: owner.place */
    const struct value_scale *scale;

    /* Returns false if the owner has no such parameter now. */
    bool (*get)(const struct owner *owner, struct value *value);
    void (*set)(struct owner *owner, const struct value *value);
    /* offset in material_values, lighting, lamp or smoke_numbers, or enum
     * medium_value */
    size_t member;
    size_t result; /* offset of a float in struct material, for get */
    double absent; /* value of a statement that the file does not have */

    const char *const *names; /* names of the choices; NULL to call name() */
    uint32_t name_count;
    /* Returns the name of choice i: "" if it is not offered, NULL behind the
     * last. */
    const char *(*name)(const struct owner *owner, uint32_t i);
    /* Returns the index of the choice for a text; NULL if choices are found by
     * name. */
    uint32_t (*find)(const struct owner *owner, const char *text);
    const char *expected; /* text of errors; NULL if not typed */
    bool is_map;          /* an image is chosen for owner.map */
};

/* Sets the members of a row whose choices have these names. */
#define CHOICES(array) \
    .names = array, .name_count = sizeof array / sizeof array[0]

/* Sets owner->row to row i of its page: the table's, then those of each map, or
 * of each lamp and smoke. Returns false behind the last. */
bool parameter_choose_row(struct owner *owner, int i);

/* Returns the number, from 1, of the lamp or smoke whose first row it is, or
 * 0. */
uint32_t parameter_heads(const struct owner *owner);

/* Returns the label of owner->row. */
const char *parameter_label(const struct owner *owner);

/* Copies the values of what is selected from a state of the edit. */
struct owner parameter_owner(const struct selection *selection,
                             const struct edit_state *state);

/* Reads the value of owner->row. Returns false if the owner has none. */
bool parameter_read(const struct owner *owner, struct value *value);

#endif
