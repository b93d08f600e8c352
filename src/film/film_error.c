// SPDX-License-Identifier: MIT
#include "film/film_error.h"

#include <math.h>
#include <stdalign.h>
#include <stdatomic.h>
#include <stdlib.h>
#include <string.h>

#include "base/memory.h"
#include "base/simd4.h"

/* Pixels of a tile, which is processed in memory on the stack. */
#define SIDE 32

/* Pixels around a tile that its local means need. */
#define HALO 3

/* Pixels on each side over which the map of the error averages. */
#define MAP_REACH 2

#define WIDE (SIDE + 2 * HALO)

/* Instead of a colour of a chess board: the pixels of both. */
#define ALL (-1)

/* Limits of means and differences, below which sums of squares are finite, and
 * of weighted differences, below which sums of third powers are. */
#define LARGEST          1e18f
#define LARGEST_WEIGHTED 1e12f

/* Deviations from the mean to the ends of the 95 % interval of the normal
 * distribution. */
#define DEVIATIONS 1.96

/* Largest logarithm of the squared upper end over the estimate: finite, but
 * beyond any picture. */
#define LOG_MAX 100

/* Pixels with the largest errors, as a share of all, and the share of the
 * error above which they make it unresolved. */
#define TOP_SHARE  0.001
#define TOP_WEIGHT 0.5

/* Bins of a histogram of errors, four for each power of two: the upper bits of
 * positive floats. */
#define BINS 1024

/* Means x and half differences e of a tile and the pixels around it, for each
 * channel, relative to white. Pixels beyond the film are 0 and have is_inside
 * 0. */
struct tile {
    float factor;              /* of the exposure */
    int x0, y0, width, height; /* without the pixels around */
    int colour; /* of a chess board, whose other pixels are left out; or ALL */
    bool is_known;
    float mean[3][WIDE][WIDE];
    float e[3][WIDE][WIDE];
    float is_inside[WIDE][WIDE];
};

/* Numbers of a pixel's samples, and what its error needs of them. Most pixels
 * have as many as the one before. */
struct counts {
    uint64_t count;
    f4 all, even, odd;
    f4 factor; /* for unequal halves, var(x) is var(a - b) times its square */
};

static void counts_set(struct counts *c, uint64_t count)
{
    float odd = (float)film_odd_count(count);
    float even = (float)film_even_count(count);

    c->count = count;
    c->all = f4_set1((float)count);
    c->even = f4_set1(even);
    c->odd = f4_set1(odd);
    c->factor = f4_set1(sqrtf(even * odd) / (float)count);
}

/* Limits numbers to `most` and above its negative. */
static inline f4 limited(f4 x, float most)
{
    return f4_max(f4_min(x, f4_set1(most)), f4_set1(-most));
}

static inline f4 sums_f4(const struct sum *s)
{
    return f4_set3(sum_float(s[0]), sum_float(s[1]), sum_float(s[2]));
}

/* Reads the mean and e of pixel `at`, whose number of samples is in `c`. */
static inline void pixel_error(const struct film *f, size_t at,
                               const struct counts *c, f4 *mean, f4 *e)
{
    f4 sum = sums_f4(f->sums + 3 * at);
    f4 odd = sums_f4(f->odd_sums + 3 * at);
    f4 difference =
        f4_sub(f4_div(f4_sub(sum, odd), c->even), f4_div(odd, c->odd));

    *mean = f4_min(f4_div(sum, c->all), f4_set1(LARGEST));
    *e = limited(f4_mul(difference, c->factor), LARGEST);
}

bool film_pixel_error(const struct film *f, size_t at, float mean[3],
                      float e[3])
{
    alignas(16) float lanes[2][4];
    struct counts c;
    f4 m, d;

    if (f->counts[at] < 2)
        return false;
    counts_set(&c, f->counts[at]);
    pixel_error(f, at, &c, &m, &d);
    f4_store(lanes[0], m);
    f4_store(lanes[1], d);
    memcpy(mean, lanes[0], 3 * sizeof *mean);
    memcpy(e, lanes[1], 3 * sizeof *e);
    return true;
}

/* Reads the film's pixel at a place of the tile, unless it has another colour.
 * Returns false if a half of it has no sample. */
static inline bool read_pixel(struct tile *t, int row, int column,
                              const struct film *f, struct counts *counts)
{
    int x = t->x0 + column - HALO, y = t->y0 + row - HALO;
    size_t at = (size_t)y * (size_t)f->width + (size_t)x;
    alignas(16) float lanes[2][4];
    f4 mean, e;

    if (t->colour != ALL && ((x + y) & 1) != t->colour)
        return true;
    if (f->counts[at] < 2)
        return false;
    if (f->counts[at] != counts->count)
        counts_set(counts, f->counts[at]);
    pixel_error(f, at, counts, &mean, &e);
    mean = f4_mul(mean, f4_set1(t->factor));
    f4_store(lanes[0], f4_min(mean, f4_set1(LARGEST)));
    f4_store(lanes[1], limited(f4_mul(e, f4_set1(t->factor)), LARGEST));
    for (int c = 0; c < 3; c++) {
        t->mean[c][row][column] = lanes[0][c];
        t->e[c][row][column] = lanes[1][c];
    }
    t->is_inside[row][column] = 1.0f;
    return true;
}

static void read_row(struct tile *t, struct film *f, int row)
{
    int y = t->y0 + row - HALO;
    int first = t->x0 >= HALO ? 0 : HALO;
    int last = t->width + 2 * HALO;
    struct counts counts = {.count = 0};

    if (y < 0 || y >= f->height)
        return;
    if (last > f->width - t->x0 + HALO)
        last = f->width - t->x0 + HALO;
    film_lock_row(f, y);
    for (int i = first; i < last; i++)
        if (!read_pixel(t, row, i, f, &counts))
            t->is_known = false;
    film_unlock_row(f, y);
}

static void read_tile(struct tile *t, struct film *f, float exposure,
                      int colour, int x0, int y0)
{
    memset(t, 0, sizeof *t);
    t->factor = develop_factor(develop_linear(exposure));
    t->colour = colour;
    t->x0 = x0;
    t->y0 = y0;
    t->width = f->width - x0 < SIDE ? f->width - x0 : SIDE;
    t->height = f->height - y0 < SIDE ? f->height - y0 : SIDE;
    t->is_known = true;
    for (int row = 0; row < t->height + 2 * HALO; row++)
        read_row(t, f, row);
}

/* Differences e of a tile times the roots of their weights, and the means m
 * around them likewise, which are at most 1. */
struct weighted {
    float e[3][SIDE][SIDE];
    float m[3][SIDE][SIDE];
};

/* Sums over the 7 rows from y on, then over 7 columns. */
static void sum_around(float values[WIDE][WIDE], int y, float sums[SIDE])
{
    float columns[WIDE];

    for (int x = 0; x < WIDE; x++)
        columns[x] = values[y][x] + values[y + 1][x] + values[y + 2][x] +
                     values[y + 3][x] + values[y + 4][x] + values[y + 5][x] +
                     values[y + 6][x];
    for (int x = 0; x < SIDE; x++)
        sums[x] = columns[x] + columns[x + 1] + columns[x + 2] +
                  columns[x + 3] + columns[x + 4] + columns[x + 5] +
                  columns[x + 6];
}

/* Share of a pixel that replaces the mean around it if it is larger, in both
 * halves. */
#define OWN_SHARE 0.25f

/* Weighs a channel by the roots of 1 / (m^2 + FILM_ERROR_BLACK). The weights
 * are corrected for the noise of m, which enlarges their mean by a few per cent
 * at a few samples: that is the second term of Taylor's series. */
static void weigh(struct tile *t, int c, struct weighted *to)
{
    float squares[WIDE][WIDE];
    float count[SIDE], mean[SIDE], square[SIDE];

    for (int y = 0; y < WIDE; y++)
        for (int x = 0; x < WIDE; x++)
            squares[y][x] = t->e[c][y][x] * t->e[c][y][x];
    for (int y = 0; y < t->height; y++) {
        sum_around(t->is_inside, y, count);
        sum_around(t->mean[c], y, mean);
        sum_around(squares, y, square);
        for (int x = 0; x < SIDE; x++) {
            float others = f_max(count[x] - 1.0f, 1.0f);
            float own = t->mean[c][y + HALO][x + HALO];
            float own_square = squares[y + HALO][x + HALO];
            float around = (mean[x] - own) / others;
            float e = t->e[c][y + HALO][x + HALO];
            float m = f_max(around, OWN_SHARE * (own - fabsf(e)));
            float variance = (square[x] - own_square) / (others * others);
            float w = 1.0f / (m * m + FILM_ERROR_BLACK);
            float curve = (3.0f * m * m - FILM_ERROR_BLACK) * w * w;
            float change = m > around ? 0.0f : -curve * variance;

            change = f_max(f_min(change, 0.5f), -0.5f);
            e *= sqrtf(w * (1.0f + change));
            to->e[c][y][x] =
                f_max(f_min(e, LARGEST_WEIGHTED), -LARGEST_WEIGHTED);
            to->m[c][y][x] = m * sqrtf(w);
        }
    }
}

/* Sums over the pixels of a film. */
struct total {
    double squares;    /* of e, weighted */
    double fourths;    /* squares of those of each pixel */
    double eighths;    /* squares of these */
    double neighbours; /* squares of the products of e of neighbours */
    double pair_count; /* of neighbours */
    double cubes;      /* of e of three neighbours, see add_corner() */
    double corner_count;
    uint64_t bin_counts[BINS];
    double bin_squares[BINS];
};

static float product(const struct weighted *w, int x, int y, int x1, int y1)
{
    return w->e[0][y][x] * w->e[0][y1][x1] + w->e[1][y][x] * w->e[1][y1][x1] +
           w->e[2][y][x] * w->e[2][y1][x1];
}

static void add_pixel(struct total *t, float square)
{
    uint32_t bin = float_bits(square) >> 21;
    double fourth = (double)square * (double)square;

    t->squares += (double)square;
    t->fourths += fourth;
    t->eighths += fourth * fourth;
    t->bin_counts[bin]++;
    t->bin_squares[bin] += (double)square;
}

static void add_pair(struct total *t, float product)
{
    t->neighbours += (double)product * (double)product;
    t->pair_count++;
}

/* Adds what the noise of the weights contributes to the variance. An error e
 * changes m of the pixels around, their weights w by the factor 1 - 2 m w e,
 * and the estimate by the sum of that times their squares. These are taken from
 * the neighbours, so that the factors are independent. */
static void add_corner(struct total *t, const struct weighted *w, int x, int y)
{
    float right = 0.0f, below = 0.0f;

    for (int c = 0; c < 3; c++) {
        float e = w->e[c][y][x] * w->m[c][y][x];

        right += e * w->e[c][y][x + 1] * w->e[c][y][x + 1];
        below += e * w->e[c][y + 1][x] * w->e[c][y + 1][x];
    }
    t->cubes += (double)right * (double)below;
    t->corner_count++;
}

static void add_tile(struct total *total, const struct tile *t,
                     const struct weighted *w)
{
    for (int y = 0; y < t->height; y++)
        for (int x = 0; x < t->width; x++) {
            add_pixel(total, product(w, x, y, x, y));
            if (x + 1 < t->width)
                add_pair(total, product(w, x, y, x + 1, y));
            if (y + 1 < t->height)
                add_pair(total, product(w, x, y, x, y + 1));
            if (x + 1 < t->width && y + 1 < t->height)
                add_corner(total, w, x, y);
        }
}

/* Returns the share of the sum that the largest pixels have. */
static double top_weight(const struct total *t, double pixels)
{
    double left = ceil(pixels * TOP_SHARE);
    double sum = 0;

    for (int i = BINS - 1; i >= 0 && left > 0; i--) {
        double count = (double)t->bin_counts[i];
        double taken = fmin(count, left);

        if (count > 0)
            sum += t->bin_squares[i] * taken / count;
        left -= taken;
    }
    return t->squares > 0 ? sum / t->squares : 0;
}

/* Share of the fourth moment in mean_variance_squared(). By the covariances of
 * 50 to 200 renders, six scenes of scenes/ need .08 to .43; lights200 and knot,
 * with their errors in few pixels, none. */
#define FOURTHS_SHARE 0.2

/* Returns the mean over the pixels of the square of their variance, which the
 * interval needs. It is a third of the fourth moment where errors are normal,
 * less where they are not. The product of neighbours' squares has it as its
 * mean where variances of neighbours are equal, and is lower elsewhere. */
static double mean_variance_squared(const struct total *t, double pixels)
{
    double high = t->fourths / 3 / pixels;
    double low = t->pair_count > 0 ? t->neighbours / t->pair_count : high;

    return low + FOURTHS_SHARE * (high - low);
}

/* Returns the deviations to the ends of the 95 % interval. The deviation is an
 * estimate itself, which is mostly too low where few pixels carry the error. So
 * Student's distribution replaces the normal one. Its degrees of freedom are
 * the number of pixels of equal error that would have the same sums. The
 * quantile is the series of Abramowitz and Stegun 1964, 26.7.5. */
static double deviations(const struct total *t)
{
    const double z = DEVIATIONS, z3 = z * z * z, z5 = z3 * z * z;
    double freedom = 1;

    if (t->eighths > 0)
        freedom = fmax(t->fourths * t->fourths / t->eighths, 1);
    return z + (z3 + z) / (4 * freedom) +
           (5 * z5 + 16 * z3 + 3 * z) / (96 * freedom * freedom);
}

static struct film_error conclude(const struct total *t, double pixels)
{
    double mean = t->squares / (3 * pixels);
    double cubes = t->corner_count > 0 ? t->cubes / t->corner_count : 0;
    double deviation =
        2.0 / 3 *
        sqrt((mean_variance_squared(t, pixels) + fmax(cubes, 0)) / pixels);
    double reach = deviations(t) * deviation;

    return (struct film_error){
        .is_known = true,
        .is_resolved = top_weight(t, pixels) <= TOP_WEIGHT,
        .error = sqrt(mean),
        .low = sqrt(fmax(0, mean - reach)),
        .high = mean > 0 ? sqrt(mean * exp(fmin(reach / mean, LOG_MAX))) : 0,
    };
}

static int tiles_in(int length)
{
    return (length + SIDE - 1) / SIDE;
}

/* Work of a pool on the rows of tiles: their totals, or a map. */
struct job {
    struct film *film;
    float exposure;
    const struct cancel *cancel; /* NULL: none */
    struct total *totals;        /* one for each row of tiles */
    float *map;                  /* mean squares of pixels */
    int colour;                  /* of the pixels, or ALL */
    atomic_bool is_unknown;      /* a half of a pixel has no sample */
};

/* Reads the tile at (x0, y0) and weighs it. Returns false after a cancel, and
 * if a pixel of the film has a half without a sample. */
static bool take_tile(struct job *j, int x0, int y0, struct tile *t,
                      struct weighted *weighted)
{
    if (atomic_load(&j->is_unknown) ||
        (j->cancel != NULL && cancel_requested(j->cancel)))
        return false;
    read_tile(t, j->film, j->exposure, j->colour, x0, y0);
    for (int c = 0; c < 3; c++)
        weigh(t, c, weighted);
    if (!t->is_known)
        atomic_store(&j->is_unknown, true);
    return t->is_known;
}

static void add_row_of_tiles(void *context, uint32_t row, int worker)
{
    struct job *j = context;
    struct weighted w;
    struct tile t;

    (void)worker;
    for (int x = 0; x < j->film->width; x += SIDE)
        if (take_tile(j, x, (int)row * SIDE, &t, &w))
            add_tile(&j->totals[row], &t, &w);
}

static void add_total(struct total *to, const struct total *t)
{
    to->squares += t->squares;
    to->fourths += t->fourths;
    to->eighths += t->eighths;
    to->neighbours += t->neighbours;
    to->pair_count += t->pair_count;
    to->cubes += t->cubes;
    to->corner_count += t->corner_count;
    for (int i = 0; i < BINS; i++) {
        to->bin_counts[i] += t->bin_counts[i];
        to->bin_squares[i] += t->bin_squares[i];
    }
}

bool film_error(struct film *f, float exposure, struct pool *pool,
                const struct cancel *cancel, struct film_error *error,
                struct error *err)
{
    struct job j = {.film = f,
                    .exposure = exposure,
                    .colour = ALL,
                    .cancel = cancel};
    int rows = tiles_in(f->height);

    *error = (struct film_error){0};
    j.totals = alloc_array((size_t)rows, sizeof *j.totals);
    if (j.totals == NULL)
        return fail(err, "out of memory for the error of %dx%d pixels",
                    f->width, f->height);
    pool_each(pool, (uint32_t)rows, add_row_of_tiles, &j);
    /* in order, so that the threads do not change the bits */
    for (int i = 1; i < rows; i++)
        add_total(&j.totals[0], &j.totals[i]);
    if (!atomic_load(&j.is_unknown) &&
        (cancel == NULL || !cancel_requested(cancel)))
        *error = conclude(&j.totals[0], (double)f->width * (double)f->height);
    free(j.totals);
    return true;
}

/* Replaces `count` numbers, `step` floats apart, by the means of the 5 around
 * each, fewer at the ends. */
static void average(float *x, int count, size_t step)
{
    float before[MAP_REACH] = {0}; /* old values of the two numbers before */

    for (int i = 0; i < count; i++) {
        float own = x[(size_t)i * step];
        float sum = before[0] + before[1] + own;
        int terms = 1 + (i < MAP_REACH ? i : MAP_REACH);

        for (int j = i + 1; j <= i + MAP_REACH && j < count; j++, terms++)
            sum += x[(size_t)j * step];
        before[0] = before[1];
        before[1] = own;
        x[(size_t)i * step] = sum / (float)terms;
    }
}

static void map_row_of_tiles(void *context, uint32_t row, int worker)
{
    struct job *j = context;
    size_t width = (size_t)j->film->width;
    struct weighted w;
    struct tile t;

    (void)worker;
    for (int x0 = 0; x0 < j->film->width; x0 += SIDE) {
        if (!take_tile(j, x0, (int)row * SIDE, &t, &w))
            return;
        for (int y = 0; y < t.height; y++)
            for (int x = 0; x < t.width; x++)
                j->map[(size_t)(t.y0 + y) * width + (size_t)(t.x0 + x)] =
                    product(&w, x, y, x, y) / 3.0f;
    }
}

void film_error_squares(struct film_squares *s, struct pool *pool,
                        const struct cancel *cancel)
{
    struct job j = {.film = s->film,
                    .exposure = s->exposure,
                    .colour = s->colour,
                    .cancel = cancel,
                    .map = s->squares};

    pool_each(pool, (uint32_t)tiles_in(s->film->height), map_row_of_tiles, &j);
    s->is_known = !atomic_load(&j.is_unknown) &&
                  (cancel == NULL || !cancel_requested(cancel));
}

bool film_error_map(struct film *f, float exposure, struct pool *pool,
                    float *map)
{
    struct film_squares s = {f, exposure, ALL, map, false};
    size_t width = (size_t)f->width;

    film_error_squares(&s, pool, NULL);
    if (!s.is_known)
        return false;
    for (int y = 0; y < f->height; y++)
        average(map + (size_t)y * width, f->width, 1);
    for (size_t x = 0; x < width; x++)
        average(map + x, f->height, width);
    for (size_t i = 0; i < width * (size_t)f->height; i++)
        map[i] = sqrtf(map[i]);
    return true;
}
