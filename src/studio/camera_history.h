// SPDX-License-Identifier: MIT
/*
 * camera_history.h - cameras that were, to go back to and forth again
 *
 * Units:     steps
 * Ownership: history_free() frees; a zeroed struct is empty
 * Threads:   one thread at a time
 * Errors:    none
 */
#ifndef GLIM_CAMERA_HISTORY_H
#define GLIM_CAMERA_HISTORY_H

#include "scene/view.h"

struct history {
    struct pose *poses;
    int at;       /* steps that can be undone: the poses before them */
    int count;    /* and behind them those that can be done again */
    int capacity; /* of poses */
};

/* The camera is about to leave this pose. What was undone is forgotten. */
void history_add(struct history *h, const struct pose *before);

/* Takes *pose, the present one, one step back, or forth again. False if there
 * is none. */
bool history_undo(struct history *h, struct pose *pose);
bool history_redo(struct history *h, struct pose *pose);

void history_free(struct history *h);

#endif
