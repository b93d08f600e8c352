// SPDX-License-Identifier: MIT
/*
 * test_mtl_save.c - the exact texts after changes of materials: only statements
 * that were changed differ
 */
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

#include "base/file.h"
#include "terminal/xmalloc.h"
#include "tests/unit/folder.h"
#include "tests/unit/kinds.h"
#include "tests/unit/read/mtl_texts.h"

static void redden(struct material_values *s)
{
    s->base_color = color(1, .5, .25);
}

static void roughen(struct material_values *s)
{
    s->roughness = number(.5);
}

static void fade(struct material_values *s)
{
    s->opacity = number(.25);
}

static void shine(struct material_values *s)
{
    s->kelvin.line = s->luminance.line = 0;
    s->emission = color(1, 2, 3);
}

static void glow(struct material_values *s)
{
    s->kelvin = number(3000);
    s->luminance = number(5);
}

static void darken(struct material_values *s)
{
    s->kelvin.line = s->luminance.line = s->emission.line = 0;
}

static void switch_map(struct material_values *s)
{
    s->maps_off ^= 1u << MTL_MAP_COLOR;
}

static void switch_bumps(struct material_values *s)
{
    s->maps_off ^= 1u << MTL_MAP_BUMP;
}

static void absorb(struct material_values *s)
{
    s->attenuation_distance = number(2.5);
    s->abbe = number(22);
    s->thinness = number(0);
    s->maps_off ^= 1u << MTL_MAP_COAT;
}

static void scatter(struct material_values *s)
{
    s->medium_scatter = (struct mtl_color){{0.5, 1e-30, 1e30}, 1};
    s->medium_absorb.line = 0;
    s->medium_anisotropy = number(-0.25);
}

static void layer(struct material_values *s)
{
    s->sheen_roughness = number(0.25);
    s->film = number(1);
    s->film_ior = number(1.5);
    s->film_thickness = number(300);
    s->cutoff = number(0.5);
}

static void shine_through(struct material_values *s)
{
    s->back_color = (struct mtl_color){{0.5, 0.75, 0.25}, 1};
    s->translucency = number(0.5);
    s->maps_off ^= 1u << MTL_MAP_BACK_COLOR;
}

static void keep(struct material_values *s)
{
    (void)s;
}

static void only_changed_statements_are_written(void **state)
{
    static const struct {
        const char *text;
        void (*edit)(struct material_values *);
        const char *want;
    } cases[] = {
        {"newmtl m\nKd 0 0 0\n", redden, "newmtl m\nKd 1 0.5 0.25\n"},
        {"newmtl m\nKd 0 0 0", redden, "newmtl m\nKd 1 0.5 0.25"},
        {"newmtl m", redden, "newmtl m\nKd 1 0.5 0.25"},
        {"# a\r\nnewmtl m\r\n\tKd\t 0 0 0\t # red \r\nfoo bar\r\n", redden,
         "# a\r\nnewmtl m\r\n\tKd\t 1 0.5 0.25\t # red \r\nfoo bar\r\n"},
        {"newmtl m\r\n\tNs 4\r\n\r\n# for n\r\nnewmtl n\r\nKd 0\r\n", redden,
         "newmtl m\r\n\tNs 4\r\n\tKd 1 0.5 0.25\r\n\r\n# for n\r\n"
         "newmtl n\r\nKd 0\r\n"},
        {"newmtl m\rKd 0\rnewmtl n\rKd 0\r", redden,
         "newmtl m\rKd 1 0.5 0.25\rnewmtl n\rKd 0\r"},
        {"newmtl m\nKd 0 \\\n 0 \\\n 0 # x\nNi 1\n", redden,
         "newmtl m\nKd 1 0.5 0.25 # x\nNi 1\n"},
        /* Only the statement that counts is changed. */
        {"newmtl m\nKd 0\nKd .1\n", redden, "newmtl m\nKd 0\nKd 1 0.5 0.25\n"},
        {"newmtl m\nKd 0\nnewmtl n\nKd 0\nnewmtl m\nKd .1\nKa 1\n", redden,
         "newmtl m\nKd 0\nnewmtl n\nKd 0\nnewmtl m\nKd 1 0.5 0.25\nKa 1\n"},
        {"newmtl m \nKd spectral a.rfl 1\n", redden,
         "newmtl m \nKd 1 0.5 0.25\n"},
        {"\xef\xbb\xbfnewmtl m\nKd 0\n", redden,
         "\xef\xbb\xbfnewmtl m\nKd 1 0.5 0.25\n"},
        {"newmtl a b\nKd 0\nnewmtl m\nKa 0 # C:\\x\\\nPs 1\n", redden,
         "newmtl a b\nKd 0\nnewmtl m\nKa 0 # C:\\x\\\nPs 1\nKd 1 0.5 0.25\n"},
        {"newmtl m\nNs 30\n", roughen, "newmtl m\nNs 30\nPr 0.5\n"},
        {"newmtl m\nTf_thin 1\nmap_Pc a.png\n", absorb,
         "newmtl m\nTf_thin 0\n#map_Pc a.png\nNi_abbe 22\nTf_distance 2.5\n"},
        {"newmtl m\nillum 7\nTf_absorb 1 2 3 # red\nTf_scatter 1 # milk\n",
         scatter,
         "newmtl m\nillum 7\n # red\nTf_scatter 0.5 1e-30 1e+30 # milk\n"
         "Tf_anisotropy -0.25\n"},
        {"newmtl m\nillum 7\nTf_multiscatter .9\nTf_albedo .8\n"
         "Tf_distance 2\n",
         scatter,
         "newmtl m\nillum 7\nTf_multiscatter .9\nTf_albedo .8\n"
         "Tf_distance 2\nTf_scatter 0.5 1e-30 1e+30\nTf_anisotropy -0.25\n"},
        {"newmtl m\nPs 1\nPf 0\n", layer,
         "newmtl m\nPs 1\nPf 1\nPs_roughness 0.25\nPf_ior 1.5\n"
         "Pf_thickness 300\nd_cutoff 0.5\n"},
        {"newmtl m\nTd_weight .25 # leaf\nmap_Td a.png\n", shine_through,
         "newmtl m\nTd_weight 0.5 # leaf\n#map_Td a.png\nTd 0.5 0.75 0.25\n"},
        {"newmtl m\nd -halo 0.5\n", fade, "newmtl m\nd -halo 0.25\n"},
        {"newmtl m\nTr 0.5\n", fade, "newmtl m\nTr 0.5\nd 0.25\n"},
        /* Either statement gives light. */
        {"newmtl m\nKe_blackbody 2000 # warm\n", shine,
         "newmtl m\nKe 1 2 3 # warm\n"},
        {"newmtl m\nKe 1 1 1\n", glow, "newmtl m\nKe_blackbody 3000 5\n"},
        {"newmtl m\nKe 9\nKe_blackbody 2000\n", glow,
         "newmtl m\nKe 9\nKe_blackbody 3000 5\n"},
        {"newmtl m\nKe 9 # was\nNi 1\nKe_blackbody 2000\n", darken,
         "newmtl m\n # was\nNi 1\n"},
        /* Maps become comments. A name may contain '#'. */
        {"newmtl m\n map_Kd -s 2 2 2 a b#.png \r\nNi 1\n", switch_map,
         "newmtl m\n #map_Kd -s 2 2 2 a b#.png\r\nNi 1\n"},
        {"newmtl m\nmap_Kd \\\n a.png\nNi 1\n", switch_map,
         "newmtl m\n#map_Kd a.png\nNi 1\n"},
        {"newmtl m\nbump a.png\nmap_Bump -bm 2 a.png\n", switch_bumps,
         "newmtl m\n#bump a.png\n#map_Bump -bm 2 a.png\n"},
        {"newmtl m\nKd 0 0 0\n", keep, "newmtl m\nKd 0 0 0\n"},
    };

    (void)state;
    for (size_t i = 0; i < sizeof cases / sizeof cases[0]; i++) {
        const char *text = cases[i].text;
        struct loaded l;
        struct material_values after;
        struct mtl_change change;
        size_t size_bytes;
        uint32_t m;
        char *got;

        load(&l, "a.mtl", text, strlen(text));
        m = mtl_find(&l.scene, "m");
        assert_int_not_equal(m, NO_INDEX);
        after = l.scene.material_origins[m].source;
        cases[i].edit(&after);
        change =
            (struct mtl_change){"m", NULL, &l.scene.material_origins[m].source,
                                &after};
        got = rewrite(&l.scene, "a.mtl", text, strlen(text), &change, 1,
                      &size_bytes);
        assert_string_equal(got, cases[i].want);
        free(got);
        unload(&l);
    }
}

/* When a map is switched off and on again, its comment becomes the statement
 * that it was. The comment beside it, which names another file, stays. */
static void maps_switched_on_again_are_as_before(void **state)
{
    static const char text[] = "newmtl m\nmap_Kd -s 2 2 2 a.png\nNi 1\n"
                               "#map_Kd old.png\n# map_Kd a.png\n";
    struct material_values off;
    struct mtl_change change;
    struct loaded l;
    size_t size_bytes, back_bytes;
    char *path = xformat("%s/a.mtl", folder);
    char *image = xformat("%s/a.png", folder);
    char *old = xformat("%s/old.png", folder);
    char *got, *back;
    struct error err;

    (void)state;
    assert_true(file_write(image, "", 0, false, NULL, &err));
    assert_true(file_write(old, "", 0, false, NULL, &err));
    load(&l, path, text, strlen(text));
    off = l.scene.material_origins[1].source;
    switch_map(&off);
    change = (struct mtl_change){"m", NULL, &l.scene.material_origins[1].source,
                                 &off};
    got = rewrite(&l.scene, path, text, strlen(text), &change, 1, &size_bytes);
    assert_memory_equal(got, "newmtl m\n#map_Kd -s 2 2 2 a.png\n", 32);
    change.before = &off;
    change.after = &l.scene.material_origins[1].source;
    back = rewrite(&l.scene, path, got, size_bytes, &change, 1, &back_bytes);
    assert_int_equal(back_bytes, strlen(text));
    assert_memory_equal(back, text, back_bytes);
    free(back);
    free(got);
    /* Without its comment the map is written as a new statement, with its
     * options. */
    got = rewrite(&l.scene, path, "newmtl m\nNi 1\n", 14, &change, 1,
                  &size_bytes);
    assert_string_equal(got, "newmtl m\nNi 1\nmap_Kd -s 2 2 1 a.png\n");
    free(got);
    unload(&l);
    free(path);
    free(image);
    free(old);
}

/* A backslash at the end of a file name does not join the next line. */
static void file_names_may_end_in_backslashes(void **state)
{
    static const char on[] = "newmtl m\nmap_Kd a.png\\ \nNi 1\n";
    static const char off[] = "newmtl m\n#map_Kd a.png\\ \nNi 1\n";
    struct material_values without;
    struct mtl_change change;
    struct loaded l;
    size_t size_bytes;
    char *path = xformat("%s/a.mtl", folder);
    char *image = xformat("%s/a.png\\", folder);
    char *got;
    struct error err;

    (void)state;
    assert_true(file_write(image, "", 0, false, NULL, &err));
    load(&l, path, on, strlen(on));
    without = l.scene.material_origins[1].source;
    switch_map(&without);
    change = (struct mtl_change){"m", NULL, &l.scene.material_origins[1].source,
                                 &without};
    got = rewrite(&l.scene, path, on, strlen(on), &change, 1, &size_bytes);
    assert_string_equal(got, off);
    free(got);
    change.before = &without;
    change.after = &l.scene.material_origins[1].source;
    got = rewrite(&l.scene, path, off, strlen(off), &change, 1, &size_bytes);
    assert_string_equal(got, on);
    free(got);
    got = rewrite(&l.scene, path, "newmtl m\n\nNi 1\n", 15, &change, 1,
                  &size_bytes);
    assert_string_equal(got, "newmtl m\n\nNi 1\nmap_Kd a.png\\ \n");
    free(got);
    unload(&l);
    free(path);
    free(image);
}

/* Checks what is written into a file that lacks the material. */
static void check_written_whole(const struct loaded *l, const char *name,
                                const struct material_values *after,
                                const char *expected)
{
    struct mtl_change change = {name, NULL,
                                &l->scene.material_origins[1].source, after};
    size_t size_bytes;
    char *got = rewrite(&l->scene, "a.mtl", "", 0, &change, 1, &size_bytes);

    assert_string_equal(got, expected);
    free(got);
}

/* A duplicate has the unknown statements of its original and comes last. */
static void duplicates_come_last(void **state)
{
    static const char text[] =
        "newmtl m\nKd 0 0 0\nsharpness 60 # x\n\n# end\nnewmtl n\nKd 1 1 1";
    struct material_values after;
    struct mtl_change change;
    struct loaded l;
    size_t size_bytes;
    char *got;

    (void)state;
    load(&l, "a.mtl", text, strlen(text));
    after = l.scene.material_origins[1].source;
    redden(&after);
    change = (struct mtl_change){"m copy", "m",
                                 &l.scene.material_origins[1].source, &after};
    got =
        rewrite(&l.scene, "a.mtl", text, strlen(text), &change, 1, &size_bytes);
    assert_string_equal(got,
                        "newmtl m\nKd 0 0 0\nsharpness 60 # x\n\n# end\n"
                        "newmtl n\nKd 1 1 1\n\n"
                        "newmtl m copy\nKd 1 0.5 0.25\nsharpness 60 # x\n");
    free(got);
    /* Another program has removed the block. */
    check_written_whole(&l, "m", &after, "\nnewmtl m\nKd 1 0.5 0.25\n");
    unload(&l);
}

/* A backslash at the end of a name does not join the next line. */
static void material_names_may_end_in_backslashes(void **state)
{
    static const char text[] = "newmtl m\\ \nKd 0 0 0\n";
    struct material_values after;
    struct loaded l;

    (void)state;
    load(&l, "a.mtl", text, strlen(text));
    assert_string_equal(l.scene.material_names[1], "m\\");
    after = l.scene.material_origins[1].source;
    redden(&after);
    check_written_whole(&l, "m\\", &after, "\nnewmtl m\\ \nKd 1 0.5 0.25\n");
    unload(&l);
}

/* Kinds that were chosen only in passing leave nothing in the file. */
static void kinds_write_only_the_needed_statements(void **state)
{
    static const struct {
        const char *text;
        int steps;
        const char *want;
    } cases[] = {
        {"newmtl m\nKd .5 .5 .5\n", 3,
         "newmtl m\nKd .5 .5 .5\nTf 0.5 0.5 0.5\nillum 7\n"},
        {"newmtl m\nKd .5 .5 .5\n", 2, "newmtl m\nKd .5 .5 .5\nPm 1\n"},
        {"newmtl m\nKd .5 .5 .5\n", 1,
         "newmtl m\nKd .5 .5 .5\nKs 0.5 0.5 0.5\n"},
        {"newmtl m\nKd .5 .5 .5\n", 5, "newmtl m\nKd .5 .5 .5\n"},
        {"newmtl m\nKd .5 .5 .5\nPm 0\nillum 2\n", -1,
         "newmtl m\nKd .5 .5 .5\nPm 0\nillum 4\nTf 0.5 0.5 0.5\n"},
        {"newmtl m\nillum 7\nTf .1 .2 .3\n", 1,
         "newmtl m\nillum 4\nTf .1 .2 .3\n"},
    };

    (void)state;
    for (size_t i = 0; i < sizeof cases / sizeof cases[0]; i++) {
        const char *text = cases[i].text;
        const struct material_values *before;
        struct material_values after, needed;
        struct mtl_change change;
        struct loaded l;
        size_t size_bytes;
        char *got;

        load(&l, "a.mtl", text, strlen(text));
        before = &l.scene.material_origins[1].source;
        after = *before;
        step_kind(&after, cases[i].steps);
        needed = material_values_needed(before, &after);
        change = (struct mtl_change){"m", NULL, before, &needed};
        got = rewrite(&l.scene, "a.mtl", text, strlen(text), &change, 1,
                      &size_bytes);
        assert_string_equal(got, cases[i].want);
        free(got);
        unload(&l);
    }
}

/* The file keeps its permissions and has the whole text. */
static void saved_files_keep_their_permissions(void **state)
{
    char *path = xformat("%s/s.mtl", folder);
    struct material_values after;
    struct mtl_change change;
    struct file_change written;
    struct loaded l;
    struct error err;
    struct stat st;
    char *text;
    size_t size_bytes;

    (void)state;
    assert_true(file_write(path, "newmtl m\nKd 0\n", 14, false, NULL, &err));
    assert_int_equal(chmod(path, 0640), 0);
    load(&l, path, "newmtl m\nKd 0\n", 14);
    after = l.scene.material_origins[1].source;
    redden(&after);
    change = (struct mtl_change){"m", NULL, &l.scene.material_origins[1].source,
                                 &after};
    check_or_say(mtl_save(&l.scene, path, (struct mtl_changes){&change, 1},
                          &written, &err),
                 err.text);
    assert_int_equal(stat(path, &st), 0);
    assert_int_equal(st.st_mode & 0777, 0640);
    assert_true(file_read(path, &text, &size_bytes, &err));
    assert_string_equal(text, "newmtl m\nKd 1 0.5 0.25\n");
    free(text);
    assert_int_equal(unlink(path), 0);
    assert_false(mtl_save(&l.scene, path, (struct mtl_changes){&change, 1},
                          &written, &err));
    check_has(err.text, "no such file");
    unload(&l);
    free(path);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(only_changed_statements_are_written),
        cmocka_unit_test(maps_switched_on_again_are_as_before),
        cmocka_unit_test(file_names_may_end_in_backslashes),
        cmocka_unit_test(duplicates_come_last),
        cmocka_unit_test(material_names_may_end_in_backslashes),
        cmocka_unit_test(kinds_write_only_the_needed_statements),
        cmocka_unit_test(saved_files_keep_their_permissions),
    };

    return cmocka_run_group_tests(tests, make_folder, remove_folder);
}
