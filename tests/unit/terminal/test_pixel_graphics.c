// SPDX-License-Identifier: MIT
/*
 * test_pixel_graphics.c - the bytes go to a small terminal that shows images at
 * its cursor; it must show the picture, and never a hole in it
 */
#include <math.h>

#include "tests/unit/pixels.h"

#include "terminal/kitty.h"
#include "terminal/pixel_graphics.h"

#define COLS   90 /* two images, and not a multiple of one */
#define ROWS   11
#define CELL_W 7
#define CELL_H 10
#define WIDTH  (COLS * CELL_W)
#define HEIGHT (ROWS * CELL_H)

/* Pixels of a window without text. */
#define BLANK (-1)

#define IDS 256

struct screen {
    int pixel[HEIGHT][WIDTH]; /* 0xRRGGBB, or BLANK */
    int owner[HEIGHT][WIDTH]; /* kitty's image there */
    int col, row;
    bool has_image[IDS]; /* kitty's */
    int images, removals;
    bool must_be_whole; /* a hole is a failure, at any time */
    struct ansi_diff_rect window;
};

static bool is_covered(const struct screen *s, int x, int y)
{
    const struct ansi_diff_rect *w = &s->window;
    int col = x / CELL_W, row = y / CELL_H;

    return col >= w->col && col < w->col + w->cols && row >= w->row &&
           row < w->row + w->rows;
}

static void check_whole(const struct screen *s)
{
    for (int y = 0; s->must_be_whole && y < HEIGHT; y++) {
        for (int x = 0; x < WIDTH; x++)
            assert_true(is_covered(s, x, y) || s->pixel[y][x] != BLANK);
    }
}

/* Shows an image that is scaled to a number of the terminal's pixels. */
static void put_pixels(struct screen *s, int width, int height,
                       const int *pixels, int to_width, int to_height, int id)
{
    for (int y = 0; y < to_height; y++) {
        for (int x = 0; x < to_width; x++) {
            int to_x = s->col * CELL_W + x, to_y = s->row * CELL_H + y;

            assert_true(to_x < WIDTH && to_y < HEIGHT);
            s->pixel[to_y][to_x] =
                pixels[y * height / to_height * width + x * width / to_width];
            s->owner[to_y][to_x] = id;
        }
    }
    s->images++;
}

static void blank(struct screen *s, int col, int row, int cols, int rows)
{
    for (int y = row * CELL_H; y < (row + rows) * CELL_H; y++) {
        for (int x = col * CELL_W; x < (col + cols) * CELL_W; x++)
            s->pixel[y][x] = BLANK;
    }
}

/* An image that others have replaced everywhere leaves no hole. */
static void remove_image(struct screen *s, int id)
{
    assert_in_range(id, 1, IDS - 1);
    assert_true(s->has_image[id]);
    s->has_image[id] = false;
    s->removals++;
    for (int y = 0; y < HEIGHT; y++) {
        for (int x = 0; x < WIDTH; x++) {
            if (s->owner[y][x] == id)
                s->pixel[y][x] = BLANK;
        }
    }
    check_whole(s);
}

static int pixel_in(const struct kitty_pixels *image, int x, int y)
{
    const uint8_t *p = image->rgb + 3 * (y * image->width + x);

    return p[0] << 16 | p[1] << 8 | p[2];
}

/* An image that waits for its placeholders. */
static struct kitty_pixels image;

static const char *take_kitty(struct screen *s, const char *p)
{
    static int pixels[PIXELS_MAX];
    bool is_virtual = p[1] == 'P';
    int id;

    if (memcmp(kitty_begin(p, is_virtual), "a=d", 3) == 0) {
        p = expect_text(kitty_begin(p, is_virtual), "a=d,d=I,i=");
        p = read_int(p, &id);
        remove_image(s, id);
        return kitty_end(expect_text(p, ",q=2"), is_virtual);
    }
    p = kitty_read(p, &image);
    /* the terminal would remove an image of the same number at once */
    assert_in_range(image.id, 16, IDS - 1);
    assert_false(s->has_image[image.id]);
    s->has_image[image.id] = true;
    for (int i = 0; i < image.width * image.height; i++)
        pixels[i] = pixel_in(&image, i, 0);
    if (is_virtual)
        s->images++;
    else
        put_pixels(s, image.width, image.height, pixels, image.cols * CELL_W,
                   image.rows * CELL_H, image.id);
    return p;
}

/* Shows the cells of a row of an image. The first has marks of row and column,
 * U+0305, U+030D, U+030E for the first three; this picture needs no more. */
static const char *take_placeholders(struct screen *s, const char *p)
{
    static const char *const marks[] = {"\xcc\x85", "\xcc\x8d", "\xcc\x8e"};
    int id, row = 0;

    p = expect_text(read_int(expect_text(p, "\033[38;5;"), &id), "m");
    assert_int_equal(id, image.id);
    p = expect_text(p, "\xf4\x8e\xbb\xae");
    while (row < 3 && memcmp(p, marks[row], 2) != 0)
        row++;
    assert_true(row < image.rows);
    p = expect_text(p + 2, marks[0]);
    for (int col = 0; col < image.cols; col++) {
        for (int y = 0; y < CELL_H; y++) {
            for (int x = 0; x < CELL_W; x++) {
                int to_x = (s->col + col) * CELL_W + x;
                int to_y = s->row * CELL_H + y;

                s->pixel[to_y][to_x] = pixel_in(
                    &image,
                    (col * CELL_W + x) * image.width / (image.cols * CELL_W),
                    (row * CELL_H + y) * image.height / (image.rows * CELL_H));
                s->owner[to_y][to_x] = id;
            }
        }
        if (col + 1 < image.cols)
            p = expect_text(p, "\xf4\x8e\xbb\xae");
    }
    return p;
}

/* Returns the colour of a sixel's register. */
static int color_of(const int percent[3])
{
    int color = 0;

    for (int c = 0; c < 3; c++)
        color = color << 8 | (percent[c] * 255 + 50) / 100;
    return color;
}

static void screen_write(struct screen *s, struct ansi_diff *a)
{
    static struct sixels sixels;
    const char *p = a->bytes;

    assert_true(ansi_diff_reserve(a, 1));
    p = a->bytes;
    a->bytes[a->length] = '\0';
    while (p < a->bytes + a->length) {
        if (memcmp(p, "\033[38", 4) == 0) {
            p = take_placeholders(s, p);
        } else if (p[1] == '[') {
            p = read_int(p + 2, &s->row);
            p = expect_text(read_int(expect_text(p, ";"), &s->col), "H");
            s->row--;
            s->col--;
        } else if (p[1] == '_' || memcmp(p, "\033Pt", 3) == 0) {
            p = take_kitty(s, p);
        } else {
            p = sixels_read(p, &sixels);
            for (int i = 0; i < sixels.width * sixels.height; i++)
                sixels.number[i] = color_of(sixels.percent[sixels.number[i]]);
            put_pixels(s, sixels.width, sixels.height, sixels.number,
                       sixels.width, sixels.height, 0);
        }
        check_whole(s);
    }
}

struct fixture {
    struct pixel_graphics g;
    struct ansi_diff a;
    struct frame frame;
    struct screen screen;
};

/* Sixels, kitty's images, and these through tmux. */
#define WAYS 3

static struct fixture st;

static void begin_layout(int way)
{
    struct pixel_graphics_shape shape = {
        .kind = way > 0 ? PIXEL_GRAPHICS_KITTY : PIXEL_GRAPHICS_SIXEL,
        .cols = COLS,
        .rows = ROWS,
        .cell_width_px = CELL_W,
        .cell_height_px = CELL_H,
        .colors = COLOR_CUT_MAX,
        .is_in_tmux = way == 2,
    };
    struct pixel_graphics before = st.g;
    struct error err;

    pixel_graphics_free(&st.g);
    assert_true(pixel_graphics_init(&st.g, &shape, &before, &err));
}

/* Returns a channel of one of 64 colours, which sixels show exactly: they have
 * more registers, whose values are whole percents. */
static uint8_t random_level(uint64_t *seed)
{
    static const uint8_t levels[4] = {0, 51, 204, 255};

    return levels[(int)(4 * check_random(seed))];
}

static void fixture_init(int way, uint64_t *seed)
{
    struct error err;

    memset(&st, 0, sizeof st);
    begin_layout(way);
    assert_true(ansi_diff_init(&st.a, COLS, ROWS, &err));
    assert_true(frame_init(&st.frame, WIDTH, HEIGHT, &err));
    for (int i = 0; i < 3 * WIDTH * HEIGHT; i++)
        st.frame.rgb[i] = random_level(seed);
    blank(&st.screen, 0, 0, COLS, ROWS);
}

static void fixture_free(void)
{
    pixel_graphics_free(&st.g);
    ansi_diff_free(&st.a);
    frame_free(&st.frame);
}

/* Draws a frame and returns the number of its images. */
static int draw(const struct ansi_diff_draw *how, enum pixel_graphics_pace pace,
                bool *is_done)
{
    st.screen.images = 0;
    st.screen.removals = 0;
    ansi_diff_begin(&st.a);
    *is_done = pixel_graphics_picture(&st.g, &st.a, &st.frame, pace, how);
    screen_write(&st.screen, &st.a);
    return st.screen.images;
}

/* Draws frames until the picture is complete. Returns their number. */
static int draw_all(const struct ansi_diff_draw *how)
{
    bool is_done = false;
    int frames = 0;

    for (; !is_done && frames < 100; frames++)
        draw(how, PIXEL_GRAPHICS_RESTS, &is_done);
    assert_true(is_done);
    return frames;
}

static int wanted(int x, int y)
{
    const uint8_t *p = st.frame.rgb + 3 * (y * WIDTH + x);

    return p[0] << 16 | p[1] << 8 | p[2];
}

/* Checks that the terminal shows the picture, and BLANK in the window. */
static void check_shown(void)
{
    for (int y = 0; y < HEIGHT; y++) {
        for (int x = 0; x < WIDTH; x++)
            assert_int_equal(st.screen.pixel[y][x], is_covered(&st.screen, x, y)
                                                        ? BLANK
                                                        : wanted(x, y));
    }
}

static void set_pixel(int x, int y, int value)
{
    memset(st.frame.rgb + 3 * (y * WIDTH + x), value, 3);
}

/* The picture at rest is exact, and a change sends only the image that has
 * changed. */
static void terminal_shows_the_picture(void **state)
{
    struct ansi_diff_draw how = {.budget_bytes = 1 << 20};
    uint64_t seed = 1;
    bool is_done;

    (void)state;
    for (int i = 0; i < WAYS; i++) {
        fixture_init(i, &seed);
        draw_all(&how);
        check_shown();
        assert_int_equal(draw(&how, PIXEL_GRAPHICS_RESTS, &is_done), 0);
        set_pixel(200, 33, 255);
        assert_int_equal(draw(&how, PIXEL_GRAPHICS_RESTS, &is_done), 1);
        check_shown();
        set_pixel(200, 33, 253); /* a difference of two may stay */
        how.step = 2;
        assert_int_equal(draw(&how, PIXEL_GRAPHICS_RESTS, &is_done), 0);
        how.step = 1;
        assert_int_equal(draw(&how, PIXEL_GRAPHICS_RESTS, &is_done), 1);
        how.step = 0;
        fixture_free();
    }
}

/* A picture that moves is new everywhere in each frame, within the budget of
 * bytes, and as fine as that allows. */
static void moving_frames_are_whole(void **state)
{
    static int before[HEIGHT][WIDTH];
    struct ansi_diff_draw how = {.budget_bytes = 40000};
    uint64_t seed = 2;
    bool is_done;

    (void)state;
    for (int i = 0; i < WAYS; i++) {
        fixture_init(i, &seed);
        for (int k = 0; k < 20; k++) {
            for (int y = 0; y < HEIGHT; y++) {
                for (int x = 0; x < WIDTH; x++)
                    set_pixel(x, y, (x / 4 + y + 97 * k) & 255);
            }
            memcpy(before, st.screen.pixel, sizeof before);
            blank(&st.screen, 0, 0, COLS, ROWS);
            draw(&how, PIXEL_GRAPHICS_MOVES, &is_done);
            assert_true(is_done);
            st.screen.must_be_whole = true;
            check_whole(&st.screen);
            st.screen.must_be_whole = false;
            if (k > 10) {
                check_at_most((double)st.a.length, 1.5 * 40000);
                assert_true(st.a.length > 40000 / 6);
            }
        }
        fixture_free();
    }
}

/* Blocks of a moving picture have the mean colour of what they replace. */
static void coarse_pixels_are_means(void **state)
{
    struct ansi_diff_draw how = {.budget_bytes = 30000};
    uint64_t seed = 3;
    bool is_done;

    (void)state;
    fixture_init(1, &seed);
    for (int y = 0; y < HEIGHT; y++) {
        for (int x = 0; x < WIDTH; x++)
            set_pixel(x, y, 255 * x / WIDTH);
    }
    draw(&how, PIXEL_GRAPHICS_MOVES, &is_done);
    for (int y = 0; y < HEIGHT; y++) {
        for (int x = 0; x < WIDTH; x++)
            check_at_most(fabs((st.screen.pixel[y][x] & 255) -
                               255.0 * x / WIDTH),
                          255.0 * 7 / WIDTH + 1); /* at most a cell wide */
    }
    for (int y = 0; y < HEIGHT; y++) { /* blocks have three columns or more */
        for (int x = 0; x < WIDTH; x++)
            set_pixel(x, y, x % 2 ? 255 : 0);
    }
    draw(&how, PIXEL_GRAPHICS_MOVES, &is_done);
    for (int y = 0; y < HEIGHT; y++) {
        for (int x = 0; x < WIDTH; x++)
            assert_in_range(st.screen.pixel[y][x] & 255, 85, 170);
    }
    fixture_free();
}

/* A picture whose sixels take few bytes becomes as fine as the screen. */
static void cheap_pictures_become_fine(void **state)
{
    struct ansi_diff_draw how = {.budget_bytes = 30000};
    uint64_t seed = 8;
    bool is_done;

    (void)state;
    fixture_init(0, &seed);
    for (int y = 0; y < HEIGHT; y++) {
        for (int x = 0; x < WIDTH; x++)
            set_pixel(x, y, y / 10 % 2 ? 255 : 0);
    }
    for (int i = 0; i < 20; i++)
        draw(&how, PIXEL_GRAPHICS_MOVES, &is_done);
    check_shown();
    assert_true(st.g.images[0].is_fine);
    fixture_free();
}

/* From the first picture on nothing is removed before its successor is there:
 * while it moves, when it comes to rest, when a window opens and closes, and
 * when the layout changes. At the end no old image is left. */
static void check_holes(int way)
{
    struct ansi_diff_rect window = {10, 2, 35, 4};
    struct ansi_diff_draw how = {.budget_bytes = 20000, .covered = &window};
    uint64_t seed = 4;
    int left = 0;
    bool is_done;

    fixture_init(way, &seed);
    draw(&how, PIXEL_GRAPHICS_MOVES, &is_done);
    st.screen.must_be_whole = true;
    for (int k = 0; k < 60; k++) {
        for (int x = 0; x < WIDTH; x++)
            set_pixel(x, (k * 7) % HEIGHT, k);
        how.covered_count = k / 10 % 2;
        if (how.covered_count)
            st.screen.window = window;
        if (k % 15 == 14)
            begin_layout(way);
        draw(&how, (enum pixel_graphics_pace)(k % 5 / 2), &is_done);
        if (how.covered_count == 0) /* where the window was is picture now */
            st.screen.window = (struct ansi_diff_rect){0, 0, 0, 0};
        check_whole(&st.screen);
    }
    draw_all(&how);
    for (int id = 1; id < IDS; id++)
        left += st.screen.has_image[id];
    assert_int_equal(left, st.g.image_count);
    fixture_free();
}

static void there_are_no_holes(void **state)
{
    (void)state;
    check_holes(1);
    check_holes(2);
}

/* A frame at rest exceeds the budget by at most four frames' worth, and a
 * picture that never stops changing is drawn everywhere. */
static void budget_is_kept(void **state)
{
    struct ansi_diff_draw how = {.budget_bytes = 6000};
    uint64_t seed = 5;
    bool is_done;

    (void)state;
    for (int i = 0; i < WAYS; i++) {
        fixture_init(i, &seed);
        draw(&how, PIXEL_GRAPHICS_MOVES, &is_done);
        for (int k = 0; k < 40; k++) {
            for (int x = 0; x < WIDTH; x++)
                set_pixel(x, (k * 7) % HEIGHT, k);
            draw(&how, PIXEL_GRAPHICS_RESTS, &is_done);
            if (k > 10)
                check_at_most((double)st.a.length, 6 * 6000);
        }
        fixture_free();
    }
}

/* Images end at a window's borders, and return when it closes. */
static void windows_stay_free(void **state)
{
    struct ansi_diff_rect window = {10, 1, 25, 3};
    uint64_t seed = 6;
    bool is_done;

    (void)state;
    for (int i = 0; i < WAYS; i++) {
        struct ansi_diff_draw how = {.budget_bytes = 1 << 20,
                                     .covered = &window};

        fixture_init(i, &seed);
        draw_all(&how);
        how.covered_count = 1;
        st.screen.window = window;
        if (i == 0) /* curses overwrites sixels */
            blank(&st.screen, 10, 1, 25, 3);
        draw_all(&how);
        check_shown();
        assert_int_equal(draw(&how, PIXEL_GRAPHICS_RESTS, &is_done), 0);
        how.covered_count = 0;
        st.screen.window = (struct ansi_diff_rect){0, 0, 0, 0};
        draw_all(&how);
        check_shown();
        blank(&st.screen, 0, ROWS - 1, COLS, 1); /* a message was there */
        pixel_graphics_invalidate(&st.g);
        draw_all(&how);
        check_shown();
        fixture_free();
    }
}

/* Frames with fewer pixels than the terminal are enlarged by the terminal, or
 * by repeated sixels. */
static void small_frames_are_enlarged(void **state)
{
    struct ansi_diff_draw how = {.budget_bytes = 1 << 20};
    struct frame small;
    struct error err;
    uint64_t seed = 7;

    (void)state;
    for (int i = 0; i < WAYS; i++) {
        bool is_done = false;

        fixture_init(i, &seed);
        assert_true(frame_init(&small, WIDTH / 7, HEIGHT / 5, &err));
        for (int k = 0; k < 3 * small.width * small.height; k++)
            small.rgb[k] = random_level(&seed);
        for (int k = 0; k < 10 && !is_done; k++) {
            ansi_diff_begin(&st.a);
            is_done = pixel_graphics_picture(&st.g, &st.a, &small,
                                             PIXEL_GRAPHICS_RESTS, &how);
            screen_write(&st.screen, &st.a);
        }
        assert_true(is_done);
        for (int y = 0; y < HEIGHT; y++) {
            for (int x = 0; x < WIDTH; x++) {
                const uint8_t *p =
                    small.rgb + 3 * (y / 5 * small.width + x / 7);

                assert_int_equal(st.screen.pixel[y][x],
                                 p[0] << 16 | p[1] << 8 | p[2]);
            }
        }
        frame_free(&small);
        fixture_free();
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(terminal_shows_the_picture),
        cmocka_unit_test(moving_frames_are_whole),
        cmocka_unit_test(coarse_pixels_are_means),
        cmocka_unit_test(cheap_pictures_become_fine),
        cmocka_unit_test(there_are_no_holes),
        cmocka_unit_test(budget_is_kept),
        cmocka_unit_test(windows_stay_free),
        cmocka_unit_test(small_frames_are_enlarged),
    };

    return cmocka_run_group_tests(tests, NULL, NULL);
}
