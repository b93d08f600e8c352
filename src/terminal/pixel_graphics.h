// SPDX-License-Identifier: MIT
/*
 * pixel_graphics.h - a picture as pixels of the terminal
 *
 * The picture goes out as tiles, parts of a row of cells: a frame sends those
 * that differ from what is shown, until its budget is spent, and the next one
 * goes on where it stopped. So a slow line never has more on its way than with
 * cells, and windows have their place.
 *
 * Units:     pixels; terminal cells for places
 * Ownership: pixel_graphics_free() frees; a zeroed struct is empty
 * Threads:   one thread at a time
 * Errors:    memory
 */
#ifndef GLIM_PIXEL_GRAPHICS_H
#define GLIM_PIXEL_GRAPHICS_H

#include <stdbool.h>
#include <stdint.h>

#include "terminal/ansi_diff.h"

enum pixel_graphics_kind {
    PIXEL_GRAPHICS_NONE,
    PIXEL_GRAPHICS_SIXEL,
    PIXEL_GRAPHICS_KITTY
};

struct pixel_graphics_shape {
    enum pixel_graphics_kind kind;
    int cols, rows; /* of the picture */
    int cell_width_px, cell_height_px;
    enum palette palette; /* of sixels: 256, or 16 for few registers */
};

/* What a tile shows: columns from the picture's corner. */
struct pixel_graphics_tile {
    int begin, end; /* nothing if equal */
    bool is_known;
};

struct pixel_graphics {
    struct pixel_graphics_shape shape;
    int tile_cols, tiles_across;
    struct pixel_graphics_tile *tiles;
    int next;       /* tile to go on with */
    bool has_begun; /* images of before are removed */
    struct frame wanted;
    struct frame shown; /* pixels of known tiles */
    struct dither dither;
    uint8_t *numbers; /* of a tile */
};

bool pixel_graphics_init(struct pixel_graphics *g,
                         const struct pixel_graphics_shape *shape,
                         struct error *err);
void pixel_graphics_free(struct pixel_graphics *g);

/* Something else has written over these cells of the picture. */
void pixel_graphics_forget(struct pixel_graphics *g,
                           struct ansi_diff_rect rect);

/* Appends what turns the shown picture into the frame, of which pixels are
 * repeated up to those of the terminal. True if nothing is left for the next
 * frame. */
bool pixel_graphics_picture(struct pixel_graphics *g, struct ansi_diff *a,
                            const struct frame *frame,
                            const struct ansi_diff_draw *how);

/* What removes all pixels where cells that are written over them do not; NULL:
 * nothing. */
const char *pixel_graphics_eraser(enum pixel_graphics_kind kind);

#endif
