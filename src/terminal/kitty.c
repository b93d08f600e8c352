// SPDX-License-Identifier: MIT
#include "terminal/kitty.h"

#include <stdio.h>
#include <string.h>

/* Transmission with display: 24-bit pixels, no answers, the cursor stays,
 * base64 in pieces of at most 4096 bytes.
 * https://sw.kovidgoyal.net/kitty/graphics-protocol/ */
#define BEGIN "\033_Ga=T,f=24,s=%d,v=%d,c=%d,r=%d,i=%d,p=1,q=2,C=1,m=%d;"
#define GO_ON "\033_Gm=%d;"
#define END   "\033\\"
#define ERASE "\033_Ga=d,d=I,i=%d,q=2\033\\"

#define PIECE_BYTES 3072 /* 4096 bytes in base64 */

/* Upper bounds: BEGIN with ERASE; GO_ON with END. */
#define BEGIN_BYTES 192
#define GO_ON_BYTES 16

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

size_t kitty_encode(const struct kitty_image *image, char *bytes)
{
    int count = image->width * image->height;
    int piece = PIECE_BYTES / 3;
    char *p = bytes;

    for (int i = 0; i < count; i++) {
        const uint8_t *row =
            image->rgb + (size_t)(i / image->width) * image->stride_bytes;
        int has_more = count - i > piece;

        if (i == 0)
            p += sprintf(p, BEGIN, image->width, image->height, image->cols,
                         image->rows, image->id, has_more);
        else if (i % piece == 0)
            p += sprintf(p, GO_ON, has_more);
        p = put_pixel(p, row + 3 * (i % image->width));
        if (i % piece == piece - 1 || i == count - 1) {
            memcpy(p, END, sizeof END - 1);
            p += sizeof END - 1;
        }
    }
    return (size_t)(p - bytes);
}

size_t kitty_erase(int id, char *bytes)
{
    return (size_t)sprintf(bytes, ERASE, id);
}
