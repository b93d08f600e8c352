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
    uint32_t *first_tris; /* one an object; NO_INDEX: it has none */
    enum parameter_page page;
    uint32_t index[PARAMETER_LIGHT + 1]; /* of each page: what is selected */
    bool by_hsv;                         /* see struct parameter_target */
};

void selection_init(struct selection *s, struct session *session);
void selection_free(struct selection *s);

/* Number of materials or objects of the page. The list shows those that are
 * listed: no material without a name, no object without a face, no duplicate
 * that was undone. */
uint32_t selection_count(const struct selection *s);
bool selection_is_listed(const struct selection *s, uint32_t i);

/* True if there is something to edit. */
bool selection_has_one(const struct selection *s);

/* Selects the one so many steps further down the list, or its last. */
void selection_move(struct selection *s, int steps);

/* Selects a neighbour of what is no longer there. */
void selection_settle(struct selection *s);

/* The names of what is selected, for free(). Selects what has these names, in
 * a scene that was loaded anew; false if it has none for the page. */
struct selection_names {
    char *material, *object;
};
struct selection_names selection_names(const struct selection *s);
bool selection_find(struct selection *s, const struct selection_names *names);

struct parameter_target selection_target(const struct selection *s);

/* Name of a material or object as it is shown: an empty one is said to be so.
 */
const char *selection_name(const struct selection *s, enum parameter_page page,
                           uint32_t i);

/* The material that an object is shown with. */
uint32_t selection_material_of(const struct selection *s, uint32_t object);

#endif
