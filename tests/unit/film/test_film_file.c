// SPDX-License-Identifier: MIT
#include "tests/unit/check.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "film/film_file.h"

#define WIDTH  37
#define HEIGHT 29
#define PIXELS (WIDTH * HEIGHT)

/* Samples of a pixel in all. */
#define SPP 20

/* A sample that is a function of pixel and index alone, as those of the
 * renderer, and of very different sizes. */
static void sample_of(int x, int y, uint64_t index, struct path_sample *p,
                      struct first_surface *s)
{
    uint64_t seed = (uint64_t)(y * WIDTH + x) * 1000 + index + 1;
    float large = check_random(&seed) < 0.01 ? 1e12f : 1.0f;
    float r = (float)check_random(&seed);

    *p = (struct path_sample){.radiance = {large * r, r, 1e-9f * r}, .rays = 3};
    *s = (struct first_surface){.direct = {0.25f * r, 0.5f * r, 0.0f},
                                .albedo = {r, 0.5f, 1.0f - r},
                                .normal = {0.0f, r, 0.0f},
                                .depth = 1.0f + r};
}

/* Adds samples with indices from the film's first on until each pixel has
 * `spp`. */
static void add_samples(struct film *f, uint64_t spp)
{
    for (int y = 0; y < f->height; y++)
        for (int x = 0; x < f->width; x++)
            for (uint64_t k = film_count(f, x, y); k < spp; k++) {
                struct path_sample p;
                struct first_surface s;

                sample_of(x, y, f->first_sample + k, &p, &s);
                film_add_row(f, (struct film_pixels){x, y, 1, 1}, &p, &s,
                             (int[]){1});
            }
}

static const uint16_t *lend(void *shares)
{
    return shares;
}

/* Exposure of the films. */
static float exposure;

/* A film of samples first to end, in a file in memory. */
static char *bytes_of(uint64_t first, uint64_t end, bool has_surfaces,
                      const uint16_t *shares, size_t *size)
{
    struct film_range range = {first, end};
    struct film_header h = {.identity = {.hashes = {1, 2, UINT64_MAX},
                                         .seed = UINT32_MAX,
                                         .picture_width = 100,
                                         .picture_height = 50,
                                         .x = 63,
                                         .y = 21,
                                         .width = WIDTH,
                                         .height = HEIGHT,
                                         .has_surfaces = has_surfaces,
                                         .is_adaptive = shares != NULL},
                            .version = "1.2",
                            .scene = "a\nb.obj",
                            .ranges = &range,
                            .range_count = 1,
                            .total = SPP};
    struct film film;
    struct error err;
    char *bytes;

    memcpy(&h.identity.exposure_bits, &exposure, sizeof exposure);
    assert_true(film_init(&film, WIDTH, HEIGHT, &err));
    assert_true(!has_surfaces || film_init_surfaces(&film, &err));
    film.first_sample = first;
    add_samples(&film, end - first);
    h.rays = atomic_load(&film.rays);
    bytes =
        film_file_bytes(&h, &film, lend, (void *)(uintptr_t)shares, size, &err);
    assert_non_null(bytes);
    film_free(&film);
    return bytes;
}

static void parse(struct film_file *f, const char *bytes, size_t size)
{
    struct error err = {""};

    check_or_say(film_file_parse(f, "x.film", bytes, size, &err), err.text);
}

/* Fails with a message that has the text. */
static void refuse(const char *bytes, size_t size, const char *text)
{
    struct film_file f;
    struct error err = {""};

    assert_false(film_file_parse(&f, "x.film", bytes, size, &err));
    check_has(err.text, text);
    film_file_free(&f);
}

static void check_same_sums(const struct sum *a, const struct sum *b, int count)
{
    for (int i = 0; i < count; i++)
        assert_true(a[i].lo == b[i].lo && a[i].hi == b[i].hi);
}

static void check_same_surfaces(const struct surface_sums *a,
                                const struct surface_sums *b)
{
    check_same_sums(a->direct, b->direct, 3);
    check_same_sums(a->odd_direct, b->odd_direct, 3);
    check_same_sums(a->seen, b->seen, 3);
    check_same_sums(a->odd_seen, b->odd_seen, 3);
    check_same_sums(&a->depth, &b->depth, 1);
    check_same_sums(&a->depth_square, &b->depth_square, 1);
    assert_memory_equal(a->albedo, b->albedo, sizeof a->albedo);
    assert_memory_equal(a->normal, b->normal, sizeof a->normal);
    assert_int_equal(a->albedo_square, b->albedo_square);
    assert_int_equal(a->count, b->count);
    assert_int_equal(a->hit_count, b->hit_count);
    assert_int_equal(a->seen_count, b->seen_count);
}

/* Checks that the film has all samples up to `spp`, as if they were added one
 * by one. */
static void check_film(struct film *f, uint64_t spp)
{
    struct film truth;
    struct error err;

    assert_true(film_init(&truth, WIDTH, HEIGHT, &err));
    assert_true(f->surfaces == NULL || film_init_surfaces(&truth, &err));
    add_samples(&truth, spp);
    assert_int_equal(f->first_sample, 0);
    for (int i = 0; i < PIXELS; i++) {
        assert_int_equal(f->counts[i], spp);
        check_same_sums(f->sums + 3 * i, truth.sums + 3 * i, 3);
        check_same_sums(f->odd_sums + 3 * i, truth.odd_sums + 3 * i, 3);
        if (f->surfaces != NULL)
            check_same_surfaces(&f->surfaces[i], &truth.surfaces[i]);
    }
    assert_int_equal(atomic_load(&f->samples), PIXELS * spp);
    assert_int_equal(atomic_load(&f->rays), 3 * PIXELS * spp);
    film_free(&truth);
}

static void films_come_back(void **state)
{
    (void)state;
    for (int surfaces = 0; surfaces < 2; surfaces++) {
        size_t size;
        char *bytes = bytes_of(0, 7, surfaces, NULL, &size);
        struct film_file f;

        parse(&f, bytes, size);
        assert_int_equal(f.header.identity.seed, UINT32_MAX);
        assert_true(f.header.identity.hashes[2] == UINT64_MAX);
        assert_int_equal(f.header.identity.x, 63);
        assert_int_equal(f.header.total, SPP);
        assert_string_equal(f.header.version, "1.2");
        assert_string_equal(f.header.scene, "a?b.obj");
        assert_false(f.is_within_pass);
        check_film(&f.film, 7);
        /* the film goes on to the same sums */
        add_samples(&f.film, 12);
        atomic_store(&f.film.rays, 3 * PIXELS * 12);
        check_film(&f.film, 12);
        film_file_free(&f);
        free(bytes);
    }
}

static void shares_come_back(void **state)
{
    uint16_t shares[PIXELS];
    struct film_file f;
    size_t size;
    char *bytes;

    (void)state;
    for (int i = 0; i < PIXELS; i++)
        shares[i] = (uint16_t)(i * 7);
    bytes = bytes_of(0, 16, false, shares, &size);
    parse(&f, bytes, size);
    assert_memory_equal(f.shares, shares, sizeof shares);
    film_file_free(&f);
    refuse(bytes, size - 1, "behind the last row");
    free(bytes);
}

/* Parts in any order have the sums of the whole. */
static void parts_join_to_the_whole(void **state)
{
    static const uint64_t ends[] = {0, 6, 8, 14, SPP};
    static const int orders[][4] = {{0, 1, 2, 3}, {3, 1, 0, 2}, {2, 3, 1, 0}};

    (void)state;
    for (int o = 0; o < 3; o++) {
        struct film_file f[4];
        struct error err = {""};

        for (int i = 0; i < 4; i++) {
            int part = orders[o][i];
            size_t size;
            char *bytes =
                bytes_of(ends[part], ends[part + 1], true, NULL, &size);

            parse(&f[i], bytes, size);
            free(bytes);
        }
        for (int i = 1; i < 4; i++)
            check_or_say(film_file_join(&f[0], "a", &f[i], "b", &err),
                         err.text);
        assert_int_equal(f[0].header.range_count, 1);
        check_film(&f[0].film, SPP);
        assert_false(film_file_join(&f[0], "a", &f[2], "b", &err));
        check_has(err.text, "that a does not have");
        for (int i = 0; i < 4; i++)
            film_file_free(&f[i]);
    }
}

static void gaps_are_found(void **state)
{
    struct film_range ranges[] = {{2, 4}, {10, 12}, {12, 14}};
    struct film_header h = {.ranges = ranges, .range_count = 3, .total = 20};
    static const struct film_range expected[] = {{0, 2}, {4, 10}, {14, 20}};
    struct film_range gap;
    uint64_t at = 0;
    int count = 0;

    (void)state;
    while (film_header_gap(&h, &at, &gap)) {
        assert_true(count < 3 && gap.first == expected[count].first &&
                    gap.end == expected[count].end);
        count++;
    }
    assert_int_equal(count, 3);
}

/* No byte can change and no end can be missing without an error. */
static void damage_is_found(void **state)
{
    size_t size;
    char *bytes = bytes_of(0, 3, false, NULL, &size);

    (void)state;
    for (size_t i = 0; i < size; i++) {
        bytes[i] ^= 1 << i % 8;
        refuse(bytes, size, "x.film");
        bytes[i] ^= 1 << i % 8;
    }
    for (size_t i = 0; i < size; i += i < 1000 ? 1 : 97)
        refuse(bytes, i, "x.film");
    bytes = realloc(bytes, size + 1);
    assert_non_null(bytes);
    bytes[size] = 0;
    refuse(bytes, size + 1, "more bytes behind the last row");
    memcpy(bytes, "glim film 2", 11);
    refuse(bytes, size, "expected 'glim film 1'");
    memcpy(bytes, "glim-", 5);
    refuse(bytes, size, "another kind of file");
    free(bytes);
}

/* As in view files: from -100 to 100 stops. */
static void wild_exposures_are_refused(void **state)
{
    static const float wild[] = {NAN, INFINITY, -INFINITY, 100.001f, -1e30f};
    static const float good[] = {100, -100, 0};
    struct film_file f = {.shares = NULL};
    size_t size;
    char *bytes;

    (void)state;
    for (size_t i = 0; i < sizeof wild / sizeof *wild; i++) {
        exposure = wild[i];
        bytes = bytes_of(0, 2, false, NULL, &size);
        refuse(bytes, size, "expected -100 to 100");
        free(bytes);
    }
    for (size_t i = 0; i < sizeof good / sizeof *good; i++) {
        exposure = good[i];
        bytes = bytes_of(0, 2, false, NULL, &size);
        parse(&f, bytes, size);
        film_file_free(&f);
        free(bytes);
    }
    exposure = 0;
}

static void other_pictures_are_named(void **state)
{
    const struct film_identity id = {.width = 1};
    struct film_identity other = id;
    struct error err;

    (void)state;
    assert_true(film_identity_check(&id, "a.film", &other, "b.obj", &err));
    other.exposure_bits = 7; /* counts for adaptive films alone */
    assert_true(film_identity_check(&id, "a.film", &other, "b.obj", &err));
    other = id;
    other.seed = 3;
    assert_false(film_identity_check(&id, "a.film", &other, "b.obj", &err));
    assert_string_equal(err.text,
                        "a.film: found seed 0, expected 3 as of b.obj "
                        "(--seed)");
    for (int i = 0; i < FILM_PARTS; i++) {
        static const char *const words[] = {"version of glim", "geometry",
                                            "materials",       "textures",
                                            "light",           "camera",
                                            "bounces",         "guide"};

        other = id;
        other.hashes[i] = 1;
        assert_false(film_identity_check(&id, "a.film", &other, "b.obj", &err));
        check_has(err.text, words[i]);
    }
}

/* A film that was saved within a pass says so, and is not joined. */
static void films_within_a_pass_are_not_joined(void **state)
{
    struct film_range range = {0, 2};
    struct film_header h = {.identity = {.picture_width = WIDTH,
                                         .picture_height = HEIGHT,
                                         .width = WIDTH,
                                         .height = HEIGHT},
                            .ranges = &range,
                            .range_count = 1};
    struct film film;
    struct film_file f, g;
    struct path_sample p;
    struct first_surface s;
    struct error err = {""};
    size_t size;
    char *bytes;

    (void)state;
    assert_true(film_init(&film, WIDTH, HEIGHT, &err));
    add_samples(&film, 2);
    sample_of(5, 5, 2, &p, &s);
    film_add_row(&film, (struct film_pixels){5, 5, 1, 1}, &p, &s, (int[]){1});
    bytes = film_file_bytes(&h, &film, NULL, NULL, &size, &err);
    assert_non_null(bytes);
    parse(&f, bytes, size);
    parse(&g, bytes, size);
    assert_true(f.is_within_pass);
    assert_int_equal(f.header.samples, 2 * PIXELS + 1);
    assert_false(film_file_join(&f, "a", &g, "b", &err));
    check_has(err.text, "within a pass");
    free(bytes);
    film_free(&film);
    film_file_free(&f);
    film_file_free(&g);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(films_come_back),
        cmocka_unit_test(shares_come_back),
        cmocka_unit_test(parts_join_to_the_whole),
        cmocka_unit_test(gaps_are_found),
        cmocka_unit_test(damage_is_found),
        cmocka_unit_test(wild_exposures_are_refused),
        cmocka_unit_test(other_pictures_are_named),
        cmocka_unit_test(films_within_a_pass_are_not_joined),
    };

    return cmocka_run_group_tests(tests, NULL, NULL);
}
