// SPDX-License-Identifier: MIT
/*
 * test_parameter.c - parameters of materials are found by
 * material_from_source(), their texts can be typed, and steps are undone
 */
#include <math.h>
#include <stdlib.h>
#include <unistd.h>

#include "base/file.h"
#include "base/memory.h"
#include "engine/scene_load.h"
#include "studio/material_parameters.h"
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

static struct material_values any_source(void)
{
    struct material_values s = material_values_empty();

    s.illum = maybe(floor(check_random(&seed) * 11));
    s.base_color = maybe_color();
    s.specular_color = maybe_color();
    s.emission = maybe_color();
    s.transmission = maybe_color();
    s.shininess = maybe(check_random(&seed) * 1200);
    s.ior = maybe(1 + check_random(&seed));
    s.abbe = maybe(100 * check_random(&seed));
    s.opacity = maybe(check_random(&seed));
    s.transparency = maybe(check_random(&seed));
    s.roughness = maybe(check_random(&seed));
    s.metalness = maybe(check_random(&seed));
    s.coat = maybe(check_random(&seed));
    s.coat_roughness = maybe(check_random(&seed));
    s.sheen = maybe(check_random(&seed));
    s.anisotropy = maybe(check_random(&seed));
    s.anisotropy_rotation = maybe(check_random(&seed));
    s.diffuse_roughness = maybe(check_random(&seed));
    s.sheen_roughness = maybe(check_random(&seed));
    s.film = maybe(check_random(&seed));
    s.back_color = maybe_color();
    s.translucency = maybe(check_random(&seed));
    s.film_ior = maybe(1 + check_random(&seed));
    s.film_thickness = maybe(1000 * check_random(&seed));
    s.cutoff = maybe(check_random(&seed));
    s.kelvin = maybe(1000 + 8000 * check_random(&seed));
    if (s.kelvin.line != 0) {
        s.luminance = (struct mtl_number){20 * check_random(&seed), 7};
        s.emission = (struct mtl_color){.line = 0};
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

/* Opens the parameter of this name of a material with these statements. */
static struct owner open_source(const struct material_values *source,
                                const char *label)
{
    struct owner o = {.selection = NULL};

    material_parameters_open(&o, source, NULL);
    for (const struct parameter_row *row = material_parameters;
         row->label != NULL; row++) {
        if (strcmp(row->label, label) == 0 && (row->kinds >> o.kind & 1) != 0)
            o.row = row;
    }
    return o;
}

/* Returns false if the material lacks the parameter. */
static bool get(const struct material_values *source, const char *label,
                struct value *value)
{
    struct owner o = open_source(source, label);

    return o.row != NULL && parameter_read(&o, value);
}

static void set(struct material_values *source, const char *label,
                const struct value *value)
{
    struct owner o = open_source(source, label);

    if (o.row == NULL)
        return;
    o.row->set(&o, value);
    *source = o.source;
}

static struct value get_color(const struct material_values *source)
{
    struct value value;

    assert_true(get(source, "colour", &value) || get(source, "tint", &value));
    return value;
}

static struct material material_of(const struct material_values *source)
{
    return open_source(source, "").material;
}

/* Each kind can be chosen and keeps the colour. */
static void kinds_keep_the_color(void **state)
{
    static const char *const names[] = {"diffuse", "plastic",    "metal",
                                        "glass",   "thin glass", "principled"};

    (void)state;
    for (int round = 0; round < 2000; round++) {
        struct material_values s = any_source();
        struct value before = get_color(&s), kind;
        double swatch[3];
        int first;

        assert_true(get(&s, "type", &kind));
        first = (int)kind.number;
        assert_string_equal(material_parameters_summary(&s, NULL, swatch),
                            names[first]);
        for (int i = 1; i <= 12; i++) {
            struct value after;

            kind.number = (first + i) % 6;
            set(&s, "type", &kind);
            assert_string_equal(material_parameters_summary(&s, NULL, swatch),
                                names[(first + i) % 6]);
            after = get_color(&s);
            for (int k = 0; k < 3; k++)
                check_close(after.rgb[k], before.rgb[k], 1e-6);
            check_color(material_of(&s).color, before.rgb);
        }
    }
}

static void set_values_reach_the_material(void **state)
{
    (void)state;
    for (int round = 0; round < 2000; round++) {
        struct material_values s = any_source();
        struct value color = {.rgb = {.01 + check_random(&seed),
                                      check_random(&seed),
                                      check_random(&seed)}};
        struct value roughness = {.number = check_random(&seed)}, found;
        double x = roughness.number, bright;
        struct material m;

        color.rgb[0] = fmin(color.rgb[0], 1);
        set(&s, "colour", &color);
        set(&s, "Abbe number", &(struct value){.number = 25});
        if (get(&s, "Abbe number", &found))
            check_close(found.number, 25, 0);
        m = material_of(&s);
        if (m.kind == MATERIAL_GLASS)
            check_close((double)m.dispersion, ((double)m.ior - 1) / 25, 1e-7);
        set(&s, "tint", &color);
        check_color(material_of(&s).color, color.rgb);
        set(&s, "roughness", &roughness);
        if (get(&s, "roughness", &found))
            assert_true((float)found.number == (float)x);
        m = material_of(&s);
        if (m.kind == MATERIAL_ROUGH_DIFFUSE)
            check_close((double)m.alpha, x, 1e-6);
        else if (m.kind == MATERIAL_METAL || m.kind == MATERIAL_PLASTIC ||
                 m.kind == MATERIAL_GLASS || m.kind == MATERIAL_PRINCIPLED)
            check_close((double)m.alpha, x * x, 1e-6);
        set(&s, "coat rough", &roughness);
        set(&s, "coat", &(struct value){.number = .5});
        set(&s, "transmits", &(struct value){.number = .25});
        set(&s, "metal", &(struct value){.number = .75});
        set(&s, "sheen", &(struct value){.number = .125});
        set(&s, "sheen rough", &(struct value){.number = .75});
        set(&s, "film", &(struct value){.number = .25});
        set(&s, "film index", &(struct value){.number = 1.5});
        set(&s, "film nm", &(struct value){.number = 350});
        set(&s, "grain", &(struct value){.number = .5});
        set(&s, "grain turn", &(struct value){.number = .25});
        set(&s, "translucent", &(struct value){.number = .375});
        set(&s, "back colour", &color);
        set(&s, "mean path", &color);
        set(&s, "subsurface", &(struct value){.number = .625});
        m = material_of(&s);
        if (m.kind != MATERIAL_METAL && m.kind != MATERIAL_GLASS &&
            m.kind != MATERIAL_THIN_GLASS) {
            check_close((double)m.translucency, .375, 0);
            check_close((double)m.subsurface, .625, 0);
            assert_true(m.medium.extinction.x > 0);
            check_color(m.back_color, color.rgb);
        }
        if (m.kind == MATERIAL_PRINCIPLED) {
            check_close((double)m.coat, .5, 0);
            check_close((double)m.transmission, .25, 1e-7);
            check_close((double)m.metalness, .75, 0);
            check_close((double)m.sheen.x, .125, 0);
            check_close((double)m.sheen_alpha, .5625, 0);
            check_close((double)m.film, .25, 0);
            check_close((double)m.film_ior, 1.5, 0);
            check_close((double)m.film_thickness, 350, 0);
            check_close((double)m.anisotropy, .5, 0);
            check_close((double)m.grain.y, 1, 1e-7);
        }
        set(&s, "of colour", &color);
        set(&s, "light", &(struct value){.number = 8});
        assert_true(get(&s, "of colour", &found));
        for (int k = 0; k < 3; k++)
            found.rgb[k] *= 8;
        check_color(material_of(&s).emission, found.rgb);
        bright = luminance(material_of(&s).emission);
        set(&s, "of colour", &(struct value){.number = 3000});
        m = material_of(&s);
        check_close(luminance(m.emission), bright, 1e-3 * bright);
        assert_true(m.emission.x > m.emission.y && m.emission.y > m.emission.z);
    }
}

/* Sheen of a colour has the weight that is set, and a film with a map the
 * thickness where it is black. */
static void values_of_gltf_are_edited(void **state)
{
    struct material_values s = material_values_empty();
    const struct value blue = {.rgb = {.1, .2, .8}};
    struct value found = {.number = 0};
    struct material m;

    (void)state;
    s.roughness = s.sheen = s.film = (struct mtl_number){.5, 1};
    s.metalness = (struct mtl_number){.25, 1};
    assert_false(get(&s, "then", &found) || get(&s, "film from", &found));
    set(&s, "sheen tint", &blue);
    set(&s, "sheen", &(struct value){.number = .25});
    m = material_of(&s);
    check_close((double)m.sheen.x, .025, 1e-7);
    check_close((double)m.sheen.z, .2, 1e-7);
    assert_true(get(&s, "sheen", &found));
    check_close(found.number, .25, 1e-6);
    set(&s, "sheen", &(struct value){.number = 0});
    assert_false(get(&s, "sheen tint", &found));

    s.maps[MTL_MAP_FILM_THICKNESS] = 3;
    set(&s, "film from", &(struct value){.number = 120});
    check_close((double)material_of(&s).film_thinnest, 120, 0);

    s.illum = (struct mtl_number){7, 1};
    s.attenuation_distance = (struct mtl_number){2, 1};
    assert_false(get(&s, "then", &found));
    s.attenuation = (struct mtl_color){{1, 1, 1}, 1};
    set(&s, "then", &blue);
    assert_true(get(&s, "then", &found));
    check_close(material_of(&s).medium.extinction.y, -log(.2) / 2, 1e-5);
}

/* Leaves begin to let light through in their own colour. */
static void leaves_keep_their_color(void **state)
{
    struct material_values s = material_values_empty();
    struct value found;

    (void)state;
    s.base_color = (struct mtl_color){{.1, .4, .2}, 1};
    assert_true(get(&s, "translucent", &found) && found.number == 0);
    assert_false(get(&s, "back colour", &found));
    set(&s, "translucent", &(struct value){.number = .5});
    assert_true(get(&s, "back colour", &found));
    check_color(material_of(&s).back_color, s.base_color.rgb);
    set(&s, "translucent", &(struct value){.number = 0});
    assert_true(material_of(&s).translucency == 0);
    /* Td alone is all of the light */
    s.translucency = (struct mtl_number){.line = 0};
    assert_true(get(&s, "translucent", &found) && found.number == 1);
}

/* The tint of a solid stays what it is if it begins to count after a distance,
 * and the weight of transmission keeps its hue. */
static void tints_take_a_distance(void **state)
{
    struct material_values s = material_values_empty();
    const struct value red = {.rgb = {.8, .4, .2}};

    (void)state;
    s.illum = (struct mtl_number){7, 1};
    assert_true(get(&s, "tint depth", &(struct value){.number = 0}));
    set(&s, "tint depth", &(struct value){.number = 2});
    set(&s, "tint", &red);
    assert_true(get_color(&s).rgb[1] == .4);
    check_close((double)material_of(&s).medium.extinction.y, -log(.4) / 2,
                1e-6);
    s.illum.value = 2;
    set(&s, "type", &(struct value){.number = 5});
    set(&s, "transmits", &(struct value){.number = .5});
    s.transmission = (struct mtl_color){{.8, .4, .2}, 1};
    set(&s, "transmits", &(struct value){.number = .4});
    check_close((double)material_of(&s).transmission, .4, 1e-7);
    check_close((double)material_of(&s).medium.extinction.y, -log(.5) / 2,
                1e-6);
    set(&s, "tint depth", &(struct value){.number = 0});
    assert_true(v3_is_zero(material_of(&s).medium.extinction));
}

static void set_number(struct material_values *source, const char *label,
                       double number)
{
    set(source, label, &(struct value){.number = number});
}

static void check_triple(const struct mtl_color *got, double r, double g,
                         double b)
{
    check_close(got->rgb[0], r, 1e-6);
    check_close(got->rgb[1], g, 1e-6);
    check_close(got->rgb[2], b, 1e-6);
}

/* A medium begins white. Density and colour are changed apart from each other,
 * and without density the distance counts again. */
static void solids_have_a_medium(void **state)
{
    const struct value coefficients = {.rgb = {1, 2, .5}};
    struct material_values s = material_values_empty();
    struct material m;
    struct value v;

    (void)state;
    assert_false(get(&s, "density", &v));
    s.illum = (struct mtl_number){7, 1};
    assert_true(get(&s, "density", &v) && v.number == 0);
    assert_false(get(&s, "scatters", &v) || get(&s, "inside", &v) ||
                 get(&s, "anisotropy", &v));
    set_number(&s, "density", 2);
    check_triple(&s.medium_scatter, 2, 2, 2);
    check_triple(&s.medium_absorb, 0, 0, 0);
    assert_true(get(&s, "inside", &v));
    check_close(v.rgb[0], 1, 1e-4);
    assert_false(get(&s, "tint depth", &v));

    set(&s, "scatters", &coefficients);
    set(&s, "absorbs", &(struct value){.rgb = {1, 0, .5}});
    set_number(&s, "anisotropy", -.5);
    m = material_of(&s);
    check_color(m.medium.scattering, coefficients.rgb);
    check_color(m.medium.extinction, (double[]){2, 2, 1});
    check_close((double)m.medium.anisotropy, -.5, 0);
    set_number(&s, "density", 6);
    check_triple(&s.medium_scatter, 3, 6, 1.5);
    check_triple(&s.medium_absorb, 3, 0, 1.5);

    set_number(&s, "density", 0);
    assert_int_equal(s.medium_scatter.line + s.medium_absorb.line, 0);
    assert_true(get(&s, "tint depth", &v));
    assert_false(get(&s, "anisotropy", &v));
}

/* The solid glass of a mixture has a medium, its sheet has none. */
static void mixtures_have_a_medium(void **state)
{
    struct material_values s = material_values_empty();
    struct value v;

    (void)state;
    s.roughness = (struct mtl_number){.5, 1};
    s.transmission = (struct mtl_color){{.6, .5, .1}, 1};
    s.attenuation_distance = (struct mtl_number){2, 1};
    s.medium_absorb = (struct mtl_color){{1, 2, 3}, 1};
    assert_true(get(&s, "absorbs", &v) && v.rgb[2] == 3);
    set_number(&s, "density", 1.5);
    check_triple(&s.medium_absorb, .5, 1, 1.5);
    set_number(&s, "transmits", .25);
    check_close((double)material_of(&s).transmission, .25, 1e-7);
    set_number(&s, "glass is", 1);
    assert_false(get(&s, "density", &v) || get(&s, "absorbs", &v));
}

/* The color that is read is the one that was set, at any anisotropy, and the
 * extinction stays. */
static void media_have_the_color_that_is_set(void **state)
{
    (void)state;
    for (int round = 0; round < 500; round++) {
        struct material_values s = material_values_empty();
        struct value color = {
            .rgb = {check_random(&seed), check_random(&seed), round % 2}};
        struct value v;

        s.illum = (struct mtl_number){7, 1};
        set_number(&s, "density", 5);
        set_number(&s, "anisotropy", 1.8 * check_random(&seed) - .9);
        set(&s, "inside", &color);
        assert_true(get(&s, "inside", &v));
        for (int c = 0; c < 3; c++) {
            check_close(v.rgb[c], color.rgb[c], 1e-3);
            check_close(s.medium_scatter.rgb[c] + s.medium_absorb.rgb[c], 5,
                        1e-5);
        }
    }
}

/* Without coefficients, density is a distance, and the colour of the medium a
 * statement beside it. */
static void distances_have_a_density(void **state)
{
    struct material_values s = material_values_empty();
    struct value v;

    (void)state;
    s.illum = (struct mtl_number){7, 1};
    s.transmission = (struct mtl_color){{.5, .5, .5}, 1};
    s.attenuation_distance = (struct mtl_number){2, 1};
    s.medium_albedo = (struct mtl_color){{.9, .9, .9}, 1};
    assert_true(get(&s, "density", &v));
    check_close(v.number, log(2) / 2, 1e-6);
    assert_false(get(&s, "scatters", &v));
    set_number(&s, "density", log(2));
    check_close(s.attenuation_distance.value, 1, 1e-6);
    set(&s, "inside", &(struct value){.rgb = {.25, .5, 1}});
    check_triple(&s.medium_color, .25, .5, 1);
    assert_int_equal(s.medium_albedo.line, 0);
    assert_true(get(&s, "inside", &v));
    check_close(v.rgb[0], .25, 1e-5);
    set_number(&s, "density", 0);
    assert_true(v3_is_zero(material_of(&s).medium.extinction));
}

/* Beside its map an absent factor is 1, on the screen as in the picture, and
 * what is set is what the picture has. */
static void absent_factors_are_1(void **state)
{
    const struct mtl_number one = {1, 1};
    struct material_values s = material_values_empty();
    struct value v;
    struct material m;

    (void)state;
    for (int i = 0; i < MTL_MAPS; i++)
        s.maps[i] = (uint32_t)i;
    s.maps[MTL_MAP_SHEEN] = NO_INDEX;
    m = material_of(&s); /* map_Pm makes it a mixture */
    assert_int_equal(m.kind, MATERIAL_PRINCIPLED);
    v = get_color(&s);
    for (int i = 0; i < 3; i++)
        assert_true(v.rgb[i] == 1);
    check_color(m.color, (double[]){1, 1, 1});
    check_color(m.emission, (double[]){1, 1, 1});
    check_close((double)m.specular.x, (double)MATERIAL_SPECULAR, 0);
    assert_true(get(&s, "of colour", &v) && v.rgb[0] == 1 && v.rgb[2] == 1);
    for (int i = 0; i < 10; i++) {
        static const char *const labels[] = {"roughness", "metal",
                                             "coat",      "coat rough",
                                             "sheen",     "sheen rough",
                                             "film",      "light",
                                             "specular",  "translucent"};
        const float made[] = {
            m.alpha,       m.metalness,  m.coat,
            m.coat_alpha,  m.sheen.x,    m.sheen_alpha,
            m.film,        m.emission.x, m.specular.x / MATERIAL_SPECULAR,
            m.translucency};

        assert_true(get(&s, labels[i], &v));
        check_close(v.number, 1, 0);
        check_close((double)made[i], 1, 0);
    }
    s.roughness = one; /* transmission counts beside Pr */
    assert_true(get(&s, "transmits", &v));
    check_close(v.number, 1, 0);
    check_close((double)material_of(&s).transmission, 1, 0);
}

/* Black beside a map would be white: a slider at its end is nearly black. */
static void factors_go_down_to_black(void **state)
{
    const struct value black = {.rgb = {0, 0, 0}};
    struct material_values s = material_values_empty();
    struct material m;
    struct value v;

    (void)state;
    s.maps[MTL_MAP_COLOR] = s.maps[MTL_MAP_SPECULAR] =
        s.maps[MTL_MAP_EMISSION] = 0;
    s.base_color = s.specular_color = s.emission =
        (struct mtl_color){{0, 0, 0}, 1};
    m = material_of(&s); /* as exporters write */
    check_color(m.color, (double[]){1, 1, 1});
    check_color(m.emission, (double[]){1, 1, 1});
    assert_true(get(&s, "light", &v) && v.number == 1);
    v = get_color(&s);
    assert_true(v.rgb[0] == 1 && v.rgb[2] == 1);
    set(&s, "colour", &black);
    set(&s, "light", &black);
    set(&s, "specular", &black);
    m = material_of(&s);
    check_color(m.color, black.rgb);
    check_color(m.emission, black.rgb);
    check_color(m.specular, black.rgb);
    check_color((struct vec3){(float)get_color(&s).rgb[0], 0, 0}, black.rgb);
}

struct fixture {
    struct scene scene;
    struct view view;
    struct warnings report;
    struct edit edit;
};

static void open_fixture_of(struct fixture *s, const char *mtl)
{
    struct error err;

    *s = (struct fixture){.report = {0}};
    put("k.obj", "mtllib k.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\no a\nusemtl m\n"
                 "f 1 2 3\no b\nusemtl n\nf 1 2 3\n");
    put("k.mtl", mtl);
    view_init(&s->view);
    for (int i = 0; i < LAMP_KINDS; i++) {
        struct lamp lamp;

        lamp_init(&lamp, (enum lamp_kind)i);
        assert_true(lamps_add(&s->view.lamps, &lamp));
    }
    check_or_say(scene_load(&s->scene, "k.obj", SCENE_UP_OF_FILE, &s->report,
                            &err),
                 err.text);
    edit_init(&s->edit, &s->scene, &s->view, &s->report);
}

static void open_fixture(struct fixture *s)
{
    open_fixture_of(s, "newmtl m\nKd .5 .25 .125\nmap_Kd no.png\nnewmtl n\n"
                       "Ke_blackbody 3000 4\n");
}

static void close_fixture(struct fixture *s)
{
    edit_free(&s->edit);
    scene_free(&s->scene);
    view_free(&s->view);
    warnings_free(&s->report);
}

static void check_same(const struct parameter *a, const struct parameter *b,
                       int count)
{
    for (int i = 0; i < count; i++) {
        assert_int_equal(a[i].id, b[i].id);
        assert_string_equal(a[i].text, b[i].text);
    }
}

static struct selection target_of(struct fixture *s, enum selection_page page,
                                  uint32_t index, bool by_hsv)
{
    return (struct selection){&s->edit, &s->scene,      NULL,
                              page,     {index, index}, by_hsv,
                              NULL,     NULL,           0,
                              0,        MTL_MAP_COLOR};
}

static const struct parameter *find(const struct parameter *list, int count,
                                    const char *label)
{
    for (int i = 0; i < count; i++)
        if (strcmp(list[i].label, label) == 0)
            return &list[i];
    print_error("no parameter '%s'\n", label);
    assert_true(false);
    return NULL;
}

/* Consecutive steps of a parameter are undone together. */
static void steps_are_undone(void **state)
{
    static const struct {
        enum selection_page page;
        uint32_t index;
        bool by_hsv;
    } targets[] = {
        {PAGE_MATERIALS, 1, false}, {PAGE_MATERIALS, 1, true},
        {PAGE_MATERIALS, 2, false}, {PAGE_OBJECTS, 1, false},
        {PAGE_LIGHT, 0, false},     {PAGE_LIGHT, 0, true},
    };
    struct fixture s;

    (void)state;
    open_fixture(&s);
    edit_sky(&s.edit, "b.hdr");
    for (size_t i = 0; i < sizeof targets / sizeof targets[0]; i++) {
        struct selection target =
            target_of(&s, targets[i].page, targets[i].index, targets[i].by_hsv);
        struct parameter before[PARAMETERS_MAX], after[PARAMETERS_MAX];
        int count = parameters_list(&target, before);

        assert_in_range(count, 1, PARAMETERS_MAX);
        for (int k = 0; k < count; k++) {
            size_t done = s.edit.history.done_count;

            if (strcmp(before[k].label, "add image") == 0)
                continue; /* chooses the map, and changes nothing */
            edit_end_step(&s.edit);
            for (int n = 0; n < 3; n++)
                parameter_step(&target, before[k].id, 1);
            if (s.edit.history.done_count == done)
                continue; /* a colour, or at the end of its scale */
            assert_int_equal(s.edit.history.done_count, done + 1);
            assert_true(edit_undo(&s.edit));
            assert_int_equal(parameters_list(&target, after), count);
            check_same(before, after, count);
        }
    }
    close_fixture(&s);
}

/* A choice of n is the same after n steps in either direction. */
static void choices_are_cyclic(void **state)
{
    static const struct {
        enum selection_page page;
        const char *label;
        int count;
    } choices[] = {{PAGE_MATERIALS, "type", 6},
                   {PAGE_MATERIALS, "map_Kd", 2},
                   {PAGE_MATERIALS, "add image", MTL_MAPS},
                   {PAGE_OBJECTS, "material", 3},
                   {PAGE_LIGHT, "tone", 3}};
    struct fixture s;

    (void)state;
    open_fixture(&s);
    for (size_t i = 0; i < sizeof choices / sizeof choices[0]; i++) {
        struct selection target = target_of(&s, choices[i].page, 1, false);
        struct parameter list[PARAMETERS_MAX];
        int count = parameters_list(&target, list);
        struct parameter first = *find(list, count, choices[i].label);

        for (int direction = -1; direction <= 1; direction += 2) {
            for (int n = 1; n <= choices[i].count; n++) {
                bool is_same;

                parameter_step(&target, first.id, direction);
                count = parameters_list(&target, list);
                is_same = strcmp(find(list, count, first.label)->text,
                                 first.text) == 0;
                assert_int_equal(is_same, n == choices[i].count);
            }
        }
    }
    close_fixture(&s);
}

/* Typing the text of a parameter gives the same text. Invalid text is refused
 * and changes nothing. */
static void texts_can_be_typed(void **state)
{
    struct fixture s;

    (void)state;
    open_fixture(&s);
    for (uint32_t m = 1; m <= 2; m++) {
        struct selection target = target_of(&s, PAGE_MATERIALS, m, m == 2);
        struct parameter before[PARAMETERS_MAX], after[PARAMETERS_MAX];
        int count = parameters_list(&target, before);
        struct error err;

        for (int k = 0; k < count; k++) {
            size_t done = s.edit.history.done_count;
            bool is_map = before[k].map != MTL_MAPS;

            assert_int_equal(before[k].takes_text, k > 0 && !is_map);
            if (k == 0 || is_map || strcmp(before[k].text, "off") == 0)
                continue;
            assert_false(
                parameter_set_text(&target, before[k].id, "many", &err));
            check_has(err.text, "found 'many', expected ");
            assert_int_equal(s.edit.history.done_count, done);
            check_or_say(parameter_set_text(&target, before[k].id,
                                            before[k].text, &err),
                         err.text);
            assert_int_equal(parameters_list(&target, after), count);
            assert_string_equal(after[k].text, before[k].text);
        }
    }
    close_fixture(&s);
}

static void typed_values_reach_the_material(void **state)
{
    static const struct {
        const char *label, *text, *shown;
    } cases[] = {
        {"colour", "#336699", "#336699"}, {"red", ".5", "0.5"},
        {"roughness", ".25", "0.25"},     {"light", "12.5", "12.5"},
        {"of colour", "2700K", "2700K"},  {"of colour", "4000", "4000K"},
        {"opacity", ".75", "0.75"},       {"of colour", "#ffffff", "#ffffff"},
    };
    struct selection target;
    struct parameter list[PARAMETERS_MAX];
    struct fixture s;
    int count;

    (void)state;
    open_fixture(&s);
    target = target_of(&s, PAGE_MATERIALS, 1, false);
    for (size_t i = 0; i < sizeof cases / sizeof cases[0]; i++) {
        struct error err;

        count = parameters_list(&target, list);
        check_or_say(parameter_set_text(&target,
                                        find(list, count, cases[i].label)->id,
                                        cases[i].text, &err),
                     err.text);
        count = parameters_list(&target, list);
        assert_string_equal(find(list, count, cases[i].label)->text,
                            cases[i].shown);
    }
    /* Switches a texture off and on. */
    assert_string_equal(find(list, count, "map_Kd")->text, "on no.png");
    parameter_step(&target, find(list, count, "map_Kd")->id, 1);
    parameters_list(&target, list);
    assert_string_equal(find(list, count, "map_Kd")->text, "off no.png");
    close_fixture(&s);
}

/* Types a value for a parameter of the light. */
static void type(struct fixture *s, const char *label, const char *text)
{
    struct selection target = target_of(s, PAGE_LIGHT, 0, false);
    struct parameter list[PARAMETERS_MAX];
    int count = parameters_list(&target, list);
    struct error err;

    check_or_say(parameter_set_text(&target, find(list, count, label)->id, text,
                                    &err),
                 err.text);
}

static void check_rgb(const double got[3], double r, double g, double b)
{
    check_close(got[0], r, 1e-3 * fabs(r));
    check_close(got[1], g, 1e-3 * fabs(g));
    check_close(got[2], b, 1e-3 * fabs(b));
}

/* Each lamp has one first row, with its kind. */
static void lamps_have_a_first_row(void **state)
{
    struct fixture s;
    struct parameter list[PARAMETERS_MAX];
    uint32_t heads = 0;
    struct selection selection;
    int count;

    (void)state;
    open_fixture(&s);
    selection = (struct selection){.edit = &s.edit,
                                   .scene = &s.scene,
                                   .page = PAGE_LIGHT};
    count = parameters_list(&selection, list);
    for (int i = 0; i < count; i++)
        if (list[i].heads > 0) {
            assert_int_equal(list[i].lamp, heads++);
            assert_true(i == 0 || list[i - 1].lamp != list[i].lamp);
        }
    assert_int_equal(heads, s.edit.now.view.lamps.count);
    close_fixture(&s);
}

/* A colour keeps the strength, and a strength the colour, of its own lamp. */
static void typed_values_reach_the_lamp(void **state)
{
    struct fixture s;
    struct lamps *now = &s.edit.now.view.lamps;

    (void)state;
    open_fixture(&s);
    type(&s, "strength", "40"); /* the first one is the point's */
    type(&s, "point", "1 .5 .25");
    check_rgb(now->items[LAMP_POINT].rgb, 40, 20, 10);
    type(&s, "spot", "#0000ff");
    check_rgb(now->items[LAMP_SPOT].rgb, 0, 0, 1);
    type(&s, "direction", "0.5 0.25 0");
    check_rgb(now->items[LAMP_DIRECTIONAL].rgb, 1, 0.5, 0);
    check_rgb(now->items[LAMP_POINT].rgb, 40, 20, 10);
    assert_true(edit_has_unsaved_view(&s.edit));
    for (int i = 0; i < 4; i++) {
        edit_end_step(&s.edit);
        edit_undo(&s.edit);
    }
    assert_true(lamps_equal(&s.edit.now.view.lamps, &s.view.lamps));
    close_fixture(&s);
}

/* Sets the first parameter of lamp `number` with this label. */
static void type_lamp(struct fixture *s, uint32_t number, const char *label,
                      const char *text)
{
    struct selection target = target_of(s, PAGE_LIGHT, 0, false);
    struct parameter list[PARAMETERS_MAX];
    int count = parameters_list(&target, list);
    struct error err;

    for (int i = 0; i < count; i++)
        if (list[i].lamp == number && strcmp(list[i].label, label) == 0) {
            check_or_say(parameter_set_text(&target, list[i].id, text, &err),
                         err.text);
            return;
        }
    print_error("no parameter '%s' of lamp %u\n", label, number);
    assert_true(false);
}

/* Places, angles and sizes reach their lamp, and all are undone. A spot always
 * has a direction, and its inner angle is within the outer one. */
static void typed_numbers_reach_the_lamp(void **state)
{
    struct fixture s;
    struct lamps *now = &s.edit.now.view.lamps;
    static const struct {
        uint32_t lamp;
        const char *label, *text;
    } typed[] = {
        {LAMP_POINT, "x", "1"},
        {LAMP_POINT, "y", "-2"},
        {LAMP_POINT, "z", "3e9"},
        {LAMP_POINT, "radius", "0.5"},
        {LAMP_SPOT, "to y", "-4"},
        {LAMP_SPOT, "to x", "5"},
        {LAMP_SPOT, "to z", "6"},
        {LAMP_SPOT, "inner", "60"},
        {LAMP_SPOT, "outer", "50"},
        {LAMP_DIRECTIONAL, "azimuth", "70"},
        {LAMP_DIRECTIONAL, "angle", "0.5"},
        {LAMP_DIRECTIONAL, "elevation", "-30"},
    };
    const struct lamp *l;

    (void)state;
    open_fixture(&s);
    for (size_t i = 0; i < sizeof typed / sizeof *typed; i++) {
        edit_end_step(&s.edit);
        type_lamp(&s, typed[i].lamp, typed[i].label, typed[i].text);
    }
    l = now->items;
    check_rgb(l[LAMP_POINT].position, 1, -2, 3e9);
    check_close(l[LAMP_POINT].radius, 0.5, 0);
    check_rgb(l[LAMP_SPOT].at, 5, -4, 6);
    check_close(l[LAMP_SPOT].inner_deg, 50, 0);
    check_close(l[LAMP_SPOT].outer_deg, 50, 0);
    check_close(l[LAMP_DIRECTIONAL].azimuth_deg, 70, 0);
    check_close(l[LAMP_DIRECTIONAL].elevation_deg, -30, 0);
    check_close(l[LAMP_DIRECTIONAL].angle_deg, 0.5, 0);
    type_lamp(&s, LAMP_SPOT, "x", "5");
    type_lamp(&s, LAMP_SPOT, "y", "-4");
    type_lamp(&s, LAMP_SPOT, "z", "6");
    assert_true(now->items[LAMP_SPOT].at[1] < -4);
    while (edit_undo(&s.edit) != NULL)
        continue;
    assert_true(lamps_equal(now, &s.view.lamps));
    close_fixture(&s);
}

/* Lamps come, change their kind and go; undo brings them back. */
static void lamps_come_and_go(void **state)
{
    struct fixture s;
    struct lamps *now = &s.edit.now.view.lamps;
    struct selection target;
    struct lamp lamp;
    uint32_t number;

    (void)state;
    open_fixture(&s);
    target = target_of(&s, PAGE_LIGHT, 0, false);
    lamp = parameter_new_lamp(&target, NO_INDEX);
    number = edit_add_lamp(&s.edit, &lamp);
    edit_end_step(&s.edit);
    assert_int_equal(number, LAMP_KINDS);
    assert_int_equal(now->count, LAMP_KINDS + 1);
    check_rgb(now->items[number].position, s.scene.center[0], s.scene.center[1],
              s.scene.center[2]);
    type_lamp(&s, number, "kind", "spot");
    assert_true(now->items[number].at[1] < now->items[number].position[1]);
    type_lamp(&s, number, "kind", "direction");
    assert_true(now->items[number].elevation_deg > 0);
    edit_end_step(&s.edit);
    edit_remove_lamp(&s.edit, 0);
    edit_end_step(&s.edit);
    assert_int_equal(now->count, LAMP_KINDS);
    assert_int_equal(now->items[0].kind, LAMP_SPOT);
    assert_true(edit_has_unsaved_view(&s.edit));
    edit_undo(&s.edit);
    assert_int_equal(now->items[0].kind, LAMP_POINT);
    while (edit_undo(&s.edit) != NULL)
        continue;
    assert_true(lamps_equal(now, &s.view.lamps));
    while (edit_redo(&s.edit) != NULL)
        continue;
    assert_int_equal(now->count, LAMP_KINDS);
    assert_int_equal(now->items[2].kind, LAMP_DIRECTIONAL);
    close_fixture(&s);
}

/* More lamps than the list can hold are left out. */
static void many_lamps_fit_the_list(void **state)
{
    struct parameter list[PARAMETERS_MAX];
    struct selection target;
    struct fixture s;

    (void)state;
    open_fixture(&s);
    for (int i = 0; i < 100; i++)
        assert_true(
            lamps_add(&s.edit.now.view.lamps, &s.view.lamps.items[i % 3]));
    target = target_of(&s, PAGE_LIGHT, 0, false);
    assert_in_range(parameters_list(&target, list), 40, PARAMETERS_MAX);
    close_fixture(&s);
}

/* Returns the parameter with this label. */
static struct parameter labelled(const struct selection *target,
                                 const char *label)
{
    struct parameter list[PARAMETERS_MAX];
    int count = parameters_list(target, list);

    return *find(list, count, label);
}

/* A substance is one step of the history. Its mean free paths are those of a
 * body as large as the object, whose longest side is 1. */
static void presets_are_one_step(void **state)
{
    static const struct {
        const char *name, *index, *abbe; /* of glass */
        const char *path;                /* of plastic */
    } cases[] = {
        {"milk", NULL, NULL, "0.0371 0.0294 0.025"},
        {"skin", NULL, NULL, "0.0483 0.0355 0.025"},
        {"marble", NULL, NULL, "0.0457 0.0382 0.0333"},
        {"wax", NULL, NULL, "0.05 0.0533 0.0658"},
        {"jade", NULL, NULL, "0.0886 0.0833 0.0935"},
        {"water", "1.333", "55.7", NULL},
        {"crown glass", "1.52", "64", NULL},
        {"flint glass", "1.62", "36", NULL},
        {"diamond", "2.42", "44.3", NULL},
    };
    struct selection target;
    struct fixture s;
    struct error err;

    (void)state;
    open_fixture(&s);
    target = target_of(&s, PAGE_MATERIALS, 1, false);
    assert_string_equal(labelled(&target, "preset").text, "none");
    for (size_t i = 0; i < sizeof cases / sizeof cases[0]; i++) {
        int id = labelled(&target, "preset").id;

        check_or_say(parameter_set_text(&target, id, cases[i].name, &err),
                     err.text);
        edit_end_step(&s.edit);
        assert_string_equal(labelled(&target, "preset").text, cases[i].name);
        if (cases[i].path != NULL) {
            assert_string_equal(labelled(&target, "type").text, "plastic");
            assert_string_equal(labelled(&target, "subsurface").text, "1");
            assert_string_equal(labelled(&target, "mean path").text,
                                cases[i].path);
            continue;
        }
        assert_string_equal(labelled(&target, "type").text, "glass");
        assert_string_equal(labelled(&target, "tint").text, "#ffffff");
        assert_string_equal(labelled(&target, "index").text, cases[i].index);
        assert_string_equal(labelled(&target, "Abbe number").text,
                            cases[i].abbe);
        assert_string_equal(labelled(&target, "density").text, "off");
    }
    parameter_step(&target, labelled(&target, "preset").id, 1);
    edit_end_step(&s.edit);
    assert_string_equal(labelled(&target, "preset").text, "milk");
    /* other lengths are the same substance, another colour is not */
    check_or_say(parameter_set_text(&target, labelled(&target, "mean path").id,
                                    ".1483 .1178 .1", &err),
                 err.text);
    assert_string_equal(labelled(&target, "preset").text, "milk");
    edit_end_step(&s.edit);
    parameter_set_text(&target, labelled(&target, "colour").id, "#804020",
                       &err);
    assert_string_equal(labelled(&target, "preset").text, "none");
    edit_end_step(&s.edit);
    assert_int_equal(s.edit.history.done_count,
                     sizeof cases / sizeof cases[0] + 3);
    while (edit_undo(&s.edit) != NULL)
        continue;
    assert_string_equal(labelled(&target, "type").text, "diffuse");
    assert_true(material_values_equal(&s.edit.now.sources[1],
                                      &s.edit.saved.sources[1]));
    close_fixture(&s);
}

/* The rows of fog appear with it. What is typed reaches the view and is undone.
 */
static void fog_is_edited(void **state)
{
    struct fixture s;
    const struct fog *f = &s.edit.now.view.lighting.fog;
    struct selection target;

    (void)state;
    open_fixture(&s);
    target = target_of(&s, PAGE_LIGHT, 0, false);
    assert_string_equal(labelled(&target, "fog").text, "off");
    type(&s, "density", ".5");
    check_rgb(f->scatter, .5, .5, .5);
    assert_string_equal(labelled(&target, "fog").text, "fog");
    type(&s, "scatters", ".1 .2 .3");
    type(&s, "absorbs", ".1");
    check_rgb(f->scatter, .1, .2, .3);
    check_rgb(f->absorb, .1, .1, .1);
    assert_string_equal(labelled(&target, "scatters").text, "0.1 0.2 0.3");
    assert_string_equal(labelled(&target, "fog").text, "other");
    type(&s, "anisotropy", ".7");
    type(&s, "falloff", "2");
    type(&s, "height", "-1");
    check_close(f->anisotropy, .7, 0);
    check_close(f->falloff, 2, 0);
    check_close(f->base, -1, 0);
    parameter_step(&target, labelled(&target, "scatters").id, 1);
    check_rgb(f->scatter, .11, .22, .33);
    type(&s, "fog", "haze");
    assert_string_equal(labelled(&target, "fog").text, "haze");
    assert_true(f->scatter[2] > f->scatter[0] && f->falloff > 0);
    assert_true(edit_has_unsaved_view(&s.edit));
    type(&s, "fog", "off");
    assert_false(fog_is_there(f));
    while (edit_undo(&s.edit) != NULL)
        continue;
    assert_true(lighting_equal(&s.edit.now.view.lighting, &s.view.lighting));
    close_fixture(&s);
}

static void triples_are_checked(void **state)
{
    static const char *const wrong[] = {"1 2",   "-1 2 3",   "#ffffff",
                                        "3000K", "1 1 1e31", "-1"};
    struct selection target;
    struct fixture s;
    struct error err;

    (void)state;
    open_fixture(&s);
    target = target_of(&s, PAGE_LIGHT, 0, false);
    type(&s, "density", "1");
    for (size_t i = 0; i < sizeof wrong / sizeof wrong[0]; i++) {
        assert_false(parameter_set_text(&target,
                                        labelled(&target, "absorbs").id,
                                        wrong[i], &err));
        check_has(err.text, "expected one number or three from 0 on");
    }
    close_fixture(&s);
}

/* Returns the parameter with this id as it is now. */
static struct parameter parameter_now(const struct selection *target, int id)
{
    struct parameter list[PARAMETERS_MAX];
    int count = parameters_list(target, list), i = 0;

    while (i < count && list[i].id != id)
        i++;
    assert_true(i < count);
    return list[i];
}

static void set_slider(const struct selection *target,
                       const struct parameter *p)
{
    double rgb[3];

    if (p->fraction < 0) {
        parameter_set_fraction(target, p->id, 0.5);
        assert_string_equal(parameter_now(target, p->id).text, p->text);
    } else if (parameter_color_at(target, p->id, 0.25, rgb)) {
        int channel = p->id % 4; /* the id of the colour is that of 0 */

        parameter_set_fraction(target, p->id, 0.25);
        assert_string_equal(parameter_now(target, p->id).text, "0.25");
        for (int c = 0; c < 3; c++)
            check_close(rgb[c], parameter_now(target, p->id - channel).color[c],
                        0);
    } else {
        for (int eighth = 1; eighth < 8; eighth += 3) {
            parameter_set_fraction(target, p->id, eighth / 8.0);
            check_close(parameter_now(target, p->id).fraction, eighth / 8.0,
                        0.01);
        }
    }
}

/* A slider's place becomes the value, and its colours are those that the
 * channel makes. */
static void sliders_set_values(void **state)
{
    struct parameter list[PARAMETERS_MAX];
    struct selection target;
    struct fixture s;
    int count;

    (void)state;
    open_fixture(&s);
    target = target_of(&s, PAGE_MATERIALS, 1, false);
    count = parameters_list(&target, list);
    assert_in_range(count, 8, PARAMETERS_MAX);
    for (int i = 0; i < count; i++)
        set_slider(&target, &list[i]);
    close_fixture(&s);
}

/* Checks that colour, light and one map of material 1 are those that the world
 * renders, and that the first key changes one channel only. */
static void check_rendered(const char *statements, double color, double light,
                           const char *stepped)
{
    struct fixture s;
    struct host_world world;
    struct selection target;
    struct parameter list[PARAMETERS_MAX];
    struct material_values after;
    struct error err;
    char *mtl = format_text("newmtl m\n%s\nnewmtl n\nKd 1\n", statements);
    int count;

    open_fixture_of(&s, mtl);
    free(mtl);
    check_or_say(world_init(&world, &s.scene, 1, &s.report, &err), err.text);
    target = target_of(&s, PAGE_MATERIALS, 1, false);
    target.world = &world;
    count = parameters_list(&target, list);
    check_close((double)world.materials[1].color.y, color, 1e-7);
    check_close((double)world.materials[1].emission.y, light, 1e-7);
    check_close(find(list, count, "colour")->color[1], color, 1e-7);
    check_close(strtod(find(list, count, "light")->text, NULL), light, 0);
    parameter_step(&target, find(list, count, "red")->id, -1);
    after = s.edit.now.sources[1];
    assert_string_equal(find(list, parameters_list(&target, list), "red")->text,
                        stepped);
    check_close(after.base_color.rgb[1], color, 1e-7);
    world_free(&world);
    close_fixture(&s);
}

/* The colour beside an image that is there, one that is missing, and one that
 * is switched off by no one. */
static void panels_show_what_is_rendered(void **state)
{
    (void)state;
    put("white.ppm", "P6\n1 1\n255\n\377\377\377");
    check_rendered("map_Kd white.ppm\nmap_Ke white.ppm", 1, 1, "0.99");
    check_rendered("Kd 0 0 0\nmap_Kd white.ppm\nKe 0 0 0\nmap_Ke white.ppm", 1,
                   1, "0.99");
    check_rendered("map_Kd no.ppm\nmap_Ke no.ppm", (double)MATERIAL_GREY, 0,
                   "0.79");
    check_rendered("Kd 0 0 0\nmap_Kd no.ppm", (double)MATERIAL_GREY, 0, "0.79");
    check_rendered("Kd .5 .5 .5\nmap_Kd no.ppm\nKe 2 2 2\nmap_Ke no.ppm", .5, 2,
                   "0.49");
    unlink("white.ppm");
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(kinds_keep_the_color),
        cmocka_unit_test(set_values_reach_the_material),
        cmocka_unit_test(values_of_gltf_are_edited),
        cmocka_unit_test(leaves_keep_their_color),
        cmocka_unit_test(tints_take_a_distance),
        cmocka_unit_test(solids_have_a_medium),
        cmocka_unit_test(mixtures_have_a_medium),
        cmocka_unit_test(media_have_the_color_that_is_set),
        cmocka_unit_test(distances_have_a_density),
        cmocka_unit_test(presets_are_one_step),
        cmocka_unit_test(fog_is_edited),
        cmocka_unit_test(triples_are_checked),
        cmocka_unit_test(absent_factors_are_1),
        cmocka_unit_test(factors_go_down_to_black),
        cmocka_unit_test(panels_show_what_is_rendered),
        cmocka_unit_test(steps_are_undone),
        cmocka_unit_test(choices_are_cyclic),
        cmocka_unit_test(texts_can_be_typed),
        cmocka_unit_test(typed_values_reach_the_material),
        cmocka_unit_test(lamps_have_a_first_row),
        cmocka_unit_test(typed_values_reach_the_lamp),
        cmocka_unit_test(typed_numbers_reach_the_lamp),
        cmocka_unit_test(lamps_come_and_go),
        cmocka_unit_test(many_lamps_fit_the_list),
        cmocka_unit_test(sliders_set_values),
    };

    return cmocka_run_group_tests(tests, enter_folder, remove_folder);
}
