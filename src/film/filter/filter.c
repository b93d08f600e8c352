// SPDX-License-Identifier: MIT
#include "film/filter/filter.h"

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

#include "base/machine.h"
#include "base/memory.h"

/* ---- builds of the loops ---- */

extern const struct filter_loops filter_loops_plain, filter_loops_avx2,
    filter_loops_avx512;

static bool always(void)
{
    return true;
}

/* Instruction sets, fastest first. */
static const struct {
    const struct filter_loops *loops;
    bool (*is_supported)(void);
} sets[] = {
#if defined(__x86_64__)
    {&filter_loops_avx512, cpu_has_avx512},
    {&filter_loops_avx2, cpu_has_avx2},
#endif
    {&filter_loops_plain, always},
};

const struct filter_loops *filter_loops_at(int i)
{
    for (size_t k = 0; k < sizeof sets / sizeof sets[0]; k++)
        if (sets[k].is_supported() && i-- == 0)
            return sets[k].loops;
    return NULL;
}

/* ---- the filter ---- */

/* Planes of two copies of two halves, weights of pairs and of opposite pixels,
 * features with their noise, samples, albedo, and counts. */
#define PLANES (2 * 8 + 4 * FILTER_PAIRS + FILTER_FEATURES + 1 + 1 + 1 + 2)

/* Least sum of weights from which the missing half of a pixel is taken. */
#define GAP_WEIGHT_MIN 1e-3f

/* One run of the filter, for workers. */
struct job {
    struct filter *filter;
    const struct filter_source *source;
    int component;
    float depth_scale;
    float mean_samples;
    float light_scale;
    struct filter_level level;
    struct filter_result result;
};

static bool is_cancelled(const struct job *j)
{
    return j->source->cancel != NULL && cancel_requested(j->source->cancel);
}

/* ---- planes ---- */

static struct filter_tile whole_row(const struct filter_planes *p, int y)
{
    return (struct filter_tile){0, y, p->width, 1};
}

/* Takes the next plane of the memory. Returns its pixel (0, 0). */
static float *take(const struct filter_planes *p, float **next)
{
    float *first = *next + FILTER_PAD * p->pitch + FILTER_MARGIN;

    *next += p->pitch * (p->height + 2 * FILTER_PAD);
    return first;
}

/* Returns the first float that begins a cache line. */
static float *first_line(float *memory)
{
    size_t rest = (uintptr_t)memory / sizeof *memory % FILTER_LINE;

    return memory + (FILTER_LINE - rest) % FILTER_LINE;
}

bool filter_init(struct filter *f, int width, int height, struct error *err)
{
    struct filter_planes *p = &f->planes;
    int lines = (width + FILTER_LINE - 1) / FILTER_LINE;
    int pitch = lines * FILTER_LINE + 2 * FILTER_MARGIN;
    size_t floats = (size_t)pitch * (size_t)(height + 2 * FILTER_PAD);
    float *next;

    *f = (struct filter){.loops = filter_loops_at(0)};
    /* zeroed by the system when workers touch it, not by this thread */
    f->memory = alloc_array(floats * PLANES + FILTER_LINE, sizeof *f->memory);
    f->row_max = alloc_array((size_t)height, sizeof *f->row_max);
    if (f->memory == NULL || f->row_max == NULL) {
        filter_free(f);
        return fail(err, "out of memory for filtering %dx%d pixels", width,
                    height);
    }
    p->width = width;
    p->height = height;
    p->pitch = pitch;
    next = first_line(f->memory);
    for (int i = 0; i < 2; i++)
        for (int h = 0; h < 2; h++) {
            for (int c = 0; c < 3; c++)
                p->halves[i].light[h][c] = take(p, &next);
            p->halves[i].variance[h] = take(p, &next);
        }
    for (int h = 0; h < 2; h++)
        for (int k = 0; k < FILTER_PAIRS; k++)
            p->weights[h][k] = take(p, &next);
    for (int h = 0; h < 2; h++)
        for (int k = 0; k < FILTER_PAIRS; k++)
            p->opposite[h][k] = take(p, &next);
    for (int i = 0; i < FILTER_FEATURES; i++)
        p->features.means[i] = take(p, &next);
    p->features.noise = take(p, &next);
    p->samples = take(p, &next);
    p->albedo = take(p, &next);
    for (int h = 0; h < 2; h++)
        f->count[h] = take(p, &next);
    return true;
}

void filter_free(struct filter *f)
{
    free(f->memory);
    free(f->row_max);
    *f = (struct filter){0};
}

/* ---- rows of the source ---- */

/* Lets the source fill a row. Noise of normals and depths goes to planes that
 * are free until the first level. */
static void load_features(void *context, uint32_t item, int worker)
{
    struct job *j = context;
    const struct filter_planes *p = &j->filter->planes;
    ptrdiff_t at = (int)item * p->pitch;
    float *normal_noise = p->halves[1].light[0][0] + at;
    float *noise = p->features.noise + at;
    struct filter_row to = {
        .depth = p->features.means[6] + at,
        .albedo_noise = noise,
        .normal_noise = normal_noise,
        .depth_noise = p->halves[1].light[0][1] + at,
        .count = {j->filter->count[0] + at, j->filter->count[1] + at},
    };

    (void)worker;
    for (int c = 0; c < 3; c++) {
        to.albedo[c] = p->features.means[c] + at;
        to.normal[c] = p->features.means[3 + c] + at;
    }
    j->source->features(j->source->context, (int)item, &to);
    for (int x = 0; x < p->width; x++) {
        for (int c = 0; c < 3; c++) {
            to.albedo[c][x] *= FILTER_ALBEDO_SCALE;
            to.normal[c][x] *= FILTER_NORMAL_SCALE;
        }
        noise[x] =
            noise[x] * (FILTER_ALBEDO_SCALE * FILTER_ALBEDO_SCALE) +
            normal_noise[x] * (FILTER_NORMAL_SCALE * FILTER_NORMAL_SCALE);
    }
}

/* Divides the light of both halves in a row by the albedo. */
VECTORISED static void divide(const float *restrict albedo, int width,
                              float *restrict a, float *restrict b)
{
    for (int x = 0; x < width; x++) {
        float inverse = 1.0f / (albedo[x] * (1.0f / FILTER_ALBEDO_SCALE) +
                                FILTER_ALBEDO_MIN);

        a[x] *= inverse;
        b[x] *= inverse;
    }
}

VECTORISED static void scale_by(const float *restrict factors, int width,
                                float *restrict light)
{
    for (int x = 0; x < width; x++)
        light[x] *= factors[x];
}

/* Returns the largest of numbers that are not negative, compared as integers.
 */
VECTORISED static float largest(const float *x, int count, float least)
{
    int32_t most = (int32_t)float_bits(least);

    for (int i = 0; i < count; i++) {
        int32_t bits = (int32_t)float_bits(x[i]);

        most = bits > most ? bits : most;
    }
    return bits_float((uint32_t)most);
}

static void load_light(void *context, uint32_t item, int worker)
{
    struct job *j = context;
    const struct filter_planes *p = &j->filter->planes;
    ptrdiff_t at = (int)item * p->pitch;
    float *to[2][3];

    (void)worker;
    for (int h = 0; h < 2; h++)
        for (int c = 0; c < 3; c++)
            to[h][c] = p->halves[0].light[h][c] + at;
    j->source->light(j->source->context, j->component, (int)item, to);
}

static void divide_light(void *context, uint32_t item, int worker)
{
    struct job *j = context;
    const struct filter_planes *p = &j->filter->planes;
    ptrdiff_t at = (int)item * p->pitch;

    (void)worker;
    for (int c = 0; c < 3; c++)
        divide(p->features.means[c] + at, p->width,
               p->halves[0].light[0][c] + at, p->halves[0].light[1][c] + at);
}

/* Loads a row of the features and of the first component, one after the other,
 * so that a source may compute both at once. */
static void load_row(void *context, uint32_t item, int worker)
{
    load_features(context, item, worker);
    load_light(context, item, worker);
}

/* Scales what is relative to means of the picture. */
static void scale_features(void *context, uint32_t item, int worker)
{
    struct job *j = context;
    const struct filter *f = j->filter;
    const struct filter_planes *p = &f->planes;
    struct filter_tile row = whole_row(p, (int)item);
    ptrdiff_t at = (int)item * p->pitch;
    float *depth = p->features.means[6] + at;
    const float *depth_noise = p->halves[1].light[0][1] + at;
    float *noise = p->features.noise + at;
    float scale = j->depth_scale;

    (void)worker;
    for (int x = 0; x < p->width; x++) {
        depth[x] *= scale;
        noise[x] += depth_noise[x] * scale * scale;
        p->samples[at + x] =
            (f->count[0][at + x] + f->count[1][at + x]) / j->mean_samples;
    }
    for (int i = 0; i < FILTER_FEATURES; i++)
        filter_extend(p, p->features.means[i], row);
    filter_extend(p, p->features.noise, row);
    filter_extend(p, p->samples, row);
}

/* Returns the inverse of the depth difference that is an edge. */
static float depth_scale(const struct filter_planes *p)
{
    double pixels = (double)p->width * p->height;
    double sum = 0;

    for (int y = 0; y < p->height; y++)
        for (int x = 0; x < p->width; x++)
            sum += p->features.means[6][y * p->pitch + x];
    return sum > 0 ? (float)(FILTER_DEPTH_SCALE * pixels / sum) : 0;
}

/* Returns the mean number of samples. */
static float mean_samples(const struct filter *f)
{
    const struct filter_planes *p = &f->planes;
    double pixels = (double)p->width * p->height;
    double sum = 0;

    for (int y = 0; y < p->height; y++)
        for (int x = 0; x < p->width; x++) {
            ptrdiff_t at = y * p->pitch + x;

            sum += (double)f->count[0][at] + (double)f->count[1][at];
        }
    return (float)(sum / pixels);
}

/* ---- light ---- */

/* Returns the number by which light of a pixel is divided. */
static float divisor(const struct filter_planes *p, int c, ptrdiff_t at)
{
    return p->features.means[c][at] * (1.0f / FILTER_ALBEDO_SCALE) +
           FILTER_ALBEDO_MIN;
}

/* Returns the weight of pixel q in the light of p: small where features differ,
 * so that lamps do not shine into their neighbours. */
static float gap_weight(const struct filter_planes *planes, ptrdiff_t p,
                        ptrdiff_t q)
{
    float square = 0.0f;

    for (int i = 0; i < FILTER_FEATURES; i++) {
        float difference =
            planes->features.means[i][p] - planes->features.means[i][q];

        square += difference * difference;
    }
    return filter_weight(1.0f, 0.0f, square);
}

/* Fills half h of a pixel that has no samples there with the mean of the four
 * pixels beside it, or with the pixel's other half. */
static void fill_pixel(const struct filter *f, int h, int x, int y)
{
    const struct filter_planes *p = &f->planes;
    ptrdiff_t at = y * p->pitch + x;
    const ptrdiff_t beside[] = {x > 0 ? at - 1 : at,
                                x < p->width - 1 ? at + 1 : at,
                                y > 0 ? at - p->pitch : at,
                                y < p->height - 1 ? at + p->pitch : at};
    float sum[3] = {0}, weights = 0;

    for (int i = 0; i < 4; i++) {
        float weight =
            f->count[h][beside[i]] > 0.0f ? gap_weight(p, at, beside[i]) : 0.0f;

        for (int c = 0; c < 3; c++)
            sum[c] += weight * p->halves[0].light[h][c][beside[i]];
        weights += weight;
    }
    for (int c = 0; c < 3; c++)
        p->halves[0].light[h][c][at] = weights > GAP_WEIGHT_MIN
                                           ? sum[c] / weights
                                           : p->halves[0].light[1 - h][c][at];
}

static void fill_gaps(void *context, uint32_t item, int worker)
{
    struct job *j = context;
    const struct filter *f = j->filter;
    ptrdiff_t at = (int)item * f->planes.pitch;

    (void)worker;
    for (int h = 0; h < 2; h++)
        for (int x = 0; x < f->planes.width; x++)
            if (!(f->count[h][at + x] > 0.0f))
                fill_pixel(f, h, x, (int)item);
}

/* Sums the channels of a row, to planes that are free until the first level. */
static void sum_channels(void *context, uint32_t item, int worker)
{
    struct job *j = context;
    const struct filter_planes *p = &j->filter->planes;
    ptrdiff_t at = (int)item * p->pitch;

    (void)worker;
    for (int h = 0; h < 2; h++) {
        float *const *light = p->halves[0].light[h];
        float *to = p->halves[1].light[h][0];

        for (int x = 0; x < p->width; x++)
            to[at + x] = light[0][at + x] + light[1][at + x] + light[2][at + x];
        filter_extend(p, to, whole_row(p, (int)item));
    }
}

/* Sums the light of the 24 pixels around each pixel of a row. */
VECTORISED static void sum_around(const float *light, ptrdiff_t pitch,
                                  int width, float *restrict sums)
{
    for (int x = 0; x < width; x++)
        sums[x] = 0.0f;
    for (int dy = -2; dy <= 2; dy++)
        for (int x = 0; dy != 0 && x < width; x++) {
            const float *row = light + dy * pitch + x;

            sums[x] += row[-2] + row[-1] + row[0] + row[1] + row[2];
        }
    for (int x = 0; x < width; x++)
        sums[x] += light[x - 2] + light[x - 1] + light[x + 1] + light[x + 2];
}

/* Computes the factors of both halves of a row's pixels, in place of the sums
 * of the 24 pixels around them. */
VECTORISED static void lone_factors(const float *const light[2],
                                    const float *const count[2], int width,
                                    float *restrict a, float *restrict b)
{
    const float *first = light[0], *second = light[1];

    for (int x = 0; x < width; x++) {
        float around = a[x] + b[x];

        a[x] = filter_lone_factor(first[x], around + second[x], count[0][x]);
        b[x] = filter_lone_factor(second[x], around + first[x], count[1][x]);
    }
}

/* Limits the lone light of a row, and notes the most that remains. */
static void limit_lone_light(void *context, uint32_t item, int worker)
{
    struct job *j = context;
    const struct filter *f = j->filter;
    const struct filter_planes *p = &f->planes;
    ptrdiff_t at = (int)item * p->pitch;
    const float *const light[2] = {p->halves[1].light[0][0] + at,
                                   p->halves[1].light[1][0] + at};
    const float *const count[2] = {f->count[0] + at, f->count[1] + at};
    float *factors[2] = {p->halves[1].light[0][1] + at,
                         p->halves[1].light[1][1] + at};
    float max = 0;

    (void)worker;
    for (int h = 0; h < 2; h++)
        sum_around(light[h], p->pitch, p->width, factors[h]);
    lone_factors(light, count, p->width, factors[0], factors[1]);
    for (int h = 0; h < 2; h++)
        for (int c = 0; c < 3; c++) {
            float *to = p->halves[0].light[h][c] + at;

            scale_by(factors[h], p->width, to);
            max = largest(to, p->width, max);
        }
    f->row_max[item] = max;
}

/* Returns the power of two that scales the light for the levels. */
static float light_scale(const struct filter *f)
{
    float max = 0;
    int exponent;

    for (int y = 0; y < f->planes.height; y++)
        max = f_max(f->row_max[y], max);
    exponent = (int)(float_bits(max) >> 23) - 127; /* -127 of 0 */
    exponent = FILTER_TOP - exponent;
    return bits_float((uint32_t)(exponent < 120 ? exponent + 127 : 247) << 23);
}

static void scale_light(void *context, uint32_t item, int worker)
{
    struct job *j = context;
    const struct filter_planes *p = &j->filter->planes;
    struct filter_tile row = whole_row(p, (int)item);

    (void)worker;
    for (int h = 0; h < 2; h++)
        for (int c = 0; c < 3; c++) {
            float *light = p->halves[0].light[h][c] + (int)item * p->pitch;

            for (int x = 0; x < p->width; x++)
                light[x] *= j->light_scale;
            filter_extend(p, p->halves[0].light[h][c], row);
        }
}

/* ---- levels ---- */

static void run_variance(void *context, uint32_t item, int worker)
{
    struct job *j = context;
    const struct filter *f = j->filter;

    (void)worker;
    f->loops->variance(&f->planes, filter_tile_at(&f->planes, item));
}

static void run_weights(void *context, uint32_t item, int worker)
{
    struct job *j = context;
    const struct filter *f = j->filter;

    (void)worker;
    if (!is_cancelled(j))
        f->loops->weigh(&f->planes, filter_tile_at(&f->planes, item),
                        &j->level);
}

static void run_average(void *context, uint32_t item, int worker)
{
    struct job *j = context;
    const struct filter *f = j->filter;

    (void)worker;
    if (!is_cancelled(j))
        f->loops->average(&f->planes, filter_tile_at(&f->planes, item),
                          &j->level);
}

/* Returns features in the planes of halves[1], which are free until the first
 * level of light. */
static struct filter_features spare_features(const struct filter_planes *p)
{
    const struct filter_halves *h = &p->halves[1];

    return (struct filter_features){.means = {h->light[0][0], h->light[0][1],
                                              h->light[0][2], h->light[1][0],
                                              h->light[1][1], h->light[1][2],
                                              h->variance[0]},
                                    .noise = h->variance[1]};
}

static void set_spare_features(struct filter_planes *p,
                               const struct filter_features *f)
{
    struct filter_halves *h = &p->halves[1];

    for (int c = 0; c < 3; c++) {
        h->light[0][c] = f->means[c];
        h->light[1][c] = f->means[3 + c];
    }
    h->variance[0] = f->means[6];
    h->variance[1] = f->noise;
}

static void run_feature_weights(void *context, uint32_t item, int worker)
{
    struct job *j = context;
    const struct filter *f = j->filter;

    (void)worker;
    f->loops->weigh_features(&f->planes, filter_tile_at(&f->planes, item),
                             j->level.step);
}

static void run_feature_average(void *context, uint32_t item, int worker)
{
    struct job *j = context;
    const struct filter *f = j->filter;
    struct filter_features to = spare_features(&f->planes);

    (void)worker;
    f->loops->average_features(&f->planes, filter_tile_at(&f->planes, item),
                               j->level.step, &to);
}

/* Averages features over pixels that differ by noise only. */
static void smooth_features(struct job *j, struct pool *pool)
{
    struct filter_planes *p = &j->filter->planes;

    for (int l = 0; l < FILTER_FEATURE_LEVELS && !is_cancelled(j); l++) {
        struct filter_features to = spare_features(p);

        j->level.step = 1 << l;
        pool_each(pool, filter_tile_count(p), run_feature_weights, j);
        pool_each(pool, filter_tile_count(p), run_feature_average, j);
        set_spare_features(p, &p->features);
        p->features = to;
    }
}

/* Sums the channels of the albedo in a row, as light is divided by them. */
static void sum_albedo(void *context, uint32_t item, int worker)
{
    struct job *j = context;
    const struct filter_planes *p = &j->filter->planes;
    ptrdiff_t at = (int)item * p->pitch;

    (void)worker;
    for (int x = 0; x < p->width; x++, at++)
        p->albedo[at] =
            divisor(p, 0, at) + divisor(p, 1, at) + divisor(p, 2, at);
}

/* Runs a level in this thread, row of tiles after row of tiles, while weights
 * are in a near cache. Averages need no weights of the rows below. */
static void run_level(struct job *j)
{
    const struct filter_planes *p = &j->filter->planes;
    uint32_t columns = filter_tile_columns(p);

    for (uint32_t first = 0; first < filter_tile_count(p); first += columns) {
        for (uint32_t i = 0; i < columns; i++)
            run_weights(j, first + i, 0);
        for (uint32_t i = 0; i < columns; i++)
            run_average(j, first + i, 0);
    }
}

/* Adds the variance of the mean of both halves, with a and b samples, to that
 * of the picture: a third for each channel. */
static void add_variance(const struct job *j, float a, float b, ptrdiff_t at,
                         float *to)
{
    const struct filter_planes *p = &j->filter->planes;
    const struct filter_halves *halves = &p->halves[j->level.from];
    float inverse = 1.0f / (j->light_scale * (a + b));
    float sum = halves->variance[0][at] * (a * inverse) * (a * inverse) +
                halves->variance[1][at] * (b * inverse) * (b * inverse);

    for (int c = 0; c < 3; c++)
        to[c] += sum * (1.0f / 3.0f) * divisor(p, c, at) * divisor(p, c, at);
}

static void add_difference(const struct job *j, ptrdiff_t at, float *to)
{
    const struct filter_planes *p = &j->filter->planes;
    const struct filter_halves *halves = &p->halves[j->level.from];

    for (int c = 0; c < 3; c++)
        to[c] += 0.5f / j->light_scale *
                 (halves->light[0][c][at] - halves->light[1][c][at]) *
                 divisor(p, c, at);
}

/* Adds a row of the filtered component to the picture. */
static void add_row(void *context, uint32_t item, int worker)
{
    struct job *j = context;
    const struct filter *f = j->filter;
    const struct filter_planes *p = &f->planes;
    const struct filter_halves *halves = &p->halves[j->level.from];
    ptrdiff_t at = (int)item * p->pitch;
    size_t to = 3 * (size_t)item * (size_t)p->width;
    float unit = 1.0f / j->light_scale;

    (void)worker;
    for (int x = 0; x < p->width; x++, at++, to += 3) {
        bool has_gap = !(f->count[0][at] > 0.0f && f->count[1][at] > 0.0f);
        float a = has_gap ? 1.0f : f->count[0][at];
        float b = has_gap ? 1.0f : f->count[1][at];
        float inverse = unit / (a + b);

        for (int c = 0; c < 3; c++) {
            float light =
                (a * halves->light[0][c][at] + b * halves->light[1][c][at]) *
                inverse;

            j->result.rgb[to + (size_t)c] += light * divisor(p, c, at);
        }
        if (j->result.variance != NULL)
            add_variance(j, a, b, at, j->result.variance + to);
        if (j->result.difference != NULL)
            add_difference(j, at, j->result.difference + to);
    }
}

static const struct {
    int levels;
    bool has_opposite;
} forms[] = {[FILTER_FULL] = {FILTER_LEVELS, true}, [FILTER_FAST] = {4, false}};

static void run_component(struct job *j, enum filter_form form,
                          struct pool *pool)
{
    const struct filter_planes *p = &j->filter->planes;
    uint32_t rows = (uint32_t)p->height;

    if (j->component > 0)
        pool_each(pool, rows, load_light, j);
    pool_each(pool, rows, divide_light, j);
    pool_each(pool, rows, fill_gaps, j);
    pool_each(pool, rows, sum_channels, j);
    pool_each(pool, rows, limit_lone_light, j);
    j->light_scale = light_scale(j->filter);
    pool_each(pool, rows, scale_light, j);
    pool_each(pool, filter_tile_count(p), run_variance, j);
    for (int l = 0; l < forms[form].levels; l++) {
        j->level =
            (struct filter_level){.from = l & 1,
                                  .step = 1 << l,
                                  .has_opposite = forms[form].has_opposite,
                                  .is_last = l == forms[form].levels - 1 &&
                                             j->result.variance == NULL};
        if (pool == NULL) {
            run_level(j);
            continue;
        }
        pool_each(pool, filter_tile_count(p), run_weights, j);
        pool_each(pool, filter_tile_count(p), run_average, j);
    }
    j->level.from = forms[form].levels & 1;
    pool_each(pool, rows, add_row, j);
}

void filter_run(struct filter *f, const struct filter_source *source,
                enum filter_form form, struct pool *pool,
                const struct filter_result *result)
{
    const struct filter_planes *p = &f->planes;
    uint32_t rows = (uint32_t)p->height;
    size_t size_bytes = (size_t)p->width * rows * 3 * sizeof *result->rgb;
    struct job j = {.filter = f, .source = source, .result = *result};

    memset(result->rgb, 0, size_bytes);
    if (result->variance != NULL)
        memset(result->variance, 0, size_bytes);
    if (result->difference != NULL)
        memset(result->difference, 0, size_bytes);
    pool_each(pool, rows, load_row, &j);
    j.depth_scale = depth_scale(p);
    j.mean_samples = mean_samples(f);
    pool_each(pool, rows, scale_features, &j);
    smooth_features(&j, pool);
    pool_each(pool, rows, sum_albedo, &j);
    for (; j.component < source->component_count && !is_cancelled(&j);
         j.component++)
        run_component(&j, form, pool);
}
