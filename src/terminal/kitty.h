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

#include <stddef.h>
#include <stdint.h>

/* Asks whether the terminal shows images; a positive answer contains ";OK". */
#define KITTY_QUESTION "\033_Gi=1,s=1,v=1,a=q,t=d,f=24;AAAA\033\\"

/* Removes all images. */
#define KITTY_ERASE_ALL "\033_Ga=d,d=A,q=2\033\\"

/* Rectangle of a picture with 3 bytes a pixel, row 0 at the top, which the
 * terminal scales to cells. */
struct kitty_image {
    int id; /* from 1 */
    int cols, rows;
    int width, height;
    const uint8_t *rgb;
    size_t stride_bytes; /* from one row to the next */
};

/* Most bytes that kitty_encode() and kitty_erase() write, together. */
size_t kitty_bytes_max(int width, int height);

/* Encodes an image. It appears with its corner in the cursor's cell; the cursor
 * stays there. Returns the number of bytes. */
size_t kitty_encode(const struct kitty_image *image, char *bytes);

/* Encodes the removal of one image. Returns the number of bytes. An image is
 * removed when its successor is there, which has another id: else the terminal
 * would show a hole while the successor arrives. */
size_t kitty_erase(int id, char *bytes);

#endif
