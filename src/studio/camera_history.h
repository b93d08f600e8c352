// SPDX-License-Identifier: MIT
/*
 * camera_history.h - cameras that were, to go back to and forth again
 *
 * Units:     steps
 * Ownership: camera_history_free() frees; a zeroed struct is empty
 * Threads:   one thread at a time
 */
#ifndef GLIM_CAMERA_HISTORY_H
#define GLIM_CAMERA_HISTORY_H

#include <stdbool.h>

#include "scene/view.h"

struct camera_history {
    struct pose *poses;
    int at;       /* steps that can be undone: the poses before them */
    int count;    /* and behind them those that can be done again */
    int capacity; /* of poses */
};

/* The camera is about to leave this pose. What was undone is forgotten. */
void camera_history_add(struct camera_history *h, const struct pose *before);

/* Takes *pose, the present one, one step back, or forth again. False if there
 * is none. */
bool camera_history_undo(struct camera_history *h, struct pose *pose);
bool camera_history_redo(struct camera_history *h, struct pose *pose);

void camera_history_free(struct camera_history *h);

#endif
