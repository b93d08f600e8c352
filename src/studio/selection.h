// SPDX-License-Identifier: MIT
/*
 * selection.h - what of a scene is selected for editing: a material, an object,
 * or the light
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
    uint32_t material, object;
    bool by_hsv;
};

void selection_init(struct selection *s, struct session *session);
void selection_free(struct selection *s);

/* How long the list is from which is selected, and which of it is shown: not
 * the material of what has none, nor objects without a face, nor duplicates
 * that were undone. */
uint32_t selection_count(const struct selection *s);
bool selection_is_listed(const struct selection *s, uint32_t i);

/* The material or object of the list that is selected. */
uint32_t selection_index(const struct selection *s);
void selection_set(struct selection *s, uint32_t i);

/* True if there is something to edit. */
bool selection_has_one(const struct selection *s);

/* Up or down the list, as far as it goes. */
void selection_move(struct selection *s, int steps);

/* What was selected may have gone: takes one beside it. */
void selection_settle(struct selection *s);

/* The names of what is selected, for free(), and the same by them in what was
 * loaded anew; false if what the page shows has gone. */
struct selection_names {
    char *material, *object;
};
struct selection_names selection_names(const struct selection *s);
bool selection_find(struct selection *s, const struct selection_names *names);

/* The knobs of what is selected; 0: there is nothing. */
int selection_knobs(const struct selection *s,
                    struct parameter knobs[PARAMETERS_MAX]);
struct parameter_target selection_target(const struct selection *s);

/* The material that an object is shown with. */
uint32_t selection_material_of(const struct selection *s, uint32_t object);

#endif
