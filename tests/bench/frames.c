// SPDX-License-Identifier: MIT
/*
 * frames - samples per pixel in a frame of 1/60 s, by size of the picture and
 * bounces, and the error of such a picture: whole pictures, from the restart
 * until the last sample is in the film
 *
 * Counts are powers of two; "-" means that not one fits. The error, the root of
 * the relative MSE in percent, is that against all light: the noise and the
 * light that more bounces would bring. It is measured in a small picture, since
 * it does not depend on the size.
 *
 * usage: frames SCENE...
 */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "base/clock.h"
#include "command/difference.h"
#include "session/session.h"

#define FRAME_NS  (1000000000u / 60)
#define ROUNDS    9
#define SPP_MAX   256
#define UNLIMITED 999

/* The picture whose error is measured, and the samples of its reference. */
#define SMALL_WIDTH    100
#define SMALL_HEIGHT   60
#define REFERENCE_SPP  4096
#define REFERENCE_SEED 1000

/* Text windows of 80x24 and 200x60 cells with half blocks, then screens. */
static const struct {
    int width, height;
} sizes[] = {{80, 48}, {200, 120}, {320, 180}, {640, 360}, {1280, 720}};

static const int depths[] = {0, 1, 2, 4, 8, UNLIMITED};

#define COUNT(array) (sizeof(array) / sizeof(array)[0])

/* Counts 1, 2, 4 ... SPP_MAX. */
#define COUNTS_MAX 9

static void open_scene(struct session *s, const char *path, int width,
                       int height, int bounces, uint32_t seed)
{
    struct options o = {.scene_path = path,
                        .width_px = width,
                        .height_px = height,
                        .seed = seed,
                        .max_bounces = bounces,
                        .has_max_bounces = true};
    struct error err;

    if (!session_open(s, &o, clock_ns(), &err)) {
        fprintf(stderr, "frames: %s\n", err.text);
        exit(1);
    }
}

static uint64_t picture_ns(struct session *s, uint64_t spp)
{
    uint64_t begin_ns = clock_ns();
    struct error err;

    if (!session_restart(s, (struct render_limits){.spp = spp}, &err)) {
        fprintf(stderr, "frames: %s\n", err.text);
        exit(1);
    }
    render_wait(s->engine.render, -1);
    return clock_ns() - begin_ns;
}

/* Returns whether the fastest of some pictures fits. Other programs can only
 * slow a picture down, and hardly by a factor of two. */
static bool fits(struct session *s, uint64_t spp)
{
    for (int i = 0; i < ROUNDS; i++) {
        uint64_t time_ns = picture_ns(s, spp);

        if (time_ns <= FRAME_NS)
            return true;
        if (time_ns > 2 * FRAME_NS)
            return false;
    }
    return false;
}

/* Returns 0 if not one sample fits. */
static uint64_t spp_that_fits(const char *path, int width, int height,
                              int bounces)
{
    static struct session s;
    uint64_t spp = 1;

    open_scene(&s, path, width, height, bounces, 0);
    picture_ns(&s, 1); /* builds the tree */
    while (spp <= SPP_MAX && fits(&s, spp))
        spp *= 2;
    session_close(&s);
    return spp / 2;
}

static void small_picture(const char *path, int bounces, uint64_t spp,
                          uint32_t seed, float *rgb)
{
    static struct session s;

    open_scene(&s, path, SMALL_WIDTH, SMALL_HEIGHT, bounces, seed);
    picture_ns(&s, spp);
    film_linear(render_film(s.engine.render), rgb);
    session_close(&s);
}

/* Returns the error of a picture of the scene of the last call with spp 0,
 * which renders the reference. */
static double error_percent(const char *path, size_t depth, uint64_t spp)
{
    static float reference[3 * SMALL_WIDTH * SMALL_HEIGHT];
    static float rgb[3 * SMALL_WIDTH * SMALL_HEIGHT];
    static double known[COUNT(depths)][COUNTS_MAX];
    struct picture_pair pair = {SMALL_WIDTH, SMALL_HEIGHT, rgb, reference};
    double *error;

    if (spp == 0) {
        memset(known, 0, sizeof known);
        small_picture(path, UNLIMITED, REFERENCE_SPP, REFERENCE_SEED,
                      reference);
        return 0;
    }
    error = &known[depth][(int)log2((double)spp)];
    if (*error == 0) {
        small_picture(path, depths[depth], spp, 0, rgb);
        *error = 100 * sqrt(picture_error_of(&pair).relmse);
    }
    return *error;
}

static void print_table(const char *path)
{
    uint64_t last[COUNT(depths)];

    error_percent(path, 0, 0);
    printf("%-26s bounces:", path);
    for (size_t d = 0; d < COUNT(depths); d++)
        if (depths[d] == UNLIMITED)
            printf("%11s", "any");
        else
            printf("%11d", depths[d]);
    for (size_t i = 0; i < COUNT(sizes); i++) {
        printf("\n%26dx%-7d ", sizes[i].width, sizes[i].height);
        for (size_t d = 0; d < COUNT(depths); d++) {
            uint64_t spp = 0;

            /* A larger picture or more bounces fit only if fewer do. */
            if ((i == 0 || last[d] > 0) && (d == 0 || last[d - 1] > 0))
                spp = spp_that_fits(path, sizes[i].width, sizes[i].height,
                                    depths[d]);
            last[d] = spp;

            if (spp == 0)
                printf("%11s", "-");
            else
                printf("%5d %3.0f %%", (int)spp, error_percent(path, d, spp));
            fflush(stdout);
        }
    }
    printf("\n");
}

int main(int argc, char **argv)
{
    for (int i = 1; i < argc; i++)
        print_table(argv[i]);
    return 0;
}
