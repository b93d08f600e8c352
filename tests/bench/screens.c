// SPDX-License-Identifier: MIT
/*
 * screens - processor time of one thread to convert a film of 1920x1080 pixels
 * to a window of 200x60 cells, by tone curve
 *
 * usage: screens [COUNT]
 */
#include <stdio.h>
#include <stdlib.h>
#include <time.h>

#include "film/film.h"
#include "scene/view.h"
#include "terminal/cells.h"
#include "terminal/xmalloc.h"

#define WIDTH  1920
#define HEIGHT 1080
#define COLS   200
#define ROWS   60
#define SPP    32

static uint64_t cpu_ns(void)
{
    struct timespec t;

    clock_gettime(CLOCK_THREAD_CPUTIME_ID, &t);
    return (uint64_t)t.tv_sec * 1000000000u + (uint64_t)t.tv_nsec;
}

static float random_light(uint32_t *seed)
{
    *seed = *seed * 1664525u + 1013904223u;
    return (float)(*seed >> 8) * (2.0f / (1 << 24));
}

static void fill(struct film *film)
{
    static struct path_sample samples[WIDTH];
    static int counts[WIDTH];
    uint32_t seed = 1;

    for (int i = 0; i < SPP * HEIGHT; i++) {
        for (int x = 0; x < WIDTH; x++) {
            counts[x] = 1;
            samples[x].radiance =
                (struct vec3){random_light(&seed), random_light(&seed),
                              random_light(&seed)};
        }
        film_add_row(film, (struct film_pixels){0, i % HEIGHT, 1, WIDTH},
                     samples, NULL, counts);
    }
}

static int compare(const void *a, const void *b)
{
    uint64_t x = *(const uint64_t *)a, y = *(const uint64_t *)b;

    return x < y ? -1 : x > y;
}

int main(int argc, char **argv)
{
    int count = argc > 1 ? (int)strtol(argv[1], NULL, 10) : 50;
    uint64_t *times_ns = xcalloc((size_t)count + 1, sizeof *times_ns);
    struct frame frame = {0};
    struct film film = {0};
    struct error err;

    if (!film_init(&film, WIDTH, HEIGHT, &err) ||
        !frame_init(&frame, COLS, 2 * ROWS, &err)) {
        fprintf(stderr, "screens: %s\n", err.text);
        return 1;
    }
    fill(&film);
    for (uint32_t tone = 0; tone < TONES; tone++) {
        for (int i = 0; i < count; i++) {
            uint64_t begin_ns = cpu_ns();

            film_preview(&film, NULL, (struct develop){0, tone}, &frame);
            times_ns[i] = cpu_ns() - begin_ns;
        }
        qsort(times_ns, (size_t)count, sizeof *times_ns, compare);
        printf("%-9s least %6.2f ms, p50 %6.2f ms\n", view_tones[tone],
               (double)times_ns[0] * 1e-6, (double)times_ns[count / 2] * 1e-6);
    }
    film_free(&film);
    frame_free(&frame);
    free(times_ns);
    return 0;
}
