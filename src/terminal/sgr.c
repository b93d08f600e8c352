// SPDX-License-Identifier: MIT
#include "terminal/sgr.h"

#include <string.h>

/* ---- palettes ---- */

static const char *const names[] = {"mono", "16 colours", "256 colours",
                                    "24 bit"};

static bool is_set(const char *text)
{
    return text && text[0] != '\0';
}

static bool begins_with(const char *text, const char *with)
{
    return text && strncmp(text, with, strlen(with)) == 0;
}

static bool ends_with(const char *text, const char *with)
{
    size_t length = text ? strlen(text) : 0;
    size_t tail = strlen(with);

    return length >= tail && strcmp(text + length - tail, with) == 0;
}

enum palette palette_guess(const struct palette_facts *facts, bool *is_final)
{
    const char *colorterm = facts->colorterm;

    *is_final = true;
    if (is_set(facts->no_color))
        return PALETTE_MONO;
    /* screen misreads 38;2;... as attributes, whatever COLORTERM says of the
     * terminal around it */
    if (!is_set(facts->tmux) &&
        (is_set(facts->sty) || begins_with(facts->term, "screen")))
        return facts->colors >= 8 || is_set(facts->sty) ? PALETTE_256
                                                        : PALETTE_MONO;
    if (begins_with(facts->term, "linux"))
        return PALETTE_16;
    *is_final = false;
    if (colorterm && (strcmp(colorterm, "truecolor") == 0 ||
                      strcmp(colorterm, "24bit") == 0))
        return PALETTE_24BIT;
    /* tmux always accepts 24 bit and rounds for the terminal around it */
    if (is_set(facts->tmux) || facts->has_rgb ||
        ends_with(facts->term, "-direct"))
        return PALETTE_24BIT;
    if (facts->colors >= 256)
        return PALETTE_256;
    return facts->colors >= 8 ? PALETTE_16 : PALETTE_MONO;
}

const char *palette_name(enum palette palette)
{
    return names[palette];
}

/* ---- parameters ---- */

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
