// SPDX-License-Identifier: MIT
#include "glim/film.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "glim/quota.h"

#include "kernels/tone.h"
#include "kernels/vec.h"

/* Pixels of a row that are read under one lock, into memory on the stack. */
#define RUN 256

/* Sums and count of some pixels together. */
struct total {
    struct sum sums[3];
    uint64_t count;
};

static void row_lock(struct film *f, int y)
{
    pthread_mutex_lock(&f->locks[y % FILM_LOCKS]);
}

static void row_unlock(struct film *f, int y)
{
    pthread_mutex_unlock(&f->locks[y % FILM_LOCKS]);
}

static size_t pixel_index(const struct film *f, int x, int y)
{
    return (size_t)y * (size_t)f->width + (size_t)x;
}

bool film_init(struct film *f, int width, int height, struct error *err)
{
    size_t pixels = (size_t)width * (size_t)height;
    size_t size_bytes = pixels * (3 * sizeof *f->sums + sizeof *f->counts);
    struct memory_quota memory = quota_memory("");

    *f = (struct film){.width = width, .height = height};
    /* the system would promise more than it has, and kill us later */
    if (size_bytes < memory.size_bytes) {
        f->sums = alloc_array(pixels, 3 * sizeof *f->sums);
        f->counts = alloc_array(pixels, sizeof *f->counts);
        f->has_row = alloc_array((size_t)height, sizeof *f->has_row);
    }
    if (f->sums == NULL || f->counts == NULL || f->has_row == NULL) {
        free(f->sums);
        free(f->counts);
        free(f->has_row);
        *f = (struct film){0};
        return fail(
            err,
            "a picture of %dx%d pixels needs %.1f GiB of memory, %s%.1f "
            "GiB %s",
            width, height, (double)size_bytes / (1 << 30),
            size_bytes < memory.size_bytes ? "more than is left of the "
                                           : "found ",
            (double)memory.size_bytes / (1 << 30), memory.place);
    }
    for (int i = 0; i < FILM_LOCKS; i++)
        pthread_mutex_init(&f->locks[i], NULL);
    return true;
}

/* Only the counts: a sum is reset by the first sample that is added to it. And
 * only rows that have some: while the camera moves, 60 times a second, these
 * are few. */
void film_clear(struct film *f)
{
    for (int y = 0; y < f->height; y++) {
        row_lock(f, y);
        if (f->has_row[y])
            memset(f->counts + pixel_index(f, 0, y), 0,
                   (size_t)f->width * sizeof *f->counts);
        f->has_row[y] = false;
        row_unlock(f, y);
    }
    atomic_store(&f->samples, 0);
    atomic_store(&f->rays, 0);
    atomic_store(&f->non_finite, 0);
    atomic_store(&f->saturated, 0);
    atomic_store(&f->cut_paths, 0);
}

void film_free(struct film *f)
{
    if (f->sums != NULL)
        for (int i = 0; i < FILM_LOCKS; i++)
            pthread_mutex_destroy(&f->locks[i]);
    free(f->sums);
    free(f->counts);
    free(f->has_row);
    *f = (struct film){0};
}

uint64_t film_count(const struct film *f, int x, int y)
{
    size_t at = pixel_index(f, x, y);

    /* who asks will add: a whole film is in no cache, and samples take long
     * enough for it to come */
    __builtin_prefetch(f->sums + 3 * at);
    __builtin_prefetch(f->sums + 3 * at + 2);
    return f->counts[at];
}

void film_add_row(struct film *f, int x, int y, int stride, int pixel_count,
                  const struct path_sample *samples, const int *counts)
{
    struct tally tally = {0};

    row_lock(f, y);
    f->has_row[y] = true;
    for (int i = 0; i < pixel_count; i++) {
        size_t at = pixel_index(f, x + i * stride, y);
        struct sum *sums = f->sums + 3 * at;

        if (counts[i] > 0 && f->counts[at] == 0)
            memset(sums, 0, 3 * sizeof *sums);
        for (int s = 0; s < counts[i]; s++)
            pixel_add(sums, *samples++, &tally);
        f->counts[at] += (uint64_t)counts[i];
    }
    row_unlock(f, y);
    film_count_more(f, &tally);
}

void film_store_row(struct film *f, int x, int y, int stride, int pixel_count,
                    const struct sum *sums, const uint64_t *counts)
{
    row_lock(f, y);
    f->has_row[y] = true;
    for (int i = 0; i < pixel_count; i++) {
        int px = x + i * stride;
        size_t from = (size_t)px;
        size_t at = pixel_index(f, px, y);

        if (f->counts[at] == counts[from])
            continue;
        memcpy(f->sums + 3 * at, sums + 3 * from, 3 * sizeof *sums);
        f->counts[at] = counts[from];
    }
    row_unlock(f, y);
}

void film_count_more(struct film *f, const struct tally *tally)
{
    atomic_fetch_add(&f->samples, tally->samples);
    atomic_fetch_add(&f->rays, tally->rays);
    if (tally->non_finite != 0)
        atomic_fetch_add(&f->non_finite, tally->non_finite);
    if (tally->saturated != 0)
        atomic_fetch_add(&f->saturated, tally->saturated);
    if (tally->cut_paths != 0)
        atomic_fetch_add(&f->cut_paths, tally->cut_paths);
}

static void mean_of(const struct sum *sums, uint64_t count, float *rgb)
{
    for (int c = 0; c < 3; c++)
        rgb[c] = sum_mean(sums[c], count);
}

/* A pixel without samples: the mean of the nearest coarser grid point that has
 * some, or black. */
static void coarse_mean(struct film *f, int x, int y, float *rgb)
{
    rgb[0] = rgb[1] = rgb[2] = 0.0f;
    for (int stride = 2; stride <= FILM_STRIDE_MAX; stride *= 2) {
        int cx = x - x % stride;
        int cy = y - y % stride;
        size_t at = pixel_index(f, cx, cy);
        bool found;

        row_lock(f, cy);
        found = f->counts[at] != 0;
        if (found)
            mean_of(f->sums + 3 * at, f->counts[at], rgb);
        row_unlock(f, cy);
        if (found)
            return;
    }
}

/* Means of `count` pixels of row y from x0 on, 3 floats a pixel. */
static void linear_run(struct film *f, int x0, int y, int count, float *rgb)
{
    bool has_gaps = false;

    row_lock(f, y);
    for (int i = 0; i < count; i++) {
        size_t at = pixel_index(f, x0 + i, y);

        rgb[3 * i] = -1.0f; /* no mean is negative */
        if (f->counts[at] != 0)
            mean_of(f->sums + 3 * at, f->counts[at], rgb + 3 * i);
        else
            has_gaps = true;
    }
    row_unlock(f, y);
    for (int i = 0; has_gaps && i < count; i++)
        if (rgb[3 * i] < 0.0f)
            coarse_mean(f, x0 + i, y, rgb + 3 * i);
}

void film_linear(struct film *f, float *rgb)
{
    for (int y = 0; y < f->height; y++)
        linear_run(f, 0, y, f->width, rgb + 3 * pixel_index(f, 0, y));
}

void film_counts(struct film *f, float *counts)
{
    for (int y = 0; y < f->height; y++) {
        row_lock(f, y);
        for (int x = 0; x < f->width; x++)
            counts[pixel_index(f, x, y)] =
                (float)f->counts[pixel_index(f, x, y)];
        row_unlock(f, y);
    }
}

/* 2^stops for any number of stops. */
static float exposure_factor(float stops)
{
    return exp2f(f_max(-126.0f, f_min(stops, 126.0f)));
}

static void expose(const float *rgb, float factor, uint32_t tone,
                   uint8_t *bytes)
{
    float shown[3] = {rgb[0] * factor, rgb[1] * factor, rgb[2] * factor};

    tone_curve(tone, shown);
    for (int c = 0; c < 3; c++)
        bytes[c] = (uint8_t)srgb_byte(shown[c]);
}

void film_resolve(struct film *f, struct develop how, struct frame *frame)
{
    float factor = exposure_factor(how.exposure);
    float rgb[3 * RUN];

    for (int y = 0; y < f->height; y++) {
        for (int x = 0; x < f->width; x += RUN) {
            int count = f->width - x < RUN ? f->width - x : RUN;

            linear_run(f, x, y, count, rgb);
            for (int i = 0; i < count; i++)
                expose(rgb + 3 * i, factor, how.tone,
                       frame->rgb + 3 * pixel_index(f, x + i, y));
        }
    }
}

static void total_add(struct total *t, const struct sum *sums, uint64_t count)
{
    if (count == 0)
        return;
    for (int c = 0; c < 3; c++)
        sum_join(&t->sums[c], sums[c]);
    t->count += count;
}

/* The part of `length` film pixels that belongs to pixel i of n. */
static void span_of(int i, int n, int length, int *begin, int *end)
{
    *begin = (int)((int64_t)i * length / n);
    *end = (int)((int64_t)(i + 1) * length / n);
    if (*end <= *begin)
        *end = *begin + 1;
}

/* Pixels of row y of a frame. */
struct run {
    const struct frame *frame;
    int x, y, count;
};

/* Adds what the film has where these pixels are. */
static void add_run(struct film *f, const struct run *r, struct total *totals)
{
    int x0, x1, y0, y1;

    span_of(r->y, r->frame->height, f->height, &y0, &y1);
    for (int y = y0; y < y1; y++) {
        row_lock(f, y);
        for (int i = 0; i < r->count && f->has_row[y]; i++) {
            span_of(r->x + i, r->frame->width, f->width, &x0, &x1);
            for (int x = x0; x < x1; x++) {
                size_t at = pixel_index(f, x, y);

                total_add(&totals[i], f->sums + 3 * at, f->counts[at]);
            }
        }
        row_unlock(f, y);
    }
}

/* A pixel of a frame where the film has no samples yet. */
static void coarse_part(struct film *f, const struct run *r, int i, float *rgb)
{
    int x0, x1, y0, y1;

    span_of(r->x + i, r->frame->width, f->width, &x0, &x1);
    span_of(r->y, r->frame->height, f->height, &y0, &y1);
    coarse_mean(f, (x0 + x1) / 2, (y0 + y1) / 2, rgb);
}

static void preview_run(struct film *f, struct film *draft, float factor,
                        uint32_t tone, const struct run *r)
{
    struct total totals[RUN] = {0};

    add_run(f, r, totals);
    if (draft != NULL)
        add_run(draft, r, totals);
    for (int i = 0; i < r->count; i++) {
        size_t at = (size_t)r->y * (size_t)r->frame->width + (size_t)(r->x + i);
        float rgb[3];

        if (totals[i].count != 0)
            mean_of(totals[i].sums, totals[i].count, rgb);
        else
            coarse_part(draft != NULL ? draft : f, r, i, rgb);
        expose(rgb, factor, tone, r->frame->rgb + 3 * at);
    }
}

void film_preview(struct film *f, struct film *draft, struct develop how,
                  struct frame *frame)
{
    float factor = exposure_factor(how.exposure);

    for (int y = 0; y < frame->height; y++)
        for (int x = 0; x < frame->width; x += RUN) {
            int count = frame->width - x < RUN ? frame->width - x : RUN;

            preview_run(f, draft, factor, how.tone,
                        &(struct run){frame, x, y, count});
        }
}

bool frame_init(struct frame *frame, int width, int height, struct error *err)
{
    frame->width = width;
    frame->height = height;
    frame->rgb = alloc_array((size_t)width * (size_t)height, 3);
    if (frame->rgb == NULL)
        return fail(err, "out of memory for a frame of %dx%d pixels", width,
                    height);
    return true;
}

void frame_free(struct frame *frame)
{
    free(frame->rgb);
    *frame = (struct frame){0};
}
