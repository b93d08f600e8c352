// SPDX-License-Identifier: MIT
/* MTL statements about what is in solid glass. */
#include <math.h>

#include "scene/material.h"
#include "tests/unit/read/one_material.h"

/* Coefficients are those of the file, or the extinction by distance with the
 * share of it that scatters. */
static void solids_scatter(void **state)
{
    const float e = logf(2) / 4;
    struct material m = only_material(
        "Tf_scatter 1 2 0\nTf_absorb .5\nTf_anisotropy -.3\nillum 7", 0);

    (void)state;
    check_color(m.color, 1, 1, 1);
    check_color(m.medium.scattering, 1, 2, 0);
    check_color(m.medium.extinction, 1.5, 2.5, .5);
    check_close((double)m.medium.anisotropy, -.3, 1e-7);
    assert_int_equal(m.is_boundary, 0);
    m = only_material("Tf_absorb 3 0 0\nNi 1\nillum 7", 0);
    check_color(m.medium.scattering, 0, 0, 0);
    check_color(m.medium.extinction, 3, 0, 0);
    assert_int_equal(m.is_boundary, 1);
    assert_int_equal(only_material("Tf_absorb 0\nNi 1\nillum 7", 0).is_boundary,
                     0);
    assert_int_equal(
        only_material("Tf_absorb 1\nNi 1\nTf .9 1 1\nillum 7", 0).is_boundary,
        0);
    assert_int_equal(
        only_material("Tf_absorb 1\nNi 1\nKe 1\nillum 7", 0).is_boundary, 0);
    m = only_material("Tf .5\nTf_distance 4\nTf_albedo 1 .5 0\nillum 7", 0);
    check_color(m.medium.extinction, (double)e, (double)e, (double)e);
    check_color(m.medium.scattering, (double)e, (double)e / 2, 0);
    m = only_material("Tf .5\nTf_distance 4\nTf_multiscatter 1 .8 0\nillum 7",
                      0);
    assert_true(m.medium.scattering.x > 0.999f * e &&
                m.medium.scattering.x <= e &&
                m.medium.scattering.y > 0.95f * e && m.medium.scattering.y < e);
    check_close((double)m.medium.scattering.z, 0, 1e-3 * (double)e);
    m = only_material("Kd .7\nPr .5\nTf .4 .4 .4\nTf_scatter 2 3 4", 0);
    check_close((double)m.transmission, .4, 1e-7);
    check_color(m.medium.scattering, 2, 3, 4);
}

/* No numbers make a medium whose coefficients are not finite, or that scatters
 * more light than it takes. */
static void media_of_any_numbers_are_media(void **state)
{
    static const char *const numbers[] = {"0",    "1e-45", "1e-30", "1e30",
                                          "3e38", "1e39",  "1e300", "-1",
                                          "nan",  "inf"};
    static const char *const keys[][2] = {{"Tf_scatter", "Tf_absorb"},
                                          {"Tf_distance", "Tf_albedo"},
                                          {"Tf_distance", "Tf_multiscatter"}};
    const size_t count = sizeof numbers / sizeof numbers[0];

    (void)state;
    for (size_t i = 0; i < 3 * count * count; i++) {
        const char *a = numbers[i % count], *b = numbers[i / count % count];
        const char *const *key = keys[i / (count * count)];
        const struct medium *m;
        struct loaded l;
        char text[256];

        snprintf(text, sizeof text,
                 "newmtl m\nillum 7\nTf .5\n%s %s\n%s %s .5 1\n"
                 "Tf_anisotropy %s\n",
                 key[0], a, key[1], b, b);
        l = load(text);
        assert_true(l.ok);
        m = &l.scene.materials[1].medium;
        assert_true(m->scattering.x >= 0 &&
                    m->scattering.x <= m->extinction.x &&
                    m->extinction.x <= 1e30f);
        assert_true(m->scattering.y <= m->extinction.y &&
                    m->scattering.z <= m->extinction.z);
        assert_true(fabsf(m->anisotropy) <= 0.999f);
        unload(&l);
    }
}

/* Statements that do nothing are counted, and the first one is named. */
static void media_without_effect_are_named(void **state)
{
    static const struct {
        const char *text;
        uint64_t count;
        const char *first;
    } cases[] = {
        {"Tf_scatter 1", 1,
         "a.mtl:2: found Tf_scatter, which solid glass uses: ignored"},
        {"illum 4\nTf .5\nTf_absorb 1\nTf_anisotropy .5", 2,
         "a.mtl:4: found Tf_absorb, which solid glass uses: ignored"},
        {"Kd .5\nTf_distance 2\nTf_albedo .5\nTf_attenuation .5", 3,
         "a.mtl:3: found Tf_distance, which solid glass uses: ignored"},
        {"illum 7\nTf_scatter 1\nTf_distance 2\nTf_albedo .5", 2,
         "a.mtl:4: found Tf_distance, which Tf_scatter and Tf_absorb replace: "
         "ignored"},
        {"illum 7\nTf_multiscatter .5\nTf_attenuation .5", 2,
         "a.mtl:4: found Tf_attenuation, which needs Tf_distance: ignored"},
        {"illum 7\nTf .5\nTf_distance 1\nTf_multiscatter .5\nTf_albedo .5", 1,
         "a.mtl:6: found Tf_albedo, which Tf_multiscatter replaces: ignored"},
        {"illum 7\nTf .5\nTf_distance 1\nTf_anisotropy .5", 1,
         "a.mtl:5: found Tf_anisotropy, which media that scatter use: "
         "ignored"},
        {"illum 7\nTf_scatter 1 -2 3", 1,
         "a.mtl:3: found Tf_scatter 1 -2 3, expected numbers of at least 0: "
         "others taken as 0"},
        {"illum 7\nTf_scatter 1\nTf_anisotropy 2", 1,
         "a.mtl:4: found Tf_anisotropy 2, expected a number from -1 to 1: "
         "taken as 0"},
    };

    (void)state;
    only_material("illum 7\nTf .5\nTf_distance 0\nTf_thin 0", 0);
    for (size_t i = 0; i < sizeof cases / sizeof cases[0]; i++) {
        char text[256];
        struct loaded l;

        snprintf(text, sizeof text, "newmtl m\n%s\n", cases[i].text);
        l = load(text);
        assert_true(l.ok);
        assert_int_equal(l.report.entry_count, 1);
        assert_string_equal(l.report.entries[0].text, cases[i].first);
        assert_int_equal(l.report.entries[0].count, cases[i].count);
        unload(&l);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(solids_scatter),
        cmocka_unit_test(media_of_any_numbers_are_media),
        cmocka_unit_test(media_without_effect_are_named),
    };

    return cmocka_run_group_tests(tests, NULL, NULL);
}
