// SPDX-License-Identifier: MIT
/*
 * comparison.h - kept renders, and the present one beside or against one of
 * them
 *
 * The wipe shows a kept render at its left and the present one at its right.
 * The view of differences marks where they differ by more than their noise. A
 * strip at the bottom shows all kept renders.
 *
 * Units:     linear light; pixels of frames; the wipe as a part of the width
 * Ownership: control is the caller's; comparison_free() and snapshot_free()
 *            free
 * Threads:   main only; rows of the film are locked
 * Errors:    become messages
 */
#ifndef GLIM_COMPARISON_H
#define GLIM_COMPARISON_H

#include "film/film.h"
#include "film/film_error.h"
#include "session/keymap.h"
#include "session/live_render.h"

/* ---- kept renders ---- */

/*
 * Each pixel has its mean and e, half the difference of the means of its two
 * halves, see film_error.h. A difference of means over a block of pixels is
 * significant if it is more than `bound` times the root of the sum of e^2 of
 * both renders: then less than one picture in twenty has a marked block where
 * only the noise differs.
 */

struct snapshot {
    int width, height;
    struct snapshot_pixel *pixels;
    uint64_t spp;
    struct film_error error;
    struct frame shown; /* as the screen showed it, filtered; no pixels: none */
    struct develop develop; /* of that frame */
};

struct snapshot_pixel {
    float mean[3], e[3];
    float is_known; /* 1: both halves have a sample; 0: e is unknown */
};

/* Keeps the film. A pixel without a known error has e = 0. */
bool snapshot_take(struct snapshot *kept, struct film *film, struct error *err);

uint64_t snapshot_bytes(const struct snapshot *kept);

/* Develops it into a frame of any size, as film_preview() does. */
void snapshot_paint(const struct snapshot *kept, struct develop how,
                    struct frame *frame);

/* Blocks of pixels, row 0 at the top. */
struct snapshot_blocks {
    int cols, rows;
    struct snapshot_block {
        float difference; /* of the means of the channels, relative to theirs */
        bool is_significant;
    } * blocks;
    int significant_count;
    bool is_unknown; /* no block has two samples of each pixel in both */
};

/* Finds the blocks in which the film differs from the kept render. There are no
 * more than cols x rows of them, and each has 8 x 8 pixels or more. Of large
 * films not all rows are read. */
bool snapshot_differences(const struct snapshot *kept, struct film *film,
                          int cols, int rows, struct snapshot_blocks *blocks,
                          struct error *err);

void snapshot_blocks_free(struct snapshot_blocks *blocks);
void snapshot_free(struct snapshot *kept);

/* ---- comparison ---- */

/*
 * The wipe shows a kept render at its left and the present one at its right.
 * The view of differences marks where they differ by more than their noise. A
 * strip at the bottom shows all kept renders.
 */

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
 * are too many. Takes the frame that shows it filtered, for the wipe, unless
 * nothing is kept; one without pixels: it is not filtered. */
void comparison_keep(struct comparison *c, struct frame *shown);

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
