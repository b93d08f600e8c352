// SPDX-License-Identifier: MIT
/*
 * selection.h - the material, the object or the light that is being edited
 *
 * Each page of the panel lists the materials or the objects of the scene, one
 * of which is selected. The page of the light has no list.
 *
 * Ownership: edit and scene stay the caller's; selection_free() frees the rest
 * Threads:   one thread at a time
 */
#ifndef GLIM_SELECTION_H
#define GLIM_SELECTION_H

#include <stdbool.h>
#include <stdint.h>

#include "session/edit.h"
#include "world/world.h"

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
    int row; /* row of the selected entry in the list */
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

#endif
