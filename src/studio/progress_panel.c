// SPDX-License-Identifier: MIT
#include "studio/progress_panel.h"

#include <stdlib.h>

#include "base/clock.h"
#include "base/memory.h"
#include "studio/progress_text.h"

/* It is to be read, not watched. */
#define GAUGE_NS UINT64_C(500000000)

static const struct backend *backend_of(const struct render_control *work)
{
    return render_backend(work->session->render);
}

void progress_panel_switch(struct progress_panel *g,
                           const struct render_control *work)
{
    g->is_on = !g->is_on;
    g->due_ns = 0;
    thread_load_begin(&g->load, backend_of(work));
    g->load_ns = clock_ns();
}

uint64_t progress_panel_next_ns(const struct progress_panel *g,
                                const struct render_control *work)
{
    bool changes = work->progress.state == RENDER_RUNNING || g->due_ns == 0;

    return g->is_on && changes ? g->due_ns : UINT64_MAX;
}

/* Of each thread since the last time; a paused render has none. */
static void measure_loads(struct progress_panel *g,
                          const struct render_control *work, uint64_t now_ns,
                          double *loads)
{
    const struct backend *b = backend_of(work);
    bool is_running = work->progress.state == RENDER_RUNNING;

    for (int i = 0; i < b->thread_count && is_running; i++)
        loads[i] = thread_load_share(&g->load, b, i, now_ns - g->load_ns);
    thread_load_begin(&g->load, b);
    g->load_ns = now_ns;
}

void progress_panel_draw(struct progress_panel *g,
                         const struct render_control *work,
                         struct screen *canvas, uint64_t now_ns)
{
    size_t thread_count = (size_t)backend_of(work)->thread_count;
    double *loads = xcalloc(thread_count, sizeof *loads);
    char texts[PROGRESS_TEXT_ROWS][PROGRESS_TEXT_BYTES];
    const char *lines[PROGRESS_TEXT_ROWS];
    struct progress_text_facts facts = {
        .progress = &work->progress,
        .speeds = &work->session->speeds,
        .loads = loads,
        .has_unicode = canvas->display.has_unicode,
    };

    measure_loads(g, work, now_ns, loads);
    facts.load_count = g->load.count;
    progress_text_format(texts, &facts);
    free(loads);
    for (int i = 0; i < PROGRESS_TEXT_ROWS; i++)
        lines[i] = texts[i];
    if (canvas->window.cols == 0)
        screen_open_corner(canvas, " progress ", lines, PROGRESS_TEXT_ROWS);
    else
        screen_set_corner(canvas, lines, PROGRESS_TEXT_ROWS);
    g->due_ns = now_ns + GAUGE_NS;
}

void progress_panel_free(struct progress_panel *g)
{
    thread_load_free(&g->load);
    *g = (struct progress_panel){0};
}
