// SPDX-License-Identifier: MIT
/*
 * kitty.h - pixels as the bytes of kitty's graphics protocol
 *
 * Units:     pixels, bytes
 * Ownership: the buffer is the caller's
 * Threads:   any
 */
#ifndef GLIM_KITTY_H
#define GLIM_KITTY_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

/* Asks whether the terminal shows images; a positive answer contains ";OK". */
#define KITTY_QUESTION "\033_Gi=1,s=1,v=1,a=q,t=d,f=24;AAAA\033\\"

/* The same, asked through tmux, which passes it on if its option
 * allow-passthrough is on. Terminals without placeholders do not know U. */
#define KITTY_TMUX_QUESTION \
    "\033Ptmux;\033\033_Gi=1,s=1,v=1,a=q,t=d,f=24,U=1;AAAA\033\033\\\033\\"

/* Removes all images. */
#define KITTY_ERASE_ALL "\033_Ga=d,d=A,q=2\033\\"

/* Rectangle of a picture with 3 bytes a pixel, row 0 at the top, which the
 * terminal scales to cells. */
struct kitty_image {
    int id;          /* 16 to 255 */
    bool is_virtual; /* sent through tmux, shown by kitty_cells() */
    int cols, rows;
    int width, height;
    const uint8_t *rgb;
    size_t stride_bytes; /* from one row to the next */
};

/* Images of more rows have no placeholders. */
#define KITTY_ROWS_MAX 64

/* Most bytes that kitty_encode() and kitty_erase() write, together. */
size_t kitty_bytes_max(int width, int height);

/* Encodes an image. It appears with its corner in the cursor's cell; the cursor
 * stays there. Returns the number of bytes. */
size_t kitty_encode(const struct kitty_image *image, char *bytes);

/* Encodes the removal of one image. Returns the number of bytes. An image is
 * removed when its successor is there, which has another id: else the terminal
 * would show a hole while the successor arrives. */
size_t kitty_erase(const struct kitty_image *image, char *bytes);

/* Encodes the placeholders of one row of an image, from 0: characters that the
 * terminal replaces by the image, so that tmux can keep and move them as text.
 * They set the foreground. Returns the number of bytes. */
size_t kitty_cells(const struct kitty_image *image, int row, char *bytes);

/* Most bytes of kitty_cells(). */
size_t kitty_cells_bytes_max(int cols);

#endif
