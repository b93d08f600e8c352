// SPDX-License-Identifier: MIT
#include "command/replicates.h"

#include <assert.h>
#include <math.h>
#include <stdint.h>
#include <stdlib.h>

#include "base/machine.h"
#include "base/memory.h"

/* ---- quantiles of Student's t ---- */

/* The continued fraction of the incomplete beta function converges in about
 * the root of its greater parameter. */
#define TERMS_MAX 10000

/* Keeps the divisors of Lentz's method away from 0. */
static double nonzero(double x)
{
    return fabs(x) < 1e-300 ? 1e-300 : x;
}

/* Returns the continued fraction of the incomplete beta function (DLMF 8.17.22)
 * by the method of Lentz. It converges fast for x < (a + 1) / (a + b + 2). */
static double beta_fraction(double a, double b, double x)
{
    double c = 1, d = 1 / nonzero(1 - (a + b) * x / (a + 1)), f = d;

    for (int m = 1; m < TERMS_MAX; m++) {
        double even = m * (b - m) * x / ((a + 2 * m - 1) * (a + 2 * m));
        double odd =
            -(a + m) * (a + b + m) * x / ((a + 2 * m) * (a + 2 * m + 1));
        double step;

        d = 1 / nonzero(1 + even * d);
        c = nonzero(1 + even / c);
        f *= d * c;
        d = 1 / nonzero(1 + odd * d);
        c = nonzero(1 + odd / c);
        step = d * c;
        f *= step;
        if (fabs(step - 1) < 1e-14)
            break;
    }
    return f;
}

/* Returns the regularised incomplete beta function I_x(a, b). */
static double beta_part(double a, double b, double x)
{
    double front =
        exp(lgamma(a + b) - lgamma(a) - lgamma(b) + a * log(x) + b * log1p(-x));

    if (x < (a + 1) / (a + b + 2))
        return front * beta_fraction(a, b, x) / a;
    return 1 - front * beta_fraction(b, a, 1 - x) / b;
}

/* Returns the probability that |t| exceeds `bound`. */
static double tail(double bound, double degrees)
{
    double x = degrees / (degrees + bound * bound);

    return x >= 1 ? 1 : x <= 0 ? 0 : beta_part(degrees / 2, 0.5, x);
}

double student_t_bound(double probability, double degrees)
{
    double low = 0, high = 1;

    while (tail(high, degrees) > probability && high < 1e150)
        high *= 2;
    for (int i = 0; i < 200 && high - low > 1e-13 * high; i++) {
        double middle = (low + high) / 2;

        if (tail(middle, degrees) > probability)
            low = middle;
        else
            high = middle;
    }
    return (low + high) / 2;
}

/* ---- replicates ---- */

/* As in relMSE. */
#define DARK 0.01

static size_t value_count(const struct replicates *r)
{
    return 3 * (size_t)r->width * (size_t)r->height;
}

bool replicates_init(struct replicates *r, int width, int height, int capacity,
                     struct error *err)
{
    struct memory_quota quota = cgroup_quota_memory("");
    double bytes = (double)sizeof(float) * 3 * width * height * capacity;
    bool ok = true;

    *r = (struct replicates){.width = width, .height = height};
    /* the other half is for the scene and the film */
    if (bytes > (double)quota.size_bytes / 2)
        return fail(err,
                    "%d pictures of %dx%d pixels need %.1f GiB of memory, "
                    "expected at most half of the %.1f GiB %s",
                    capacity, width, height, bytes / (1 << 30),
                    (double)quota.size_bytes / (1 << 30), quota.place);
    for (int i = 0; ok && i < capacity; i++) {
        r->rgb[i] = alloc_array(value_count(r), sizeof *r->rgb[i]);
        ok = r->rgb[i] != NULL;
    }
    return ok || fail(err, "out of memory for %d pictures of %dx%d pixels",
                      capacity, width, height);
}

void replicates_free(struct replicates *r)
{
    for (int i = 0; i < REPLICATES_MAX; i++)
        free(r->rgb[i]);
    *r = (struct replicates){0};
}

/* Sets the interval of the true error, sum, from the sum of squares of the
 * variances v of the pixels' means. The difference of a pixel's true squared
 * error and its estimate from k pictures has the variance 2 v^2 k / (k - 1),
 * also if the noise has long tails: a bright sample raises both. The logarithm
 * keeps the interval above 0. */
static void set_interval(struct mean_error *e, double sum, double squares,
                         int count)
{
    double variance = 2 * squares * count / (count - 1);
    double margin = 1.96 * sqrt(variance) / sum;

    e->relmse_low = e->relmse * exp(-margin);
    e->relmse_high = e->relmse * exp(margin);
}

/* Estimates of the variance of a mean: from all pictures, and two independent
 * ones from their halves. */
struct variances {
    double all, halves[2];
};

/* Returns the variance of the pictures from `begin` to `end`. */
static double variance_of(const struct replicates *r, size_t i, int begin,
                          int end)
{
    double mean = 0, squares = 0;

    for (int j = begin; j < end; j++)
        mean += (double)r->rgb[j][i] / (end - begin);
    for (int j = begin; j < end; j++)
        squares += pow((double)r->rgb[j][i] - mean, 2);
    return squares / (end - begin - 1);
}

static double mean_of(const struct replicates *r, size_t i)
{
    double sum = 0;

    for (int j = 0; j < r->count; j++)
        sum += (double)r->rgb[j][i];
    return sum / r->count;
}

/* Returns the mean of the squared error of x over w = x^2 + DARK, if x has this
 * mean and the variance v, whose square is given. The noise of w changes the
 * quotient by v^2 (1 / w)'', the next term of the series. It is limited, since
 * the series needs small errors. */
static double relative_error(double mean, double variance, double square)
{
    double w = mean * mean + DARK;
    double error = variance / w, limit = error / 2;
    double more = square * (6 * mean * mean - 2 * DARK) / (w * w * w);

    return error + fmin(fmax(more, -limit), limit);
}

/* Replaces a value by its mean and adds its variances. */
static void add_value(struct replicates *r, size_t i, struct mean_error *e,
                      struct variances *relative)
{
    int k = r->count, half = k / 2;
    double mean = mean_of(r, i);
    double all = variance_of(r, i, 0, k) / k;
    double first = variance_of(r, i, 0, half) / k;
    double second = variance_of(r, i, half, k) / k;
    double w = mean * mean + DARK;

    e->mean += mean;
    e->mse += all;
    relative->all += relative_error(mean, all, first * second);
    relative->halves[0] += first / w;
    relative->halves[1] += second / w;
    r->rgb[0][i] = (float)mean;
}

const float *replicates_mean(struct replicates *r, struct mean_error *e)
{
    double count = (double)value_count(r), sum = 0, squares = 0;
    int k = r->count;

    assert(k >= REPLICATES_MIN);
    *e = (struct mean_error){0};
    for (size_t pixel = 0; pixel < value_count(r); pixel += 3) {
        struct variances relative = {0, {0, 0}};

        /* channels of a pixel have the same noise and count as one */
        for (size_t i = pixel; i < pixel + 3; i++)
            add_value(r, i, e, &relative);
        sum += relative.all;
        squares += relative.halves[0] * relative.halves[1];
    }
    e->mse /= count;
    e->mean /= count;
    e->relmse = sum / count;
    if (sum > 0)
        set_interval(e, sum, squares, k);
    return r->rgb[0];
}
