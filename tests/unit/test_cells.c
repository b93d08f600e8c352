// SPDX-License-Identifier: MIT
#include "check.h"

#include <math.h>
#include <stdlib.h>

#include "glim/cells.h"

static struct cells make_cells(struct frame *frame, int cols, int rows)
{
    struct cells cells;
    struct error err;

    assert_true(frame_init(frame, cols, 2 * rows, &err));
    assert_true(cells_init(&cells, cols, rows, &err));
    return cells;
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
    struct cells c = make_cells(&f, 2, 1);

    (void)state;
    set(&f, 0, 0, 1, 2, 3);
    set(&f, 0, 1, 4, 5, 6);
    set(&f, 1, 0, 7, 8, 9);
    set(&f, 1, 1, 7, 8, 9);
    cells_from_frame(&c, &f, PALETTE_24BIT, GLYPHS_UPPER);
    assert_int_equal(c.cell[0].glyph, CELL_UPPER);
    assert_int_equal(c.cell[0].fg, 0x010203);
    assert_int_equal(c.cell[0].bg, 0x040506);
    assert_int_equal(c.cell[1].glyph, ' ');
    assert_int_equal(c.cell[1].bg, 0x070809);
    cells_from_frame(&c, &f, PALETTE_24BIT, GLYPHS_LOWER);
    assert_int_equal(c.cell[0].glyph, CELL_LOWER);
    assert_int_equal(c.cell[0].fg, 0x040506);
    assert_int_equal(c.cell[0].bg, 0x010203);
    cells_from_frame(&c, &f, PALETTE_24BIT, GLYPHS_SPACE);
    assert_int_equal(c.cell[0].glyph, ' ');
    assert_int_equal(c.cell[0].bg, 0x030405); /* halves round up */
    cells_free(&c);
    frame_free(&f);
}

/* xterm's own numbers: 16 + 36 r + 6 g + b of levels 0 95 135 175 215 255, and
 * 232.. = 8 + 10 i. */
static void value_256(int n, int rgb[3])
{
    static const int level[6] = {0, 95, 135, 175, 215, 255};

    if (n >= 232) {
        rgb[0] = rgb[1] = rgb[2] = 8 + 10 * (n - 232);
        return;
    }
    rgb[0] = level[(n - 16) / 36];
    rgb[1] = level[(n - 16) / 6 % 6];
    rgb[2] = level[(n - 16) % 6];
}

static int weighted(const int a[3], const int b[3])
{
    return 2 * (a[0] - b[0]) * (a[0] - b[0]) +
           4 * (a[1] - b[1]) * (a[1] - b[1]) +
           3 * (a[2] - b[2]) * (a[2] - b[2]);
}

/* Against a search through all 240 colours. */
static void nearest_of_256(void **state)
{
    struct frame f;
    struct cells c = make_cells(&f, 1, 1);
    uint64_t seed = 1;

    (void)state;
    for (int i = 0; i < 20000; i++) {
        int v[3], got[3], try[3];
        int best = 1 << 30;

        for (int k = 0; k < 3; k++)
            v[k] = (int)(256 * check_random(&seed));
        if (i % 4 == 0) /* greys and what is near them */
            v[1] = v[2] = v[0];
        set(&f, 0, 0, v[0], v[1], v[2]);
        set(&f, 0, 1, v[0], v[1], v[2]);
        cells_from_frame(&c, &f, PALETTE_256, GLYPHS_UPPER);
        assert_in_range(c.cell[0].bg, 16, 255);
        value_256((int)c.cell[0].bg, got);
        for (int n = 16; n < 256; n++) {
            value_256(n, try);
            if (weighted(v, try) < best)
                best = weighted(v, try);
        }
        assert_int_equal(weighted(v, got), best);
    }
    cells_free(&c);
    frame_free(&f);
}

/* A flat area of 16 colours has, on average and as light (squared), the colour
 * it stands for; the four by four thresholds round to a sixteenth. */
static void sixteen_keep_the_average(void **state)
{
    static const int colors[][3] = {{60, 100, 20},   {128, 128, 128},
                                    {170, 0, 0},     {0, 0, 0},
                                    {255, 255, 255}, {90, 40, 140}};
    struct frame f;
    struct cells c = make_cells(&f, 8, 4);

    (void)state;
    for (size_t i = 0; i < sizeof colors / sizeof colors[0]; i++) {
        const int *v = colors[i];
        double light[3] = {0};

        for (int y = 0; y < 8; y++)
            for (int x = 0; x < 8; x++)
                set(&f, x, y, v[0], v[1], v[2]);
        cells_from_frame(&c, &f, PALETTE_16, GLYPHS_UPPER);
        for (int n = 0; n < 32; n++) {
            const struct cell *cell = &c.cell[n];
            uint32_t half[2] = {cell->glyph == ' ' ? cell->bg : cell->fg,
                                cell->bg};

            for (int h = 0; h < 2; h++) {
                assert_in_range(half[h], 0, 15);
                for (int k = 0; k < 3; k++) {
                    int on = (int)(half[h] >> k & 1);
                    int value = half[h] < 8 ? 170 * on : 85 + 170 * on;

                    light[k] += value * value / 64.0;
                }
            }
        }
        for (int k = 0; k < 3; k++)
            check_close(light[k], v[k] * v[k],
                        (255.0 * 255 - 85 * 85) / 32 + 1);
    }
    cells_free(&c);
    frame_free(&f);
}

static void mono_is_characters_that_grow(void **state)
{
    struct frame f;
    struct cells c = make_cells(&f, 256, 1);
    int changes = 0;

    (void)state;
    for (int x = 0; x < 256; x++) {
        set(&f, x, 0, x, x, x);
        set(&f, x, 1, x, x, x);
    }
    cells_from_frame(&c, &f, PALETTE_MONO, GLYPHS_UPPER);
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

static void ascii_keeps_the_hue(void **state)
{
    struct frame f;
    struct cells c = make_cells(&f, 1, 1);

    (void)state;
    set(&f, 0, 0, 100, 50, 0);
    set(&f, 0, 1, 100, 50, 0);
    cells_from_frame(&c, &f, PALETTE_24BIT, GLYPHS_ASCII);
    assert_in_range(c.cell[0].glyph, '!', '~');
    assert_int_equal(c.cell[0].fg, 255 << 16 | 127 << 8);
    assert_int_equal(c.cell[0].bg, CELL_DEFAULT);
    cells_free(&c);
    frame_free(&f);
}

/* The shape is kept to half a cell, and the picture lies inside, centred. */
static void pictures_fit(void **state)
{
    uint64_t seed = 2;

    (void)state;
    for (int i = 0; i < 20000; i++) {
        int width = 1 + (int)(3000 * check_random(&seed));
        int height = 1 + (int)(3000 * check_random(&seed));
        int cols = 1 + (int)(300 * check_random(&seed));
        int rows = 1 + (int)(100 * check_random(&seed));
        double aspect = 0.5 + 3 * check_random(&seed);
        struct fit fit = cells_fit(width, height, cols, rows, aspect);
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

/* A cursor of three cells that the borders cut. */
static void a_mark_is_seen_in_every_palette(void **state)
{
    static const struct {
        enum palette palette;
        uint32_t fg, bg;
    } cases[] = {
        {PALETTE_MONO, CELL_DEFAULT, CELL_DEFAULT},
        {PALETTE_16, 0, 15}, /* black, bright white */
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
        for (int k = 0; k < 8; k++)
            assert_int_equal(cells.cell[k].glyph,
                             ((const char[]){0, 0, 0, 0, '[', '+', ']', 0})[k]);
        assert_int_equal(cells.cell[5].fg, cases[i].fg);
        assert_int_equal(cells.cell[5].bg, cases[i].bg);
    }
    memset(cells.cell, 0, 8 * sizeof cells.cell[0]);
    cells_mark(&cells, 3, 0);
    cells_mark(&cells, 0, 1);
    cells_mark(&cells, 1, 2); /* outside */
    for (int k = 0; k < 8; k++)
        assert_int_equal(cells.cell[k].glyph,
                         ((const char[]){0, 0, '[', '+', '+', ']', 0, 0})[k]);
    cells_free(&cells);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_mark_is_seen_in_every_palette),
        cmocka_unit_test(two_pixels_make_a_half_block),
        cmocka_unit_test(nearest_of_256),
        cmocka_unit_test(sixteen_keep_the_average),
        cmocka_unit_test(mono_is_characters_that_grow),
        cmocka_unit_test(ascii_keeps_the_hue),
        cmocka_unit_test(pictures_fit),
    };

    return cmocka_run_group_tests(tests, NULL, NULL);
}
