// SPDX-License-Identifier: MIT
/*
 * halts - time from the request to halt until every worker is parked, and from
 * a restart until the first whole (coarse) picture, as in a window of about 120
 * x 40 cells; and the processor time of the busiest worker until it is parked,
 * which does not depend on other programs
 *
 * usage: halts SCENE [COUNT [opencl]]
 */
#include <stdio.h>
#include <stdlib.h>
#include <unistd.h>

#include "base/clock.h"
#include "render/opencl/backend_cl.h"
#include "render/opencl/cl_api.h"
#include "session/session.h"
#include "terminal/xmalloc.h"

#define WORKERS_MAX 1024

static int compare(const void *a, const void *b)
{
    uint64_t x = *(const uint64_t *)a, y = *(const uint64_t *)b;

    return x < y ? -1 : x > y;
}

static void print_row(const char *what, uint64_t *times_ns, int count)
{
    const double shares[] = {0.5, 0.99, 0.999};

    qsort(times_ns, (size_t)count, sizeof *times_ns, compare);
    printf("%-24s", what);
    for (int i = 0; i < 3; i++)
        printf(" %8.3f",
               (double)times_ns[(int)((count - 1) * shares[i])] * 1e-6);
    printf(" %8.3f\n", (double)times_ns[count - 1] * 1e-6);
}

/* Reads the processor time of each worker. Returns the most that one has used
 * since the last call, in which no other program has a part. */
static uint64_t worker_ns(const struct backend *b)
{
    static uint64_t before[WORKERS_MAX];
    uint64_t most = 0;

    for (int i = 0; i < b->thread_count && i < WORKERS_MAX; i++) {
        uint64_t now = b->cpu_ns(b, i);

        if (now - before[i] > most)
            most = now - before[i];
        before[i] = now;
    }
    return most;
}

/* Chooses the available OpenCL device. */
static bool use_device(struct session *s, struct error *err)
{
    struct cl_request request = {.features = world_features(&s->engine.world)};
    char *log;

    s->engine.backends.device = backend_cl_create(&request, &log, err);
    if (s->engine.backends.device == NULL)
        return false;
    render_set_backend(s->engine.render, s->engine.backends.device);
    return true;
}

int main(int argc, char **argv)
{
    struct options o = {.scene_path = argc > 1 ? argv[1] : NULL,
                        .max_bounces = -1};
    int count = argc > 2 ? (int)strtol(argv[2], NULL, 10) : 1000;
    uint64_t *halts = xcalloc((size_t)count, sizeof *halts);
    uint64_t *workers = xcalloc((size_t)count, sizeof *workers);
    uint64_t *restarts = xcalloc((size_t)count, sizeof *restarts);
    static struct session s;
    struct error err;
    uint64_t random = 1;

    cl_environment_prepare(0);
    if (argc < 2 || !session_open(&s, &o, clock_ns(), &err) ||
        (argc > 3 && !use_device(&s, &err)) ||
        !session_restart(&s, (struct render_limits){0}, &err)) {
        fprintf(stderr, "halts: %s\n", argc < 2 ? "no scene" : err.text);
        return 1;
    }
    while (render_progress(s.engine.render).first_picture_ns == 0)
        usleep(1000); /* the tree is built */
    s.draft_width = 120;
    s.draft_height = 80;
    for (int i = 0; i < count; i++) {
        uint64_t begin;

        random = random * 6364136223846793005u + 1442695040888963407u;
        usleep(1000 + (useconds_t)(random >> 33) % 20000);
        worker_ns(s.engine.backends.cpu);
        begin = clock_ns();
        render_halt(s.engine.render);
        halts[i] = clock_ns() - begin;
        workers[i] = worker_ns(s.engine.backends.cpu);
        begin = clock_ns();
        if (!session_restart(&s, (struct render_limits){0}, &err)) {
            fprintf(stderr, "halts: %s\n", err.text);
            return 1;
        }
        while (render_progress(s.engine.render).first_picture_ns == 0)
            usleep(50);
        restarts[i] = clock_ns() - begin;
    }
    printf("%-24s %8s %8s %8s %8s  ms, %d times\n", argv[1], "p50", "p99",
           "p99.9", "max", count);
    print_row("halt", halts, count);
    print_row("processor in a halt", workers, count);
    print_row("restart to coarse", restarts, count);
    session_close(&s);
    free(halts);
    free(workers);
    free(restarts);
    return 0;
}
