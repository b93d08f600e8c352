// SPDX-License-Identifier: MIT
/*
 * builds - samples a second of processor time in whole renders, and what the
 * build of paths.c for the scene's features brings beside the one for all;
 * rounds are interleaved
 *
 * usage: builds SCENE...
 */
#include <stdio.h>
#include <stdlib.h>

#include "glim/scene_world.h"
#include "glim/isa.h"
#include "glim/session.h"
#include "tests/bench/median.h"

#define ROUNDS 5
#define WIDTH  480
#define HEIGHT 270
#define SPP    4

/* Of all workers together: what other programs leave of the machine does not
 * matter to it. */
static uint64_t cpu_ns(const struct session *s)
{
    const struct backend *b = render_backend(s->render);
    uint64_t sum_ns = 0;

    for (int i = 0; i < b->thread_count; i++)
        sum_ns += b->cpu_ns(b, i);
    return sum_ns;
}

/* Millions of samples a second; *p is the last picture's progress, 0 before the
 * first, which builds the tree. Features that no scene has choose the build for
 * all: samples are light, and leave what they do not need alone. */
static double rate(struct session *s, uint32_t more_features,
                   struct render_progress *p)
{
    struct render_job job = {.geometry_changed = p->samples == 0,
                             .crop = {0, 0, WIDTH, HEIGHT},
                             .spp = SPP};
    uint64_t begin_ns = cpu_ns(s);
    struct error err;

    if (!scene_world(&s->scene, &s->view, 0, &job.world, &err)) {
        fprintf(stderr, "builds: %s\n", err.text);
        exit(1);
    }
    job.world.settings.features |= more_features;
    if (!render_start(s->render, &job, &err)) {
        fprintf(stderr, "builds: %s\n", err.text);
        exit(1);
    }
    render_wait(s->render, -1);
    *p = render_progress(s->render);
    return (double)p->samples * 1e3 / (double)(cpu_ns(s) - begin_ns);
}

static void bench(const char *path)
{
    struct options o = {.scene_path = path,
                        .max_bounces = -1,
                        .width_px = WIDTH,
                        .height_px = HEIGHT};
    double whole[ROUNDS], fit[ROUNDS];
    struct render_progress p = {0};
    struct session s;
    struct error err;

    if (!session_open(&s, &o, clock_ns(), &err)) {
        fprintf(stderr, "builds: %s\n", err.text);
        exit(1);
    }
    rate(&s, 0, &p); /* loads code and data */
    for (int i = 0; i < ROUNDS; i++) {
        whole[i] = rate(&s, FEATURE_FIRST_HIT, &p);
        fit[i] = rate(&s, 0, &p);
    }
    double all = median(whole, ROUNDS), own = median(fit, ROUNDS);
    printf("%-50s %9.3f %7.2f %9.2f %9.3f\n", path, own,
           own * (double)p.rays / (double)p.samples,
           (double)p.rays / (double)p.samples, own / all);
    session_close(&s);
}

int main(int argc, char **argv)
{
    printf("%-50s %9s %7s %9s %9s\n", "scene", "Msampl/s", "Mrays/s",
           "rays/path", "own/whole");
    for (int i = 1; i < argc; i++)
        bench(argv[i]);
    return 0;
}
