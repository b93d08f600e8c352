// SPDX-License-Identifier: MIT
#include "terminal/palette.h"

#include <string.h>

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
