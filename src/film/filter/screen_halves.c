// SPDX-License-Identifier: MIT
#include "film/filter/screen_halves.h"

#include <math.h>
#include <stdalign.h>
#include <stdlib.h>
#include <string.h>

#include "base/memory.h"
#include "base/simd4.h"
#include "image/frame.h"

/* ---- halves ---- */

/* Pixels of a film whose sums are converted at once. */
#define RUN 256

/* Halves of a film's pixel, or sums of such halves, weighted by area, over a
 * pixel of the screen. */
struct half_cell {
    /* red, green, blue, and the weight of halves that have samples */
    alignas(16) float light[2][4];
    float count[2]; /* samples */
};

void screen_halves_free(struct screen_halves *s)
{
    free(s->memory);
    free(s->cells);
    free(s->next_cells);
    *s = (struct screen_halves){0};
}

bool screen_halves_init(struct screen_halves *s, int width, int height,
                        const struct filter_loops *loops)
{
    float *next;

    *s = (struct screen_halves){
        .width = width,
        .height = height,
        .loops = loops,
        .memory = alloc_array((size_t)width, (2 * 4 + 3) * sizeof *s->memory),
        .cells = alloc_aligned((size_t)width, sizeof *s->cells),
        .next_cells = alloc_aligned((size_t)width, sizeof *s->cells),
    };
    if (s->memory == NULL || s->cells == NULL || s->next_cells == NULL) {
        screen_halves_free(s);
        return false;
    }
    next = s->memory;
    for (int h = 0; h < 2; h++, next += 4 * width) {
        for (int c = 0; c < 3; c++)
            s->light[h][c] = next + c * width;
        s->count[h] = next + 3 * width;
    }
    s->raw = next;
    return true;
}

static inline void add_to_half(struct half_cell *to, int half, f4 mean,
                               float count, float area)
{
    float *light = to->light[half];

    f4_store(light, f4_add(f4_load(light), f4_mul(mean, f4_set1(area))));
    to->count[half] += area * count;
}

/* Sums of consecutive pixels of a film's row, as floats. */
struct run {
    int first, end;
    float all[3 * RUN], odd[3 * RUN];
};

static void convert_run(const struct screen_halves *s, const struct film *film,
                        int x, int y, struct run *r)
{
    size_t at = (size_t)y * (size_t)film->width + (size_t)x;
    int left = film->width - x, count = left < RUN ? left : RUN;

    r->first = x;
    r->end = x + count;
    s->loops->convert(film->sums + 3 * at, 3 * count, r->all);
    s->loops->convert(film->odd_sums + 3 * at, 3 * count, r->odd);
}

/* A pixel of a film: means of its even and its odd samples, with 1 in the last
 * lane if there are some. */
struct pixel_means {
    f4 even, odd;
    float even_count, odd_count;
};

static inline struct pixel_means pixel_means(const struct run *r, int x,
                                             uint64_t count)
{
    static const alignas(16) float last[4] = {0.0f, 0.0f, 0.0f, 1.0f};
    const float *a = r->all + 3 * (x - r->first);
    const float *b = r->odd + 3 * (x - r->first);
    f4 zero = f4_set1(0.0f), one = f4_load(last);
    f4 all = f4_set3(a[0], a[1], a[2]), odd = f4_set3(b[0], b[1], b[2]);
    struct pixel_means p = {zero, zero, (float)film_even_count(count),
                            (float)film_odd_count(count)};

    if (count > 1) {
        f4 even = f4_max(f4_sub(all, odd), zero);

        p.even = f4_mul(even, f4_set1(1.0f / p.even_count));
        p.even = f4_add(p.even, one);
        p.odd = f4_add(f4_mul(odd, f4_set1(1.0f / p.odd_count)), one);
    } else if (count == 1) {
        p.even = f4_add(all, one);
    }
    return p;
}

/* Adds a film's pixel to a cell. Its even samples belong to half `even`. */
static inline void add_pixel(struct half_cell *to, const struct pixel_means *p,
                             int even, float area)
{
    add_to_half(to, even, p->even, p->even_count, area);
    add_to_half(to, 1 - even, p->odd, p->odd_count, area);
}

/* Adds row y of the film to the row's cells, and to the next row's: `height`
 * and `next_height` of the film's row are within them. Even samples belong to
 * either half equally often on any coarse grid. */
static void add_film_row(const struct screen_halves *s, const struct film *film,
                         int y, float height, float next_height)
{
    const uint64_t *counts = film->counts + (size_t)y * (size_t)film->width;
    struct area_walk w = area_walk(film->width, s->width, 0, s->width);
    struct run r;

    r.end = 0;
    while (area_walks(&w)) {
        int x = w.from, even = __builtin_parity((unsigned)(x ^ y));
        struct pixel_means p;

        if (x >= r.end)
            convert_run(s, film, x, y, &r);
        p = pixel_means(&r, x, counts[x]);
        do {
            int to = w.to;
            float area = area_step(&w);

            add_pixel(s->cells + to, &p, even, height * area);
            if (next_height > 0.0f)
                add_pixel(s->next_cells + to, &p, even, next_height * area);
        } while (w.from == x && area_walks(&w));
    }
}

/* Adds up the film's pixels within row y of the screen, which has as many rows
 * as the film or fewer, and follows row y - 1. */
static void add_film(struct screen_halves *s, struct film *film, int y)
{
    struct area_walk w = area_walk(film->height, s->height, y, 1);
    struct half_cell *cells = s->next_cells;

    s->next_cells = s->cells;
    s->cells = cells;
    memset(s->next_cells, 0, (size_t)s->width * sizeof *cells);
    while (area_walks(&w)) {
        int from = w.from;
        bool is_new = (int64_t)from * s->height >= (int64_t)y * film->height;
        float height = area_step(&w);

        film_lock_row(film, from);
        if (is_new && film->has_row[from])
            add_film_row(s, film, from, height, (float)s->height - height);
        film_unlock_row(film, from);
    }
}

/* Makes the sums of a pixel means, and adds the draft's pixel. */
static inline void add_draft(struct half_cell *cell, int half, float unit,
                             f4 draft, float draft_count)
{
    float count = cell->count[half] * unit;
    float *light = cell->light[half];
    float scale;

    cell->count[half] = count + draft_count;
    if (!(count > 0.0f)) {
        f4_store(light, draft);
        return;
    }
    scale = 1.0f / cell->count[half];
    f4_store(light,
             f4_add(f4_mul(f4_load(light), f4_set1(count * scale / light[3])),
                    f4_mul(draft, f4_set1(draft_count * scale))));
}

/* Writes a pixel to the row. */
static inline void put_cell(const struct screen_halves *s, int x,
                            const struct half_cell *cell)
{
    float inverse = 1.0f / (cell->count[0] + cell->count[1]);

    for (int c = 0; c < 3; c++) {
        s->light[0][c][x] = cell->light[0][c];
        s->light[1][c][x] = cell->light[1][c];
        s->raw[3 * x + c] = (cell->count[0] * cell->light[0][c] +
                             cell->count[1] * cell->light[1][c]) *
                            inverse;
    }
    s->count[0][x] = cell->count[0];
    s->count[1][x] = cell->count[1];
}

void screen_halves_begin(struct screen_halves *s)
{
    memset(s->next_cells, 0, (size_t)s->width * sizeof *s->next_cells);
}

void screen_halves_row(struct screen_halves *s, struct film *film,
                       struct film *draft, int y)
{
    static const struct half_cell empty;
    static const struct pixel_means none;
    float unit = 1.0f / ((float)s->width * (float)s->height);
    struct run r;

    r.end = 0;
    if (film != NULL)
        add_film(s, film, y);
    if (draft != NULL)
        film_lock_row(draft, y);
    for (int x = 0; x < s->width; x++) {
        struct half_cell cell = film != NULL ? s->cells[x] : empty;
        struct pixel_means p = none;
        int even = (x + y) & 1;

        if (draft != NULL) {
            if (x >= r.end)
                convert_run(s, draft, x, y, &r);
            p = pixel_means(
                &r, x,
                draft->counts[(size_t)y * (size_t)draft->width + (size_t)x]);
        }
        add_draft(&cell, even, unit, p.even, p.even_count);
        add_draft(&cell, 1 - even, unit, p.odd, p.odd_count);
        put_cell(s, x, &cell);
    }
    if (draft != NULL)
        film_unlock_row(draft, y);
}

/* ---- detail ---- */

/* Variance of a pixel that has samples in one half only. */
#define UNKNOWN_VARIANCE 1e30f

/* Numbers of a pixel in the planes. */
#define HIGH_NUMBERS 3
#define LOW_NUMBERS  (4 + 4 + 4)

/* Weight of a pixel with seen light only. */
#define LEAST_WEIGHT 1e-6f

void screen_detail_free(struct screen_detail *d)
{
    screen_halves_free(&d->halves);
    free(d->memory);
    *d = (struct screen_detail){0};
}

static void take_planes(struct screen_detail *d, size_t high, size_t low)
{
    d->detail = d->memory;
    d->filtered = d->detail + 3 * high;
    d->low = d->filtered + 4 * low;
    d->count = d->low + 4 * low;
    d->noise = d->count + low;
    d->energy = d->noise + low;
    d->weight = d->energy + low;
    d->between = d->weight + low;
    d->row = d->between + 4 * (size_t)d->low_width;
    d->weights = d->row + 4 * (size_t)d->width;
}

bool screen_detail_init(struct screen_detail *d, int width, int height,
                        int low_width, int low_height,
                        const struct filter_loops *loops)
{
    size_t high = (size_t)width * (size_t)height;
    size_t low = (size_t)low_width * (size_t)low_height;
    size_t rows = 5 * (size_t)width + 4 * (size_t)low_width;

    *d = (struct screen_detail){
        .width = width,
        .height = height,
        .low_width = low_width,
        .low_height = low_height,
        .memory = alloc_array(HIGH_NUMBERS * high + LOW_NUMBERS * low + rows,
                              sizeof *d->memory),
    };
    if (d->memory == NULL ||
        !screen_halves_init(&d->halves, width, height, loops)) {
        screen_detail_free(d);
        return false;
    }
    take_planes(d, high, low);
    return true;
}

/* ---- enlargement ---- */

/* Place of a pixel between two pixels of a smaller picture. */
struct place {
    int first, second;
    float part; /* of the second */
};

static inline struct place place_of(int i, int size, int low_size)
{
    float at = ((float)i + 0.5f) * (float)low_size / (float)size - 0.5f;
    float floor_at = floorf(at);
    int first = (int)floor_at, last = low_size - 1;

    return (struct place){first > 0 ? first : 0,
                          first < last ? first + 1 : last, at - floor_at};
}

static void blend(const float *a, const float *b, float part, int count,
                  float *restrict to)
{
    for (int i = 0; i < count; i++)
        to[i] = a[i] + part * (b[i] - a[i]);
}

/* Enlarges row y of a picture whose pixels have `numbers` numbers. */
static void enlarge(const struct screen_detail *d, const float *picture,
                    int numbers, int y, float *to)
{
    struct place v = place_of(y, d->height, d->low_height);
    int count = numbers * d->low_width;

    blend(picture + (size_t)v.first * (size_t)count,
          picture + (size_t)v.second * (size_t)count, v.part, count,
          d->between);
    for (int x = 0; x < d->width; x++, to += numbers) {
        struct place h = place_of(x, d->width, d->low_width);

        blend(d->between + numbers * h.first, d->between + numbers * h.second,
              h.part, numbers, to);
    }
}

/* Enlarges row y of a picture whose pixels are weighted, the weight last, to
 * d->row, whose pixels have three numbers then. */
static void enlarge_weighted(const struct screen_detail *d,
                             const float *picture, int y)
{
    const float *from = d->row;
    float *to = d->row;

    enlarge(d, picture, 4, y, d->row);
    for (int x = 0; x < d->width; x++, from += 4) {
        float scale = 1.0f / from[3];

        for (int c = 0; c < 3; c++)
            *to++ = from[c] * scale;
    }
}

/* Weighs a pixel by the light in it that is not seen. */
static void put_weighted(float seen, const float rgb[3], float to[4])
{
    to[3] = fmaxf(1.0f - seen, LEAST_WEIGHT);
    for (int c = 0; c < 3; c++)
        to[c] = rgb[c] * to[3];
}

/* ---- detail ---- */

/* Returns the variance of a pixel's mean, summed over channels. */
static float variance_of(const struct screen_halves *h, int x)
{
    float a = h->count[0][x], b = h->count[1][x], square = 0.0f;

    if (!(a > 0.0f && b > 0.0f))
        return UNKNOWN_VARIANCE;
    for (int c = 0; c < 3; c++) {
        float difference = h->light[0][c][x] - h->light[1][c][x];

        square += difference * difference;
    }
    return square * (a * b / ((a + b) * (a + b)));
}

/* Returns the pixel of the filtered picture that has pixel (x, y) of the
 * result. */
static size_t low_pixel(const struct screen_detail *d, int x, int y)
{
    int row = area_cell(y, d->low_height, d->height);
    int column = area_cell(x, d->low_width, d->width);

    return (size_t)row * (size_t)d->low_width + (size_t)column;
}

/* Returns row y of the film's detail. */
static float *detail_row(const struct screen_detail *d, int y)
{
    return d->detail + 3 * (size_t)y * (size_t)d->width;
}

/* Adds row y of the film to means and noise, and keeps its pixels. */
static void add_row(struct screen_detail *d, struct film *film, int y)
{
    float *high = detail_row(d, y);

    screen_halves_row(&d->halves, film, NULL, y);
    memcpy(high, d->halves.raw, 3 * (size_t)d->width * sizeof *high);
    for (int x = 0; x < d->width; x++, high += 3) {
        size_t at = low_pixel(d, x, y);

        for (int c = 0; c < 3; c++)
            d->low[4 * at + (size_t)c] += high[c];
        d->noise[at] += variance_of(&d->halves, x);
        d->count[at]++;
    }
}

static void find_low(struct screen_detail *d, struct film *film,
                     const float *seen)
{
    size_t pixels = (size_t)d->low_width * (size_t)d->low_height;

    memset(d->low, 0, 4 * pixels * sizeof *d->low);
    memset(d->count, 0, 3 * pixels * sizeof *d->count);
    screen_halves_begin(&d->halves);
    for (int y = 0; y < d->height; y++)
        add_row(d, film, y);
    for (size_t i = 0; i < pixels; i++) {
        float *low = d->low + 4 * i, mean[3];

        for (int c = 0; c < 3; c++)
            mean[c] = low[c] / d->count[i];
        put_weighted(seen[i], mean, low);
    }
}

/* Makes the pixels of row y the detail in them, and adds its energy. */
static void find_detail(struct screen_detail *d, int y)
{
    float *detail = detail_row(d, y);

    enlarge_weighted(d, d->low, y);
    for (int i = 0; i < 3 * d->width; i++)
        detail[i] -= d->row[i];
    for (int x = 0; x < d->width; x++, detail += 3)
        d->energy[low_pixel(d, x, y)] += detail[0] * detail[0] +
                                         detail[1] * detail[1] +
                                         detail[2] * detail[2];
}

/* Returns the sum over 3x3 pixels, fewer at the edges. */
static float sum_around(const struct screen_detail *d, const float *plane,
                        int x, int y)
{
    float sum = 0.0f;

    for (int j = y > 0 ? y - 1 : y; j <= y + 1 && j < d->low_height; j++)
        for (int i = x > 0 ? x - 1 : x; i <= x + 1 && i < d->low_width; i++)
            sum += plane[(size_t)j * (size_t)d->low_width + (size_t)i];
    return sum;
}

static void find_weights(struct screen_detail *d)
{
    float *weight = d->weight;

    for (int y = 0; y < d->low_height; y++)
        for (int x = 0; x < d->low_width; x++) {
            float energy = sum_around(d, d->energy, x, y);
            float noise = sum_around(d, d->noise, x, y);

            *weight++ = energy > noise ? 1.0f - noise / energy : 0.0f;
        }
}

void screen_detail_find(struct screen_detail *d, struct film *film,
                        const float *filtered, const float *seen)
{
    uint64_t film_pixels = (uint64_t)film->width * (uint64_t)film->height;
    size_t pixels = (size_t)d->low_width * (size_t)d->low_height;

    for (size_t i = 0; i < pixels; i++)
        put_weighted(seen[i], filtered + 3 * i, d->filtered + 4 * i);
    d->has_detail = atomic_load(&film->samples) >= 2 * film_pixels;
    if (!d->has_detail)
        return;
    find_low(d, film, seen);
    for (int y = 0; y < d->height; y++)
        find_detail(d, y);
    find_weights(d);
}

const float *screen_detail_row(struct screen_detail *d, int y)
{
    const float *detail = detail_row(d, y);

    enlarge_weighted(d, d->filtered, y);
    if (!d->has_detail)
        return d->row;
    enlarge(d, d->weight, 1, y, d->weights);
    for (int i = 0; i < 3 * d->width; i++)
        d->row[i] = fmaxf(d->row[i] + d->weights[i / 3] * detail[i], 0.0f);
    return d->row;
}
