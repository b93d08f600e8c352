// SPDX-License-Identifier: MIT
/*
 * test_pixel_graphics.c - the bytes go to a small terminal that shows images at
 * its cursor; it must show the picture
 */
#include "tests/unit/pixels.h"

#include "terminal/kitty.h"
#include "terminal/pixel_graphics.h"

#define COLS   40 /* not a multiple of a tile's */
#define ROWS   5
#define CELL_W 7
#define CELL_H 10
#define WIDTH  (COLS * CELL_W)
#define HEIGHT (ROWS * CELL_H)

/* Pixels of a window without text. */
#define BLANK (-1)

struct screen {
    int pixel[HEIGHT][WIDTH]; /* 0xRRGGBB, a colour number, or BLANK */
    int col, row;
    int image_col[256], image_row[256],
        image_cols[256]; /* images of kitty by id */
    int images;
};

static void put_pixels(struct screen *s, int width, int height,
                       const int *pixels)
{
    for (int y = 0; y < height; y++) {
        for (int x = 0; x < width; x++) {
            int to_x = s->col * CELL_W + x, to_y = s->row * CELL_H + y;

            assert_true(to_x < WIDTH && to_y < HEIGHT);
            s->pixel[to_y][to_x] = pixels[y * width + x];
        }
    }
}

static void blank(struct screen *s, int col, int row, int cols)
{
    for (int y = row * CELL_H; y < (row + 1) * CELL_H; y++) {
        for (int x = col * CELL_W; x < (col + cols) * CELL_W; x++)
            s->pixel[y][x] = BLANK;
    }
}

static void remove_image(struct screen *s, int id)
{
    assert_in_range(id, 1, 255);
    blank(s, s->image_col[id], s->image_row[id], s->image_cols[id]);
    s->image_cols[id] = 0;
}

static const char *take_kitty(struct screen *s, const char *p)
{
    static struct kitty_pixels image;
    static int pixels[PIXELS_MAX];
    int id;

    if (memcmp(p, KITTY_ERASE_ALL, sizeof KITTY_ERASE_ALL - 1) == 0) {
        for (id = 1; id < 256; id++)
            remove_image(s, id);
        return p + sizeof KITTY_ERASE_ALL - 1;
    }
    if (memcmp(p, "\033_Ga=d", 6) == 0) {
        p = read_int(expect_text(p, "\033_Ga=d,d=I,i="), &id);
        remove_image(s, id);
        return expect_text(p, ",q=2\033\\");
    }
    p = kitty_read(p, &image);
    remove_image(s, image.id);
    s->image_col[image.id] = s->col;
    s->image_row[image.id] = s->row;
    s->image_cols[image.id] = image.width / CELL_W;
    for (int i = 0; i < image.width * image.height; i++)
        pixels[i] = image.rgb[3 * i] << 16 | image.rgb[3 * i + 1] << 8 |
                    image.rgb[3 * i + 2];
    put_pixels(s, image.width, image.height, pixels);
    return p;
}

static void screen_write(struct screen *s, struct ansi_diff *a)
{
    static struct sixels image;
    const char *p = a->bytes;

    assert_true(ansi_diff_reserve(a, 1));
    p = a->bytes;
    a->bytes[a->length] = '\0';
    while (p < a->bytes + a->length) {
        if (p[1] == '[') {
            p = read_int(p + 2, &s->row);
            p = expect_text(read_int(expect_text(p, ";"), &s->col), "H");
            s->row--;
            s->col--;
            continue;
        }
        s->images++;
        if (p[1] == '_') {
            p = take_kitty(s, p);
        } else {
            p = sixels_read(p, &image);
            put_pixels(s, image.width, image.height, image.number);
        }
    }
}

struct fixture {
    struct pixel_graphics g;
    struct ansi_diff a;
    struct frame frame;
    struct dither dither;
    struct screen screen;
};

static void fixture_init(struct fixture *st, enum pixel_graphics_kind kind,
                         uint64_t *seed)
{
    struct pixel_graphics_shape shape = {kind,   COLS,   ROWS,
                                         CELL_W, CELL_H, PALETTE_256};
    struct error err;

    memset(st, 0, sizeof *st);
    assert_true(pixel_graphics_init(&st->g, &shape, &err));
    assert_true(ansi_diff_init(&st->a, COLS, ROWS, &err));
    assert_true(frame_init(&st->frame, WIDTH, HEIGHT, &err));
    assert_true(dither_init(&st->dither, &err));
    for (int i = 0; i < 3 * WIDTH * HEIGHT; i++)
        st->frame.rgb[i] = (uint8_t)(256 * check_random(seed));
    for (int row = 0; row < ROWS; row++)
        blank(&st->screen, 0, row, COLS);
}

static void fixture_free(struct fixture *st)
{
    pixel_graphics_free(&st->g);
    ansi_diff_free(&st->a);
    frame_free(&st->frame);
    dither_free(&st->dither);
}

/* Draws a frame and returns the number of its images. */
static int draw(struct fixture *st, const struct ansi_diff_draw *how,
                bool *is_done)
{
    st->screen.images = 0;
    ansi_diff_begin(&st->a);
    *is_done = pixel_graphics_picture(&st->g, &st->a, &st->frame, how);
    screen_write(&st->screen, &st->a);
    return st->screen.images;
}

static int wanted(struct fixture *st, int x, int y)
{
    const uint8_t *p = st->frame.rgb + 3 * (y * WIDTH + x);
    struct rgb c = {p[0], p[1], p[2]};

    if (st->g.shape.kind == PIXEL_GRAPHICS_SIXEL)
        return (int)dither_color(&st->dither, c, x, y, PALETTE_256);
    return c.r << 16 | c.g << 8 | c.b;
}

/* Checks that the terminal shows the picture, and BLANK in this rectangle of
 * cells. */
static void check_shown(struct fixture *st, struct ansi_diff_rect hole)
{
    for (int y = 0; y < HEIGHT; y++) {
        for (int x = 0; x < WIDTH; x++) {
            int col = x / CELL_W, row = y / CELL_H;
            bool inside = col >= hole.col && col < hole.col + hole.cols &&
                          row >= hole.row && row < hole.row + hole.rows;

            assert_int_equal(st->screen.pixel[y][x],
                             inside ? BLANK : wanted(st, x, y));
        }
    }
}

static void set_pixel(struct fixture *st, int x, int y, int value)
{
    memset(st->frame.rgb + 3 * (y * WIDTH + x), value, 3);
}

/* The picture is exact, and a change sends only the tile that has changed. */
static void terminal_shows_the_picture(void **state)
{
    static const enum pixel_graphics_kind kinds[] = {PIXEL_GRAPHICS_SIXEL,
                                                     PIXEL_GRAPHICS_KITTY};
    static struct fixture st;
    struct ansi_diff_draw how = {.budget_bytes = SIZE_MAX};
    uint64_t seed = 1;
    bool is_done;

    (void)state;
    for (int i = 0; i < 2; i++) {
        fixture_init(&st, kinds[i], &seed);
        draw(&st, &how, &is_done);
        assert_true(is_done);
        check_shown(&st, (struct ansi_diff_rect){0, 0, 0, 0});
        assert_int_equal(draw(&st, &how, &is_done), 0);
        set_pixel(&st, 200, 33, 255);
        assert_int_equal(draw(&st, &how, &is_done), 1);
        check_shown(&st, (struct ansi_diff_rect){0, 0, 0, 0});
        set_pixel(&st, 200, 33, 253); /* a difference of two may stay */
        how.step = 2;
        assert_int_equal(draw(&st, &how, &is_done), 0);
        how.step = 1;
        assert_int_equal(draw(&st, &how, &is_done), 1);
        how.step = 0;
        fixture_free(&st);
    }
}

/* A frame exceeds the budget by at most one tile, and a picture that never
 * stops changing is drawn everywhere. */
static void budget_is_kept(void **state)
{
    static const enum pixel_graphics_kind kinds[] = {PIXEL_GRAPHICS_SIXEL,
                                                     PIXEL_GRAPHICS_KITTY};
    static struct fixture st;
    struct ansi_diff_draw how = {.budget_bytes = 3000};
    uint64_t seed = 2;

    (void)state;
    for (int i = 0; i < 2; i++) {
        bool is_done = false;
        int frames = 0;

        fixture_init(&st, kinds[i], &seed);
        for (; !is_done && frames < 100; frames++) {
            int images = draw(&st, &how, &is_done);

            assert_true(images >= 1 || is_done);
            check_at_most((double)st.a.length, 3000 + 16 * 7 * 10 * 8);
        }
        assert_in_range(frames, 3, 20);
        check_shown(&st, (struct ansi_diff_rect){0, 0, 0, 0});
        for (int row = 0; row < ROWS; row++)
            blank(&st.screen, 0, row, COLS);
        for (int k = 0; k < 2 * frames; k++) {
            for (int x = 0; x < WIDTH; x++)
                set_pixel(&st, x, (k * 7) % HEIGHT, k);
            pixel_graphics_invalidate(&st.g, (struct ansi_diff_rect){0, 0, COLS,
                                                                     ROWS});
            draw(&st, &how, &is_done);
        }
        for (int y = 0; y < HEIGHT; y++)
            for (int x = 0; x < WIDTH; x++)
                assert_int_not_equal(st.screen.pixel[y][x], BLANK);
        fixture_free(&st);
    }
}

/* Images end at a window's borders, and return when it closes. */
static void windows_stay_free(void **state)
{
    static const enum pixel_graphics_kind kinds[] = {PIXEL_GRAPHICS_SIXEL,
                                                     PIXEL_GRAPHICS_KITTY};
    static struct fixture st;
    struct ansi_diff_rect window = {10, 1, 25, 3};
    uint64_t seed = 3;
    bool is_done;

    (void)state;
    for (int i = 0; i < 2; i++) {
        struct ansi_diff_draw how = {.budget_bytes = SIZE_MAX,
                                     .covered = &window};

        fixture_init(&st, kinds[i], &seed);
        draw(&st, &how, &is_done);
        how.covered_count = 1; /* curses overwrites sixels */
        if (kinds[i] == PIXEL_GRAPHICS_SIXEL) {
            for (int row = 1; row < 4; row++)
                blank(&st.screen, 10, row, 25);
        }
        pixel_graphics_invalidate(&st.g,
                                  (struct ansi_diff_rect){0, 1, COLS, 3});
        draw(&st, &how, &is_done);
        check_shown(&st, window);
        assert_int_equal(draw(&st, &how, &is_done), 0);
        how.covered_count = 0;
        draw(&st, &how, &is_done);
        check_shown(&st, (struct ansi_diff_rect){0, 0, 0, 0});
        fixture_free(&st);
    }
}

/* Each pixel of a frame with fewer pixels than the terminal becomes a
 * rectangle. */
static void small_frames_are_enlarged(void **state)
{
    static struct fixture st;
    struct ansi_diff_draw how = {.budget_bytes = SIZE_MAX};
    struct frame small;
    struct error err;
    uint64_t seed = 4;
    bool is_done;

    (void)state;
    fixture_init(&st, PIXEL_GRAPHICS_KITTY, &seed);
    assert_true(frame_init(&small, WIDTH / 4, HEIGHT / 5, &err));
    for (int y = 0; y < HEIGHT; y++) {
        for (int x = 0; x < WIDTH; x++) {
            uint8_t *from = st.frame.rgb + 3 * (y / 5 * 5 * WIDTH + x / 4 * 4);

            memcpy(st.frame.rgb + 3 * (y * WIDTH + x), from, 3);
            memcpy(small.rgb + 3 * (y / 5 * (WIDTH / 4) + x / 4), from, 3);
        }
    }
    ansi_diff_begin(&st.a);
    assert_true(pixel_graphics_picture(&st.g, &st.a, &small, &how));
    screen_write(&st.screen, &st.a);
    check_shown(&st, (struct ansi_diff_rect){0, 0, 0, 0});
    assert_int_equal(draw(&st, &how, &is_done), 0);
    frame_free(&small);
    fixture_free(&st);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(terminal_shows_the_picture),
        cmocka_unit_test(budget_is_kept),
        cmocka_unit_test(windows_stay_free),
        cmocka_unit_test(small_frames_are_enlarged),
    };

    return cmocka_run_group_tests(tests, NULL, NULL);
}
