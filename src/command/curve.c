// SPDX-License-Identifier: MIT
#include "command/curve.h"

#include <inttypes.h>
#include <math.h>
#include <stdlib.h>

#include "base/memory.h"
#include "base/print.h"
#include "command/replicates.h"

/* ---- series ---- */

/* Sums of least squares over the points. */
struct sums {
    double x, xx, y, xy, yy;
};

static struct sums sums_of(const struct series *s)
{
    struct sums sum = {0};

    for (int i = 0; i < s->count; i++) {
        double x = log(s->x[i]), y = log(s->y[i]) / 2;

        sum.x += x;
        sum.xx += x * x;
        sum.y += y;
        sum.xy += x * y;
        sum.yy += y * y;
    }
    return sum;
}

struct series_fit series_fit(const struct series *s)
{
    struct series_fit fit = {NAN, NAN, NAN};
    struct sums m = sums_of(s);
    double n = s->count, determinant = n * m.xx - m.x * m.x;
    double offset, rest, margin;

    if (s->count < 2)
        return fit;
    fit.slope = (n * m.xy - m.x * m.y) / determinant;
    if (s->count < 3)
        return fit;
    offset = (m.xx * m.y - m.x * m.xy) / determinant;
    rest = fmax(m.yy - offset * m.y - fit.slope * m.xy, 0);
    margin =
        student_t_bound(0.05, n - 2) * sqrt(rest / (n - 2) * n / determinant);
    fit.low = fit.slope - margin;
    fit.high = fit.slope + margin;
    return fit;
}

struct series series_half_slope(const struct series *s)
{
    struct series guide = {.name = "slope -0.5", .is_guide = true, .count = 2};
    double x = 0, y = 0;

    for (int i = 0; i < s->count; i++) {
        x += log(s->x[i]) / s->count;
        y += log(s->y[i]) / s->count;
    }
    for (int i = 0; i < 2; i++) {
        guide.x[i] = s->x[i == 0 ? 0 : s->count - 1];
        /* the error is a square, whose slope is twice that of its root */
        guide.y[i] = exp(y - (log(guide.x[i]) - x));
    }
    return guide;
}

/* Interpolates the error after this time. */
static double error_after(const struct series *s, double seconds)
{
    int i = 1;
    double t;

    while (i < s->count - 1 && s->x[i] < seconds)
        i++;
    t = log(seconds / s->x[i - 1]) / log(s->x[i] / s->x[i - 1]);
    return s->y[i - 1] * pow(s->y[i] / s->y[i - 1], t);
}

double series_times(const struct series *a, const struct series *b)
{
    double seconds = fmin(a->x[a->count - 1], b->x[b->count - 1]);

    return error_after(b, seconds) / error_after(a, seconds);
}

/* ---- curves ---- */

/* Beyond this share the error of the reference's own noise makes the rest
 * uncertain. */
#define DROWNED_SHARE 0.5

void curve_add(struct curve *c, const struct curve_render *render,
               const struct picture_pair *pair,
               const struct reference_info *own)
{
    struct picture_error e = picture_error_of(pair);
    double error = picture_error_stated(pair, render->exposure);
    struct curve_point *p = &c->points[c->count];

    if (c->count == SERIES_POINTS)
        return;
    *p = (struct curve_point){
        .render = *render,
        .error =
            sqrt(fmax(picture_error_without(error * error, own->relmse), 0)),
        .mse = fmax(picture_error_without(e.mse, own->mse), 0),
        .relmse = fmax(picture_error_without(e.relmse, own->relmse), 0),
        .bias = e.bias,
        .percentile = e.percentile,
        .groups = picture_error_groups(pair),
        .is_drowned = own->mse > DROWNED_SHARE * e.mse ||
                      own->relmse > DROWNED_SHARE * e.relmse,
    };
    for (int i = 0; i < PIXEL_GROUPS; i++) {
        p->groups.mse[i] -= e.mse - p->mse;
        p->groups.relmse[i] -= e.relmse - p->relmse;
    }
    c->count++;
}

double curve_efficiency(const struct curve_point *p)
{
    return 1 / (p->relmse * p->render.seconds);
}

/* True if the point is part of the slope and the diagram. */
static bool is_shown(const struct curve_point *p)
{
    return !p->is_drowned && p->mse > 0 && p->relmse > 0 &&
           p->render.seconds > 0 && p->render.cpu_seconds > 0;
}

struct series curve_series(const struct curve *c, struct curve_axes axes)
{
    struct series s = {.name = axes.is_relative ? "relative MSE" : "MSE"};

    for (int i = 0; i < c->count; i++) {
        const struct curve_point *p = &c->points[i];

        if (!is_shown(p))
            continue;
        s.x[s.count] = axes.is_cpu ? p->render.cpu_seconds : p->render.seconds;
        s.y[s.count++] = axes.is_relative ? p->relmse : p->mse;
    }
    return s;
}

void curve_write_head(FILE *to)
{
    print_line(to, "%10s %9s %9s %9s %9s %9s %9s %10s %9s %9s", "spp",
               "seconds", "cpu s", "RMSE", "relMSE", "bias", "99.9 %",
               "efficiency", "error", "stated");
}

/* Formats a number. A quotient by a black reference or by no error is none. */
static const char *number_text(char text[32], int digits, double number,
                               const char *none)
{
    if (!isfinite(number))
        return none;
    snprintf(text, 32, "%.*g", digits, number);
    return text;
}

void curve_write_row(FILE *to, const struct curve_point *p)
{
    const struct film_error *stated = &p->render.stated;
    const char *none = "unknown";
    double known = stated->is_known ? stated->error : NAN;
    char bias[32] = "unknown", efficiency[32], error[32];

    if (isfinite(p->bias))
        snprintf(bias, sizeof bias, "%+7.2f %%", 100 * p->bias);
    print_line(to,
               "%10" PRIu64 " %9.4g %9.4g %9.4g %9.4g %9s %9.4g %10s %9.4g "
               "%9s%s",
               p->render.spp, p->render.seconds, p->render.cpu_seconds,
               sqrt(p->mse), p->relmse, bias, p->percentile,
               number_text(efficiency, 4, curve_efficiency(p), none), p->error,
               number_text(error, 4, known, none),
               p->is_drowned ? " (reference too noisy)" : "");
}

/* Returns the mean error of all groups but one. */
static double mean_without(const double groups[PIXEL_GROUPS], int left_out)
{
    double sum = 0;

    for (int i = 0; i < PIXEL_GROUPS; i++)
        sum += i == left_out ? 0 : groups[i];
    return sum / (PIXEL_GROUPS - 1);
}

/* Returns the slope without one group of pixels. */
static double slope_without(const struct curve *c, struct curve_axes axes,
                            int left_out)
{
    struct series s = curve_series(c, axes);

    for (int i = 0, k = 0; i < c->count; i++) {
        const struct group_errors *g = &c->points[i].groups;

        if (is_shown(&c->points[i]))
            s.y[k++] =
                mean_without(axes.is_relative ? g->relmse : g->mse, left_out);
    }
    return series_fit(&s).slope;
}

struct series_fit curve_fit(const struct curve *c, struct curve_axes axes)
{
    struct series s = curve_series(c, axes);
    struct series_fit fit = series_fit(&s);
    double slopes[PIXEL_GROUPS], mean = 0, squares = 0, margin;

    for (int i = 0; i < PIXEL_GROUPS; i++) {
        slopes[i] = slope_without(c, axes, i);
        mean += slopes[i] / PIXEL_GROUPS;
    }
    for (int i = 0; i < PIXEL_GROUPS; i++)
        squares += (slopes[i] - mean) * (slopes[i] - mean);
    margin = student_t_bound(0.05, PIXEL_GROUPS - 1) *
             sqrt(squares * (PIXEL_GROUPS - 1) / PIXEL_GROUPS);
    if (margin > fit.slope - fit.low) {
        fit.low = fit.slope - margin;
        fit.high = fit.slope + margin;
    }
    return fit;
}

static void write_slope(FILE *to, const char *label, const struct curve *c,
                        struct curve_axes axes)
{
    struct series_fit fit = curve_fit(c, axes);

    if (isnan(fit.slope))
        print_line(to, "%s: unknown, too few points", label);
    else if (isnan(fit.low))
        print_line(to, "%s: %.2f", label, fit.slope);
    else
        print_line(to, "%s: %.2f (95 %%: %.2f to %.2f)", label, fit.slope,
                   fit.low, fit.high);
}

void curve_write_slopes(FILE *to, const struct curve *c)
{
    static const struct {
        const char *label;
        struct curve_axes axes;
    } slopes[] = {
        {"slope of log RMSE over log seconds", {false, false}},
        {"slope of log RMSE over log cpu seconds", {false, true}},
        {"slope of log root relMSE over log seconds", {true, false}},
        {"slope of log root relMSE over log cpu seconds", {true, true}},
    };

    for (int i = 0; i < 4; i++)
        write_slope(to, slopes[i].label, c, slopes[i].axes);
}

/* Returns the stated error with its interval; nothing if it is unknown. */
static const char *stated_values(char text[64], const struct film_error *e)
{
    if (e->is_known)
        snprintf(text, 64, "%.6g,%.6g,%.6g", e->error, e->low, e->high);
    else
        snprintf(text, 64, ",,");
    return text;
}

char *curve_csv(const struct curve *c)
{
    char *text =
        format_text("spp,seconds,cpu_seconds,rmse,relmse,bias,percentile_999,"
                    "efficiency,error,stated,stated_low,stated_high\n");

    for (int i = 0; text != NULL && i < c->count; i++) {
        const struct curve_point *p = &c->points[i];
        char bias[32], efficiency[32], stated[64];
        char *longer =
            format_text("%s%" PRIu64
                        ",%.6g,%.6g,%.6g,%.6g,%s,%.6g,%s,%.6g,%s\n",
                        text, p->render.spp, p->render.seconds,
                        p->render.cpu_seconds, sqrt(p->mse), p->relmse,
                        number_text(bias, 6, p->bias, ""), p->percentile,
                        number_text(efficiency, 6, curve_efficiency(p), ""),
                        p->error, stated_values(stated, &p->render.stated));

        free(text);
        text = longer;
    }
    return text;
}
