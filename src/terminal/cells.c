// SPDX-License-Identifier: MIT
#include "terminal/cells.h"

#include <assert.h>
#include <math.h>
#include <stdlib.h>

#include "base/memory.h"
#include "base/min_max.h"

/* Characters in order of their ink, from none to most. */
static const char ramp[] = " .:;+xo%#@";
#define RAMP_LENGTH ((int)sizeof ramp - 1)

/* Part of a frame's pixels that are black, and white, when its contrast is
 * stretched, and the most that it is. */
#define TONES_LOST   0.02
#define CONTRAST_MAX 4

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

/* Colours of a cell's dots. A pixel of a frame with fewer has several of them.
 */
struct dots {
    struct rgb color[GLYPH_DOTS];
};

static struct dots dots_of(const struct cells *cells, int col, int row)
{
    int across = cells->frame->width / cells->cols;
    int down = cells->frame->height / cells->rows;
    struct dots dots;

    for (int i = 0; i < GLYPH_DOTS; i++)
        dots.color[i] = pixel(cells->frame, col * across + i % 2 * across / 2,
                              row * down + i / 2 * down / 4);
    return dots;
}

static int root_mean(int sum, int count)
{
    return (int)(sqrtf((float)sum / (float)count) + 0.5f);
}

/* Returns the mean colour of the dots whose bit in the mask is `bit`; there is
 * at least one. The mean is taken of squared values, roughly the light, which
 * is what the eye averages. */
static struct rgb mean_of(const struct dots *dots, unsigned mask, unsigned bit)
{
    struct rgb sum = {0, 0, 0};
    int count = 0;

    for (int i = 0; i < GLYPH_DOTS; i++) {
        const struct rgb *c = &dots->color[i];

        if ((mask >> i & 1) != bit)
            continue;
        sum.r += c->r * c->r;
        sum.g += c->g * c->g;
        sum.b += c->b * c->b;
        count++;
    }
    return (struct rgb){root_mean(sum.r, count), root_mean(sum.g, count),
                        root_mean(sum.b, count)};
}

static int largest(struct rgb c)
{
    int m = c.r > c.g ? c.r : c.g;

    return m > c.b ? m : c.b;
}

/* Returns the brightness that a glyph shows, from 0 to 255: in colour, that of
 * its hue multiplies it. */
static int ink_of(const struct cells *cells, struct rgb c)
{
    return cells->palette == PALETTE_MONO ? cells->tones[rgb_brightness(c)]
                                          : largest(c);
}

/* Returns a glyph in a colour with only the hue. */
static struct cell ink_cell(struct cells *cells, struct rgb c, uint32_t glyph)
{
    struct cell cell = {CELL_DEFAULT, CELL_DEFAULT, glyph};
    int light = largest(c);

    if (cells->palette != PALETTE_MONO && glyph != ' ' && light > 0) {
        struct rgb hue = {c.r * 255 / light, c.g * 255 / light,
                          c.b * 255 / light};

        /* middle threshold: a cell of one colour needs no pattern */
        cell.fg = dither_color(&cells->dither, hue, 1, 3, cells->palette);
    }
    return cell;
}

static struct cell ascii_cell(struct cells *cells, struct rgb c, int ink)
{
    return ink_cell(cells, c, (uint32_t)ramp[ink * RAMP_LENGTH / 256]);
}

/* Returns a cell with the dots set that are brighter than their threshold. The
 * comparison is of squared values, roughly the light. */
static struct cell braille_cell(struct cells *cells, const struct dots *dots,
                                int col, int row)
{
    unsigned mask = 0;

    for (int i = 0; i < GLYPH_DOTS; i++) {
        int ink = ink_of(cells, dots->color[i]);
        int threshold = dither_threshold(2 * col + i % 2, 4 * row + i / 2);

        if (32 * ink * ink > (2 * threshold + 1) * 255 * 255)
            mask |= 1u << i;
    }
    return ink_cell(cells, mean_of(dots, 0, 0), glyph_of_braille(mask));
}

/* Partitions of 2x4 dots into two groups, one of which is a block: halves and
 * quadrants, whose inverse is a block, too, then quarters. The foreground is
 * the lighter colour: in many fonts a glyph does not reach the edge of its
 * cell, and a line of the background is visible there, which disturbs if it is
 * light. So quarters are never dark. */
static const uint8_t partitions[] = {0x0f, 0x55, 0x05, 0x0a, 0x50,
                                     0xa0, 0xa5, 0xc0, 0xfc};
#define QUARTERS 7

/* Subtracts the mean from the dots and weighs the channels by the eye's
 * sensitivity. */
static void centre(const struct dots *dots, float values[3][GLYPH_DOTS])
{
    float mean[3] = {0.0f, 0.0f, 0.0f};

    for (int i = 0; i < GLYPH_DOTS; i++) {
        values[0][i] = eye[0] * (float)dots->color[i].r;
        values[1][i] = eye[1] * (float)dots->color[i].g;
        values[2][i] = eye[2] * (float)dots->color[i].b;
        for (int c = 0; c < 3; c++)
            mean[c] += values[c][i] / GLYPH_DOTS;
    }
    for (int c = 0; c < 3; c++) {
        for (int i = 0; i < GLYPH_DOTS; i++)
            values[c][i] -= mean[c];
    }
}

/* Returns the mask of the partition with the most gain. Take the dots relative
 * to their mean, and let S be the sum over the k of n dots in one group. The
 * other group has the sum -S, and two colours instead of one reduce the squared
 * error by |S|^2 n / (k (n - k)). A flat cell has halves, which are dithered
 * apart. */
static unsigned best_mask(const struct dots *dots)
{
    float values[3][GLYPH_DOTS];
    unsigned best = partitions[0];
    float most = 0.01f; /* more than what rounding leaves of a flat cell */

    centre(dots, values);
    for (size_t i = 0; i < sizeof partitions; i++) {
        float sum[3] = {0.0f, 0.0f, 0.0f}, gain;
        int k = __builtin_popcount(partitions[i]);

        for (int dot = 0; dot < GLYPH_DOTS; dot++)
            for (int c = 0; c < 3 && partitions[i] >> dot & 1; c++)
                sum[c] += values[c][dot];
        if (i >= QUARTERS && sum[0] + sum[1] + sum[2] < 0.0f)
            continue;
        gain = (sum[0] * sum[0] + sum[1] * sum[1] + sum[2] * sum[2]) /
               (float)(k * (GLYPH_DOTS - k));
        if (gain > most) {
            most = gain;
            best = partitions[i];
        }
    }
    return best;
}

static struct cell solid_cell(uint32_t color)
{
    return (struct cell){color, color, ' '};
}

static int brightness_of(uint32_t color, enum palette palette)
{
    return rgb_brightness(palette == PALETTE_24BIT
                              ? (struct rgb){(int)(color >> 16),
                                             (int)(color >> 8 & 255),
                                             (int)(color & 255)}
                              : dither_value(color, palette));
}

/* Returns a cell with the mean colours of the two groups of the mask. The
 * foreground is the lighter one. */
static struct cell block_cell(struct cells *cells, const struct dots *dots,
                              int col, int row)
{
    unsigned mask = best_mask(dots);
    uint32_t inverse = glyph_of_block(0xff ^ mask);
    struct cell cell = {.glyph = glyph_of_block(mask)};

    cell.bg = dither_color(&cells->dither, mean_of(dots, mask, 0), col,
                           2 * row + 1, cells->palette);
    cell.fg = dither_color(&cells->dither, mean_of(dots, mask, 1), col, 2 * row,
                           cells->palette);
    if (cell.fg == cell.bg)
        return solid_cell(cell.fg);
    return inverse != 0 && brightness_of(cell.fg, cells->palette) <
                               brightness_of(cell.bg, cells->palette)
               ? (struct cell){cell.bg, cell.fg, inverse}
               : cell;
}

static struct cell shade_cell(struct cells *cells, struct rgb c)
{
    struct shade s = dither_shade(&cells->dither, c);

    return s.quarters == 0
               ? solid_cell(s.bg)
               : (struct cell){s.fg, s.bg,
                               CELL_SHADE - 1 + (uint32_t)s.quarters};
}

static struct cell cell_of(struct cells *cells, const struct dots *dots,
                           int col, int row)
{
    if (cells->glyphs == GLYPHS_BRAILLE)
        return braille_cell(cells, dots, col, row);
    if (cells->glyphs == GLYPHS_ASCII || cells->palette == PALETTE_MONO) {
        struct rgb mean = mean_of(dots, 0, 0);

        return ascii_cell(cells, mean, ink_of(cells, mean));
    }
    if (cells->glyphs == GLYPHS_SHADE && cells->palette == PALETTE_16)
        return shade_cell(cells, dots->color[0]);
    if (cells->glyphs == GLYPHS_SHADE || cells->glyphs == GLYPHS_SPACE)
        return solid_cell(dither_color(&cells->dither, dots->color[0], col,
                                       2 * row, cells->palette));
    return block_cell(cells, dots, col, row);
}

/* Returns the brightness below which a part of the frame's pixels are. */
static int percentile(const int counts[256], double part, int pixels)
{
    int at = 0;

    for (double left = part * pixels - counts[0]; left > 0 && at < 255;)
        left -= counts[++at];
    return at;
}

/* Stretches the contrast of a frame to all tones that characters and dots have,
 * by at most CONTRAST_MAX. */
static void find_tones(struct cells *cells, const struct frame *frame)
{
    int pixels = frame->width * frame->height;
    int counts[256] = {0};
    int dark, range, full;

    for (int y = 0; y < frame->height; y++)
        for (int x = 0; x < frame->width; x++)
            counts[rgb_brightness(pixel(frame, x, y))]++;
    dark = percentile(counts, TONES_LOST, pixels);
    range = percentile(counts, 1 - TONES_LOST, pixels) - dark;
    full = int_min(CONTRAST_MAX * range, 255);
    for (int i = 0; i < 256; i++) {
        int tone = i;

        if (range > 0 && range < 255)
            tone =
                dark * (255 - full) / (255 - range) + (i - dark) * full / range;
        cells->tones[i] = (uint8_t)(tone < 0 ? 0 : tone > 255 ? 255 : tone);
    }
}

void cells_begin(struct cells *cells, const struct frame *frame,
                 enum palette palette, enum glyphs glyphs)
{
    cells->palette = palette;
    cells->glyphs = glyphs;
    assert(frame->width % cells->cols == 0 && frame->height % cells->rows == 0);
    cells->frame = frame;
    cells->has_mark = false;
    if (palette == PALETTE_MONO)
        find_tones(cells, frame);
}

static struct cell *row_of(struct cells *cells, int row)
{
    return cells->cell + (size_t)row * (size_t)cells->cols;
}

static void convert_row(struct cells *cells, int row)
{
    struct cell *out = row_of(cells, row);

    for (int col = 0; col < cells->cols; col++) {
        struct dots dots = dots_of(cells, col, row);

        out[col] = cell_of(cells, &dots, col, row);
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
        return solid_cell(dither_color(NULL, color, 0, 0, palette));
    case PALETTE_16:
    case PALETTE_256: return solid_cell(dither_nearest(color, palette));
    case PALETTE_MONO: break;
    }
    return ascii_cell(&mono, color, rgb_brightness(color));
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
