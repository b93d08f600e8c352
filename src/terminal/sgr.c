// SPDX-License-Identifier: MIT
#include "terminal/sgr.h"

#include <string.h>

/* Distance from the dark to the bright eight of 16 colours. */
#define BRIGHT 60

char *sgr_number(char *to, uint32_t n)
{
    char digits[10];
    int count = 0;

    do {
        digits[count++] = (char)('0' + n % 10);
        n /= 10;
    } while (n);
    while (count)
        *to++ = digits[--count];
    return to;
}

static char *put(char *to, const char text[3])
{
    memcpy(to, text, 3);
    return to + 3;
}

char *sgr_color(char *to, uint32_t color, enum palette palette,
                enum sgr_ground ground)
{
    uint32_t base = (uint32_t)ground;

    if (color == CELL_DEFAULT)
        return sgr_number(to, base + 9);
    if (palette == PALETTE_24BIT) {
        to = put(sgr_number(to, base + 8), ";2;");
        to = sgr_number(to, color >> 16 & 255);
        *to++ = ';';
        to = sgr_number(to, color >> 8 & 255);
        *to++ = ';';
        return sgr_number(to, color & 255);
    }
    if (palette == PALETTE_256)
        return sgr_number(put(sgr_number(to, base + 8), ";5;"), color);
    return sgr_number(to, color < 8 ? base + color : base + BRIGHT + color - 8);
}
