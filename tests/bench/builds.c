// SPDX-License-Identifier: MIT
/*
 * builds - samples per second of processor time in whole renders, and the gain
 * of the build of cpu_kernel.c for the scene's features over the build for all;
 * rounds are interleaved
 *
 * usage: builds SCENE...
 *        builds --once own|whole SCENE
 *
 * --once renders one small picture, for a counter of instructions, and prints
 * its number of samples.
 */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "base/clock.h"
#include "session/session.h"
#include "tests/bench/median.h"
#include "tests/bench/render_crop.h"

#define ROUNDS 5
#define WIDTH  480
#define HEIGHT 270
#define SPP    4

/* Samples of a small picture are taken in blocks of eight, like most of a long
 * render. */
#define SMALL_SPP    64
#define SMALL_WIDTH  24
#define SMALL_HEIGHT 12

static _Noreturn void stop(const struct error *err)
{
    fprintf(stderr, "builds: %s\n", err->text);
    exit(1);
}

/* Processor time of all workers, which other programs hardly disturb. */
static uint64_t cpu_ns(const struct session *s)
{
    const struct backend *b = render_backend(s->engine.render);
    uint64_t sum_ns = 0;

    for (int i = 0; i < b->thread_count; i++)
        sum_ns += b->cpu_ns(b, i);
    return sum_ns;
}

/* Returns millions of samples per second. *p is the progress of the previous
 * picture, 0 before the first, which builds the tree. More features
 * select the build for all of them; samples are of light and do not use those.
 */
static double rate(struct session *s, uint64_t more_features, struct rect crop,
                   uint64_t spp, struct render_progress *p)
{
    uint64_t begin_ns = cpu_ns(s);
    struct error err;

    if (!render_crop(s, crop, spp, 0, more_features, &err))
        stop(&err);
    *p = render_progress(s->engine.render);
    return (double)p->samples * 1e3 / (double)(cpu_ns(s) - begin_ns);
}

static void open_scene(struct session *s, const char *path)
{
    struct options o = {.scene_path = path,
                        .max_bounces = -1,
                        .width_px = WIDTH,
                        .height_px = HEIGHT};
    struct error err;

    if (!session_open(s, &o, clock_ns(), &err))
        stop(&err);
}

static void bench(const char *path)
{
    const struct rect crop = {0, 0, WIDTH, HEIGHT};
    double whole[ROUNDS], fit[ROUNDS];
    struct render_progress p = {0};
    struct session s;

    open_scene(&s, path);
    rate(&s, 0, crop, SPP, &p); /* loads code and data */
    for (int i = 0; i < ROUNDS; i++) {
        whole[i] = rate(&s, FEATURE_AOV, crop, SPP, &p);
        fit[i] = rate(&s, 0, crop, SPP, &p);
    }
    double all = median(whole, ROUNDS), own = median(fit, ROUNDS);
    printf("%-50s %9.3f %7.2f %9.2f %9.3f\n", path, own,
           own * (double)p.rays / (double)p.samples,
           (double)p.rays / (double)p.samples, own / all);
    session_close(&s);
}

static void once(const char *build, const char *path)
{
    const struct rect crop = {WIDTH / 2, HEIGHT / 2, SMALL_WIDTH, SMALL_HEIGHT};
    struct render_progress p = {0};
    struct session s;

    open_scene(&s, path);
    rate(&s, strcmp(build, "whole") == 0 ? FEATURE_AOV : 0, crop, SMALL_SPP,
         &p);
    printf("%llu\n", (unsigned long long)p.samples);
    session_close(&s);
}

int main(int argc, char **argv)
{
    if (argc == 4 && strcmp(argv[1], "--once") == 0) {
        once(argv[2], argv[3]);
        return 0;
    }
    printf("%-50s %9s %7s %9s %9s\n", "scene", "Msampl/s", "Mrays/s",
           "rays/path", "own/whole");
    for (int i = 1; i < argc; i++)
        bench(argv[i]);
    return 0;
}
