// SPDX-License-Identifier: MIT
#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

#include "read/mtl.h"
#include "scene/material.h"
#include "tests/unit/files.h"
#include "tests/unit/read/one_material.h"
#include "kernels/energy.h"

static void statements_choose_the_kind(void **state)
{
    static const struct {
        const char *text;
        uint32_t kind;
        double color, alpha, ior;
    } cases[] = {
        {"Kd .5 .5 .5", MATERIAL_DIFFUSE, .5, 0, 1.5},
        {"Kd .5", MATERIAL_DIFFUSE, .5, 0, 1.5},
        {"", MATERIAL_DIFFUSE, .8, 0, 1.5},
        {"Kd .5\nKs 1\nNs 6\nillum 2", MATERIAL_PLASTIC, .5, .5, 1.5},
        {"Kd .5\nKs 0\nNs 6\nillum 2", MATERIAL_DIFFUSE, .5, 0, 1.5},
        {"Kd .5\nKs 1\nPr .5\nNs 6", MATERIAL_PLASTIC, .5, .25, 1.5},
        {"Kd .5\nKs 1\nKd_roughness .7", MATERIAL_PLASTIC, .5, 0, 1.5},
        {"Kd .5\nKd_roughness .7", MATERIAL_ROUGH_DIFFUSE, .5, .7, 1.5},
        {"Kd .5\nKd_roughness .0009", MATERIAL_DIFFUSE, .5, 0, 1.5},
        {"Kd .5\nillum 0", MATERIAL_DIFFUSE, .5, 0, 1.5},
        {"Kd .5\nKs .9\nillum 10", MATERIAL_PLASTIC, .5, 0, 1.5},
        {"Kd 0\nKs .9\nillum 3", MATERIAL_METAL, .9, 0, 1.5},
        {"Kd 0\nKs .9\nNs 1000\nillum 5", MATERIAL_METAL, .9, 0, 1.5},
        {"Kd 0\nKs .9\nNs 0\nillum 5", MATERIAL_METAL, .9, 0, 1.5},
        {"Kd 0\nKs .9\nNs 6\nillum 5", MATERIAL_METAL, .9, .5, 1.5},
        {"Kd .3\nKs 0\nillum 5", MATERIAL_DIFFUSE, .3, 0, 1.5},
        {"Kd .7\nKs .2\nPm 1\nPr .4\nillum 3", MATERIAL_METAL, .7, .16, 1.5},
        {"Kd .7\nPm .5\nPr 1\nNs 1000", MATERIAL_PRINCIPLED, .7, 1, 1.5},
        {"Kd .7\nPm .4\nPr .5\nNi 1.3", MATERIAL_PRINCIPLED, .7, .25, 1.3},
        {"Kd .7\nPm 0\nPr 1", MATERIAL_DIFFUSE, .7, 0, 1.5},
        {"Kd .7\nPc .1\nPcr .5", MATERIAL_PRINCIPLED, .7, 0, 1.5},
        {"Kd .7\nPc 0\nPcr .5", MATERIAL_DIFFUSE, .7, 0, 1.5},
        {"Kd .7\nPr .5\nTf .2\nillum 2", MATERIAL_PRINCIPLED, .7, .25, 1.5},
        {"Kd .7\nPr .5\nTf 0 0 0\nillum 2", MATERIAL_DIFFUSE, .7, 0, 1.5},
        {"Kd .7\naniso .5", MATERIAL_DIFFUSE, .7, 0, 1.5},
        {"Kd .7\nKs .5\naniso .5", MATERIAL_PRINCIPLED, .7, 0, 1.5},
        {"Kd .7\nPs .5", MATERIAL_PRINCIPLED, .7, 0, 1.5},
        {"Kd .7\nKs .5\nNs 6\nTf .2", MATERIAL_PLASTIC, .7, .5, 1.5},
        {"Ks .9\nPr 0\nNs 6\nillum 3", MATERIAL_METAL, .9, 0, 1.5},
        {"Kd 0\nKs 1\nNi 1.3\nillum 7", MATERIAL_GLASS, 1, 0, 1.3},
        {"Kd 0\nTf .1 .1 .1\nNs 200\nNi 2.5\nillum 7", MATERIAL_GLASS, .1,
         0.09950371902099893, 2.5},
        {"Ni 1\nPr .5\nillum 6", MATERIAL_GLASS, 1, .25, 1},
        {"Tf .25\nNi .75\nillum 4", MATERIAL_THIN_GLASS, .25, 0, .75},
        {"Tf .25\nNi 1\nillum 4", MATERIAL_THIN_GLASS, .25, 0, 1},
        /* Maya writes this for an opaque material. */
        {"illum 4\nKd .25\nTf 1 1 1\nNi 1.00", MATERIAL_DIFFUSE, .25, 0, 1.5},
        {"illum 4\nKd .5\nTf 1 1 1\nNi 1\nKs .5\nNs 6", MATERIAL_PLASTIC, .5,
         .5, 1.5},
        /* An untinted sheet of partial opacity, or of Ni 1, is a surface. */
        {"illum 4\nKd .5\nKs .5\nNs 6\nNi 1", MATERIAL_PLASTIC, .5, .5, 1.5},
        {"illum 9\nKd .5\nNi 1", MATERIAL_DIFFUSE, .5, 0, 1.5},
        {"illum 4\nKd .5\nd 0\nNi 1.3", MATERIAL_THIN_GLASS, 1, 0, 1.3},
        {"Ni 1000000\nPr .5\nillum 9", MATERIAL_THIN_GLASS, 1, .25, 1e6},
    };

    (void)state;
    for (size_t i = 0; i < sizeof cases / sizeof cases[0]; i++) {
        struct material m = only_material(cases[i].text, 0);

        if (m.kind != cases[i].kind)
            print_error("%s\n", cases[i].text);
        assert_int_equal(m.kind, cases[i].kind);
        check_color(m.color, cases[i].color, cases[i].color, cases[i].color);
        check_close((double)m.alpha, cases[i].alpha, 1e-7);
        check_close((double)m.ior, cases[i].ior, 1e-6);
        check_color(m.emission, 0, 0, 0);
        check_close((double)m.opacity, 1, 0);
        assert_int_equal(m.color_texture, NO_INDEX);
        assert_int_equal(m.emission_texture, NO_INDEX);
    }
}

static void ks_is_the_coat(void **state)
{
    (void)state;
    check_color(only_material("Kd .5\nKs .5 1 0", 0).specular, .04, .08, 0);
    check_color(only_material("Kd .5\nKs 2 -1 .25", 1).specular, .08, 0, .02);
    check_color(only_material("Kd .5\nKs 1\nillum 3", 0).specular, 0, 0, 0);
}

static void ke_is_the_emission(void **state)
{
    (void)state;
    check_color(only_material("Kd 0 0 0\nKe 17 12 4", 0).emission, 17, 12, 4);
    check_color(only_material("Ke 2", 0).emission, 2, 2, 2);
    assert_true(only_material("Ke 1e38 1e-10 0", 0).emission.x == 1e38f);
    check_color(only_material("Ke -1 3 -0", 1).emission, 0, 3, 0);
    check_color(only_material("Ke inf nan 1e39", 1).emission, 0, 0, 0);
    check_color(only_material("Ke 1 1e400 2", 1).emission, 1, 0, 2);
}

static double luminance(struct vec3 c)
{
    return 0.2126 * (double)c.x + 0.7152 * (double)c.y + 0.0722 * (double)c.z;
}

/* The colours themselves are tested by test_blackbody. */
static void black_bodies_have_their_luminance(void **state)
{
    struct vec3 c = only_material("Kd 0 0 0\nKe_blackbody 2000", 0).emission;

    (void)state;
    check_close(luminance(c), 1, 1e-3);
    assert_true(c.x > c.y && c.y > c.z);
    check_close(luminance(only_material("Ke_blackbody 6500 25", 0).emission),
                25, 0.02);
    check_close(luminance(
                    only_material("Ke 3 3 3\nKe_blackbody 5e3 2", 0).emission),
                2, 2e-3);
    check_color(only_material("Ke_blackbody 5000 2\nKe 3", 0).emission, 3, 3,
                3);
    check_color(only_material("Ke_blackbody 0", 0).emission, 0, 0, 0);
    check_color(only_material("Ke_blackbody 5000 0", 0).emission, 0, 0, 0);
    check_color(only_material("Ke_blackbody -5", 1).emission, 0, 0, 0);
    check_color(only_material("Ke_blackbody nan", 1).emission, 0, 0, 0);
    check_color(only_material("Ke_blackbody 1e30 4", 1).emission, 0, 0, 0);
    check_color(only_material("Ke_blackbody 5000 -1", 1).emission, 0, 0, 0);
}

static void colors_are_clamped(void **state)
{
    (void)state;
    check_color(only_material("Kd 2 -1 .5", 1).color, 1, 0, .5);
    check_color(only_material("Kd nan inf -inf", 1).color, 0, 1, 0);
    check_color(only_material("Ks 1.5 1 1\nillum 3", 1).color, 1, 1, 1);
    check_color(only_material("Tf 1 2 3\nillum 7", 1).color, 1, 1, 1);
    check_color(only_material("Kd 1 0 1", 0).color, 1, 0, 1);
}

static void impossible_values_are_replaced(void **state)
{
    static const char *const iors[] = {"0", "-1", "nan", "inf", "1e7", "1e-7"};

    (void)state;
    for (size_t i = 0; i < sizeof iors / sizeof iors[0]; i++) {
        char text[64];

        snprintf(text, sizeof text, "Ni %s\nillum 7", iors[i]);
        check_close((double)only_material(text, 1).ior, 1.5, 0);
    }
    check_close((double)only_material("Ks 1\nillum 3\nPr 2", 1).alpha, 1, 0);
    check_close((double)only_material("Ks 1\nillum 3\nPr -1", 1).alpha, 0, 0);
    check_close((double)only_material("Ks 1\nillum 3\nPr nan", 1).alpha, 0, 0);
    check_close((double)only_material("Ks 1\nillum 3\nNs -5", 1).alpha, 0, 0);
    check_close((double)only_material("Ks 1\nillum 3\nNs 1e300", 0).alpha, 0,
                0);
    assert_int_equal(only_material("illum 99\nKd .5", 1).kind,
                     MATERIAL_DIFFUSE);
    assert_int_equal(only_material("illum nan\nKd .5", 1).kind,
                     MATERIAL_DIFFUSE);
    assert_int_equal(only_material("illum -1e300\nKd .5", 1).kind,
                     MATERIAL_DIFFUSE);
    assert_int_equal(only_material("Pm nan", 1).kind, MATERIAL_DIFFUSE);
}

static void d_and_tr_are_the_opacity(void **state)
{
    (void)state;
    check_close((double)only_material("d .25", 0).opacity, .25, 0);
    check_close((double)only_material("d -halo .25", 0).opacity, .25, 0);
    check_close((double)only_material("Tr .25", 0).opacity, .75, 0);
    check_close((double)only_material("Tr 1\nd 1", 0).opacity, 1, 0);
    /* MeshLab's opacity; Blender does not read it */
    check_close((double)only_material("Tr 1", 1).opacity, 1, 0);
    check_close((double)only_material("d 0\nTr 1", 1).opacity, 0, 0);
    check_close((double)only_material("d .5\nTr 0", 0).opacity, .5, 0);
    check_close((double)only_material("d 7", 1).opacity, 1, 0);
    check_close((double)only_material("d nan", 1).opacity, 1, 0);
    check_close((double)only_material("d .25\nillum 7", 0).opacity, 1, 0);
    /* an untinted sheet of partial opacity is a surface */
    check_close((double)only_material("d .25\nillum 9", 0).opacity, .25, 0);
    check_close((double)only_material("Tr .75\nillum 4", 0).opacity, .25, 0);
    check_close((double)only_material("d .25\nTf .5\nillum 9", 0).opacity, 1,
                0);
    /* and one of Ni 1 without any colour is reported */
    assert_int_equal(only_material("Ni 1\nillum 4", 1).kind,
                     MATERIAL_THIN_GLASS);
}

static void check_refused(const char *text, const char *message)
{
    struct loaded l = load(text);

    assert_false(l.ok);
    assert_string_equal(l.err.text, message);
    unload(&l);
}

static void malformed_numbers_are_refused(void **state)
{
    (void)state;
    check_refused("newmtl m\nKd 1 x 0\n",
                  "a.mtl:2: found 'x' after Kd, expected a number");
    check_refused("newmtl m\nKd 1 0\n",
                  "a.mtl:2: found the end of the line after Kd, expected 1 or "
                  "3 numbers");
    check_refused("newmtl m\n\nNs\n",
                  "a.mtl:3: found the end of the line after Ns, expected a "
                  "number");
    check_refused("newmtl m\nNi 1,5",
                  "a.mtl:2: found '1,5' after Ni, expected a number");
}

static void names_are_whole_lines(void **state)
{
    struct loaded l = load("# c\r\nnewmtl two  words \r\nKd 1 0 0\r\n"
                           "newmtl b\r\nnewmtl two  words\r\nKd 0 1 0\r\n"
                           "newmtl\r\nKd 0 0 1");

    (void)state;
    assert_true(l.ok);
    assert_int_equal(l.scene.material_count, 3);
    assert_string_equal(l.scene.material_names[0], "");
    assert_string_equal(l.scene.material_names[1], "two  words");
    assert_string_equal(l.scene.material_names[2], "b");
    check_color(l.scene.materials[0].color, .8, .8, .8);
    check_color(l.scene.materials[1].color, 0, 1, 0);
    assert_int_equal(l.report.entry_count, 2);
    assert_string_equal(l.report.entries[0].text,
                        "a.mtl:5: found newmtl 'two  words' again: the later "
                        "one is used");
    assert_int_equal(mtl_find(&l.scene, "c"), NO_INDEX);
    unload(&l);
}

static void unused_statements_are_warned_of(void **state)
{
    struct loaded l = load("Kd 1 1 1\nnewmtl m\nKa x\nKd spectral a.rfl\n"
                           "disp -bm 1 a.png\ndisp b.png\nsharpness 1\n"
                           "map_Kd\n");

    (void)state;
    assert_true(l.ok);
    assert_int_equal(l.report.entry_count, 5);
    assert_string_equal(l.report.entries[0].text,
                        "a.mtl:1: found 'Kd', expected newmtl");
    assert_string_equal(
        l.report.entries[1].text,
        "a.mtl:4: found Kd spectral, expected a colour: ignored");
    assert_string_equal(l.report.entries[2].text,
                        "a.mtl:5: found 'disp', which glim does not use");
    assert_int_equal(l.report.entries[2].count, 2);
    assert_string_equal(l.report.entries[4].text,
                        "a.mtl:8: found map_Kd without a file name: ignored");
    assert_int_equal(l.scene.texture_count, 0);
    unload(&l);
}

/* Compares the file name that remains after the options of a map statement. */
static void map_options_are_not_part_of_the_name(void **state)
{
    static const struct {
        const char *text, *path;
        bool has_unknown;
        float scale[2], offset[2];
        bool is_clamped;
    } cases[] = {
        {"map_Kd a.png", "a.png", false, {1, 1}, {0, 0}, 0},
        {"map_Kd  a b  c.png ", "a b  c.png", false, {1, 1}, {0, 0}, 0},
        {"map_Kd -s 2 3 4 a.png", "a.png", false, {2, 3}, {0, 0}, 0},
        {"map_Kd -s 2 a.png", "a.png", false, {2, 1}, {0, 0}, 0},
        {"map_Kd -o 0.25 .5 3d.png", "3d.png", false, {1, 1}, {.25f, .5f}, 0},
        {"map_Kd -o inf 0 -s 1e39 1 a.png", "a.png", false, {1, 1}, {0, 0}, 0},
        {"map_Kd -clamp on -bm 1.5 -blendu off -mm 0 1 a b.png",
         "a b.png",
         true,
         {1, 1},
         {0, 0},
         1},
        {"map_Kd -type cube_top -texres 512 -imfchan r -t 1 1 1 a.png",
         "a.png",
         true,
         {1, 1},
         {0, 0},
         0},
        {"map_Kd a b.png -s 2 -2 1 -clamp on -o -1",
         "a b.png",
         false,
         {2, -2},
         {-1, 0},
         1},
        {"map_Kd -clamp off a -b.png", "a -b.png", false, {1, 1}, {0, 0}, 0},
        {"map_Kd -colorspace sRGB a b.png", "a b.png", true, {1, 1}, {0, 0}, 0},
        {"map_Kd -colorspace sRGB -s 2 2 1 -x y -flag -o 1 a.png -bm 2",
         "a.png",
         true,
         {2, 2},
         {1, 0},
         0},
        {"map_Kd -flag a.png", "a.png", true, {1, 1}, {0, 0}, 0},
        {"map_Kd -name", "-name", false, {1, 1}, {0, 0}, 0},
        {"map_Kd -a.png b.png", "-a.png b.png", false, {1, 1}, {0, 0}, 0},
        {"map_Kd -.png", "-.png", false, {1, 1}, {0, 0}, 0},
        {"map_Kd t/a.png", "t/a.png", false, {1, 1}, {0, 0}, 0},
        {"map_Kd /t/a.png", "/t/a.png", false, {1, 1}, {0, 0}, 0},
    };

    (void)state;
    for (size_t i = 0; i < sizeof cases / sizeof cases[0]; i++) {
        char text[256];
        struct loaded l;
        const struct texture *t;

        snprintf(text, sizeof text, "newmtl m\n%s\n", cases[i].text);
        l = load(text);
        assert_true(l.ok);
        assert_int_equal(l.scene.texture_count, 1);
        assert_string_equal(l.scene.texture_paths[0], cases[i].path);
        assert_int_equal(l.report.entry_count, cases[i].has_unknown);
        t = &l.scene.textures[0];
        check_close((double)t->scale.x, (double)cases[i].scale[0], 0);
        check_close((double)t->scale.y, (double)cases[i].scale[1], 0);
        check_close((double)t->offset.x, (double)cases[i].offset[0], 0);
        check_close((double)t->offset.y, (double)cases[i].offset[1], 0);
        assert_int_equal(t->flags, cases[i].is_clamped ? TEXTURE_CLAMP : 0);
        assert_int_equal(t->is_data, 0);
        unload(&l);
    }
}

/* Maps whose scales differ in the last bit are different textures. */
static void maps_of_other_scales_are_not_shared(void **state)
{
    struct loaded l = load("newmtl a\nmap_Kd -s 1.0000001 1 t.png\n"
                           "newmtl b\nmap_Kd t.png\n");

    (void)state;
    assert_true(l.ok);
    assert_int_equal(l.scene.texture_count, 2);
    unload(&l);
}

static void equal_maps_are_shared(void **state)
{
    struct loaded l =
        load("newmtl a\nmap_Kd t.png\nmap_Ke t.png\nnewmtl b\nmap_Kd u.png\n"
             "newmtl c\nmap_Kd t.png\nillum 7\n"
             "newmtl d\nmap_Kd u.png\nillum 3\nKs 1 1 1\nmap_Ks t.png\n"
             "newmtl e\nmap_Kd u.png\nmap_Ks t.png\n"
             "newmtl f\nillum 5\nmap_Ks u.png\n");
    const struct material *m = l.scene.materials;

    (void)state;
    assert_true(l.ok);
    assert_int_equal(l.scene.texture_count, 2);
    assert_int_equal(m[1].color_texture, 0);
    assert_int_equal(m[1].emission_texture, 0);
    assert_int_equal(m[2].color_texture, 1);
    assert_int_equal(m[3].kind, MATERIAL_GLASS);
    assert_int_equal(m[3].color_texture, 0);
    assert_int_equal(m[4].kind, MATERIAL_METAL);
    assert_int_equal(m[4].color_texture, 0);
    assert_int_equal(m[5].kind, MATERIAL_PLASTIC);
    assert_int_equal(m[5].color_texture, 1);
    assert_int_equal(m[5].specular_texture, 0);
    assert_int_equal(m[6].kind, MATERIAL_METAL);
    assert_int_equal(m[6].color_texture, 1);
    assert_int_equal(l.report.entry_count, 1);
    assert_int_equal(l.report.entries[0].count, 1);
    unload(&l);
}

static void statements_weigh_the_lobes(void **state)
{
    struct material m =
        only_material("Kd .7\nKs .5\nPr .5\nPm .25\nTf .2 .3 .4\n"
                      "Pc .7\nPcr .5\nNi 1.4",
                      0);

    (void)state;
    check_close((double)m.metalness, .25, 0);
    check_close((double)m.transmission, .3, 1e-7);
    check_close((double)m.coat, .7, 1e-7);
    check_close((double)m.coat_alpha, .25, 0);
    check_color(m.specular, .04, .04, .04);
    m = only_material("Ks .9\nillum 3\nPc 1", 0); /* a coated mirror */
    assert_int_equal(m.kind, MATERIAL_PRINCIPLED);
    check_close((double)m.metalness, 1, 0);
    check_color(m.color, .9, .9, .9);
    m = only_material("Pm 7\nPc -1", 1);
    assert_int_equal(m.kind, MATERIAL_METAL);
}

static void sheen_has_the_roughness_of_the_file(void **state)
{
    (void)state;
    check_close((double)only_material("Ps .5", 0).sheen_alpha, .25, 0);
    check_close((double)only_material("Ps .5\nPs_roughness .8", 0).sheen_alpha,
                .64, 1e-7);
    check_close((double)only_material("Ps .5\nPs_roughness 0", 0).sheen_alpha,
                (double)SHEEN_ALPHA_MIN, 0);
    check_close((double)only_material("Ps .5\nPs_roughness 2", 1).sheen_alpha,
                1, 0);
    assert_int_equal(only_material("Kd .5\nPs_roughness .8", 0).kind,
                     MATERIAL_DIFFUSE);
}

static void films_are_on_surfaces_that_reflect(void **state)
{
    struct material m = only_material("Pm 1\nPf .5", 0);

    (void)state;
    assert_int_equal(m.kind, MATERIAL_PRINCIPLED);
    check_close((double)m.film, .5, 0);
    check_close((double)m.film_ior, 1.3, 1e-7);
    check_close((double)m.film_thickness, 400, 0);
    m = only_material("Ks .5\nPf 1\nPf_ior 1.8\nPf_thickness 250", 0);
    check_close((double)m.film_ior, 1.8, 1e-7);
    check_close((double)m.film_thickness, 250, 0);
    assert_int_equal(only_material("Ks .5\nPf 1\nPf_thickness 0", 0).kind,
                     MATERIAL_PLASTIC);
    assert_int_equal(only_material("Kd .5\nPf 1", 0).kind, MATERIAL_DIFFUSE);
    assert_int_equal(only_material("Pm 1\nPf 0", 0).kind, MATERIAL_METAL);
    m = only_material("Pm 1\nPf 7\nPf_ior .5\nPf_thickness 1e9", 1);
    check_close((double)m.film, 1, 0);
    check_close((double)m.film_ior, 1.3, 1e-7);
    check_close((double)m.film_thickness, 400, 0);
}

static double dispersion_of(const char *text, int warnings)
{
    return (double)only_material(text, warnings).dispersion;
}

/* (Ni - 1) / V, of glass only. */
static void abbe_numbers_disperse_glass(void **state)
{
    (void)state;
    check_close(dispersion_of("Ni 1.6\nNi_abbe 20\nillum 7", 0), .03, 1e-8);
    check_close(dispersion_of("Ni_abbe 50\nTf .5\nillum 4", 0), .01, 1e-8);
    check_close(dispersion_of("Kd .7\nPr .5\nTf .4 .4 .4\nNi 1.8\nNi_abbe 40",
                              0),
                .02, 1e-8);
    check_close(dispersion_of("Ni 1.6\nillum 7", 0), 0, 0);
    check_close(dispersion_of("Ni 1.6\nNi_abbe 0\nillum 7", 0), 0, 0);
    check_close(dispersion_of("Ni 1.6\nNi_abbe -5\nillum 7", 1), 0, 0);
    check_close(dispersion_of("Ni 1.6\nNi_abbe nan\nillum 7", 1), 0, 0);
    check_close(dispersion_of("Ni .7\nNi_abbe 20\nillum 7", 0), 0, 0);
    check_close(dispersion_of("Kd .5\nPc 1\nNi_abbe 20", 0), 0, 0);
    check_close(dispersion_of("Ni 1e6\nNi_abbe 1e-300\nillum 7", 0), 1e6, 0);
}

/* Td is all of the light unless a weight says otherwise, and white if absent.
 */
static void leaves_let_light_through(void **state)
{
    struct material m = only_material("Kd .5\nTd .9 .6 .3", 0);

    (void)state;
    assert_int_equal(m.kind, MATERIAL_DIFFUSE);
    check_close((double)m.translucency, 1, 0);
    check_color(m.back_color, .9, .6, .3);
    m = only_material("Kd .5\nKs .5\nTd .9\nTd_weight .25", 0);
    assert_int_equal(m.kind, MATERIAL_PLASTIC);
    check_close((double)m.translucency, .25, 0);
    m = only_material("Pm .5\nTd_weight .5", 0);
    assert_int_equal(m.kind, MATERIAL_PRINCIPLED);
    check_color(m.back_color, 1, 1, 1);
    m = only_material("Kd_roughness .5\nTd .5\nTd_weight 0", 0);
    check_close((double)m.translucency, 0, 0);
    assert_int_equal(material_features(&m, NULL) & FEATURE_TRANSLUCENT, 0);
    m = only_material("Kd_roughness .5\nTd 2 .5 -1\nTd_weight 7", 2);
    check_close((double)m.translucency, 1, 0);
    check_color(m.back_color, 1, .5, 0);
    assert_int_not_equal(material_features(&m, NULL) & FEATURE_TRANSLUCENT, 0);
    check_close((double)only_material("Td_weight nan", 1).translucency, 0, 0);
    /* metal and glass have no diffuse part */
    m = only_material("Pm 1\nTd .5", 1);
    check_close((double)m.translucency, 0, 0);
    m = only_material("illum 7\nTd_weight .5", 1);
    check_close((double)m.translucency, 0, 0);
    only_material("Pm 1\nTd .5\nTd_weight 0", 0);
}

static void maps_of_leaves_imply_their_factors(void **state)
{
    struct loaded l = load("newmtl a\nmap_Td c.png\n"
                           "newmtl b\nmap_Td_weight w.png\nTd .5\n"
                           "newmtl c\nmap_Td c.png\nTd_weight 0\n");
    const struct material *m = l.scene.materials;

    (void)state;
    assert_true(l.ok);
    assert_int_equal(m[1].back_texture, 0);
    check_close((double)m[1].translucency, 1, 0);
    check_color(m[1].back_color, 1, 1, 1);
    assert_int_equal(l.scene.textures[0].is_data, 0);
    assert_int_equal(m[2].translucency_texture, 1);
    check_close((double)m[2].translucency, 1, 0);
    assert_int_equal(l.scene.textures[1].is_data, 1);
    assert_int_equal(m[3].back_texture, NO_INDEX);
    assert_int_equal(l.report.entry_count, 1);
    unload(&l);
}

/* Absorption per unit of length of the file. */
static void solids_absorb_their_colour(void **state)
{
    const double d = 2.5;
    struct material m =
        only_material("Tf .5 .25 1\nTf_distance 2.5\nillum 7", 0);

    (void)state;
    check_color(m.color, 1, 1, 1);
    check_color(m.medium.extinction, log(2.0) / d, log(4.0) / d, 0);
    m = only_material("Kd .7\nKs .5\nPr .5\nTf .4 .2 .1\nTf_distance 2.5", 0);
    check_close((double)m.transmission, .4, 1e-7);
    check_color(m.color, .7, .7, .7);
    check_color(m.medium.extinction, 0, log(2.0) / d, log(4.0) / d);
    m = only_material("Tf 0 1 1\nTf_distance 1e-30\nillum 7", 0);
    assert_true(m.medium.extinction.x >= 1e30f &&
                isfinite(m.medium.extinction.x));
    m = only_material("Tf .5\nTf_distance 0\nillum 7", 0);
    check_color(m.color, .5, .5, .5);
    check_color(m.medium.extinction, 0, 0, 0);
    m = only_material("Tf .5\nTf_distance -1\nillum 7", 1);
    check_color(m.color, .5, .5, .5);
    m = only_material("Tf .5\nTf_distance 2\nillum 4", 1);
    check_color(m.medium.extinction, 0, 0, 0);
    only_material("Kd .5\nTf_distance 2", 1);
}

/* Sf is the weight of light below the diffuse part of a surface, Sr its mean
 * free path. */
static void surfaces_have_light_below(void **state)
{
    static const struct {
        const char *text;
        double subsurface;
        int warnings;
    } cases[] = {
        {"Kd .7\nSr 1 1 1", 0, 0},
        {"Kd .7\nSf 1", 0, 1},
        {"Kd .7\nSf 1\nSr 0 0 0", 0, 1},
        {"Pm 1\nSf 1\nSr 1 1 1", 0, 1},
        {"illum 7\nSf 1\nSr 1 1 1", 0, 1},
        {"Pm .5\nSf 1\nSr 1 1 1", 1, 0},
        {"Pm 1\nPc 1\nSf 1\nSr 1 1 1", 0, 1},
        {"Tf .5\nPr .2\nSf 1\nSr 1 1 1", 1, 0},
        {"Tf 1 1 1\nPr .2\nSf 1\nSr 1 1 1", 0, 1},
        {"Tf .5\nPr .2\nTf_scatter 1\nSf 1\nSr 1 1 1", 0, 1},
    };
    struct material m = only_material("Kd .7\nSf .5\nSr .1 .2 .4\nSg -.5", 0);

    (void)state;
    assert_int_equal(m.kind, MATERIAL_DIFFUSE);
    assert_int_equal(m.role, ROLE_NONE); /* light paths leave it out */
    check_close((double)m.subsurface, .5, 0);
    check_color(m.medium.extinction, 10, 5, 2.5);
    check_close((double)m.medium.anisotropy, -.5, 0);
    m = only_material("Kd .7\nKs .5\nSf 1\nSr 1 0 1e-38", 0);
    assert_int_equal(m.kind, MATERIAL_PLASTIC);
    check_color(m.medium.extinction, 1, (double)1e30f, (double)1e30f);
    assert_true(material_features(&m, NULL) & FEATURE_SUBSURFACE);
    assert_false(material_features(&m, NULL) & FEATURE_ATTENUATION);
    for (size_t i = 0; i < sizeof cases / sizeof cases[0]; i++)
        check_close(
            (double)only_material(cases[i].text, cases[i].warnings).subsurface,
            cases[i].subsurface, 0);
    assert_true(only_material("Kd .7\nSf 7\nSr 1 1 1", 1).subsurface == 1);
    assert_true(
        only_material("Kd .7\nSf 1\nSr 1 1 1\nSg 2", 1).medium.anisotropy == 0);
}

static void sheets_are_rough_if_the_file_says_so(void **state)
{
    struct material m = only_material("Tf .5\nNs 20\nillum 4", 0);

    (void)state;
    check_close((double)m.alpha, 0, 0);
    m = only_material("Tf .5\nPr .5\nillum 4", 0);
    assert_int_equal(m.kind, MATERIAL_THIN_GLASS);
    check_close((double)m.alpha, .25, 0);
    m = only_material("Kd .7\nKs .5\nPr .5\nTf .4 .2 0\nTf_thin 1", 0);
    assert_int_equal(m.kind, MATERIAL_PRINCIPLED);
    assert_int_equal(m.is_thin, 1);
    check_close((double)m.transmission, .2, 1e-7);
    m = only_material("Kd .7\nPr .5\nTf .4\nTf_thin 1\nTf_distance 1", 1);
    check_color(m.medium.extinction, 0, 0, 0);
    assert_int_equal(only_material("Kd .7\nTf_thin 1", 0).is_thin, 0);
    only_material("Kd .7\nPr .5\nTf .4\nTf_thin 7", 1);
}

/* A lost map takes its layer with it; maps that nothing uses are named. */
static void maps_weigh_the_layers(void **state)
{
    struct loaded l = load("newmtl a\nmap_Pc c.png\nmap_Pcr r.png\n"
                           "newmtl b\nmap_Ps s.png\nPs .5\n"
                           "newmtl c\nPr .5\nmap_Tf t.png\n"
                           "newmtl d\nmap_Tf t.png\nmap_Pcr r.png\n");
    const struct material *m = l.scene.materials;

    (void)state;
    assert_true(l.ok);
    for (int i = 1; i <= 3; i++)
        assert_int_equal(m[i].kind, MATERIAL_PRINCIPLED);
    assert_int_equal(m[1].coat_texture, 0);
    assert_int_equal(m[1].coat_alpha_texture, 1);
    check_close((double)m[1].coat, 1, 0);
    check_close((double)m[1].coat_alpha, 1, 0);
    assert_int_equal(m[2].sheen_texture, 2);
    check_close((double)m[2].sheen.x, .5, 0);
    assert_int_equal(m[3].transmission_texture, 3);
    check_close((double)m[3].transmission, 1, 0);
    assert_int_equal(l.scene.textures[3].is_data, 1);
    assert_int_equal(m[4].kind, MATERIAL_DIFFUSE);
    assert_int_equal(m[4].transmission_texture, NO_INDEX);
    assert_int_equal(l.report.entry_count, 1);
    assert_int_equal(l.report.entries[0].count, 2);
    unload(&l);
}

static void maps_of_numbers_are_data(void **state)
{
    struct loaded l =
        load("newmtl a\nmap_Pr r.png\nKs 1\nmap_d r.png\nmap_Kd r.png\n"
             "newmtl b\nmap_Pr -s 2 2 r.png\nPr .5\nillum 7\n"
             "newmtl c\nmap_Pm m.png\nPr .5\nKd 1 0 0\n"
             "newmtl d\nmap_Pm m.png\nPm .75\nKs 1\nPr .5\nillum 3\n"
             "newmtl e\nmap_Pr r.png\nnewmtl f\nmap_d r.png\nillum 7\n");
    const struct material *m = l.scene.materials;

    (void)state;
    assert_true(l.ok);
    assert_int_equal(l.scene.texture_count, 5);
    assert_int_equal(l.scene.textures[0].is_data, 1);
    assert_int_equal(l.scene.textures[1].is_data, 1);
    assert_int_equal(l.scene.textures[2].is_data, 0);
    assert_int_equal(m[1].alpha_texture, 0);
    assert_int_equal(m[1].opacity_texture, 1); /* its alpha, if it has some */
    assert_int_equal(m[1].color_texture, 2);
    check_close((double)m[1].alpha, 1, 0);
    assert_int_equal(m[2].alpha_texture, 3);
    check_close((double)m[2].alpha, .25, 0);
    assert_int_equal(m[3].kind, MATERIAL_PRINCIPLED);
    assert_int_equal(m[3].metal_texture, 4);
    check_close((double)m[3].metalness, 1, 0);
    check_close((double)m[3].alpha, .25, 0);
    check_close((double)m[4].metalness, .75, 0);
    assert_int_equal(m[1].bump_texture, NO_INDEX);
    /* A diffuse material has no roughness, glass no coverage. */
    assert_int_equal(m[5].alpha_texture, NO_INDEX);
    assert_int_equal(m[6].opacity_texture, NO_INDEX);
    assert_int_equal(l.report.entry_count, 1);
    assert_int_equal(l.report.entries[0].count, 2);
    unload(&l);
}

static void bump_maps_have_their_scale(void **state)
{
    static const char *const keys[] = {"bump", "map_bump", "map_Bump"};
    struct material m;

    (void)state;
    for (size_t i = 0; i < 3; i++) {
        char text[64];

        snprintf(text, sizeof text, "%s -bm .5 h.png", keys[i]);
        m = only_material(text, 0);
        assert_int_equal(m.bump_texture, 0);
        check_close((double)m.bump_scale, .5, 0);
    }
    check_close((double)only_material("bump h.png", 0).bump_scale, 1, 0);
    check_close((double)only_material("bump h.png -bm -2", 0).bump_scale, -2,
                0);
    check_close((double)only_material("bump -bm inf h.png", 0).bump_scale, 1,
                0);
    m = only_material("norm n.png\nillum 7", 0);
    assert_int_equal(m.normal_texture, 0);
    assert_int_equal(m.bump_texture, NO_INDEX);
}

/* Every path of another machine that can mean a file here finds it. */
static void paths_of_other_machines_find_the_file(void **state)
{
    static const char *const names[] = {"sub/wood a.png",
                                        "sub\\wood a.png",
                                        "sub/wood\\ a.png",
                                        "C:\\models\\wood a.png",
                                        "/home/x/wood a.png",
                                        "\"sub/wood a.png\"",
                                        "-s 2 2 \"wood a.png\" -bm 1",
                                        "\"C:\\models\\Wood A.png\""};
    (void)state;
    assert_int_equal(mkdir("sub", 0700), 0);
    put("sub/wood a.png", "");
    put("wood a.png", "");
    for (size_t i = 0; i < sizeof names / sizeof names[0]; i++) {
        char text[256];
        struct loaded l;

        snprintf(text, sizeof text, "newmtl m\nmap_Kd %s\n", names[i]);
        l = load(text);
        assert_true(l.ok);
        assert_int_equal(access(l.scene.texture_paths[0], R_OK), 0);
        unload(&l);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(statements_choose_the_kind),
        cmocka_unit_test(ks_is_the_coat),
        cmocka_unit_test(ke_is_the_emission),
        cmocka_unit_test(black_bodies_have_their_luminance),
        cmocka_unit_test(colors_are_clamped),
        cmocka_unit_test(impossible_values_are_replaced),
        cmocka_unit_test(d_and_tr_are_the_opacity),
        cmocka_unit_test(malformed_numbers_are_refused),
        cmocka_unit_test(names_are_whole_lines),
        cmocka_unit_test(unused_statements_are_warned_of),
        cmocka_unit_test(map_options_are_not_part_of_the_name),
        cmocka_unit_test(equal_maps_are_shared),
        cmocka_unit_test(maps_of_other_scales_are_not_shared),
        cmocka_unit_test(statements_weigh_the_lobes),
        cmocka_unit_test(sheen_has_the_roughness_of_the_file),
        cmocka_unit_test(films_are_on_surfaces_that_reflect),
        cmocka_unit_test(abbe_numbers_disperse_glass),
        cmocka_unit_test(leaves_let_light_through),
        cmocka_unit_test(maps_of_leaves_imply_their_factors),
        cmocka_unit_test(solids_absorb_their_colour),
        cmocka_unit_test(surfaces_have_light_below),
        cmocka_unit_test(sheets_are_rough_if_the_file_says_so),
        cmocka_unit_test(maps_weigh_the_layers),
        cmocka_unit_test(maps_of_numbers_are_data),
        cmocka_unit_test(bump_maps_have_their_scale),
        cmocka_unit_test_setup_teardown(paths_of_other_machines_find_the_file,
                                        enter_folder, remove_folder),
    };

    return cmocka_run_group_tests(tests, NULL, NULL);
}
