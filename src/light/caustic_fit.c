// SPDX-License-Identifier: MIT
#include "light/caustic_fit.h"

#include <math.h>
#include <string.h>

#include "kernels/vec.h"

/* Least number of photons of which two lobes are made in place of one. */
#define PART_LEAST 6u

/* Logarithm of the likelihood that two lobes have to gain: for each photon, and
 * for the numbers that they are more. */
#define GAIN_EACH 0.3
#define GAIN      2.0

/* Photons that a lobe needs to move with the place, and the numbers that are
 * fitted to them. */
#define MOVING_LEAST 5u
#define MOVING       3.0

/* Damping of these numbers, relative to the squared extent of the landings. */
#define DAMPING 1e-3

/* Residuals that are assumed beside the photons' own: their number, and their
 * size relative to the extent of the landings. On a glass ball under the sun
 * twice the size leaves 10 % more error, half of it as much. */
#define PRIOR_COUNT 2.0
#define PRIOR_SIZE  0.05

/* Least size of residuals relative to the distance, so that floats suffice. */
#define SIZE_LEAST 1e-5

/* Factor from the residuals' covariance to the lobe. A disc of light is sampled
 * best with 2.3. */
#define WIDENING 2.0

/* Least height of the caster over a photon's landing, and cosine of its way, in
 * the direction of the lobe and relative to the lobe's height. */
#define SLANT_LEAST 0.05f

/* A fit of one lobe. Coordinates on its plane are those along x and y. */
struct fit {
    struct vec3 p, q; /* means of landings and of where they came from */
    struct vec3 axis, x, y;
    double distance;                      /* from p to q */
    struct vec2 places[CAUSTIC_FIT_MOST]; /* where photons meet the plane */
    double weights[CAUSTIC_FIT_MOST];     /* have a sum of 1 */
    double middle[2];                     /* mean place */
    struct vec3 dx, dy;                   /* change of the places with p */
    double extent;                        /* mean squared distance from p */
    double xx, xy, yy;                    /* covariance of the residuals */
};

/* Sets the plane and the photons' places on it. Returns false if they come from
 * too many directions for one plane. */
static bool fit_plane(const struct near_photon *near, uint32_t n, struct fit *f)
{
    double sum = 0;

    memset(f, 0, sizeof *f);
    for (uint32_t i = 0; i < n; i++)
        sum += (double)near[i].landing->flux;
    for (uint32_t i = 0; i < n; i++) {
        const struct landing *l = near[i].landing;

        f->weights[i] = (double)l->flux / sum;
        f->p = v3_add(f->p, v3_scale(l->p, (float)f->weights[i]));
        f->q = v3_add(f->q, v3_scale(l->from, (float)f->weights[i]));
    }
    f->axis = v3_sub(f->q, f->p);
    f->distance = (double)v3_length(f->axis);
    if (!(f->distance > 1e-6))
        return false;
    f->axis = v3_unit(f->axis);
    frame_around(f->axis, &f->x, &f->y);
    for (uint32_t i = 0; i < n; i++) {
        const struct landing *l = near[i].landing;
        struct vec3 to = v3_sub(f->q, l->p), at;
        float height = v3_dot(to, f->axis), cosine = v3_dot(l->wi, f->axis);

        if (!(height > SLANT_LEAST * (float)f->distance &&
              cosine > SLANT_LEAST))
            return false;
        at = v3_sub(v3_scale(l->wi, height / cosine), to);
        f->places[i] = v2(v3_dot(at, f->x), v3_dot(at, f->y));
        f->middle[0] += f->weights[i] * (double)f->places[i].x;
        f->middle[1] += f->weights[i] * (double)f->places[i].y;
    }
    return true;
}

/* Solves the symmetric equations m x = y for x. m is positive definite. */
static struct vec3 solve(double m[3][3], const double y[3])
{
    double a[3][4], x[3];

    for (int i = 0; i < 3; i++) {
        memcpy(a[i], m[i], sizeof m[i]);
        a[i][3] = y[i];
    }
    for (int i = 0; i < 3; i++)
        for (int j = i + 1; j < 3; j++)
            for (int k = 3; k >= i; k--)
                a[j][k] -= a[i][k] * a[j][i] / a[i][i];
    for (int i = 2; i >= 0; i--) {
        x[i] = a[i][3];
        for (int k = i + 1; k < 3; k++)
            x[i] -= a[i][k] * x[k];
        x[i] /= a[i][i];
    }
    return v3((float)x[0], (float)x[1], (float)x[2]);
}

/* Sets the change of places with the landings, by least squares. */
static void fit_moves(const struct near_photon *near, uint32_t n, struct fit *f)
{
    double m[3][3] = {{0}}, y[2][3] = {{0}};

    for (uint32_t i = 0; i < n; i++) {
        struct vec3 way = v3_sub(near[i].landing->p, f->p);
        double w = f->weights[i];
        double of[3] = {(double)way.x, (double)way.y, (double)way.z};

        for (int j = 0; j < 3; j++) {
            for (int k = 0; k < 3; k++)
                m[j][k] += w * of[j] * of[k];
            y[0][j] += w * of[j] * ((double)f->places[i].x - f->middle[0]);
            y[1][j] += w * of[j] * ((double)f->places[i].y - f->middle[1]);
        }
    }
    f->extent = m[0][0] + m[1][1] + m[2][2];
    if (n < MOVING_LEAST || !(f->extent > 0))
        return;
    for (int j = 0; j < 3; j++)
        m[j][j] += DAMPING * f->extent;
    f->dx = solve(m, y[0]);
    f->dy = solve(m, y[1]);
}

/* Difference of a photon's place from the fitted one. */
static struct vec2 residual(const struct fit *f, const struct near_photon *near,
                            uint32_t i)
{
    struct vec3 way = v3_sub(near[i].landing->p, f->p);

    return v2(f->places[i].x - (float)f->middle[0] - v3_dot(f->dx, way),
              f->places[i].y - (float)f->middle[1] - v3_dot(f->dy, way));
}

/* Sets the covariance of the residuals. */
static void fit_widths(const struct near_photon *near, uint32_t n,
                       struct fit *f)
{
    double free = n - (n < MOVING_LEAST ? 1 : MOVING);
    double own = n / (free + PRIOR_COUNT);
    double least = SIZE_LEAST * SIZE_LEAST * f->distance * f->distance;
    double prior = PRIOR_SIZE * PRIOR_SIZE * f->extent + least;

    for (uint32_t i = 0; i < n; i++) {
        struct vec2 r = residual(f, near, i);
        double w = own * f->weights[i];

        f->xx += w * (double)(r.x * r.x);
        f->xy += w * (double)(r.x * r.y);
        f->yy += w * (double)(r.y * r.y);
    }
    f->xx += prior * PRIOR_COUNT / (free + PRIOR_COUNT);
    f->yy += prior * PRIOR_COUNT / (free + PRIOR_COUNT);
}

static bool fit_one(const struct near_photon *near, uint32_t n, struct fit *f)
{
    if (!fit_plane(near, n, f))
        return false;
    fit_moves(near, n, f);
    fit_widths(near, n, f);
    return true;
}

/* Area of a lobe on its plane, without constant factors. */
static double fit_area(const struct fit *f)
{
    return sqrt(fmax(f->xx * f->yy - f->xy * f->xy, 1e-12 * f->xx * f->yy));
}

static struct vec3 combine(double a, struct vec3 x, double b, struct vec3 y)
{
    return v3_add(v3_scale(x, (float)a), v3_scale(y, (float)b));
}

static double dot(struct vec3 a, struct vec3 b)
{
    return (double)a.x * (double)b.x + (double)a.y * (double)b.y +
           (double)a.z * (double)b.z;
}

/* The coordinates along x and y are divided by the Cholesky factor of the
 * covariance. */
static struct caustic_lobe lobe_of(const struct fit *f)
{
    double xx = sqrt(WIDENING * f->xx);
    double yx = WIDENING * f->xy / xx;
    double yy = WIDENING * fit_area(f) / xx;
    double a = 1 / xx, b = -yx / (xx * yy), c = 1 / yy;
    struct vec3 move_x = v3_sub(f->x, f->dx), move_y = v3_sub(f->y, f->dy);
    double x0 = dot(f->dx, f->p) - dot(f->x, f->q) - f->middle[0];
    double y0 = dot(f->dy, f->p) - dot(f->y, f->q) - f->middle[1];

    return (struct caustic_lobe){
        .axis = f->axis,
        .height = (float)dot(f->axis, f->q),
        .u = v3_scale(f->x, (float)a),
        .v = combine(b, f->x, c, f->y),
        .du = v3_scale(move_x, (float)a),
        .dv = combine(b, move_x, c, move_y),
        .u0 = (float)(a * x0),
        .v0 = (float)(b * x0 + c * y0),
        .scale = (float)(a * c / M_PI),
    };
}

static void add_part(const struct near_photon *near, uint32_t n,
                     const struct fit *f, struct caustic_parts *parts)
{
    struct caustic_part *part = &parts->list[parts->count];

    if (parts->count == CAUSTIC_LOBES_MOST)
        return;
    *part = (struct caustic_part){
        .lobe = lobe_of(f),
        .solid_angle =
            M_PI * WIDENING * fit_area(f) / (f->distance * f->distance),
    };
    for (uint32_t i = 0; i < n; i++) {
        part->flux += (double)near[i].landing->flux;
        part->radiance += f->weights[i] * (double)near[i].landing->radiance;
    }
    parts->count++;
}

/* Divides the photons at the middle of the residuals' longest axis. Returns the
 * number of those before it. */
static uint32_t divide(struct near_photon *near, uint32_t n,
                       const struct fit *f)
{
    double angle = .5 * atan2(2 * f->xy, f->xx - f->yy);
    struct vec2 axis = v2((float)cos(angle), (float)sin(angle));
    struct near_photon behind[CAUSTIC_FIT_MOST];
    uint32_t before_count = 0, behind_count = 0;

    for (uint32_t i = 0; i < n; i++) {
        struct vec2 r = residual(f, near, i);

        if (r.x * axis.x + r.y * axis.y < 0.0f)
            near[before_count++] = near[i];
        else
            behind[behind_count++] = near[i];
    }
    memcpy(near + before_count, behind, behind_count * sizeof *behind);
    return before_count;
}

/* Likelihood of a part of a mixture at its photons, as a logarithm. */
static double likelihood(const struct fit *f, uint32_t n, uint32_t all)
{
    return n * (log((double)n / all) - log(fit_area(f)));
}

/* Divides the photons into `*first` and the rest. Returns false if one lobe
 * suits them as well. */
static bool is_divided(struct near_photon *near, uint32_t n,
                       const struct fit *whole, uint32_t *first)
{
    struct fit a, b;
    uint32_t rest;

    if (n < 2 * PART_LEAST)
        return false;
    *first = divide(near, n, whole);
    rest = n - *first;
    return *first >= PART_LEAST && rest >= PART_LEAST &&
           fit_one(near, *first, &a) && fit_one(near + *first, rest, &b) &&
           likelihood(&a, *first, n) + likelihood(&b, rest, n) >
               likelihood(whole, n, n) + GAIN_EACH * n + GAIN;
}

void caustic_fit(struct near_photon *near, uint32_t count,
                 struct caustic_parts *parts)
{
    struct fit whole;
    bool ok = fit_one(near, count, &whole);
    uint32_t first = count / 2;

    if (ok && !is_divided(near, count, &whole, &first)) {
        add_part(near, count, &whole, parts);
    } else if (count > 1) {
        caustic_fit(near, first, parts);
        caustic_fit(near + first, count - first, parts);
    }
}
