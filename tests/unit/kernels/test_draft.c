// SPDX-License-Identifier: MIT
/*
 * test_draft.c - the draft before a film: its pixels, its mean, and that it
 * does not affect the film
 */
#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>

#include "tests/unit/check.h"
#include "tests/unit/mesh.h"

#include "base/clock.h"
#include "session/session.h"
#include "world/world.h"
#include "kernels/camera.h"
#include "kernels/rng.h"

#define SIDE   48
#define PIXELS (SIDE * SIDE)

static struct session session;
static struct world box;

static int open_scene(void **state)
{
    static struct options options = {.scene_path = "scenes/cornell.obj",
                                     .width_px = SIDE,
                                     .height_px = SIDE,
                                     .max_bounces = -1,
                                     .thread_count = 2};
    struct error err;

    (void)state;
    if (session_open(&session, &options, clock_ns(), &err) &&
        world_lend(&session.engine.world, &session.engine.scene,
                   &session.edit.now.view, 0, &box, &err))
        return 0;
    print_error("%s\n", err.text);
    return -1;
}

static int close_scene(void **state)
{
    (void)state;
    session_close(&session);
    return 0;
}

static void start(struct host_world *host, const struct world *world,
                  uint64_t spp, int draft_width, int draft_height,
                  uint32_t seed)
{
    struct render_job job = {.world = *world,
                             .host = host,
                             .crop = {0, 0, SIDE, SIDE},
                             .limits.spp = spp,
                             .draft_width = draft_width,
                             .draft_height = draft_height};
    struct error err;

    job.world.settings.seed = seed;
    check_or_say(render_start(session.engine.render, &job, &err), err.text);
}

/* Renders a draft for the filter. */
static void start_draft_for_filter(uint32_t seed)
{
    struct render_job job = {.world = box,
                             .host = &session.engine.world,
                             .crop = {0, 0, SIDE, SIDE},
                             .limits.spp = 1,
                             .draft_width = SIDE,
                             .draft_height = SIDE,
                             .draft_has_surfaces = true};
    struct error err;

    job.world.settings.seed = seed;
    check_or_say(render_start(session.engine.render, &job, &err), err.text);
    assert_true(render_wait(session.engine.render, 60000));
}

/* Renders to the end and returns the film's sums and counts. */
static void finish(struct sum sums[3 * PIXELS], uint64_t counts[PIXELS])
{
    struct film *film = render_film(session.engine.render);

    assert_true(render_wait(session.engine.render, 60000));
    assert_int_equal(render_progress(session.engine.render).state, RENDER_DONE);
    memcpy(sums, film->sums, 3 * PIXELS * sizeof *sums);
    memcpy(counts, film->counts, PIXELS * sizeof *counts);
}

/* Starts a picture with a draft and halts it when the draft has begun and the
 * film has not. The machine may be too slow for that at first. */
static void halt_in_the_draft(void)
{
    struct render_progress p;
    int tries = 0;

    do {
        assert_true(tries++ < 10000);
        start(&session.engine.world, &box, 30, 31, 40, 1);
        assert_non_null(render_draft(session.engine.render));
        do
            p = render_progress(session.engine.render);
        while (p.draft_samples == 0 && p.state == RENDER_RUNNING);
        render_halt(session.engine.render);
        p = render_progress(session.engine.render);
    } while (p.samples > 0 || p.draft_samples == DRAFT_SPP * 31 * 40);
    render_resume(session.engine.render, (struct render_limits){.spp = 30});
}

/* With and without a draft, and halted at any moment of either, a film has the
 * same bits and counts. */
static void films_do_not_depend_on_drafts(void **state)
{
    static struct sum sums[2][3 * PIXELS];
    static uint64_t counts[2][PIXELS];
    struct render_progress p[2];
    struct timespec pause = {0, 0};

    (void)state;
    start(&session.engine.world, &box, 30, 0, 0, 1);
    assert_null(render_draft(session.engine.render));
    finish(sums[0], counts[0]);
    p[0] = render_progress(session.engine.render);
    halt_in_the_draft();
    for (int halts = 0; !render_wait(session.engine.render, 0); halts++) {
        nanosleep(&pause, NULL);
        pause.tv_nsec = halts % 20 * 50000;
        render_halt(session.engine.render);
        render_resume(session.engine.render, (struct render_limits){.spp = 30});
    }
    finish(sums[1], counts[1]);
    p[1] = render_progress(session.engine.render);
    assert_memory_equal(counts[0], counts[1], sizeof counts[0]);
    assert_memory_equal(sums[0], sums[1], sizeof sums[0]);
    assert_int_equal(p[1].samples, 30 * PIXELS);
    assert_int_equal(p[1].rays, p[0].rays);
    assert_int_equal(p[1].draft_samples, DRAFT_SPP * 31 * 40);
    assert_null(
        render_draft(session.engine.render)); /* the film has enough samples */
}

/* A draft has at most as many pixels as the film, and as its order supports. */
static void drafts_are_small(void **state)
{
    (void)state;
    start(&session.engine.world, &box, 1, SIDE + 1, 1 << 20, 1);
    assert_int_equal(render_draft(session.engine.render)->width, SIDE);
    assert_int_equal(render_draft(session.engine.render)->height, SIDE);
    start(&session.engine.world, &box, 1, 5, 0, 1);
    assert_null(render_draft(session.engine.render));
    assert_true(render_wait(session.engine.render, 60000));
    assert_int_equal(render_progress(session.engine.render).draft_samples, 0);
}

/* A backend that records its calls of begin. */
struct notes {
    struct backend base;
    struct world worlds[2];
    int x0[2], y0[2];
    int begin_count;
};

static bool note_load(struct backend *b, struct host_world *host,
                      struct world *world, struct error *err)
{
    (void)b, (void)host, (void)world, (void)err;
    return true;
}

static bool note_begin(struct backend *b, const struct backend_picture *p,
                       struct error *err)
{
    struct notes *n = (struct notes *)b;
    int i = n->begin_count++;

    (void)err;
    assert_in_range(i, 0, 1);
    n->worlds[i] = *p->world;
    n->x0[i] = p->x0;
    n->y0[i] = p->y0;
    return true;
}

static enum pass_result note_pass(struct backend *b, const struct pass *pass,
                                  const struct cancel *cancel,
                                  struct error *err)
{
    (void)b, (void)pass, (void)cancel, (void)err;
    return PASS_DONE;
}

static void check_same_direction(struct vec3 a, struct vec3 b)
{
    check_close((double)a.x, (double)b.x, 2e-6);
    check_close((double)a.y, (double)b.y, 2e-6);
    check_close((double)a.z, (double)b.z, 2e-6);
}

/* The corners and the middle of a draft's pixel are those of the same part of
 * the crop. */
static void drafts_show_the_same_part_as_films(void **state)
{
    struct notes n = {
        .base = {.load = note_load, .begin = note_begin, .pass = note_pass}};
    struct camera camera = {.eye = {1, 2, 3},
                            .width = 640,
                            .forward = {0, 0, -1},
                            .height = 360,
                            .right = {1.1f, 0, 0},
                            .lens_radius = 0.1f,
                            .up = {0, 0.62f, 0},
                            .focus = 4};
    struct host_world host = {.versions = {0}};
    struct render_job job = {.host = &host,
                             .world.settings.camera = camera,
                             .crop = {201, 33, 290, 130},
                             .limits.spp = 1,
                             .draft_width = 77,
                             .draft_height = 41};
    struct error err;
    struct render *r = render_create(&n.base, &err);

    (void)state;
    assert_non_null(r);
    assert_true(render_start(r, &job, &err));
    assert_true(render_wait(r, 10000));
    assert_int_equal(n.begin_count, 2);
    assert_int_equal(n.worlds[0].settings.order, ORDER_DRAFT);
    assert_int_equal(n.worlds[1].settings.order, ORDER_PROGRESSIVE);
    assert_memory_equal(&n.worlds[1].settings.camera, &camera, sizeof camera);
    for (int i = 0; i < 77 * 41; i++)
        for (int k = 0; k < 3; k++) {
            struct vec2 at = {0.5f * (float)k, 0.5f * (float)k};
            float x = ((float)(i % 77) + at.x) / 77 * 290;
            float y = ((float)(i / 77) + at.y) / 41 * 130;
            struct camera c = n.worlds[0].settings.camera;
            struct ray draft = camera_ray(c, (uint32_t)(n.x0[0] + i % 77),
                                          (uint32_t)(n.y0[0] + i / 77), at);
            struct ray film = camera_ray(camera, (uint32_t)(n.x0[1] + (int)x),
                                         (uint32_t)(n.y0[1] + (int)y),
                                         v2(x - floorf(x), y - floorf(y)));

            check_same_direction(draft.d, film.d);
            at = v2(0.2f, 0.9f);
            check_same_direction(camera_through_lens(c, draft, at).d,
                                 camera_through_lens(camera, film, at).d);
        }
    render_destroy(r);
}

/* Renders a draft and a film of the same size and samples, linear. */
static void render_two(struct host_world *host, const struct world *world,
                       uint32_t seed, float draft[3 * PIXELS],
                       float film[3 * PIXELS])
{
    start(host, world, DRAFT_SPP, SIDE, SIDE, seed);
    assert_true(render_wait(session.engine.render, 60000));
    film_linear(render_draft(session.engine.render), draft);
    film_linear(render_film(session.engine.render), film);
}

/* Returns the mean of a channel over a quarter of a picture. */
static double quarter_mean(const float *rgb, int quarter, int channel)
{
    double sum = 0;

    for (int i = 0; i < PIXELS / 4; i++) {
        int x = i % (SIDE / 2) + quarter % 2 * (SIDE / 2);
        int y = i / (SIDE / 2) + quarter / 2 * (SIDE / 2);

        sum += (double)rgb[3 * (y * SIDE + x) + channel];
    }
    return sum / (PIXELS / 4);
}

/* Over 40 seeds, for each quarter and channel: Student's t with 39 degrees of
 * freedom exceeds 5.9 once in a million, and there are 12 values. */
static void drafts_have_the_films_mean(void **state)
{
    static float draft[3 * PIXELS], film[3 * PIXELS];
    double sums[12] = {0}, squares[12] = {0};
    const int n = 40;

    (void)state;
    for (int seed = 0; seed < n; seed++) {
        render_two(&session.engine.world, &box, (uint32_t)seed, draft, film);
        for (int i = 0; i < 12; i++) {
            double d = quarter_mean(draft, i % 4, i / 4) -
                       quarter_mean(film, i % 4, i / 4);

            sums[i] += d;
            squares[i] += d * d;
        }
    }
    for (int i = 0; i < 12; i++) {
        double mean = sums[i] / n;
        double variance = (squares[i] / n - mean * mean) / (n - 1);

        assert_true(variance > 0);
        check_at_most(fabs(mean) / sqrt(variance), 5.9);
    }
}

#define BLUR_RADIUS 5
#define BLUR_SIGMA  1.5

/* Sums of squares over the pixels of a picture, away from its border. */
struct errors {
    double plain, blurred;
};

static void add_errors(struct errors *e, const float *rgb, const float *truth)
{
    const int r = BLUR_RADIUS;

    for (int y = r; y < SIDE - r; y++)
        for (int x = r; x < SIDE - r; x++) {
            double sum = 0, weights = 0;

            for (int k = 0; k < (2 * r + 1) * (2 * r + 1); k++) {
                int dx = k % (2 * r + 1) - r, dy = k / (2 * r + 1) - r;
                size_t at = 3 * (size_t)((y + dy) * SIDE + x + dx);
                double d = (double)rgb[at] - (double)truth[at];
                double weight =
                    exp(-(dx * dx + dy * dy) / (2 * BLUR_SIGMA * BLUR_SIGMA));

                sum += weight * d;
                weights += weight;
                e->plain += dx == 0 && dy == 0 ? d * d : 0;
            }
            e->blurred += sum / weights * (sum / weights);
        }
}

/* Makes a floor and a lamp above it, which only BSDF samples find. */
static void make_floor(struct mesh *m)
{
    memset(m, 0, sizeof *m);
    m->materials[0] = mesh_material(MATERIAL_DIFFUSE, 0.7f);
    m->materials[1] = mesh_material(MATERIAL_DIFFUSE, 0.0f);
    m->materials[1].emission = v3(9, 9, 9);
    mesh_add_quad(m, v3(-9, 0, -9), v3(-9, 0, 9), v3(9, 0, 9), v3(9, 0, -9), 0);
    mesh_add_quad(m, v3(-1, 1.5f, -1), v3(1, 1.5f, -1), v3(1, 1.5f, 1),
                  v3(-1, 1.5f, 1), 1);
    m->world.settings.camera = (struct camera){.eye = {0, 1, 0},
                                               .width = SIDE,
                                               .forward = {0, -1, 0},
                                               .height = SIDE,
                                               .right = {1, 0, 0},
                                               .up = {0, 0, -1}};
    mesh_finish(m);
}

/* Compares with a film of 100 times as many samples. After a blur the draft has
 * half the error of a film with as many samples (.6 is allowed; independent
 * pixels have 1). Without a blur the errors are equal. */
static void blurred_drafts_have_less_error(void **state)
{
    static float draft[3 * PIXELS], film[3 * PIXELS], truth[3 * PIXELS];
    struct errors of_draft = {0, 0}, of_film = {0, 0};
    struct mesh m;

    (void)state;
    make_floor(&m);
    start(&m.host, &m.world, 500, 0, 0, 12345);
    assert_true(render_wait(session.engine.render, 60000));
    film_linear(render_film(session.engine.render), truth);
    for (uint32_t seed = 0; seed < 20; seed++) {
        render_two(&m.host, &m.world, seed, draft, film);
        add_errors(&of_draft, draft, truth);
        add_errors(&of_film, film, truth);
    }
    mesh_free(&m);
    check_close(of_draft.plain, of_film.plain, 0.15 * of_film.plain);
    check_at_most(of_draft.blurred, 0.6 * of_film.blurred);
}

/* In a draft for the filter the halves of a pixel are independent: over seeds,
 * the products of their errors have mean 0. The errors of pixels depend on each
 * other, so each seed gives one number, the mean over its pixels. Student's t
 * with 39 degrees of freedom exceeds 5.9 once in a million. */
static void halves_of_drafts_are_independent(void **state)
{
    static double halves[40][2][PIXELS], means[2][PIXELS];
    const int n = 40;
    double sum = 0, squares = 0;

    (void)state;
    for (int k = 0; k < n; k++) {
        struct film *f;

        start_draft_for_filter((uint32_t)k);
        f = render_surfaces(session.engine.render);
        assert_non_null(f);
        for (int i = 0; i < PIXELS; i++) {
            double odd = (double)sum_float(f->odd_sums[3 * i]);
            double all = (double)sum_float(f->sums[3 * i]);

            assert_int_equal(f->counts[i], DRAFT_HALVES_SPP);
            halves[k][0][i] = (all - odd) / (DRAFT_HALVES_SPP / 2);
            halves[k][1][i] = odd / (DRAFT_HALVES_SPP / 2);
            for (int h = 0; h < 2; h++)
                means[h][i] += halves[k][h][i] / n;
        }
    }
    for (int k = 0; k < n; k++) {
        double product = 0;

        for (int i = 0; i < PIXELS; i++)
            product += (halves[k][0][i] - means[0][i]) *
                       (halves[k][1][i] - means[1][i]) / PIXELS;
        sum += product;
        squares += product * product;
    }
    sum /= n;
    squares = (squares / n - sum * sum) / (n - 1);
    check_at_most(fabs(sum) / sqrt(squares), 5.9);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(films_do_not_depend_on_drafts),
        cmocka_unit_test(drafts_are_small),
        cmocka_unit_test(drafts_show_the_same_part_as_films),
        cmocka_unit_test(drafts_have_the_films_mean),
        cmocka_unit_test(blurred_drafts_have_less_error),
        cmocka_unit_test(halves_of_drafts_are_independent),
    };

    return cmocka_run_group_tests(tests, open_scene, close_scene);
}
