// SPDX-License-Identifier: MIT
#include "terminal/screen.h"

#include <poll.h>
#include <stdio.h>
#include <string.h>
#include <unistd.h>

#include "base/clock.h"
#include "base/min_max.h"
#include "film/filter/screen_filter.h"
#include "image/frame.h"
#include "terminal/kitty.h"

/* Longest wait for answers in screen_drain(). */
#define DRAIN_NS UINT64_C(500000000)

/* Most bytes of a frame of pixels on any line: encoding them takes some 20 ms,
 * and a key waits for that. */
#define PIXEL_BYTES_MAX ((size_t)512 << 10)

/* Most pixels of a frame while the picture moves: its draft must be whole
 * within the time of a frame. */
#define MOVING_PIXELS 8000

/* Smallest window that has room for a picture and a status line. */
#define COLS_MIN 40
#define ROWS_MIN 12

/* Columns of the panel. It takes the whole window if fewer than PICTURE_COLS
 * would be left for the picture. */
#define PANEL_COLS   38
#define PICTURE_COLS 20

void screen_init(struct screen *screen, const struct term_caps_choice *choice)
{
    *screen = (struct screen){.has_status_row = true};
    frame_pacing_init(&screen->pace, clock_ns());
    term_caps_init(&screen->display, choice);
}

/* Removes images that characters do not overwrite: kitty's, but not sixels. */
static void erase_images(struct screen *screen)
{
    if (screen->has_old_images ||
        screen->graphics.shape.kind == PIXEL_GRAPHICS_KITTY)
        tty_write(KITTY_ERASE_ALL, sizeof KITTY_ERASE_ALL - 1);
    screen->has_old_images = false;
}

static void free_sized(struct screen *screen)
{
    pixel_graphics_free(&screen->graphics);
    cells_free(&screen->cells);
    screen->frame_width = screen->frame_height = 0;
}

static void say_too_small(const struct tty_size *size)
{
    char text[64];
    int length = snprintf(text, sizeof text, "needs %dx%d", COLS_MIN, ROWS_MIN);

    if (size->cols >= COLS_MIN / 2)
        snprintf(text + length, sizeof text - (size_t)length, ", has %dx%d",
                 size->cols, size->rows);
    windows_notice(text);
}

static int panel_cols(int cols)
{
    return cols - PICTURE_COLS < PANEL_COLS ? cols : PANEL_COLS;
}

static bool is_too_small(const struct tty_size *size)
{
    return size->cols < COLS_MIN || size->rows < ROWS_MIN;
}

bool screen_is_hidden(const struct screen *screen)
{
    return screen->panel_cols > 0 && screen->panel_cols == term_size().cols;
}

static struct cells_rect fit_to(const struct screen *screen,
                                const struct tty_size *size, int width_px,
                                int height_px)
{
    /* Sixels in the last row scroll the screen; on some terminals a character
     * in its last cell does. */
    bool is_short = screen->has_status_row || tty_scrolls_at_end() ||
                    term_caps_pixels(&screen->display) == PIXEL_GRAPHICS_SIXEL;

    int beside = screen->panel_cols < size->cols ? screen->panel_cols : 0;
    struct cells_rect fit =
        cells_fit(width_px, height_px, size->cols - beside,
                  size->rows - (is_short ? 1 : 0),
                  term_caps_cell_aspect(&screen->display, size));

    if (beside > 0)
        fit.col = 0; /* where it is beside a bar: it stays there */
    return fit;
}

struct cells_rect screen_expect(const struct term_caps_choice *choice,
                                int width_px, int height_px)
{
    struct screen screen = {.display.cell_aspect = choice->cell_aspect,
                            .has_status_row = true};
    struct tty_size size = term_size();

    if (is_too_small(&size))
        return (struct cells_rect){0};
    return fit_to(&screen, &size, width_px, height_px);
}

/* Frames have no more pixels than the picture. Returns false if the terminal
 * shows no pixels, or without memory: cells are shown then. */
static bool init_pixels(struct screen *screen,
                        const struct pixel_graphics *before,
                        const struct tty_size *size, int width_px,
                        int height_px, struct error *err)
{
    const struct term_caps *d = &screen->display;
    struct pixel_graphics_shape shape = {
        .kind = term_caps_pixels(d),
        .cols = screen->fit.cols,
        .rows = screen->fit.rows,
        .colors = d->sixel_colors > 0 ? int_min(d->sixel_colors, COLOR_CUT_MAX)
                                      : COLOR_CUT_MAX,
        .is_in_tmux = tty_is_in_tmux(),
    };

    if (shape.kind == PIXEL_GRAPHICS_NONE ||
        !term_caps_cell_size(d, size, &shape.cell_width_px,
                             &shape.cell_height_px))
        return false;
    if (!pixel_graphics_init(&screen->graphics, &shape, before, err))
        return false;
    screen->frame_width = int_min(screen->graphics.width_px, width_px);
    screen->frame_height = int_min(screen->graphics.height_px, height_px);
    screen_filter_draft_size(screen->frame_width, screen->frame_height,
                             MOVING_PIXELS, &screen->moving_width,
                             &screen->moving_height);
    return true;
}

static bool init_cells(struct screen *screen, struct error *err)
{
    struct glyph_grid grid = glyphs_grid(screen->display.glyphs);

    screen->frame_width = grid.across * screen->fit.cols;
    screen->frame_height = grid.down * screen->fit.rows;
    if (screen->display.glyphs == GLYPHS_BLOCK)
        grid = glyphs_grid(GLYPHS_HALF);
    screen->moving_width = grid.across * screen->fit.cols;
    screen->moving_height = grid.down * screen->fit.rows;
    return cells_init(&screen->cells, screen->fit.cols, screen->fit.rows, err);
}

bool screen_layout(struct screen *screen, int width_px, int height_px,
                   struct error *err)
{
    struct pixel_graphics before = screen->graphics;
    const struct term_caps *d = &screen->display;
    bool must_clear = before.shape.kind != PIXEL_GRAPHICS_NONE ||
                      term_caps_pixels(d) != PIXEL_GRAPHICS_NONE ||
                      screen->ansi.palette != d->palette;
    struct tty_size size;
    bool ok;

    free_sized(screen);
    windows_use_theme(d->theme, d->palette);
    if (tty_relayout(must_clear))
        ansi_diff_free(&screen->ansi);
    size = term_size();
    screen->is_new = true;
    screen->window = (struct ansi_diff_rect){0};
    screen->has_status = false;
    screen->must_update = true;
    screen->is_too_small = is_too_small(&size);
    if (before.shape.kind == PIXEL_GRAPHICS_KITTY)
        screen->has_old_images = true;
    if (screen->is_too_small) {
        erase_images(screen);
        say_too_small(&size);
        return true;
    }
    screen->panel_cols = screen->has_panel ? panel_cols(size.cols) : 0;
    screen->fit = fit_to(screen, &size, width_px, height_px);
    screen->cursor_col =
        screen->cursor_col < screen->fit.cols ? screen->cursor_col : 0;
    screen->cursor_row =
        screen->cursor_row < screen->fit.rows ? screen->cursor_row : 0;
    screen->ansi.next_row = screen->ansi.next_col = 0;
    ok = (screen->ansi.shown ||
          ansi_diff_init(&screen->ansi, size.cols, size.rows, err)) &&
         (init_pixels(screen, &before, &size, width_px, height_px, err) ||
          init_cells(screen, err));
    if (screen->graphics.shape.kind == PIXEL_GRAPHICS_KITTY)
        screen->has_old_images = false; /* its first picture replaces them */
    return ok;
}

bool screen_answer(struct screen *screen, const struct event *event)
{
    enum palette palette = screen->display.palette;
    enum theme theme = screen->display.theme;
    bool is_other = term_caps_answer(&screen->display, event);

    if (screen->display.palette != palette || screen->display.theme != theme) {
        windows_use_theme(screen->display.theme, screen->display.palette);
        screen->must_update = true;
    }
    if (event->kind == EVENT_READY)
        frame_pacing_answer(&screen->pace, clock_ns());
    if (event->kind == EVENT_ATTRIBUTES)
        screen->has_all_answers = true;
    else if (event->kind != EVENT_KITTY) /* which is later inside tmux */
        return is_other;
    return term_caps_pixels(&screen->display) != screen->graphics.shape.kind;
}

const char *screen_glyphs_name(const struct screen *screen)
{
    switch (screen->graphics.shape.kind) {
    case PIXEL_GRAPHICS_SIXEL: return "sixel pixels";
    case PIXEL_GRAPHICS_KITTY: return "kitty pixels";
    case PIXEL_GRAPHICS_NONE: break;
    }
    return glyphs_name(screen->display.glyphs);
}

/* The picture has to be drawn again where text was. */
static void give_to_picture(struct screen *screen, struct ansi_diff_rect rect)
{
    rect.col += screen->fit.col;
    rect.row += screen->fit.row;
    ansi_diff_invalidate(&screen->ansi, rect);
    pixel_graphics_invalidate(&screen->graphics);
}

/* The last row of the screen, in cells of the picture. */
static struct ansi_diff_rect last_row(const struct screen *screen)
{
    return (struct ansi_diff_rect){0, term_size().rows - 1 - screen->fit.row,
                                   screen->fit.cols, 1};
}

static void draw_status(const struct screen *screen)
{
    const struct status_row *row = &screen->status;

    windows_text(WINDOW_STATUS, 0, 0, term_size().cols, row->role, row->text);
    for (int i = 0; i < row->span_count; i++)
        windows_text(WINDOW_STATUS, 0, row->spans[i].col, row->spans[i].cols,
                     row->spans[i].role, row->text + row->spans[i].col);
}

void screen_status(struct screen *screen, const struct status_row *row)
{
    if (row ? screen->has_status &&
                  memcmp(row, &screen->status, sizeof *row) == 0
            : !screen->has_status)
        return;
    screen->has_status = row != NULL;
    windows_hide_status();
    if (row) {
        screen->status = *row;
        draw_status(screen);
    } else {
        give_to_picture(screen, last_row(screen));
    }
    screen->must_update = true;
}

void screen_begin_panel(struct screen *screen)
{
    windows_open_panel(screen->panel_cols);
    screen->must_update = true;
}

static void cover(struct screen *screen, struct window_rect r)
{
    screen->window =
        (struct ansi_diff_rect){r.col - screen->fit.col,
                                r.row - screen->fit.row, r.cols, r.rows};
    screen->must_update = true;
}

struct window_rect screen_open_window(struct screen *screen,
                                      enum window_place place,
                                      const char *title,
                                      const char *const *texts, int text_count)
{
    struct window_rect r =
        windows_open(place, screen->foot_rows, title, texts, text_count);

    cover(screen, r);
    return r;
}

void screen_set_window(struct screen *screen, const char *const *texts,
                       int text_count)
{
    windows_set(texts, text_count);
    screen->must_update = true;
}

void screen_close_window(struct screen *screen)
{
    windows_close();
    give_to_picture(screen, screen->window);
    screen->window = (struct ansi_diff_rect){0};
    screen->must_update = true;
}

/* Draws the cursor around its cell: a white box around a black one is visible
 * on any colour. */
static void mark_pixels(const struct screen *screen, struct frame *f)
{
    int x0 = screen->cursor_col * f->width / screen->fit.cols;
    int y0 = screen->cursor_row * f->height / screen->fit.rows;
    int x1 = (screen->cursor_col + 1) * f->width / screen->fit.cols - 1;
    int y1 = (screen->cursor_row + 1) * f->height / screen->fit.rows - 1;

    frame_box(f, x0 - 1, y0 - 1, x1 + 1, y1 + 1, 0);
    frame_box(f, x0 - 2, y0 - 2, x1 + 2, y1 + 2, 0xffffff);
}

/* Appends changes of the picture to a frame with some text. Returns false if
 * the budget was too small for all of them; half of it is the picture's at
 * least. */
static bool add_picture(struct screen *screen, const struct screen_frame *frame,
                        size_t text_bytes)
{
    size_t budget_bytes = screen->pace.budget_bytes;
    struct ansi_diff_rect covered[3] = {screen->window};
    struct ansi_diff_draw draw = {.col = screen->fit.col,
                                  .row = screen->fit.row,
                                  .budget_bytes =
                                      budget_bytes > 2 * text_bytes
                                          ? budget_bytes - text_bytes
                                          : budget_bytes / 2,
                                  .step = frame->step,
                                  .covered = covered,
                                  .covered_count = 1};

    if (screen->has_status && !screen->has_status_row)
        covered[draw.covered_count++] = last_row(screen);
    if (screen_is_hidden(screen))
        covered[draw.covered_count++] =
            (struct ansi_diff_rect){0, 0, screen->fit.cols, screen->fit.rows};
    if (screen->graphics.shape.kind != PIXEL_GRAPHICS_NONE) {
        if (screen->has_cursor)
            mark_pixels(screen, frame->pixels);
        if (draw.budget_bytes > PIXEL_BYTES_MAX)
            draw.budget_bytes = PIXEL_BYTES_MAX;
        return pixel_graphics_picture(&screen->graphics, &screen->ansi,
                                      frame->pixels, frame->pace, &draw);
    }
    cells_begin(&screen->cells, frame->pixels, screen->display.palette,
                screen->display.glyphs);
    if (screen->has_cursor)
        cells_mark(&screen->cells, screen->cursor_col, screen->cursor_row);
    return ansi_diff_picture(&screen->ansi, &screen->cells, &draw);
}

/* Carries the cells of the terminal over to a new layout. The picture
 * overwrites text that was where it is now; text or blanks overwrite all else.
 */
static void take_over(struct screen *screen)
{
    const struct cells_rect *fit = &screen->fit;
    struct ansi_diff *a = &screen->ansi;

    for (int i = 0; i < a->cols * a->rows; i++) {
        int col = i % a->cols, row = i / a->cols;
        bool was_text = windows_shown(col, row)->kind != WINDOW_CELL_SPARED;
        bool is_picture = !screen_is_hidden(screen) && col >= fit->col &&
                          col < fit->col + fit->cols && row >= fit->row &&
                          row < fit->row + fit->rows;

        if (is_picture || !was_text)
            windows_set_shown(col, row,
                              is_picture ? WINDOW_CELL_SPARED
                                         : WINDOW_CELL_UNKNOWN);
        if (was_text || !is_picture)
            ansi_diff_shown(a, col, row)->glyph = 0;
    }
}

void screen_draw_text(struct screen *screen)
{
    if (!screen->must_update)
        return;
    screen->must_update = false;
    if (screen->is_new && !screen->is_too_small)
        take_over(screen);
    screen->is_new = false;
    if (tty_has_sync() && !screen->is_too_small) {
        tty_write(TTY_SYNC_BEGIN, sizeof TTY_SYNC_BEGIN - 1);
        screen->text_bytes = sizeof TTY_SYNC_BEGIN - 1;
    }
    screen->text_bytes += windows_update();
}

/* One write() a frame. */
enum screen_result screen_draw(struct screen *screen,
                               const struct screen_frame *frame)
{
    struct ansi_diff *a = &screen->ansi;
    bool has_sync = tty_has_sync();
    size_t text_bytes = screen->text_bytes;
    bool is_complete = true;
    bool asks;
    size_t before;

    screen->text_bytes = 0;
    if (screen->is_too_small)
        return SCREEN_DONE;
    ansi_diff_begin(a);
    if (has_sync && text_bytes == 0)
        ansi_diff_text(a, TTY_SYNC_BEGIN);
    before = a->length;
    if (frame->pixels) {
        is_complete = add_picture(screen, frame, text_bytes);
        if (screen->has_old_images)
            ansi_diff_text(a, KITTY_ERASE_ALL);
        screen->has_old_images = false;
    }
    if (a->length == before && text_bytes == 0)
        return is_complete ? SCREEN_DONE : SCREEN_MORE;
    asks = a->length > before && frame_pacing_wants_request(&screen->pace);
    if (a->length > before)
        ansi_diff_end(a, term_size().rows - 1);
    if (has_sync)
        ansi_diff_text(a, TTY_SYNC_END);
    if (asks)
        ansi_diff_text(a, FRAME_PACING_REQUEST);
    uint64_t begin_ns = clock_ns();
    if (!tty_write(a->bytes, a->length))
        return SCREEN_GONE;
    frame_pacing_sent(&screen->pace, text_bytes + a->length, asks, begin_ns,
                      clock_ns());
    return is_complete ? SCREEN_DONE : SCREEN_MORE;
}

struct ansi_text_style screen_style(const struct screen *screen)
{
    return (struct ansi_text_style){screen->fit.cols, screen->fit.rows,
                                    screen->display.palette,
                                    screen->display.glyphs};
}

static bool awaits_answers(const struct screen *screen)
{
    return screen->pace.state != FRAME_PACING_MUTE &&
           (screen->pace.outstanding > 0 || !screen->has_all_answers);
}

static void take_answers(struct screen *screen, struct tty_input *input)
{
    struct event event;

    while (tty_input_next(input, false, &event))
        screen_answer(screen, &event);
}

void screen_drain(struct screen *screen, struct tty_input *input)
{
    uint64_t until_ns = clock_ns() + DRAIN_NS;
    uint64_t now_ns;

    erase_images(screen);
    take_answers(screen, input); /* read together with the last key */
    while (awaits_answers(screen) && (now_ns = clock_ns()) < until_ns) {
        struct pollfd in = {.fd = STDIN_FILENO, .events = POLLIN};
        unsigned char bytes[512];
        int count;

        if (poll(&in, 1, (int)((until_ns - now_ns) / 1000000) + 1) <= 0)
            continue;
        count = tty_read(bytes, sizeof bytes);
        if (count < 0)
            return;
        tty_input_feed(input, bytes, (size_t)count);
        take_answers(screen, input);
    }
    if (awaits_answers(screen))
        tty_flush_input();
    frame_pacing_forget(&screen->pace);
    screen->has_all_answers = true;
}

void screen_free(struct screen *screen)
{
    free_sized(screen);
    ansi_diff_free(&screen->ansi);
}
