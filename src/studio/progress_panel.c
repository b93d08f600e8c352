// SPDX-License-Identifier: MIT
#include "studio/progress_panel.h"

#include <stdlib.h>

#include "base/clock.h"
#include "terminal/gauge.h"
#include "terminal/xmalloc.h"
#include "studio/progress_text.h"
#include "studio/status_line.h"

/* Time between two updates, long enough to read the numbers. */
#define UPDATE_NS UINT64_C(500000000)

static const struct backend *backend_of(const struct render_control *control)
{
    return render_backend(control->session->render);
}

void progress_panel_switch(struct progress_panel *panel,
                           const struct render_control *control)
{
    panel->is_on = !panel->is_on;
    panel->due_ns = 0;
    thread_load_begin(&panel->load, backend_of(control));
    panel->load_ns = clock_ns();
}

uint64_t progress_panel_next_ns(const struct progress_panel *panel,
                                const struct render_control *control)
{
    bool changes =
        control->progress.state == RENDER_RUNNING || panel->due_ns == 0;

    return panel->is_on && changes ? panel->due_ns : UINT64_MAX;
}

/* Measures the load of each thread since the last update. Loads are 0 if the
 * render is paused. */
static void measure_loads(struct progress_panel *panel,
                          const struct render_control *control, uint64_t now_ns,
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

/* Draws the gauge into its blank line. */
static void draw_gauge(const struct render_progress *p, struct screen *screen)
{
    const struct term_caps *d = &screen->display;
    struct cell cells[PROGRESS_TEXT_COLS];
    double part = 0;

    status_line_part(p, &part);
    gauge_cells(cells, PROGRESS_TEXT_COLS, part,
                theme_style(d->theme, d->palette, ROLE_GAUGE), d->has_unicode);
    windows_paint(WINDOW_OVER, 1 + PROGRESS_TEXT_GAUGE, 2, cells,
                  PROGRESS_TEXT_COLS);
}

void progress_panel_draw(struct progress_panel *panel,
                         const struct render_control *control,
                         struct screen *screen, uint64_t now_ns)
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
    if (screen->window.cols == 0)
        screen_open_window(screen, WINDOW_TOP_RIGHT, " progress ", lines,
                           row_count);
    else
        screen_set_window(screen, lines, row_count);
    draw_gauge(&control->progress, screen);
    panel->due_ns = now_ns + UPDATE_NS;
}

void progress_panel_free(struct progress_panel *panel)
{
    thread_load_free(&panel->load);
    *panel = (struct progress_panel){0};
}
