// SPDX-License-Identifier: MIT
/*
 * written_films.h - films for tests of image_write(), and checks of the files
 *
 * Ownership: the caller frees films with film_free(), texts with free()
 * Threads:   one
 * Errors:    a failed check ends the test
 */
#ifndef TESTS_WRITTEN_FILMS_H
#define TESTS_WRITTEN_FILMS_H

#include <stdlib.h>

#include "base/file.h"
#include "film/image_write.h"
#include "image/stb.h"
#include "tests/unit/check.h"

#define WIDTH  37
#define HEIGHT 23

/* Makes a film of one sample per pixel; `value` returns the channels of a
 * pixel. */
static inline void make_film(struct film *film, int width, int height,
                             float (*value)(int x, int y, int c))
{
    struct error err;
    struct path_sample *samples = calloc((size_t)width, sizeof *samples);
    int *counts = calloc((size_t)width, sizeof *counts);

    assert_non_null(samples);
    assert_non_null(counts);
    assert_true(film_init(film, width, height, &err));
    for (int y = 0; y < height; y++) {
        for (int x = 0; x < width; x++) {
            samples[x].radiance =
                (struct vec3){value(x, y, 0), value(x, y, 1), value(x, y, 2)};
            counts[x] = 1;
        }
        film_add_row(film, (struct film_pixels){0, y, 1, width}, samples, NULL,
                     counts);
    }
    free(samples);
    free(counts);
}

static inline float light(int x, int y, int c)
{
    return (float)((x * 31 + y * 57 + c * 11) % 97) / 97;
}

static inline char *read_file(const char *path, size_t *size_bytes)
{
    struct error err;
    char *text;

    assert_true(file_read(path, &text, size_bytes, &err));
    return text;
}

/* Checks that the PNG file has the bytes of the frame. */
static inline void has_bytes(const char *path, const struct frame *expected)
{
    int width, height, channels;
    size_t size;
    char *text = read_file(path, &size);

    stb_limit((size_t)1 << 30);
    stbi_uc *rgb = stbi_load_from_memory((stbi_uc *)text, (int)size, &width,
                                         &height, &channels, 0);
    free(text);
    assert_non_null(rgb);
    assert_int_equal(width, expected->width);
    assert_int_equal(height, expected->height);
    assert_int_equal(channels, 3);
    assert_memory_equal(rgb, expected->rgb, (size_t)width * (size_t)height * 3);
    free(rgb);
}

#endif
