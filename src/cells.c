// SPDX-License-Identifier: MIT
#include "glim/cells.h"

#include <assert.h>
#include <math.h>
#include <stdlib.h>

/* Characters by the ink they have, from none to most. */
static const char ramp[] = " .:;+xo%#@";
#define RAMP_LENGTH ((int)sizeof ramp - 1)

/* The first 16 colours: eight whose channels are 0 or 170, eight with 85 or
 * 255. Themes differ, and nobody can ask all terminals; these are the VGA's and
 * lie in the middle of what is in use. */
#define DARK_ON    170
#define BRIGHT_OFF 85

/* Bayer's matrix: thresholds that spread a level over 4x4 pixels. */
static const int8_t bayer[4][4] = {{0, 8, 2, 10},
                                   {12, 4, 14, 6},
                                   {3, 11, 1, 9},
                                   {15, 7, 13, 5}};

struct rgb {
    int r, g, b;
};

bool cells_init(struct cells *cells, int cols, int rows, struct error *err)
{
    assert(cols > 0 && rows > 0);
    *cells = (struct cells){.cols = cols, .rows = rows};
    cells->cell =
        alloc_array((size_t)cols * (size_t)rows, sizeof cells->cell[0]);
    if (!cells->cell)
        return fail(err, "no memory for a window of %dx%d cells", cols, rows);
    return true;
}

void cells_free(struct cells *cells)
{
    free(cells->cell);
    *cells = (struct cells){0};
}

static struct rgb pixel(const struct frame *frame, int x, int y)
{
    const uint8_t *p =
        frame->rgb + 3 * ((size_t)y * (size_t)frame->width + (size_t)x);

    return (struct rgb){p[0], p[1], p[2]};
}

/* In the curve's space, not in light: the eye sees no difference between two
 * neighbours, and a cell of one colour is coarse anyway. */
static struct rgb average(struct rgb a, struct rgb b)
{
    return (struct rgb){(a.r + b.r + 1) / 2, (a.g + b.g + 1) / 2,
                        (a.b + b.b + 1) / 2};
}

/* Squared, weighted as the eye weighs the primaries, roughly. */
static int distance_of(struct rgb a, struct rgb b)
{
    int r = a.r - b.r;
    int g = a.g - b.g;
    int blue = a.b - b.b;

    return 2 * r * r + 4 * g * g + 3 * blue * blue;
}

/* The 6 levels of the colour cube are 0, 95, 135, 175, 215, 255. */
static int cube_level(int v)
{
    if (v < 48)
        return 0;
    return v < 115 ? 1 : (v - 35) / 40;
}

static int cube_value(int level)
{
    return level ? 55 + 40 * level : 0;
}

/* The nearest of the cube (16..231) and the greys (232..255: 8, 18, .. 238). */
static uint32_t nearest_256(struct rgb c)
{
    int r = cube_level(c.r);
    int g = cube_level(c.g);
    int b = cube_level(c.b);
    struct rgb cube = {cube_value(r), cube_value(g), cube_value(b)};
    int mean = (2 * c.r + 4 * c.g + 3 * c.b) / 9;
    int step = mean < 8 ? 0 : (mean - 3) / 10;
    int shade = step > 23 ? 23 : step;
    int value = 8 + 10 * shade;
    struct rgb grey = {value, value, value};

    if (distance_of(c, grey) < distance_of(c, cube))
        return (uint32_t)(232 + shade);
    return (uint32_t)(16 + 36 * r + 6 * g + b);
}

static int square(int v)
{
    return v * v;
}

/* Whether a channel between `off` and `on` is on at a threshold of 0..15. The
 * eye adds light, which is roughly the square of these numbers. */
static bool is_on(int v, int off, int on, int threshold)
{
    return 32 * (square(v) - square(off)) >
           (2 * threshold + 1) * (square(on) - square(off));
}

/* Dithers each channel between the two values it has among the dark or the
 * bright eight, whichever come closer to the colour. All channels share the
 * threshold, so that grey stays grey. */
static uint32_t dithered_16(struct rgb c, int threshold)
{
    int v[3] = {c.r, c.g, c.b};
    int too_bright = 0;
    int too_dark = 0;
    uint32_t color = 0;

    for (int i = 0; i < 3; i++) {
        too_bright += v[i] > DARK_ON ? square(v[i] - DARK_ON) : 0;
        too_dark += v[i] < BRIGHT_OFF ? square(BRIGHT_OFF - v[i]) : 0;
    }
    bool is_dark = too_bright <= too_dark;
    for (int i = 0; i < 3; i++) {
        if (is_dark ? is_on(v[i], 0, DARK_ON, threshold)
                    : is_on(v[i], BRIGHT_OFF, 255, threshold))
            color |= 1u << i;
    }
    return is_dark ? color : color + 8;
}

static uint32_t color_number(struct rgb c, int x, int y, enum palette palette)
{
    switch (palette) {
    case PALETTE_24BIT:
        return (uint32_t)c.r << 16 | (uint32_t)c.g << 8 | (uint32_t)c.b;
    case PALETTE_256: return nearest_256(c);
    case PALETTE_16: return dithered_16(c, bayer[y & 3][x & 3]);
    case PALETTE_MONO: break;
    }
    return CELL_DEFAULT;
}

static int largest(struct rgb c)
{
    int m = c.r > c.g ? c.r : c.g;

    return m > c.b ? m : c.b;
}

/* The character carries the brightness, its colour only the hue. */
static struct cell ascii_cell(struct rgb c, enum palette palette)
{
    struct cell cell = {CELL_DEFAULT, CELL_DEFAULT, ' '};
    int light =
        palette == PALETTE_MONO ? (2 * c.r + 5 * c.g + c.b) / 8 : largest(c);
    int index = light * RAMP_LENGTH / 256;

    if (index == 0)
        return cell;
    cell.glyph = (uint32_t)ramp[index];
    if (palette != PALETTE_MONO) {
        struct rgb hue = {c.r * 255 / light, c.g * 255 / light,
                          c.b * 255 / light};

        /* a threshold of the middle: one colour needs no pattern */
        cell.fg = color_number(hue, 1, 3, palette);
    }
    return cell;
}

static struct cell block_cell(struct rgb top, struct rgb bottom, int x, int y,
                              enum palette palette, enum glyphs glyphs)
{
    uint32_t a;
    uint32_t b;

    if (glyphs == GLYPHS_SPACE) {
        a = color_number(average(top, bottom), x, y, palette);
        return (struct cell){a, a, ' '};
    }
    a = color_number(top, x, 2 * y, palette);
    b = color_number(bottom, x, 2 * y + 1, palette);
    if (a == b)
        return (struct cell){a, a, ' '};
    if (glyphs == GLYPHS_LOWER)
        return (struct cell){b, a, CELL_LOWER};
    return (struct cell){a, b, CELL_UPPER};
}

void cells_from_frame(struct cells *cells, const struct frame *frame,
                      enum palette palette, enum glyphs glyphs)
{
    bool ascii = palette == PALETTE_MONO || glyphs == GLYPHS_ASCII;
    struct cell *out = cells->cell;

    assert(frame->width == cells->cols && frame->height == 2 * cells->rows);
    cells->palette = palette;
    for (int y = 0; y < cells->rows; y++) {
        for (int x = 0; x < cells->cols; x++) {
            struct rgb top = pixel(frame, x, 2 * y);
            struct rgb bottom = pixel(frame, x, 2 * y + 1);

            *out++ = ascii ? ascii_cell(average(top, bottom), palette)
                           : block_cell(top, bottom, x, y, palette, glyphs);
        }
    }
}

static int within(double cells, int most)
{
    if (!(cells >= 1.0))
        return 1;
    return cells > most ? most : (int)cells;
}

/* Black on white, whatever the picture shows there; characters alone where
 * there are no colours. */
static struct cell mark_cell(enum palette palette, char glyph)
{
    switch (palette) {
    case PALETTE_24BIT: return (struct cell){0, 0xffffff, glyph};
    case PALETTE_256: return (struct cell){16, 231, glyph};
    case PALETTE_16: return (struct cell){0, 15, glyph};
    case PALETTE_MONO: break;
    }
    return (struct cell){CELL_DEFAULT, CELL_DEFAULT, glyph};
}

void cells_mark(struct cells *cells, int col, int row)
{
    static const char text[] = "[+]";

    for (int i = 0; i < 3; i++) {
        int x = col - 1 + i;

        if (x >= 0 && x < cells->cols && row >= 0 && row < cells->rows)
            cells->cell[(size_t)row * (size_t)cells->cols + (size_t)x] =
                mark_cell(cells->palette, text[i]);
    }
}

struct fit cells_fit(int width_px, int height_px, int cols, int rows,
                     double cell_aspect)
{
    double shape = (double)width_px / height_px * cell_aspect;
    struct fit fit;

    assert(width_px > 0 && height_px > 0 && cols > 0 && rows > 0);
    if (cols <= rows * shape) {
        fit.cols = cols;
        fit.rows = within(floor(cols / shape + 0.5), rows);
    } else {
        fit.cols = within(floor(rows * shape + 0.5), cols);
        fit.rows = rows;
    }
    fit.col = (cols - fit.cols) / 2;
    fit.row = (rows - fit.rows) / 2;
    return fit;
}
