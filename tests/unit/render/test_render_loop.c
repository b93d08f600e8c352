// SPDX-License-Identifier: MIT
#include "tests/unit/check.h"
#include "tests/unit/mesh.h"

#include <fenv.h>
#include <math.h>
#include <poll.h>
#include <sched.h>
#include <string.h>
#include <unistd.h>
#ifdef __SSE2__
#include <immintrin.h>
#endif

#include "render/cpu_dispatch.h"
#include "render/render_loop.h"

#define WIDTH  70 /* not a multiple of a block */
#define HEIGHT 43

/* Makes a room with a lamp and a glass ball. */
static void make_room(struct mesh *m)
{
    memset(m, 0, sizeof *m);
    m->materials[0] = mesh_material(MATERIAL_DIFFUSE, 0.7f);
    m->materials[1] = mesh_material(MATERIAL_DIFFUSE, 0.0f);
    m->materials[1].emission = v3(9, 8, 7);
    m->materials[2] = mesh_material(MATERIAL_GLASS, 1.0f);
    mesh_add_box(m, v3(-1, -1, -1), v3(1, 1, 1), 0);
    mesh_add_quad(m, v3(-0.4f, 0.99f, -0.4f), v3(0.4f, 0.99f, -0.4f),
                  v3(0.4f, 0.99f, 0.4f), v3(-0.4f, 0.99f, 0.4f), 1);
    mesh_add_sphere(m, v3(0, -0.5f, 0), 0.4f, 12, 20, 2);
    m->world.settings.camera = (struct camera){.eye = {0, 0, 0.95f},
                                               .width = WIDTH,
                                               .forward = {0, 0, -1},
                                               .height = HEIGHT,
                                               .right = {0.8f, 0, 0},
                                               .up = {0, 0.5f, 0}};
    mesh_finish(m);
}

static struct render *open_render_with(const struct cpu_kernel *paths,
                                       int threads)
{
    struct error err;
    struct backend *backend = backend_cpu_create(threads, paths, &err);
    struct render *r;

    assert_non_null(backend);
    r = render_create(backend, &err);
    assert_non_null(r);
    return r;
}

static struct render *open_render(int threads)
{
    return open_render_with(cpu_kernel_best(), threads);
}

static void close_render(struct render *r)
{
    struct backend *backend = render_backend(r);

    render_destroy(r);
    backend->destroy(backend);
}

static struct render_job job_of(struct mesh *m, uint64_t spp)
{
    struct render_job job = {.world = m->world,
                             .host = &m->host,
                             .crop = {0, 0, WIDTH, HEIGHT},
                             .limits.spp = spp};

    job.world.settings.features = FEATURES_ALL;
    return job;
}

static void assert_same_film(struct film *a, struct film *b)
{
    size_t pixels = (size_t)a->width * (size_t)a->height;

    assert_int_equal(a->width, b->width);
    assert_memory_equal(a->counts, b->counts, pixels * sizeof *a->counts);
    assert_memory_equal(a->sums, b->sums, 3 * pixels * sizeof *a->sums);
    assert_int_equal(atomic_load(&a->rays), atomic_load(&b->rays));
}

static void thread_counts_give_the_same_bits(void **state)
{
    const int threads[] = {1, 2, 3, 8};
    struct render *renders[4];
    struct mesh m;
    struct error err;

    (void)state;
    make_room(&m);
    for (int i = 0; i < 4; i++) {
        struct render_job job = job_of(&m, 11);
        struct render_progress p;

        renders[i] = open_render(threads[i]);
        assert_true(render_start(renders[i], &job, &err));
        assert_true(render_wait(renders[i], 60000));
        p = render_progress(renders[i]);
        assert_int_equal(p.state, RENDER_DONE);
        assert_int_equal(p.spp_done, 11);
        assert_int_equal(p.samples, 11 * WIDTH * HEIGHT);
        assert_int_equal(p.non_finite, 0);
        assert_true(p.first_picture_ns > 0);
        if (i > 0)
            assert_same_film(render_film(renders[0]), render_film(renders[i]));
    }
    for (int i = 0; i < 4; i++)
        close_render(renders[i]);
    mesh_free(&m);
}

/* The last 3 of the 11 samples are in a block that is not full. */
/* The last passes give each pixel 48 and 64 samples. */
static void long_passes_are_complete(void **state)
{
    struct render *r = open_render(2);
    struct render_job job;
    struct mesh m;
    struct error err;

    (void)state;
    make_room(&m);
    job = job_of(&m, 1130);
    job.crop = (struct rect){0, 0, 9, 5};
    assert_true(render_start(r, &job, &err));
    assert_true(render_wait(r, 60000));
    assert_int_equal(render_progress(r).samples, 1130 * 9 * 5);
    for (int i = 0; i < 9 * 5; i++)
        assert_int_equal(film_count(render_film(r), i % 9, i / 9), 1130);
    close_render(r);
    mesh_free(&m);
}

static void instruction_sets_give_the_same_bits(void **state)
{
    struct render *plain = open_render_with(cpu_kernel_named("plain", NULL), 2);
    const struct cpu_kernel *paths;
    struct mesh m;
    struct error err;
    struct render_job job;

    (void)state;
    make_room(&m);
    job = job_of(&m, 11);
    assert_true(render_start(plain, &job, &err));
    assert_true(render_wait(plain, 60000));
    for (int i = 0; (paths = cpu_kernel_at(i)) != NULL; i++) {
        struct render *r = open_render_with(paths, 2);

        assert_true(render_start(r, &job, &err));
        assert_true(render_wait(r, 60000));
        assert_same_film(render_film(plain), render_film(r));
        close_render(r);
    }
    assert_null(cpu_kernel_named("sse9", &err));
    close_render(plain);
    mesh_free(&m);
}

/* Halting at any moment and resuming loses no sample and repeats none. */
static void halts_lose_and_repeat_no_samples(void **state)
{
    struct render *whole = open_render(2), *halted = open_render(2);
    struct mesh m;
    struct error err;
    struct render_job job;
    int halts = 0;

    (void)state;
    make_room(&m);
    job = job_of(&m, 40);
    assert_true(render_start(whole, &job, &err));
    assert_true(render_start(halted, &job, &err));
    while (!render_wait(halted, 1)) {
        render_halt(halted);
        assert_int_not_equal(render_progress(halted).state, RENDER_RUNNING);
        render_resume(halted, (struct render_limits){.spp = 40});
        halts++;
    }
    assert_true(render_wait(whole, 60000));
    assert_true(halts > 3);
    assert_int_equal(render_progress(halted).state, RENDER_DONE);
    assert_same_film(render_film(whole), render_film(halted));
    /* one more sample per pixel */
    render_resume(whole, (struct render_limits){.spp = 41});
    assert_true(render_wait(whole, 60000));
    assert_int_equal(render_progress(whole).samples, 41 * WIDTH * HEIGHT);
    close_render(whole);
    close_render(halted);
    mesh_free(&m);
}

static struct render_progress wait_for_done(struct render *r)
{
    struct render_progress p;

    assert_true(render_wait(r, 60000));
    p = render_progress(r);
    assert_int_equal(p.state, RENDER_DONE);
    return p;
}

/* The limit of time counts rendering only, and the samples that it cuts off are
 * not lost: the picture can be completed. */
/* Drafts of other sizes and of numbers between its passes change no bit of a
 * film. */
static void a_film_outlives_drafts(void **state)
{
    static struct mesh m;
    struct render *whole = open_render(2), *kept = open_render(2);
    struct render_job job, other;
    struct error err;
    int drafts = 0;

    (void)state;
    make_room(&m);
    job = job_of(&m, 40);
    assert_true(render_start(whole, &job, &err));
    assert_true(render_start(kept, &job, &err));
    while (!render_wait(kept, 1)) {
        uint64_t spp_done = render_progress(kept).spp_done;

        other = job;
        other.keeps_film = true;
        other.draft_width = 10 + drafts % 7;
        other.draft_height = 20;
        other.draft_has_surfaces = drafts % 2 == 0;
        if (drafts % 3 == 0) {
            other.world.settings.sample = SAMPLE_NORMAL;
            other.limits = (struct render_limits){0};
        }
        assert_true(render_start(kept, &other, &err));
        assert_true(render_progress(kept).spp_done >= spp_done);
        if (drafts++ % 3 == 0)
            render_wait(kept, -1);
        other.world.settings.sample = SAMPLE_LIGHT;
        other.limits = job.limits;
        assert_true(render_start(kept, &other, &err));
    }
    assert_true(drafts > 3);
    render_wait(whole, -1);
    assert_int_equal(render_progress(kept).spp_done, 40);
    assert_same_film(render_film(whole), render_film(kept));
    close_render(whole);
    close_render(kept);
    mesh_free(&m);
}

static void time_ends_a_render(void **state)
{
    const uint64_t limit_ns = 200000000;
    struct render *whole = open_render(2), *timed = open_render(2);
    struct render_limits limits = {.time_ns = limit_ns};
    struct render_progress p;
    uint64_t samples;
    struct render_job job;
    struct mesh m;
    struct error err;

    (void)state;
    make_room(&m);
    job = job_of(&m, 0);
    job.limits = limits;
    assert_true(render_start(timed, &job, &err));
    assert_false(render_wait(timed, 60));
    render_halt(timed);
    p = render_progress(timed);
    assert_int_equal(p.state, RENDER_IDLE);
    assert_int_equal(p.stopped_by, RENDER_LIMIT_NONE);
    usleep(250000); /* longer than the limit */
    render_resume(timed, limits);
    p = wait_for_done(timed);
    assert_int_equal(p.stopped_by, RENDER_LIMIT_TIME);
    assert_true(p.render_ns >= limit_ns && p.samples > 0);
    /* done already: the time of earlier runs counts */
    samples = p.samples;
    render_resume(timed, limits);
    p = wait_for_done(timed);
    assert_int_equal(p.stopped_by, RENDER_LIMIT_TIME);
    assert_int_equal(p.samples, samples);
    /* samples come first */
    limits.spp = render_progress(timed).spp_done + 20;
    limits.time_ns = UINT64_MAX / 4;
    render_resume(timed, limits);
    p = wait_for_done(timed);
    assert_int_equal(p.stopped_by, RENDER_LIMIT_SPP);
    job = job_of(&m, limits.spp);
    assert_true(render_start(whole, &job, &err));
    assert_int_equal(wait_for_done(whole).stopped_by, RENDER_LIMIT_SPP);
    assert_same_film(render_film(whole), render_film(timed));
    close_render(whole);
    close_render(timed);
    mesh_free(&m);
}

/* The stated error is that of the film at the end of the time, also within a
 * pass. Halts between a pass and its error change neither bits nor errors. */
static void errors_belong_to_the_film(void **state)
{
    struct render *r = open_render(2), *halted = open_render(2);
    struct render_progress p, q;
    struct render_job job;
    struct film_error e;
    struct mesh m;
    struct error err;

    (void)state;
    make_room(&m);
    job = job_of(&m, 0);
    do { /* until two samples of each pixel fit, with any machine */
        job.limits.time_ns = 2 * job.limits.time_ns + 50000000;
        assert_true(render_start(r, &job, &err));
        p = wait_for_done(r);
    } while (!p.film_error.is_known);
    assert_int_equal(p.stopped_by, RENDER_LIMIT_TIME);
    assert_true(film_error(render_film(r), 0, NULL, NULL, &e, &err));
    check_close(p.film_error.error, e.error, 0);
    check_close(p.film_error.high, e.high, 0);
    job.limits = (struct render_limits){.spp = 40};
    assert_true(render_start(r, &job, &err));
    assert_true(render_start(halted, &job, &err));
    while (!render_wait(halted, 1)) {
        render_halt(halted);
        render_resume(halted, job.limits);
    }
    p = wait_for_done(r);
    q = wait_for_done(halted);
    check_close(q.film_error.high, p.film_error.high, 0);
    assert_false(q.is_adaptive);
    close_render(r);
    close_render(halted);
    mesh_free(&m);
}

/* A time that is over before the first sample gives an empty film. */
static void no_time_gives_no_sample(void **state)
{
    struct render *r = open_render(2);
    struct render_progress p;
    struct render_job job;
    struct mesh m;
    struct error err;

    (void)state;
    make_room(&m);
    job = job_of(&m, 7);
    job.limits.time_ns = 1;
    assert_true(render_start(r, &job, &err));
    p = wait_for_done(r);
    assert_int_equal(p.stopped_by, RENDER_LIMIT_TIME);
    assert_int_equal(p.samples, 0);
    close_render(r);
    mesh_free(&m);
}

/* After a restart nothing of the previous picture is shown. */
static void restarts_show_nothing_old(void **state)
{
    struct render *r = open_render(2), *fresh = open_render(2);
    struct mesh m;
    struct error err;
    struct render_job job;

    (void)state;
    make_room(&m);
    job = job_of(&m, 0);
    assert_true(render_start(r, &job, &err));
    for (int i = 0; i < 30; i++) {
        job.world.settings.camera.eye.x = 0.01f * (float)i;
        job.limits.spp = i == 29 ? 5 : 0;
        while (i % 2 == 0 && render_progress(r).samples == 0)
            sched_yield();
        assert_true(render_start(r, &job, &err));
    }
    assert_true(render_start(fresh, &job, &err));
    assert_true(render_wait(r, 60000));
    assert_true(render_wait(fresh, 60000));
    assert_same_film(render_film(r), render_film(fresh));
    close_render(r);
    close_render(fresh);
    mesh_free(&m);
}

static void a_crop_is_part_of_the_whole(void **state)
{
    static float all[3 * WIDTH * HEIGHT], part[3 * 20 * 10];
    struct render *r = open_render(2);
    struct mesh m;
    struct error err;
    struct render_job job;

    (void)state;
    make_room(&m);
    job = job_of(&m, 3);
    assert_true(render_start(r, &job, &err));
    render_wait(r, -1);
    film_linear(render_film(r), all);
    job.crop = (struct rect){33, 21, 20, 10};
    assert_true(render_start(r, &job, &err));
    render_wait(r, -1);
    film_linear(render_film(r), part);
    for (int y = 0; y < 10; y++)
        assert_memory_equal(part + 3 * 20 * y,
                            all + 3 * (WIDTH * (y + 21) + 33),
                            3 * 20 * sizeof *part);
    close_render(r);
    mesh_free(&m);
}

/* STRESS G5: duplicate faces look like single ones, bit for bit. */
static void duplicate_faces_change_nothing(void **state)
{
    struct render *once = open_render(2), *twice = open_render(2);
    struct mesh m, doubled;
    struct error err;
    struct render_job job;

    (void)state;
    make_room(&m);
    make_room(&doubled);
    for (uint32_t i = 0; i < m.tri_count; i++) {
        const uint32_t *v = m.tris[i].v;

        mesh_add(&doubled, m.positions[v[0]], m.positions[v[1]],
                 m.positions[v[2]], m.tris[i].material);
    }
    mesh_finish(&doubled);
    job = job_of(&m, 16);
    assert_true(render_start(once, &job, &err));
    job = job_of(&doubled, 16);
    assert_true(render_start(twice, &job, &err));
    assert_true(render_wait(once, 60000));
    assert_true(render_wait(twice, 60000));
    assert_same_film(render_film(once), render_film(twice));
    close_render(once);
    close_render(twice);
    mesh_free(&m);
    mesh_free(&doubled);
}

/* The tree is freed with the backend and built again with it. */
static void waiting_backends_hold_no_tree(void **state)
{
    struct render *r = open_render(1);
    struct backend *first = render_backend(r);
    struct error err;
    struct backend *second = backend_cpu_create(1, cpu_kernel_best(), &err);
    struct backend *order[] = {first, second, first};
    struct mesh m;

    (void)state;
    make_room(&m);
    assert_non_null(second);
    for (int i = 0; i < 3; i++) {
        struct render_job job = job_of(&m, 1);

        render_set_backend(r, order[i]);
        assert_true(render_start(r, &job, &err));
        assert_true(render_wait(r, 60000));
        assert_true(order[i]->tree_bytes > 0);
        assert_int_equal((i % 2 == 0 ? second : first)->tree_bytes, 0);
    }
    second->destroy(second);
    close_render(r);
    mesh_free(&m);
}

static void end_of_a_render_is_an_event(void **state)
{
    struct render *r = open_render(1);
    struct pollfd fd = {.fd = render_event_fd(r), .events = POLLIN};
    struct mesh m;
    struct error err;
    struct render_job job;
    uint64_t events = 0;

    (void)state;
    make_room(&m);
    job = job_of(&m, 1);
    assert_int_equal(read(render_event_fd(r), &events, sizeof events), -1);
    assert_true(render_start(r, &job, &err));
    render_wait(r, -1);
    /* Immediately after the state changes. */
    assert_int_equal(poll(&fd, 1, 60000), 1);
    assert_int_equal(read(fd.fd, &events, sizeof events), sizeof events);
    assert_int_equal(events, 1);
    close_render(r);
    render_destroy(NULL);
    mesh_free(&m);
}

/* STRESS C16: a library has switched denormals off or changed the rounding mode
 * before the threads start. Some last bits differ, but the picture is the same.
 * The t value of the pixels' differences exceeds 4.9 once in a million. */
static void foreign_float_modes_change_nothing(void **state)
{
    static float rgb[3][3 * WIDTH * HEIGHT];
    fenv_t before;

    (void)state;
    fegetenv(&before);
    for (int i = 0; i < 3; i++) {
        struct mesh m = {0};
        struct render_job job;
        struct render *r;
        struct error err;

        make_room(&m);
        if (i == 1)
            fesetround(FE_UPWARD);
#ifdef __SSE2__
        if (i == 2)
            _mm_setcsr(_mm_getcsr() | 0x8040); /* FTZ, DAZ */
#endif
        r = open_render(2);
        job = job_of(&m, 16);
        assert_true(render_start(r, &job, &err));
        assert_true(render_wait(r, 60000));
        fesetenv(&before);
        assert_int_equal(render_progress(r).non_finite, 0);
        film_linear(render_film(r), rgb[i]);
        close_render(r);
        mesh_free(&m);
    }
    for (int i = 1; i < 3; i++) {
        double sum = 0, squares = 0;
        const int n = 3 * WIDTH * HEIGHT;

        for (int k = 0; k < n; k++) {
            double d = (double)rgb[i][k] - (double)rgb[0][k];

            sum += d;
            squares += d * d;
        }
        if (i == 1)
            assert_true(squares > 0); /* the threads do round upwards */
        assert_true(fabs(sum) <= 4.9 * sqrt(squares) + 1e-6 * n);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(thread_counts_give_the_same_bits),
        cmocka_unit_test(long_passes_are_complete),
        cmocka_unit_test(instruction_sets_give_the_same_bits),
        cmocka_unit_test(halts_lose_and_repeat_no_samples),
        cmocka_unit_test(a_film_outlives_drafts),
        cmocka_unit_test(time_ends_a_render),
        cmocka_unit_test(errors_belong_to_the_film),
        cmocka_unit_test(no_time_gives_no_sample),
        cmocka_unit_test(restarts_show_nothing_old),
        cmocka_unit_test(a_crop_is_part_of_the_whole),
        cmocka_unit_test(duplicate_faces_change_nothing),
        cmocka_unit_test(waiting_backends_hold_no_tree),
        cmocka_unit_test(end_of_a_render_is_an_event),
        cmocka_unit_test(foreign_float_modes_change_nothing),
    };

    return cmocka_run_group_tests(tests, NULL, NULL);
}
