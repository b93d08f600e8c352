// SPDX-License-Identifier: MIT
#include "film/filter/screen_filter.h"

#include <stdlib.h>
#include <string.h>

#include "base/memory.h"
#include "base/min_max.h"
#include "film/filter/film_filter.h"
#include "image/frame.h"

/* Added to the normal of pixels with seen light: no others are averaged with
 * them. */
#define SEEN_NORMAL 100.0f

/* Change of a pixel, in steps of 255, up to which it is shown unfiltered, and
 * from which on it is shown filtered. */
#define CHANGE_MIN 0.25f
#define CHANGE_MAX 1.0f

/* Largest noise of a pixel that counts, relative to white. */
#define NOISE_MAX 1e9f

/* Stride of the pixels among which the greatest depth is searched. */
#define FAR_STRIDE 4

/* Floats of a pixel in the planes. */
#define PLANES (2 + 3 * 3)

/* Floats of a pixel in the row that is processed. */
#define ROWS (3 + 2)

/* Pixels of a frame that are made without the filter at once. */
#define CHUNK 64

/* The films of one run. */
struct films {
    struct screen_filter *filter;
    const struct screen_films *shown;
    bool is_empty; /* the film has no samples */
    float far;
};

/* ---- sizes ---- */

void screen_filter_draft_size(int frame_width, int frame_height, int most,
                              int *width, int *height)
{
    double pixels = (double)frame_width * (double)frame_height;
    double scale = sqrt(fmin(most / pixels, 1.0));

    *width = (int)fmax(frame_width * scale, 1.0);
    *height = (int)fmax(frame_height * scale, 1.0);
}

/* Returns true if the draft has at most the pixels of the frame along both
 * axes. */
static bool fits(const struct film *draft, const struct frame *frame)
{
    return draft->width <= frame->width && draft->height <= frame->height;
}

/* ---- memory ---- */

static size_t row_index(const struct screen_filter *f, int y)
{
    return (size_t)y * (size_t)f->width;
}

void screen_filter_free(struct screen_filter *f)
{
    filter_free(&f->filter);
    screen_halves_free(&f->halves);
    screen_detail_free(&f->detail);
    free(f->memory);
    free(f->rows);
    free(f->raw_bytes);
    free(f->filtered_bytes);
    *f = (struct screen_filter){0};
}

static bool has_detail(const struct screen_filter *f)
{
    return f->shown_width > f->width;
}

static void take_planes(struct screen_filter *f)
{
    size_t pixels = (size_t)f->width * (size_t)f->height;
    float *next = f->memory;

    f->seen = next;
    f->change = next + pixels;
    f->raw = next + 2 * pixels;
    f->rgb = next + 5 * pixels;
    f->difference = next + 8 * pixels;
    f->changes = f->rows;
    f->shares = f->changes + 3 * f->width;
    f->largest = f->shares + f->width + 1;
}

/* Allocates what depends on both sizes. The detail is of no use if the frame
 * shows no more pixels along an axis. */
static bool allocate(struct screen_filter *f)
{
    size_t width = (size_t)f->width, pixels = width * (size_t)f->height;
    struct error ignored;

    f->memory = alloc_array(pixels, PLANES * sizeof *f->memory);
    f->rows = alloc_array(width * ROWS + 2, sizeof *f->rows);
    f->raw_bytes = alloc_array(width, 3);
    f->filtered_bytes = alloc_array((size_t)f->shown_width, 3);
    return f->memory != NULL && f->rows != NULL && f->raw_bytes != NULL &&
           f->filtered_bytes != NULL &&
           filter_init(&f->filter, f->width, f->height, &ignored) &&
           screen_halves_init(&f->halves, f->width, f->height,
                              f->filter.loops) &&
           (!has_detail(f) ||
            screen_detail_init(&f->detail, f->shown_width, f->shown_height,
                               f->width, f->height, f->filter.loops));
}

/* Prepares for a draft, and for a frame that shows `film`. */
static bool resize(struct screen_filter *f, const struct film *draft,
                   const struct film *film, const struct frame *frame)
{
    int shown_width = int_min(frame->width, film->width);
    int shown_height = int_min(frame->height, film->height);

    if (shown_width <= draft->width || shown_height <= draft->height) {
        shown_width = draft->width;
        shown_height = draft->height;
    }
    if (f->width == draft->width && f->height == draft->height &&
        f->shown_width == shown_width && f->shown_height == shown_height)
        return true;
    screen_filter_free(f);
    f->width = draft->width;
    f->height = draft->height;
    f->shown_width = shown_width;
    f->shown_height = shown_height;
    if (!allocate(f)) {
        screen_filter_free(f);
        return false;
    }
    take_planes(f);
    return true;
}

/* ---- source of the filter ---- */

/* Returns the share of light in a pixel that is seen. It is 1 under a black
 * sky: the film may have the edge of a lamp there that the draft has missed. */
static inline float seen_share(const struct film *draft, size_t at)
{
    const struct sum *seen = draft->surfaces[at].seen;
    const struct sum *sums = draft->sums + 3 * at;
    float all;

    if (draft->surfaces[at].seen_count == 0)
        return 0.0f;
    all = sum_float(sums[0]) + sum_float(sums[1]) + sum_float(sums[2]);
    return all > 0.0f ? f_min((sum_float(seen[0]) + sum_float(seen[1]) +
                               sum_float(seen[2])) /
                                  all,
                              1.0f)
                      : 1.0f;
}

/* Halves count equally, for the grid of a young film would show if each pixel's
 * samples counted. */
static void give_features(void *context, int y, const struct filter_row *to)
{
    const struct films *s = context;
    struct film *surfaces = s->shown->surfaces;
    struct screen_filter *f = s->filter;
    const struct screen_halves *halves = &f->halves;
    size_t first = row_index(f, y);

    screen_halves_row(&f->halves, s->is_empty ? NULL : s->shown->film, surfaces,
                      y);
    memcpy(f->raw + 3 * first, halves->raw,
           3 * (size_t)f->width * sizeof *f->raw);
    for (int h = 0; h < 2; h++)
        for (int x = 0; x < f->width; x++)
            to->count[h][x] = halves->count[h][x] > 0.0f ? 1.0f : 0.0f;
    film_features(surfaces, s->far, y,
                  (struct film_columns){0, 1, surfaces->width}, to);
    film_lock_row(surfaces, y);
    for (int x = 0; x < f->width; x++) {
        size_t at = first + (size_t)x;

        f->seen[at] = seen_share(surfaces, at);
        if (f->seen[at] > 0.0f)
            to->normal[0][x] += SEEN_NORMAL;
    }
    film_unlock_row(surfaces, y);
}

/* Gives the row whose features were given last. */
static void give_light(void *context, int component, int y, float *to[2][3])
{
    const struct films *s = context;
    const struct screen_halves *halves = &s->filter->halves;

    (void)component, (void)y;
    for (int h = 0; h < 2; h++)
        for (int c = 0; c < 3; c++)
            memcpy(to[h][c], halves->light[h][c],
                   (size_t)halves->width * sizeof *to[h][c]);
}

/* ---- frame ---- */

/* Computes how much the filter has changed numbers in a frame, nearly, in steps
 * of 255. */
VECTORISED static void find_changes(const float *restrict raw,
                                    const float *restrict filtered,
                                    float factor, bool is_cut, int count,
                                    float *restrict change)
{
    for (int i = 0; i < count; i++) {
        float a = factor * raw[i], b = factor * filtered[i];
        float low = is_cut ? f_min(a, 1.0f) : a / (1.0f + a);
        float high = is_cut ? f_min(b, 1.0f) : b / (1.0f + b);

        change[i] = fabsf(sqrtf(high) - sqrtf(low)) * 255.0f;
    }
}

VECTORISED static void find_most(const float *restrict numbers, int width,
                                 float *restrict most)
{
    for (int x = 0; x < width; x++)
        most[x] = f_max(f_max(numbers[3 * x], numbers[3 * x + 1]),
                        numbers[3 * x + 2]);
}

/* Computes the changes of the pixels of row y. */
static void row_changes(const struct screen_filter *f, int y,
                        struct develop how)
{
    size_t at = row_index(f, y);

    find_changes(f->raw + 3 * at, f->rgb + 3 * at, develop_factor(how),
                 how.tone == TONE_LINEAR, 3 * f->width, f->changes);
    find_most(f->changes, f->width, f->change + at);
}

VECTORISED static void find_largest(const float *restrict above,
                                    const float *restrict row,
                                    const float *restrict below, int width,
                                    float *restrict largest)
{
    for (int x = 0; x < width; x++)
        largest[x] = f_max(f_max(above[x], below[x]), row[x]);
}

/* Computes the shares of the filtered picture from the largest changes, whose
 * row has a pixel more on each side. */
VECTORISED static void find_shares(const float *restrict largest,
                                   const float *restrict seen, int width,
                                   float *restrict share)
{
    for (int x = 0; x < width; x++) {
        float change = f_max(f_max(largest[x - 1], largest[x + 1]), largest[x]);
        float part = (change - CHANGE_MIN) * (1.0f / (CHANGE_MAX - CHANGE_MIN));

        share[x] = f_max(f_min(part, 1.0f), 0.0f) * (1.0f - seen[x]);
    }
}

/* Computes the share of the filtered picture in each pixel of row y, from the
 * changes of the pixels around it. */
static const float *row_shares(const struct screen_filter *f, int y)
{
    const float *row = f->change + row_index(f, y);
    const float *above = y > 0 ? row - f->width : row;
    const float *below = y < f->height - 1 ? row + f->width : row;

    find_largest(above, row, below, f->width, f->largest);
    find_shares(f->largest, f->seen + row_index(f, y), f->width, f->shares);
    return f->shares;
}

/* A frame to be filled. */
struct target {
    const struct films *films;
    struct develop how;
    struct frame *frame;
};

/* Fills pixels of row y of the frame without the filter. While the film is
 * empty, they are those of the unfiltered draft. */
static void put_raw(const struct target *t, int x, int y, int count)
{
    const struct screen_filter *f = t->films->filter;
    uint8_t *to =
        t->frame->rgb + 3 * ((size_t)y * (size_t)t->frame->width + (size_t)x);

    if (!t->films->is_empty) {
        film_preview_part(t->films->shown->film, t->films->shown->draft, t->how,
                          (struct film_pixels){x, y, 1, count}, t->frame);
        return;
    }
    for (int i = x; i < x + count; i++, to += 3)
        memcpy(to,
               f->raw_bytes +
                   3 * (size_t)area_cell(i, f->width, t->frame->width),
               3);
}

static void mix_pixel(float share, const uint8_t *filtered, uint8_t *to)
{
    for (int c = 0; c < 3; c++)
        to[c] = (uint8_t)(share * (float)filtered[c] +
                          (1.0f - share) * (float)to[c] + 0.5f);
}

/* Fills up to CHUNK pixels of row y. */
static void put_chunk(const struct target *t, const float *share, int first,
                      int y, int count)
{
    const struct screen_filter *f = t->films->filter;
    int width = t->frame->width;
    uint8_t *to =
        t->frame->rgb + 3 * ((size_t)y * (size_t)width + (size_t)first);
    float shares[CHUNK];
    float least = 1.0f;

    for (int i = 0; i < count; i++) {
        shares[i] = share[area_cell(first + i, f->width, width)];
        least = f_min(least, shares[i]);
    }
    if (least < 1.0f)
        put_raw(t, first, y, count);
    for (int i = 0; i < count; i++, to += 3) {
        int from = area_cell(first + i, f->shown_width, width);
        const uint8_t *filtered = f->filtered_bytes + 3 * (size_t)from;

        if (shares[i] >= 1.0f)
            memcpy(to, filtered, 3);
        else
            mix_pixel(shares[i], filtered, to);
    }
}

/* Returns the row of the filtered picture that row y of the frame shows. */
static const float *filtered_row(const struct target *t, int y)
{
    struct screen_filter *f = t->films->filter;
    int from = area_cell(y, f->shown_height, t->frame->height);

    return has_detail(f) ? screen_detail_row(&f->detail, from)
                         : f->rgb + 3 * row_index(f, from);
}

static void put_row(const struct target *t, int y)
{
    const struct screen_filter *f = t->films->filter;
    int from = area_cell(y, f->height, t->frame->height);
    const float *share = row_shares(f, from);

    develop_row(t->how, f->shown_width, filtered_row(t, y), f->filtered_bytes);
    if (t->films->is_empty)
        develop_row(t->how, f->width, f->raw + 3 * row_index(f, from),
                    f->raw_bytes);
    for (int x = 0; x < t->frame->width; x += CHUNK) {
        int left = t->frame->width - x;

        put_chunk(t, share, x, y, left < CHUNK ? left : CHUNK);
    }
}

static double find_error(const struct screen_filter *f, float factor)
{
    size_t pixels = (size_t)f->width * (size_t)f->height;
    double sum = 0;

    for (size_t i = 0; i < 3 * pixels; i++) {
        float light = factor * f->rgb[i];
        float noise = f_min(fabsf(factor * f->difference[i]), NOISE_MAX);

        sum += (double)((1.0f - f->seen[i / 3]) * noise * noise /
                        (light * light + FILM_ERROR_BLACK));
    }
    return SCREEN_FILTER_ERROR * sqrt(sum / (3.0 * (double)pixels));
}

bool screen_filter_show(struct screen_filter *f,
                        const struct screen_films *shown, struct develop how,
                        enum filter_form form, struct frame *frame)
{
    struct film *film = shown->film, *surfaces = shown->surfaces;
    struct films context = {f, shown, atomic_load(&film->samples) == 0, 0.0f};
    const struct filter_source source = {&context, 1, give_features, give_light,
                                         frame->cancel};
    struct target target = {&context, how, frame};

    if (!fits(surfaces, frame) || !resize(f, surfaces, film, frame))
        return false;
    screen_halves_begin(&f->halves);
    context.far = film_features_far(surfaces, FAR_STRIDE);
    filter_run(&f->filter, &source, form, NULL,
               &(struct filter_result){f->rgb, NULL, f->difference});
    f->error = find_error(f, develop_factor(how));
    if (has_detail(f))
        screen_detail_find(&f->detail, film, f->rgb, f->seen);
    for (int y = 0; y < f->height; y++)
        row_changes(f, y, how);
    for (int y = 0; frame_has_row(frame, y); y++)
        put_row(&target, y);
    return true;
}
