// SPDX-License-Identifier: MIT
/*
 * checks.c - tests of what glim.h promises, in a program that has only that
 *
 * usage: checks SCENE FILM...: prints a line for each failure, then
 * "api: N passed, N failed". The films are shares of 8 samples of 32 x 24
 * pixels, and joined.png becomes their picture; saved.film has 3 samples.
 */
#include <math.h>
#include <pthread.h>
#include <signal.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <glim/glim.h>

#define WIDTH  32
#define HEIGHT 24
#define BYTES  (3 * WIDTH * HEIGHT)

static int passed, failed;
static const char *scene_path;

static void check(bool is_good, const char *what)
{
    if (is_good)
        passed++;
    else
        failed++;
    if (!is_good)
        printf("FAILED: %s\n", what);
}

/* The call has failed with a text that contains `part`. */
static void check_error(bool ok, const struct glim_error *err, const char *part)
{
    bool is_good = !ok && strstr(err->text, part) != NULL;

    check(is_good, part);
    if (!is_good)
        printf("    found: %s\n", ok ? "no error" : err->text);
}

static struct glim *open_small(void)
{
    struct glim_error err;
    struct glim *g = glim_open(scene_path, NULL, &err);

    if (g == NULL || !glim_set_size(g, WIDTH, HEIGHT, &err)) {
        printf("%s\n", err.text);
        exit(1);
    }
    return g;
}

static void check_wrong_values(void)
{
    struct glim_error err;
    struct glim *g = open_small();

    check_error(glim_open("nowhere/none.obj", NULL, &err) != NULL, &err,
                "none.obj: no such file");
    check(glim_open("nowhere/none.obj", NULL, NULL) == NULL,
          "an error without a place for its text");
    check_error(glim_open(scene_path,
                          &(struct glim_open_options){.threads = -1},
                          &err) != NULL,
                &err, "found -1");
    check_error(glim_set_size(g, 0, 0, &err), &err, "found 0x0");
    check_error(glim_set_size(g, 65537, 5, &err), &err, "found 65537x5");
    check_error(glim_set_crop(g, 30, 0, 3, 1, &err), &err, "30,0,3,1");
    check_error(glim_set_crop(g, 0, 0, 2147483647, 1, &err), &err, "crop");
    check_error(glim_set_threads(g, -1, &err), &err, "found -1");
    check_error(glim_set_max_bounces(g, -2, &err), &err, "found -2");
    glim_close(g);
    glim_close(NULL);
}

/* A NULL that glim.h does not allow, as a handle. */
static void check_no_handle(void)
{
    struct glim_error err;
    struct glim_camera camera = glim_get_camera(NULL);
    const char *path = "none.film";
    float rgb[3];
    int width = 1, height = 1;

    check_error(glim_set_camera(NULL, &camera, &err), &err,
                "handle: found NULL");
    check_error(glim_set_size(NULL, 1, 1, &err), &err, "handle: found NULL");
    check_error(glim_set_crop(NULL, 0, 0, 1, 1, &err), &err,
                "handle: found NULL");
    check_error(glim_set_max_bounces(NULL, 1, &err), &err,
                "handle: found NULL");
    check_error(glim_set_threads(NULL, 1, &err), &err, "handle: found NULL");
    check_error(glim_set_backend(NULL, GLIM_BACKEND_CPU, NULL, &err), &err,
                "handle: found NULL");
    check_error(glim_set_error_limit(NULL, 0, &err), &err,
                "handle: found NULL");
    check_error(glim_set_denoise(NULL, true, &err), &err, "handle: found NULL");
    check_error(glim_render(NULL, 1, 0, NULL, NULL, &err) != GLIM_FAILED, &err,
                "handle: found NULL");
    check_error(glim_read_floats(NULL, rgb, 3, &err), &err,
                "handle: found NULL");
    check_error(glim_save(NULL, "a.png", &err), &err, "handle: found NULL");
    check_error(glim_save_film(NULL, path, &err), &err, "handle: found NULL");
    check_error(glim_load_films(NULL, &path, 1, &err), &err,
                "handle: found NULL");
    check(camera.fovy_deg == 0, "the camera of no handle");
    check(glim_get_progress(NULL).samples == 0, "the progress of no handle");
    check(!glim_is_denoised(NULL) && glim_warning(NULL, 0) == NULL &&
              glim_file(NULL, 0) == NULL && glim_backend_log(NULL) == NULL,
          "the texts of no handle");
    glim_get_size(NULL, &width, &height);
    check(width == 0 && height == 0, "the size of no handle");
    width = height = 1;
    glim_get_picture_size(NULL, &width, &height);
    check(width == 0 && height == 0, "the picture of no handle");
    glim_set_seed(NULL, 1);
    glim_set_adaptive(NULL, true);
    glim_cancel(NULL);
    glim_close(NULL);
}

static void check_null_names(void)
{
    struct glim_error err;
    struct glim *g = open_small();
    const char *paths[2] = {"saved.film", NULL};

    check_error(glim_open(NULL, NULL, &err) != NULL, &err, "scene: found NULL");
    check_error(glim_set_camera(g, NULL, &err), &err, "camera: found NULL");
    check(glim_render(g, 1, 0, NULL, NULL, NULL) == GLIM_DONE, "a sample");
    check_error(glim_read_floats(g, NULL, BYTES, &err), &err,
                "picture: found NULL");
    check_error(glim_read_bytes(g, NULL, BYTES, &err), &err,
                "picture: found NULL");
    check_error(glim_save(g, NULL, &err), &err, "file: found NULL");
    check_error(glim_save_new(g, NULL, &err) != NULL, &err, "file: found NULL");
    check_error(glim_save_film(g, NULL, &err), &err, "film: found NULL");
    check_error(glim_load_films(g, NULL, 1, &err), &err, "films: found NULL");
    check_error(glim_load_films(g, paths, 2, &err), &err, "films: found NULL");
    check(glim_get_progress(g).spp == 1, "the picture stays");
    glim_get_size(g, NULL, NULL);
    glim_get_picture_size(g, NULL, NULL);
    glim_close(g);
}

/* Numbers that are none, and values that an enumeration lacks. */
static void check_no_numbers(void)
{
    struct glim_error err;
    struct glim *g = open_small();
    struct glim_sun sun = {NAN, NAN};
    struct glim_open_options o = {.up = (enum glim_up)99};

    check_error(glim_open(scene_path, &o, &err) != NULL, &err,
                "up: found 99, expected 0 to 2");
    o.up = (enum glim_up) - 1;
    check_error(glim_open(scene_path, &o, &err) != NULL, &err,
                "up: found -1, expected 0 to 2");
    o = (struct glim_open_options){.has_anim_time = true, .anim_time_s = NAN};
    check_error(glim_open(scene_path, &o, &err) != NULL, &err, "nan s");
    o = (struct glim_open_options){.sun = &sun};
    check_error(glim_open(scene_path, &o, &err) != NULL, &err, "nan");
    o = (struct glim_open_options){.turbidity = NAN};
    check_error(glim_open(scene_path, &o, &err) != NULL, &err, "nan");
    check_error(glim_set_backend(g, (enum glim_backend)77, NULL, &err), &err,
                "backend: found 77, expected 0 to 2");
    check_error(glim_set_error_limit(g, NAN, &err), &err, "nan");
    check_error(glim_render(g, 0, NAN, NULL, NULL, &err) != GLIM_FAILED, &err,
                "seconds: found nan, expected a number from 0 on");
    check_error(glim_render(g, 0, -1, NULL, NULL, &err) != GLIM_FAILED, &err,
                "seconds: found -1, expected a number from 0 on");
    check(glim_render(g, 1, INFINITY, NULL, NULL, NULL) == GLIM_DONE,
          "no limit of time");
    glim_close(g);
}

static void check_wrong_cameras(void)
{
    struct glim_error err;
    struct glim *g = open_small();
    struct glim_camera camera = glim_get_camera(g);

    camera.fovy_deg = 180;
    check_error(glim_set_camera(g, &camera, &err), &err, "fovy");
    camera = glim_get_camera(g);
    memcpy(camera.at, camera.eye, sizeof camera.at);
    check_error(glim_set_camera(g, &camera, &err), &err, "one point");
    camera.eye[0] = NAN;
    check_error(glim_set_camera(g, &camera, &err), &err, "infinity");
    camera = glim_get_camera(g);
    camera.aperture = -1;
    check_error(glim_set_camera(g, &camera, &err), &err, "aperture");
    glim_close(g);
}

static void check_wrong_reads(void)
{
    struct glim_error err;
    struct glim *g = open_small();
    float rgb[3];

    check_error(glim_read_floats(g, rgb, 3, &err), &err, "glim_render()");
    check_error(glim_save(g, "none.png", &err), &err, "glim_render()");
    check(glim_render(g, 1, 0, NULL, NULL, NULL) == GLIM_DONE, "a sample");
    check_error(glim_read_floats(g, rgb, 3, &err), &err, "expected 2304");
    check_error(glim_save(g, "picture.gif", &err), &err, ".png");
    check_error(glim_save(g, "nowhere/x.png", &err), &err, "no such");
    glim_close(g);
}

/* A picture that is rendered in parts equals the one that is rendered at once.
 */
static void check_parts(void)
{
    struct glim *a = open_small(), *b = open_small();
    uint8_t of_a[BYTES], of_b[BYTES];

    check(glim_render(a, 4, 0, NULL, NULL, NULL) == GLIM_DONE, "all");
    check(glim_render(b, 1, 0, NULL, NULL, NULL) == GLIM_DONE, "a part");
    check(glim_render(b, 4, 0, NULL, NULL, NULL) == GLIM_DONE, "the rest");
    check(glim_get_progress(b).spp == 4, "4 samples a pixel");
    check(glim_read_bytes(a, of_a, BYTES, NULL), "bytes");
    check(glim_read_bytes(b, of_b, BYTES, NULL), "bytes");
    check(memcmp(of_a, of_b, BYTES) == 0, "the same picture in parts");
    glim_set_seed(b, 1);
    check(glim_get_progress(b).samples == 0, "no picture after a setting");
    check(glim_render(b, 4, 0, NULL, NULL, NULL) == GLIM_DONE, "another seed");
    check(glim_read_bytes(b, of_b, BYTES, NULL), "bytes");
    check(memcmp(of_a, of_b, BYTES) != 0, "another seed has other noise");
    glim_close(a);
    glim_close(b);
}

static bool stop_at_once(void *context, const struct glim_progress *p)
{
    (void)p;
    ++*(int *)context;
    return false;
}

static void check_stops(void)
{
    struct glim *g = open_small();
    int calls = 0;

    check(glim_render(g, 0, 0, stop_at_once, &calls, NULL) == GLIM_STOPPED,
          "stopped by the function");
    check(calls == 1, "one call");
    glim_cancel(g);
    check(glim_render(g, 0, 0, NULL, NULL, NULL) == GLIM_STOPPED,
          "cancelled before it began");
    check(glim_render(g, 0, 0.05, NULL, NULL, NULL) == GLIM_DONE,
          "a limit of time");
    check(glim_get_progress(g).samples > 0, "samples within that time");
    glim_close(g);
}

static bool save_progress(void *context, const struct glim_progress *p)
{
    *(struct glim_progress *)context = *p;
    return true;
}

/* The error ends a render, and the progress says so. */
static void check_limits(void)
{
    struct glim *g = open_small();
    struct glim_progress p, during = {.spp = 0};
    struct glim_error err;

    check_error(glim_set_error_limit(g, -0.1, &err), &err, "found -0.1");
    check_error(glim_set_error_limit(g, NAN, &err), &err, "expected 0 to 1");
    check(glim_render(g, 4, 0, NULL, NULL, NULL) == GLIM_DONE, "4 samples");
    p = glim_get_progress(g);
    check(p.limit == GLIM_LIMIT_SPP && p.part_done == 1 && p.seconds_left == 0,
          "samples as the limit");
    check(p.error_is_known && p.error_low <= p.error &&
              p.error <= p.error_high && p.error > 0.02,
          "an error with its interval");
    check(glim_set_error_limit(g, 0.05, &err), "a limit of the error");
    check(glim_get_progress(g).spp == 4, "the picture stays");
    check(glim_render(g, 0, 0, save_progress, &during, NULL) == GLIM_DONE,
          "up to the error");
    check(during.limit == GLIM_LIMIT_ERROR || during.limit == GLIM_LIMIT_NONE,
          "the error as the nearest limit");
    p = glim_get_progress(g);
    check(p.limit == GLIM_LIMIT_ERROR && p.error_high <= 0.05 && p.spp > 4,
          "the error as the limit");
    check(glim_render(g, 0, 0, NULL, NULL, NULL) == GLIM_DONE, "done already");
    check(glim_get_progress(g).spp == p.spp, "no more samples");
    check(glim_set_error_limit(g, 0, &err), "no limit of the error");
    check(glim_render(g, 0, 0.02, NULL, NULL, NULL) == GLIM_DONE, "0.02 s");
    check(glim_get_progress(g).limit == GLIM_LIMIT_SECONDS,
          "the time as the limit");
    glim_close(g);
}

/* A film that was saved in a progress function and loaded goes on to the
 * picture of a render at once. */
static bool save_film(void *context, const struct glim_progress *p)
{
    struct glim *g = context;

    if (p->samples > 0)
        check(glim_save_film(g, "part.film", NULL), "a film in between");
    return p->samples == 0;
}

static void check_films(const char *const *shares, int count)
{
    static const char *const saved[] = {"saved.film"}, *const part[] = {
                                                           "part.film"};
    struct glim *a = open_small(), *b = open_small();
    uint8_t of_a[BYTES], of_b[BYTES];
    struct glim_error err;

    check_error(glim_save_film(a, "saved.film", &err), &err, "glim_render()");
    check_error(glim_load_films(a, saved, 0, &err), &err, "found 0");
    check(glim_render(a, 3, 0, NULL, NULL, NULL) == GLIM_DONE, "3 samples");
    check(glim_save_film(a, "saved.film", &err), "a film");
    check_error(glim_save_film(a, "nowhere/x.film", &err), &err, "no such");
    check(glim_render(b, 0, 0, save_film, b, NULL) == GLIM_STOPPED, "stopped");
    for (int i = 0; i < 3; i++) {
        struct glim *c = open_small();
        uint64_t spp;

        check(i == 2 ? glim_load_films(c, shares, count, &err)
                     : glim_load_films(c, i == 0 ? saved : part, 1, &err),
              "films are loaded");
        check(i > 0 || glim_get_progress(c).spp == 3, "3 samples are loaded");
        if (i == 2)
            check(glim_save(c, "joined.png", &err), "a joined picture");
        /* some pixels of a film in between have more samples */
        spp = glim_get_progress(c).spp + 200;
        glim_set_seed(a, 0);
        check(glim_render(a, spp, 0, NULL, NULL, NULL) == GLIM_DONE, "at once");
        check(glim_render(c, spp, 0, NULL, NULL, NULL) == GLIM_DONE,
              "the rest");
        check(glim_read_bytes(a, of_a, BYTES, NULL), "bytes");
        check(glim_read_bytes(c, of_b, BYTES, NULL), "bytes");
        check(memcmp(of_a, of_b, BYTES) == 0, "a film goes on");
        glim_close(c);
    }
    check_error(glim_load_films(a, shares + 1, count - 1, &err), &err,
                "a part of the samples");
    check(glim_get_progress(a).spp == 208, "the picture stays");
    glim_set_seed(a, 4);
    check_error(glim_load_films(a, saved, 1, &err), &err, "seed");
    check_error(glim_load_films(a, &scene_path, 1, &err), &err, "another kind");
    glim_close(a);
    glim_close(b);
}

static void *render_in_thread(void *rgb)
{
    struct glim *g = open_small();

    glim_render(g, 4, 0, NULL, NULL, NULL);
    glim_read_bytes(g, rgb, BYTES, NULL);
    glim_close(g);
    return NULL;
}

static void check_threads(void)
{
    static uint8_t rgb[4][BYTES];
    pthread_t threads[4];

    for (int i = 0; i < 4; i++)
        pthread_create(&threads[i], NULL, render_in_thread, rgb[i]);
    for (int i = 0; i < 4; i++)
        pthread_join(threads[i], NULL);
    for (int i = 1; i < 4; i++)
        check(memcmp(rgb[0], rgb[i], BYTES) == 0,
              "the same picture in four threads");
}

/* Without the program that tries devices, the CPU renders. */
static void check_device(void)
{
    struct glim_error err;
    struct glim *g =
        glim_open(scene_path,
                  &(struct glim_open_options){.program = "/nowhere/glim"},
                  &err);

    check(g != NULL && glim_set_size(g, WIDTH, HEIGHT, &err), "a program");
    check_error(glim_set_backend(g, GLIM_BACKEND_OPENCL, NULL, &err), &err,
                "/nowhere/glim");
    check(glim_render(g, 1, 0, NULL, NULL, NULL) == GLIM_DONE,
          "the CPU instead");
    glim_close(g);
}

static void on_signal(int number)
{
    (void)number;
}

/* The handlers of signals stay the program's. */
static void check_signals(void)
{
    static const int numbers[] = {SIGINT, SIGPIPE, SIGFPE, SIGCHLD};
    struct glim *g;

    for (int i = 0; i < 4; i++)
        signal(numbers[i], on_signal);
    g = open_small();
    check(glim_render(g, 1, 0, NULL, NULL, NULL) == GLIM_DONE, "a sample");
    glim_close(g);
    for (int i = 0; i < 4; i++)
        check(signal(numbers[i], SIG_DFL) == on_signal, "a handler stays");
}

int main(int argc, char **argv)
{
    if (argc < 3)
        return 2;
    scene_path = argv[1];
    check(strcmp(glim_version(), GLIM_VERSION) == 0, "one version");
    check_wrong_values();
    check_no_handle();
    check_null_names();
    check_no_numbers();
    check_wrong_cameras();
    check_wrong_reads();
    check_parts();
    check_stops();
    check_limits();
    check_films((const char *const *)argv + 2, argc - 2);
    check_threads();
    check_device();
    check_signals();
    printf("api: %d passed, %d failed\n", passed, failed);
    return failed > 0;
}
