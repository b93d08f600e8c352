// SPDX-License-Identifier: MIT
#include "filter/screen_filter.h"

#include <stdlib.h>
#include <string.h>

#include "base/memory.h"
#include "filter/film_features.h"
#include "picture/area.h"

/* Added to the normal of pixels with seen light: no others are averaged with
 * them. */
#define SEEN_NORMAL 100.0f

/* Largest change of a developed pixel, in steps of 255, with which it is shown
 * unfiltered, and the least with which it is shown filtered. */
#define CHANGE_LEAST 1
#define CHANGE_MOST  4

/* Floats of a pixel in the planes. */
#define PLANES (2 * 3 + 2 + 1 + 3)

/* The films of one run. */
struct films {
    struct screen_filter *filter;
    struct film *film, *draft, *surfaces;
    float far;
};

/* Sums of a half over the film's pixels in a pixel of the screen. */
struct part {
    float light[3]; /* means, weighted by area */
    float area;     /* of the pixels that have samples */
    float samples;  /* weighted by area */
};

static size_t row_index(const struct screen_filter *f, int y)
{
    return (size_t)y * (size_t)f->width;
}

/* ---- memory ---- */

void screen_filter_free(struct screen_filter *f)
{
    filter_free(&f->filter);
    free(f->memory);
    free(f->bytes[0]);
    *f = (struct screen_filter){0};
}

static void take_planes(struct screen_filter *f)
{
    size_t pixels = (size_t)f->width * (size_t)f->height;
    float *next = f->memory;

    for (int h = 0; h < 2; h++) {
        for (int c = 0; c < 3; c++, next += pixels)
            f->light[h][c] = next;
        f->count[h] = next;
        next += pixels;
    }
    f->seen = next;
    f->rgb = next + pixels;
    f->bytes[1] = f->bytes[0] + 3 * pixels;
    f->change = f->bytes[1] + 3 * pixels;
}

static bool resize(struct screen_filter *f, int width, int height)
{
    size_t pixels = (size_t)width * (size_t)height;
    struct error ignored;

    if (f->width == width && f->height == height)
        return true;
    screen_filter_free(f);
    f->memory = alloc_array(pixels, PLANES * sizeof *f->memory);
    f->bytes[0] = alloc_array(pixels, 7);
    if (f->memory == NULL || f->bytes[0] == NULL ||
        !filter_init(&f->filter, width, height, &ignored)) {
        screen_filter_free(f);
        return false;
    }
    f->width = width;
    f->height = height;
    take_planes(f);
    return true;
}

/* ---- halves ---- */

/* Means and numbers of samples of the halves of a pixel. */
struct pixel_halves {
    float light[2][3];
    float count[2];
};

static inline struct pixel_halves pixel_halves(const struct film *f, int x,
                                               int y)
{
    size_t at = (size_t)y * (size_t)f->width + (size_t)x;
    uint64_t count = f->counts[at];
    int odd = (x + y + 1) & 1; /* half of the odd samples */
    struct pixel_halves p = {.count = {0}};

    p.count[1 - odd] = (float)((count + 1) / 2);
    p.count[odd] = (float)(count / 2);
    for (size_t c = 0; c < 3 && count > 0; c++) {
        float all = sum_float(f->sums[3 * at + c]);
        float part = count > 1 ? sum_float(f->odd_sums[3 * at + c]) : 0.0f;

        p.light[1 - odd][c] = f_max(all - part, 0.0f) / p.count[1 - odd];
        p.light[odd][c] = count > 1 ? part / p.count[odd] : 0.0f;
    }
    return p;
}

static inline void add_part(struct part *sum, const struct pixel_halves *p,
                            int half, float area)
{
    if (!(p->count[half] > 0.0f))
        return;
    for (int c = 0; c < 3; c++)
        sum->light[c] += area * p->light[half][c];
    sum->area += area;
    sum->samples += area * p->count[half];
}

/* Adds row y of the film, of which `height` is within the row of the screen. */
static void add_film_row(const struct film *film, int width, int y,
                         float height, struct part (*row)[2])
{
    struct area_walk w = area_walk(film->width, width, 0, width);

    while (area_walks(&w)) {
        int x = w.from;
        struct pixel_halves p = pixel_halves(film, x, y);

        do {
            int i = w.to;
            float area = height * area_step(&w);

            add_part(&row[i][0], &p, 0, area);
            add_part(&row[i][1], &p, 1, area);
        } while (w.from == x && area_walks(&w));
    }
}

/* Adds the film's pixels within row y of the screen. */
static void add_film(struct film *film, const struct screen_filter *f, int y,
                     struct part (*row)[2])
{
    struct area_walk w = area_walk(film->height, f->height, y, 1);

    while (area_walks(&w)) {
        int from = w.from;
        float height = area_step(&w);

        film_lock_row(film, from);
        if (film->has_row[from])
            add_film_row(film, f->width, from, height, row);
        film_unlock_row(film, from);
    }
}

/* Sets pixel x of a row to the mean of the film's part and the draft's. */
static void set_half(const struct screen_filter *f, size_t at, int half,
                     const struct part *part, float unit,
                     const struct pixel_halves *draft)
{
    float film_count = part->samples * unit;
    float count = film_count + draft->count[half];
    float scale = part->area > 0.0f ? film_count / part->area : 0.0f;

    f->count[half][at] = count;
    for (int c = 0; c < 3; c++)
        f->light[half][c][at] =
            count > 0.0f ? (scale * part->light[c] +
                            draft->count[half] * draft->light[half][c]) /
                               count
                         : 0.0f;
}

/* Returns the share of the draft's light in a pixel that is seen. */
static float seen_share(const struct film *draft, size_t at)
{
    const struct surface_sums *s = &draft->surfaces[at];
    float seen = 0.0f, all = 0.0f;

    for (size_t c = 0; c < 3; c++) {
        seen += sum_float(s->seen[c]);
        all += sum_float(draft->sums[3 * at + c]);
    }
    return seen > 0.0f ? f_min(seen / all, 1.0f) : 0.0f;
}

static void gather_row(const struct films *s, int y, struct part (*row)[2])
{
    struct screen_filter *f = s->filter;
    float unit = 1.0f / ((float)f->width * (float)f->height);

    memset(row, 0, (size_t)f->width * sizeof *row);
    add_film(s->film, f, y, row);
    film_lock_row(s->surfaces, y);
    for (int x = 0; x < f->width; x++) {
        size_t at = row_index(f, y) + (size_t)x;
        struct pixel_halves draft = {.count = {0}};

        if (s->draft != NULL)
            draft = pixel_halves(s->draft, x, y);
        for (int h = 0; h < 2; h++)
            set_half(f, at, h, &row[x][h], unit, &draft);
        f->seen[at] = seen_share(s->surfaces, at);
    }
    film_unlock_row(s->surfaces, y);
}

static bool gather(const struct films *s)
{
    struct screen_filter *f = s->filter;
    struct part(*row)[2] = alloc_array((size_t)f->width, sizeof *row);

    for (int y = 0; y < f->height && row != NULL; y++)
        gather_row(s, y, row);
    free(row);
    return row != NULL;
}

/* ---- source of the filter ---- */

static void give_features(void *context, int y, const struct filter_row *to)
{
    const struct films *s = context;
    const struct screen_filter *f = s->filter;
    size_t at = row_index(f, y);

    film_features(s->surfaces, s->far, y, to);
    for (int h = 0; h < 2; h++)
        memcpy(to->count[h], f->count[h] + at,
               (size_t)f->width * sizeof *to->count[h]);
    for (int x = 0; x < f->width; x++)
        if (f->seen[at + (size_t)x] > 0.0f)
            to->normal[0][x] += SEEN_NORMAL;
}

static void give_light(void *context, int component, int y, float *to[2][3])
{
    const struct films *s = context;
    const struct screen_filter *f = s->filter;

    (void)component;
    for (int h = 0; h < 2; h++)
        for (int c = 0; c < 3; c++)
            memcpy(to[h][c], f->light[h][c] + row_index(f, y),
                   (size_t)f->width * sizeof *to[h][c]);
}

/* ---- frame ---- */

/* Writes the mean of both halves of a pixel. */
static void put_unfiltered(const struct screen_filter *f, size_t at, float *rgb)
{
    float a = f->count[0][at], b = f->count[1][at];

    for (int c = 0; c < 3; c++)
        rgb[c] = (a * f->light[0][c][at] + b * f->light[1][c][at]) / (a + b);
}

/* Develops the filtered picture, then the unfiltered one in its place. */
static void develop(struct screen_filter *f, struct develop how)
{
    for (int y = 0; y < f->height; y++) {
        size_t at = row_index(f, y);
        float *rgb = f->rgb + 3 * at;

        develop_row(how, f->width, rgb, f->bytes[1] + 3 * at);
        for (int x = 0; x < f->width; x++)
            put_unfiltered(f, at + (size_t)x, rgb + 3 * x);
        develop_row(how, f->width, rgb, f->bytes[0] + 3 * at);
    }
}

/* Returns the largest change of a channel of a developed pixel. */
static uint8_t change_of(const struct screen_filter *f, size_t at)
{
    int most = 0;

    for (size_t c = 0; c < 3; c++) {
        int change = f->bytes[0][3 * at + c] - f->bytes[1][3 * at + c];

        change = change < 0 ? -change : change;
        most = change > most ? change : most;
    }
    return (uint8_t)most;
}

/* Returns the largest change of the pixels around (x, y). */
static int change_around(const struct screen_filter *f, int x, int y)
{
    int most = 0;

    for (int j = y > 0 ? y - 1 : 0; j <= y + 1 && j < f->height; j++)
        for (int i = x > 0 ? x - 1 : 0; i <= x + 1 && i < f->width; i++) {
            int change = f->change[row_index(f, j) + (size_t)i];

            most = change > most ? change : most;
        }
    return most;
}

/* Returns the share of the filtered picture in a pixel. */
static float filtered_share(const struct screen_filter *f, int x, int y)
{
    float change = (float)(change_around(f, x, y) - CHANGE_LEAST) *
                   (1.0f / (CHANGE_MOST - CHANGE_LEAST));

    return f_max(f_min(change, 1.0f), 0.0f) *
           (1.0f - f->seen[row_index(f, y) + (size_t)x]);
}

static void mix(const struct screen_filter *f, struct frame *frame)
{
    for (int y = 0; y < f->height; y++)
        for (int x = 0; x < f->width; x++) {
            size_t at = row_index(f, y) + (size_t)x;
            float share = filtered_share(f, x, y);

            for (size_t c = 3 * at; c < 3 * at + 3; c++)
                frame->rgb[c] =
                    (uint8_t)(share * (float)f->bytes[1][c] +
                              (1.0f - share) * (float)frame->rgb[c] + 0.5f);
        }
}

bool screen_filter_show(struct screen_filter *f, struct film *film,
                        struct film *draft, struct film *surfaces,
                        struct develop how, int levels, struct frame *frame)
{
    struct films context = {f, film, draft, surfaces, 0.0f};
    const struct filter_source source = {&context, 1, give_features,
                                         give_light};

    if (frame->width != surfaces->width || frame->height != surfaces->height ||
        !resize(f, frame->width, frame->height) || !gather(&context))
        return false;
    context.far = film_features_far(surfaces);
    filter_run(&f->filter, &source, levels, NULL, f->rgb);
    develop(f, how);
    for (size_t i = 0; i < (size_t)f->width * (size_t)f->height; i++)
        f->change[i] = change_of(f, i);
    mix(f, frame);
    return true;
}
