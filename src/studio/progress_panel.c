// SPDX-License-Identifier: MIT
#include "studio/progress_panel.h"

#include <stdio.h>
#include <stdlib.h>

#include "studio/progress_text.h"
#include "studio/status_line.h"
#include "terminal/gauge.h"
#include "terminal/xmalloc.h"

/* Time between two updates, long enough to read the numbers. */
#define UPDATE_NS UINT64_C(500000000)

/* The same on a slow line, which the picture needs. */
#define SLOW_NS UINT64_C(2000000000)

static const struct backend *backend_of(const struct live_render *control)
{
    return render_backend(control->session->engine.render);
}

uint64_t progress_panel_next_ns(const struct progress_panel *panel,
                                const struct live_render *control)
{
    bool changes =
        control->progress.state == RENDER_RUNNING || panel->due_ns == 0;

    return changes ? panel->due_ns : UINT64_MAX;
}

/* Measures the load of each thread since the last update. Loads are 0 if the
 * render is paused. */
static void measure_loads(struct progress_panel *panel,
                          const struct live_render *control, uint64_t now_ns,
                          double *loads)
{
    const struct backend *b = backend_of(control);
    bool is_running = control->progress.state == RENDER_RUNNING;

    for (int i = 0; i < b->thread_count && is_running; i++)
        loads[i] =
            thread_load_share(&panel->load, b, i, now_ns - panel->load_ns);
    thread_load_begin(&panel->load, b);
    panel->load_ns = now_ns;
}

/* Draws the gauge into its blank line, at a cell of a part of the screen. */
static void draw_gauge(const struct render_progress *p,
                       const struct screen *screen, enum window_part part_of,
                       int row, int col)
{
    const struct term_caps *d = &screen->display;
    struct cell cells[PROGRESS_TEXT_COLS];
    double part = 0;

    status_line_part(p, &part);
    gauge_cells(cells, PROGRESS_TEXT_COLS, part,
                theme_style(d->theme, d->palette, ROLE_GAUGE), d->has_unicode);
    windows_paint(part_of, row + PROGRESS_TEXT_GAUGE, col, cells,
                  PROGRESS_TEXT_COLS);
}

static void draw_window(const struct render_progress *p, struct screen *screen,
                        const char *const *lines, int count)
{
    if (screen->window.cols == 0)
        screen_open_window(screen, WINDOW_TOP_RIGHT, " progress ", lines,
                           count);
    else
        screen_set_window(screen, lines, count);
    draw_gauge(p, screen, WINDOW_OVER, 1, 2);
}

static void draw_in_bar(const struct render_progress *p, struct screen *screen,
                        const struct window_rect *bar, const char *const *lines,
                        int count)
{
    int first = bar->row - (term_size().rows - 1); /* the status line is 0 */

    for (int i = 0; i < bar->rows; i++) {
        char text[PROGRESS_TEXT_BYTES + 1];

        snprintf(text, sizeof text, " %s", i < count ? lines[i] : "");
        windows_text(WINDOW_STATUS, first + i, bar->col, bar->cols, ROLE_TEXT,
                     text);
    }
    draw_gauge(p, screen, WINDOW_STATUS, first, bar->col + 1);
    screen->must_update = true;
}

void progress_panel_draw(struct progress_panel *panel,
                         const struct live_render *control,
                         struct screen *screen, const struct window_rect *bar,
                         uint64_t now_ns)
{
    const struct backend *b = backend_of(control);
    double *loads = xcalloc((size_t)b->thread_count, sizeof *loads);
    struct rank_progress *ranks = xcalloc((size_t)b->rank_count, sizeof *ranks);
    int row_count;
    char texts[PROGRESS_TEXT_ROWS][PROGRESS_TEXT_BYTES];
    const char *lines[PROGRESS_TEXT_ROWS];
    struct progress_text_facts facts = {
        .progress = &control->progress,
        .speeds = &control->session->speeds,
        .errors = &control->session->errors,
        .loads = loads,
        .has_unicode = screen->display.has_unicode,
        .ranks = ranks,
        .rank_count = b->rank_count,
    };

    measure_loads(panel, control, now_ns, loads);
    facts.load_count = panel->load.count;
    for (int i = 0; i < b->rank_count; i++)
        ranks[i] = b->rank_progress(b, i);
    row_count = progress_text_format(texts, &facts);
    free(loads);
    free(ranks);
    for (int i = 0; i < row_count; i++)
        lines[i] = texts[i];
    if (bar)
        draw_in_bar(&control->progress, screen, bar, lines, row_count);
    if (panel->is_on)
        draw_window(&control->progress, screen, lines, row_count);
    panel->due_ns =
        now_ns + (frame_pacing_is_slow(&screen->pace) ? SLOW_NS : UPDATE_NS);
}

void progress_panel_free(struct progress_panel *panel)
{
    thread_load_free(&panel->load);
    *panel = (struct progress_panel){0};
}
