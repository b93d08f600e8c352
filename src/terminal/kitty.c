// SPDX-License-Identifier: MIT
#include "terminal/kitty.h"

#include <assert.h>
#include <stdio.h>
#include <string.h>

#include "terminal/glyphs.h"

/* Transmission with display: 24-bit pixels, no answers, the cursor stays,
 * base64 in pieces of at most 4096 bytes. Through tmux the image is a virtual
 * one: "Unicode placeholders" in the text of kitty's protocol. */
#define BEGIN "a=T,f=24,s=%d,v=%d,c=%d,r=%d,i=%d,%s,q=2,m=%d;"
#define GO_ON "m=%d;"
#define ERASE "a=d,d=I,i=%d,q=2"

/* Row and column 0 and on of a placeholder are these combining characters, in
 * the protocol's order. */
static const uint16_t marks[KITTY_ROWS_MAX] = {
    0x0305, 0x030d, 0x030e, 0x0310, 0x0312, 0x033d, 0x033e, 0x033f,
    0x0346, 0x034a, 0x034b, 0x034c, 0x0350, 0x0351, 0x0352, 0x0357,
    0x035b, 0x0363, 0x0364, 0x0365, 0x0366, 0x0367, 0x0368, 0x0369,
    0x036a, 0x036b, 0x036c, 0x036d, 0x036e, 0x036f, 0x0483, 0x0484,
    0x0485, 0x0486, 0x0487, 0x0592, 0x0593, 0x0594, 0x0595, 0x0597,
    0x0598, 0x0599, 0x059c, 0x059d, 0x059e, 0x059f, 0x05a0, 0x05a1,
    0x05a8, 0x05a9, 0x05ab, 0x05ac, 0x05af, 0x05c4, 0x0610, 0x0611,
    0x0612, 0x0613, 0x0614, 0x0615, 0x0616, 0x0617, 0x0657, 0x0658,
};

#define PLACEHOLDER       0x10eeeeu
#define PLACEHOLDER_BYTES 4
#define MARK_BYTES        2
#define COLOR_BYTES       16 /* "\033[38;5;255m" */

#define PIECE_BYTES 3072 /* 4096 bytes in base64 */

/* Upper bounds: BEGIN with ERASE; GO_ON; with begin and end of a command. */
#define BEGIN_BYTES 192
#define GO_ON_BYTES 32

static const char digits[] =
    "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";

size_t kitty_bytes_max(int width, int height)
{
    size_t pixels = (size_t)width * (size_t)height;

    return BEGIN_BYTES + 4 * pixels +
           (3 * pixels / PIECE_BYTES + 1) * GO_ON_BYTES;
}

/* Writes a pixel of three bytes as four base64 digits. */
static char *put_pixel(char *p, const uint8_t *rgb)
{
    unsigned bits = (unsigned)rgb[0] << 16 | (unsigned)rgb[1] << 8 | rgb[2];

    for (int shift = 18; shift >= 0; shift -= 6)
        *p++ = digits[bits >> shift & 63];
    return p;
}

/* tmux passes on what is between its own marks, with each ESC doubled. */
static char *begin_command(char *p, const struct kitty_image *image)
{
    return stpcpy(p, image->is_virtual ? "\033Ptmux;\033\033_G" : "\033_G");
}

static char *end_command(char *p, const struct kitty_image *image)
{
    return stpcpy(p, image->is_virtual ? "\033\033\\\033\\" : "\033\\");
}

size_t kitty_encode(const struct kitty_image *image, char *bytes)
{
    int count = image->width * image->height;
    int piece = PIECE_BYTES / 3;
    char *p = bytes;

    for (int i = 0; i < count; i++) {
        const uint8_t *row =
            image->rgb + (size_t)(i / image->width) * image->stride_bytes;
        int has_more = count - i > piece;

        if (i % piece == 0)
            p = begin_command(p, image);
        if (i == 0)
            p += sprintf(p, BEGIN, image->width, image->height, image->cols,
                         image->rows, image->id,
                         image->is_virtual ? "U=1" : "p=1,C=1", has_more);
        else if (i % piece == 0)
            p += sprintf(p, GO_ON, has_more);
        p = put_pixel(p, row + 3 * (i % image->width));
        if (i % piece == piece - 1 || i == count - 1)
            p = end_command(p, image);
    }
    return (size_t)(p - bytes);
}

size_t kitty_erase(const struct kitty_image *image, char *bytes)
{
    char *p = begin_command(bytes, image);

    p += sprintf(p, ERASE, image->id);
    return (size_t)(end_command(p, image) - bytes);
}

/* The number of the image is the foreground, among 256 colours: tmux may round
 * others. Only the first cell of a row has marks; the others follow it. */
size_t kitty_cells(const struct kitty_image *image, int row, char *bytes)
{
    char *p = bytes;

    assert(row < KITTY_ROWS_MAX);
    p += sprintf(p, "\033[38;5;%dm", image->id);
    for (int col = 0; col < image->cols; col++) {
        p += glyph_utf8(PLACEHOLDER, p);
        if (col == 0) {
            p += glyph_utf8(marks[row], p);
            p += glyph_utf8(marks[0], p);
        }
    }
    return (size_t)(p - bytes);
}

size_t kitty_cells_bytes_max(int cols)
{
    return COLOR_BYTES + 2 * MARK_BYTES + (size_t)cols * PLACEHOLDER_BYTES;
}
