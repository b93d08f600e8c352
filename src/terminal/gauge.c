// SPDX-License-Identifier: MIT
#include "terminal/gauge.h"

#define EIGHTHS 8

/* U+2588 is a full block, U+2589 to U+258F are seven eighths to one. */
#define BLOCK      0x2588u
#define LIGHT_FILL 0x2591u

/* Lines at the left, in the middle and at the right of a cell. */
static const uint32_t handles[] = {0x258fu, 0x2502u, 0x2595u};
#define HANDLES ((int)(sizeof handles / sizeof handles[0]))

/* Luminance of sRGB bytes from which black is seen better than white. */
#define BRIGHT 128

static double clamped(double fraction)
{
    return !(fraction > 0) ? 0 : fraction < 1 ? fraction : 1;
}

/* Returns the character of a cell of which so many eighths are filled. A gauge
 * without a colour of its ground shows the rest as a light pattern. */
static uint32_t fill_glyph(int eighths, bool has_ground, bool has_unicode)
{
    if (!has_unicode)
        return 2 * eighths >= EIGHTHS ? '=' : '.';
    if (eighths >= EIGHTHS)
        return BLOCK;
    if (eighths <= 0)
        return has_ground ? ' ' : LIGHT_FILL;
    return BLOCK + (uint32_t)(EIGHTHS - eighths);
}

void gauge_cells(struct cell *cells, int cols, double fraction,
                 struct text_style style, bool has_unicode)
{
    int filled = (int)(clamped(fraction) * EIGHTHS * cols + 0.5);

    for (int i = 0; i < cols; i++)
        cells[i] =
            (struct cell){style.fg, style.bg,
                          fill_glyph(filled - EIGHTHS * i,
                                     style.bg != CELL_DEFAULT, has_unicode)};
}

static struct rgb value_of(uint32_t color, enum palette palette)
{
    if (palette != PALETTE_24BIT)
        return dither_value(color, palette);
    return (struct rgb){(int)(color >> 16 & 255), (int)(color >> 8 & 255),
                        (int)(color & 255)};
}

void gauge_handle(struct cell *cells, int cols, double fraction,
                  enum palette palette, bool has_unicode)
{
    int place = (int)(clamped(fraction) * (HANDLES * cols - 1) + 0.5);
    struct cell *cell = &cells[place / HANDLES];
    bool is_dark;

    cell->glyph = has_unicode ? handles[place % HANDLES] : '|';
    if (palette == PALETTE_MONO)
        return;
    is_dark = rgb_brightness(value_of(cell->bg, palette)) < BRIGHT;
    cell->fg = cells_of_color(is_dark ? (struct rgb){255, 255, 255}
                                      : (struct rgb){0, 0, 0},
                              palette)
                   .fg;
}

double gauge_fraction(int col, int cols)
{
    return clamped((col + 0.5) / cols);
}
