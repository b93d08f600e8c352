// SPDX-License-Identifier: MIT
/*
 * test_blender.c - materials as Blender's exporters write them
 *
 * ../shared/suites/blender has the exports of 3.4.1 and 5.0.1, and its README
 * what was set. The folder is looked for in ../shared or $GLIM_SHARED.
 */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "base/file.h"
#include "read/mtl.h"
#include "terminal/xmalloc.h"
#include "tests/unit/read/mtl_texts.h"
#include "tests/unit/shared.h"

#define ROUGH .25 /* alpha of roughness 0.5 */

/* A material as it was set. Transmission, coat and sheet of glass are known
 * with the extension only. */
struct truth {
    const char *name;
    double color[3], metalness, alpha, opacity;
    double transmission, coat; /* with the extension */
    uint32_t classic_kind, kind;
};

static const struct truth truths[] = {
    {"plain",
     {.8, .3, .1},
     0,
     ROUGH,
     1,
     0,
     0,
     MATERIAL_PLASTIC,
     MATERIAL_PLASTIC},
    {"gold", {1, .7, .2}, 1, .04, 1, 0, 0, MATERIAL_METAL, MATERIAL_METAL},
    {"half",
     {1, .7, .2},
     .5,
     ROUGH,
     1,
     0,
     0,
     MATERIAL_PRINCIPLED,
     MATERIAL_PRINCIPLED},
    {"alpha",
     {.8, .1, .1},
     0,
     ROUGH,
     .3,
     0,
     0,
     MATERIAL_PLASTIC,
     MATERIAL_PLASTIC},
    {"glass", {1, 1, 1}, 0, 0, 1, 1, 0, MATERIAL_PLASTIC, MATERIAL_PRINCIPLED},
    {"glow",
     {.8, .8, .8},
     0,
     ROUGH,
     1,
     0,
     0,
     MATERIAL_PLASTIC,
     MATERIAL_PLASTIC},
    {"coat",
     {.8, .8, .8},
     0,
     ROUGH,
     1,
     0,
     .7,
     MATERIAL_PLASTIC,
     MATERIAL_PRINCIPLED},
    {"sheen",
     {.8, .8, .8},
     0,
     ROUGH,
     1,
     0,
     0,
     MATERIAL_PLASTIC,
     MATERIAL_PRINCIPLED},
    {"aniso",
     {.8, .8, .8},
     1,
     ROUGH,
     1,
     0,
     0,
     MATERIAL_METAL,
     MATERIAL_PRINCIPLED},
};

/* Reads a file of the suite, or skips the test if there is none. Returns its
 * text for free(). */
static char *read_suite(const char *name, size_t *size_bytes)
{
    struct error err;
    char file[64], *path, *text;

    snprintf(file, sizeof file, "suites/blender/%s.mtl", name);
    path = shared_path(file);
    check_or_say(file_read(path, &text, size_bytes, &err), err.text);
    free(path);
    return text;
}

static const struct material *find(const struct loaded *l, const char *name)
{
    uint32_t index = mtl_find(&l->scene, name);

    assert_int_not_equal(index, NO_INDEX);
    return &l->scene.materials[index];
}

static void check_color(struct vec3 c, const double rgb[3])
{
    check_close((double)c.x, rgb[0], 1e-6);
    check_close((double)c.y, rgb[1], 1e-6);
    check_close((double)c.z, rgb[2], 1e-6);
}

/* The specular level is 0.5, which means 4 % in 3.4, whatever Ni is, and the
 * Fresnel reflectance of Ni in 5.0. A clearcoat of 1 in 3.4 reflects as much as
 * a coat of weight .25 in 5.0. */
static void check_truth(const struct loaded *l, const struct truth *t,
                        bool is_extended, bool is_second)
{
    const struct material *m = find(l, t->name);
    double ni = strcmp(t->name, "glass") == 0 ? 1.45 : 1.5;
    double r = (ni - 1) / (ni + 1), f0 = is_second ? r * r : .04;
    double specular[3] = {f0, f0, f0};

    print_message("%s\n", t->name);
    assert_int_equal(m->kind, is_extended ? t->kind : t->classic_kind);
    check_color(m->color, t->color);
    check_close((double)m->metalness, t->metalness, 1e-6);
    check_close((double)m->alpha, t->alpha, 1e-6);
    check_close((double)m->opacity, t->opacity, 1e-6);
    check_close((double)m->transmission, is_extended ? t->transmission : 0,
                1e-6);
    check_close((double)m->coat,
                is_extended ? (is_second ? 1 : 0.25) * t->coat : 0, 1e-6);
    if (m->coat > 0)
        check_close((double)m->coat_alpha, .03 * .03, 1e-6);
    if (m->transmission > 0)
        check_close((double)m->ior, ni, 1e-6);
    if (m->kind != MATERIAL_METAL)
        check_color(m->specular, specular);
}

static void check_suite(const char *name, enum mtl_dialect dialect,
                        const char *version, bool is_extended)
{
    static const double light[3] = {3, 1.5, .6};
    size_t size_bytes;
    char *text = read_suite(name, &size_bytes);
    struct mtl_dialect_found found = mtl_dialect_find(text, size_bytes);
    const struct material *m;
    struct loaded l;

    print_message("%s\n", name);
    assert_int_equal(found.dialect, dialect);
    assert_string_equal(found.version, version);
    load(&l, "a.mtl", text, size_bytes);
    for (size_t i = 0; i < sizeof truths / sizeof truths[0]; i++)
        check_truth(&l, &truths[i], is_extended, dialect == MTL_BLENDER_4);
    check_color(find(&l, "glow")->emission, light);
    m = find(&l, "tex");
    assert_int_equal(m->kind, MATERIAL_PLASTIC);
    assert_string_equal(path_name(l.scene.texture_paths[m->color_texture]),
                        "col.png");
    assert_string_equal(path_name(l.scene.texture_paths[m->alpha_texture]),
                        "rgh.png");
    assert_string_equal(path_name(l.scene.texture_paths[m->bump_texture]),
                        "nrm.png");
    check_close((double)m->alpha, 1, 0);
    if (is_extended) {
        check_close((double)find(&l, "sheen")->sheen.x, .6, 1e-7);
        check_close((double)find(&l, "sheen")->sheen_alpha, .25, 0);
        check_close((double)find(&l, "aniso")->anisotropy, .8, 1e-7);
        check_close((double)find(&l, "aniso")->grain.x, 1, 0);
    }
    assert_int_equal(l.report.entry_count, 0);
    unload(&l);
    free(text);
}

static void suite_has_what_was_set(void **state)
{
    (void)state;
    check_suite("b3_0", MTL_BLENDER_3, "3.4.1", false);
    check_suite("b3_1", MTL_BLENDER_3, "3.4.1", true);
    check_suite("b5_0", MTL_BLENDER_4, "5.0.1", false);
    check_suite("b5_1", MTL_BLENDER_4, "5.0.1", true);
}

/* Without its first two lines, the order of the statements shows the same. */
static void lost_lines_do_not_matter(void **state)
{
    static const struct {
        const char *name;
        enum mtl_dialect dialect;
    } files[] = {{"b3_0", MTL_BLENDER_3},
                 {"b3_1", MTL_BLENDER_3},
                 {"b5_0", MTL_BLENDER_4},
                 {"b5_1", MTL_BLENDER_4}};

    (void)state;
    for (size_t i = 0; i < sizeof files / sizeof files[0]; i++) {
        size_t size_bytes;
        char *text = read_suite(files[i].name, &size_bytes);
        const char *rest = strstr(text, "newmtl");
        struct mtl_dialect_found found =
            mtl_dialect_find(rest, size_bytes - (size_t)(rest - text));

        assert_int_equal(found.dialect, files[i].dialect);
        assert_string_equal(found.version, "");
        free(text);
    }
}

#define BLOCK                                                        \
    "newmtl m\nNs 250.000000\nKa 1.000000 1.000000 1.000000\n"       \
    "Kd 0.800000 0.300000 0.100000\nKs 0.500000 0.500000 0.500000\n" \
    "Ke 0.000000 0.000000 0.000000\nNi 1.500000\nd 1.000000\nillum 2\n"

/* What the exporter of Blender 2.8 to 3.0 writes of gold. */
#define SCRIPT                                                         \
    "# Blender MTL File: 'None'\n# Material Count: 1\n\nnewmtl gold\n" \
    "Ns 639.999995\nKa 1.000000 1.000000 1.000000\n"                   \
    "Kd 1.000000 0.700000 0.200000\nKs 0.500000 0.500000 0.500000\n"   \
    "Ke 0.000000 0.000000 0.000000\nNi 1.450000\nd 1.000000\nillum 3"

static void first_comments_choose_the_dialect(void **state)
{
    static const struct {
        const char *text;
        enum mtl_dialect dialect;
    } cases[] = {
        {"", MTL_CLASSIC},
        {"newmtl m\n", MTL_CLASSIC},
        {"# Blender 3.1.0 MTL File\n", MTL_BLENDER_3},
        {"# Blender 3.6.12 MTL File: 'x.blend'\r\n", MTL_BLENDER_3},
        {"# Blender 4.0.0 MTL File: 'x.blend'\n", MTL_BLENDER_4},
        {"\xef\xbb\xbf# Blender 10.2.0 MTL File\n", MTL_BLENDER_4},
        {"# CC0\n\n# Blender 4.2.0 MTL File: 'x'\nnewmtl m\n", MTL_BLENDER_4},
        {"# Blender 2.93.4 MTL File\n" BLOCK, MTL_CLASSIC},
        {"# Blender MTL File: 'None'\n# Material Count: 1\n" BLOCK,
         MTL_CLASSIC},
        {SCRIPT, MTL_BLENDER_3},
        {SCRIPT "\nKd 1 1 1\n", MTL_CLASSIC},
        {"# Wavefront MTL File\n" BLOCK, MTL_CLASSIC},
        {"newmtl m\n# Blender 4.2.0 MTL File: 'x'\n", MTL_CLASSIC},
        {"# Blender\n", MTL_CLASSIC},
        {"# Blender 4\n", MTL_CLASSIC},
        {"# Blender 4.1", MTL_CLASSIC},
        {"#", MTL_CLASSIC},
        {BLOCK, MTL_BLENDER_4},
        {"# by hand\n" BLOCK "map_Bump -bm 1.000000 n.png\n", MTL_BLENDER_4},
        {BLOCK "Kd 0.500000 0.500000 0.500000\n", MTL_CLASSIC},
        {BLOCK "disp a.png\n", MTL_CLASSIC},
        {BLOCK "map_Kd a.png\nPr 0.500000\n", MTL_CLASSIC},
        {BLOCK "newmtl n\nKd .5 .5 .5\n", MTL_CLASSIC},
        {"Ni 1.500000\n" BLOCK, MTL_CLASSIC},
    };

    (void)state;
    for (size_t i = 0; i < sizeof cases / sizeof cases[0]; i++) {
        const char *text = cases[i].text;

        print_message("%s\n", text);
        assert_int_equal(mtl_dialect_find(text, strlen(text)).dialect,
                         cases[i].dialect);
    }
}

/* Reads one material of a file of this dialect. */
static struct material one(enum mtl_dialect dialect, const char *statements)
{
    char *text =
        xformat("%s\nnewmtl m\n%s\n", mtl_dialect_line(dialect), statements);
    struct material m;
    struct loaded l;

    load(&l, "a.mtl", text, strlen(text));
    m = *find(&l, "m");
    unload(&l);
    free(text);
    return m;
}

/* Cases that the suite does not have, after the source of the exporter. */
static void statements_mean_what_the_exporter_writes(void **state)
{
    struct material m;

    (void)state;
    /* metal of partial opacity; of no specular level */
    m = one(MTL_BLENDER_4, "Ns 250\nKa .75\nKd .5\nKs .5\nd .5\nillum 6");
    assert_int_equal(m.kind, MATERIAL_PRINCIPLED);
    check_close((double)m.metalness, .75, 1e-7);
    check_close((double)m.opacity, .5, 0);
    m = one(MTL_BLENDER_4, "Ns 250\nKa .25\nKd .5\nKs 0\nillum 1");
    check_close((double)m.metalness, .25, 0);
    m = one(MTL_BLENDER_4, "Ns 250\nKa 1\nKd .5\nKs 0\nillum 1");
    assert_int_equal(m.kind, MATERIAL_DIFFUSE);
    /* no specular level, and an index that reflects more than half */
    m = one(MTL_BLENDER_4, "Ns 250\nKa 1\nKd .5\nNi 14\nillum 2");
    assert_true(m.specular.x <= 1);
    m = one(MTL_BLENDER_4, "Ns 250\nKa 1\nKd .5\nKs .5\nNi 14\nillum 2");
    check_close((double)m.specular.x, 13. * 13 / 15 / 15, 1e-6);
    /* a map of metal; roughness at its ends */
    m = one(MTL_BLENDER_3, "Ns 0\nKa 1\nKd .5\nKs .5\nillum 2\nmap_refl m.png");
    assert_int_equal(m.kind, MATERIAL_PRINCIPLED);
    assert_int_equal(m.metal_texture, 0);
    check_close((double)m.alpha, 1, 0);
    check_close((double)one(MTL_BLENDER_3, "Ns 1000\nKs .5").alpha, 0, 0);
    /* the specular level scales the reflectance of Ni from 4.0 on */
    check_close((double)one(MTL_BLENDER_4, "Ks .5\nNi 2").specular.x, 1.0 / 9,
                1e-7);
    check_close((double)one(MTL_BLENDER_4, "Ks 1\nNi 1.5").specular.x, .08,
                1e-7);
    check_close((double)one(MTL_BLENDER_4, "Ks 1\nNi 100").specular.x, 1, 0);
    check_close((double)one(MTL_BLENDER_4, "map_Ks s.png\nNi 2").specular.x,
                2.0 / 9, 1e-7);
    check_close((double)one(MTL_BLENDER_3, "Ks .5\nNi 2").specular.x, .04,
                1e-7);
    /* what people add by hand */
    m = one(MTL_BLENDER_4, "Kd .5\nKs .5\nillum 7\nNi 1.3");
    assert_int_equal(m.kind, MATERIAL_GLASS);
    m = one(MTL_BLENDER_4, "Kd .5\nillum 6");
    assert_int_equal(m.kind, MATERIAL_GLASS);
    m = one(MTL_BLENDER_4, "Kd .5\nd 0\nKs .5\nillum 9");
    check_close((double)m.opacity, 0, 0);
}

/* Rewrites material m of `text` with another roughness and its Ke as it is. */
static char *rough(const char *text)
{
    struct material_values after;
    struct mtl_change change = {.name = "m", .after = &after};
    struct loaded l;
    size_t size_bytes;
    char *got;

    load(&l, "a.mtl", text, strlen(text));
    after = l.scene.material_origins[mtl_find(&l.scene, "m")].source;
    change.before = &l.scene.material_origins[mtl_find(&l.scene, "m")].source;
    after.roughness = number(.3);
    got =
        rewrite(&l.scene, "a.mtl", text, strlen(text), &change, 1, &size_bytes);
    unload(&l);
    return got;
}

/* Glim's statements break the order of Blender's; the line says it then. */
static void saved_files_keep_their_dialect(void **state)
{
    char *got = rough(BLOCK);

    (void)state;
    assert_string_equal(got, "# Blender 5.0.0 MTL File\n" BLOCK "Pr 0.3\n");
    free(got);
    got = rough("# Blender 3.4.1 MTL File\n" BLOCK);
    assert_string_equal(got, "# Blender 3.4.1 MTL File\n" BLOCK "Pr 0.3\n");
    free(got);
    got = rough("newmtl m\nKd 1 1 1\n");
    assert_string_equal(got, "newmtl m\nKd 1 1 1\nPr 0.3\n");
    free(got);
}

/* A classic file whose only foreign statement goes stays classic. */
static void classic_files_stay_classic(void **state)
{
    static const char text[] = BLOCK "Tr 0.000000\n";
    struct material_values after;
    struct mtl_change change = {.name = "m", .after = &after};
    struct loaded l;
    size_t size_bytes;
    char *got;

    (void)state;
    load(&l, "a.mtl", text, strlen(text));
    assert_int_equal(l.report.entry_count, 0);
    after = l.scene.material_origins[1].source;
    change.before = &l.scene.material_origins[1].source;
    after.transparency.line = 0;
    got =
        rewrite(&l.scene, "a.mtl", text, strlen(text), &change, 1, &size_bytes);
    assert_string_equal(got, "# Wavefront MTL File\n" BLOCK);
    free(got);
    unload(&l);
}

/* Maps under Blender's keys are switched off and on in their place. */
static void maps_of_blender_are_switched(void **state)
{
    static const char on[] = "# Blender 5.0.0 MTL File\nnewmtl m\n"
                             "map_Ns r.png\nmap_refl m.png\n";
    static const char off[] = "# Blender 5.0.0 MTL File\nnewmtl m\n"
                              "#map_Ns r.png\n#map_refl m.png\n";
    struct material_values after;
    struct mtl_change change = {.name = "m", .after = &after};
    struct loaded l;
    size_t size_bytes;
    char *got;

    (void)state;
    load(&l, "a.mtl", on, strlen(on));
    after = l.scene.material_origins[1].source;
    change.before = &l.scene.material_origins[1].source;
    after.maps_off = 1u << MTL_MAP_ROUGHNESS | 1u << MTL_MAP_METALNESS;
    got = rewrite(&l.scene, "a.mtl", on, strlen(on), &change, 1, &size_bytes);
    assert_string_equal(got, off);
    free(got);
    unload(&l);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(suite_has_what_was_set),
        cmocka_unit_test(lost_lines_do_not_matter),
        cmocka_unit_test(first_comments_choose_the_dialect),
        cmocka_unit_test(statements_mean_what_the_exporter_writes),
        cmocka_unit_test(saved_files_keep_their_dialect),
        cmocka_unit_test(classic_files_stay_classic),
        cmocka_unit_test(maps_of_blender_are_switched),
    };

    return cmocka_run_group_tests(tests, NULL, NULL);
}
