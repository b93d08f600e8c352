// SPDX-License-Identifier: MIT
/*
 * test_view_modes.c - pictures other than of light
 *
 * Pictures for files are traced through another tree and by another query than
 * drafts on the screen, and both must be equal. Depths and colours of a wall
 * are known.
 */
#include "tests/unit/check.h"

#include <limits.h>
#include <math.h>
#include <unistd.h>

#include "base/clock.h"
#include "base/file.h"
#include "film/film_error.h"
#include "inspect/false_color.h"
#include "inspect/view_modes.h"
#include "tests/unit/files.h"

#define WIDTH  48
#define HEIGHT 32

static struct options options;
static char root[PATH_MAX]; /* the repository */

static void open_scene(struct session *s, const char *path)
{
    struct error err;

    options_init(&options);
    options.scene_path = path;
    options.width_px = WIDTH;
    options.height_px = HEIGHT;
    options.thread_count = 1;
    check_or_say(session_open(s, &options, clock_ns(), &err), err.text);
}

/* Draws a draft of a render in live mode, as the screen does. */
static void draw_draft(struct session *s, struct view_mode *show,
                       struct frame *frame)
{
    struct film *film, *draft;
    struct error err;

    s->sample = view_mode_sample(show->kind);
    s->draft_width = WIDTH;
    s->draft_height = HEIGHT;
    check_or_say(session_restart(s, (struct render_limits){0}, &err), err.text);
    assert_true(render_wait(s->engine.render, 60000));
    film = render_film(s->engine.render);
    draft = render_draft(s->engine.render);
    assert_non_null(draft);
    view_mode_preview(show, film, draft, NULL, frame);
}

static void files_show_what_the_screen_shows(void **state)
{
    static const enum show_kind kinds[] = {SHOW_PREVIEW, SHOW_NORMALS,
                                           SHOW_FACES,   SHOW_UVS,
                                           SHOW_DEPTH,   SHOW_MATERIALS};
    struct session s;
    struct view_mode show;
    struct frame screen, picture;
    struct error err;
    char legend[sizeof show.legend], path[PATH_MAX + 32];

    (void)state;
    snprintf(path, sizeof path, "%s/scenes/interior.obj", root);
    open_scene(&s, path);
    view_mode_init(&show, &s);
    assert_true(frame_init(&screen, WIDTH, HEIGHT, &err));
    assert_true(frame_init(&picture, WIDTH, HEIGHT, &err));
    for (size_t i = 0; i < sizeof kinds / sizeof kinds[0]; i++) {
        assert_true(view_mode_set(&show, kinds[i], &err));
        draw_draft(&s, &show, &screen);
        strcpy(legend, show.legend);
        check_or_say(view_mode_picture(&show, NULL, &picture, &err), err.text);
        assert_memory_equal(screen.rgb, picture.rgb, 3 * WIDTH * HEIGHT);
        assert_string_equal(show.legend, legend);
    }
    frame_free(&screen);
    frame_free(&picture);
    view_mode_free(&show);
    session_close(&s);
}

/* A wall at z = 0 is seen from (0, 0, 5) with half a field of view of 20
 * degrees. The ray through the middle of pixel (x, y) is 5 sqrt(1 + u^2 + v^2)
 * long. */
static void depths_are_distances_along_the_ray(void **state)
{
    double top = tan(20 * 0.017453292519943295);
    double near = 5 * sqrt(1 + 2 * pow(top / HEIGHT, 2));
    double u = top * (WIDTH - 1) / HEIGHT, v = top * (HEIGHT - 1) / HEIGHT;
    char legend[128];
    struct session s;
    struct view_mode show;
    struct frame f;
    struct error err;

    (void)state;
    put("wall.obj", "v -20 -20 0\nv 20 -20 0\nv 20 20 0\nv -20 20 0\n"
                    "f 1 2 3 4\n");
    put("wall.view", "eye 0 0 5\nat 0 0 0\n");
    open_scene(&s, "wall.obj");
    view_mode_init(&show, &s);
    assert_true(frame_init(&f, WIDTH, HEIGHT, &err));
    assert_true(view_mode_set(&show, SHOW_DEPTH, &err));
    check_or_say(view_mode_picture(&show, NULL, &f, &err), err.text);
    snprintf(legend, sizeof legend, "DEPTH  from %.4g, white, to %.4g, dark",
             near, 5 * sqrt(1 + u * u + v * v));
    assert_string_equal(show.legend, legend);
    assert_int_equal(f.rgb[3 * (HEIGHT / 2 * WIDTH + WIDTH / 2)], 255);
    assert_int_equal(f.rgb[0], 38); /* 0.15 of white */
    assert_true(view_mode_set(&show, SHOW_NORMALS, &err));
    check_or_say(view_mode_picture(&show, NULL, &f, &err), err.text);
    for (int i = 0; i < 3 * WIDTH * HEIGHT; i++)
        assert_int_equal(f.rgb[i], i % 3 == 2 ? 255 : 128);
    frame_free(&f);
    view_mode_free(&show);
    session_close(&s);
}

static void render(struct session *s, uint64_t spp)
{
    struct error err;

    check_or_say(session_restart(s, (struct render_limits){.spp = spp}, &err),
                 err.text);
    assert_true(render_wait(s->engine.render, 60000));
}

/* Errors are those of film_error.h, in the colours of --error-map. With one
 * sample they are unknown, and light is shown. Both films have the same
 * numbers of samples when the view looks at them, but not the same samples. */
static void errors_are_those_of_the_film(void **state)
{
    static float map[WIDTH * HEIGHT];
    char path[PATH_MAX + 32];
    struct view_mode light, show;
    struct frame expected, f;
    struct session s;
    struct error err;

    (void)state;
    snprintf(path, sizeof path, "%s/scenes/cornell.obj", root);
    open_scene(&s, path);
    view_mode_init(&light, &s);
    view_mode_init(&show, &s);
    assert_true(frame_init(&expected, WIDTH, HEIGHT, &err));
    assert_true(frame_init(&f, WIDTH, HEIGHT, &err));
    assert_true(view_mode_set(&show, SHOW_ERROR, &err));
    render(&s, 1);
    view_mode_preview(&light, render_film(s.engine.render), NULL, NULL,
                      &expected);
    view_mode_preview(&show, render_film(s.engine.render), NULL, NULL, &f);
    assert_memory_equal(f.rgb, expected.rgb, 3 * WIDTH * HEIGHT);
    assert_string_equal(show.legend,
                        "ERROR  unknown until each pixel has two samples");
    for (int i = 0; i < 2; i++) {
        options.seed = (uint32_t)i;
        render(&s, 8);
        view_mode_preview(&show, render_film(s.engine.render), NULL, NULL, &f);
        assert_true(film_error_map(render_film(s.engine.render),
                                   session_develop(&s).exposure, NULL, map));
        for (int k = 0; k < WIDTH * HEIGHT; k++)
            frame_dot(&expected, k % WIDTH, k / WIDTH, error_map_color(map[k]));
        assert_memory_equal(f.rgb, expected.rgb, 3 * WIDTH * HEIGHT);
        assert_non_null(strstr(show.legend, "white 100 %; noise "));
    }
    frame_free(&f);
    frame_free(&expected);
    view_mode_free(&show);
    view_mode_free(&light);
    session_close(&s);
}

static int enter(void **state)
{
    return getcwd(root, sizeof root) != NULL ? enter_folder(state) : -1;
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(files_show_what_the_screen_shows),
        cmocka_unit_test(depths_are_distances_along_the_ray),
        cmocka_unit_test(errors_are_those_of_the_film),
    };

    return cmocka_run_group_tests(tests, enter, remove_folder);
}
