// SPDX-License-Identifier: MIT
/*
 * test_truth_media.c - media against the values of ../shared/truth-media, which
 * are closed forms, quadrature, Chandrasekhar's H functions and adding-doubling
 *
 * The values are not in this repository; without them the test is skipped.
 */
#include <math.h>
#include <string.h>

#include <jansson.h>

#include "base/memory.h"
#include "glim/glim.h"
#include "tests/unit/shared.h"

#define SEEDS 64

/* Student's t with 63 degrees of freedom exceeds this once in 1e6 (two-sided).
 * There are 29 values of 3 channels: one false alarm in 11,000 choices of
 * seeds. The seeds are fixed. */
#define T_LIMIT 5.43

/* Standard errors must be below this part of the value, or any picture would
 * do. */
#define PRECISION 0.008

/* Samples of one seed, of all pixels of the region together: paths of one
 * vertex near a lamp, those of which few come through a grid, and others. */
#define SAMPLES_SINGLE 6144
#define SAMPLES_GRID   16384
#define SAMPLES        1024

struct estimate {
    double mean[3], error[3];
};

static void region_mean(struct glim *g, uint64_t spp, int pixels,
                        double mean[3])
{
    float *rgb = calloc((size_t)pixels, 3 * sizeof *rgb);
    struct glim_error err;

    assert_non_null(rgb);
    check_or_say(glim_render(g, spp, 0, NULL, NULL, &err) == GLIM_DONE,
                 err.text);
    check_or_say(glim_read_floats(g, rgb, 3 * (size_t)pixels, &err), err.text);
    assert_int_equal(glim_get_progress(g).non_finite, 0);
    for (int k = 0; k < 3; k++) {
        mean[k] = 0;
        for (int i = 0; i < pixels; i++)
            mean[k] += (double)rgb[3 * i + k] / pixels;
    }
    free(rgb);
}

/* Returns the mean of the region over independent seeds. */
static struct estimate estimate(struct glim *g, int samples, int pixels)
{
    uint64_t spp = (uint64_t)(samples + pixels - 1) / (uint64_t)pixels;
    struct estimate e = {{0}, {0}};

    for (uint32_t seed = 1; seed <= SEEDS; seed++) {
        double mean[3];

        glim_set_seed(g, seed);
        region_mean(g, spp, pixels, mean);
        for (int k = 0; k < 3; k++) {
            e.mean[k] += mean[k] / SEEDS;
            e.error[k] += mean[k] * mean[k] / SEEDS;
        }
    }
    for (int k = 0; k < 3; k++)
        e.error[k] =
            sqrt(fmax(e.error[k] - e.mean[k] * e.mean[k], 0) / (SEEDS - 1));
    return e;
}

static double number(const json_t *value, const char *key)
{
    return json_number_value(json_object_get(value, key));
}

static const char *text(const json_t *value, const char *key)
{
    return json_string_value(json_object_get(value, key));
}

static struct glim *open_value(const char *folder, const json_t *value,
                               int *pixels)
{
    char *scene = format_text("%s/%s", folder, text(value, "obj"));
    char *view = format_text("%s/%s", folder, text(value, "cam_file"));
    struct glim_open_options options = {.view_path = view, .threads = 1};
    struct glim_error err;
    struct glim *g = glim_open(scene, &options, &err);
    int region[4];

    check_or_say(g != NULL, err.text);
    assert_null(glim_warning(g, 0));
    for (size_t i = 0; i < 4; i++)
        region[i] = (int)json_integer_value(
            json_array_get(json_object_get(value, "region"), i));
    *pixels = (region[2] - region[0]) * (region[3] - region[1]);
    check_or_say(glim_set_crop(g, region[0], region[1], region[2] - region[0],
                               region[3] - region[1], &err),
                 err.text);
    free(scene);
    free(view);
    return g;
}

/* Returns false, with a line for each channel that misses its value. */
static bool check_value(const char *folder, const json_t *value)
{
    double systematic = number(value, "rel_tol") + number(value, "truth_err");
    const char *group = text(value, "group");
    int samples = strcmp(group, "single") == 0 ? SAMPLES_SINGLE
                  : strcmp(group, "grid") == 0 ? SAMPLES_GRID
                                               : SAMPLES;
    int pixels;
    struct glim *g = open_value(folder, value, &pixels);
    struct estimate e = estimate(g, samples, pixels);
    bool ok = true;

    for (size_t k = 0; k < 3; k++) {
        double want = json_number_value(
            json_array_get(json_object_get(value, "expected"), k));
        double miss = fabs(e.mean[k] - want);
        double allowed = T_LIMIT * e.error[k] + systematic * want;

        if (miss <= allowed && e.error[k] <= PRECISION * want)
            continue;
        print_error("%s, channel %zu: got %.6g, want %.6g, off by %.2g, "
                    "allowed %.2g; standard error %.2g\n",
                    text(value, "id"), k, e.mean[k], want, miss, allowed,
                    e.error[k]);
        ok = false;
    }
    glim_close(g);
    return ok;
}

/* True for the values of media, also of grids. */
static bool is_about_media(const json_t *value)
{
    static const char *const groups[] = {"absorb",  "nested", "shadow",
                                         "furnace", "single", "multiple",
                                         "grid"};
    static const char *const others[] = {"furnace_sss", "furnace_sheet"};

    for (size_t i = 0; i < sizeof others / sizeof others[0]; i++)
        if (strcmp(text(value, "scene"), others[i]) == 0)
            return false;
    for (size_t i = 0; i < sizeof groups / sizeof groups[0]; i++)
        if (strcmp(text(value, "group"), groups[i]) == 0)
            return true;
    return false;
}

static void media_have_their_true_values(void **state)
{
    char *folder = shared_path("truth-media");
    char *path = format_text("%s/truth.json", folder);
    json_t *values = json_load_file(path, 0, NULL);
    const json_t *value;
    bool ok = true;
    int count = 0;
    size_t i;

    (void)state;
    assert_non_null(values);
    json_array_foreach (values, i, value) {
        if (!is_about_media(value))
            continue;
        ok = check_value(folder, value) && ok;
        count++;
    }
    assert_true(ok);
    assert_int_equal(count, 29);
    json_decref(values);
    free(path);
    free(folder);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(media_have_their_true_values),
    };

    return cmocka_run_group_tests(tests, NULL, NULL);
}
