// SPDX-License-Identifier: MIT
/*
 * What a person sets is what material_from_source() finds, for materials as
 * files may have them; what a knob shows can be typed, and what was turned can
 * be turned back.
 */
#include <math.h>
#include <stdlib.h>
#include <unistd.h>

#include "base/file.h"
#include "formats/scene_load.h"
#include "studio/material_params.h"
#include "studio/parameter_text.h"
#include "tests/unit/check.h"
#include "tests/unit/files.h"

static uint64_t seed = 5;

static struct mtl_number maybe(double value)
{
    if (check_random(&seed) < .5)
        return (struct mtl_number){.line = 0};
    return (struct mtl_number){value, 7};
}

static struct mtl_color maybe_color(void)
{
    struct mtl_color c = {.line = 7};

    if (check_random(&seed) < .4)
        return (struct mtl_color){.line = 0};
    for (int i = 0; i < 3; i++)
        c.rgb[i] = check_random(&seed) < .2 ? 0 : check_random(&seed);
    return c;
}

static struct mtl_source any_source(void)
{
    struct mtl_source s = mtl_source_empty();

    s.illum = maybe(floor(check_random(&seed) * 11));
    s.kd = maybe_color();
    s.ks = maybe_color();
    s.ke = maybe_color();
    s.tf = maybe_color();
    s.ns = maybe(check_random(&seed) * 1200);
    s.ni = maybe(1 + check_random(&seed));
    s.d = maybe(check_random(&seed));
    s.tr = maybe(check_random(&seed));
    s.pr = maybe(check_random(&seed));
    s.pm = maybe(check_random(&seed));
    s.kd_roughness = maybe(check_random(&seed));
    s.kelvin = maybe(1000 + 8000 * check_random(&seed));
    if (s.kelvin.line != 0) {
        s.luminance = (struct mtl_number){20 * check_random(&seed), 7};
        s.ke = (struct mtl_color){.line = 0};
    }
    for (int i = 0; i < MTL_MAPS; i++)
        if (check_random(&seed) < .2)
            s.maps[i] = (uint32_t)i;
    return s;
}

static void check_color(struct vec3 got, const double want[3])
{
    check_close((double)got.x, want[0], 1e-6);
    check_close((double)got.y, want[1], 1e-6);
    check_close((double)got.z, want[2], 1e-6);
}

static double luminance(struct vec3 c)
{
    return 0.2126 * (double)c.x + 0.7152 * (double)c.y + 0.0722 * (double)c.z;
}

static bool is_kind(const struct mtl_source *s, const char *name)
{
    return strcmp(material_params_kind(s), name) == 0;
}

/* All kinds are reached one after the other, with the colour kept. */
static void kinds_turn(void **state)
{
    static const char *const names[] = {"diffuse", "plastic", "metal", "glass",
                                        "thin glass"};

    (void)state;
    for (int round = 0; round < 2000; round++) {
        struct mtl_source s = any_source();
        double before[3], after[3];
        int first = 0;

        material_params_color(&s, before);
        while (!is_kind(&s, names[first]))
            first++;
        for (int i = 1; i <= 10; i++) {
            struct material m;

            material_params_turn_kind(&s, 1);
            assert_string_equal(material_params_kind(&s),
                                names[(first + i) % 5]);
            material_params_color(&s, after);
            for (int k = 0; k < 3; k++)
                check_close(after[k], before[k], 1e-6);
            m = material_params_material(&s);
            check_color(m.color, before);
        }
        material_params_turn_kind(&s, -1);
        assert_string_equal(material_params_kind(&s), names[(first + 4) % 5]);
    }
}

static void values_arrive(void **state)
{
    (void)state;
    for (int round = 0; round < 2000; round++) {
        struct mtl_source s = any_source();
        double rgb[3] = {.01 + check_random(&seed), check_random(&seed),
                         check_random(&seed)};
        double x = check_random(&seed), light[3];
        struct material m;

        rgb[0] = fmin(rgb[0], 1);
        material_params_set_color(&s, rgb);
        m = material_params_material(&s);
        check_color(m.color, rgb);
        material_params_set_roughness(&s, x);
        assert_true((float)material_params_roughness(&s) == (float)x);
        m = material_params_material(&s);
        if (m.kind == MATERIAL_ROUGH_DIFFUSE)
            check_close((double)m.alpha, x, 1e-6);
        else if (m.kind == MATERIAL_METAL || m.kind == MATERIAL_PLASTIC ||
                 m.kind == MATERIAL_GLASS)
            check_close((double)m.alpha, x * x, 1e-6);
        material_params_set_light_color(&s, rgb);
        material_params_set_strength(&s, 8);
        material_params_light_color(&s, light);
        m = material_params_material(&s);
        for (int k = 0; k < 3; k++)
            light[k] *= 8;
        check_color(m.emission, light);
        x = luminance(m.emission);
        material_params_set_kelvin(&s, 3000);
        m = material_params_material(&s);
        check_close(luminance(m.emission), x, 1e-3 * x);
        assert_true(m.emission.x > m.emission.y && m.emission.y > m.emission.z);
    }
}

/* ---- knobs, of a scene that was read ---- */

struct stage {
    struct scene scene;
    struct view view;
    struct warnings report;
    struct edit edit;
};

static void open_stage(struct stage *s)
{
    struct error err;

    *s = (struct stage){.report = {0}};
    put("k.obj", "mtllib k.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\no a\nusemtl m\n"
                 "f 1 2 3\no b\nusemtl n\nf 1 2 3\n");
    put("k.mtl", "newmtl m\nKd .5 .25 .125\nmap_Kd no.png\nnewmtl n\n"
                 "Ke_blackbody 3000 4\n");
    view_init(&s->view);
    check_or_say(scene_load(&s->scene, "k.obj", false, &s->report, &err),
                 err.text);
    edit_init(&s->edit, &s->scene, &s->view, &s->report);
}

static void close_stage(struct stage *s)
{
    edit_free(&s->edit);
    scene_free(&s->scene);
    view_free(&s->view);
    warnings_free(&s->report);
}

static void same_knobs(const struct parameter *a, const struct parameter *b,
                       int count)
{
    for (int i = 0; i < count; i++) {
        assert_int_equal(a[i].id, b[i].id);
        assert_string_equal(a[i].text, b[i].text);
    }
}

/* Turned up by some steps and down again, in the middle of its scale. */
static void knobs_turn_back(void **state)
{
    static const struct parameter_target targets[] = {
        {PARAMETER_MATERIAL, 1, false}, {PARAMETER_MATERIAL, 1, true},
        {PARAMETER_MATERIAL, 2, false}, {PARAMETER_OBJECT, 1, false},
        {PARAMETER_LIGHT, 0, false},    {PARAMETER_LIGHT, 0, true},
    };
    struct stage s;

    (void)state;
    open_stage(&s);
    edit_sky(&s.edit, "b.hdr");
    for (size_t i = 0; i < sizeof targets / sizeof targets[0]; i++) {
        struct parameter before[PARAMETERS_MAX], after[PARAMETERS_MAX];
        int count = parameters_list(&s.edit, &s.scene, &targets[i], before);

        assert_in_range(count, 1, PARAMETERS_MAX);
        for (int k = 0; k < count; k++) {
            size_t done = s.edit.done_count;

            edit_break(&s.edit);
            for (int n = 0; n < 3; n++)
                parameter_turn(&s.edit, &targets[i], before[k].id, 1);
            if (s.edit.done_count == done)
                continue; /* a swatch, or at the end of its scale */
            assert_int_equal(s.edit.done_count, done + 1);
            assert_true(edit_undo(&s.edit));
            assert_int_equal(parameters_list(&s.edit, &s.scene, &targets[i],
                                             after),
                             count);
            same_knobs(before, after, count);
        }
    }
    close_stage(&s);
}

/* What a knob shows, typed into it, shows the same; nonsense is refused and
 * changes nothing. */
static void shown_texts_can_be_typed(void **state)
{
    struct stage s;

    (void)state;
    open_stage(&s);
    for (uint32_t m = 1; m <= 2; m++) {
        struct parameter_target target = {PARAMETER_MATERIAL, m, m == 2};
        struct parameter before[PARAMETERS_MAX], after[PARAMETERS_MAX];
        int count = parameters_list(&s.edit, &s.scene, &target, before);
        struct error err;

        for (int k = 0; k < count; k++) {
            size_t done = s.edit.done_count;
            bool is_map = strncmp(before[k].label, "map", 3) == 0;

            assert_int_equal(knob_takes_text(before[k].id), k > 0 && !is_map);
            if (k == 0 || is_map || strcmp(before[k].text, "off") == 0)
                continue;
            assert_false(
                knob_set_text(&s.edit, &target, before[k].id, "many", &err));
            check_has(err.text, "found 'many', expected ");
            assert_int_equal(s.edit.done_count, done);
            check_or_say(knob_set_text(&s.edit, &target, before[k].id,
                                       before[k].text, &err),
                         err.text);
            assert_int_equal(parameters_list(&s.edit, &s.scene, &target, after),
                             count);
            assert_string_equal(after[k].text, before[k].text);
        }
    }
    close_stage(&s);
}

static const struct parameter *find(const struct parameter *knobs, int count,
                                    const char *label)
{
    for (int i = 0; i < count; i++)
        if (strcmp(knobs[i].label, label) == 0)
            return &knobs[i];
    print_error("no knob '%s'\n", label);
    assert_true(false);
    return NULL;
}

static void typed_values_arrive(void **state)
{
    static const struct {
        const char *label, *text, *shown;
    } cases[] = {
        {"colour", "#336699", "#336699"}, {"red", ".5", "0.5"},
        {"roughness", ".25", "0.25"},     {"light", "12.5", "12.5"},
        {"of colour", "2700K", "2700K"},  {"of colour", "4000", "4000K"},
        {"cover", ".75", "0.75"},         {"of colour", "#ffffff", "#ffffff"},
    };
    struct parameter_target target = {PARAMETER_MATERIAL, 1, false};
    struct parameter knobs[PARAMETERS_MAX];
    struct stage s;
    int count;

    (void)state;
    open_stage(&s);
    for (size_t i = 0; i < sizeof cases / sizeof cases[0]; i++) {
        struct error err;

        count = parameters_list(&s.edit, &s.scene, &target, knobs);
        check_or_say(knob_set_text(&s.edit, &target,
                                   find(knobs, count, cases[i].label)->id,
                                   cases[i].text, &err),
                     err.text);
        count = parameters_list(&s.edit, &s.scene, &target, knobs);
        assert_string_equal(find(knobs, count, cases[i].label)->text,
                            cases[i].shown);
    }
    /* a texture off and on */
    assert_string_equal(find(knobs, count, "map_Kd")->text, "on no.png");
    parameter_turn(&s.edit, &target, find(knobs, count, "map_Kd")->id, 1);
    parameters_list(&s.edit, &s.scene, &target, knobs);
    assert_string_equal(find(knobs, count, "map_Kd")->text, "off no.png");
    close_stage(&s);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(kinds_turn),
        cmocka_unit_test(values_arrive),
        cmocka_unit_test(knobs_turn_back),
        cmocka_unit_test(shown_texts_can_be_typed),
        cmocka_unit_test(typed_values_arrive),
    };

    return cmocka_run_group_tests(tests, enter_folder, remove_folder);
}
