// SPDX-License-Identifier: MIT
/*
 * The bytes go to a little terminal that knows what the standard says about
 * them (ECMA-48: CUP, CUF, SGR); what it shows must be the cells.
 */
#include "check.h"

#include <stdlib.h>
#include <string.h>

#include "glim/ansi.h"

#define COLS 40
#define ROWS 12

struct screen {
    struct cell cell[ROWS][COLS];
    int row, col;
    uint32_t fg, bg;
};

static void screen_clear(struct screen *s)
{
    memset(s, 0, sizeof *s);
    s->fg = s->bg = CELL_DEFAULT;
}

static uint32_t sgr_color(const int *p, int count, int *used)
{
    if (count >= 5 && p[1] == 2) {
        *used = 5;
        return (uint32_t)(p[2] << 16 | p[3] << 8 | p[4]);
    }
    assert_true(count >= 3 && p[1] == 5);
    *used = 3;
    return (uint32_t)p[2];
}

static void sgr(struct screen *s, const int *p, int count)
{
    for (int i = 0; i < count;) {
        int used = 1;

        if (p[i] == 0)
            s->fg = s->bg = CELL_DEFAULT;
        else if (p[i] == 38)
            s->fg = sgr_color(p + i, count - i, &used);
        else if (p[i] == 48)
            s->bg = sgr_color(p + i, count - i, &used);
        else if (p[i] == 39)
            s->fg = CELL_DEFAULT;
        else if (p[i] == 49)
            s->bg = CELL_DEFAULT;
        else if (p[i] >= 30 && p[i] < 38)
            s->fg = (uint32_t)p[i] - 30;
        else if (p[i] >= 40 && p[i] < 48)
            s->bg = (uint32_t)p[i] - 40;
        else if (p[i] >= 90 && p[i] < 98)
            s->fg = (uint32_t)p[i] - 82;
        else if (p[i] >= 100 && p[i] < 108)
            s->bg = (uint32_t)p[i] - 92;
        else
            _fail(__FILE__, __LINE__);
        i += used;
    }
}

static const char *control(struct screen *s, const char *p)
{
    int params[16] = {0};
    int count = 1;

    for (; (*p >= '0' && *p <= '9') || *p == ';'; p++) {
        if (*p == ';')
            count++;
        else
            params[count - 1] = params[count - 1] * 10 + (*p - '0');
    }
    assert_true(count <= 16);
    if (*p == 'm') {
        sgr(s, params, count);
    } else if (*p == 'H') {
        s->row = params[0] - 1;
        s->col = params[1] - 1;
    } else {
        assert_int_equal(*p, 'C');
        s->col += params[0] ? params[0] : 1;
    }
    return p + 1;
}

static void print(struct screen *s, uint32_t glyph)
{
    assert_in_range(s->row, 0, ROWS - 1);
    assert_in_range(s->col, 0, COLS - 1);
    s->cell[s->row][s->col++] = (struct cell){s->fg, s->bg, glyph};
}

static const char *print_utf8(struct screen *s, const char *p)
{
    unsigned char first = (unsigned char)*p++;
    int more = first >= 0xf0 ? 3 : first >= 0xe0 ? 2 : 1;
    uint32_t glyph = first & (0x3fu >> more);

    for (; more > 0; more--) {
        assert_int_equal(*p & 0xc0, 0x80);
        glyph = glyph << 6 | (uint32_t)(*p++ & 0x3f);
    }
    print(s, glyph);
    return p;
}

static void screen_write_bytes(struct screen *s, const char *p, size_t length)
{
    const char *end = p + length;

    while (p < end) {
        if (*p == '\n') {
            s->row++;
            s->col = 0;
            p++;
        } else if (memcmp(p, "\033[", 2) == 0) {
            p = control(s, p + 2);
        } else if (*p & 0x80) {
            p = print_utf8(s, p);
        } else {
            assert_in_range(*p, ' ', '~');
            print(s, (uint32_t)*p++);
        }
    }
}

static void screen_write(struct screen *s, const struct ansi *a)
{
    screen_write_bytes(s, a->bytes, a->length);
}

/* Colours of the dots of a cell, whatever of its two is the foreground. */
static void dots_of(const struct cell *cell, enum glyphs glyphs,
                    uint32_t dots[GLYPH_DOTS_MAX])
{
    struct glyph_grid grid = glyphs_grid(glyphs);
    unsigned mask;

    assert_true(glyphs_mask(glyphs, cell->glyph, &mask));
    for (int i = 0; i < grid.across * grid.down; i++)
        dots[i] = mask >> i & 1 ? cell->fg : cell->bg;
}

static void check_shown(const struct screen *s, const struct cells *c, int col,
                        int row)
{
    for (int y = 0; y < c->rows; y++) {
        for (int x = 0; x < c->cols; x++) {
            const struct cell *want = &c->cell[y * c->cols + x];
            const struct cell *got = &s->cell[row + y][col + x];

            uint32_t is[GLYPH_DOTS_MAX] = {0}, should[GLYPH_DOTS_MAX] = {0};

            if (want->bg == CELL_DEFAULT) { /* a character, or its dots */
                assert_int_equal(got->glyph, want->glyph);
                assert_int_equal(got->bg, want->bg);
                continue;
            }
            dots_of(got, c->glyphs, is);
            dots_of(want, c->glyphs, should);
            assert_memory_equal(is, should, sizeof is);
        }
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

/* Of which some dots are set and others not. */
static uint32_t random_glyph(enum glyphs glyphs, uint64_t *seed)
{
    struct glyph_grid grid = glyphs_grid(glyphs);
    unsigned masks = (1u << grid.across * grid.down) - 2;

    return glyphs_of_mask(glyphs, 1 + (unsigned)(masks * check_random(seed)));
}

/* Changes some cells; few colours, so that neighbours often share them. */
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

static struct ansi make_ansi(int cols, int rows)
{
    struct ansi a;
    struct error err;

    assert_true(ansi_init(&a, cols, rows, &err));
    return a;
}

/* Every palette and kind of glyphs, changes of some and of all cells. */
static void screen_shows_the_cells(void **state)
{
    struct cells c = make_cells(30, 9);
    struct ansi a = make_ansi(30, 9);
    struct ansi_draw how = {.col = 4, .row = 2, .budget_bytes = SIZE_MAX};
    static const enum glyphs kinds[5] = {GLYPHS_HALF, GLYPHS_LOWER,
                                         GLYPHS_QUADRANT, GLYPHS_SEXTANT,
                                         GLYPHS_BRAILLE};
    struct screen s;
    uint64_t seed = 5;

    (void)state;
    screen_clear(&s);
    for (int round = 0; round < 200; round++) {
        enum palette palette = (enum palette)(round / 10 % 4);
        double part = round % 10 == 0 ? 1.0 : 0.3;

        c.glyphs = kinds[round / 40];
        scramble(&c, palette, part, &seed);
        ansi_begin(&a);
        assert_true(ansi_picture(&a, &c, &how));
        ansi_end(&a, ROWS - 1);
        screen_write(&s, &a);
        check_shown(&s, &c, 4, 2);
        assert_true(s.fg == CELL_DEFAULT && s.bg == CELL_DEFAULT);
        assert_true(s.row == ROWS - 1 && s.col == 0);
    }
    ansi_begin(&a);
    assert_true(ansi_picture(&a, &c, &how));
    assert_int_equal(a.length, 0); /* nothing changed, nothing said */
    ansi_free(&a);
    cells_free(&c);
}

/* However small the budget, every cell has its turn, and no frame is much
 * larger than allowed. */
static void budget_is_kept(void **state)
{
    struct cells c = make_cells(COLS, ROWS);
    struct ansi a = make_ansi(COLS, ROWS);
    struct ansi_draw how = {.budget_bytes = 100};
    struct screen s;
    uint64_t seed = 6;
    bool is_done = false;
    int frames = 0;

    (void)state;
    screen_clear(&s);
    scramble(&c, PALETTE_24BIT, 1.0, &seed);
    for (; !is_done; frames++) {
        ansi_begin(&a);
        is_done = ansi_picture(&a, &c, &how);
        assert_true(a.length < 100 + 56);
        screen_write(&s, &a);
        s.fg = s.bg = CELL_DEFAULT;
        assert_true(frames < 10000);
    }
    assert_true(frames > 10);
    check_shown(&s, &c, 0, 0);

    /* a picture that never rests: all cells are drawn sooner or later */
    screen_clear(&s);
    ansi_forget_all(&a);
    for (int i = 0; i < 4 * frames; i++) {
        scramble(&c, PALETTE_24BIT, 1.0, &seed);
        ansi_begin(&a);
        ansi_picture(&a, &c, &how);
        screen_write(&s, &a);
        s.fg = s.bg = CELL_DEFAULT;
    }
    for (int i = 0; i < COLS * ROWS; i++)
        assert_int_not_equal(s.cell[i / COLS][i % COLS].glyph, 0);
    ansi_free(&a);
    cells_free(&c);
}

static void small_steps_may_stay(void **state)
{
    struct cells c = make_cells(3, 1);
    struct ansi a = make_ansi(3, 1);
    struct ansi_draw how = {.budget_bytes = SIZE_MAX, .step = 2};

    (void)state;
    c.palette = PALETTE_24BIT;
    c.cell[0] = (struct cell){0x101010, 0x202020, CELL_UPPER};
    c.cell[1] = (struct cell){0x303030, 0x303030, ' '};
    c.cell[2] = (struct cell){0x404040, 0x505050, CELL_UPPER};
    ansi_begin(&a);
    ansi_picture(&a, &c, &how);
    c.cell[0].fg = 0x12100e; /* by two */
    c.cell[1] = (struct cell){0x313030, 0x302f30, CELL_UPPER};
    c.cell[2].bg = 0x505350; /* by three */
    ansi_begin(&a);
    ansi_picture(&a, &c, &how);
    ansi_text(&a, "");
    a.bytes[a.length] = '\0';
    assert_string_equal(
        a.bytes, "\033[1;3H\033[38;2;64;64;64;48;2;80;83;80m\xe2\x96\x80");
    how.step = 0; /* exact at the end */
    ansi_begin(&a);
    ansi_picture(&a, &c, &how);
    a.bytes[a.length] = '\0';
    assert_string_equal(a.bytes, "\033[1;1H\033[38;2;18;16;14;48;2;32;32;32m"
                                 "\xe2\x96\x80\033[38;2;49;48;48;48;2;48;47;48m"
                                 "\xe2\x96\x80");
    ansi_free(&a);
    cells_free(&c);
}

static void covered_cells_stay(void **state)
{
    struct cells c = make_cells(COLS, ROWS);
    struct ansi a = make_ansi(COLS, ROWS);
    struct ansi_rect covers[2] = {{5, 2, 20, 6}, {25, 3, 3, 3}};
    struct ansi_draw how = {.budget_bytes = SIZE_MAX,
                            .covered = covers,
                            .covered_count = 2};
    struct screen s;
    uint64_t seed = 7;

    (void)state;
    screen_clear(&s);
    scramble(&c, PALETTE_256, 1.0, &seed);
    ansi_begin(&a);
    assert_true(ansi_picture(&a, &c, &how));
    screen_write(&s, &a);
    for (int y = 0; y < ROWS; y++) {
        for (int x = 0; x < COLS; x++) {
            bool inside = (x >= 5 && x < 25 && y >= 2 && y < 8) ||
                          (x >= 25 && x < 28 && y >= 3 && y < 6);

            assert_true((s.cell[y][x].glyph == 0) == inside);
        }
    }
    how.covered_count = 0; /* the windows close: curses has cleared there */
    for (int y = 2; y < 8; y++)
        memset(s.cell[y], 0, sizeof s.cell[y]);
    ansi_forget(&a, (struct ansi_rect){-3, 2, COLS + 9, 6});
    ansi_begin(&a);
    assert_true(ansi_picture(&a, &c, &how));
    s.fg = s.bg = CELL_DEFAULT;
    screen_write(&s, &a);
    check_shown(&s, &c, 0, 0);
    ansi_free(&a);
    cells_free(&c);
}

/* The bytes for changes that are known by heart. */
static void bytes_are_few(void **state)
{
    struct cells c = make_cells(4, 1);
    struct ansi a = make_ansi(4, 1);
    struct ansi_draw how = {.budget_bytes = SIZE_MAX};

    (void)state;
    c.palette = PALETTE_16;
    for (int i = 0; i < 4; i++)
        c.cell[i] = (struct cell){12, 1, CELL_UPPER};
    ansi_begin(&a);
    ansi_picture(&a, &c, &how);
    a.bytes[a.length] = '\0';
    assert_string_equal(a.bytes, "\033[1;1H\033[94;41m\xe2\x96\x80\xe2\x96\x80"
                                 "\xe2\x96\x80\xe2\x96\x80");
    c.cell[0].fg = 2;
    c.cell[2] = (struct cell){1, 1, ' '}; /* behind one that stays */
    ansi_begin(&a);
    ansi_picture(&a, &c, &how);
    a.bytes[a.length] = '\0';
    assert_string_equal(a.bytes, "\033[1;1H\033[32;41m\xe2\x96\x80\033[C ");
    ansi_free(&a);
    cells_free(&c);
}

/* A pattern of two colours needs them once: the glyphs alternate. Half blocks
 * of which only the upper may be used cannot do that. */
static void two_colors_stay_set(void **state)
{
    struct cells c = make_cells(6, 1);
    struct ansi a = make_ansi(6, 1);
    struct ansi_draw how = {.budget_bytes = SIZE_MAX};

    (void)state;
    c.palette = PALETTE_256;
    c.glyphs = GLYPHS_HALF;
    for (int i = 0; i < 6; i++)
        c.cell[i] = i % 2 ? (struct cell){20, 30, CELL_UPPER}
                          : (struct cell){30, 20, CELL_UPPER};
    c.cell[4] = (struct cell){20, 20, ' '};
    c.cell[5] = (struct cell){30, 30, ' '};
    ansi_begin(&a);
    ansi_picture(&a, &c, &how);
    a.bytes[a.length] = '\0';
    assert_string_equal(a.bytes, "\033[1;1H\033[38;5;30;48;5;20m"
                                 "\xe2\x96\x80\xe2\x96\x84"
                                 "\xe2\x96\x80\xe2\x96\x84 \033[48;5;30m ");
    ansi_begin(&a);
    ansi_picture(&a, &c, &how);
    assert_int_equal(a.length, 0); /* it is shown, inverse or not */
    c.glyphs = GLYPHS_UPPER;
    ansi_begin(&a);
    ansi_picture(&a, &c, &how);
    a.bytes[a.length] = '\0';
    assert_null(strstr(a.bytes, "\xe2\x96\x84"));
    assert_null(strstr(a.bytes, "\xe2\x96\x88"));
    ansi_free(&a);
    cells_free(&c);
}

/* Text for a file shows the same cells as the screen, on a screen without any
 * positions, and ends each line with the reader's own colours. */
static void lines_show_the_cells(void **state)
{
    static const enum glyphs kinds[] = {GLYPHS_HALF, GLYPHS_UPPER,
                                        GLYPHS_SEXTANT, GLYPHS_BRAILLE};
    struct cells c = make_cells(COLS, ROWS);
    struct screen s;
    struct error err;
    uint64_t seed = 8;

    (void)state;
    for (int round = 0; round < 16; round++) {
        size_t size_bytes;
        char *text;

        screen_clear(&s);
        c.glyphs = kinds[round / 4];
        scramble(&c, (enum palette)(round % 4), 1.0, &seed);
        assert_true(ansi_lines(&c, &text, &size_bytes, &err));
        assert_int_equal(text[size_bytes - 1], '\n');
        for (size_t i = 0; i < size_bytes; i++) {
            if (text[i] == '\n' && c.palette != PALETTE_MONO)
                assert_memory_equal(text + i - 3, "\033[m", 3);
            if (text[i] != '\033')
                continue;
            /* colours, and nothing that moves */
            assert_true(c.palette != PALETTE_MONO);
            assert_int_equal(text[i + 2 + strspn(text + i + 2, "0123456789;")],
                             'm');
        }
        screen_write_bytes(&s, text, size_bytes);
        assert_int_equal(s.row, ROWS);
        check_shown(&s, &c, 0, 0);
        free(text);
    }
    cells_free(&c);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(screen_shows_the_cells),
        cmocka_unit_test(budget_is_kept),
        cmocka_unit_test(small_steps_may_stay),
        cmocka_unit_test(covered_cells_stay),
        cmocka_unit_test(bytes_are_few),
        cmocka_unit_test(two_colors_stay_set),
        cmocka_unit_test(lines_show_the_cells),
    };

    return cmocka_run_group_tests(tests, NULL, NULL);
}
