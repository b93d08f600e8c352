// SPDX-License-Identifier: MIT
/*
 * test_direct.c - light samples, BSDF samples and both with MIS have the same
 * mean in every shipped scene, and MIS has the least error; the mean is the
 * same without the guide, where there is one
 */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "base/clock.h"
#include "session/session.h"
#include "tests/unit/check.h"
#include "world/light/sky_table.h"
#include "world/world.h"

static const char *const scenes[] = {
    "scenes/glass_mirror.obj", "scenes/cornell.obj",  "scenes/materials.obj",
    "scenes/skylit.obj",       "scenes/interior.obj", "scenes/lights200.obj",
};

#define WIDTH  48
#define HEIGHT 27
#define SPP    16
#define SEEDS  24
#define MODES  4

/* Follows the values of enum direct: MIS without the guide. */
#define UNGUIDED 3

/* Welch's t with at least 23 degrees of freedom exceeds this in 1e-5 of the
 * cases. There are 6 scenes, 3 channels and at most 3 pairs: one false alarm in
 * 1,850 choices of seeds. The seeds are fixed. */
#define T_LIMIT 5.6

/* Mean and variance over the seeds of a picture's mean, for each channel, and
 * the mean square deviation of its pixels from their mean over the seeds. */
struct outcome {
    double mean[3];
    double variance[3];
    double noise;
};

/* Compensated tables are zero in places, where only BSDF samples find the
 * sky. */
static void fill_sky_table(struct host_world *host)
{
    struct error err;

    if (host->sky_texels == NULL)
        return;
    sky_table_free(&host->sky_table);
    check_or_say(sky_table_build(&host->sky_table, host->sky_texels,
                                 host->sky_width, host->sky_height, SKY_ALONE,
                                 &err),
                 err.text);
}

static void render_seed(struct session *s, int mode, uint32_t seed, float *rgb)
{
    struct render_job job = {.host = &s->engine.world,
                             .crop = {0, 0, WIDTH, HEIGHT},
                             .limits.spp = SPP};
    struct error err;

    check_or_say(world_lend(&s->engine.world, &s->engine.scene,
                            &s->edit.now.view, seed, &job.world, &err),
                 err.text);
    if (mode == UNGUIDED)
        path_guide_lend(&(struct path_guide){.cells = NULL}, &job.world);
    else
        job.world.settings.direct = (uint32_t)mode;
    check_or_say(render_start(s->engine.render, &job, &err), err.text);
    assert_true(render_wait(s->engine.render, 300000));
    assert_int_equal(render_progress(s->engine.render).non_finite, 0);
    film_linear(render_film(s->engine.render), rgb);
}

static void measure(struct session *s, int mode, struct outcome *o)
{
    enum { NUMBERS = 3 * WIDTH * HEIGHT };
    static float rgb[NUMBERS];
    static double sums[NUMBERS], squares[NUMBERS];

    memset(o, 0, sizeof *o);
    memset(sums, 0, sizeof sums);
    memset(squares, 0, sizeof squares);
    for (uint32_t seed = 1; seed <= SEEDS; seed++) {
        double mean[3] = {0, 0, 0};

        render_seed(s, mode, seed, rgb);
        for (int i = 0; i < NUMBERS; i++) {
            double x = (double)rgb[i];

            mean[i % 3] += x / (WIDTH * HEIGHT);
            sums[i] += x;
            squares[i] += x * x;
        }
        for (int c = 0; c < 3; c++) {
            o->mean[c] += mean[c] / SEEDS;
            o->variance[c] += mean[c] * mean[c] / SEEDS;
        }
    }
    for (int c = 0; c < 3; c++) {
        o->variance[c] -= o->mean[c] * o->mean[c];
        o->variance[c] = fmax(o->variance[c], 0) / (SEEDS - 1);
    }
    for (int i = 0; i < NUMBERS; i++)
        o->noise +=
            (squares[i] / SEEDS - sums[i] / SEEDS * sums[i] / SEEDS) / NUMBERS;
}

static void all_techniques_have_the_same_mean(void **state)
{
    (void)state;
    for (size_t i = 0; i < sizeof scenes / sizeof scenes[0]; i++) {
        struct options o = {.scene_path = scenes[i],
                            .max_bounces = -1,
                            .batch = true};
        struct outcome outcomes[MODES];
        struct session s;
        struct error err;
        int modes = UNGUIDED;

        if (!check_is_due(4))
            continue;
        check_or_say(session_open(&s, &o, clock_ns(), &err), err.text);
        s.edit.now.view.width_px = WIDTH;
        s.edit.now.view.height_px = HEIGHT;
        measure(&s, DIRECT_MIS, &outcomes[DIRECT_MIS]);
        measure(&s, DIRECT_BSDF, &outcomes[DIRECT_BSDF]);
        if (path_guide_has_tables(&s.engine.world.guide))
            measure(&s, UNGUIDED, &outcomes[modes++]);
        fill_sky_table(&s.engine.world);
        measure(&s, DIRECT_LIGHTS, &outcomes[DIRECT_LIGHTS]);
        for (int k = DIRECT_LIGHTS; k < modes; k++)
            for (int c = 0; c < 3; c++) {
                const struct outcome *a = &outcomes[DIRECT_MIS];
                const struct outcome *b = &outcomes[k];
                double t = (a->mean[c] - b->mean[c]) /
                           sqrt(a->variance[c] + b->variance[c] + 1e-14);

                if (fabs(t) > T_LIMIT)
                    print_error("%s, channel %d, mode %d: %g and %g\n",
                                scenes[i], c, k, a->mean[c], b->mean[c]);
                check_at_most(fabs(t), T_LIMIT);
            }
        for (int k = DIRECT_LIGHTS; k < modes; k++) {
            print_message("%s: noise %.3g, mode %d %.3g\n", scenes[i],
                          outcomes[DIRECT_MIS].noise, k, outcomes[k].noise);
            check_at_most(outcomes[DIRECT_MIS].noise, 1.1 * outcomes[k].noise);
        }
        session_close(&s);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(all_techniques_have_the_same_mean),
    };

    return cmocka_run_group_tests(tests, NULL, NULL);
}
