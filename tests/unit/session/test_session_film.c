// SPDX-License-Identifier: MIT
/*
 * test_session_film.c - what makes two films films of the same picture, the
 * samples of shares, and checkpoints on a slow disk
 */
#include <stdatomic.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>
#include <unistd.h>

#include "base/clock.h"
#include "session/session_film.h"

#include "tests/unit/files.h"
#include "tests/unit/npy_file.h"

#define OBJ  "mtllib s.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\nusemtl m\nf 1 2 3\n"
#define MTL  "newmtl m\nKd 0.5 0.5 0.5\n"
#define VIEW "eye 0 0 5\nat 0 0 0\nbackground 1 1 1\n"

static const char *const names[] = {"s.obj",  "s.mtl",  "s.view",
                                    "s.film", "c.film", "s.npy"};

/* A disk that does not answer until it is released. */
static atomic_bool is_slow, is_writing, is_released;

static void rest(void)
{
    nanosleep(&(struct timespec){.tv_nsec = 1000000}, NULL);
}

int __real_fsync(int fd);
int __wrap_fsync(int fd);

int __wrap_fsync(int fd)
{
    atomic_store(&is_writing, true);
    while (atomic_load(&is_slow) && !atomic_load(&is_released))
        rest();
    return __real_fsync(fd);
}

static int leave(void **state)
{
    (void)state;
    for (size_t i = 0; i < sizeof names / sizeof names[0]; i++)
        unlink(names[i]);
    return leave_empty_folder(state);
}

static struct options some_options(void)
{
    struct options o;

    options_init(&o);
    o.scene_path = "s.obj";
    o.batch = true;
    o.thread_count = 1;
    o.width_px = 16;
    o.height_px = 9;
    o.film_path = "s.film";
    return o;
}

static struct film_identity identity_of(const struct options *o)
{
    struct film_identity id;
    struct session_film f;
    struct session s;
    struct error err;

    check_or_say(session_open(&s, o, clock_ns(), &err), err.text);
    check_or_say(session_film_begin(&f, &s, &err), err.text);
    id = f.identity;
    session_film_end(&f);
    session_close(&s);
    return id;
}

static void put_files(const char *obj, const char *mtl, const char *view)
{
    put("s.obj", obj);
    put("s.mtl", mtl);
    put("s.view", view);
}

/* Checks that the files make samples of the picture of OBJ, MTL and VIEW, or
 * that this is what differs. */
static void check_files(const char *obj, const char *mtl, const char *view,
                        const char *difference)
{
    struct options o = some_options();
    struct film_identity a, b;
    struct error err = {""};

    put_files(OBJ, MTL, VIEW);
    a = identity_of(&o);
    put_files(obj, mtl, view);
    b = identity_of(&o);
    if (difference == NULL) {
        check_or_say(film_identity_check(&b, "b", &a, "a", &err), err.text);
        return;
    }
    assert_false(film_identity_check(&b, "b", &a, "a", &err));
    check_has(err.text, difference);
}

static void only_the_picture_counts(void **state)
{
    (void)state;
    check_files(OBJ, MTL, VIEW, NULL);
    check_files("# more\n" OBJ, MTL "# x\n", VIEW "tone aces\n", NULL);
    check_files(OBJ, MTL, VIEW "exposure 2\n", NULL);
    check_files(OBJ "f 3 2 1\n", MTL, VIEW, "geometry");
    check_files(OBJ, "newmtl m\nKd 0.5 0.5 0.25\n", VIEW, "materials");
    check_files(OBJ, MTL, "eye 0 0 4\nat 0 0 0\nbackground 1 1 1\n", "camera");
    check_files(OBJ, MTL, "eye 0 0 5\nat 0 0 0\nbackground 1 1 2\n", "light");
    check_files(OBJ, MTL, VIEW "max_bounces 3\n", "bounces");
}

/* ---- smokes ---- */

#define SMOKE VIEW "medium s.npy scatter 1 2 3 absorb 1 1 1 scale 2\n"

/* Writes a grid of which one voxel has this number. */
static void put_grid(float number)
{
    const float numbers[8] = {1, 2, 3, 4, 5, 6, number, 8};
    size_t size;
    char *bytes = npy_file_of((const uint32_t[3]){2, 2, 2}, numbers, &size);

    put_bytes("s.npy", bytes, size);
    free(bytes);
}

/* Returns the film of a view with a smoke. */
static struct film_identity smoke_film(const char *view, float number)
{
    struct options o = some_options();

    put_files(OBJ, MTL, view);
    put_grid(number);
    return identity_of(&o);
}

/* Coefficients, places and each voxel count. */
static void smokes_count(void **state)
{
    static const struct {
        const char *view;
        float number;
    } others[] = {
        {VIEW, 7},
        {SMOKE, 7.01f},
        {VIEW "medium s.npy scatter 1 2 3 absorb 1 1 1.01 scale 2\n", 7},
        {VIEW "medium s.npy scatter 1 2 3 absorb 1 1 1 scale 2 at 0 0 .1\n", 7},
        {VIEW "medium s.npy scatter 1 2 3 absorb 1 1 1 scale 2 anisotropy .1\n",
         7},
        {SMOKE "medium s.npy absorb .1 0 0\n", 7},
    };
    struct film_identity a = smoke_film(SMOKE, 7), b;
    struct error err = {""};

    (void)state;
    b = smoke_film(SMOKE, 7);
    check_or_say(film_identity_check(&b, "b", &a, "a", &err), err.text);
    for (size_t i = 0; i < sizeof others / sizeof *others; i++) {
        b = smoke_film(others[i].view, others[i].number);
        assert_false(film_identity_check(&b, "b", &a, "a", &err));
        check_has(err.text, "light");
    }
}

/* A film of a smoke goes on with the same smoke alone. */
static void films_go_on_with_their_smoke(void **state)
{
    struct options o = some_options();

    (void)state;
    o.has_spp = true;
    o.spp = 2;
    put_files(OBJ, MTL, SMOKE);
    for (int i = 0; i < 3; i++) {
        struct film_file *from = NULL;
        struct session_film f;
        struct session s;
        struct error err = {""};

        put_grid(i < 2 ? 7 : 6);
        o.resume_path = i == 0 ? NULL : "s.film";
        check_or_say(session_open(&s, &o, clock_ns(), &err), err.text);
        check_or_say(session_film_begin(&f, &s, &err), err.text);
        if (i == 0) {
            check_or_say(session_restart(&s, options_limits(&o), &err),
                         err.text);
            assert_true(render_wait(s.engine.render, 60000));
            check_or_say(session_film_write(&f, &err), err.text);
        } else {
            assert_int_equal(session_film_resume(&f, &from, &err), i == 1);
            check_has(err.text, i == 1 ? "" : "light");
        }
        session_film_end(&f);
        session_close(&s);
    }
}

static void options_count(void **state)
{
    struct options o = some_options(), other;
    struct film_identity a;
    struct error err;

    (void)state;
    put_files(OBJ, MTL, VIEW);
    a = identity_of(&o);
    for (int i = 0; i < 6; i++) {
        static const char *const words[] = {"--seed", "-w",         "-h",
                                            "-d",     "--adaptive", "--crop"};
        struct film_identity b;

        other = o;
        other.seed = i == 0;
        other.width_px += i == 1;
        other.height_px += i == 2;
        other.has_max_bounces = i == 3;
        other.max_bounces = 4;
        other.adaptive = i == 4;
        other.has_crop = i == 5;
        other.crop = (struct rect){1, 0, 15, 9};
        b = identity_of(&other);
        assert_false(film_identity_check(&b, "b", &a, "a", &err));
        check_has(err.text, words[i]);
    }
    other = o;
    other.thread_count = 2;
    other.spp = 400;
    other.share_index = 2;
    other.share_count = 4;
    other.has_spp = true;
    {
        struct film_identity b = identity_of(&other);

        check_or_say(film_identity_check(&b, "b", &a, "a", &err), err.text);
    }
}

/* The shares of any number of samples are neighbours, begin with even numbers,
 * and are equally large but for four samples. */
static void shares_cover_all_samples(void **state)
{
    static const uint64_t spps[] = {16, 17, 1000, 1001, 1000000000000u};
    static const int counts[] = {1, 2, 3, 8, 100000};

    (void)state;
    for (int s = 0; s < 5; s++)
        for (int c = 0; c < 5; c++) {
            struct options o = {.spp = spps[s],
                                .has_spp = true,
                                .share_count = counts[c]};
            uint64_t sum = 0;

            for (int i = 1; i <= counts[c]; i++) {
                uint64_t spp;

                o.share_index = i;
                assert_true(sum % 2 == 0);
                assert_true(session_film_first(&o) == sum);
                spp = session_film_limits(&o).spp;
                assert_true(spp + 4 > spps[s] / (uint64_t)counts[c]);
                assert_true(spp < spps[s] / (uint64_t)counts[c] + 4);
                sum += spp;
            }
            assert_true(sum == spps[s]);
        }
}

/* While the disk holds a checkpoint, the render goes on and can be halted. */
static void renders_do_not_wait_for_the_disk(void **state)
{
    struct options o = some_options();
    struct render_progress before, p;
    struct session_film f;
    struct session s;
    struct error err;

    (void)state;
    put_files(OBJ, MTL, VIEW);
    o.checkpoint_path = "c.film";
    o.checkpoint_ns = 100000000;
    o.has_spp = true;
    o.spp = 1000000000;
    check_or_say(session_open(&s, &o, clock_ns(), &err), err.text);
    check_or_say(session_film_begin(&f, &s, &err), err.text);
    atomic_store(&is_writing, false);
    atomic_store(&is_slow, true);
    check_or_say(session_restart(&s, options_limits(&o), &err), err.text);
    check_or_say(session_film_watch(&f, &err), err.text);
    while (!atomic_load(&is_writing))
        rest();
    before = render_progress(s.engine.render);
    do {
        rest();
        p = render_progress(s.engine.render);
    } while (p.spp_done < before.spp_done + 1000);
    render_halt(s.engine.render);
    assert_int_equal(access("c.film", F_OK), -1);
    atomic_store(&is_released, true);
    session_film_stop(&f);
    assert_int_equal(access("c.film", F_OK), 0);
    session_film_end(&f);
    session_close(&s);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(only_the_picture_counts),
        cmocka_unit_test(smokes_count),
        cmocka_unit_test(films_go_on_with_their_smoke),
        cmocka_unit_test(options_count),
        cmocka_unit_test(shares_cover_all_samples),
        cmocka_unit_test(renders_do_not_wait_for_the_disk),
    };

    return cmocka_run_group_tests(tests, enter_folder, leave);
}
