// SPDX-License-Identifier: MIT
/*
 * device - samples per second of the OpenCL device and of the CPU's threads,
 * and the gain of kernels without unneeded features; rounds are interleaved
 *
 * usage: device THREADS SCENE...
 */
#include <stdio.h>
#include <stdlib.h>

#include "base/clock.h"
#include "render/opencl/backend_cl.h"
#include "render/opencl/cl_api.h"
#include "session/session.h"
#include "tests/bench/median.h"

#define ROUNDS 5
#define SPP    4

enum contestant { CPU, FULL, SPECIAL, CONTESTANTS };

/* Returns millions of samples per second. */
static double rate(struct session *s, struct backend *backend)
{
    struct render_progress p;
    struct error err;

    render_set_backend(s->engine.render, backend);
    if (!session_restart(s, (struct render_limits){.spp = SPP}, &err)) {
        fprintf(stderr, "device: %s\n", err.text);
        exit(1);
    }
    render_wait(s->engine.render, -1);
    p = render_progress(s->engine.render);
    return (double)p.samples * 1e3 / (double)(p.render_ns - p.build_ns);
}

static struct backend *open_device(uint64_t features)
{
    struct cl_request request = {.features = features};
    struct error err;
    char *log;
    struct backend *b = backend_cl_create(&request, &log, &err);

    if (b == NULL) {
        fprintf(stderr, "device: %s\n", err.text);
        exit(1);
    }
    return b;
}

static void bench(const char *path, int threads)
{
    struct options o = {.scene_path = path,
                        .thread_count = threads,
                        .max_bounces = -1,
                        .width_px = 480,
                        .height_px = 270};
    double rates[CONTESTANTS][ROUNDS];
    struct backend *backends[CONTESTANTS];
    struct session s;
    struct error err;

    if (!session_open(&s, &o, clock_ns(), &err)) {
        fprintf(stderr, "device: %s\n", err.text);
        exit(1);
    }
    backends[CPU] = s.engine.backends.cpu;
    backends[FULL] = open_device(FEATURES_ALL);
    backends[SPECIAL] = open_device(world_features(&s.engine.world));
    for (int i = 0; i < CONTESTANTS; i++)
        rate(&s, backends[i]); /* loads code and data */
    for (int i = 0; i < ROUNDS; i++)
        for (int k = 0; k < CONTESTANTS; k++)
            rates[k][i] = rate(&s, backends[k]);
    double cpu = median(rates[CPU], ROUNDS);
    double full = median(rates[FULL], ROUNDS);
    printf("%-28s %7.3f %7.3f %7.2f %9.2f\n", path, cpu, full, full / cpu,
           median(rates[SPECIAL], ROUNDS) / full);
    render_set_backend(s.engine.render, backends[CPU]);
    backends[FULL]->destroy(backends[FULL]);
    backends[SPECIAL]->destroy(backends[SPECIAL]);
    session_close(&s);
}

int main(int argc, char **argv)
{
    int threads = argc > 1 ? (int)strtol(argv[1], NULL, 10) : 0;

    cl_environment_prepare(threads);
    printf("%d threads %17s %7s %7s %7s %9s\n", threads, "Msamples/s:", "CPU",
           "OpenCL", "ratio", "special");
    for (int i = 2; i < argc; i++)
        bench(argv[i], threads);
    return 0;
}
