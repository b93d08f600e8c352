// SPDX-License-Identifier: MIT
#include "tests/unit/check.h"

#include <stdlib.h>

#include "film/film.h"
#include "terminal/ansi_diff.h"

/* Makes a film of 4x4 pixels: the upper half is red of radiance 1, the lower
 * half green of 0.5, which is 188 in sRGB (IEC 61966-2-1) at exposure 0. */
static struct film make_film(void)
{
    struct film film;
    struct error err;
    const int counts[4] = {1, 1, 1, 1};

    assert_true(film_init(&film, 4, 4, &err));
    for (int y = 0; y < 4; y++) {
        struct path_sample samples[4] = {0};

        for (int x = 0; x < 4; x++)
            samples[x].radiance =
                (struct vec3){y < 2, y < 2 ? 0.0f : 0.5f, 0.0f};
        film_add_row(&film, (struct film_pixels){0, y, 1, 4}, samples, NULL,
                     counts);
    }
    return film;
}

static void check_text(const struct ansi_text_style *style,
                       const char *expected)
{
    struct film film = make_film();
    struct frame frame;
    struct error err;
    size_t size_bytes;
    char *text;

    assert_true(ansi_text_frame_init(&frame, style, &err));
    film_preview(&film, NULL, develop_linear(0), &frame);
    assert_true(ansi_text_of_frame(&frame, style, &text, &size_bytes, &err));
    frame_free(&frame);
    assert_int_equal(size_bytes, strlen(expected));
    assert_memory_equal(text, expected, size_bytes);
    free(text);
    film_free(&film);
}

static void text_shows_the_film(void **state)
{
    (void)state;
    check_text(&(struct ansi_text_style){2, 2, PALETTE_24BIT, GLYPHS_HALF},
               "\033[48;2;255;0;0m  \033[m\n\033[48;2;0;188;0m  \033[m\n");
    check_text(&(struct ansi_text_style){2, 1, PALETTE_24BIT, GLYPHS_HALF},
               "\033[38;2;0;188;0;48;2;255;0;0m\xe2\x96\x84\xe2\x96\x84"
               "\033[m\n");
    /* Green is the lighter colour. */
    check_text(&(struct ansi_text_style){1, 1, PALETTE_24BIT, GLYPHS_BLOCK},
               "\033[38;2;0;188;0;48;2;255;0;0m\xe2\x96\x84\033[m\n");
    /* (180, 133, 0) is brighter than both halves, the brightest of the frame.
     */
    check_text(&(struct ansi_text_style){2, 1, PALETTE_MONO, GLYPHS_HALF},
               "@@\n");
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(text_shows_the_film),
    };

    return cmocka_run_group_tests(tests, NULL, NULL);
}
