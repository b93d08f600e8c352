// SPDX-License-Identifier: MIT
/*
 * frames - samples per pixel in a frame of 1/60 s, by size of the picture and
 * bounces: whole pictures, from the restart until the last sample is in the
 * film
 *
 * Counts are powers of two; "-" means that not one fits.
 *
 * usage: frames SCENE...
 */
#include <stdio.h>
#include <stdlib.h>

#include "base/clock.h"

#include "session/session.h"

#define FRAME_NS  (1000000000u / 60)
#define ROUNDS    9
#define SPP_MOST  256
#define UNLIMITED 999

/* Text windows of 80x24 and 200x60 cells with half blocks, then screens. */
static const struct {
    int width, height;
} sizes[] = {{80, 48}, {200, 120}, {320, 180}, {640, 360}, {1280, 720}};

static const int depths[] = {0, 1, 2, 4, 8, UNLIMITED};

#define COUNT(array) (sizeof(array) / sizeof(array)[0])

static uint64_t picture_ns(struct session *s, uint64_t spp)
{
    uint64_t begin_ns = clock_ns();
    struct error err;

    if (!session_restart(s, (struct render_limits){.spp = spp}, &err)) {
        fprintf(stderr, "frames: %s\n", err.text);
        exit(1);
    }
    render_wait(s->render, -1);
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
    struct options o = {.scene_path = path,
                        .width_px = width,
                        .height_px = height,
                        .max_bounces = bounces,
                        .has_max_bounces = true};
    static struct session s;
    struct error err;
    uint64_t spp = 1;

    if (!session_open(&s, &o, clock_ns(), &err)) {
        fprintf(stderr, "frames: %s\n", err.text);
        exit(1);
    }
    picture_ns(&s, 1); /* builds the tree */
    while (spp <= SPP_MOST && fits(&s, spp))
        spp *= 2;
    session_close(&s);
    return spp / 2;
}

static void print_table(const char *path)
{
    uint64_t last[COUNT(depths)];

    printf("%-26s bounces:", path);
    for (size_t d = 0; d < COUNT(depths); d++)
        if (depths[d] == UNLIMITED)
            printf("%6s", "any");
        else
            printf("%6d", depths[d]);
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
                printf("%6s", "-");
            else
                printf("%6d", (int)spp);
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
