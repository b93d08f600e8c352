// SPDX-License-Identifier: MIT
#include "terminal/cells.h"

#include <assert.h>
#include <math.h>
#include <stdlib.h>

#include "base/memory.h"

/* Characters in order of their ink, from none to most. */
static const char ramp[] = " .:;+xo%#@";
#define RAMP_LENGTH ((int)sizeof ramp - 1)

/* Number of masks whose last dot is not set. The other masks are their
 * inverses. */
#define MASKS_MAX (1 << (GLYPH_DOTS_MAX - 1))

/* Square roots of the channel weights 2, 4, 3, a rough measure of the eye's
 * sensitivity. */
static const float eye[3] = {1.41421356f, 2.0f, 1.73205081f};

bool cells_init(struct cells *cells, int cols, int rows, struct error *err)
{
    assert(cols > 0 && rows > 0);
    *cells = (struct cells){.cols = cols, .rows = rows};
    cells->cell =
        alloc_array((size_t)cols * (size_t)rows, sizeof cells->cell[0]);
    if (!cells->cell)
        return fail(err, "out of memory for a window of %dx%d cells", cols,
                    rows);
    if (dither_init(&cells->dither, err))
        return true;
    cells_free(cells);
    return false;
}

void cells_free(struct cells *cells)
{
    free(cells->cell);
    dither_free(&cells->dither);
    *cells = (struct cells){0};
}

static struct rgb pixel(const struct frame *frame, int x, int y)
{
    const uint8_t *p =
        frame->rgb + 3 * ((size_t)y * (size_t)frame->width + (size_t)x);

    return (struct rgb){p[0], p[1], p[2]};
}

/* Pixels of a cell, dot by dot. */
struct dots {
    int count;
    struct rgb color[GLYPH_DOTS_MAX];
};

static struct dots dots_of(const struct frame *frame, struct glyph_grid grid,
                           int col, int row)
{
    struct dots dots = {.count = 0};

    for (int y = 0; y < grid.down; y++) {
        for (int x = 0; x < grid.across; x++)
            dots.color[dots.count++] =
                pixel(frame, col * grid.across + x, row * grid.down + y);
    }
    return dots;
}

/* Returns the mean colour of the dots whose bit in the mask is `bit`; there is
 * at least one. The mean is taken of sRGB values, not of light: the eye sees no
 * difference for neighbouring colours, and a cell of one colour is coarse
 * anyway. */
static struct rgb mean_of(const struct dots *dots, unsigned mask, unsigned bit)
{
    struct rgb sum = {0, 0, 0};
    int count = 0;

    for (int i = 0; i < dots->count; i++) {
        if ((mask >> i & 1) != bit)
            continue;
        sum.r += dots->color[i].r;
        sum.g += dots->color[i].g;
        sum.b += dots->color[i].b;
        count++;
    }
    return (struct rgb){(sum.r + count / 2) / count,
                        (sum.g + count / 2) / count,
                        (sum.b + count / 2) / count};
}

static int largest(struct rgb c)
{
    int m = c.r > c.g ? c.r : c.g;

    return m > c.b ? m : c.b;
}

/* Returns a character for the brightness, in a colour with only the hue. */
static struct cell ascii_cell(struct cells *cells, struct rgb c)
{
    struct cell cell = {CELL_DEFAULT, CELL_DEFAULT, ' '};
    bool is_mono = cells->palette == PALETTE_MONO;
    int light = is_mono ? rgb_brightness(c) : largest(c);
    int index = light * RAMP_LENGTH / 256;

    if (index == 0)
        return cell;
    cell.glyph = (uint32_t)ramp[index];
    if (!is_mono) {
        struct rgb hue = {c.r * 255 / light, c.g * 255 / light,
                          c.b * 255 / light};

        /* middle threshold: a cell of one colour needs no pattern */
        cell.fg = dither_color(&cells->dither, hue, 1, 3, cells->palette);
    }
    return cell;
}

/* Returns a cell with the dots set that are brighter than their threshold. The
 * comparison is of squared values, roughly the light. */
static struct cell mono_cell(const struct cells *cells, const struct dots *dots,
                             int col, int row)
{
    struct glyph_grid grid = glyphs_grid(cells->glyphs);
    unsigned mask = 0;

    for (int i = 0; i < dots->count; i++) {
        int light = rgb_brightness(dots->color[i]);
        int threshold = dither_threshold(col * grid.across + i % grid.across,
                                         row * grid.down + i / grid.across);

        if (32 * light * light > (2 * threshold + 1) * 255 * 255)
            mask |= 1u << i;
    }
    return (struct cell){CELL_DEFAULT, CELL_DEFAULT,
                         glyphs_of_mask(cells->glyphs, mask)};
}

/* Gain of each mask. Take the dots relative to their mean, and let S be the sum
 * over the k of n dots in one group. The other group has the sum -S, and two
 * colours instead of one reduce the squared error by |S|^2 n / (k (n - k)). The
 * table holds the factor of |S|^2. */
struct partition {
    float share[MASKS_MAX];
};

static void partition_init(struct partition *p, int dots)
{
    p->share[0] = 0.0f;
    for (int mask = 1; mask < 1 << (dots - 1); mask++) {
        int k = __builtin_popcount((unsigned)mask);

        p->share[mask] = (float)dots / (float)(k * (dots - k));
    }
}

/* Sums the values over the dots of each mask. */
static void sum_masks(const float *values, int count, float sums[MASKS_MAX])
{
    sums[0] = 0.0f;
    for (int i = 0; i < count - 1; i++) {
        for (int mask = 0; mask < 1 << i; mask++)
            sums[(1 << i) + mask] = sums[mask] + values[i];
    }
}

/* Subtracts the mean from the dots and weighs the channels by the eye's
 * sensitivity. */
static void centre(const struct dots *dots, float values[3][GLYPH_DOTS_MAX])
{
    float mean[3] = {0.0f, 0.0f, 0.0f};

    for (int i = 0; i < dots->count; i++) {
        values[0][i] = eye[0] * (float)dots->color[i].r;
        values[1][i] = eye[1] * (float)dots->color[i].g;
        values[2][i] = eye[2] * (float)dots->color[i].b;
        for (int c = 0; c < 3; c++)
            mean[c] += values[c][i] / (float)dots->count;
    }
    for (int c = 0; c < 3; c++) {
        for (int i = 0; i < dots->count; i++)
            values[c][i] -= mean[c];
    }
}

/* Returns the mask whose two groups have the least squared error. All masks are
 * tried. */
static unsigned best_mask(const struct partition *p, const struct dots *dots)
{
    float values[3][GLYPH_DOTS_MAX];
    float r[MASKS_MAX], g[MASKS_MAX], b[MASKS_MAX];
    unsigned best = 0;
    float most = 0.0f;

    centre(dots, values);
    sum_masks(values[0], dots->count, r);
    sum_masks(values[1], dots->count, g);
    sum_masks(values[2], dots->count, b);
    for (unsigned i = 1; i < 1u << (dots->count - 1); i++) {
        float gain = p->share[i] * (r[i] * r[i] + g[i] * g[i] + b[i] * b[i]);

        if (gain > most) {
            most = gain;
            best = i;
        }
    }
    return best;
}

static struct cell solid_cell(uint32_t color)
{
    return (struct cell){color, color, ' '};
}

/* Returns a cell with the mean colours of the two groups of the mask. */
static struct cell block_cell(struct cells *cells, const struct dots *dots,
                              unsigned mask, int col, int row)
{
    bool is_lower = cells->glyphs == GLYPHS_LOWER;
    struct dither *d = &cells->dither;
    uint32_t fg;
    uint32_t bg;

    if (mask == 0)
        return solid_cell(
            dither_color(d, mean_of(dots, 0, 0), col, 2 * row, cells->palette));
    fg = dither_color(d, mean_of(dots, mask, 1), col, 2 * row + is_lower,
                      cells->palette);
    bg = dither_color(d, mean_of(dots, mask, 0), col, 2 * row + !is_lower,
                      cells->palette);
    if (fg == bg)
        return solid_cell(fg);
    return (struct cell){fg, bg, glyphs_of_mask(cells->glyphs, mask)};
}

static struct cell cell_of(struct cells *cells, const struct dots *dots,
                           const struct partition *partition, int col, int row)
{
    bool is_mono = cells->palette == PALETTE_MONO;
    unsigned mask;

    if (cells->glyphs == GLYPHS_ASCII || (is_mono && dots->count <= 2))
        return ascii_cell(cells, mean_of(dots, 0, 0));
    if (is_mono)
        return mono_cell(cells, dots, col, row);
    switch (cells->glyphs) {
    case GLYPHS_SPACE: return block_cell(cells, dots, 0, col, row);
    case GLYPHS_HALF:
    case GLYPHS_UPPER: return block_cell(cells, dots, 1, col, row);
    case GLYPHS_LOWER: return block_cell(cells, dots, 2, col, row);
    default: break;
    }
    mask = best_mask(partition, dots);
    /* where dots leave gaps, most of a cell is background */
    if (!glyphs_are_solid(cells->glyphs) &&
        2 * __builtin_popcount(mask) > dots->count)
        mask ^= (1u << dots->count) - 1;
    return block_cell(cells, dots, mask, col, row);
}

void cells_begin(struct cells *cells, const struct frame *frame,
                 enum palette palette, enum glyphs glyphs)
{
    struct glyph_grid grid = glyphs_grid(glyphs);

    assert(frame->width == grid.across * cells->cols &&
           frame->height == grid.down * cells->rows);
    cells->palette = palette;
    cells->glyphs = glyphs;
    cells->frame = frame;
    cells->has_mark = false;
}

static struct cell *row_of(struct cells *cells, int row)
{
    return cells->cell + (size_t)row * (size_t)cells->cols;
}

static void convert_row(struct cells *cells, int row)
{
    struct glyph_grid grid = glyphs_grid(cells->glyphs);
    struct cell *out = row_of(cells, row);
    struct partition partition;

    partition_init(&partition, grid.across * grid.down);
    for (int col = 0; col < cells->cols; col++) {
        struct dots dots = dots_of(cells->frame, grid, col, row);

        out[col] = cell_of(cells, &dots, &partition, col, row);
    }
}

void cells_from_frame(struct cells *cells, const struct frame *frame,
                      enum palette palette, enum glyphs glyphs)
{
    cells_begin(cells, frame, palette, glyphs);
    for (int row = 0; row < cells->rows; row++)
        cells_row(cells, row);
    cells->frame = NULL;
}

struct cell cells_of_color(struct rgb color, enum palette palette)
{
    struct cells mono = {.palette = PALETTE_MONO};

    switch (palette) {
    case PALETTE_24BIT:
    case PALETTE_16: /* middle threshold, as in ascii_cell() */
        return solid_cell(dither_color(NULL, color, 1, 3, palette));
    case PALETTE_256: return solid_cell(dither_nearest_256(color));
    case PALETTE_MONO: break;
    }
    return ascii_cell(&mono, color);
}

static int within(double cells, int most)
{
    if (!(cells >= 1.0))
        return 1;
    return cells > most ? most : (int)cells;
}

/* Returns a character in black on white, or without colours if there are
 * none. */
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
    cells->has_mark = true;
    cells->mark_col = col;
    cells->mark_row = row;
}

void cells_row(struct cells *cells, int row)
{
    static const char text[] = "[+]";

    if (cells->frame)
        convert_row(cells, row);
    for (int i = 0; i < 3 && cells->has_mark && row == cells->mark_row; i++) {
        int x = cells->mark_col - 1 + i;

        if (x >= 0 && x < cells->cols)
            row_of(cells, row)[x] = mark_cell(cells->palette, text[i]);
    }
}

struct cells_rect cells_fit(int width_px, int height_px, int cols, int rows,
                            double cell_aspect)
{
    double shape = (double)width_px / height_px * cell_aspect;
    struct cells_rect fit;

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
