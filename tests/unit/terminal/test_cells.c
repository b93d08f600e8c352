// SPDX-License-Identifier: MIT
#include "tests/unit/check.h"

#include <math.h>
#include <stdlib.h>

#include "terminal/cells.h"

static struct cells make_cells_of(struct frame *frame, int cols, int rows,
                                  enum glyphs glyphs)
{
    struct glyph_grid grid = glyphs_grid(glyphs);
    struct cells cells;
    struct error err;

    assert_true(frame_init(frame, grid.across * cols, grid.down * rows, &err));
    assert_true(cells_init(&cells, cols, rows, &err));
    return cells;
}

static struct cells make_cells(struct frame *frame, int cols, int rows)
{
    return make_cells_of(frame, cols, rows, GLYPHS_HALF);
}

static void set(struct frame *f, int x, int y, int r, int g, int b)
{
    uint8_t *p = f->rgb + 3 * (y * f->width + x);

    p[0] = (uint8_t)r;
    p[1] = (uint8_t)g;
    p[2] = (uint8_t)b;
}

static void two_pixels_make_a_half_block(void **state)
{
    struct frame f;
    struct cells c = make_cells(&f, 3, 1);

    (void)state;
    set(&f, 0, 0, 4, 5, 6);
    set(&f, 0, 1, 1, 2, 3);
    set(&f, 1, 0, 1, 2, 3);
    set(&f, 1, 1, 4, 5, 6);
    set(&f, 2, 0, 7, 8, 9);
    set(&f, 2, 1, 7, 8, 9);
    cells_from_frame(&c, &f, PALETTE_24BIT, GLYPHS_HALF);
    for (int i = 0; i < 2; i++) { /* the lighter colour is the foreground */
        assert_int_equal(c.cell[i].glyph, i == 0 ? CELL_UPPER : CELL_LOWER);
        assert_int_equal(c.cell[i].fg, 0x040506);
        assert_int_equal(c.cell[i].bg, 0x010203);
    }
    assert_int_equal(c.cell[2].glyph, ' ');
    assert_int_equal(c.cell[2].bg, 0x070809);
    cells_free(&c);
    frame_free(&f);
}

/* Grey of 128 lies between the greys of 85 and 170: of the shades a half has
 * the mean that is nearest, 135. The other palettes have blanks. */
static void sixteen_colors_have_shades(void **state)
{
    struct frame f;
    struct cells c = make_cells_of(&f, 2, 1, GLYPHS_SHADE);

    (void)state;
    set(&f, 0, 0, 128, 128, 128);
    set(&f, 1, 0, 170, 0, 0); /* dark red is one of them */
    cells_from_frame(&c, &f, PALETTE_16, GLYPHS_SHADE);
    assert_int_equal(c.cell[0].glyph, 0x2592); /* MEDIUM SHADE */
    assert_int_equal(c.cell[0].fg + c.cell[0].bg, 7 + 8);
    assert_int_equal(c.cell[1].glyph, ' ');
    cells_from_frame(&c, &f, PALETTE_24BIT, GLYPHS_SHADE);
    assert_int_equal(c.cell[0].glyph, ' ');
    assert_int_equal(c.cell[0].bg, 0x808080);
    cells_free(&c);
    frame_free(&f);
}

static void one_pixel_is_a_blank(void **state)
{
    struct frame f;
    struct cells c = make_cells_of(&f, 2, 1, GLYPHS_SPACE);

    (void)state;
    set(&f, 0, 0, 1, 2, 3);
    set(&f, 1, 0, 4, 5, 6);
    cells_from_frame(&c, &f, PALETTE_24BIT, GLYPHS_SPACE);
    for (int i = 0; i < 2; i++) {
        assert_int_equal(c.cell[i].glyph, ' ');
        assert_int_equal(c.cell[i].bg, i == 0 ? 0x010203 : 0x040506);
    }
    cells_free(&c);
    frame_free(&f);
}

/* Returns the sum of squared distances to the means of the two groups of dots,
 * those of set and of clear bits, weighted as in the program. */
static double squared_error(const struct frame *f, unsigned mask)
{
    static const double weight[3] = {2, 4, 3};
    int count = f->width * f->height;
    double total = 0;

    for (int bit = 0; bit < 2; bit++) {
        for (int c = 0; c < 3; c++) {
            double sum = 0, sum2 = 0;
            int n = 0;

            for (int i = 0; i < count; i++) {
                double v = f->rgb[3 * i + c];

                if ((int)(mask >> i & 1) != bit)
                    continue;
                sum += v;
                sum2 += v * v;
                n++;
            }
            total += n > 0 ? weight[c] * (sum2 - sum * sum / n) : 0;
        }
    }
    return total;
}

/* Returns the root of the mean square over the dots whose bit has this value,
 * of each channel. */
static uint32_t mean(const struct frame *f, unsigned mask, unsigned bit)
{
    uint32_t color = 0;

    for (int c = 0; c < 3; c++) {
        int n = 0;
        double sum = 0;

        for (int i = 0; i < f->width * f->height; i++) {
            if ((mask >> i & 1) != bit)
                continue;
            sum += pow(f->rgb[3 * i + c], 2);
            n++;
        }
        color = color << 8 | (uint32_t)floor(sqrt(sum / n) + 0.5);
    }
    return color;
}

/* Returns the mean of the dots whose bit has this value, weighted as in the
 * program. */
static double lightness(const struct frame *f, unsigned mask, unsigned bit)
{
    static const double root[3] = {1.41421356, 2, 1.73205081};
    double sum = 0;
    int n = 0;

    for (int i = 0; i < f->width * f->height; i++) {
        if ((mask >> i & 1) != bit)
            continue;
        for (int c = 0; c < 3; c++)
            sum += root[c] * f->rgb[3 * i + c];
        n++;
    }
    return sum / n;
}

/* Blocks have the least error of the pictures of the Unicode chart whose
 * foreground is the lighter colour: halves and quadrants can be exchanged with
 * their inverse, quarters cannot. */
static void blocks_are_the_best_of_the_chart(void **state)
{
    /* halves, one quadrant, the diagonal; then quarters */
    static const unsigned masks[] = {0x0f, 0x55, 0x05, 0x0a, 0x50,
                                     0xa0, 0xa5, 0xc0, 0xfc};
    int quarters = 0;
    uint64_t seed = 4;

    (void)state;
    for (int round = 0; round < 3000; round++) {
        struct frame f;
        struct cells c = make_cells_of(&f, 1, 1, GLYPHS_BLOCK);
        double whole, gain = 0, most = 0;
        unsigned mask;

        for (int i = 0; i < 24; i++)
            f.rgb[i] = (uint8_t)(round % 2 * 120 * (i >= 18) +
                                 136 * check_random(&seed));
        cells_from_frame(&c, &f, PALETTE_24BIT, GLYPHS_BLOCK);
        assert_true(glyph_block_mask(c.cell[0].glyph, &mask));
        whole = squared_error(&f, 0);
        for (int i = 0; i < 9; i++) {
            bool is_dark = i >= 7 && lightness(&f, masks[i], 1) <
                                         lightness(&f, masks[i], 0);
            double g = whole - squared_error(&f, masks[i]);

            if (is_dark)
                continue;
            most = fmax(most, g);
            if (mask == masks[i] || mask == (255 ^ masks[i])) {
                gain = g;
                quarters += i >= 7;
            }
        }
        check_close(gain, most, 1e-3 * most);
        assert_int_equal(c.cell[0].fg, mean(&f, mask, 1));
        assert_int_equal(c.cell[0].bg, mean(&f, mask, 0));
        cells_free(&c);
        frame_free(&f);
    }
    assert_true(quarters > 300);
}

/* In every palette the foreground of half blocks is the lighter colour. A
 * dither of two colours then sets them once, and the glyphs alternate. Blocks
 * take the same frames while a picture moves. */
static void light_dots_are_the_foreground(void **state)
{
    struct frame f;
    struct cells c = make_cells(&f, 1, 1);

    (void)state;
    for (int i = 0; i < 4; i++) {
        enum glyphs glyphs = i < 2 ? GLYPHS_HALF : GLYPHS_BLOCK;
        enum palette palette = i % 2 ? PALETTE_24BIT : PALETTE_256;

        set(&f, 0, 0, 215, 215, 95);
        set(&f, 0, 1, 0, 0, 95);
        cells_from_frame(&c, &f, palette, glyphs);
        struct cell upper = c.cell[0];
        set(&f, 0, 0, 0, 0, 95);
        set(&f, 0, 1, 215, 215, 95);
        cells_from_frame(&c, &f, palette, glyphs);
        assert_int_equal(upper.glyph, CELL_UPPER);
        assert_int_equal(c.cell[0].glyph, CELL_LOWER);
        assert_int_equal(upper.fg, palette == PALETTE_256 ? 185 : 0xd7d75f);
        assert_int_equal(upper.bg, palette == PALETTE_256 ? 17 : 0x00005f);
        assert_int_equal(c.cell[0].fg, upper.fg);
        assert_int_equal(c.cell[0].bg, upper.bg);
    }
    cells_free(&c);
    frame_free(&f);
}

/* Each dot of braille is a bit of the number after U+2800. */
static int dots_of_braille(uint32_t glyph)
{
    if (glyph == ' ')
        return 0;
    assert_in_range(glyph, 0x2801, 0x28ff);
    return __builtin_popcount(glyph - 0x2800);
}

/* Without colours, the share of dots is the grey's light (squared). */
static void mono_dots_keep_the_average(void **state)
{
    enum glyphs glyphs = GLYPHS_BRAILLE;

    (void)state;
    for (int v = 0; v < 256; v++) {
        struct frame f;
        struct cells c = make_cells_of(&f, 4, 4, glyphs);
        int on = 0;

        for (int i = 0; i < 3 * f.width * f.height; i++)
            f.rgb[i] = (uint8_t)v;
        cells_from_frame(&c, &f, PALETTE_MONO, glyphs);
        for (int i = 0; i < 16; i++) {
            assert_true(c.cell[i].fg == CELL_DEFAULT &&
                        c.cell[i].bg == CELL_DEFAULT);
            on += dots_of_braille(c.cell[i].glyph);
        }
        check_close((double)on / (f.width * f.height), v * v / 65025.0,
                    1.0 / 32 + 1e-9);
        cells_free(&c);
        frame_free(&f);
    }
}

/* A frame of little contrast has all tones from no dot to all dots, but one of
 * hardly any does not become black and white. */
static void mono_contrast_is_stretched(void **state)
{
    struct frame f;
    struct cells c = make_cells_of(&f, 100, 1, GLYPHS_BRAILLE);

    (void)state;
    for (int step = 4; step >= 1; step -= 3) {
        for (int i = 0; i < f.width * f.height; i++) {
            int v = 100 + step * (i % f.width) / 8;

            set(&f, i % f.width, i / f.width, v, v, v);
        }
        cells_from_frame(&c, &f, PALETTE_MONO, GLYPHS_BRAILLE);
        assert_int_equal(dots_of_braille(c.cell[0].glyph), step == 4 ? 0 : 1);
        assert_in_range(dots_of_braille(c.cell[99].glyph), step == 4 ? 8 : 2,
                        step == 4 ? 8 : 4);
    }
    cells_free(&c);
    frame_free(&f);
}

static void mono_characters_grow_with_brightness(void **state)
{
    struct frame f;
    struct cells c = make_cells(&f, 256, 1);
    int changes = 0;

    (void)state;
    for (int x = 0; x < 256; x++) {
        set(&f, x, 0, x, x, x);
        set(&f, x, 1, x, x, x);
    }
    cells_from_frame(&c, &f, PALETTE_MONO, GLYPHS_HALF);
    assert_int_equal(c.cell[0].glyph, ' ');
    assert_int_equal(c.cell[255].glyph, '@');
    for (int x = 0; x < 256; x++) {
        assert_in_range(c.cell[x].glyph, ' ', '~');
        assert_true(c.cell[x].fg == CELL_DEFAULT &&
                    c.cell[x].bg == CELL_DEFAULT);
        if (x > 0 && c.cell[x].glyph != c.cell[x - 1].glyph)
            changes++;
    }
    assert_int_equal(changes, 9);
    cells_free(&c);
    frame_free(&f);
}

/* In colours, a character or dots show the brightest channel, in the hue. */
static void ink_keeps_the_hue(void **state)
{
    static const enum glyphs kinds[] = {GLYPHS_ASCII, GLYPHS_BRAILLE};

    (void)state;
    for (int k = 0; k < 2; k++) {
        struct frame f;
        struct cells c = make_cells_of(&f, 1, 1, kinds[k]);

        for (int i = 0; i < f.width * f.height; i++)
            set(&f, i % f.width, i / f.width, 200, 100, 0);
        cells_from_frame(&c, &f, PALETTE_24BIT, kinds[k]);
        if (k == 0)
            assert_in_range(c.cell[0].glyph, '!', '~');
        else /* of 8 dots a share of (200 / 255)^2, rounded by the pattern */
            assert_in_range(dots_of_braille(c.cell[0].glyph), 4, 6);
        assert_int_equal(c.cell[0].fg, 255 << 16 | 127 << 8);
        assert_int_equal(c.cell[0].bg, CELL_DEFAULT);
        cells_free(&c);
        frame_free(&f);
    }
}

/* The shape is kept to half a cell, and the picture is centred inside. */
static void pictures_keep_their_shape(void **state)
{
    uint64_t seed = 2;

    (void)state;
    for (int i = 0; i < 20000; i++) {
        int width = 1 + (int)(3000 * check_random(&seed));
        int height = 1 + (int)(3000 * check_random(&seed));
        int cols = 1 + (int)(300 * check_random(&seed));
        int rows = 1 + (int)(100 * check_random(&seed));
        double aspect = 0.5 + 3 * check_random(&seed);
        struct cells_rect fit = cells_fit(width, height, cols, rows, aspect);
        double shape = (double)width / height;

        assert_true(fit.cols >= 1 && fit.cols <= cols);
        assert_true(fit.rows >= 1 && fit.rows <= rows);
        assert_true(fit.cols == cols || fit.rows == rows);
        assert_true(abs(cols - fit.cols - 2 * fit.col) <= 1);
        assert_true(abs(rows - fit.rows - 2 * fit.row) <= 1);
        if (fit.rows == rows && fit.cols > 1 && fit.cols < cols)
            check_close(fit.cols, rows * aspect * shape, 0.5001);
        if (fit.cols == cols && fit.rows > 1 && fit.rows < rows)
            check_close(fit.rows, cols / (aspect * shape), 0.5001);
    }
}

/* The cursor has three cells, and the borders cut it. */
static void marks_are_visible_in_every_palette(void **state)
{
    static const struct {
        enum palette palette;
        uint32_t fg, bg;
    } cases[] = {
        {PALETTE_MONO, CELL_DEFAULT, CELL_DEFAULT},
        {PALETTE_16, 0, 15}, /* black and bright white */
        {PALETTE_256, 16, 231},
        {PALETTE_24BIT, 0x000000, 0xffffff},
    };
    struct cells cells;
    struct error err;

    (void)state;
    assert_true(cells_init(&cells, 4, 2, &err));
    for (size_t i = 0; i < sizeof cases / sizeof cases[0]; i++) {
        memset(cells.cell, 0, 8 * sizeof cells.cell[0]);
        cells.palette = cases[i].palette;
        cells_mark(&cells, 1, 1);
        cells_row(&cells, 0);
        cells_row(&cells, 1);
        for (int k = 0; k < 8; k++)
            assert_int_equal(cells.cell[k].glyph,
                             ((const char[]){0, 0, 0, 0, '[', '+', ']', 0})[k]);
        assert_int_equal(cells.cell[5].fg, cases[i].fg);
        assert_int_equal(cells.cell[5].bg, cases[i].bg);
    }
    memset(cells.cell, 0, 8 * sizeof cells.cell[0]);
    cells_mark(&cells, 3, 0);
    cells_row(&cells, 0);
    cells_mark(&cells, 0, 1);
    cells_row(&cells, 1);
    cells_mark(&cells, 1, 2); /* outside */
    cells_row(&cells, 0);
    cells_row(&cells, 1);
    for (int k = 0; k < 8; k++)
        assert_int_equal(cells.cell[k].glyph,
                         ((const char[]){0, 0, '[', '+', '+', ']', 0, 0})[k]);
    cells_free(&cells);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(marks_are_visible_in_every_palette),
        cmocka_unit_test(two_pixels_make_a_half_block),
        cmocka_unit_test(one_pixel_is_a_blank),
        cmocka_unit_test(sixteen_colors_have_shades),
        cmocka_unit_test(blocks_are_the_best_of_the_chart),
        cmocka_unit_test(light_dots_are_the_foreground),
        cmocka_unit_test(mono_dots_keep_the_average),
        cmocka_unit_test(mono_contrast_is_stretched),
        cmocka_unit_test(mono_characters_grow_with_brightness),
        cmocka_unit_test(ink_keeps_the_hue),
        cmocka_unit_test(pictures_keep_their_shape),
    };

    return cmocka_run_group_tests(tests, NULL, NULL);
}
