// SPDX-License-Identifier: MIT
#include "studio/error_graph.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "base/min_max.h"
#include "base/print.h"
#include "render/error_text.h"
#include "studio/about_window.h"
#include "studio/status_line.h"

/* Dots of a braille character. */
#define ACROSS 2
#define DOWN   4

/* Times of the target further than this are not shown: the course so far would
 * be squeezed. */
#define AHEAD_MAX 100

/* Columns of the labels at the left, such as "0.0010 %". */
#define LABEL_COLS 9

/* ---- plot ---- */

/* Returns the part of the way from one end of a logarithmic axis to the other,
 * 0 to 1. */
static double part_of(double value, double from, double to)
{
    double part =
        from < to || from > to ? log(value / from) / log(to / from) : 0;

    return fmin(fmax(part, 0), 1);
}

/* Returns the error at a time, on straight lines between those that are known
 * and to the target at the end of the axis. */
static double error_at(const struct error_graph *g,
                       const struct error_history *h, double target,
                       double time_s)
{
    struct error_then a = h->points[0], b = a;

    for (int i = 0; i < h->count && b.time_s <= time_s; i++) {
        a = b;
        b = h->points[i];
    }
    if (b.time_s <= time_s) {
        a = b;
        b = (struct error_then){g->to_s, target};
    }
    return a.error *
           pow(b.error / a.error, part_of(time_s, a.time_s, b.time_s));
}

/* Finds the axes. Returns false if the target is not on them. */
static bool set_axes(struct error_graph *g, const struct error_history *h,
                     double target, double target_s)
{
    struct error_then last = h->points[h->count - 1];
    bool goes_on = target_s > last.time_s &&
                   target_s < AHEAD_MAX * last.time_s && target > 0 &&
                   target < last.error;

    g->from_s = h->points[0].time_s;
    g->to_s = goes_on ? target_s : last.time_s;
    g->high = g->low = goes_on ? target : last.error;
    for (int i = 0; i < h->count; i++) {
        g->high = fmax(g->high, h->points[i].error);
        g->low = fmin(g->low, h->points[i].error);
    }
    return goes_on;
}

/* The dots of a column of a plot, as bits of the rows of dots. */
struct dots {
    bool is_set[ACROSS][DOWN * ERROR_GRAPH_ROWS];
};

/* Writes the character of a cell. Braille has Unicode's bits; an ASCII
 * character shows how high the dots are piled. */
static void put_cell(char *text, const struct dots *d, int row,
                     bool has_unicode)
{
    static const unsigned char bits[ACROSS][DOWN] = {{0x01, 0x02, 0x04, 0x40},
                                                     {0x08, 0x10, 0x20, 0x80}};
    int count[ACROSS] = {0, 0};
    unsigned set = 0;

    for (int x = 0; x < ACROSS; x++) {
        for (int y = 0; y < DOWN; y++) {
            if (!d->is_set[x][DOWN * row + y])
                continue;
            set |= bits[x][y];
            count[x]++;
        }
    }
    if (has_unicode)
        snprintf(text, 4, "\xe2%c%c", (char)(0xa0 | set >> 6),
                 (char)(0x80 | (set & 0x3f)));
    else
        snprintf(text, 2, "%c", " .:|#"[int_max(count[0], count[1])]);
}

bool error_graph_plot(struct error_graph *g, const struct error_history *h,
                      double target, double target_s)
{
    int width = ACROSS * g->cols, height = DOWN * g->rows;

    if (h->count < 2)
        return false;
    g->known_cols = g->cols;
    if (set_axes(g, h, target, target_s))
        g->known_cols =
            (int)(part_of(h->points[h->count - 1].time_s, g->from_s, g->to_s) *
                  g->cols);
    memset(g->text, 0, sizeof g->text);
    for (int col = 0; col < g->cols; col++) {
        struct dots d = {{{false}}};
        bool is_known = col < g->known_cols;

        for (int x = 0; x < ACROSS; x++) {
            double time_s =
                g->from_s * pow(g->to_s / g->from_s,
                                (double)(ACROSS * col + x) / (width - 1));
            int top =
                (int)(part_of(error_at(g, h, target, time_s), g->high, g->low) *
                          (height - 1) +
                      0.5);

            for (int y = top; y < (is_known ? height : top + 1 - x); y++)
                d.is_set[x][y] = true;
        }
        for (int row = 0; row < g->rows; row++)
            put_cell(g->text[row] + strlen(g->text[row]), &d, row,
                     g->has_unicode);
    }
    return true;
}

/* ---- drawing ---- */

/* Writes one text at the left and one at the right of a row, if both have room.
 */
static void draw_sides(int row, int col, int cols, enum text_role role,
                       const char *left, const char *right)
{
    int room = cols - text_width_of(left) - 1;

    windows_text(WINDOW_STATUS, row, col, cols, role, left);
    if (text_width_of(right) <= room)
        windows_text(WINDOW_STATUS, row, col + cols - text_width_of(right),
                     text_width_of(right), ROLE_FAINT, right);
}

static void format_time(char text[32], double s)
{
    if (s < 10)
        snprintf(text, 32, "%.2g s", s);
    else
        status_line_duration(text, 32, (uint64_t)(fmin(s, 1e9) * 1e9));
}

static void draw_label(int row, int col, double error)
{
    char text[ERROR_TEXT_BYTES];

    error_text_percent(text, error);
    windows_text(WINDOW_STATUS, row, col, LABEL_COLS, ROLE_FAINT, text);
}

static void draw_plot(const struct error_graph *g, int row, int col)
{
    size_t bytes = g->has_unicode ? 3 : 1;
    char left[32], right[32];

    draw_label(row, col, g->high);
    draw_label(row + g->rows - 1, col, g->low);
    col += LABEL_COLS;
    for (int i = 0; i < g->rows; i++) {
        windows_text(WINDOW_STATUS, row + i, col, g->cols, ROLE_KEY,
                     g->text[i]);
        windows_text(WINDOW_STATUS, row + i, col + g->known_cols,
                     g->cols - g->known_cols, ROLE_FAINT,
                     g->text[i] + bytes * (size_t)g->known_cols);
    }
    format_time(left, g->from_s);
    format_time(right, g->to_s);
    draw_sides(row + g->rows, col, g->cols, ROLE_FAINT, left, right);
}

void error_graph_draw(const struct live_render *control, struct screen *screen,
                      const struct window_rect *at)
{
    const struct render_progress *p = &control->progress;
    struct error_graph g = {.cols = int_min(at->cols - LABEL_COLS - 2,
                                            ERROR_GRAPH_COLS),
                            .rows = int_min(at->rows - 2, ERROR_GRAPH_ROWS),
                            /* curses writes the graph by the locale's
                             * characters, whatever the terminal shows */
                            .has_unicode =
                                screen->display.has_unicode && MB_CUR_MAX > 1};
    double target = p->error_limit > 0 ? p->error_limit
                                       : error_text_target(p->film_error.high);
    int row = at->row - (term_size().rows - 1); /* the status line is 0 */
    char right[ABOUT_COLS + 1];
    double ns = 0;

    for (int i = 0; i < at->rows; i++)
        windows_text(WINDOW_STATUS, row + i, at->col, at->cols, ROLE_TEXT, "");
    if (!(p->film_error.high > target) || !render_left_to_error(p, target, &ns))
        ns = 0;
    about_speed(control, right, sizeof right);
    draw_sides(row, at->col + 1, at->cols - 2, ROLE_TEXT,
               "noise of the samples", right);
    if (error_graph_plot(&g, &control->session->errors, target,
                         ns > 0 ? (ns + (double)p->render_ns) * 1e-9 : 0))
        draw_plot(&g, row + 1, at->col + 1);
    screen->must_update = true;
}
