// SPDX-License-Identifier: MIT
/*
 * parameter.h - the material, the object or the light that is being edited, and
 * its values that the user can change
 *
 * Each page of the panel lists the materials or the objects of the scene, one
 * of which is selected. The page of the light has no list. A parameter is a row
 * of parameter_table.h. It is shown as a text with a position on a scale or a
 * colour, and changed by steps or by a typed text. Every change goes through
 * the edit's history.
 *
 * Units:     those of MTL and view files
 * Ownership: edit and scene stay the caller's; selection_free() frees the rest
 * Threads:   one thread at a time
 * Errors:    the text of an error says what was expected
 */
#ifndef GLIM_PARAMETER_H
#define GLIM_PARAMETER_H

#include <stdbool.h>
#include <stdint.h>

#include "session/edit.h"
#include "world/world.h"

/* ---- selections ---- */

enum selection_page { PAGE_MATERIALS, PAGE_OBJECTS, PAGE_LIGHT, PAGES };

struct selection {
    struct edit *edit;
    const struct scene *scene;
    const struct host_world *world; /* has the images; NULL: all are there */
    enum selection_page page;
    uint32_t index[PAGES]; /* selected material or object of each page */
    bool by_hsv;           /* channels of colours are hue, saturation and value,
                              else red, green and blue */
    uint32_t *first_tris;  /* first triangle of each object, or NO_INDEX */
    uint32_t *listed; /* list of the page: materials with a name, objects with a
                         face, no duplicate that was undone */
    int listed_count;
    int row;              /* row of the selected entry in the list */
    enum mtl_map new_map; /* as which an image is added */
};

/* Names of the selected material and object, for free(). */
struct selection_names {
    char *material, *object;
};

void selection_init(struct selection *s, struct edit *edit,
                    const struct scene *scene, const struct host_world *world);
void selection_free(struct selection *s);

/* Makes the list again after a change of page, index or scene. If the selected
 * entry has gone, the one above it is selected. */
void selection_settle(struct selection *s);

/* Returns true if a material, object or light is selected. */
bool selection_has_one(const struct selection *s);

/* Moves the selection down by some rows, or up if negative, within the list. */
void selection_move(struct selection *s, int steps);

/* Returns the names of the selected material and object. */
struct selection_names selection_names(const struct selection *s);

/* Selects the material and object with these names in a scene that was loaded
 * again. Returns false if the page has none. */
bool selection_renew(struct selection *s, const struct selection_names *names);

/* Returns the name of a material or object, or a text for an empty name. */
const char *selection_name(const struct selection *s, enum selection_page page,
                           uint32_t i);

/* Returns the selected material, or that of the selected object. */
uint32_t selection_material(const struct selection *s);

/* Returns the material that an object is shown with. */
uint32_t selection_material_of(const struct selection *s, uint32_t object);

/* ---- parameters ---- */

#define PARAMETER_TEXT_BYTES 64

/* Parameter with its current value. */
struct parameter {
    int id; /* for parameter_step() and parameter_set_text() */
    const char *label;
    char text[PARAMETER_TEXT_BYTES];
    double fraction; /* position on the scale, 0 to 1; negative if there is no
                        scale */
    bool has_steps;  /* false: a colour, only its channels have steps */
    bool takes_text;
    char takes[32]; /* which text that is, for a hint: "0 to 1" */
    bool has_color;
    double color[3];  /* linear */
    enum mtl_map map; /* that an image is for; MTL_MAPS: none */
    uint32_t texture; /* the texture that it switches; NO_INDEX: none */
    uint32_t lamp;    /* the lamp that has it; NO_INDEX: none */
    uint32_t heads;   /* number, from 1, of the lamp or smoke whose first one it
                         is; 0: none */
};

/* Lamps that are listed at most, and room for their parameters. */
#define PARAMETER_LAMPS 16
#define PARAMETERS_MAX  416

/* Lists the parameters of what is selected and returns their number. */
int parameters_list(const struct selection *selection,
                    struct parameter list[PARAMETERS_MAX]);

/* Returns a new lamp for the light: a copy of lamp `number`, or a point light
 * in the middle of the scene for NO_INDEX. */
struct lamp parameter_new_lamp(const struct selection *selection,
                               uint32_t number);

/* Changes a number by steps of its scale, and a choice to the next or previous
 * one. */
void parameter_step(struct selection *selection, int id, int steps);

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
