// SPDX-License-Identifier: MIT
/*
 * test_ansi_diff.c - the bytes go to a terminal for tests (vt.h), which must
 * show the cells
 */
#include "tests/unit/check.h"

#include <stdlib.h>
#include <string.h>

#include "terminal/ansi_diff.h"
#include "tests/unit/vt.h"

#define COLS 40
#define ROWS 12

static struct vt vt;

static void forget_colors(void)
{
    vt.pen.fg = vt.pen.bg = CELL_DEFAULT;
}

static void show(const struct ansi_diff *a)
{
    vt_write(&vt, a->bytes, a->length);
}

/* Checks that only jumps, steps to the right and colours are sent. */
static void check_sequences(void)
{
    for (int c = 0; c < 128; c++)
        assert_true(!vt.seen[c] || strchr("HCm", c));
    assert_string_equal(vt.moved, "");
    assert_string_equal(vt.unknown, "");
}

static void check_shown(const struct cells *c, int col, int row)
{
    check_sequences();
    for (int y = 0; y < c->rows; y++) {
        for (int x = 0; x < c->cols; x++)
            assert_true(vt_shows(&vt.cell[row + y][col + x],
                                 &c->cell[y * c->cols + x]));
    }
}

static uint32_t random_color(enum palette palette, uint64_t *seed)
{
    double u = check_random(seed);

    switch (palette) {
    case PALETTE_24BIT: return (uint32_t)(u * 0x1000000);
    case PALETTE_256: return 16 + (uint32_t)(u * 240);
    case PALETTE_16: return (uint32_t)(u * 16);
    case PALETTE_MONO: break;
    }
    return CELL_DEFAULT;
}

/* Returns a glyph of which some dots are set and others are not. */
static uint32_t random_glyph(enum glyphs glyphs, uint64_t *seed)
{
    uint32_t glyph = 0;

    while (glyph == 0) {
        unsigned mask = 1 + (unsigned)(254 * check_random(seed));

        glyph = glyphs == GLYPHS_BRAILLE ? glyph_of_braille(mask)
                                         : glyph_of_block(mask);
    }
    return glyph;
}

/* Changes some cells. There are few colours, so that neighbours often share
 * them. */
static void scramble(struct cells *c, enum palette palette, double part,
                     uint64_t *seed)
{
    uint32_t colors[3];

    c->palette = palette;
    for (int i = 0; i < 3; i++)
        colors[i] = random_color(palette, seed);
    for (int i = 0; i < c->cols * c->rows; i++) {
        struct cell *cell = &c->cell[i];

        if (check_random(seed) >= part)
            continue;
        cell->fg = colors[(int)(3 * check_random(seed))];
        cell->bg = colors[(int)(3 * check_random(seed))];
        cell->glyph = random_glyph(c->glyphs, seed);
        if (palette == PALETTE_MONO)
            cell->glyph = '!' + (uint32_t)(90 * check_random(seed));
        if (cell->fg == cell->bg && palette != PALETTE_MONO)
            cell->glyph = ' ';
    }
}

static struct cells make_cells(int cols, int rows)
{
    struct cells c;
    struct error err;

    assert_true(cells_init(&c, cols, rows, &err));
    return c;
}

static struct ansi_diff make_ansi(int cols, int rows)
{
    struct ansi_diff a;
    struct error err;

    assert_true(ansi_diff_init(&a, cols, rows, &err));
    return a;
}

/* Tests every palette and kind of glyphs, with some and all cells changed. */
static void screen_shows_the_cells(void **state)
{
    struct cells c = make_cells(30, 9);
    struct ansi_diff a = make_ansi(COLS, ROWS);
    struct ansi_diff_draw how = {.col = 4, .row = 2, .budget_bytes = SIZE_MAX};
    static const enum glyphs kinds[2] = {GLYPHS_BLOCK, GLYPHS_BRAILLE};
    uint64_t seed = 5;

    (void)state;
    vt_open(&vt, COLS, ROWS);
    for (int round = 0; round < 200; round++) {
        enum palette palette = (enum palette)(round / 10 % 4);
        double part = round % 10 == 0 ? 1.0 : 0.3;

        c.glyphs = kinds[round / 100];
        scramble(&c, palette, part, &seed);
        ansi_diff_begin(&a);
        assert_true(ansi_diff_picture(&a, &c, &how));
        ansi_diff_end(&a, ROWS - 1);
        show(&a);
        check_shown(&c, 4, 2);
        assert_true(vt.pen.fg == CELL_DEFAULT && vt.pen.bg == CELL_DEFAULT);
        assert_true(vt.row == ROWS - 1 && vt.col == 0);
    }
    ansi_diff_begin(&a);
    assert_true(ansi_diff_picture(&a, &c, &how));
    assert_int_equal(a.length, 0); /* no change sends nothing */
    ansi_diff_free(&a);
    cells_free(&c);
}

#define UNMADE 0xdeadu

/* Makes cells of a frame of random pixels, no row of which is made yet. */
static void begin_random(struct cells *c, struct frame *frame, uint64_t *seed)
{
    struct glyph_grid grid = glyphs_grid(GLYPHS_BLOCK);
    struct error err;

    assert_true(frame_init(frame, grid.across * COLS, grid.down * ROWS, &err));
    for (int i = 0; i < 3 * frame->width * frame->height; i++)
        frame->rgb[i] = (uint8_t)(256 * check_random(seed));
    cells_begin(c, frame, PALETTE_24BIT, GLYPHS_BLOCK);
}

static void unmake(struct cells *c)
{
    for (int i = 0; i < COLS * ROWS; i++)
        c->cell[i].glyph = UNMADE;
}

static int rows_made(const struct cells *c)
{
    int made = 0;

    for (int y = 0; y < ROWS; y++)
        made += c->cell[y * COLS].glyph != UNMADE;
    return made;
}

static int looks_left;

static bool has_key(void)
{
    return looks_left-- <= 0;
}

/* A key that waits ends a frame after the row at which it is seen, and the next
 * frame goes on at the row after that. */
static void keys_end_a_frame_between_rows(void **state)
{
    struct cells c = make_cells(COLS, ROWS);
    struct ansi_diff a = make_ansi(COLS, ROWS);
    struct ansi_diff_draw how = {.budget_bytes = SIZE_MAX};
    struct cancel cancel = {.deadline_ns = 1, .is_due = has_key};
    struct frame frame;
    uint64_t seed = 7;

    (void)state;
    vt_open(&vt, COLS, ROWS);
    begin_random(&c, &frame, &seed);
    frame.cancel = &cancel;
    unmake(&c);
    ansi_diff_begin(&a);
    looks_left = 4;
    assert_false(ansi_diff_picture(&a, &c, &how));
    assert_int_equal(rows_made(&c), 5);
    assert_int_equal(a.next_row, 5);
    assert_int_equal(a.next_col, 0);
    looks_left = 0; /* a key is there all the time: each frame has a row */
    unmake(&c);
    assert_false(ansi_diff_picture(&a, &c, &how));
    assert_int_equal(rows_made(&c), 1);
    assert_int_not_equal(c.cell[5 * COLS].glyph, UNMADE);
    frame.cancel = NULL;
    assert_true(ansi_diff_picture(&a, &c, &how));
    show(&a);
    cells_from_frame(&c, &frame, PALETTE_24BIT, GLYPHS_BLOCK);
    check_shown(&c, 0, 0);
    frame_free(&frame);
    ansi_diff_free(&a);
    cells_free(&c);
}

/* A frame that needs many pieces of output makes each row once, and one more
 * time in each piece that begins or ends in it. */
static void pieces_make_only_their_rows(void **state)
{
    struct cells c = make_cells(COLS, ROWS);
    struct ansi_diff a = make_ansi(COLS, ROWS);
    struct ansi_diff_draw how = {.budget_bytes = 100};
    bool is_done = false;
    int pieces = 0, made = 0;
    struct frame frame;
    uint64_t seed = 8;

    (void)state;
    begin_random(&c, &frame, &seed);
    for (; !is_done; pieces++) {
        ansi_diff_begin(&a);
        unmake(&c);
        is_done = ansi_diff_picture(&a, &c, &how);
        made += rows_made(&c);
    }
    assert_true(pieces > 10 * ROWS);
    assert_in_range(made, pieces, pieces + 2 * ROWS);
    frame_free(&frame);
    ansi_diff_free(&a);
    cells_free(&c);
}

/* However small the budget is, every cell is drawn some time, and no frame is
 * much larger than the budget. */
static void budget_is_kept(void **state)
{
    struct cells c = make_cells(COLS, ROWS);
    struct ansi_diff a = make_ansi(COLS, ROWS);
    struct ansi_diff_draw how = {.budget_bytes = 100};
    uint64_t seed = 6;
    bool is_done = false;
    int frames = 0;

    (void)state;
    vt_open(&vt, COLS, ROWS);
    scramble(&c, PALETTE_24BIT, 1.0, &seed);
    for (; !is_done; frames++) {
        ansi_diff_begin(&a);
        is_done = ansi_diff_picture(&a, &c, &how);
        assert_true(a.length < 100 + 56);
        show(&a);
        forget_colors();
        assert_true(frames < 10000);
    }
    assert_true(frames > 10);
    check_shown(&c, 0, 0);

    /* If the picture never stops changing, all cells are still drawn some
     * time. */
    vt_open(&vt, COLS, ROWS);
    ansi_diff_invalidate_all(&a);
    for (int i = 0; i < 4 * frames; i++) {
        scramble(&c, PALETTE_24BIT, 1.0, &seed);
        ansi_diff_begin(&a);
        ansi_diff_picture(&a, &c, &how);
        show(&a);
        forget_colors();
    }
    for (int i = 0; i < COLS * ROWS; i++)
        assert_int_not_equal(vt.cell[i / COLS][i % COLS].glyph, 0);
    ansi_diff_free(&a);
    cells_free(&c);
}

static void small_differences_may_stay(void **state)
{
    struct cells c = make_cells(3, 1);
    struct ansi_diff a = make_ansi(3, 1);
    struct ansi_diff_draw how = {.budget_bytes = SIZE_MAX, .step = 2};

    (void)state;
    c.palette = PALETTE_24BIT;
    c.cell[0] = (struct cell){0x101010, 0x202020, CELL_UPPER};
    c.cell[1] = (struct cell){0x303030, 0x303030, ' '};
    c.cell[2] = (struct cell){0x404040, 0x505050, CELL_UPPER};
    ansi_diff_begin(&a);
    ansi_diff_picture(&a, &c, &how);
    c.cell[0].fg = 0x12100e; /* a difference of two */
    c.cell[1] = (struct cell){0x313030, 0x302f30, CELL_UPPER};
    c.cell[2].bg = 0x505350; /* a difference of three */
    ansi_diff_begin(&a);
    ansi_diff_picture(&a, &c, &how);
    ansi_diff_text(&a, "");
    a.bytes[a.length] = '\0';
    assert_string_equal(
        a.bytes, "\033[1;3H\033[38;2;64;64;64;48;2;80;83;80m\xe2\x96\x80");
    how.step = 0; /* exact in the end */
    ansi_diff_begin(&a);
    ansi_diff_picture(&a, &c, &how);
    a.bytes[a.length] = '\0';
    assert_string_equal(a.bytes, "\033[1;1H\033[38;2;18;16;14;48;2;32;32;32m"
                                 "\xe2\x96\x80\033[38;2;49;48;48;48;2;48;47;48m"
                                 "\xe2\x96\x80");
    ansi_diff_free(&a);
    cells_free(&c);
}

static void covered_cells_stay(void **state)
{
    struct cells c = make_cells(COLS, ROWS);
    struct ansi_diff a = make_ansi(COLS, ROWS);
    struct ansi_diff_rect covers[2] = {{5, 2, 20, 6}, {25, 3, 3, 3}};
    struct ansi_diff_draw how = {.budget_bytes = SIZE_MAX,
                                 .covered = covers,
                                 .covered_count = 2};
    uint64_t seed = 7;

    (void)state;
    vt_open(&vt, COLS, ROWS);
    scramble(&c, PALETTE_256, 1.0, &seed);
    ansi_diff_begin(&a);
    assert_true(ansi_diff_picture(&a, &c, &how));
    show(&a);
    for (int y = 0; y < ROWS; y++) {
        for (int x = 0; x < COLS; x++) {
            bool inside = (x >= 5 && x < 25 && y >= 2 && y < 8) ||
                          (x >= 25 && x < 28 && y >= 3 && y < 6);

            assert_true((vt.cell[y][x].glyph == 0) == inside);
        }
    }
    /* The windows are closed, and curses has cleared them. */
    how.covered_count = 0;
    for (int y = 2; y < 8; y++)
        memset(vt.cell[y], 0, sizeof vt.cell[y]);
    ansi_diff_invalidate(&a, (struct ansi_diff_rect){-3, 2, COLS + 9, 6});
    ansi_diff_begin(&a);
    assert_true(ansi_diff_picture(&a, &c, &how));
    forget_colors();
    show(&a);
    check_shown(&c, 0, 0);
    ansi_diff_free(&a);
    cells_free(&c);
}

/* Compares with byte sequences that were written by hand. */
static void changes_take_few_bytes(void **state)
{
    struct cells c = make_cells(4, 1);
    struct ansi_diff a = make_ansi(4, 1);
    struct ansi_diff_draw how = {.budget_bytes = SIZE_MAX};

    (void)state;
    c.palette = PALETTE_16;
    for (int i = 0; i < 4; i++)
        c.cell[i] = (struct cell){12, 1, CELL_UPPER};
    ansi_diff_begin(&a);
    ansi_diff_picture(&a, &c, &how);
    a.bytes[a.length] = '\0';
    assert_string_equal(a.bytes, "\033[1;1H\033[94;41m\xe2\x96\x80\xe2\x96\x80"
                                 "\xe2\x96\x80\xe2\x96\x80");
    c.cell[0].fg = 2;
    c.cell[2] = (struct cell){1, 1, ' '}; /* after one that stays */
    ansi_diff_begin(&a);
    ansi_diff_picture(&a, &c, &how);
    a.bytes[a.length] = '\0';
    assert_string_equal(a.bytes, "\033[1;1H\033[32;41m\xe2\x96\x80\033[C ");
    ansi_diff_free(&a);
    cells_free(&c);
}

/* Prints as the system does for a terminal: a line feed returns the cursor. */
static void print_lines(const char *text, size_t size_bytes)
{
    for (size_t i = 0; i < size_bytes; i++) {
        if (text[i] == '\n')
            vt_write(&vt, "\r", 1);
        vt_write(&vt, text + i, 1);
    }
}

/* Text for a file shows the same cells as the screen without moving the cursor,
 * and ends each line with the default colours. */
static void text_lines_show_the_cells(void **state)
{
    static const enum glyphs kinds[] = {GLYPHS_BLOCK, GLYPHS_BRAILLE};
    struct cells c = make_cells(COLS, ROWS);
    struct error err;
    uint64_t seed = 8;

    (void)state;
    for (int round = 0; round < 16; round++) {
        size_t size_bytes;
        char *text;

        vt_open(&vt, COLS, ROWS + 1);
        c.glyphs = kinds[round / 8];
        scramble(&c, (enum palette)(round % 4), 1.0, &seed);
        assert_true(ansi_diff_lines(&c, &text, &size_bytes, &err));
        assert_int_equal(text[size_bytes - 1], '\n');
        for (size_t i = 0; i < size_bytes; i++) {
            if (text[i] == '\n' && c.palette != PALETTE_MONO)
                assert_memory_equal(text + i - 3, "\033[m", 3);
            if (text[i] != '\033')
                continue;
            /* colours, without any movement */
            assert_true(c.palette != PALETTE_MONO);
            assert_int_equal(text[i + 2 + strspn(text + i + 2, "0123456789;")],
                             'm');
        }
        print_lines(text, size_bytes);
        assert_int_equal(vt.row, ROWS);
        check_shown(&c, 0, 0);
        free(text);
    }
    cells_free(&c);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(screen_shows_the_cells),
        cmocka_unit_test(budget_is_kept),
        cmocka_unit_test(keys_end_a_frame_between_rows),
        cmocka_unit_test(pieces_make_only_their_rows),
        cmocka_unit_test(small_differences_may_stay),
        cmocka_unit_test(covered_cells_stay),
        cmocka_unit_test(changes_take_few_bytes),
        cmocka_unit_test(text_lines_show_the_cells),
    };

    return cmocka_run_group_tests(tests, NULL, NULL);
}
