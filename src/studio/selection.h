// SPDX-License-Identifier: MIT
/*
 * selection.h - the material, the object or the light that is being edited
 *
 * Each page of the panel lists the materials or the objects of the scene and
 * has one of them selected; the page of the light has no list.
 *
 * Ownership: the session stays the caller's; selection_free() frees the rest
 * Threads:   one thread at a time
 */
#ifndef GLIM_SELECTION_H
#define GLIM_SELECTION_H

#include <stdbool.h>
#include <stdint.h>

#include "session/session.h"
#include "studio/parameter.h"

struct selection {
    struct session *session;
    uint32_t *first_tris; /* of each object; NO_INDEX: it has no triangle */
    enum parameter_page page;
    uint32_t index[PARAMETER_LIGHT + 1]; /* of the selected one, by page */
    uint32_t *listed; /* the list of the page: materials with a name, objects
                         with a face, no duplicate that was undone */
    int listed_count;
    int row;     /* of the selected one, in the list */
    bool by_hsv; /* see struct parameter_target */
};

/* Names of the selected material and object. */
struct selection_names {
    char *material, *object;
};

void selection_init(struct selection *s, struct session *session);
void selection_free(struct selection *s);

/* Makes the list anew, after a change of page, index or scene. If the selected
 * one has gone, the one above it is selected. */
void selection_settle(struct selection *s);

/* True if there is something to edit. */
bool selection_has_one(const struct selection *s);

/* Selects the row some steps further down, or up, as far as the list goes. */
void selection_move(struct selection *s, int steps);

/* The names are for free(). */
struct selection_names selection_names(const struct selection *s);

/* For a scene that was loaded anew: selects what has these names. False if the
 * page has none. */
bool selection_renew(struct selection *s, const struct selection_names *names);

struct parameter_target selection_target(const struct selection *s);

/* Name of a material or object, with a text in place of an empty name. */
const char *selection_name(const struct selection *s, enum parameter_page page,
                           uint32_t i);

/* The material that an object is shown with. */
uint32_t selection_material_of(const struct selection *s, uint32_t object);

#endif
