// SPDX-License-Identifier: MIT
#include "film/film.h"

#include <math.h>
#include <stdalign.h>
#include <stdlib.h>
#include <string.h>

#include "base/machine.h"
#include "base/memory.h"
#include "base/simd4.h"
#include "image/frame.h"
#include "kernels/tone.h"
#include "kernels/vec.h"

/* Pixels of a row that are processed at once, in memory on the stack. */
#define RUN 256

void film_lock_row(struct film *f, int y)
{
    pthread_mutex_lock(&f->locks[y % FILM_LOCKS]);
}

void film_unlock_row(struct film *f, int y)
{
    pthread_mutex_unlock(&f->locks[y % FILM_LOCKS]);
}

static size_t pixel_index(const struct film *f, int x, int y)
{
    return (size_t)y * (size_t)f->width + (size_t)x;
}

static bool lacks_memory(int width, int height, size_t size_bytes,
                         struct error *err)
{
    struct memory_quota memory = cgroup_quota_memory("");

    return fail(err,
                "a picture of %dx%d pixels needs %.1f GiB of memory, %s%.1f "
                "GiB %s",
                width, height, (double)size_bytes / (1 << 30),
                size_bytes < memory.size_bytes ? "more than is left of the "
                                               : "found ",
                (double)memory.size_bytes / (1 << 30), memory.place);
}

/* Linux may grant more memory than the machine has and kill the process
 * later. */
static bool fits_memory(size_t size_bytes)
{
    return size_bytes < cgroup_quota_memory("").size_bytes;
}

bool film_init(struct film *f, int width, int height, struct error *err)
{
    size_t pixels = (size_t)width * (size_t)height;
    size_t size_bytes = pixels * FILM_PIXEL_BYTES;

    *f = (struct film){.width = width, .height = height};
    if (fits_memory(size_bytes)) {
        f->sums = alloc_array(pixels, 3 * sizeof *f->sums);
        f->odd_sums = alloc_array(pixels, 3 * sizeof *f->odd_sums);
        f->counts = alloc_array(pixels, sizeof *f->counts);
        f->has_row = alloc_array((size_t)height, sizeof *f->has_row);
    }
    if (f->sums == NULL || f->odd_sums == NULL || f->counts == NULL ||
        f->has_row == NULL) {
        free(f->sums);
        free(f->odd_sums);
        free(f->counts);
        free(f->has_row);
        *f = (struct film){0};
        lacks_memory(width, height, size_bytes, err);
        return false;
    }
    for (int i = 0; i < FILM_LOCKS; i++)
        pthread_mutex_init(&f->locks[i], NULL);
    return true;
}

bool film_init_surfaces(struct film *f, struct error *err)
{
    size_t pixels = (size_t)f->width * (size_t)f->height;
    size_t size_bytes = pixels * sizeof *f->surfaces;

    if (fits_memory(size_bytes))
        f->surfaces = alloc_array(pixels, sizeof *f->surfaces);
    return f->surfaces != NULL ||
           lacks_memory(f->width, f->height, size_bytes, err);
}

/* Resets the counts only, since the first sample added to a pixel resets its
 * sum, and only in rows that have samples: while the camera moves, film_clear()
 * runs 60 times a second and few rows have some. */
void film_clear(struct film *f)
{
    for (int y = 0; y < f->height; y++) {
        film_lock_row(f, y);
        if (f->has_row[y])
            memset(f->counts + pixel_index(f, 0, y), 0,
                   (size_t)f->width * sizeof *f->counts);
        f->has_row[y] = false;
        film_unlock_row(f, y);
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
    free(f->odd_sums);
    free(f->surfaces);
    free(f->counts);
    free(f->has_row);
    *f = (struct film){0};
}

uint64_t film_count(const struct film *f, int x, int y)
{
    size_t at = pixel_index(f, x, y);

    /* the caller will add samples: prefetch the sums, which are not in a cache,
     * while the samples are computed */
    __builtin_prefetch(f->sums + 3 * at);
    __builtin_prefetch(f->sums + 3 * at + 2);
    __builtin_prefetch(f->odd_sums + 3 * at);
    __builtin_prefetch(f->odd_sums + 3 * at + 2);
    return f->counts[at];
}

void film_add_row(struct film *f, struct film_pixels at,
                  const struct path_sample *samples,
                  const struct first_surface *surfaces, const int *counts)
{
    struct tally tally = {0};

    film_lock_row(f, at.y);
    f->has_row[at.y] = true;
    for (int i = 0; i < at.count; i++) {
        size_t to = pixel_index(f, at.x + i * at.stride, at.y);
        struct sum *sums = f->sums + 3 * to;
        struct sum *odd_sums = f->odd_sums + 3 * to;
        uint64_t count = f->counts[to];

        if (counts[i] > 0 && count == 0) {
            memset(sums, 0, 3 * sizeof *sums);
            memset(odd_sums, 0, 3 * sizeof *odd_sums);
            if (f->surfaces != NULL)
                surface_clear(&f->surfaces[to]);
        }
        for (int s = 0; s < counts[i] && f->surfaces != NULL; s++)
            surface_add(&f->surfaces[to], f->first_sample + count + (uint64_t)s,
                        *surfaces++, samples[s].radiance);
        for (int s = 0; s < counts[i]; s++)
            pixel_add(sums, odd_sums, count++, *samples++, &tally);
        f->counts[to] = count;
    }
    film_unlock_row(f, at.y);
    film_count_more(f, &tally);
}

void film_store_row(struct film *f, struct film_pixels at,
                    const struct sum *sums, const struct sum *odd_sums,
                    const struct surface_sums *surfaces, const uint64_t *counts)
{
    film_lock_row(f, at.y);
    f->has_row[at.y] = true;
    for (int i = 0; i < at.count; i++) {
        int px = at.x + i * at.stride;
        size_t from = (size_t)px;
        size_t to = pixel_index(f, px, at.y);

        if (f->counts[to] == counts[from])
            continue;
        memcpy(f->sums + 3 * to, sums + 3 * from, 3 * sizeof *sums);
        memcpy(f->odd_sums + 3 * to, odd_sums + 3 * from, 3 * sizeof *odd_sums);
        if (f->surfaces != NULL)
            f->surfaces[to] = surfaces[from];
        f->counts[to] = counts[from];
    }
    film_unlock_row(f, at.y);
}

static void swap_counter(atomic_uint_least64_t *a, atomic_uint_least64_t *b)
{
    atomic_store(b, atomic_exchange(a, atomic_load(b)));
}

void film_swap(struct film *a, struct film *b)
{
    struct film old = {.sums = a->sums,
                       .odd_sums = a->odd_sums,
                       .surfaces = a->surfaces,
                       .counts = a->counts,
                       .has_row = a->has_row,
                       .first_sample = a->first_sample};

    a->sums = b->sums;
    a->odd_sums = b->odd_sums;
    a->surfaces = b->surfaces;
    a->counts = b->counts;
    a->has_row = b->has_row;
    a->first_sample = b->first_sample;
    b->sums = old.sums;
    b->odd_sums = old.odd_sums;
    b->surfaces = old.surfaces;
    b->counts = old.counts;
    b->has_row = old.has_row;
    b->first_sample = old.first_sample;
    swap_counter(&a->samples, &b->samples);
    swap_counter(&a->rays, &b->rays);
    swap_counter(&a->non_finite, &b->non_finite);
    swap_counter(&a->saturated, &b->saturated);
    swap_counter(&a->cut_paths, &b->cut_paths);
}

bool film_copy(struct film *to, struct film *from, struct error *err)
{
    size_t width = (size_t)from->width;

    if (!film_init(to, from->width, from->height, err))
        return false;
    if (from->surfaces != NULL && !film_init_surfaces(to, err)) {
        film_free(to);
        return false;
    }
    for (int y = 0; y < from->height;
         y++) { /* whole rows, as they are locked */
        size_t at = (size_t)y * width;

        film_lock_row(from, y);
        memcpy(to->sums + 3 * at, from->sums + 3 * at,
               3 * width * sizeof *to->sums);
        memcpy(to->odd_sums + 3 * at, from->odd_sums + 3 * at,
               3 * width * sizeof *to->odd_sums);
        if (from->surfaces != NULL)
            memcpy(to->surfaces + at, from->surfaces + at,
                   width * sizeof *to->surfaces);
        memcpy(to->counts + at, from->counts + at, width * sizeof *to->counts);
        to->has_row[y] = from->has_row[y];
        film_unlock_row(from, y);
    }
    return true;
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

void film_count_again(struct film *f)
{
    size_t pixels = (size_t)f->width * (size_t)f->height;
    uint64_t samples = 0;

    for (size_t i = 0; i < pixels; i++)
        samples += f->counts[i];
    atomic_store(&f->samples, samples);
}

static inline f4 mean_of(const struct sum *sums, uint64_t count)
{
    f4 all =
        f4_set3(sum_float(sums[0]), sum_float(sums[1]), sum_float(sums[2]));

    return f4_div(all, f4_set1((float)count));
}

/* Returns the value shown for a pixel without samples: the mean of the nearest
 * coarser grid point that has some, or black. */
static f4 coarse_mean(struct film *f, int x, int y)
{
    f4 rgb = f4_set1(0.0f);
    bool found = false;

    for (int stride = 2; !found && stride <= FILM_STRIDE_MAX; stride *= 2) {
        int cx = x - x % stride;
        int cy = y - y % stride;
        size_t at = pixel_index(f, cx, cy);

        film_lock_row(f, cy);
        found = f->counts[at] != 0;
        if (found)
            rgb = mean_of(f->sums + 3 * at, f->counts[at]);
        film_unlock_row(f, cy);
    }
    return rgb;
}

static void put(f4 rgb, float *to)
{
    alignas(16) float from[4];

    f4_store(from, rgb);
    memcpy(to, from, 3 * sizeof *to);
}

/* Writes the means of `count` pixels of row y from x0 on, 3 floats each. */
static void linear_run(struct film *f, int x0, int y, int count, float *rgb)
{
    bool has_gaps = false;

    film_lock_row(f, y);
    for (int i = 0; i < count; i++) {
        size_t at = pixel_index(f, x0 + i, y);

        rgb[3 * i] = -1.0f; /* marks a gap, as no mean is negative */
        if (f->counts[at] != 0)
            put(mean_of(f->sums + 3 * at, f->counts[at]), rgb + 3 * i);
        else
            has_gaps = true;
    }
    film_unlock_row(f, y);
    for (int i = 0; has_gaps && i < count; i++)
        if (rgb[3 * i] < 0.0f)
            put(coarse_mean(f, x0 + i, y), rgb + 3 * i);
}

void film_linear(struct film *f, float *rgb)
{
    for (int y = 0; y < f->height; y++)
        linear_run(f, 0, y, f->width, rgb + 3 * pixel_index(f, 0, y));
}

void film_counts(struct film *f, float *counts)
{
    for (int y = 0; y < f->height; y++) {
        film_lock_row(f, y);
        for (int x = 0; x < f->width; x++)
            counts[pixel_index(f, x, y)] =
                (float)f->counts[pixel_index(f, x, y)];
        film_unlock_row(f, y);
    }
}

float develop_factor(struct develop how)
{
    return exp2f(f_max(-126.0f, f_min(how.exposure, 126.0f)));
}

/* Develops linear light for a screen, whose white is 1. Lane 3 stays 0. */
static inline f4 show(f4 light, float factor, uint32_t tone)
{
    alignas(16) float rgb[4];

    light = f4_mul(light, f4_set1(factor));
    if (tone != TONE_LINEAR) {
        f4_store(rgb, light);
        tone_curve(tone, rgb);
        light = f4_set3(rgb[0], rgb[1], rgb[2]);
    }
    return f4_min(light, f4_set1(1.0f));
}

static void encode(f4 shown, uint8_t *bytes)
{
    alignas(16) float rgb[4];

    f4_store(rgb, shown);
    for (int c = 0; c < 3; c++)
        bytes[c] = (uint8_t)srgb_byte(rgb[c]);
}

/* Scales numbers and cuts them to [0, 1]. */
VECTORISED static void scale_numbers(const float *restrict from, float factor,
                                     int count, float *restrict to)
{
    for (int i = 0; i < count; i++)
        to[i] = f_min(f_max(factor * from[i], 0.0f), 1.0f);
}

VECTORISED static void find_near(const float *restrict linear, int count,
                                 int32_t *restrict near)
{
    for (int i = 0; i < count; i++)
        near[i] = srgb_near(linear[i]);
}

/* Develops up to RUN pixels. */
static void develop_run(struct develop how, int count, const float *rgb,
                        uint8_t *bytes)
{
    float toned[3 * RUN], linear[3 * RUN];
    int32_t near[3 * RUN];
    float factor = develop_factor(how);

    if (how.tone != TONE_LINEAR) {
        for (int i = 0; i < count; i++)
            put(show(f4_set3(rgb[3 * i], rgb[3 * i + 1], rgb[3 * i + 2]),
                     factor, how.tone),
                toned + 3 * i);
        rgb = toned;
        factor = 1.0f;
    }
    scale_numbers(rgb, factor, 3 * count, linear);
    find_near(linear, 3 * count, near);
    for (int i = 0; i < 3 * count; i++)
        bytes[i] = (uint8_t)srgb_byte_near(linear[i], near[i]);
}

void develop_row(struct develop how, int count, const float *rgb,
                 uint8_t *bytes)
{
    for (int x = 0; x < count; x += RUN)
        develop_run(how, count - x < RUN ? count - x : RUN, rgb + 3 * x,
                    bytes + 3 * x);
}

void film_resolve(struct film *f, struct develop how, struct frame *frame)
{
    float rgb[3 * RUN];

    for (int y = 0; y < f->height; y++) {
        for (int x = 0; x < f->width; x += RUN) {
            int count = f->width - x < RUN ? f->width - x : RUN;

            linear_run(f, x, y, count, rgb);
            develop_row(how, count, rgb, frame->rgb + 3 * pixel_index(f, x, y));
        }
    }
}

/* Weighted sum of colours, with the sum of the weights in the last member. */
struct weighted {
    alignas(16) float rgb_weight[4];
};

/* Consecutive pixels of a frame's row y, from x on, as sums over the film's
 * pixels weighted by area. */
struct run {
    int x, y, count;
    struct weighted shown[RUN]; /* sums of pixels developed one by one */
    struct weighted light[RUN]; /* sums of linear light, developed afterwards */
};

/* Parameters of the conversion of films to a frame. */
struct showing {
    const struct frame *frame;
    bool has_draft;
    float factor;
    uint32_t tone;
};

static inline void add(struct weighted *sum, f4 rgb, float weight)
{
    static const alignas(16) float one[4] = {0.0f, 0.0f, 0.0f, 1.0f};
    f4 more = f4_mul(f4_add(rgb, f4_load(one)), f4_set1(weight));

    f4_store(sum->rgb_weight, f4_add(f4_load(sum->rgb_weight), more));
}

/* Returns the share of a film's pixel that is developed by itself. Pixels with
 * few samples get too dark that way, because the curve cuts values above white
 * but keeps the low ones. Beside a draft the share grows from 0 at one sample
 * to 1 at FILM_YOUNG_SPP, when the draft goes. */
static inline float trust(const struct showing *s, uint64_t samples)
{
    if (!s->has_draft || samples >= FILM_YOUNG_SPP)
        return 1.0f;
    return (float)(samples - 1) / (FILM_YOUNG_SPP - 1);
}

/* Prefetch distance in pixels. Sums are in no cache and arrive in the time that
 * this many pixels take. */
#define AHEAD 32

/* Adds the pixels of row y of the film that overlap the run, over `height` of
 * the row's height. */
static void add_row(const struct showing *how, const struct film *f, int y,
                    float height, bool is_draft, struct run *r)
{
    struct showing s = *how;
    struct area_walk w = area_walk(f->width, s.frame->width, r->x, r->count);
    const uint64_t *counts = f->counts + pixel_index(f, 0, y);
    const struct sum *sums = f->sums + 3 * pixel_index(f, 0, y);

    while (area_walks(&w)) {
        int x = w.from;
        uint64_t samples = counts[x];
        float trusted = 0.0f;
        f4 light = f4_set1(0.0f), shown = light;

        if (x + AHEAD < f->width)
            __builtin_prefetch(sums + 3 * (x + AHEAD));
        if (samples != 0) {
            light = mean_of(sums + 3 * x, samples);
            trusted = is_draft ? 0.0f : trust(&s, samples);
        }
        if (trusted > 0.0f)
            shown = show(light, s.factor, s.tone);
        do {
            int i = w.to - r->x;
            float area = height * area_step(&w);

            if (trusted > 0.0f)
                add(&r->shown[i], shown, area * trusted);
            if (s.has_draft && samples != 0)
                add(&r->light[i], light, area * (float)samples);
        } while (w.from == x && area_walks(&w));
    }
}

static void add_film(const struct showing *s, struct film *f, bool is_draft,
                     struct run *r)
{
    struct area_walk w = area_walk(f->height, s->frame->height, r->y, 1);

    while (area_walks(&w)) {
        int y = w.from;
        float height = area_step(&w);

        film_lock_row(f, y);
        if (f->has_row[y])
            add_row(s, f, y, height, is_draft, r);
        film_unlock_row(f, y);
    }
}

/* Returns the mean of the nearest sample of a coarser grid for pixel i of the
 * run. */
static f4 coarse_part(const struct showing *s, struct film *f,
                      const struct run *r, int i)
{
    int64_t x = (2 * (int64_t)(r->x + i) + 1) * f->width;
    int64_t y = (2 * (int64_t)r->y + 1) * f->height;

    return coarse_mean(f, (int)(x / (2 * s->frame->width)),
                       (int)(y / (2 * s->frame->height)));
}

/* Returns pixel i of the run as the screen shows it. Sums of developed pixels
 * cover part of the area `whole` of a frame's pixel; developed linear light
 * fills the rest. */
static f4 finish(const struct showing *s, struct film *film, struct film *draft,
                 const struct run *r, int i)
{
    float whole = (float)film->width * (float)film->height;
    f4 sure = f4_load(r->shown[i].rgb_weight);
    f4 light = f4_load(r->light[i].rgb_weight);
    float sure_weight = r->shown[i].rgb_weight[3];
    float light_weight = r->light[i].rgb_weight[3];

    if (!draft && sure_weight > 0.0f)
        return f4_div(sure, f4_set1(sure_weight));
    if (light_weight > 0.0f)
        light = f4_div(light, f4_set1(light_weight));
    else
        light = coarse_part(s, draft ? draft : film, r, i);
    light = show(light, s->factor, s->tone);
    if (!draft)
        return light;
    light = f4_mul(light, f4_set1(1.0f - sure_weight / whole));
    return f4_add(light, f4_div(sure, f4_set1(whole)));
}

void film_preview_part(struct film *film, struct film *draft,
                       struct develop how, struct film_pixels part,
                       struct frame *frame)
{
    struct showing s = {frame, draft != NULL, develop_factor(how), how.tone};

    while (part.count > 0) {
        size_t at = (size_t)part.y * (size_t)frame->width + (size_t)part.x;
        struct run r;

        r.x = part.x;
        r.y = part.y;
        r.count = part.count < RUN ? part.count : RUN;
        memset(r.shown, 0, (size_t)r.count * sizeof *r.shown);
        memset(r.light, 0, (size_t)r.count * sizeof *r.light);
        add_film(&s, film, false, &r);
        if (draft)
            add_film(&s, draft, true, &r);
        for (int i = 0; i < r.count; i++)
            encode(finish(&s, film, draft, &r, i),
                   frame->rgb + 3 * (at + (size_t)i));
        part.x += r.count;
        part.count -= r.count;
    }
}

void film_preview(struct film *film, struct film *draft, struct develop how,
                  struct frame *frame)
{
    for (int y = 0; frame_has_row(frame, y); y++)
        film_preview_part(film, draft, how,
                          (struct film_pixels){0, y, 1, frame->width}, frame);
}

/* ---- merging ---- */

/* Returns false if a sum is too large for both. */
static bool join_sums(struct sum *to, const struct sum *from, int count)
{
    bool has_room = true;

    for (int i = 0; i < count; i++)
        has_room &= sum_join(&to[i], from[i]);
    return has_room;
}

static void join_numbers(uint32_t *to, const uint32_t *from, int count)
{
    for (int i = 0; i < count; i++)
        to[i] += from[i];
}

static void join_surfaces(struct surface_sums *to,
                          const struct surface_sums *from)
{
    join_sums(to->direct, from->direct, 3);
    join_sums(to->odd_direct, from->odd_direct, 3);
    join_sums(to->seen, from->seen, 3);
    join_sums(to->odd_seen, from->odd_seen, 3);
    join_sums(&to->depth, &from->depth, 1);
    join_sums(&to->depth_square, &from->depth_square, 1);
    join_numbers(to->albedo, from->albedo, 3);
    join_numbers(to->normal, from->normal, 3);
    join_numbers(&to->albedo_square, &from->albedo_square, 1);
    join_numbers(&to->count, &from->count, 1);
    join_numbers(&to->hit_count, &from->hit_count, 1);
    join_numbers(&to->seen_count, &from->seen_count, 1);
}

static void clear_pixel(struct film *f, size_t at)
{
    memset(f->sums + 3 * at, 0, 3 * sizeof *f->sums);
    memset(f->odd_sums + 3 * at, 0, 3 * sizeof *f->odd_sums);
    if (f->surfaces != NULL)
        surface_clear(&f->surfaces[at]);
}

/* Returns the number of pixels whose sums are too large together. */
static uint64_t merge_row(struct film *f, size_t to, const struct film *part,
                          size_t from)
{
    uint64_t full = 0;

    for (int x = 0; x < f->width; x++, to++, from++) {
        if (part->counts[from] == 0)
            continue;
        if (f->counts[to] == 0)
            clear_pixel(f, to);
        full += !join_sums(f->sums + 3 * to, part->sums + 3 * from, 3);
        join_sums(f->odd_sums + 3 * to, part->odd_sums + 3 * from, 3);
        if (f->surfaces != NULL)
            join_surfaces(&f->surfaces[to], &part->surfaces[from]);
        f->counts[to] += part->counts[from];
    }
    return full;
}

void film_merge(struct film *f, int y, const struct film *part)
{
    size_t width = (size_t)f->width;
    uint64_t full = atomic_load(&part->saturated);

    for (int i = 0; i < part->height; i++) {
        film_lock_row(f, y + i);
        f->has_row[y + i] = true;
        full += merge_row(f, (size_t)(y + i) * width, part, (size_t)i * width);
        film_unlock_row(f, y + i);
    }
    atomic_fetch_add(&f->samples, atomic_load(&part->samples));
    atomic_fetch_add(&f->rays, atomic_load(&part->rays));
    atomic_fetch_add(&f->non_finite, atomic_load(&part->non_finite));
    atomic_fetch_add(&f->saturated, full);
    atomic_fetch_add(&f->cut_paths, atomic_load(&part->cut_paths));
}
