// SPDX-License-Identifier: MIT
/*
 * filter - the error of filtered pictures against long renders
 *
 * usage: filter [SCENE...]
 *
 * The middle of each shipped scene is rendered at 4 to 4,096 samples. The error
 * of the filtered picture is never higher than that of the unfiltered one, and
 * its mean is the same. Over the six scenes the geometric mean of the gain is
 * at least 15, 10 and 5 at 4, 16 and 64 samples.
 *
 * The reference is the mean of two renders of REFERENCE_SPP samples. Its own
 * error, which their difference gives, is subtracted from both errors.
 */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "base/clock.h"
#include "base/thread.h"
#include "filter/film_filter.h"
#include "session/session.h"
#include "tests/bench/render_crop.h"
#include "rows.h"

#define WIDTH   96
#define HEIGHT  72
#define NUMBERS (3 * WIDTH * HEIGHT)

#define REFERENCE_SPP 2048

/* Largest change of the mean by the filter. */
#define MEAN_CHANGE 0.01

static const uint64_t counts[] = {4, 16, 64, 256, 1024, 4096};
static const double least_gains[] = {15, 10, 5};

enum { COUNTS = sizeof counts / sizeof counts[0], MEANS = 3 };

/* Product of the gains of all scenes at each number of samples. */
static double products[COUNTS] = {1, 1, 1, 1, 1, 1};
static int scene_count;

static void stop(const struct error *err)
{
    fprintf(stderr, "filter: %s\n", err->text);
    exit(2);
}

/* Renders the crop and copies its light. Samples and seeds are those given. */
static void render(struct session *s, uint64_t spp, uint32_t seed, float *rgb)
{
    struct rect crop = {272, 144, WIDTH, HEIGHT};
    struct error err;

    if (!render_crop(s, crop, spp, seed, FEATURE_FILTER, &err))
        stop(&err);
    film_linear(render_film(s->render), rgb);
}

static void filter(struct session *s, float *rgb)
{
    struct film to;
    struct error err;

    if (!film_filter_copy(render_film(s->render), usable_threads(), &to, &err))
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

    render(s, REFERENCE_SPP, 101, truth);
    render(s, REFERENCE_SPP, 102, other);
    for (int i = 0; i < NUMBERS; i++) {
        double half = ((double)truth[i] - other[i]) / 2;

        truth[i] = (float)((double)other[i] + half);
        sum += half * half / (pow((double)truth[i], 2) + 0.01);
    }
    return sum / NUMBERS;
}

static void check_scene(const char *path)
{
    static float truth[NUMBERS], raw[NUMBERS], clean[NUMBERS];
    struct options o = {.scene_path = path,
                        .max_bounces = -1,
                        .width_px = 640,
                        .height_px = 360};
    struct session s;
    struct error err;
    double own;

    if (!session_open(&s, &o, clock_ns(), &err))
        stop(&err);
    own = find_truth(&s, truth);
    for (int i = 0; i < COUNTS; i++) {
        double before, after, change;

        render(&s, counts[i], 1, raw);
        filter(&s, clean);
        before = rel_mse(raw, truth) - own;
        after = rel_mse(clean, truth) - own;
        change = mean_of(clean) / mean_of(raw) - 1;
        row(after <= before && fabs(change) <= MEAN_CHANGE, "filter",
            "%s, %d spp: relMSE %.3g, filtered %.3g, own %.2g; mean %+.2f %%",
            path, (int)counts[i], before, after, own, 100 * change);
        /* below a tenth of the reference's own error the gain is not known */
        products[i] *= before / fmax(after, own / 10);
    }
    scene_count++;
    session_close(&s);
}

int main(int argc, char **argv)
{
    static const char *const all[] = {"scenes/cornell.obj",
                                      "scenes/skylit.obj",
                                      "scenes/glass_mirror.obj",
                                      "scenes/interior.obj",
                                      "scenes/materials.obj",
                                      "scenes/lights200.obj"};

    if (argc > 1) {
        for (int i = 1; i < argc; i++)
            check_scene(argv[i]);
        return rows_status();
    }
    for (size_t i = 0; i < sizeof all / sizeof all[0]; i++)
        check_scene(all[i]);
    for (int i = 0; i < MEANS; i++) {
        double gain = pow(products[i], 1.0 / scene_count);

        row(gain >= least_gains[i], "filter",
            "geometric mean of the gain at %d spp: %.1f, at least %g",
            (int)counts[i], gain, least_gains[i]);
    }
    return rows_status();
}
