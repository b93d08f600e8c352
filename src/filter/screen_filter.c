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

/* Change of a pixel, in steps of 255, up to which it is shown unfiltered, and
 * from which on it is shown filtered. */
#define CHANGE_LEAST 1.0f
#define CHANGE_MOST  4.0f

/* Stride of the pixels among which the greatest depth is searched. */
#define FAR_STRIDE 4

/* Prefetch distance in pixels. */
#define AHEAD 16

/* Floats of a pixel in the planes. */
#define PLANES (2 * 5 + 2 + 3)

/* The films of one run. */
struct films {
    struct screen_filter *filter;
    struct film *film, *draft, *surfaces;
    float far;
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
    free(f->bytes);
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
        f->area[h] = next + pixels;
        next += 2 * pixels;
    }
    f->seen = next;
    f->change = next + pixels;
    f->rgb = next + 2 * pixels;
}

static bool resize(struct screen_filter *f, int width, int height)
{
    size_t pixels = (size_t)width * (size_t)height;
    struct error ignored;

    if (f->width == width && f->height == height)
        return true;
    screen_filter_free(f);
    f->memory = alloc_array(pixels, PLANES * sizeof *f->memory);
    f->bytes = alloc_array((size_t)width, 3);
    if (f->memory == NULL || f->bytes == NULL ||
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

/* Returns the halves of pixel (x, y), whose even samples belong to half
 * `even`. */
static inline struct pixel_halves pixel_halves(const struct film *f, int x,
                                               int y, int even)
{
    size_t at = (size_t)y * (size_t)f->width + (size_t)x;
    uint64_t count = f->counts[at];
    int odd = 1 - even;
    struct pixel_halves p = {.count = {0}};

    p.count[even] = (float)film_even_count(count);
    p.count[odd] = (float)film_odd_count(count);
    if (count == 1) {
        for (size_t c = 0; c < 3; c++)
            p.light[even][c] = sum_float(f->sums[3 * at + c]);
    } else if (count > 1) {
        float even_inverse = 1.0f / p.count[even];
        float odd_inverse = 1.0f / p.count[odd];

        for (size_t c = 0; c < 3; c++) {
            float all = sum_float(f->sums[3 * at + c]);
            float part = sum_float(f->odd_sums[3 * at + c]);

            p.light[even][c] = f_max(all - part, 0.0f) * even_inverse;
            p.light[odd][c] = part * odd_inverse;
        }
    }
    return p;
}

/* Adds a half of a film's pixel to the sums of the screen's pixel `at`. */
static inline void add_part(const struct screen_filter *f, size_t at, int half,
                            const struct pixel_halves *p, float area)
{
    if (!(p->count[half] > 0.0f))
        return;
    for (int c = 0; c < 3; c++)
        f->light[half][c][at] += area * p->light[half][c];
    f->area[half][at] += area;
    f->count[half][at] += area * p->count[half];
}

/* Returns the half of the even samples of a film's pixel. It is even and odd
 * equally often on any coarse grid. */
static inline int film_half(int x, int y)
{
    return __builtin_parity((unsigned)(x ^ y));
}

/* Adds row y of the film, of which `height` is within the row of the screen
 * that begins with pixel `at`. */
static void add_film_row(const struct screen_filter *f, size_t at,
                         const struct film *film, int y, float height)
{
    struct area_walk w = area_walk(film->width, f->width, 0, f->width);

    while (area_walks(&w)) {
        int x = w.from;
        struct pixel_halves p = pixel_halves(film, x, y, film_half(x, y));

        do {
            size_t to = at + (size_t)w.to;
            float area = height * area_step(&w);

            add_part(f, to, 0, &p, area);
            add_part(f, to, 1, &p, area);
        } while (w.from == x && area_walks(&w));
    }
}

/* Adds up the film's pixels within row y of the screen. */
static void add_film(const struct screen_filter *f, struct film *film, int y)
{
    struct area_walk w = area_walk(film->height, f->height, y, 1);

    while (area_walks(&w)) {
        int from = w.from;
        float height = area_step(&w);

        film_lock_row(film, from);
        if (film->has_row[from])
            add_film_row(f, row_index(f, y), film, from, height);
        film_unlock_row(film, from);
    }
}

/* Makes sums of the film and the draft's pixel a mean. */
static inline void set_half(const struct screen_filter *f, size_t at, int half,
                            float unit, const struct pixel_halves *draft)
{
    float film_count = f->count[half][at] * unit;
    float count = film_count + draft->count[half];
    float part, inverse;

    f->count[half][at] = count;
    if (!(film_count > 0.0f)) { /* a young film has few samples */
        for (int c = 0; c < 3; c++)
            f->light[half][c][at] = draft->light[half][c];
        return;
    }
    part = film_count / f->area[half][at];
    inverse = 1.0f / count;
    for (int c = 0; c < 3; c++)
        f->light[half][c][at] = (part * f->light[half][c][at] +
                                 draft->count[half] * draft->light[half][c]) *
                                inverse;
}

/* Returns the share of the draft's light in a pixel that is seen. */
static inline float seen_share(const struct film *draft, size_t at)
{
    const struct sum *seen = draft->surfaces[at].seen;
    const struct sum *all = draft->sums + 3 * at;

    if ((seen[0].hi | seen[0].lo | seen[1].hi | seen[1].lo | seen[2].hi |
         seen[2].lo) == 0)
        return 0.0f;
    return f_min(
        (sum_float(seen[0]) + sum_float(seen[1]) + sum_float(seen[2])) /
            (sum_float(all[0]) + sum_float(all[1]) + sum_float(all[2])),
        1.0f);
}

/* Prefetches the parts of a pixel's surface that are read, which are in no
 * cache. */
static inline void prefetch(const struct surface_sums *s)
{
    __builtin_prefetch(s->seen);
    __builtin_prefetch(s->seen + 2);
    __builtin_prefetch(&s->depth);
    __builtin_prefetch(&s->count);
}

/* Fills row y with the means of film and draft. */
static void gather(const struct films *s, int y)
{
    struct screen_filter *f = s->filter;
    float unit = 1.0f / ((float)f->width * (float)f->height);
    size_t first = row_index(f, y), size = (size_t)f->width * sizeof(float);
    size_t pixels = row_index(f, f->height);

    for (int h = 0; h < 2; h++) {
        for (int c = 0; c < 3; c++)
            memset(f->light[h][c] + first, 0, size);
        memset(f->count[h] + first, 0, size);
        memset(f->area[h] + first, 0, size);
    }
    add_film(f, s->film, y);
    film_lock_row(s->surfaces, y);
    for (int x = 0; x < f->width; x++) {
        size_t at = first + (size_t)x;
        struct pixel_halves draft = {.count = {0}};

        if (at + AHEAD < pixels)
            prefetch(s->surfaces->surfaces + at + AHEAD);
        if (s->draft != NULL)
            draft = pixel_halves(s->draft, x, y, (x + y) & 1);
        set_half(f, at, 0, unit, &draft);
        set_half(f, at, 1, unit, &draft);
        f->seen[at] = seen_share(s->surfaces, at);
    }
    film_unlock_row(s->surfaces, y);
}

/* ---- source of the filter ---- */

/* Halves count equally, for the grid of a young film would show if each pixel's
 * samples counted. */
static void give_features(void *context, int y, const struct filter_row *to)
{
    const struct films *s = context;
    const struct screen_filter *f = s->filter;
    size_t at = row_index(f, y);

    gather(s, y);
    film_features(s->surfaces, s->far, y, to);
    for (int h = 0; h < 2; h++)
        for (int x = 0; x < f->width; x++)
            to->count[h][x] = f->count[h][at + (size_t)x] > 0.0f ? 1.0f : 0.0f;
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

/* Returns nearly the value of light in a frame, from 0 to 255. */
static inline float shown(float light, bool is_cut)
{
    return 255.0f * sqrtf(is_cut ? f_min(light, 1.0f) : light / (1.0f + light));
}

/* Writes the unfiltered light of a pixel. */
static inline void unfiltered(const struct screen_filter *f, size_t at,
                              float rgb[3])
{
    float a = f->count[0][at], b = f->count[1][at];
    float inverse = 1.0f / (a + b);

    for (int c = 0; c < 3; c++)
        rgb[c] = (a * f->light[0][c][at] + b * f->light[1][c][at]) * inverse;
}

/* Raises the changes of a row's pixels to those of a channel: a and b are the
 * light of the halves, na and nb their samples. */
VECTORISED static void
raise_changes(const float *restrict a, const float *restrict b,
              const float *restrict na, const float *restrict nb,
              const float *restrict filtered, float factor, bool is_cut,
              int width, float *restrict change)
{
    for (int x = 0; x < width; x++) {
        float light = (na[x] * a[x] + nb[x] * b[x]) / (na[x] + nb[x]);
        float by = shown(factor * filtered[3 * x], is_cut) -
                   shown(factor * light, is_cut);

        change[x] = f_max(fabsf(by), change[x]);
    }
}

/* Computes how much the filter has changed the pixels of row y. */
static void find_changes(const struct screen_filter *f, int y,
                         struct develop how)
{
    size_t at = row_index(f, y);

    memset(f->change + at, 0, (size_t)f->width * sizeof *f->change);
    for (size_t c = 0; c < 3; c++)
        raise_changes(f->light[0][c] + at, f->light[1][c] + at,
                      f->count[0] + at, f->count[1] + at, f->rgb + 3 * at + c,
                      develop_factor(how), how.tone == TONE_LINEAR, f->width,
                      f->change + at);
}

/* Returns the largest change of the pixels around (x, y). */
static float change_around(const struct screen_filter *f, int x, int y)
{
    float most = 0.0f;

    for (int j = y > 0 ? y - 1 : 0; j <= y + 1 && j < f->height; j++)
        for (int i = x > 0 ? x - 1 : 0; i <= x + 1 && i < f->width; i++)
            most = f_max(f->change[row_index(f, j) + (size_t)i], most);
    return most;
}

/* Returns the share of the filtered picture in a pixel. */
static float filtered_share(const struct screen_filter *f, int x, int y)
{
    float share = (change_around(f, x, y) - CHANGE_LEAST) *
                  (1.0f / (CHANGE_MOST - CHANGE_LEAST));

    return f_max(f_min(share, 1.0f), 0.0f) *
           (1.0f - f->seen[row_index(f, y) + (size_t)x]);
}

/* Returns the pixel of a picture of `size` that shows pixel i of a frame. */
static int scaled(int i, int size, int frame_size)
{
    return (int)((2 * (int64_t)i + 1) * size / (2 * (int64_t)frame_size));
}

/* Mixes a pixel into the frame. While the film is empty the frame is not filled
 * yet. */
static inline void mix(const struct screen_filter *f, int x, int y,
                       struct develop how, bool is_empty, uint8_t to[3])
{
    float share = filtered_share(f, x, y);
    const uint8_t *from = f->bytes + 3 * (size_t)x;
    float rgb[3];

    if (share >= 1.0f) {
        memcpy(to, from, 3);
        return;
    }
    if (is_empty) {
        unfiltered(f, row_index(f, y) + (size_t)x, rgb);
        develop_row(how, 1, rgb, to);
    }
    for (int c = 0; c < 3; c++)
        to[c] = (uint8_t)(share * (float)from[c] +
                          (1.0f - share) * (float)to[c] + 0.5f);
}

static void mix_rows(const struct screen_filter *f, struct develop how,
                     bool is_empty, struct frame *frame)
{
    uint8_t *to = frame->rgb;

    for (int i = 0; i < frame->height; i++) {
        int y = scaled(i, f->height, frame->height);

        develop_row(how, f->width, f->rgb + 3 * row_index(f, y), f->bytes);
        for (int j = 0; j < frame->width; j++, to += 3)
            mix(f, scaled(j, f->width, frame->width), y, how, is_empty, to);
    }
}

/* Returns true if the draft has the pixels of the frame, or those of a film
 * that the frame enlarges. */
static bool fits(const struct film *film, const struct film *draft,
                 const struct frame *frame)
{
    return (draft->width == frame->width ||
            (draft->width == film->width && film->width < frame->width)) &&
           (draft->height == frame->height ||
            (draft->height == film->height && film->height < frame->height));
}

bool screen_filter_show(struct screen_filter *f, struct film *film,
                        struct film *draft, struct film *surfaces,
                        struct develop how, int levels, struct frame *frame)
{
    struct films context = {f, film, draft, surfaces, 0.0f};
    const struct filter_source source = {&context, 1, give_features,
                                         give_light};
    bool is_empty = atomic_load(&film->samples) == 0;

    if (!fits(film, surfaces, frame) ||
        !resize(f, surfaces->width, surfaces->height))
        return false;
    if (!is_empty)
        film_preview(film, draft, how, frame);
    context.far = film_features_far(surfaces, FAR_STRIDE);
    filter_run(&f->filter, &source, levels, NULL, f->rgb);
    for (int y = 0; y < f->height; y++)
        find_changes(f, y, how);
    mix_rows(f, how, is_empty, frame);
    return true;
}
