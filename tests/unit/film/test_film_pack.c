// SPDX-License-Identifier: MIT
/*
 * test_film_pack.c - packed rows of a film are the same pixels, and damaged
 * bytes are refused
 */
#include "tests/unit/check.h"

#include <stdlib.h>
#include <string.h>

#include "film/film_pack.h"

#define WIDTH  23
#define HEIGHT 5

static uint64_t word(uint64_t *seed, int bits)
{
    uint64_t w = (uint64_t)(check_random(seed) * 0x1p32) << 32 |
                 (uint64_t)(check_random(seed) * 0x1p32);

    return bits == 0 ? 0 : w >> (64 - bits);
}

static void make_film(struct film *f, bool has_surfaces, uint64_t seed)
{
    struct error err;

    assert_true(film_init(f, WIDTH, HEIGHT, &err));
    assert_true(!has_surfaces || film_init_surfaces(f, &err));
    for (int i = 0; i < WIDTH * HEIGHT; i++) {
        int bits = (int)(check_random(&seed) * 65);
        int low = (int)(check_random(&seed) * 40);

        f->counts[i] = i % 7 == 0 ? 0 : 1 + word(&seed, 6);
        for (int c = 0; c < 3; c++) {
            f->sums[3 * i + c].lo = word(&seed, bits) >> low << low;
            f->sums[3 * i + c].hi = word(&seed, i / WIDTH * 16);
            f->odd_sums[3 * i + c].lo = word(&seed, 64);
        }
        if (has_surfaces) {
            f->surfaces[i].depth.lo = word(&seed, 60);
            f->surfaces[i].albedo[1] = (uint32_t)word(&seed, 32);
            f->surfaces[i].seen_count = (uint32_t)i;
        }
    }
}

static void check_pixel(const struct film *got, int x, const struct film *want,
                        int at)
{
    assert_int_equal(got->counts[x], want->counts[at]);
    if (want->counts[at] == 0) /* its sums are undefined */
        return;
    assert_memory_equal(got->sums + 3 * x, want->sums + 3 * at,
                        3 * sizeof *want->sums);
    assert_memory_equal(got->odd_sums + 3 * x, want->odd_sums + 3 * at,
                        3 * sizeof *want->sums);
    if (want->surfaces != NULL)
        assert_memory_equal(&got->surfaces[x], &want->surfaces[at],
                            sizeof *want->surfaces);
}

static void packed_rows_are_the_same(void **state)
{
    (void)state;
    for (int i = 0; i < 20; i++) {
        struct film film, row;
        struct error err = {""};
        size_t size;
        uint8_t *bytes;
        const uint8_t *p;

        make_film(&film, i % 2, (uint64_t)i + 1);
        assert_true(film_init(&row, WIDTH, 1, &err));
        assert_true(i % 2 == 0 || film_init_surfaces(&row, &err));
        bytes = film_pack(&film, 3, &size);
        assert_non_null(bytes);
        p = bytes + 3;
        for (int y = 0; y < HEIGHT; y++) {
            check_or_say(film_unpack_row(&row, &p, bytes + size, &err),
                         err.text);
            for (int x = 0; x < WIDTH; x++)
                check_pixel(&row, x, &film, y * WIDTH + x);
        }
        free(bytes);
        film_free(&row);
        film_free(&film);
    }
}

/* A film of 16 samples of a usual picture has less than half of its bytes. */
static void usual_sums_are_small(void **state)
{
    struct film film;
    struct error err;
    uint64_t seed = 5;
    size_t size;
    uint8_t *bytes;

    (void)state;
    assert_true(film_init(&film, WIDTH, HEIGHT, &err));
    for (int k = 0; k < 16; k++)
        for (int y = 0; y < HEIGHT; y++) {
            struct path_sample samples[WIDTH];
            int counts[WIDTH];

            for (int x = 0; x < WIDTH; x++) {
                float light = 0.01f + (float)check_random(&seed);

                samples[x] = (struct path_sample){.radiance = {light, light / 3,
                                                               light * 3},
                                                  .rays = 2};
                counts[x] = 1;
            }
            film_add_row(&film, (struct film_pixels){0, y, 1, WIDTH}, samples,
                         NULL, counts);
        }
    bytes = film_pack(&film, 0, &size);
    check_at_most((double)size / (WIDTH * HEIGHT), 45);
    free(bytes);
    film_free(&film);
}

static void damaged_bytes_are_refused(void **state)
{
    struct film film, row;
    struct error err = {""};
    size_t size;
    uint8_t *bytes;

    (void)state;
    make_film(&film, true, 9);
    assert_true(film_init(&row, WIDTH, 1, &err));
    assert_true(film_init_surfaces(&row, &err));
    bytes = film_pack(&film, 0, &size);
    for (size_t cut = 0; cut < size; cut += 3) {
        uint8_t *part = malloc(cut + 1); /* so that a sanitizer sees its end */
        const uint8_t *p = part;
        int rows = 0;

        memcpy(part, bytes, cut);
        while (rows < HEIGHT && film_unpack_row(&row, &p, part + cut, &err))
            rows++;
        assert_true(rows < HEIGHT);
        check_has(err.text, "found damaged rows of a film");
        free(part);
    }
    for (int i = 0; i < 256; i++) { /* any number of bytes left out */
        const uint8_t *p = bytes;

        bytes[0] = (uint8_t)i;
        if (!film_unpack_row(&row, &p, bytes + size, &err))
            assert_true(i > 0);
    }
    free(bytes);
    film_free(&row);
    film_free(&film);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(packed_rows_are_the_same),
        cmocka_unit_test(usual_sums_are_small),
        cmocka_unit_test(damaged_bytes_are_refused),
    };

    return cmocka_run_group_tests(tests, NULL, NULL);
}
