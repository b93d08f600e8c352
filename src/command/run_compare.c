// SPDX-License-Identifier: MIT
#include "command/command.h"

#include <inttypes.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>

#include "base/file.h"
#include "base/memory.h"
#include "base/print.h"
#include "command/difference.h"
#include "command/flip.h"
#include "command/reference_info.h"
#include "film/image_write.h"
#include "image/image_read.h"

/* More tiles than this are only counted. */
#define LISTED_MAX 20

static const char *const channels[] = {"red", "green", "blue"};

bool batch_compare_read(struct image *image, const char *path,
                        uint64_t held_bytes, struct error *err)
{
    struct image_file file;
    uint64_t clamped;

    if (!image_open(&file, path, IMAGE_LINEAR, held_bytes, err) ||
        !image_decode(&file, image, &clamped, err))
        return false;
    if (clamped > 0)
        print_line(stderr,
                   "glim: warning: %s: found %" PRIu64
                   " value%s below 0 or infinite, taken as 0 or 1e30",
                   path, clamped, print_plural(clamped));
    return true;
}

/* Finds mistakes before large files are read. */
static bool check_output(const struct options *o, struct error *err)
{
    const char *path = o->output_path;

    if (path == NULL)
        return true;
    if (path_is_same(path, o->picture_path) ||
        path_is_same(path, o->reference_path))
        return fail(err,
                    "-o: found '%s', a picture that is compared, expected "
                    "another file",
                    path);
    return image_write_check(path, err);
}

static bool read_pair(struct image images[2], const struct options *o,
                      struct picture_pair *pair, struct error *err)
{
    const struct image *a = &images[0], *b = &images[1];

    if (!batch_compare_read(&images[0], o->picture_path, 0, err) ||
        !batch_compare_read(&images[1], o->reference_path,
                            12 * (uint64_t)a->width * (uint64_t)a->height, err))
        return false;
    if (a->width != b->width || a->height != b->height)
        return fail(err, "%s: found %dx%d pixels, expected %dx%d as in %s",
                    o->picture_path, a->width, a->height, b->width, b->height,
                    o->reference_path);
    *pair = (struct picture_pair){a->width, a->height, a->rgb, b->rgb};
    return true;
}

/* Prints an error, without the reference's own if that matters. */
static void print_error(const char *label, double measured, double own,
                        bool is_root)
{
    double rest = picture_error_without(measured, own);
    double shown = is_root ? sqrt(fmax(rest, 0)) : fmax(rest, 0);

    if (rest <= 0 && measured > 0)
        print_line(stdout, "%-18s not above that of the reference", label);
    else if (rest < measured)
        print_line(stdout, "%-18s %.4g (without the reference's own)", label,
                   shown);
    else
        print_line(stdout, "%-18s %.4g", label, shown);
}

static void print_errors(const struct picture_error *e, double flip,
                         const struct reference_info *own)
{
    print_error("RMSE", e->mse, own->mse, true);
    print_error("relMSE", e->relmse, own->relmse, false);
    if (isfinite(e->bias_margin))
        print_line(stdout, "%-18s %+.3g %% +- %.2g %%", "bias", 100 * e->bias,
                   100 * e->bias_margin);
    else if (isfinite(e->bias))
        print_line(stdout, "%-18s %+.3g %%", "bias", 100 * e->bias);
    else
        print_line(stdout, "%-18s unknown, as the reference is black", "bias");
    print_line(stdout, "%-18s %.4g", "FLIP", flip);
    print_line(stdout, "%-18s %.4g", "99.9th percentile", e->percentile);
    print_line(stdout, "%-18s %+.4g at pixel %d,%d, %s", "largest", e->largest,
               e->largest_x, e->largest_y, channels[e->largest_channel]);
}

static int by_significance(const void *left, const void *right)
{
    const struct tile *a = left, *b = right;
    double x = fabs(a->t), y = fabs(b->t);

    if (x != y)
        return x < y ? 1 : -1;
    return a->y != b->y ? a->y - b->y : a->x - b->x;
}

/* Formats the difference of a tile for people. */
static void format_difference(char *text, size_t size_bytes,
                              const struct tile *t)
{
    char relative[32] = "";

    if (t->reference > 0)
        snprintf(relative, sizeof relative, " (%+.3g %%)",
                 100 * t->difference / t->reference);
    snprintf(text, size_bytes, "%s %+.4g%s, t %.3g", channels[t->channel],
             t->difference, relative, t->t);
}

static void print_whole(const struct tile_test *test)
{
    char text[128];

    format_difference(text, sizeof text, &test->whole);
    if (test->whole.differs)
        print_line(stdout, "%-18s differs: %s", "mean", text);
    else
        print_line(stdout, "%-18s does not differ", "mean");
}

static void print_tile(const struct tile *t)
{
    char text[128];

    format_difference(text, sizeof text, t);
    print_line(stdout, "  %dx%d at %d,%d: %s", t->width, t->height, t->x, t->y,
               text);
}

/* Prints the tiles that differ. Sorts the tiles. */
static void print_tiles(struct tile_test *test)
{
    int count = test->cols * test->rows;
    int listed = test->differing < LISTED_MAX ? test->differing : LISTED_MAX;

    if (test->differing == 0)
        print_line(stdout, "%-18s none of %d differs (|t| below %.3g)", "tiles",
                   count, test->bound);
    else
        print_line(stdout, "%-18s %d of %d differ (|t| above %.3g)", "tiles",
                   test->differing, count, test->bound);
    qsort(test->tiles, (size_t)count, sizeof *test->tiles, by_significance);
    for (int i = 0; i < listed; i++)
        print_tile(&test->tiles[i]);
    if (listed < test->differing)
        print_line(stdout, "  and %d more", test->differing - listed);
}

static bool write_floats(const struct picture_pair *p, const char *path,
                         struct error *err)
{
    size_t count = 3 * (size_t)p->width * (size_t)p->height;
    float *rgb = alloc_array(count, sizeof *rgb);
    bool ok;

    if (rgb == NULL)
        return fail(err, "%s: out of memory for %dx%d pixels", path, p->width,
                    p->height);
    for (size_t i = 0; i < count; i++)
        rgb[i] = p->rgb[i] - p->reference[i];
    ok = image_write_floats(rgb, p->width, p->height, path, err);
    free(rgb);
    return ok;
}

static bool write_colors(const struct picture_pair *p,
                         const struct tile_test *test, const char *path,
                         struct error *err)
{
    struct frame frame = {0};
    bool ok = frame_init(&frame, p->width, p->height, err);

    if (ok) {
        double full = difference_draw(p, test, &frame);

        ok = image_write_frame(&frame, path, err);
        if (ok)
            print_line(stdout,
                       "%-18s %s: red is brighter, blue is darker; full "
                       "colours at %.3g %%",
                       "differences", path, 100 * full);
    }
    frame_free(&frame);
    return ok;
}

static bool write_output(const struct picture_pair *p,
                         const struct tile_test *test, const char *path,
                         struct error *err)
{
    if (path == NULL)
        return true;
    return image_write_format_of(path) == IMAGE_WRITE_PFM
               ? write_floats(p, path, err)
               : write_colors(p, test, path, err);
}

static bool compare(const struct options *o, const struct picture_pair *p,
                    int *status, struct error *err)
{
    struct reference_info own = reference_info_read(o->reference_path);
    struct picture_error e = picture_error_of(p);
    struct tile_test test = {0};
    double flip = 0;
    bool ok = flip_mean(p, &flip, err) &&
              tile_test_init(&test, p, o->tile_count, o->false_alarms, err);

    if (ok) {
        print_line(stdout, "%s against %s, %dx%d pixels", o->picture_path,
                   o->reference_path, p->width, p->height);
        print_errors(&e, flip, &own);
        ok = write_output(p, &test, o->output_path, err);
    }
    if (ok) {
        print_whole(&test);
        print_tiles(&test);
        *status = test.whole.differs || test.differing > 0;
        ok = print_finish(stdout, err);
    }
    tile_test_free(&test);
    return ok;
}

bool batch_compare_run(const struct options *o, int *status, struct error *err)
{
    struct image images[2] = {{0}, {0}};
    struct picture_pair pair;
    bool ok = check_output(o, err) && read_pair(images, o, &pair, err) &&
              compare(o, &pair, status, err);

    image_free(&images[0]);
    image_free(&images[1]);
    return ok;
}
