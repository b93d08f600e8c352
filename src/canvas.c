// SPDX-License-Identifier: MIT
#include "glim/canvas.h"

#include <math.h>
#include <poll.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#define SYNC_BEGIN "\033[?2026h"
#define SYNC_END   "\033[?2026l"

/* The longest round trip that is waited for at the end. */
#define DRAIN_NS UINT64_C(500000000)

/* A smaller window has no room for a picture and a word about it. */
#define COLS_MIN 40
#define ROWS_MIN 12

/* The panel, and what it leaves of a narrow window. */
#define PANEL_COLS   38
#define PICTURE_COLS 12

static enum palette palette_of_option(enum color_mode mode)
{
    switch (mode) {
    case COLOR_MONO: return PALETTE_MONO;
    case COLOR_16: return PALETTE_16;
    case COLOR_256: return PALETTE_256;
    case COLOR_24BIT:
    case COLOR_AUTO: break;
    }
    return PALETTE_24BIT;
}

static void choose_palette(struct canvas *c, enum color_mode mode)
{
    c->palette_is_final = true;
    if (mode == COLOR_AUTO)
        c->palette = term_palette(&c->palette_is_final);
    else
        c->palette = palette_of_option(mode);
}

static void choose_glyphs(struct canvas *c, enum glyph_mode mode)
{
    bool may_learn;

    c->glyphs_are_final = true;
    switch (mode) {
    case GLYPH_UPPER: c->glyphs = GLYPHS_UPPER; return;
    case GLYPH_LOWER: c->glyphs = GLYPHS_LOWER; return;
    case GLYPH_SPACE: c->glyphs = GLYPHS_SPACE; return;
    case GLYPH_ASCII: c->glyphs = GLYPHS_ASCII; return;
    case GLYPH_AUTO: break;
    }
    c->glyphs = term_is_utf8(&may_learn) ? GLYPHS_UPPER : GLYPHS_SPACE;
    c->glyphs_are_final = !may_learn;
}

void canvas_init(struct canvas *c, const struct options *options)
{
    *c = (struct canvas){.has_status_row = true};
    pace_init(&c->pace, clock_ns());
    c->cell_aspect = options->cell_aspect;
    c->aspect_is_final = options->cell_aspect > 0;
    choose_glyphs(c, options->glyph);
    choose_palette(c, options->color);
}

static void free_sized(struct canvas *c)
{
    cells_free(&c->cells);
    frame_free(&c->frame);
    ansi_free(&c->ansi);
    swatches_free(&c->swatches);
}

static void say_too_small(const struct term_size *size)
{
    char text[96];

    snprintf(text, sizeof text, "window %dx%d: at least %dx%d is needed",
             size->cols, size->rows, COLS_MIN, ROWS_MIN);
    term_notice(text);
}

/* What the person gave, what the terminal answered, what the system says, what
 * is common. */
static double cell_aspect(const struct canvas *c, const struct term_size *size)
{
    if (c->cell_aspect > 0)
        return c->cell_aspect;
    /* from far away the system's pixels can be nonsense */
    if (size->cell_aspect >= 0.5 && size->cell_aspect <= 5)
        return size->cell_aspect;
    return 2;
}

static int panel_cols(int cols)
{
    return cols - PICTURE_COLS < PANEL_COLS ? cols - PICTURE_COLS : PANEL_COLS;
}

static bool is_too_small(const struct term_size *size)
{
    return size->cols < COLS_MIN || size->rows < ROWS_MIN;
}

static struct fit fit_to(const struct canvas *c, const struct term_size *size,
                         int width_px, int height_px)
{
    return cells_fit(width_px, height_px, size->cols - c->panel_cols,
                     size->rows - (c->has_status_row ? 1 : 0),
                     cell_aspect(c, size));
}

struct fit canvas_expect(const struct options *options, int width_px,
                         int height_px)
{
    struct canvas c = {.cell_aspect = options->cell_aspect,
                       .has_status_row = true};
    struct term_size size = term_size();

    if (is_too_small(&size))
        return (struct fit){0};
    return fit_to(&c, &size, width_px, height_px);
}

bool canvas_layout(struct canvas *c, int width_px, int height_px,
                   struct error *err)
{
    struct term_size size;

    free_sized(c);
    term_relayout();
    size = term_size();
    c->window = (struct ansi_rect){0};
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
    return cells_init(&c->cells, c->fit.cols, c->fit.rows, err) &&
           frame_init(&c->frame, c->fit.cols, 2 * c->fit.rows, err) &&
           ansi_init(&c->ansi, c->fit.cols, c->fit.rows, err) &&
           (c->panel_cols == 0 ||
            swatches_init(&c->swatches, size.rows - 1, err));
}

static bool take_cell_size(struct canvas *c, const struct event *event)
{
    double before = c->cell_aspect;
    double aspect;

    if (c->aspect_is_final || event->x < 1 || event->y < 1)
        return false;
    aspect = (double)event->y / event->x;
    if (aspect < 0.5 || aspect > 5)
        return false;
    if (before <= 0) {
        struct term_size size = term_size();

        before = cell_aspect(c, &size);
    }
    c->cell_aspect = aspect;
    return fabs(before - aspect) > 0.01 * aspect;
}

bool canvas_answer(struct canvas *c, const struct event *event)
{
    switch (event->kind) {
    case EVENT_READY: pace_answer(&c->pace, clock_ns()); break;
    case EVENT_TRUE_COLOR:
        if (!c->palette_is_final)
            c->palette = PALETTE_24BIT;
        break;
    case EVENT_SYNC: term_use_sync(); break;
    case EVENT_CELL_SIZE: return take_cell_size(c, event);
    case EVENT_CURSOR:
        if (!c->glyphs_are_final)
            c->glyphs = event->x == 2 ? GLYPHS_UPPER : GLYPHS_SPACE;
        c->glyphs_are_final = true;
        break;
    case EVENT_ATTRIBUTES: c->has_all_answers = true; break;
    case EVENT_KEY:
    case EVENT_MOUSE: break;
    }
    return false;
}

void canvas_next_palette(struct canvas *c)
{
    c->palette_is_final = true;
    c->palette = c->palette == PALETTE_MONO ? PALETTE_24BIT
                                            : (enum palette)(c->palette - 1);
}

/* Rows of the screen, which curses may have cleared to their ends. */
static void forget_rows(struct canvas *c, int row, int rows)
{
    ansi_forget(&c->ansi,
                (struct ansi_rect){0, row - c->fit.row, c->ansi.cols, rows});
}

void canvas_status(struct canvas *c, const char *text)
{
    if (text ? c->has_status && strcmp(text, c->status) == 0 : !c->has_status)
        return;
    c->has_status = text != NULL;
    if (text)
        snprintf(c->status, sizeof c->status, "%s", text);
    term_status(text);
    forget_rows(c, term_size().rows - 1, 1);
    c->must_update = true;
}

void canvas_show_panel(struct canvas *c, const struct term_line *panel_lines,
                       int line_count)
{
    term_show_panel(panel_lines, line_count, c->panel_cols);
    c->has_new_panel = true;
    c->must_update = true;
}

/* Curses has written the panel anew, with blanks for the swatches. */
static bool write_swatches(struct canvas *c)
{
    struct swatches *s = &c->swatches;
    struct term_size size = term_size();

    if (!c->has_new_panel)
        return true;
    c->has_new_panel = false;
    swatches_draw(s, c->palette, size.cols - c->panel_cols + 2, 0,
                  size.rows - 1);
    return term_write(s->ansi.bytes, s->ansi.length);
}

static void cover(struct canvas *c, struct term_rect r)
{
    c->window = (struct ansi_rect){r.col - c->fit.col, r.row - c->fit.row,
                                   r.cols, r.rows};
    forget_rows(c, r.row, r.rows);
    c->must_update = true;
}

void canvas_open_window(struct canvas *c, const char *title,
                        const char *const *texts, int text_count)
{
    cover(c, term_open_window(title, texts, text_count));
}

void canvas_open_corner(struct canvas *c, const char *title,
                        const char *const *texts, int text_count)
{
    cover(c, term_open_corner(title, texts, text_count));
}

void canvas_set_corner(struct canvas *c, const char *const *texts,
                       int text_count)
{
    term_set_window(texts, text_count);
    c->must_update = true;
}

bool canvas_has_unicode(const struct canvas *c)
{
    return c->glyphs == GLYPHS_UPPER || c->glyphs == GLYPHS_LOWER;
}

void canvas_close_window(struct canvas *c)
{
    term_close_window();
    forget_rows(c, c->window.row + c->fit.row, c->window.rows);
    c->window = (struct ansi_rect){0};
    c->must_update = true;
}

/* Appends what changed in the picture; false if the budget was too small. */
static bool add_picture(struct canvas *c, struct film *film, struct film *draft,
                        struct develop how, int step)
{
    struct ansi_rect covered[2] = {c->window};
    struct ansi_draw draw = {.col = c->fit.col,
                             .row = c->fit.row,
                             .budget_bytes = c->pace.budget_bytes,
                             .step = step,
                             .covered = covered,
                             .covered_count = 1};

    if (c->has_status && !c->has_status_row) {
        covered[1] = (struct ansi_rect){0, term_size().rows - 1 - c->fit.row,
                                        c->fit.cols, 1};
        draw.covered_count = 2;
    }
    film_preview(film, draft, how, &c->frame);
    cells_from_frame(&c->cells, &c->frame, c->palette, c->glyphs);
    if (c->has_cursor)
        cells_mark(&c->cells, c->cursor_col, c->cursor_row);
    return ansi_picture(&c->ansi, &c->cells, &draw);
}

/* One write() a frame; one more before curses writes its part. */
enum canvas_result canvas_draw(struct canvas *c, struct film *film,
                               struct film *draft, struct develop how, int step)
{
    struct ansi *a = &c->ansi;
    bool has_sync = term_has_sync();
    bool has_updated = c->must_update;
    bool is_complete = true;
    bool asks;
    size_t before;

    if (c->is_too_small) {
        if (has_updated)
            term_update();
        c->must_update = false;
        return CANVAS_DONE;
    }
    if (has_updated) {
        if (has_sync)
            term_write(SYNC_BEGIN, sizeof SYNC_BEGIN - 1);
        term_update();
        if (!write_swatches(c))
            return CANVAS_GONE;
        c->must_update = false;
    }
    ansi_begin(a);
    if (has_sync && !has_updated)
        ansi_text(a, SYNC_BEGIN);
    before = a->length;
    if (film)
        is_complete = add_picture(c, film, draft, how, step);
    if (a->length == before && !has_updated)
        return is_complete ? CANVAS_DONE : CANVAS_MORE;
    asks = a->length > before && pace_wants_request(&c->pace);
    if (a->length > before)
        ansi_end(a, term_size().rows - 1);
    if (has_sync)
        ansi_text(a, SYNC_END);
    if (asks)
        ansi_text(a, PACE_REQUEST);
    uint64_t begin_ns = clock_ns();
    if (!term_write(a->bytes, a->length))
        return CANVAS_GONE;
    pace_sent(&c->pace, a->length, asks, begin_ns, clock_ns());
    return is_complete ? CANVAS_DONE : CANVAS_MORE;
}

static bool awaits_answers(const struct canvas *c)
{
    return c->pace.state != PACE_MUTE &&
           (c->pace.outstanding > 0 || !c->has_all_answers);
}

void canvas_drain(struct canvas *c, struct input *input)
{
    uint64_t until_ns = clock_ns() + DRAIN_NS;
    uint64_t now_ns;

    while (awaits_answers(c) && (now_ns = clock_ns()) < until_ns) {
        struct pollfd in = {.fd = STDIN_FILENO, .events = POLLIN};
        unsigned char bytes[512];
        struct event event;
        int count;

        if (poll(&in, 1, (int)((until_ns - now_ns) / 1000000) + 1) <= 0)
            continue;
        count = term_read(bytes, sizeof bytes);
        if (count < 0)
            return;
        input_feed(input, bytes, (size_t)count);
        while (input_next(input, false, &event))
            canvas_answer(c, &event);
    }
    if (awaits_answers(c))
        term_forget_input();
    pace_forget(&c->pace);
    c->has_all_answers = true;
}

void canvas_free(struct canvas *c)
{
    free_sized(c);
}
