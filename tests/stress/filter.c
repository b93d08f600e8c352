// SPDX-License-Identifier: MIT
/*
 * filter - the error of filtered pictures against long renders
 *
 * usage: filter [SCENE...]
 *
 * The middle of each shipped scene, and of those in ../shared/scenes-bench or
 * $GLIM_SHARED/scenes-bench, is rendered at 4 to 4,096 samples, with as many in
 * each pixel and with the adaptive counts of --denoise, which begin after
 * ADAPTIVE_FIRST samples. The error of the filtered picture is never higher
 * than that of the unfiltered one, and its mean is the same. Over all scenes
 * the geometric mean of the gain is at least 15, 10 and 5 at 4, 16 and 64
 * samples. In a furnace, a room of radiance 1 in each direction, the filtered
 * mean is 1 within the standard error of the unfiltered one.
 *
 * The reference is the mean of two renders of REFERENCE_SPP samples. Its own
 * error, which their difference gives, is subtracted from both errors.
 */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "base/clock.h"
#include "base/thread_pool.h"
#include "film/filter/film_filter.h"
#include "rows.h"
#include "session/session.h"
#include "terminal/xmalloc.h"
#include "tests/unit/folder.h"

#include "kernels/sample_share.h"

#define WIDTH   96
#define HEIGHT  72
#define NUMBERS (3 * WIDTH * HEIGHT)

#define REFERENCE_SPP 2048

/* Largest change of the mean by the filter. */
#define MEAN_CHANGE 0.01

/* Standard errors within which the mean of a furnace is 1: one false alarm in
 * 1.7 million. */
#define FURNACE_ERRORS 5

static const uint64_t counts[] = {4, 16, 64, 256, 1024, 4096};
static const double least_gains[] = {15, 10, 5};

enum { COUNTS = sizeof counts / sizeof counts[0], MEANS = 3 };

/* Product of the gains of all scenes at each number of samples, uniform. */
static double products[COUNTS] = {1, 1, 1, 1, 1, 1};
static int scene_count;

static void stop(const struct error *err)
{
    fprintf(stderr, "filter: %s\n", err->text);
    exit(2);
}

/* Begins a render of the picture's middle and waits for its first samples. */
static void begin(struct session *s, uint64_t spp, uint32_t seed,
                  bool is_adaptive)
{
    struct render_job job = {
        .host = &s->engine.world,
        .crop = {(s->options->width_px - WIDTH) / 2,
                 (s->options->height_px - HEIGHT) / 2, WIDTH, HEIGHT},
        .limits.spp = spp,
        .is_adaptive = is_adaptive,
    };
    struct error err;

    if (!world_lend(&s->engine.world, &s->engine.scene, &s->edit.now.view, seed,
                    &job.world, &err))
        stop(&err);
    job.world.settings.features |= FEATURE_FILTER;
    if (!render_start(s->engine.render, &job, &err))
        stop(&err);
    render_wait(s->engine.render, -1);
}

/* Goes on to a number of samples. */
static void go_on(struct session *s, uint64_t spp)
{
    render_resume(s->engine.render, (struct render_limits){.spp = spp});
    render_wait(s->engine.render, -1);
}

static void filter(struct session *s, float *rgb)
{
    struct film to;
    struct error err;

    if (!film_filter_copy(render_film(s->engine.render), usable_threads(), &to,
                          &err))
        stop(&err);
    film_linear(&to, rgb);
    film_free(&to);
}

static double rel_mse(const float *a, const float *truth)
{
    double sum = 0;

    for (int i = 0; i < NUMBERS; i++)
        sum +=
            pow((double)a[i] - truth[i], 2) / (pow((double)truth[i], 2) + 0.01);
    return sum / NUMBERS;
}

static double mean_of(const float *rgb)
{
    double sum = 0;

    for (int i = 0; i < NUMBERS; i++)
        sum += rgb[i];
    return sum / NUMBERS;
}

/* Makes the reference and returns its own error. */
static double find_truth(struct session *s, float *truth)
{
    static float other[NUMBERS];
    double sum = 0;

    begin(s, REFERENCE_SPP, 101, false);
    film_linear(render_film(s->engine.render), truth);
    begin(s, REFERENCE_SPP, 102, false);
    film_linear(render_film(s->engine.render), other);
    for (int i = 0; i < NUMBERS; i++) {
        double half = ((double)truth[i] - other[i]) / 2;

        truth[i] = (float)((double)other[i] + half);
        sum += half * half / (pow((double)truth[i], 2) + 0.01);
    }
    return sum / NUMBERS;
}

/* Compares the render's picture, raw and filtered, with the truth. Returns the
 * gain. */
static double check_picture(struct session *s, const float *truth, double own,
                            int spp, const char *how)
{
    static float raw[NUMBERS], clean[NUMBERS];
    double before, after, change;

    film_linear(render_film(s->engine.render), raw);
    filter(s, clean);
    before = rel_mse(raw, truth) - own;
    after = rel_mse(clean, truth) - own;
    change = mean_of(clean) / mean_of(raw) - 1;
    row(after <= before && fabs(change) <= MEAN_CHANGE, "filter",
        "%s, %d spp%s: relMSE %.3g, filtered %.3g, own %.2g; mean %+.2f %%",
        s->options->scene_path, spp, how, before, after, own, 100 * change);
    /* below a tenth of the reference's own error the gain is not known */
    return before / fmax(after, own / 10);
}

static void open_scene(struct session *s, struct options *o)
{
    struct error err;

    if (!session_open(s, o, clock_ns(), &err))
        stop(&err);
}

static void check_scene(const char *path, int width, int height)
{
    static float truth[NUMBERS];
    struct options o = {.scene_path = path,
                        .max_bounces = -1,
                        .width_px = width,
                        .height_px = height};
    struct session s;
    double own;

    open_scene(&s, &o);
    own = find_truth(&s, truth);
    begin(&s, counts[0], 1, false);
    for (int i = 0; i < COUNTS; i++) {
        go_on(&s, counts[i]);
        products[i] *= check_picture(&s, truth, own, (int)counts[i], "");
    }
    begin(&s, ADAPTIVE_FIRST, 1, true);
    for (int i = 0; i < COUNTS; i++) {
        if (counts[i] <= ADAPTIVE_FIRST)
            continue;
        go_on(&s, counts[i]);
        check_picture(&s, truth, own, (int)counts[i], " adaptive");
    }
    scene_count++;
    session_close(&s);
}

/* Writes a text into the current folder. */
static void write_text(const char *name, const char *text)
{
    FILE *f = fopen(name, "w");

    if (f == NULL || fputs(text, f) < 0 || fclose(f) != 0) {
        fprintf(stderr, "filter: cannot write %s\n", name);
        exit(2);
    }
}

/* Returns the standard error of the mean of the unfiltered picture, from the
 * differences of its halves. */
static double standard_error(struct film *film)
{
    double sum = 0;

    for (size_t at = 0; at < WIDTH * HEIGHT; at++) {
        float mean[3], e[3];

        if (!film_pixel_error(film, at, mean, e))
            return INFINITY;
        /* channels of a pixel are correlated */
        sum += pow(((double)e[0] + (double)e[1] + (double)e[2]) / NUMBERS, 2);
    }
    return sqrt(sum);
}

/* A closed room that emits half of what it absorbs of radiance 1. */
static void check_furnace(void)
{
    struct options o = {.scene_path = "room.obj",
                        .max_bounces = 999,
                        .width_px = WIDTH,
                        .height_px = HEIGHT};
    struct session s;

    write_text("room.mtl", "newmtl room\nKd .5 .5 .5\nKe .5 .5 .5\n");
    write_text("room.obj",
               "mtllib room.mtl\nusemtl room\n"
               "v -1 -1 -1\nv 1 -1 -1\nv -1 1 -1\nv 1 1 -1\n"
               "v -1 -1 1\nv 1 -1 1\nv -1 1 1\nv 1 1 1\n"
               "f 1 3 4 2\nf 5 6 8 7\nf 1 2 6 5\nf 3 7 8 4\nf 1 5 7 3\n"
               "f 2 4 8 6\n");
    write_text("room.view", "eye 0 0 .9\nat .3 .2 -1\nfovy 60\n");
    open_scene(&s, &o);
    for (int adaptive = 0; adaptive < 2; adaptive++) {
        begin(&s, 4, 1, adaptive);
        for (int i = 0; i < COUNTS - 1; i++) {
            static float clean[NUMBERS];
            double error;

            go_on(&s, counts[i]);
            filter(&s, clean);
            error = standard_error(render_film(s.engine.render));
            row(fabs(mean_of(clean) - 1) <= FURNACE_ERRORS * error, "filter",
                "furnace, %d spp%s: mean %.6f, standard error %.2g",
                (int)counts[i], adaptive ? " adaptive" : "", mean_of(clean),
                error);
        }
    }
    session_close(&s);
}

static void check_bench_scenes(void)
{
    static const char *const names[] = {"cornell", "many_lights", "sky"};
    const char *root = getenv("GLIM_SHARED");

    for (size_t i = 0; i < sizeof names / sizeof names[0]; i++) {
        char *path =
            xformat("%s/scenes-bench/%s/%s.obj",
                    root != NULL ? root : "../shared", names[i], names[i]);

        if (access(path, R_OK) == 0)
            check_scene(path, 256, 256);
        else
            printf("skip filter: no %s\n", path);
        free(path);
    }
}

static void check_gains(void)
{
    for (int i = 0; i < MEANS; i++) {
        double gain = pow(products[i], 1.0 / scene_count);

        row(gain >= least_gains[i], "filter",
            "geometric mean of the gain at %d spp: %.1f, at least %g",
            (int)counts[i], gain, least_gains[i]);
    }
}

int main(int argc, char **argv)
{
    static const char *const all[] = {"scenes/cornell.obj",
                                      "scenes/skylit.obj",
                                      "scenes/glass_mirror.obj",
                                      "scenes/interior.obj",
                                      "scenes/materials.obj",
                                      "scenes/lights200.obj",
                                      "scenes/principled.obj"};

    if (argc > 1) {
        for (int i = 1; i < argc; i++)
            check_scene(argv[i], 640, 360);
        return rows_status();
    }
    for (size_t i = 0; i < sizeof all / sizeof all[0]; i++)
        check_scene(all[i], 640, 360);
    check_bench_scenes();
    check_gains();
    if (enter_folder(NULL) != 0)
        return 2;
    check_furnace();
    return remove_folder(NULL) == 0 ? rows_status() : 2;
}
