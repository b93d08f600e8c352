// SPDX-License-Identifier: MIT
#include "tests/unit/check.h"
#include "tests/unit/chi_square.h"

#include <math.h>
#include <string.h>

#include "tests/unit/surfaces.h"

static bool draw(const struct bsdf *m, struct vec3 wo, uint64_t *state,
                 struct bsdf_sample *s)
{
    struct vec2 u;

    u.x = (float)(floor(check_random(state) * 0x1p24) * 0x1p-24);
    u.y = (float)(floor(check_random(state) * 0x1p24) * 0x1p-24);
    return bsdf_sample(m, wo, u,
                       (float)(floor(check_random(state) * 0x1p24) * 0x1p-24),
                       s);
}

/*
 * The sphere of wi is divided into cells of the microfacet normal h, for
 * reflections and for refractions, so that narrow lobes fill many cells. Rows
 * are uniform in asinh(tan(theta_h) / alpha): fine inside the lobe and
 * logarithmic outside. Each cell is integrated by midpoints, with Walter's
 * Jacobians (2007, eqs. 14 and 17) in double.
 */
#define ROWS    24
#define COLUMNS 12
#define SIDES   2 /* reflected, refracted */
#define CELLS   (SIDES * ROWS * COLUMNS)
#define POINTS  512 /* of a cell */

struct chart {
    double alpha;  /* width of the finest rows */
    double extent; /* range of the coordinate of rows */
};

static struct chart chart_of(const struct bsdf *m)
{
    struct chart c;

    c.alpha = m->kind == MATERIAL_DIFFUSE || m->kind == MATERIAL_ROUGH_DIFFUSE
                  ? 1
                  : fmax((double)m->alpha, 5e-4);
    c.extent = asinh(1e4 / c.alpha);
    return c;
}

/* Returns x of a unit vector from y and z, since x itself has few digits near
 * 1. */
static double long_x(struct vec3 v)
{
    double r2 = (double)v.y * (double)v.y + (double)v.z * (double)v.z;

    return r2 < 0.5 ? copysign(sqrt(1 - r2), (double)v.x) : (double)v.x;
}

/* True if the surface transmits along mirror images of reflections. */
static bool is_sheet(const struct bsdf *m)
{
    return bsdf_transmits(m) && !bsdf_is_solid(m);
}

static int cell_of(const struct chart *c, const struct bsdf *m, struct vec3 wo,
                   struct vec3 wi)
{
    double eta = wi.z < 0 && !is_sheet(m) ? (double)m->eta : 1;
    double z = is_sheet(m) ? fabs((double)wi.z) : (double)wi.z;
    double h[3] = {long_x(wo) + eta * long_x(wi), eta * (double)wi.y,
                   (double)wo.z + eta * z};
    double sign = h[2] < 0 ? -1 : 1;
    double phi = atan2(sign * h[1], sign * h[0]) / (2 * M_PI);
    double row = asinh(hypot(h[0], h[1]) / fabs(h[2]) / c->alpha) / c->extent;
    int i = (int)fmin(row * ROWS, ROWS - 1);
    int j = (int)((phi - floor(phi)) * COLUMNS) % COLUMNS;

    return ((wi.z < 0) * ROWS + i) * COLUMNS + j;
}

/* Returns wi and the solid angle per unit of (row, column) there, or 0 if this
 * facet sends no light from wo to wi. */
static double chart_point(const struct chart *c, const struct bsdf *m,
                          struct vec3 wo, bool is_crossing, double row,
                          double column, struct vec3 *wi)
{
    double tangent = c->alpha * sinh(row * c->extent);
    double hz = 1 / sqrt(1 + tangent * tangent);
    double phi = 2 * M_PI * column;
    double h[3] = {tangent * hz * cos(phi), tangent * hz * sin(phi), hz};
    double o_dot_h = (double)wo.x * h[0] + (double)wo.z * h[2];
    double eta = (double)m->eta;
    /* d omega_h: sin d theta d phi, and d tan theta = d theta / cos^2 */
    double area = tangent * hz * hz * hz * 2 * M_PI * c->alpha * c->extent *
                  cosh(row * c->extent);
    double ct, z;

    if (o_dot_h <= 0)
        return 0;
    if (!is_crossing || is_sheet(m)) {
        z = 2 * o_dot_h * h[2] - (double)wo.z;
        *wi = v3((float)(2 * o_dot_h * h[0] - (double)wo.x),
                 (float)(2 * o_dot_h * h[1] - (double)wo.y),
                 (float)(is_crossing ? -z : z));
        return z > 0 ? area * 4 * o_dot_h : 0;
    }
    if (!bsdf_is_solid(m) || (1 - o_dot_h * o_dot_h) >= eta * eta)
        return 0;
    ct = sqrt(1 - (1 - o_dot_h * o_dot_h) / (eta * eta));
    z = (o_dot_h / eta - ct) * h[2] - (double)wo.z / eta;
    *wi =
        v3((float)((o_dot_h / eta - ct) * h[0] - (double)wo.x / eta),
           (float)((o_dot_h / eta - ct) * h[1] - (double)wo.y / eta), (float)z);
    return z < 0 ? area * pow(o_dot_h / eta - ct, 2) / ct : 0;
}

/* Integrates the pdf over each cell and returns the sum. */
static double expected_shares(const struct chart *c, const struct bsdf *m,
                              struct vec3 wo, double *shares)
{
    /* At normal incidence the column does not matter, and the horizon cuts all
     * cells of a row at the same place. */
    const int across = wo.z == 1 ? 1 : 8;
    double total = 0;

    for (int k = 0; k < CELLS; k++) {
        int side = k / (ROWS * COLUMNS);
        int i = k / COLUMNS % ROWS;
        int j = k % COLUMNS;

        shares[k] = 0;
        for (int p = 0; p < POINTS; p++) {
            double row = (i + (p / across + 0.5) * across / POINTS) / ROWS;
            double column = (j + (p % across + 0.5) / across) / COLUMNS;
            struct vec3 wi;
            double area = chart_point(c, m, wo, side == 1, row, column, &wi);

            if (area > 0)
                shares[k] += area * (double)surface_pdf(m, wo, wi);
        }
        shares[k] /= POINTS * ROWS * COLUMNS;
        total += shares[k];
    }
    return total;
}

/* Chance exceeds 5.2 deviations once in 1e7. There are 365 tests, so one false
 * alarm in 27,000 choices of the seed, which is fixed. */
#define DEVIATE_MAX 5.2
#define DRAWS       40000

static void check_density(const struct bsdf *m, float mu)
{
    static double shares[CELLS + 1], counts[CELLS + 1];
    struct vec3 wo = direction(mu);
    struct chart c = chart_of(m);
    uint64_t seed = 1;
    struct chi_square chi = chi_begin();
    double total;

    if (!check_is_due(9))
        return;
    total = expected_shares(&c, m, wo, shares);
    memset(counts, 0, sizeof counts);
    for (int i = 0; i < DRAWS; i++) {
        struct bsdf_sample s;
        int k = CELLS; /* rejected, or from a delta distribution */

        if (draw(m, wo, &seed, &s) && !s.is_delta) {
            k = cell_of(&c, m, wo, s.wi);
            check_close((double)s.pdf / (double)surface_pdf(m, wo, s.wi), 1,
                        1e-6);
        }
        counts[k]++;
    }
    /* The sum is 1 within 6 standard errors of the share without density and
     * the error of the midpoint rule at the horizon. */
    shares[CELLS] = counts[CELLS] / DRAWS;
    check_close(total + shares[CELLS], 1,
                2e-3 + 6 * sqrt(shares[CELLS] * (1 - shares[CELLS]) / DRAWS));
    shares[CELLS] = fmax(1 - total, 0);
    for (int k = 0; k <= CELLS; k++)
        chi_add(&chi, shares[k] * DRAWS, counts[k]);
    chi_end(&chi);
    /* Cells with too few counts for chi-square. */
    check_at_most(chi.rest_count, chi.rest + 6 * sqrt(chi.rest) + 20);
    if (chi.degrees > 0 && chi_deviate(&chi) > DEVIATE_MAX) {
        print_error("kind %u alpha %g eta %g cosine %g: chi-square %g of %g\n",
                    m->kind, (double)m->alpha, (double)m->eta, (double)mu,
                    chi.sum, chi.degrees);
        assert_true(false);
    }
}

static void samples_of_reflections_follow_their_density(void **state)
{
    (void)state;
    at_all_reflections(check_density);
}

static void samples_of_glass_follow_their_density(void **state)
{
    (void)state;
    at_all_glasses(check_density);
}

static void samples_of_sheets_follow_their_density(void **state)
{
    (void)state;
    at_all_sheets(check_density, brick);
}

static void samples_of_mixtures_follow_their_density(void **state)
{
    (void)state;
    at_mixtures(check_density);
}

static void samples_of_translucents_follow_their_density(void **state)
{
    (void)state;
    at_all_translucents(check_density, brick, gold);
    at_translucent_mixtures(check_density);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(samples_of_reflections_follow_their_density),
        cmocka_unit_test(samples_of_glass_follow_their_density),
        cmocka_unit_test(samples_of_sheets_follow_their_density),
        cmocka_unit_test(samples_of_mixtures_follow_their_density),
        cmocka_unit_test(samples_of_translucents_follow_their_density),
    };

    return cmocka_run_group_tests(tests, NULL, NULL);
}
