// SPDX-License-Identifier: MIT
/*
 * comparison.h - kept renders, and the present one beside or against one of
 * them
 *
 * The wipe shows a kept render at its left and the present one at its right.
 * The view of differences marks where they differ by more than their noise. A
 * strip at the bottom shows all kept renders.
 *
 * Units:     pixels of frames; the wipe as a part of the width
 * Ownership: control is the caller's; comparison_free() frees the rest
 * Threads:   main only
 * Errors:    become messages
 */
#ifndef GLIM_COMPARISON_H
#define GLIM_COMPARISON_H

#include "inspect/snapshot.h"
#include "session/keymap.h"
#include "session/live_render.h"

#define COMPARISON_KEPT_MAX 6

enum comparison_mode {
    COMPARISON_OFF,
    COMPARISON_WIPE,
    COMPARISON_DIFFERENCE,
    COMPARISON_MODES
};

struct comparison {
    struct live_render *control;
    enum comparison_mode mode;
    double wipe; /* 0: only the present render */
    struct snapshot kept[COMPARISON_KEPT_MAX];
    int count, chosen;
    char legend[128]; /* text of the status line; "" while off */

    /* kept renders as painted for the frame's size and this development */
    struct frame painted[COMPARISON_KEPT_MAX], thumbs[COMPARISON_KEPT_MAX];
    int width, height;
    struct develop develop;
    struct snapshot_blocks blocks;
    uint64_t blocks_ns; /* when they were found */
};

void comparison_init(struct comparison *c, struct live_render *control);

/* Keeps the present render and compares with it. The oldest one goes if there
 * are too many. */
void comparison_keep(struct comparison *c);

/* Shows the wipe, then the differences, then neither. */
void comparison_next(struct comparison *c);

/* Takes an action while comparing: arrows move the wipe and choose, Esc ends.
 * Returns false if it means nothing here. */
bool comparison_takes(struct comparison *c, enum action action);

/* Moves the wipe to a part of the width. */
void comparison_wipe_to(struct comparison *c, double part);

/* Paints the comparison into the frame, which shows the present render. Call it
 * only while there is one. */
void comparison_paint(struct comparison *c, struct frame *frame);

void comparison_free(struct comparison *c);

#endif
