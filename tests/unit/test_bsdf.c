// SPDX-License-Identifier: MIT
#include "check.h"

#include <math.h>

#include "kernels/bsdf.h"

#define SIDE 400 /* points each way: midpoints, so errors fall as 1/SIDE^2 */

static const float alphas[] = {5e-4f, 1e-3f, 1e-2f, 0.1f, 0.3f, 0.6f, 1.0f};
static const float cosines[] = {1.0f, 0.7f, 0.3f, 0.05f, 0.001f};

#define COUNT(a) (sizeof(a) / sizeof *(a))

static struct vec2 grid_point(int i)
{
    return v2((float)((i % SIDE + 0.5) / SIDE),
              (float)((i / SIDE + 0.5) / SIDE));
}

static struct vec3 direction(float cosine)
{
    return v3(sqrtf(1.0f - cosine * cosine), 0.0f, cosine);
}

/* Unpolarised Fresnel from the law of refraction in angles (Hecht, Optics,
 * 4.6: sines and tangents), in double. */
static double fresnel_by_angles(double cosine, double eta)
{
    double ti = acos(cosine);
    double st = sin(ti) / eta;
    double tt, s, p;

    if (st >= 1)
        return 1;
    if (ti < 1e-6)
        return pow((eta - 1) / (eta + 1), 2);
    tt = asin(st);
    s = sin(ti - tt) / sin(ti + tt);
    p = tan(ti - tt) / tan(ti + tt);
    return (s * s + p * p) / 2;
}

static double smith_lambda(double alpha, double cosine)
{
    double tan2 = (1 - cosine * cosine) / (cosine * cosine);

    return (sqrt(1 + alpha * alpha * tan2) - 1) / 2;
}

/* Directional albedo with F = 1 (eta 0) or of glass, by quadrature over all
 * microfacet normals drawn with density D cos (Walter et al. 2007, eq. 35):
 * E = mean of G2 (wo.h) / (cos_o cos_h). */
static double albedo_by_quadrature(double alpha, double mu, double eta)
{
    const int side = 1000;
    double wo[3] = {sqrt(1 - mu * mu), 0, mu};
    double lo = smith_lambda(alpha, mu);
    double sum = 0;

    for (int i = 0; i < side; i++) {
        /* the tail of normals far from upright is drawn out by a square */
        double s = (i + 0.5) / side;
        double tan2 = alpha * alpha * (1 / ((1 - s) * (1 - s)) - 1);
        double hz = 1 / sqrt(1 + tan2);
        double hr = sqrt(tan2) * hz;

        for (int j = 0; j < side; j++) {
            double phi = M_PI * (j + 0.5) / side;
            double hx = hr * cos(phi);
            double oh = wo[0] * hx + wo[2] * hz;
            double iz = 2 * oh * hz - mu;
            double f = eta == 0 ? 1 : fresnel_by_angles(fmin(oh, 1), eta);
            double part = 0;

            if (oh <= 0)
                continue;
            if (iz > 0)
                part = f / (1 + lo + smith_lambda(alpha, iz));
            if (eta != 0 && f < 1) {
                double ct = sqrt(1 - (1 - oh * oh) / (eta * eta));

                iz = -((oh / eta - ct) * hz - mu / eta);
                if (iz > 0)
                    part += (1 - f) / (1 + lo + smith_lambda(alpha, iz));
            }
            sum += 2 * (1 - s) * part * oh / (mu * hz);
        }
    }
    return sum / side / side;
}

static void diffuse_weight_is_the_albedo(void **state)
{
    struct bsdf m = {{0.2f, 0.5f, 1.0f}, 0, 1, MATERIAL_DIFFUSE};
    struct bsdf_sample s;

    (void)state;
    for (int i = 0; i < SIDE * SIDE; i++) {
        if (!bsdf_sample(&m, direction(0.3f), grid_point(i), 0, &s))
            continue;
        assert_true(s.weight.x == 0.2f && s.weight.y == 0.5f &&
                    s.weight.z == 1.0f && s.eta_scale == 1.0f);
    }
}

static void metal_albedo_is_that_of_ggx(void **state)
{
    struct bsdf m = {{1, 1, 1}, 0, 1, MATERIAL_METAL};
    struct bsdf_sample s;

    (void)state;
    for (size_t a = 0; a < COUNT(alphas); a++)
        for (size_t c = 0; c < COUNT(cosines); c++) {
            double sum = 0;

            m.alpha = alphas[a];
            for (int i = 0; i < SIDE * SIDE; i++)
                if (bsdf_sample(&m, direction(cosines[c]), grid_point(i), 0,
                                &s)) {
                    assert_true(s.wi.z > 0);
                    check_close(v3_length(s.wi), 1, 1e-5);
                    sum += (double)s.weight.x;
                }
            sum /= SIDE * SIDE;
            check_close(sum,
                        albedo_by_quadrature((double)alphas[a],
                                             (double)cosines[c], 0),
                        5e-4);
            check_at_most(sum, 1 + 1e-4);
        }
    /* what Schlick and masking leave at normal incidence and a = 1 */
    check_close(albedo_by_quadrature(1, 1, 0), 1 - log(2.0), 1e-3);
}

static void mirrors_reflect(void **state)
{
    struct bsdf m = {{0.9f, 0.5f, 0.1f}, 0, 1, MATERIAL_METAL};
    struct bsdf_sample s;

    (void)state;
    assert_true(bsdf_sample(&m, v3(0.6f, 0, 0.8f), v2(0.3f, 0.4f), 0, &s));
    check_close(s.wi.x, -0.6, 1e-7);
    check_close(s.wi.z, 0.8, 1e-7);
    /* Schlick 1994: F0 + (1 - F0) (1 - cos)^5 */
    check_close(s.weight.y, 0.5 + 0.5 * pow(0.2, 5), 1e-6);
}

static void smooth_glass_obeys_fresnel_and_snell(void **state)
{
    const double etas[] = {1.5, 1 / 1.5, 1.33, 2.4};

    (void)state;
    for (size_t e = 0; e < COUNT(etas); e++)
        for (int i = 1; i <= 1000; i++) {
            float c = (float)i / 1000;
            double f = fresnel_by_angles((double)c, etas[e]);
            struct bsdf m = {{0.5f, 0.5f, 0.5f},
                             0,
                             (float)etas[e],
                             MATERIAL_GLASS};
            struct bsdf_sample s;
            float cos_t;

            check_close(fresnel_dielectric(c, m.eta, &cos_t), f, 3e-4);
            assert_true(bsdf_sample(&m, direction(c), v2(0, 0), 0, &s));
            check_close(s.wi.z, (double)c, 1e-6); /* the lobe at 0 */
            check_close(s.weight.x, 1, 0);
            if (f > 0.999)
                continue;
            assert_true(
                bsdf_sample(&m, direction(c), v2(0, 0), 0.9999999f, &s));
            assert_true(s.wi.z < 0);
            check_close(v3_length(s.wi), 1, 2e-6);
            check_close(-s.wi.x * etas[e], (double)direction(c).x, 2e-6);
            check_close(s.weight.x, 0.5, 0); /* the tint */
            check_close(s.eta_scale, 1 / (etas[e] * etas[e]), 1e-6);
        }
}

static void index_one_is_invisible(void **state)
{
    struct bsdf m = {{1, 1, 1}, 0.5f, 1.0f, MATERIAL_GLASS};
    struct bsdf_sample s;

    (void)state;
    assert_true(bsdf_sample(&m, v3(0.6f, 0, 0.8f), v2(0.1f, 0.9f), 0, &s));
    assert_true(s.wi.x == -0.6f && s.wi.z == -0.8f && s.weight.x == 1);
}

static void rough_glass_keeps_what_masking_leaves(void **state)
{
    const float etas[] = {1.5f, 1 / 1.5f};
    struct bsdf_sample s;

    (void)state;
    for (size_t e = 0; e < COUNT(etas); e++)
        for (size_t a = 2; a < COUNT(alphas); a++)
            for (size_t c = 0; c < COUNT(cosines); c++) {
                struct bsdf m = {{1, 1, 1}, alphas[a], etas[e], MATERIAL_GLASS};
                double sum = 0;

                for (int i = 0; i < SIDE * SIDE; i++) {
                    /* the lobe by a third number: golden ratio */
                    float lobe = (float)fmod(i * 0.618033988749895, 1.0);

                    if (bsdf_sample(&m, direction(cosines[c]), grid_point(i),
                                    lobe, &s))
                        sum += (double)s.weight.x;
                }
                sum /= SIDE * SIDE;
                check_close(sum,
                            albedo_by_quadrature((double)alphas[a],
                                                 (double)cosines[c],
                                                 (double)etas[e]),
                            2e-3);
            }
}

/* Sheets: reflectance 2F / (1 + F), the rest straight on. */
static void thin_glass_adds_up_its_reflections(void **state)
{
    struct bsdf m = {{1, 1, 1}, 0, 1.5f, MATERIAL_THIN_GLASS};
    const int n = 100000;

    (void)state;
    for (size_t c = 0; c < COUNT(cosines); c++) {
        double f = fresnel_by_angles((double)cosines[c], 1.5);
        int reflected = 0;

        for (int i = 0; i < n; i++) {
            struct bsdf_sample s;
            struct vec3 wo = direction(cosines[c]);

            assert_true(
                bsdf_sample(&m, wo, v2(0, 0), (float)((i + 0.5) / n), &s));
            if (s.wi.z > 0)
                reflected++;
            else
                assert_true(s.wi.x == -wo.x && s.wi.z == -wo.z);
        }
        check_close((double)reflected / n, 2 * f / (1 + f), 1e-3);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(diffuse_weight_is_the_albedo),
        cmocka_unit_test(metal_albedo_is_that_of_ggx),
        cmocka_unit_test(mirrors_reflect),
        cmocka_unit_test(smooth_glass_obeys_fresnel_and_snell),
        cmocka_unit_test(index_one_is_invisible),
        cmocka_unit_test(rough_glass_keeps_what_masking_leaves),
        cmocka_unit_test(thin_glass_adds_up_its_reflections),
    };

    return cmocka_run_group_tests(tests, NULL, NULL);
}
