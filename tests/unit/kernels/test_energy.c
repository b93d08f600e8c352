// SPDX-License-Identifier: MIT
#include "tests/unit/check.h"
#include "tests/unit/facets.h"

#include "kernels/energy_stretched.h"

static const double alphas[] = {5e-4, 1e-3, 1e-2, 0.1, 0.3, 0.6, 1.0};
static const double cosines[] = {1.0, 0.7, 0.3, 0.05, 0.001};
static const double etas[] = {1.5,     1 / 1.5, 1.33,    1 / 1.33, 2.4,
                              1 / 2.4, 1.1,     1 / 1.1, 1e6,      1e-6};

#define COUNT(a) (sizeof(a) / sizeof *(a))

/* Number of points beside the tables' nodes. */
#define OFF_NODES 24

struct point {
    double alpha, mu, eta;
};

/* Returns a point of the grid of alphas and cosines, then random points
 * between. */
static struct point point(int i, uint64_t *state)
{
    struct point p = {0, 0, 0};
    double root = sqrt(5e-4);

    if (i < (int)(COUNT(alphas) * COUNT(cosines))) {
        p.alpha = alphas[i / (int)COUNT(cosines)];
        p.mu = cosines[i % (int)COUNT(cosines)];
        return p;
    }
    root += (1 - root) * check_random(state);
    p.alpha = root * root;
    p.mu = pow(10, -3 * check_random(state));
    return p;
}

#define POINTS (int)(COUNT(alphas) * COUNT(cosines) + OFF_NODES)

static void albedo_of_ggx_is_that_of_quadrature(void **state)
{
    uint64_t seed = 3;

    (void)state;
    for (int i = 0; i < POINTS; i++) {
        struct point p = point(i, &seed);
        struct ggx_albedo e = ggx_albedo((float)p.mu, (float)p.alpha);

        check_close(1 - (double)e.loss,
                    albedo_by_quadrature(FACETS_WHITE, p.alpha, p.mu, 0), 1e-3);
        check_close((double)e.schlick,
                    albedo_by_quadrature(FACETS_SCHLICK, p.alpha, p.mu, 0),
                    2e-3);
        check_at_most(0, (double)e.loss);
    }
    /* The loss by masking at normal incidence and alpha 1. */
    check_close((double)ggx_albedo(1, 1).loss, log(2.0), 1e-5);
}

/* The losses of rough metal are compensated by (1 - E_i) / (1 - E_mean). Its
 * mean over the interpolated table must be 1. */
static void means_are_those_of_the_table(void **state)
{
    const int n = 20000;

    (void)state;
    for (int k = 0; k <= 200; k++) {
        double root = sqrt(5e-4) + (1 - sqrt(5e-4)) * k / 200;
        double alpha = root * root;
        struct ggx_albedo mean = ggx_albedo_mean((float)alpha);
        double loss = 0, schlick = 0;

        for (int i = 0; i < n; i++) {
            double t = (i + 0.5) / n; /* mu = t^2, because it is steep at 0 */
            struct ggx_albedo e = ggx_albedo((float)(t * t), (float)alpha);

            loss += (double)e.loss * 4 * t * t * t / n;
            schlick += (double)e.schlick * 4 * t * t * t / n;
        }
        check_close((double)mean.loss / loss, 1, 1e-2);
        check_close((double)mean.schlick, schlick, 5e-4);
    }
}

static struct vec3 toward(double mu, double phi)
{
    double sine = sqrt(1 - mu * mu);

    return v3((float)(sine * cos(phi)), (float)(sine * sin(phi)), (float)mu);
}

/* Over the whole range of the anisotropy, which ends at the stretch root 10. */
static void albedo_of_stretched_facets_is_that_of_quadrature(void **state)
{
    uint64_t seed = 5;
    double error = 0, schlick_error = 0;
    const int n = check_is_thorough() ? 150 : 30;

    (void)state;
    for (int i = 0; i < n; i++) {
        struct point p = point(POINTS, &seed);
        double s = 1 / sqrt(1 - 0.9 * check_random(&seed));
        double phi = 2 * M_PI * check_random(&seed);
        double ax = p.alpha * s, ay = p.alpha / s;
        struct ggx g = {(float)p.alpha, (float)s};
        struct ggx_albedo e = facets_albedo(toward(p.mu, phi), g);
        double one = stretched_by_quadrature(FACETS_WHITE, ax, ay, p.mu, phi);
        double schlick =
            stretched_by_quadrature(FACETS_SCHLICK, ax, ay, p.mu, phi);

        check_close(1 - (double)e.loss, one, 5e-3);
        check_close((double)e.schlick, schlick, 6e-3);
        error += fabs(1 - (double)e.loss - one) / n;
        schlick_error += fabs((double)e.schlick - schlick) / n;
    }
    check_at_most(error, 5e-4);
    check_at_most(schlick_error, 5e-4);
}

/* Hardly stretched facets have the albedo of isotropic ones. */
static void stretching_begins_at_isotropic_facets(void **state)
{
    uint64_t seed = 6;

    (void)state;
    for (int i = 0; i < 300; i++) {
        struct point p = point(i, &seed);
        struct ggx g = {(float)p.alpha, 1.0f + 1e-6f};
        struct ggx_albedo a = facets_albedo(toward(p.mu, i), g);
        struct ggx_albedo mean = facets_albedo_mean(g);

        g.stretch = 1;
        check_close((double)a.loss,
                    (double)facets_albedo(toward(p.mu, i), g).loss, 4e-3);
        check_close((double)mean.loss / (double)facets_albedo_mean(g).loss, 1,
                    2e-2);
    }
}

/* The error of the mean times the largest loss is an error of the light that
 * white metal reflects. */
static void means_are_those_of_the_stretched_table(void **state)
{
    const int n = 200, turns = 24;

    (void)state;
    for (int k = 0; k <= 40; k++) {
        double root = sqrt(5e-4) + (1 - sqrt(5e-4)) * (k % 9) / 8;
        struct ggx g = {(float)(root * root),
                        (float)pow(10, 0.5 * (k + 1) / 41)};
        struct ggx_albedo mean = facets_albedo_mean(g);
        double loss = 0, schlick = 0, most = 0;

        for (int i = 0; i < n * turns; i++) {
            double t = (i / turns + 0.5) / n;
            double phi = M_PI / 2 * (i % turns + 0.5) / turns;
            struct ggx_albedo e = facets_albedo(toward(t * t, phi), g);

            loss += (double)e.loss * 4 * t * t * t / n / turns;
            schlick += (double)e.schlick * 4 * t * t * t / n / turns;
            most = fmax(most, (double)e.loss);
        }
        check_close(((double)mean.loss / loss - 1) * most, 0, 3.5e-3);
        check_close((double)mean.schlick, schlick, 1e-3);
    }
}

static void albedo_of_glass_is_that_of_quadrature(void **state)
{
    uint64_t seed = 4;

    (void)state;
    for (int i = 0; i < POINTS; i++)
        for (size_t k = 0; k < COUNT(etas); k++) {
            struct point p = point(i, &seed);
            double e;

            if (!check_is_due(7))
                continue;
            e = albedo_by_quadrature(FACETS_GLASS, p.alpha, p.mu, etas[k]);
            check_close((double)glass_albedo((float)p.mu, (float)p.alpha,
                                             (float)etas[k]) /
                            e,
                        1, 3e-3);
        }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(albedo_of_ggx_is_that_of_quadrature),
        cmocka_unit_test(means_are_those_of_the_table),
        cmocka_unit_test(albedo_of_stretched_facets_is_that_of_quadrature),
        cmocka_unit_test(stretching_begins_at_isotropic_facets),
        cmocka_unit_test(means_are_those_of_the_stretched_table),
        cmocka_unit_test(albedo_of_glass_is_that_of_quadrature),
    };

    return cmocka_run_group_tests(tests, NULL, NULL);
}
