// SPDX-License-Identifier: MIT
#include "tests/unit/check.h"

#include <math.h>

#include "tests/unit/facets.h"
#include "tests/unit/surfaces.h"

static struct vec3 any_direction(uint64_t *state)
{
    double z = 1 - 2 * check_random(state);
    double phi = 2 * M_PI * check_random(state);
    double r = sqrt(1 - z * z);

    return v3((float)(r * cos(phi)), (float)(r * sin(phi)), (float)z);
}

static void diffuse_weight_is_the_albedo(void **state)
{
    struct bsdf m = {.color = {0.2f, 0.5f, 1}, .kind = MATERIAL_DIFFUSE};
    struct bsdf_sample s;

    (void)state;
    for (int i = 0; i < 1000; i++) {
        if (!bsdf_sample(&m, direction(0.3f), v2((float)i / 1000, 0.3f), 0, &s))
            continue;
        assert_true(s.weight.x == 0.2f && s.weight.y == 0.5f &&
                    s.weight.z == 1.0f && s.eta_scale == 1.0f);
    }
}

static void mirrors_reflect(void **state)
{
    struct bsdf m = {.color = {0.9f, 0.5f, 0.1f}, .kind = MATERIAL_METAL};
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
    const double indices[] = {1.5, 1 / 1.5, 1.33, 2.4};

    (void)state;
    for (size_t e = 0; e < COUNT(indices); e++)
        for (int i = 1; i <= 1000; i++) {
            float c = (float)i / 1000;
            double f = fresnel_by_angles((double)c, indices[e]);
            struct bsdf m = {.color = {0.5f, 0.5f, 0.5f},
                             .eta = (float)indices[e],
                             .kind = MATERIAL_GLASS};
            struct bsdf_sample s = {0};
            float cos_t;

            check_close(fresnel_dielectric(c, m.eta, &cos_t), f, 3e-4);
            assert_true(bsdf_sample(&m, direction(c), v2(0, 0), 0, &s));
            check_close(s.wi.z, (double)c, 1e-6); /* the lobe at index 0 */
            check_close(s.weight.x, 1, 0);
            if (f > 0.999)
                continue;
            assert_true(
                bsdf_sample(&m, direction(c), v2(0, 0), 0.9999999f, &s));
            assert_true(s.wi.z < 0);
            check_close(v3_length(s.wi), 1, 2e-6);
            check_close(-s.wi.x * indices[e], (double)direction(c).x, 2e-6);
            check_close(s.weight.x, 0.5, 0); /* the tint */
            check_close(s.eta_scale, 1 / (indices[e] * indices[e]), 1e-6);
        }
}

static void index_one_is_invisible(void **state)
{
    struct bsdf m = {.color = white,
                     .alpha = 0.5f,
                     .eta = 1,
                     .kind = MATERIAL_GLASS};
    struct bsdf_sample s;

    (void)state;
    assert_true(bsdf_sample(&m, v3(0.6f, 0, 0.8f), v2(0.1f, 0.9f), 0, &s));
    assert_true(s.wi.x == -0.6f && s.wi.z == -0.8f && s.weight.x == 1);
}

/* A sheet reflects 2F / (1 + F) and transmits the rest straight on. */
static void thin_glass_adds_up_its_reflections(void **state)
{
    struct bsdf m = {.color = white, .eta = 1.5f, .kind = MATERIAL_THIN_GLASS};
    const int n = 100000;

    (void)state;
    for (size_t c = 0; c < COUNT(cosines); c++) {
        double f = fresnel_by_angles((double)cosines[c], 1.5);
        int reflected = 0;

        for (int i = 0; i < n; i++) {
            struct bsdf_sample s = {0};
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

/* f(wo, wi) = f(wi, wo). Through a face f(wo, wi; eta) = eta^2 f(wi, wo; 1 /
 * eta), without the compensation of glass, which is not reciprocal. */
static void check_reciprocity(const struct bsdf *m, float mu)
{
    uint64_t seed = 7;

    for (int i = 0; i < 200; i++) {
        struct vec3 wo = direction(mu);
        struct vec3 wi = any_direction(&seed);
        struct bsdf back = *m;
        double there, again, scale = 1;

        if (fabsf(wi.z) < 1e-3f)
            continue;
        there = (double)surface_f(m, wo, wi).x / fabs((double)wi.z);
        if (wi.z < 0) {
            if (m->kind == MATERIAL_GLASS) {
                back.eta = 1 / m->eta;
                scale = (double)(m->eta * m->eta);
            }
            again = (double)surface_f(&back, v3(wi.x, wi.y, -wi.z),
                                      v3(wo.x, wo.y, -wo.z))
                        .x;
        } else {
            again = (double)surface_f(&back, wi, wo).x;
        }
        again *= scale / (double)mu;
        if (m->kind == MATERIAL_GLASS) {
            there *= fmax((double)glass_albedo(mu, m->alpha, m->eta), 0.05);
            again *=
                fmax((double)glass_albedo(fabsf(wi.z), back.alpha, back.eta),
                     0.05);
        }
        check_close(there, again, 2e-3 * there + 1e-9);
    }
}

static void reflections_are_reciprocal(void **state)
{
    (void)state;
    at_all_reflections(check_reciprocity);
}

static void glass_is_reciprocal_but_for_its_compensation(void **state)
{
    (void)state;
    at_all_glasses(check_reciprocity);
}

static void rough_sheets_are_reciprocal(void **state)
{
    (void)state;
    at_all_sheets(check_reciprocity, white);
}

static void leaves_are_reciprocal(void **state)
{
    (void)state;
    at_all_translucents(check_reciprocity, brick, gold);
}

static void mirrors_and_sheets_have_no_density(void **state)
{
    const uint32_t kinds[] = {MATERIAL_METAL, MATERIAL_GLASS,
                              MATERIAL_THIN_GLASS, MATERIAL_PLASTIC};

    (void)state;
    for (size_t k = 0; k < COUNT(kinds); k++) {
        struct bsdf m = {.specular = white, .eta = 1.5f, .kind = kinds[k]};
        struct bsdf_sample s = {.is_delta = false};

        assert_true(bsdf_is_delta(&m));
        assert_true(surface_pdf(&m, direction(0.7f), direction(0.7f)) == 0);
        assert_true(bsdf_sample(&m, direction(0.7f), v2(0, 0), 0, &s));
        assert_true(s.is_delta && s.pdf == 0);
    }
}

/* F90 is 50 F0 for weak faces (Lagarde and de Rousiers 2014, 3.1). */
static void weak_faces_stay_weak_at_grazing_angles(void **state)
{
    struct bsdf m = {.specular = {0.01f, 0.01f, 0.01f},
                     .eta = 1,
                     .kind = MATERIAL_PLASTIC};

    (void)state;
    for (size_t c = 0; c < COUNT(cosines); c++) {
        struct bsdf_sample s;

        assert_true(bsdf_sample(&m, direction(cosines[c]), v2(0, 0), 0, &s));
        check_close((double)s.weight.x,
                    0.01 + 0.49 * pow(1 - (double)cosines[c], 5), 1e-6);
    }
}

static double albedo(const struct bsdf *m, float mu)
{
    return (double)sampled_albedo(m, mu, 300).z;
}

/* Returns f |cosine| of a channel from the direction `from`. */
static double eval_z(const void *bsdf, struct vec3 from, struct vec3 wi)
{
    return (double)surface_f(bsdf, from, wi).z;
}

/* Integrates f |cosine| of surfaces without highlights. */
static double integral_of_eval(const struct bsdf *m, float mu)
{
    return hemisphere_integral(eval_z, m, mu, 500);
}

static void check_furnace(const struct bsdf *m, float mu)
{
    double e;

    if (!check_is_due(4))
        return;
    e = m->kind == MATERIAL_ROUGH_DIFFUSE ? integral_of_eval(m, mu)
                                          : albedo(m, mu);
    if (fabs(e - 1) > 3e-3)
        print_error("kind %u alpha %g specular %g eta %g cosine %g\n", m->kind,
                    (double)m->alpha, (double)m->specular.x, (double)m->eta,
                    (double)mu);
    check_close(e, 1, 3e-3);
}

static void white_reflections_lose_nothing(void **state)
{
    const struct vec3 coats[] = {{0, 0, 0},
                                 {0.04f, 0.04f, 0.04f},
                                 {0.5f, 0.5f, 0.5f}};
    struct bsdf m = {.color = white, .eta = 1, .kind = MATERIAL_ROUGH_DIFFUSE};

    (void)state;
    for (m.alpha = 0; m.alpha <= 1; m.alpha += 0.25f)
        at_all_cosines(check_furnace, &m);
    for (size_t a = 0; a < COUNT(alphas); a++) {
        m.alpha = alphas[a];
        m.kind = MATERIAL_METAL;
        at_all_cosines(check_furnace, &m);
        m.kind = MATERIAL_PLASTIC;
        for (size_t k = 0; k < COUNT(coats); k++) {
            m.specular = coats[k];
            at_all_cosines(check_furnace, &m);
        }
    }
    m.alpha = 0;
    at_all_cosines(check_furnace, &m);
}

/* Directions that are mirrored to below the surface. */
static double eval_below_z(const void *bsdf, struct vec3 from, struct vec3 wi)
{
    return eval_z(bsdf, from, v3(wi.x, wi.y, -wi.z));
}

/* White paper reflects the rest of what it transmits; below a clear surface,
 * the rest of what that does not reflect. */
static void check_paper(const struct bsdf *m, float mu)
{
    double w = (double)m->translucency, above = 0, below;

    if (m->kind == MATERIAL_PLASTIC)
        above = (double)specular_albedo(m, direction(mu),
                                        bsdf_albedo(m, direction(mu)))
                    .x;
    below = hemisphere_integral(eval_below_z, m, mu, 300);
    check_close(below, w * (1 - above), 3e-3);
    if (m->kind == MATERIAL_ROUGH_DIFFUSE)
        check_close(integral_of_eval(m, mu), 1 - w, 3e-3);
    else
        check_close(albedo(m, mu), 1, 3e-3);
}

static void white_paper_loses_nothing(void **state)
{
    (void)state;
    at_all_translucents(check_paper, white, white);
}

/* f |cosine| of leaves by Lambert's law: a share of the front's colour above,
 * and the back's colour below. */
static void leaves_shine_on_both_sides(void **state)
{
    const struct bsdf m = {.color = {0.1f, 0.4f, 0.2f},
                           .kind = MATERIAL_DIFFUSE,
                           .back_color = {0.5f, 0.8f, 0},
                           .translucency = 0.25f};
    struct bsdf_sample s;
    int crossed = 0;

    (void)state;
    check_close((double)surface_f(&m, direction(0.3f), direction(0.6f)).y,
                0.75 * 0.4 * 0.6 / M_PI, 1e-7);
    check_close((double)surface_f(&m, direction(0.3f), v3(0.8f, 0, -0.6f)).y,
                0.25 * 0.8 * 0.6 / M_PI, 1e-7);
    assert_true(bsdf_transmits(&m) && !bsdf_is_delta(&m) && !bsdf_is_black(&m));
    for (int i = 0; i < 1000; i++) {
        assert_true(bsdf_sample(&m, direction(0.3f), v2(0.3f, 0.4f),
                                (float)((i + 0.5) / 1000), &s));
        crossed += s.wi.z < 0;
        check_close((double)(s.wi.z < 0 ? s.weight.x : s.weight.z),
                    s.wi.z < 0 ? 0.25 * 0.5 / 0.4 : 0.75 * 0.2 / 0.6, 1e-6);
    }
    assert_int_equal(crossed, 400); /* .25 * .8 beside .75 * .4 */
}

/* A black front with a back is a surface; without one it is none. */
static void black_leaves_let_light_through(void **state)
{
    struct bsdf m = {.kind = MATERIAL_DIFFUSE,
                     .back_color = brick,
                     .translucency = 1};

    (void)state;
    assert_false(bsdf_is_black(&m));
    m.back_color = v3(0, 0, 0);
    assert_true(bsdf_is_black(&m));
    m.kind = MATERIAL_PLASTIC;
    assert_true(bsdf_is_delta(&m));
    m.back_color = brick;
    assert_false(bsdf_is_delta(&m));
    m.kind = MATERIAL_PRINCIPLED;
    assert_true(bsdf_transmits(&m) && !bsdf_is_delta(&m));
}

static void white_glass_loses_nothing(void **state)
{
    struct bsdf m = {.color = white, .kind = MATERIAL_GLASS};

    (void)state;
    for (size_t e = 0; e < COUNT(etas); e++)
        for (size_t a = 0; a < COUNT(alphas); a++) {
            m.eta = etas[e];
            m.alpha = alphas[a];
            at_all_cosines(check_furnace, &m);
        }
}

static void white_sheets_lose_nothing(void **state)
{
    (void)state;
    at_all_sheets(check_furnace, white);
}

/* A hardly rough sheet is a smooth one: light leaves along the mirror direction
 * and straight on, by the same shares. */
static void rough_sheets_become_smooth(void **state)
{
    const int n = 20000;

    (void)state;
    for (size_t c = 0; c < 4; c++) {
        struct bsdf m = {.color = brick,
                         .alpha = 1e-3f,
                         .eta = 1.5f,
                         .kind = MATERIAL_THIN_GLASS};
        struct vec3 wo = direction(cosines[c]);
        double f = fresnel_by_angles((double)cosines[c], 1.5);
        double reflected = 0, transmitted = 0;
        uint64_t seed = 3;

        for (int i = 0; i < n; i++) {
            struct vec2 u =
                v2((float)check_random(&seed), (float)check_random(&seed));
            struct bsdf_sample s;

            if (!bsdf_sample(&m, wo, u, (float)((i + 0.5) / n), &s))
                continue;
            assert_false(s.is_delta);
            if (fabsf(s.wi.x + wo.x) > 0.02f || fabsf(s.wi.y) > 0.02f)
                continue;
            reflected += s.wi.z > 0 ? (double)s.weight.y / n : 0;
            transmitted += s.wi.z > 0 ? 0 : (double)s.weight.y / n;
        }
        check_close(reflected, 2 * f / (1 + f), 0.01);
        check_close(transmitted, (double)brick.y * (1 - f) / (1 + f), 0.01);
    }
}

/* Closed forms of Turquin and Hill with albedos by quadrature: one bounce is F0
 * (E - S) + S, further ones are (1 - E) F^2 E_mean / (1 - F (1 - E_mean)). */
static void coloured_metal_has_its_albedo(void **state)
{
    (void)state;
    for (size_t a = 2; a < COUNT(alphas); a++) {
        struct bsdf m = {.color = gold,
                         .alpha = alphas[a],
                         .eta = 1,
                         .kind = MATERIAL_METAL};
        double alpha = (double)alphas[a];
        double mean = 0;

        if (!check_is_due(3))
            continue;
        for (int i = 0; i < 32; i++) { /* mu = t^2, because it is steep at 0 */
            double t = (i + 0.5) / 32;

            mean += albedo_by_quadrature(FACETS_WHITE, alpha, t * t, 0) * 4 *
                    t * t * t / 32;
        }
        for (size_t c = 0; c < COUNT(cosines); c++) {
            double mu = (double)cosines[c];
            double e = albedo_by_quadrature(FACETS_WHITE, alpha, mu, 0);
            double s = albedo_by_quadrature(FACETS_SCHLICK, alpha, mu, 0);
            double f0 = (double)gold.z;
            double f = f0 + (1 - f0) / 21;

            check_close(albedo(&m, cosines[c]),
                        f0 * (e - s) + s +
                            (1 - e) * f * f * mean / (1 - f * (1 - mean)),
                        3e-3);
        }
    }
}

/* Single scattering of EON by quadrature, and the closed form of the rest: rho
 * E + rho_m (1 - E). */
static void rough_diffuse_has_its_albedo(void **state)
{
    const int side = 400;
    const double r = 0.8;
    const double a = 1 / (1 + (0.5 - 2 / (3 * M_PI)) * r);
    struct bsdf m = {.color = brick,
                     .alpha = (float)r,
                     .eta = 1,
                     .kind = MATERIAL_ROUGH_DIFFUSE};

    (void)state;
    for (size_t c = 0; c < COUNT(cosines); c++) {
        double mu = (double)cosines[c];
        double rho = (double)brick.z;
        double mean = a * (1 + (2.0 / 3 - 28 / (15 * M_PI)) * r);
        double e = 0;

        for (int i = 0; i < side * side; i++) {
            double z = (i % side + 0.5) / side;
            double phi = M_PI * (i / side + 0.5) / side;
            double s = sqrt((1 - mu * mu) * (1 - z * z)) * cos(phi);
            double t = s > 0 ? fmax(mu, z) : 1;

            e += 2 * z * a * (1 + r * s / t) / side / side;
        }
        check_close(integral_of_eval(&m, cosines[c]),
                    rho * e +
                        rho * rho * mean / (1 - rho * (1 - mean)) * (1 - e),
                    1.5e-3);
    }
}

/* Tests all values that files, textures and grazing rays can give. */
static void nothing_is_ever_nan_or_negative(void **state)
{
    const float edges[] = {0, 0x1p-24f, 0.5f, 1 - 0x1p-24f};
    const float mus[] = {1, 0.5f, 1e-3f, 1e-7f, 1e-15f, 1e-30f, 0};
    const float widths[] = {0, 4.9e-4f, 5e-4f, 0.02f, 1};
    const struct vec3 coat_normals[] = {{0, 0, 0}, {0.6f, 0, 0.8f}, {-1, 0, 0}};
    const float indices[] = {1e-6f, 0.5f, 0.9985f, 1, 1.0015f, 3, 1e6f};

    (void)state;
    for (uint32_t i = 0; i < 7 * 7 * 5 * 7 * 64; i++) {
        uint32_t k = i / 64;
        struct bsdf m = {.color = k & 1 ? white : v3(0, 1, 0.5f),
                         .specular = k & 2 ? strong : v3(0, 0, 0),
                         .kind = k % 7,
                         .alpha = widths[k / 49 % 5],
                         .eta = indices[k / 245],
                         .metalness = (float)(k % 3) / 2,
                         .transmission = (float)(k / 3 % 3) / 2,
                         .coat = (float)(k / 9 % 2),
                         .is_thin = k / 5 % 2,
                         .coat_normal = coat_normals[k / 7 % 3],
                         .coat_alpha = widths[(k / 49 + k / 18) % 5]};
        bool is_paper = (k & 4) != 0 && (k % 7 <= MATERIAL_ROUGH_DIFFUSE ||
                                         k % 7 == MATERIAL_PLASTIC ||
                                         k % 7 == MATERIAL_PRINCIPLED);
        struct vec3 wo = direction(mus[k / 7 % 7]);
        struct vec2 u = v2(edges[i % 4], edges[i / 4 % 4]);
        struct bsdf_sample s;

        if (is_paper) {
            m.translucency = edges[1 + k / 8 % 3];
            m.back_color = k & 64 ? white : v3(0, 0, 1e-30f);
        }
        if (!bsdf_sample(&m, wo, u, edges[i / 16 % 4], &s))
            continue;
        assert_true(s.weight.x >= 0 && s.weight.y >= 0 && s.weight.z >= 0);
        assert_true(v3_max_component(s.weight) < FLOAT_MAX &&
                    s.pdf < FLOAT_MAX);
        assert_true(v3_length(s.wi) < 1.1f);
        assert_true(s.is_delta || s.pdf > 0);
        assert_true(s.wi.z > 0 || is_paper || m.kind >= MATERIAL_GLASS);
        check_close((double)s.eta_scale, (double)bsdf_eta_scale(&m, s.wi), 0);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(diffuse_weight_is_the_albedo),
        cmocka_unit_test(mirrors_reflect),
        cmocka_unit_test(smooth_glass_obeys_fresnel_and_snell),
        cmocka_unit_test(index_one_is_invisible),
        cmocka_unit_test(thin_glass_adds_up_its_reflections),
        cmocka_unit_test(reflections_are_reciprocal),
        cmocka_unit_test(glass_is_reciprocal_but_for_its_compensation),
        cmocka_unit_test(rough_sheets_are_reciprocal),
        cmocka_unit_test(rough_sheets_become_smooth),
        cmocka_unit_test(white_sheets_lose_nothing),
        cmocka_unit_test(mirrors_and_sheets_have_no_density),
        cmocka_unit_test(weak_faces_stay_weak_at_grazing_angles),
        cmocka_unit_test(white_reflections_lose_nothing),
        cmocka_unit_test(white_glass_loses_nothing),
        cmocka_unit_test(white_paper_loses_nothing),
        cmocka_unit_test(leaves_shine_on_both_sides),
        cmocka_unit_test(black_leaves_let_light_through),
        cmocka_unit_test(leaves_are_reciprocal),
        cmocka_unit_test(coloured_metal_has_its_albedo),
        cmocka_unit_test(rough_diffuse_has_its_albedo),
        cmocka_unit_test(nothing_is_ever_nan_or_negative),
    };

    return cmocka_run_group_tests(tests, NULL, NULL);
}
