// SPDX-License-Identifier: MIT
#include "terminal/screen.h"

#include <poll.h>
#include <stdio.h>
#include <string.h>
#include <unistd.h>

#include "base/clock.h"
#include "picture/raster.h"

/* The longest round trip that is waited for at the end. */
#define DRAIN_NS UINT64_C(500000000)

/* Of a frame of pixels, however fast the line: what is encoded in the time that
 * a key may wait, some 20 ms. */
#define PIXEL_BYTES_MAX ((size_t)512 << 10)

/* Sixel images with fewer colours have the 16. */
#define SIXEL_COLORS_MIN 256

/* A smaller window has no room for a picture and a word about it. */
#define COLS_MIN 40
#define ROWS_MIN 12

/* The panel, and what it leaves of a narrow window. */
#define PANEL_COLS   38
#define PICTURE_COLS 10

/* Where swatches stand in the panel. */
#define SWATCH_COL 2

void screen_init(struct screen *c, const struct term_caps_choice *choice)
{
    *c = (struct screen){.has_status_row = true};
    frame_pacing_init(&c->pace, clock_ns());
    term_caps_init(&c->display, choice);
}

/* Cells that are written over sixels replace them, over kitty's not. */
static void erase_pixels(struct screen *c)
{
    const char *eraser = pixel_graphics_eraser(c->graphics.shape.kind);

    if (eraser)
        tty_write(eraser, strlen(eraser));
}

static void free_sized(struct screen *c)
{
    pixel_graphics_free(&c->graphics);
    cells_free(&c->cells);
    frame_free(&c->frame);
    ansi_diff_free(&c->ansi);
    swatches_free(&c->swatches);
}

static void say_too_small(const struct tty_size *size)
{
    char text[96];

    snprintf(text, sizeof text, "window %dx%d: at least %dx%d is needed",
             size->cols, size->rows, COLS_MIN, ROWS_MIN);
    windows_notice(text);
}

static int panel_cols(int cols)
{
    return cols - PICTURE_COLS < PANEL_COLS ? cols - PICTURE_COLS : PANEL_COLS;
}

static bool is_too_small(const struct tty_size *size)
{
    return size->cols < COLS_MIN || size->rows < ROWS_MIN;
}

static struct fit fit_to(const struct screen *c, const struct tty_size *size,
                         int width_px, int height_px)
{
    /* sixels in the last row would scroll the screen, on some a character */
    bool is_short = c->has_status_row || tty_scrolls_at_end() ||
                    term_caps_pixels(&c->display) == PIXEL_GRAPHICS_SIXEL;

    return cells_fit(width_px, height_px, size->cols - c->panel_cols,
                     size->rows - (is_short ? 1 : 0),
                     term_caps_cell_aspect(&c->display, size));
}

struct fit screen_expect(const struct term_caps_choice *choice, int width_px,
                         int height_px)
{
    struct screen c = {.display.cell_aspect = choice->cell_aspect,
                       .has_status_row = true};
    struct tty_size size = term_size();

    if (is_too_small(&size))
        return (struct fit){0};
    return fit_to(&c, &size, width_px, height_px);
}

static int at_most(int a, int b)
{
    return a < b ? a : b;
}

/* The frame need not have more pixels than the film of this size. False if the
 * picture is not of pixels, or there is no memory for them: then of cells. */
static bool init_pixels(struct screen *c, const struct tty_size *size,
                        int width_px, int height_px, struct error *err)
{
    const struct term_caps *d = &c->display;
    bool is_poor = d->sixel_colors > 0 && d->sixel_colors < SIXEL_COLORS_MIN;
    struct pixel_graphics_shape shape = {
        .kind = term_caps_pixels(d),
        .cols = c->fit.cols,
        .rows = c->fit.rows,
        .palette = is_poor ? PALETTE_16 : PALETTE_256,
    };

    if (shape.kind == PIXEL_GRAPHICS_NONE ||
        !term_caps_cell_size(d, size, &shape.cell_width_px,
                             &shape.cell_height_px))
        return false;
    if (pixel_graphics_init(&c->graphics, &shape, err) &&
        frame_init(&c->frame, at_most(c->graphics.shown.width, width_px),
                   at_most(c->graphics.shown.height, height_px), err))
        return true;
    pixel_graphics_free(&c->graphics);
    return false;
}

static bool init_cells(struct screen *c, struct error *err)
{
    struct glyph_grid grid = glyphs_grid(c->display.glyphs);

    return cells_init(&c->cells, c->fit.cols, c->fit.rows, err) &&
           frame_init(&c->frame, grid.across * c->fit.cols,
                      grid.down * c->fit.rows, err);
}

bool screen_layout(struct screen *c, int width_px, int height_px,
                   struct error *err)
{
    struct tty_size size;

    erase_pixels(c);
    free_sized(c);
    tty_relayout();
    size = term_size();
    c->window = (struct ansi_diff_rect){0};
    c->has_status = false;
    c->has_new_panel = false;
    c->must_update = true;
    c->is_too_small = is_too_small(&size);
    if (c->is_too_small) {
        say_too_small(&size);
        return true;
    }
    c->panel_cols = c->has_panel ? panel_cols(size.cols) : 0;
    c->fit = fit_to(c, &size, width_px, height_px);
    c->cursor_col = c->cursor_col < c->fit.cols ? c->cursor_col : 0;
    c->cursor_row = c->cursor_row < c->fit.rows ? c->cursor_row : 0;
    return ansi_diff_init(&c->ansi, c->fit.cols, c->fit.rows, err) &&
           (init_pixels(c, &size, width_px, height_px, err) ||
            init_cells(c, err)) &&
           (c->panel_cols == 0 ||
            swatches_init(&c->swatches, size.rows - 1, err));
}

bool screen_answer(struct screen *c, const struct event *event)
{
    bool is_other = term_caps_answer(&c->display, event);

    if (event->kind == EVENT_READY)
        frame_pacing_answer(&c->pace, clock_ns());
    if (event->kind != EVENT_ATTRIBUTES)
        return is_other;
    c->has_all_answers = true;
    return term_caps_pixels(&c->display) != c->graphics.shape.kind;
}

const char *screen_glyphs_name(const struct screen *c)
{
    switch (c->graphics.shape.kind) {
    case PIXEL_GRAPHICS_SIXEL: return "sixel pixels";
    case PIXEL_GRAPHICS_KITTY: return "kitty pixels";
    case PIXEL_GRAPHICS_NONE: break;
    }
    return glyphs_name(c->display.glyphs);
}

/* Text was there. */
static void give_to_picture(struct screen *c, struct ansi_diff_rect rect)
{
    ansi_diff_forget(&c->ansi, rect);
    pixel_graphics_forget(&c->graphics, rect);
}

/* The last row of the screen, as a part of the picture. */
static struct ansi_diff_rect last_row(const struct screen *c)
{
    return (struct ansi_diff_rect){0, term_size().rows - 1 - c->fit.row,
                                   c->fit.cols, 1};
}

void screen_status(struct screen *c, const char *text)
{
    if (text ? c->has_status && strcmp(text, c->status) == 0 : !c->has_status)
        return;
    c->has_status = text != NULL;
    if (text)
        snprintf(c->status, sizeof c->status, "%s", text);
    windows_status(text);
    if (!text)
        give_to_picture(c, last_row(c));
    c->must_update = true;
}

void screen_show_panel(struct screen *c, const struct window_line *panel_lines,
                       int line_count)
{
    windows_show_panel(panel_lines, line_count, c->panel_cols);
    for (int y = 0; y < c->swatches.cells.rows; y++) {
        if (c->swatches.is_there[y])
            windows_spare(y, SWATCH_COL, SWATCH_COLS);
    }
    c->has_new_panel = true;
    c->must_update = true;
}

static bool write_swatches(struct screen *c)
{
    struct swatches *s = &c->swatches;
    struct tty_size size = term_size();
    struct ansi_diff_rect window = c->window;

    if (!c->has_new_panel)
        return true;
    c->has_new_panel = false;
    window.col += c->fit.col;
    window.row += c->fit.row;
    swatches_draw(s, c->display.palette, size.cols - c->panel_cols + SWATCH_COL,
                  0, &window, size.rows - 1);
    return tty_write(s->ansi.bytes, s->ansi.length);
}

static void cover(struct screen *c, struct window_rect r)
{
    c->window = (struct ansi_diff_rect){r.col - c->fit.col, r.row - c->fit.row,
                                        r.cols, r.rows};
    c->must_update = true;
}

void screen_open_window(struct screen *c, const char *title,
                        const char *const *texts, int text_count)
{
    cover(c, windows_open(title, texts, text_count));
}

void screen_open_panel(struct screen *c, const char *title,
                       const char *const *texts, int text_count)
{
    cover(c, windows_open_left(title, texts, text_count));
}

void screen_open_corner(struct screen *c, const char *title,
                        const char *const *texts, int text_count)
{
    cover(c, windows_open_corner(title, texts, text_count));
}

void screen_set_corner(struct screen *c, const char *const *texts,
                       int text_count)
{
    windows_set(texts, text_count);
    c->must_update = true;
}

void screen_close_window(struct screen *c)
{
    windows_close();
    give_to_picture(c, c->window);
    c->window = (struct ansi_diff_rect){0};
    c->has_new_panel = c->panel_cols > 0; /* it may have been below */
    c->must_update = true;
}

/* Around the cell of the cursor: white around black is seen on anything. */
static void mark_pixels(struct screen *c)
{
    struct frame *f = &c->frame;
    int x0 = c->cursor_col * f->width / c->fit.cols;
    int y0 = c->cursor_row * f->height / c->fit.rows;
    int x1 = (c->cursor_col + 1) * f->width / c->fit.cols - 1;
    int y1 = (c->cursor_row + 1) * f->height / c->fit.rows - 1;

    raster_box(f, x0 - 1, y0 - 1, x1 + 1, y1 + 1, 0);
    raster_box(f, x0 - 2, y0 - 2, x1 + 2, y1 + 2, 0xffffff);
}

/* Appends what changed in the picture; false if the budget was too small. */
static bool add_picture(struct screen *c, struct film *film, struct film *draft,
                        struct develop how, int step)
{
    struct ansi_diff_rect covered[2] = {c->window};
    struct ansi_diff_draw draw = {.col = c->fit.col,
                                  .row = c->fit.row,
                                  .budget_bytes = c->pace.budget_bytes,
                                  .step = step,
                                  .covered = covered,
                                  .covered_count = 1};

    if (c->has_status && !c->has_status_row) {
        covered[1] = last_row(c);
        draw.covered_count = 2;
    }
    film_preview(film, draft, how, &c->frame);
    if (c->painter.paint)
        c->painter.paint(c->painter.context, film, draft, &c->frame);
    if (c->graphics.shape.kind != PIXEL_GRAPHICS_NONE) {
        if (c->has_cursor)
            mark_pixels(c);
        if (draw.budget_bytes > PIXEL_BYTES_MAX)
            draw.budget_bytes = PIXEL_BYTES_MAX;
        return pixel_graphics_picture(&c->graphics, &c->ansi, &c->frame, &draw);
    }
    cells_from_frame(&c->cells, &c->frame, c->display.palette,
                     c->display.glyphs);
    if (c->has_cursor)
        cells_mark(&c->cells, c->cursor_col, c->cursor_row);
    return ansi_diff_picture(&c->ansi, &c->cells, &draw);
}

/* One write() a frame; more before it if text has changed. */
enum screen_result screen_draw(struct screen *c, struct film *film,
                               struct film *draft, struct develop how, int step)
{
    struct ansi_diff *a = &c->ansi;
    bool has_sync = tty_has_sync();
    bool has_updated = c->must_update;
    bool is_complete = true;
    bool asks;
    size_t before;

    if (c->is_too_small) {
        if (has_updated)
            windows_update();
        c->must_update = false;
        return SCREEN_DONE;
    }
    if (has_updated) {
        if (has_sync)
            tty_write(TTY_SYNC_BEGIN, sizeof TTY_SYNC_BEGIN - 1);
        windows_update();
        if (!write_swatches(c))
            return SCREEN_GONE;
        c->must_update = false;
    }
    ansi_diff_begin(a);
    if (has_sync && !has_updated)
        ansi_diff_text(a, TTY_SYNC_BEGIN);
    before = a->length;
    if (film)
        is_complete = add_picture(c, film, draft, how, step);
    if (a->length == before && !has_updated)
        return is_complete ? SCREEN_DONE : SCREEN_MORE;
    asks = a->length > before && frame_pacing_wants_request(&c->pace);
    if (a->length > before)
        ansi_diff_end(a, term_size().rows - 1);
    if (has_sync)
        ansi_diff_text(a, TTY_SYNC_END);
    if (asks)
        ansi_diff_text(a, FRAME_PACING_REQUEST);
    uint64_t begin_ns = clock_ns();
    if (!tty_write(a->bytes, a->length))
        return SCREEN_GONE;
    frame_pacing_sent(&c->pace, a->length, asks, begin_ns, clock_ns());
    return is_complete ? SCREEN_DONE : SCREEN_MORE;
}

struct ansi_text_style screen_style(const struct screen *c)
{
    return (struct ansi_text_style){c->fit.cols, c->fit.rows,
                                    c->display.palette, c->display.glyphs};
}

static bool awaits_answers(const struct screen *c)
{
    return c->pace.state != FRAME_PACING_MUTE &&
           (c->pace.outstanding > 0 || !c->has_all_answers);
}

void screen_drain(struct screen *c, struct tty_input *input)
{
    uint64_t until_ns = clock_ns() + DRAIN_NS;
    uint64_t now_ns;

    erase_pixels(c);
    while (awaits_answers(c) && (now_ns = clock_ns()) < until_ns) {
        struct pollfd in = {.fd = STDIN_FILENO, .events = POLLIN};
        unsigned char bytes[512];
        struct event event;
        int count;

        if (poll(&in, 1, (int)((until_ns - now_ns) / 1000000) + 1) <= 0)
            continue;
        count = tty_read(bytes, sizeof bytes);
        if (count < 0)
            return;
        tty_input_feed(input, bytes, (size_t)count);
        while (tty_input_next(input, false, &event))
            screen_answer(c, &event);
    }
    if (awaits_answers(c))
        tty_forget_input();
    frame_pacing_forget(&c->pace);
    c->has_all_answers = true;
}

void screen_free(struct screen *c)
{
    free_sized(c);
}
