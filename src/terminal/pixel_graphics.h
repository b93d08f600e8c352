// SPDX-License-Identifier: MIT
/*
 * pixel_graphics.h - a picture as pixels of the terminal
 *
 * The picture is divided into images, around the windows that cover it. While
 * it moves, each frame sends all of them, with as many pixels as the budget of
 * bytes allows. At rest a frame sends the images that differ from what is
 * shown, at the pixels of the frame, until its budget is spent; the next one
 * continues there. An image stays until its successor is there.
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
#include "terminal/color_cut.h"

enum pixel_graphics_kind {
    PIXEL_GRAPHICS_NONE,
    PIXEL_GRAPHICS_SIXEL,
    PIXEL_GRAPHICS_KITTY
};

struct pixel_graphics_shape {
    enum pixel_graphics_kind kind;
    int cols, rows; /* size of the picture */
    int cell_width_px, cell_height_px;
    int colors;      /* most of a sixel image: its registers */
    bool is_in_tmux; /* kitty's images go through it */
};

struct pixel_graphics_image {
    struct ansi_diff_rect rect;
    int id;       /* kitty's number of it */
    bool is_fine; /* `shown` has its pixels, as far as the line allows them */
};

/* Most images: windows divide the picture into few parts, and these into four
 * rows of images. */
#define PIXEL_GRAPHICS_IMAGES 64
#define PIXEL_GRAPHICS_OLD    128

struct pixel_graphics {
    struct pixel_graphics_shape shape;
    struct pixel_graphics_image images[PIXEL_GRAPHICS_IMAGES];
    int image_count;
    int old_images[PIXEL_GRAPHICS_OLD]; /* kitty's, of another layout */
    int old_count;
    int last_id;
    int next;           /* first image of the next frame */
    bool is_stale;      /* images are missing or overwritten */
    double pixel_bytes; /* bytes of a pixel, from the images sent last */
    int width_px, height_px;
    struct frame shown; /* pixels of fine images; no pixels before the first */
    uint8_t *pixels;    /* of one image */
    uint8_t *numbers; /* its colours in `cut`, then those of its enlargement */
    struct color_cut cut;
};

/* Initializes for a layout of the screen. The images of the layout before,
 * which may be freed or zeroed, are removed when the first picture is there. */
bool pixel_graphics_init(struct pixel_graphics *g,
                         const struct pixel_graphics_shape *shape,
                         const struct pixel_graphics *before,
                         struct error *err);
void pixel_graphics_free(struct pixel_graphics *g);

/* Marks the picture as overwritten, because something else was drawn there. */
void pixel_graphics_invalidate(struct pixel_graphics *g);

enum pixel_graphics_pace {
    PIXEL_GRAPHICS_MOVES,
    PIXEL_GRAPHICS_BEGINS, /* at rest, but it still changes everywhere */
    PIXEL_GRAPHICS_RESTS
};

/* Appends the changes from what is shown if the picture rests, otherwise all of
 * it. Frames have at most the pixels of the terminal. Returns true if the
 * picture is complete, false if the next frame has to continue. */
bool pixel_graphics_picture(struct pixel_graphics *g, struct ansi_diff *a,
                            const struct frame *frame,
                            enum pixel_graphics_pace pace,
                            const struct ansi_diff_draw *how);

#endif
