// SPDX-License-Identifier: MIT
#include "studio/progress_panel.h"

#include <stdlib.h>

#include "studio/progress_text.h"

/* It is to be read, not watched. */
#define GAUGE_NS UINT64_C(500000000)

static const struct backend *backend_of(const struct work *work)
{
    return render_backend(work->session->render);
}

void gauge_switch(struct gauge *g, const struct work *work)
{
    g->is_on = !g->is_on;
    g->due_ns = 0;
    load_begin(&g->load, backend_of(work));
    g->load_ns = clock_ns();
}

uint64_t gauge_next_ns(const struct gauge *g, const struct work *work)
{
    bool changes = work->progress.state == RENDER_RUNNING || g->due_ns == 0;

    return g->is_on && changes ? g->due_ns : UINT64_MAX;
}

/* Of each thread since the last time; a paused render has none. */
static void measure_loads(struct gauge *g, const struct work *work,
                          uint64_t now_ns, double *loads)
{
    const struct backend *b = backend_of(work);
    bool is_running = work->progress.state == RENDER_RUNNING;

    for (int i = 0; i < b->thread_count && is_running; i++)
        loads[i] = load_share(&g->load, b, i, now_ns - g->load_ns);
    load_begin(&g->load, b);
    g->load_ns = now_ns;
}

void gauge_draw(struct gauge *g, const struct work *work, struct canvas *canvas,
                uint64_t now_ns)
{
    size_t thread_count = (size_t)backend_of(work)->thread_count;
    double *loads = xcalloc(thread_count, sizeof *loads);
    char texts[METER_ROWS][METER_BYTES];
    const char *lines[METER_ROWS];
    struct meter_facts facts = {
        .progress = &work->progress,
        .speeds = &work->session->speeds,
        .loads = loads,
        .has_unicode = canvas->display.has_unicode,
    };

    measure_loads(g, work, now_ns, loads);
    facts.load_count = g->load.count;
    meter_format(texts, &facts);
    free(loads);
    for (int i = 0; i < METER_ROWS; i++)
        lines[i] = texts[i];
    if (canvas->window.cols == 0)
        canvas_open_corner(canvas, " progress ", lines, METER_ROWS);
    else
        canvas_set_corner(canvas, lines, METER_ROWS);
    g->due_ns = now_ns + GAUGE_NS;
}

void gauge_free(struct gauge *g)
{
    load_free(&g->load);
    *g = (struct gauge){0};
}
