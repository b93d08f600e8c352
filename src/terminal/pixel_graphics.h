// SPDX-License-Identifier: MIT
/*
 * pixel_graphics.h - a picture as pixels of the terminal
 *
 * The picture is sent in tiles, parts of a row of cells. A frame sends the
 * tiles that differ from what is shown until its budget is spent; the next one
 * continues there. So a slow line has as few bytes on the way as with cells,
 * and windows can cover parts of the picture.
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
    int cols, rows; /* size of the picture */
    int cell_width_px, cell_height_px;
    enum palette palette; /* of sixels: 256, or 16 for few registers */
};

/* Columns of a tile that are shown, from the picture's corner. */
struct pixel_graphics_tile {
    int begin, end; /* equal if nothing is shown */
    bool is_known;
};

struct pixel_graphics {
    struct pixel_graphics_shape shape;
    int tile_cols, tiles_across;
    struct pixel_graphics_tile *tiles;
    int next;       /* first tile of the next frame */
    bool has_begun; /* earlier images were removed */
    struct frame wanted;
    struct frame shown; /* pixels of the tiles that are shown */
    struct dither dither;
    uint8_t *numbers; /* palette numbers of one tile */
};

bool pixel_graphics_init(struct pixel_graphics *g,
                         const struct pixel_graphics_shape *shape,
                         struct error *err);
void pixel_graphics_free(struct pixel_graphics *g);

/* Marks cells of the picture as unknown, because something else was drawn
 * there. */
void pixel_graphics_invalidate(struct pixel_graphics *g,
                               struct ansi_diff_rect rect);

/* Appends the changes from the shown picture to the frame, whose pixels are
 * repeated to match the terminal's. Returns true if the picture is complete,
 * false if the budget ended the frame. */
bool pixel_graphics_picture(struct pixel_graphics *g, struct ansi_diff *a,
                            const struct frame *frame,
                            const struct ansi_diff_draw *how);

/* Returns the bytes that remove all pixels, for terminals where characters do
 * not overwrite them; NULL if none are needed. */
const char *pixel_graphics_eraser(enum pixel_graphics_kind kind);

#endif
