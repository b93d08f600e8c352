// SPDX-License-Identifier: MIT
#include "terminal/theme.h"

#include <string.h>

/* ---- control sequences ---- */

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

/* ---- themes ---- */

/* Colours of a role: 0xRRGGBB, and their numbers among 16 colours. */
struct role_colors {
    uint32_t fg, bg;
    uint8_t fg_16, bg_16;
    bool is_bold;
};

#define BLACK   0
#define BLUE    4
#define CYAN    6
#define WHITE   7
#define GREY    8
#define B_RED   9
#define B_GREEN 10
#define B_YEL   11
#define B_WHITE 15

static const struct role_colors dark[ROLES] = {
    [ROLE_TEXT] = {0xd3d9e2, 0x161b22, WHITE, BLACK, false},
    [ROLE_FAINT] = {0x8b96a5, 0x161b22, WHITE, BLACK, false},
    [ROLE_TITLE] = {0xffffff, 0x161b22, B_WHITE, BLACK, true},
    [ROLE_KEY] = {0xf0c060, 0x161b22, B_YEL, BLACK, true},
    [ROLE_SELECTED] = {0xffffff, 0x2b4f7a, BLACK, CYAN, true},
    [ROLE_PICKED] = {0xffffff, 0x2a323d, B_WHITE, BLACK, true},
    [ROLE_FRAME] = {0x5f6d80, 0x161b22, CYAN, BLACK, false},
    [ROLE_STATUS] = {0xd3d9e2, 0x222a35, BLACK, WHITE, false},
    [ROLE_STATUS_FAINT] = {0x98a3b3, 0x222a35, BLACK, WHITE, false},
    [ROLE_STATUS_KEY] = {0xf0c060, 0x222a35, BLUE, WHITE, true},
    [ROLE_LIVE] = {0x06210f, 0x57c785, BLACK, B_GREEN, true},
    [ROLE_NORMAL] = {0x07182c, 0x77b0f2, B_WHITE, BLUE, true},
    [ROLE_PAUSED] = {0x241a00, 0xe8bb4e, BLACK, B_YEL, true},
    [ROLE_FAILED] = {0x2c0505, 0xf07878, BLACK, B_RED, true},
    [ROLE_MESSAGE] = {0xffe3a3, 0x222a35, BLACK, WHITE, true},
    [ROLE_GAUGE] = {0x57c785, 0x2a333f, B_GREEN, BLACK, false},
};

static const struct role_colors light[ROLES] = {
    [ROLE_TEXT] = {0x22272e, 0xf6f4ee, BLACK, B_WHITE, false},
    [ROLE_FAINT] = {0x5f6875, 0xf6f4ee, BLACK, B_WHITE, false},
    [ROLE_TITLE] = {0x000000, 0xf6f4ee, BLACK, B_WHITE, true},
    [ROLE_KEY] = {0x8a4a00, 0xf6f4ee, BLUE, B_WHITE, true},
    [ROLE_SELECTED] = {0x000000, 0xb5d3f2, BLACK, CYAN, true},
    [ROLE_PICKED] = {0x000000, 0xdfe3e6, BLACK, WHITE, true},
    [ROLE_FRAME] = {0x7c8591, 0xf6f4ee, BLACK, B_WHITE, false},
    [ROLE_STATUS] = {0x22272e, 0xdcdfe3, BLACK, WHITE, false},
    [ROLE_STATUS_FAINT] = {0x525b68, 0xdcdfe3, BLACK, WHITE, false},
    [ROLE_STATUS_KEY] = {0x7a4000, 0xdcdfe3, BLUE, WHITE, true},
    [ROLE_LIVE] = {0xffffff, 0x1b7a43, B_WHITE, BLACK, true},
    [ROLE_NORMAL] = {0xffffff, 0x1f5fa8, B_WHITE, BLACK, true},
    [ROLE_PAUSED] = {0x241a00, 0xe8bb4e, BLACK, B_YEL, true},
    [ROLE_FAILED] = {0xffffff, 0xb02a2a, B_WHITE, BLACK, true},
    [ROLE_MESSAGE] = {0x6b3500, 0xdcdfe3, BLACK, WHITE, true},
    [ROLE_GAUGE] = {0x0f6a2e, 0xc2c8cf, BLACK, WHITE, false},
};

static const unsigned plain[ROLES] = {
    [ROLE_FAINT] = TEXT_DIM,
    [ROLE_TITLE] = TEXT_BOLD,
    [ROLE_KEY] = TEXT_BOLD,
    [ROLE_SELECTED] = TEXT_REVERSE,
    [ROLE_PICKED] = TEXT_BOLD,
    [ROLE_STATUS] = TEXT_REVERSE,
    [ROLE_STATUS_FAINT] = TEXT_REVERSE,
    [ROLE_STATUS_KEY] = TEXT_REVERSE | TEXT_BOLD,
    [ROLE_LIVE] = TEXT_BOLD,
    [ROLE_NORMAL] = TEXT_BOLD,
    [ROLE_PAUSED] = TEXT_BOLD,
    [ROLE_FAILED] = TEXT_BOLD,
    [ROLE_MESSAGE] = TEXT_REVERSE | TEXT_BOLD,
};

static struct rgb channels(uint32_t color)
{
    return (struct rgb){(int)(color >> 16 & 255), (int)(color >> 8 & 255),
                        (int)(color & 255)};
}

struct text_style theme_style(enum theme theme, enum palette palette,
                              enum text_role role)
{
    const struct role_colors *c =
        theme == THEME_LIGHT ? &light[role] : &dark[role];
    unsigned bold = c->is_bold ? TEXT_BOLD : 0;

    if (theme == THEME_PLAIN || palette == PALETTE_MONO || role == ROLE_OUTSIDE)
        return (struct text_style){CELL_DEFAULT, CELL_DEFAULT, plain[role]};
    if (palette == PALETTE_16) /* bold would turn black to grey on many */
        return (struct text_style){c->fg_16, c->bg_16,
                                   c->fg_16 < GREY ? 0 : bold};
    if (palette == PALETTE_256)
        return (struct text_style){dither_nearest(channels(c->fg), palette),
                                   dither_nearest(channels(c->bg), palette),
                                   bold};
    return (struct text_style){c->fg, c->bg, bold};
}
