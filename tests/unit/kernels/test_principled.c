// SPDX-License-Identifier: MIT
/*
 * test_principled.c - mixtures of surfaces against their parts and against
 * closed forms
 */
#include "tests/unit/check.h"

#include <math.h>

#include "tests/unit/facets.h"
#include "tests/unit/surfaces.h"

#define MIXTURES 60

static struct vec3 any_direction(uint64_t *state, float least)
{
    float z = least + (1 - least) * (float)check_random(state);
    double phi = 2 * M_PI * check_random(state);
    float r = sqrtf(1 - z * z);

    return v3(r * (float)cos(phi), r * (float)sin(phi), z);
}

static void check_same(struct bsdf a, struct bsdf b)
{
    uint64_t seed = 5;

    for (int i = 0; i < 500; i++) {
        struct vec3 wo = any_direction(&seed, 0);
        struct vec3 wi = any_direction(&seed, 0);
        float pdf_a, pdf_b;
        struct vec3 fa, fb;

        wi.z = i % 2 == 0 ? wi.z : -wi.z;
        fa = bsdf_terms(&a, wo, wi, &pdf_a);
        fb = bsdf_terms(&b, wo, wi, &pdf_b);
        check_close((double)fa.x, (double)fb.x, 1e-5 * (double)fb.x);
        check_close((double)fa.z, (double)fb.z, 1e-5 * (double)fb.z);
        check_close((double)pdf_a, (double)pdf_b, 1e-5 * (double)pdf_b);
    }
}

/* At the ends of its parameters the mixture is one of its parts. */
static void ends_are_metal_plastic_and_glass(void **state)
{
    const uint32_t kinds[] = {MATERIAL_METAL, MATERIAL_PLASTIC, MATERIAL_GLASS};

    (void)state;
    for (size_t a = 0; a < COUNT(alphas); a++)
        for (size_t k = 0; k < COUNT(kinds); k++) {
            struct bsdf part = {.color = brick,
                                .specular = strong,
                                .alpha = alphas[a],
                                .eta = 1.5f,
                                .kind = kinds[k]};
            struct bsdf m = part;

            m.kind = MATERIAL_PRINCIPLED;
            m.metalness = kinds[k] == MATERIAL_METAL ? 1 : 0;
            if (kinds[k] == MATERIAL_GLASS) {
                m.transmission = 1;
                m.color = v3_mul(part.color, part.color);
            }
            check_same(m, part);
            assert_int_equal(bsdf_is_delta(&m), bsdf_is_delta(&part));
            assert_int_equal(bsdf_transmits(&m), bsdf_transmits(&part));
        }
}

static struct vec3 albedo(const struct bsdf *m, float mu)
{
    return sampled_albedo(m, mu, 400);
}

static void white_mixtures_lose_nothing(void **state)
{
    uint64_t seed = 1;

    (void)state;
    for (int i = 0; i < MIXTURES; i++) {
        struct bsdf m = random_mixture(&seed);
        struct vec3 e;

        m.color = white;
        if (!check_is_due(6))
            continue;
        e = albedo(&m, cosines[i % (int)COUNT(cosines)]);
        check_at_most(fmax((double)e.x, fmax((double)e.y, (double)e.z)),
                      1 + 5e-3);
        check_at_most(m.film * m.transmission > 0 ? 0.9 : 1 - 5e-3,
                      fmin((double)e.x, fmin((double)e.y, (double)e.z)));
    }
}

static void coloured_mixtures_add_no_light(void **state)
{
    uint64_t seed = 2;

    (void)state;
    for (int i = 0; i < MIXTURES; i++) {
        struct bsdf m = random_mixture(&seed);
        struct vec3 e;

        m.film = i % 2 == 0 ? m.film : 0;
        if (i / 2 % 2 == 0)
            m.coat_normal = any_direction(&seed, 0.3f);
        if (!check_is_due(5))
            continue;
        e = albedo(&m, cosines[i % (int)COUNT(cosines)]);

        check_at_most(fmax((double)e.x, fmax((double)e.y, (double)e.z)), 1);
        if (m.film > 0)
            continue; /* it has colours of its own */
        check_at_most((double)e.y, (double)e.x + 5e-3);
        check_at_most((double)e.z, (double)e.y + 5e-3);
    }
}

/* Without transmission f(wo, wi) = f(wi, wo) below coat and sheen, which take
 * what they reflect from wo. */
static void layers_are_reciprocal_but_for_those_above(void **state)
{
    uint64_t seed = 3;

    (void)state;
    for (int i = 0; i < MIXTURES; i++) {
        struct bsdf m = random_mixture(&seed);
        struct bsdf coat = {.color = v3(0, 0, 0),
                            .specular = v3(COAT_F0, COAT_F0, COAT_F0),
                            .kind = MATERIAL_PLASTIC};

        m.transmission = 0;
        m.film = 0;
        coat.alpha = m.coat_alpha;
        for (int k = 0; k < 50; k++) {
            struct vec3 w[2] = {any_direction(&seed, 0.01f),
                                any_direction(&seed, 0.01f)};
            double f[2];

            for (int j = 0; j < 2; j++) {
                struct vec3 wo = w[j], wi = w[1 - j];
                double sheen =
                    (double)(m.sheen.x * sheen_albedo(wo.z, m.sheen_alpha));
                double e =
                    (double)(m.coat *
                             specular_albedo(&coat, wo, bsdf_albedo(&coat, wo))
                                 .x);
                double top = (double)(m.coat * surface_f(&coat, wo, wi).y);

                if (m.sheen.x > 0)
                    top = (1 - sheen) * top +
                          (double)(m.sheen.x * sheen_f(wo, wi, m.sheen_alpha));
                e = 1 - (1 - sheen) * (1 - e);

                f[j] = ((double)surface_f(&m, wo, wi).y - top) / (1 - e) /
                       (double)wi.z;
            }
            check_close(f[0], f[1], 2e-3 * f[0] + 1e-5);
        }
    }
}

/* The distribution and Smith's masking with two widths (Heitz 2014, eqs. 85 and
 * 86). */
static void facets_have_two_widths(void **state)
{
    uint64_t seed = 6;

    (void)state;
    for (int i = 0; i < 2000; i++) {
        struct bsdf m = {.alpha = 0.05f + 0.95f * (float)check_random(&seed),
                         .anisotropy = (float)check_random(&seed),
                         .kind = MATERIAL_PRINCIPLED};
        struct vec3 h = any_direction(&seed, 0.01f);
        double aspect = sqrt(1 - 0.9 * (double)m.anisotropy);
        double ax = (double)m.alpha / aspect, ay = (double)m.alpha * aspect;
        double x = (double)h.x, y = (double)h.y, z = (double)h.z;
        double d = x * x / (ax * ax) + y * y / (ay * ay) + z * z;
        double lambda =
            (sqrt(1 + (ax * ax * x * x + ay * ay * y * y) / (z * z)) - 1) / 2;

        check_close((double)ggx_density(h, bsdf_facets(&m)) * M_PI * ax * ay *
                        d * d,
                    1, 1e-4);
        check_close((double)ggx_root(h, bsdf_facets(&m)) /
                        (z * (1 + 2 * lambda)),
                    1, 1e-4);
    }
}

/* White facets reflect all light from each azimuth. */
static void stretched_facets_keep_all_light(void **state)
{
    uint64_t seed = 8;

    (void)state;
    for (int i = 0; i < 80; i++) {
        float phi = 2 * (float)M_PI * (float)check_random(&seed);
        struct vec3 wo = direction(cosines[i % (int)COUNT(cosines)]);
        struct bsdf m = {.color = white,
                         .specular = strong,
                         .alpha = alphas[3 + i / 5 % 4],
                         .anisotropy = (float)(i / 20 + 1) / 4,
                         .metalness = (float)(i % 2),
                         .eta = 1,
                         .kind = MATERIAL_PRINCIPLED};

        wo = v3(wo.x * cosf(phi), wo.x * sinf(phi), wo.z);
        if (check_is_due(5))
            check_close((double)sampled_albedo_from(&m, wo, 150).x, 1, 5e-3);
    }
}

static void sheen_is_reciprocal(void **state)
{
    uint64_t seed = 9;

    (void)state;
    for (int i = 0; i < 2000; i++) {
        struct vec3 wo = any_direction(&seed, 0.01f);
        struct vec3 wi = any_direction(&seed, 0.01f);
        float alpha = SHEEN_ALPHA_MIN +
                      (1 - SHEEN_ALPHA_MIN) * (float)check_random(&seed);
        double there = (double)(sheen_f(wo, wi, alpha) / wi.z);

        check_close((double)(sheen_f(wi, wo, alpha) / wo.z), there,
                    1e-4 * there + 1e-12);
    }
}

static double sheen_of(const void *alpha, struct vec3 wo, struct vec3 wi)
{
    return (double)sheen_f(wo, wi, *(const float *)alpha);
}

/* The table has the albedo, also between its nodes, and no more light leaves
 * than arrives. */
static void sheen_has_the_albedo_of_its_table(void **state)
{
    (void)state;
    for (float alpha = SHEEN_ALPHA_MIN; alpha <= 1; alpha += 0.0731f)
        for (float mu = 0.0023f; mu <= 1; mu *= 1.31f) {
            double e;

            if (!check_is_due(9))
                continue;
            e = hemisphere_integral(sheen_of, &alpha, mu, 400);
            check_at_most(e, 1);
            check_close((double)sheen_albedo(mu, alpha), e,
                        mu < 0.02f ? 0.015 : 4e-3);
        }
}

static void powers_are_those_of_libm(void **state)
{
    uint64_t seed = 4;

    (void)state;
    for (int i = 0; i < 100000; i++) {
        float x = (float)exp2(20 * check_random(&seed) - 19);
        float y = (float)(8 * check_random(&seed));
        double want = pow((double)x, (double)y);

        if (want > 1e-30)
            check_close((double)f_pow(x, y) / want, 1, 1e-5);
        y = (float)(160 * check_random(&seed) - 80);
        check_close((double)f_exp(y) / exp((double)y), 1, 1e-5);
    }
    assert_true(f_pow(0, 2) == 0 && f_exp2(-1000) == 0);
    assert_true(f_exp2(1000) == 0x1p126f);
}

/* A coat of full weight over a black base reflects its albedo, found by
 * quadrature; over a base of albedo a it adds (1 - that) a. */
static void coats_reflect_their_albedo(void **state)
{
    (void)state;
    for (size_t a = 2; a < COUNT(alphas); a++)
        for (size_t c = 0; c < COUNT(cosines) - 1; c++) {
            struct bsdf m = {.coat = 0.8f,
                             .coat_alpha = alphas[a],
                             .eta = 1,
                             .kind = MATERIAL_PRINCIPLED};
            double alpha = (double)alphas[a], mu = (double)cosines[c];
            double e, s, coat;

            if (!check_is_due(3))
                continue;
            e = albedo_by_quadrature(FACETS_WHITE, alpha, mu, 0);
            s = albedo_by_quadrature(FACETS_SCHLICK, alpha, mu, 0);
            coat = 0.8 * (0.04 * (e - s) + s);
            check_close((double)albedo(&m, cosines[c]).x, coat, 4e-3);
            m.color = v3(0.6f, 0.6f, 0.6f);
            check_close((double)albedo(&m, cosines[c]).x,
                        coat + (1 - coat) * 0.6, 4e-3);
        }
}

/* A smooth coat reflects about its own normal, and a rough one too, as a coat
 * whose frame is turned; the base keeps its own. */
static void coats_have_their_own_normal(void **state)
{
    const float angle = 0.3f;
    struct bsdf flat = {.coat = 1, .eta = 1, .kind = MATERIAL_PRINCIPLED};
    struct bsdf bent = flat;
    struct vec3 wo = direction(0.9f), turned = wo, wi;
    struct bsdf_sample s;
    uint64_t seed = 4;

    (void)state;
    bent.coat_normal = v3(0, sinf(angle), cosf(angle));
    assert_true(bsdf_sample(&bent, wo, v2(0.3f, 0.6f), 0.5f, &s));
    wi = v3_sub(v3_scale(bent.coat_normal, 2 * v3_dot(bent.coat_normal, wo)),
                wo);
    check_close((double)v3_length(v3_sub(s.wi, wi)), 0, 1e-6);
    flat.coat_alpha = bent.coat_alpha = 0.3f;
    turned.y = cosf(angle) * wo.y - sinf(angle) * wo.z;
    turned.z = sinf(angle) * wo.y + cosf(angle) * wo.z;
    for (int i = 0; i < 1000; i++) {
        struct vec3 in = direction((float)check_random(&seed)), there = in;
        float p, q;
        double want, is;

        there.y = cosf(angle) * in.y - sinf(angle) * in.z;
        there.z = sinf(angle) * in.y + cosf(angle) * in.z;
        if (there.z <= 0)
            continue;
        want = (double)bsdf_terms(&flat, turned, there, &p).x;
        is = (double)bsdf_terms(&bent, wo, in, &q).x;
        check_close(is, want, 1e-4 * want + 1e-7);
        check_close((double)q, (double)p, 1e-4 * (double)p + 1e-6);
    }
    bent.color = white;
    check_at_most((double)albedo(&bent, 0.4f).x, 1 + 4e-3);
}

static void mixtures_of_mirrors_have_no_density(void **state)
{
    struct bsdf m = {.color = gold,
                     .metalness = 0.5f,
                     .transmission = 1,
                     .coat = 1,
                     .eta = 1.5f,
                     .kind = MATERIAL_PRINCIPLED};
    struct bsdf_sample s;

    (void)state;
    assert_true(bsdf_is_delta(&m));
    assert_true(surface_pdf(&m, direction(0.7f), direction(0.7f)) == 0);
    for (int i = 0; i < 100; i++) {
        assert_true(bsdf_sample(&m, direction(0.7f), v2(0.3f, 0.6f),
                                (float)i / 100, &s));
        assert_true(s.is_delta && s.pdf == 0);
    }
    m.coat_alpha = 0.1f;
    assert_false(bsdf_is_delta(&m));
    m.coat = 0;
    assert_true(bsdf_is_delta(&m));
    m.transmission = 0.5f;
    assert_false(bsdf_is_delta(&m));
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(ends_are_metal_plastic_and_glass),
        cmocka_unit_test(white_mixtures_lose_nothing),
        cmocka_unit_test(coloured_mixtures_add_no_light),
        cmocka_unit_test(layers_are_reciprocal_but_for_those_above),
        cmocka_unit_test(powers_are_those_of_libm),
        cmocka_unit_test(sheen_is_reciprocal),
        cmocka_unit_test(sheen_has_the_albedo_of_its_table),
        cmocka_unit_test(facets_have_two_widths),
        cmocka_unit_test(stretched_facets_keep_all_light),
        cmocka_unit_test(coats_reflect_their_albedo),
        cmocka_unit_test(coats_have_their_own_normal),
        cmocka_unit_test(mixtures_of_mirrors_have_no_density),
    };

    return cmocka_run_group_tests(tests, NULL, NULL);
}
