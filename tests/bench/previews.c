// SPDX-License-Identifier: MIT
/*
 * previews - time for a frame of the preview while the camera moves, in a
 * window of 200x60 cells: from the restart to the cells, without the terminal
 *
 * usage: previews SCENE [COUNT]
 */
#include <stdio.h>
#include <stdlib.h>
#include <time.h>

#include "base/clock.h"
#include "session/session.h"
#include "terminal/cells.h"
#include "terminal/xmalloc.h"

#define COLS 200
#define ROWS 60

static int compare(const void *a, const void *b)
{
    uint64_t x = *(const uint64_t *)a, y = *(const uint64_t *)b;

    return x < y ? -1 : x > y;
}

/* Processor time of all threads, which other programs hardly disturb. */
static uint64_t cpu_ns(void)
{
    struct timespec t;

    clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &t);
    return (uint64_t)t.tv_sec * 1000000000u + (uint64_t)t.tv_nsec;
}

static bool draw(struct session *s, struct frame *frame, struct cells *cells,
                 struct error *err)
{
    s->edit.now.view.pose.eye[0] +=
        1e-3 * (s->edit.now.view.pose.at[0] - s->edit.now.view.pose.eye[0]) +
        1e-4;
    if (!session_restart(s, (struct render_limits){0}, err))
        return false;
    render_wait(s->engine.render, -1);
    film_preview(render_film(s->engine.render), render_draft(s->engine.render),
                 develop_linear(0), frame);
    cells_from_frame(cells, frame, PALETTE_24BIT, GLYPHS_HALF);
    return true;
}

int main(int argc, char **argv)
{
    struct options o = {.scene_path = argc > 1 ? argv[1] : NULL,
                        .max_bounces = -1};
    int count = argc > 2 ? (int)strtol(argv[2], NULL, 10) : 300;
    uint64_t *times_ns = xcalloc((size_t)count + 1, sizeof *times_ns);
    static struct session s;
    struct frame frame = {0};
    struct cells cells = {0};
    struct error err;
    uint64_t begin_cpu_ns;
    double cpu_ms;
    bool ok = argc > 1 && session_open(&s, &o, clock_ns(), &err) &&
              frame_init(&frame, COLS, 2 * ROWS, &err) &&
              cells_init(&cells, COLS, ROWS, &err);

    s.draft_width = COLS;
    s.draft_height = 2 * ROWS;
    s.sample = SAMPLE_PREVIEW;
    ok = ok && draw(&s, &frame, &cells, &err); /* builds the tree */
    begin_cpu_ns = cpu_ns();
    for (int i = 0; i < count && ok; i++) {
        uint64_t begin_ns = clock_ns();

        ok = draw(&s, &frame, &cells, &err);
        times_ns[i] = clock_ns() - begin_ns;
    }
    if (!ok) {
        fprintf(stderr, "previews: %s\n", argc < 2 ? "no scene" : err.text);
        return 1;
    }
    cpu_ms = (double)(cpu_ns() - begin_cpu_ns) * 1e-6 / count;
    qsort(times_ns, (size_t)count, sizeof *times_ns, compare);
    printf("%-24s p50 %6.2f ms, p99 %6.2f ms: %.0f frames/s; %.2f ms of one "
           "core\n",
           argv[1], (double)times_ns[count / 2] * 1e-6,
           (double)times_ns[count * 99 / 100] * 1e-6,
           1e9 / (double)times_ns[count / 2], cpu_ms);
    session_close(&s);
    cells_free(&cells);
    frame_free(&frame);
    free(times_ns);
    return 0;
}
