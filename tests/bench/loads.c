// SPDX-License-Identifier: MIT
/*
 * loads - seconds to load scene files, before the tree is built
 *
 * usage: loads SCENE...
 *
 * The file is in the page cache. Medians of ROUNDS loads, with two
 * threads.
 */
#include <stdio.h>
#include <stdlib.h>
#include <sys/stat.h>

#include "base/clock.h"
#include "base/memory.h"
#include "engine/scene_load.h"
#include "tests/bench/median.h"

#define ROUNDS  7
#define THREADS 2

/* Returns the seconds of one load. */
static double load(const char *path, uint32_t *tri_count)
{
    struct scene scene = {.thread_count = THREADS};
    struct warnings report = {0};
    struct error err;
    uint64_t begin_ns = clock_ns();
    double seconds;

    if (!scene_load(&scene, path, SCENE_UP_OF_FILE, &report, &err)) {
        fprintf(stderr, "loads: %s\n", err.text);
        exit(1);
    }
    seconds = (double)(clock_ns() - begin_ns) * 1e-9;
    *tri_count = scene.tri_count;
    warnings_free(&report);
    scene_free(&scene);
    return seconds;
}

int main(int argc, char **argv)
{
    memory_init();
    printf("%-32s %9s %7s %9s %7s\n", "file", "triangles", "MB", "seconds",
           "MB/s");
    for (int i = 1; i < argc; i++) {
        double seconds[ROUNDS], megabytes;
        uint32_t tri_count = 0;
        struct stat st;

        for (int k = 0; k < ROUNDS; k++)
            seconds[k] = load(argv[i], &tri_count);
        megabytes = stat(argv[i], &st) == 0 ? (double)st.st_size * 1e-6 : 0;
        printf("%-32s %9u %7.1f %9.3f %7.0f\n", argv[i], tri_count, megabytes,
               median(seconds, ROUNDS), megabytes / median(seconds, ROUNDS));
    }
    return 0;
}
