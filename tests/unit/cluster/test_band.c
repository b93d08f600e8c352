// SPDX-License-Identifier: MIT
/*
 * test_band.c - bands of a film, rendered alone and merged, have the sums of a
 * film that is rendered at once
 */
#include "tests/unit/check.h"
#include "tests/unit/mesh.h"

#include <stdlib.h>
#include <string.h>

#include "film/film.h"
#include "render/cluster/band.h"
#include "render/cpu_dispatch.h"

#define WIDTH  37
#define HEIGHT 29
#define PIXELS (WIDTH * HEIGHT)

static struct mesh mesh;
static struct backend *backend;
static uint16_t shares[PIXELS];
static float light_pixels[6 * PIXELS];
static const struct pass_light light = {.pixels = light_pixels,
                                        .pixel_count = PIXELS,
                                        .version = 1};

static int open_room(void **state)
{
    struct error err;
    uint64_t seed = 1;

    (void)state;
    memset(&mesh, 0, sizeof mesh);
    mesh.materials[0] = mesh_material(MATERIAL_DIFFUSE, 0.7f);
    mesh.materials[1] = mesh_material(MATERIAL_DIFFUSE, 0.0f);
    mesh.materials[1].emission = v3(9, 8, 7);
    mesh_add_box(&mesh, v3(-1, -1, -1), v3(1, 1, 1), 0);
    mesh_add_quad(&mesh, v3(-0.4f, 0.99f, -0.4f), v3(0.4f, 0.99f, -0.4f),
                  v3(0.4f, 0.99f, 0.4f), v3(-0.4f, 0.99f, 0.4f), 1);
    mesh.world.settings.camera = (struct camera){.eye = {0, 0, 0.95f},
                                                 .width = 80,
                                                 .forward = {0, 0, -1},
                                                 .height = 60,
                                                 .right = {0.8f, 0, 0},
                                                 .up = {0, 0.5f, 0}};
    mesh_finish(&mesh);
    mesh.world.settings.features = FEATURES_ALL;
    for (int i = 0; i < PIXELS; i++)
        shares[i] = (uint16_t)(512 + check_random(&seed) * 9000);
    for (int i = 0; i < 6 * PIXELS; i++)
        light_pixels[i] = (float)check_random(&seed);
    backend = backend_cpu_create(2, cpu_kernel_best(), &err);
    return backend == NULL ||
           !backend->load(backend, &mesh.host, &mesh.world, &err);
}

static int close_room(void **state)
{
    (void)state;
    backend->destroy(backend);
    world_drop_tree(&mesh.host);
    return 0;
}

static const struct cancel never;

/* Passes with shares have light as well. */
static struct pass pass_to(uint64_t done, uint64_t target, bool has_shares)
{
    struct pass pass = {.stride = 1,
                        .shares = has_shares ? shares : NULL,
                        .light = has_shares ? &light : NULL,
                        .order = 3};

    return pass_with(pass, target, target - done);
}

static void make_film(struct film *f, uint64_t first_sample)
{
    struct error err;

    assert_true(film_init(f, WIDTH, HEIGHT, &err));
    assert_true(film_init_surfaces(f, &err));
    f->first_sample = first_sample;
}

static void render_whole(struct film *f, const struct pass *pass)
{
    struct error err;

    assert_true(backend->begin(backend,
                               &(struct backend_picture){.host = &mesh.host,
                                                         .world = &mesh.world,
                                                         .film = f,
                                                         .x0 = 11,
                                                         .y0 = 7},
                               &err));
    assert_true(backend->pass(backend, pass, &never, &err) == PASS_DONE);
}

static struct band_range rows_of(int y, int rows, const struct pass *pass)
{
    return (struct band_range){.y = y, .rows = rows, .pass = *pass};
}

static void render_range(struct band *band, const struct film *f,
                         const struct band_range *range,
                         const struct cancel *cancel, enum pass_result result)
{
    struct error err = {""};

    check_or_say(band_init(band, WIDTH, range, true, &err), err.text);
    band_take(band, f, range);
    assert_true(band_render(band, backend,
                            &(struct backend_picture){.host = &mesh.host,
                                                      .world = &mesh.world,
                                                      .x0 = 11,
                                                      .y0 = 7},
                            f->first_sample, cancel, &err) == result);
}

static void render_band(struct film *f, int y, int rows,
                        const struct pass *pass)
{
    struct band_range range = rows_of(y, rows, pass);
    struct band band;

    render_range(&band, f, &range, &never, PASS_DONE);
    film_merge(f, y, &band.film);
    band_free(&band);
}

/* Renders the rows in another order. */
static void render_bands(struct film *f, const struct pass *pass)
{
    render_band(f, 16, 8, pass);
    render_band(f, 24, HEIGHT - 24, pass);
    render_band(f, 0, 16, pass);
}

static void check_same(const struct film *a, const struct film *b)
{
    for (int i = 0; i < PIXELS; i++) {
        assert_int_equal(a->counts[i], b->counts[i]);
        assert_memory_equal(a->sums + 3 * i, b->sums + 3 * i,
                            3 * sizeof *a->sums);
        assert_memory_equal(a->odd_sums + 3 * i, b->odd_sums + 3 * i,
                            3 * sizeof *a->sums);
        assert_memory_equal(&a->surfaces[i], &b->surfaces[i],
                            sizeof *a->surfaces);
    }
    assert_int_equal(atomic_load(&a->samples), atomic_load(&b->samples));
    assert_int_equal(atomic_load(&a->rays), atomic_load(&b->rays));
}

static void bands_make_the_whole_film(void **state)
{
    (void)state;
    for (int i = 0; i < 3; i++) {
        static const uint64_t firsts[] = {0, 0, 1000};
        bool has_shares = i == 1;
        struct pass to_16 = pass_to(0, 16, false),
                    to_40 = pass_to(16, 40, has_shares);
        struct film whole, parts;

        make_film(&whole, firsts[i]);
        make_film(&parts, firsts[i]);
        render_whole(&whole, &to_16);
        render_whole(&whole, &to_40);
        render_bands(&parts, &to_16);
        /* a part of the rows is ahead, as after a halt */
        render_band(&parts, 8, 16, &to_40);
        render_bands(&parts, &to_40);
        check_same(&whole, &parts);
        film_free(&whole);
        film_free(&parts);
    }
}

/* A band that is cancelled has whole samples, and the rest follows. */
static void cancelled_bands_lose_nothing(void **state)
{
    struct pass to_40 = pass_to(0, 40, false);
    struct band_range range = rows_of(0, 16, &to_40);
    struct cancel now = {.deadline_ns = 1};
    struct film whole, parts;
    struct band band;

    (void)state;
    make_film(&whole, 0);
    make_film(&parts, 0);
    render_whole(&whole, &to_40);
    render_range(&band, &parts, &range, &now, PASS_CANCELLED);
    film_merge(&parts, 0, &band.film);
    band_free(&band);
    render_bands(&parts, &to_40);
    check_same(&whole, &parts);
    film_free(&whole);
    film_free(&parts);
}

/* Bands of a pass that ranks would have, whose answers come in any order. */
static void slices_make_the_whole_film(void **state)
{
    (void)state;
    for (int i = 0; i < 2; i++) {
        struct pass to_16 = pass_to(0, 16, false),
                    to_200 = pass_to(16, 200, i == 1);
        struct band_answer *answers[200];
        struct band_range ranges[200];
        size_t sizes[200];
        struct film whole, parts;
        struct band_plan plan;
        int count = 0, done = 0;
        struct error err = {""};

        make_film(&whole, 0);
        make_film(&parts, 0);
        render_whole(&whole, &to_16);
        render_whole(&parts, &to_16);
        render_whole(&whole, &to_200);
        plan = band_plan_begin(&parts, &to_200, 5, HEIGHT);
        assert_int_equal(plan.slices, 3); /* 15 bands of rows for 5 ranks */
        for (; band_plan_next(&plan, &ranges[count]); count++) {
            struct band band;

            render_range(&band, &parts, &ranges[count], &never, PASS_DONE);
            answers[count] = band_answer_make(&band, 1, "", &sizes[count]);
            band_free(&band);
        }
        assert_true(count >= 20);
        /* the newest first, and none before those that it follows */
        while (done < count) {
            int k = count - 1;

            while (answers[k] == NULL || !band_plan_is_next(&parts, &ranges[k]))
                k--;
            check_or_say(band_answer_add(answers[k], sizes[k], &parts, &err),
                         err.text);
            free(answers[k]);
            answers[k] = NULL;
            done++;
        }
        check_same(&whole, &parts);
        film_free(&whole);
        film_free(&parts);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(bands_make_the_whole_film),
        cmocka_unit_test(cancelled_bands_lose_nothing),
        cmocka_unit_test(slices_make_the_whole_film),
    };

    return cmocka_run_group_tests(tests, open_room, close_room);
}
