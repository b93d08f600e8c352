// SPDX-License-Identifier: MIT
/*
 * What is written into MTL files: exactly the statements that were changed, and
 * so that reading gives what was wanted, for hand-made odd files and for all
 * that are at hand.
 */
#include <dirent.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

#include "base/file.h"
#include "base/memory.h"
#include "formats/mtl.h"
#include "formats/mtl_save.h"
#include "terminal/xmalloc.h"
#include "tests/unit/check.h"
#include "tests/unit/folder.h"
#include "tests/unit/kinds.h"

struct loaded {
    struct scene scene;
    struct warnings report;
};

static void load(struct loaded *l, const char *path, const char *text,
                 size_t size_bytes)
{
    struct error err;

    *l = (struct loaded){.scene = {.path = NULL}};
    check_or_say(mtl_parse(&l->scene, text, size_bytes, path, &l->report, &err),
                 err.text);
}

static void unload(struct loaded *l)
{
    scene_free(&l->scene);
    warnings_free(&l->report);
}

/* The new text, as a string. */
static char *rewrite(const struct scene *scene, const char *path,
                     const char *text, size_t size_bytes,
                     const struct mtl_change *changes, size_t count,
                     size_t *new_size_bytes)
{
    struct error err;
    char *new_text;

    check_or_say(mtl_rewrite(scene, path, text, size_bytes, changes, count,
                             &new_text, new_size_bytes, &err),
                 err.text);
    new_text = realloc(new_text, *new_size_bytes + 1);
    assert_non_null(new_text);
    new_text[*new_size_bytes] = '\0';
    return new_text;
}

static struct mtl_number number(double value)
{
    return (struct mtl_number){value, 1};
}

static struct mtl_color color(double r, double g, double b)
{
    return (struct mtl_color){{r, g, b}, 1};
}

/* ---- exact texts ---- */

static void redden(struct mtl_source *s)
{
    s->kd = color(1, .5, .25);
}

static void roughen(struct mtl_source *s)
{
    s->pr = number(.5);
}

static void fade(struct mtl_source *s)
{
    s->d = number(.25);
}

static void shine(struct mtl_source *s)
{
    s->kelvin.line = s->luminance.line = 0;
    s->ke = color(1, 2, 3);
}

static void glow(struct mtl_source *s)
{
    s->kelvin = number(3000);
    s->luminance = number(5);
}

static void darken(struct mtl_source *s)
{
    s->kelvin.line = s->luminance.line = s->ke.line = 0;
}

static void switch_map(struct mtl_source *s)
{
    s->maps_off ^= 1u << MTL_MAP_KD;
}

static void switch_bumps(struct mtl_source *s)
{
    s->maps_off ^= 1u << MTL_MAP_BUMP;
}

static void leave(struct mtl_source *s)
{
    (void)s;
}

static void test_statements(void **state)
{
    static const struct {
        const char *text;
        void (*edit)(struct mtl_source *);
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
        /* what counts is changed, and nothing else */
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
        {"newmtl m\nd -halo 0.5\n", fade, "newmtl m\nd -halo 0.25\n"},
        {"newmtl m\nTr 0.5\n", fade, "newmtl m\nTr 0.5\nd 0.25\n"},
        /* light by either statement */
        {"newmtl m\nKe_blackbody 2000 # warm\n", shine,
         "newmtl m\nKe 1 2 3 # warm\n"},
        {"newmtl m\nKe 1 1 1\n", glow, "newmtl m\nKe_blackbody 3000 5\n"},
        {"newmtl m\nKe 9\nKe_blackbody 2000\n", glow,
         "newmtl m\nKe 9\nKe_blackbody 3000 5\n"},
        {"newmtl m\nKe 9 # was\nNi 1\nKe_blackbody 2000\n", darken,
         "newmtl m\n # was\nNi 1\n"},
        /* maps become comments; a name may hold '#' */
        {"newmtl m\n map_Kd -s 2 2 2 a b#.png \r\nNi 1\n", switch_map,
         "newmtl m\n #map_Kd -s 2 2 2 a b#.png\r\nNi 1\n"},
        {"newmtl m\nmap_Kd \\\n a.png\nNi 1\n", switch_map,
         "newmtl m\n#map_Kd a.png\nNi 1\n"},
        {"newmtl m\nbump a.png\nmap_Bump -bm 2 a.png\n", switch_bumps,
         "newmtl m\n#bump a.png\n#map_Bump -bm 2 a.png\n"},
        {"newmtl m\nKd 0 0 0\n", leave, "newmtl m\nKd 0 0 0\n"},
    };

    (void)state;
    for (size_t i = 0; i < sizeof cases / sizeof cases[0]; i++) {
        const char *text = cases[i].text;
        struct loaded l;
        struct mtl_source after;
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

/* Off and on again: the comment becomes the statement that it was, and not the
 * comment beside it, which means another file. */
static void test_maps_come_back(void **state)
{
    static const char text[] = "newmtl m\nmap_Kd -s 2 2 2 a.png\nNi 1\n"
                               "#map_Kd old.png\n# map_Kd a.png\n";
    struct mtl_source off;
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
    /* without the comment it is written anew, with its options */
    got = rewrite(&l.scene, path, "newmtl m\nNi 1\n", 14, &change, 1,
                  &size_bytes);
    assert_string_equal(got, "newmtl m\nNi 1\nmap_Kd -s 2 2 1 a.png\n");
    free(got);
    unload(&l);
    free(path);
    free(image);
    free(old);
}

/* A backslash that ends a name never joins the next line to it. */
static void test_backslashes(void **state)
{
    static const char on[] = "newmtl m\nmap_Kd a.png\\ \nNi 1\n";
    static const char off[] = "newmtl m\n#map_Kd a.png\\ \nNi 1\n";
    struct mtl_source without;
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

/* Into a file that does not have it. */
static void check_written_whole(const struct loaded *l, const char *name,
                                const struct mtl_source *after,
                                const char *expected)
{
    struct mtl_change change = {name, NULL,
                                &l->scene.material_origins[1].source, after};
    size_t size_bytes;
    char *got = rewrite(&l->scene, "a.mtl", "", 0, &change, 1, &size_bytes);

    assert_string_equal(got, expected);
    free(got);
}

/* A duplicate has its pattern's unknown statements and comes last. */
static void test_duplicates(void **state)
{
    static const char text[] =
        "newmtl m\nKd 0 0 0\naniso .3 # x\n\n# end\nnewmtl n\nKd 1 1 1";
    struct mtl_source after;
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
    assert_string_equal(got, "newmtl m\nKd 0 0 0\naniso .3 # x\n\n# end\n"
                             "newmtl n\nKd 1 1 1\n\n"
                             "newmtl m copy\nKd 1 0.5 0.25\naniso .3 # x\n");
    free(got);
    /* somebody else has removed the block */
    check_written_whole(&l, "m", &after, "\nnewmtl m\nKd 1 0.5 0.25\n");
    unload(&l);
}

/* A backslash at the end of a line would join the next one to the name. */
static void test_names_end_in_backslashes(void **state)
{
    static const char text[] = "newmtl m\\ \nKd 0 0 0\n";
    struct mtl_source after;
    struct loaded l;

    (void)state;
    load(&l, "a.mtl", text, strlen(text));
    assert_string_equal(l.scene.material_names[1], "m\\");
    after = l.scene.material_origins[1].source;
    redden(&after);
    check_written_whole(&l, "m\\", &after, "\nnewmtl m\\ \nKd 1 0.5 0.25\n");
    unload(&l);
}

/* Kinds that a person only steps through leave nothing in the file. */
static void test_what_is_needed(void **state)
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
        const struct mtl_source *before;
        struct mtl_source after, needed;
        struct mtl_change change;
        struct loaded l;
        size_t size_bytes;
        char *got;

        load(&l, "a.mtl", text, strlen(text));
        before = &l.scene.material_origins[1].source;
        after = *before;
        step_kind(&after, cases[i].steps);
        needed = mtl_source_needed(before, &after);
        change = (struct mtl_change){"m", NULL, before, &needed};
        got = rewrite(&l.scene, "a.mtl", text, strlen(text), &change, 1,
                      &size_bytes);
        assert_string_equal(got, cases[i].want);
        free(got);
        unload(&l);
    }
}

/* ---- all files at hand ---- */

#define ROUNDS 40

static uint64_t seed = 1;

static double random_unit(void)
{
    /* now and then a number with few digits, as people type them */
    double x = check_random(&seed);

    return check_random(&seed) < .3 ? floor(x * 10) / 10 : x;
}

static void change_color(struct mtl_color *c)
{
    if (check_random(&seed) < .7)
        return;
    *c = color(random_unit(), random_unit(), random_unit());
    if (check_random(&seed) < .2)
        *c = (struct mtl_color){.line = 0};
}

static void change_number(struct mtl_number *n, double most)
{
    if (check_random(&seed) < .8)
        return;
    *n = number(most == 10 ? floor(random_unit() * 10) : random_unit() * most);
    if (check_random(&seed) < .2)
        *n = (struct mtl_number){.line = 0};
}

static struct mtl_source changed(const struct mtl_source *from)
{
    struct mtl_source s = *from;

    change_color(&s.kd);
    change_color(&s.ks);
    change_color(&s.ke);
    change_color(&s.tf);
    change_number(&s.illum, 10);
    change_number(&s.ns, 900);
    change_number(&s.ni, 3);
    change_number(&s.d, 1);
    change_number(&s.tr, 1);
    change_number(&s.pr, 1);
    change_number(&s.pm, 1);
    change_number(&s.kd_roughness, 1);
    change_number(&s.kelvin, 9000);
    s.luminance = s.kelvin.line != 0 ? number(random_unit() * 50)
                                     : (struct mtl_number){.line = 0};
    if (s.kelvin.line != 0)
        s.ke = (struct mtl_color){.line = 0}; /* only one can be told */
    for (int i = 0; i < MTL_MAPS; i++)
        if (s.maps[i] != NO_INDEX && check_random(&seed) < .3)
            s.maps_off ^= 1u << i;
    return s;
}

/* Statements that glim neither knows nor writes, and comments, in order. */
static char *rest_of(const char *text, size_t size_bytes)
{
    char *rest = calloc(size_bytes + 1, 1);
    size_t length = 0;

    assert_non_null(rest);
    for (const char *p = text, *end = text + size_bytes; p < end;) {
        const char *line_end = p + strcspn(p, "\r\n");
        const char *word = p + strspn(p, " \t");
        const char *hash = memchr(p, '#', (size_t)(line_end - p));
        bool is_foreign =
            strncmp(word, "Ka", 2) == 0 || strncmp(word, "Ps", 2) == 0 ||
            strncmp(word, "refl", 4) == 0 || strncmp(word, "disp", 4) == 0;

        if (is_foreign)
            hash = p;
        if (hash && strncmp(hash, "#map", 4) != 0 &&
            strncmp(hash, "#bump", 5) != 0 && strncmp(hash, "#norm", 5) != 0) {
            memcpy(rest + length, hash, (size_t)(line_end - hash));
            length += (size_t)(line_end - hash);
        }
        p = line_end + (line_end < end);
    }
    return rest;
}

/* The same but for textures that are off: reading does not know of them. */
static void check_same(const struct scene *got, uint32_t g,
                       const struct mtl_source *want, const char *path)
{
    struct warnings none = {.entries = NULL};
    struct mtl_source there = *want;
    struct material a, b;

    for (int i = 0; i < MTL_MAPS; i++)
        there.maps[i] = mtl_source_map(want, (enum mtl_map)i);
    there.maps_off = 0;
    if (there.maps[MTL_MAP_BUMP] == NO_INDEX)
        there.bump_scale = 1;
    a = material_from_source(&got->material_origins[g].source, path, &none);
    b = material_from_source(&there, path, &none);
    /* textures are numbered anew: it is enough that they are there */
    for (int i = 0; i < MTL_MAPS; i++)
        assert_int_equal(got->material_origins[g].source.maps[i] == NO_INDEX,
                         there.maps[i] == NO_INDEX);
    b.color_texture = a.color_texture;
    b.emission_texture = a.emission_texture;
    b.coat_texture = a.coat_texture;
    b.alpha_texture = a.alpha_texture;
    b.metal_texture = a.metal_texture;
    b.opacity_texture = a.opacity_texture;
    b.normal_texture = a.normal_texture;
    b.bump_texture = a.bump_texture;
    if (memcmp(&a, &b, sizeof a) != 0)
        print_error("%s: material %s\n", path, got->material_names[g]);
    assert_memory_equal(&a, &b, sizeof a);
    warnings_free(&none);
}

static void check_file(const char *path)
{
    struct error err;
    struct loaded l;
    char *text;
    size_t size_bytes;

    check_or_say(file_read(path, &text, &size_bytes, &err), err.text);
    load(&l, path, text, size_bytes);
    for (int round = 0; round < ROUNDS; round++) {
        uint32_t count = l.scene.material_count - 1;
        struct mtl_source *after = alloc_array(count, sizeof *after);
        struct mtl_change *changes = alloc_array(count, sizeof *changes);
        char *before_rest = rest_of(text, size_bytes);
        size_t new_bytes;
        struct loaded again;
        char *got, *got_rest;

        for (uint32_t i = 0; i < count; i++) {
            const struct mtl_source *s =
                &l.scene.material_origins[i + 1].source;

            after[i] = round == 0 ? *s : changed(s);
            changes[i] = (struct mtl_change){l.scene.material_names[i + 1],
                                             NULL, s, &after[i]};
        }
        got = rewrite(&l.scene, path, text, size_bytes, changes, count,
                      &new_bytes);
        if (round == 0) {
            assert_int_equal(new_bytes, size_bytes);
            assert_memory_equal(got, text, size_bytes);
        }
        load(&again, path, got, new_bytes);
        assert_int_equal(again.scene.material_count, l.scene.material_count);
        for (uint32_t i = 0; i < count; i++) {
            assert_string_equal(again.scene.material_names[i + 1],
                                l.scene.material_names[i + 1]);
            check_same(&again.scene, i + 1, &after[i], path);
        }
        got_rest = rest_of(got, new_bytes);
        assert_string_equal(got_rest, before_rest);
        unload(&again);
        free(got_rest);
        free(got);
        free(before_rest);
        free(changes);
        free(after);
    }
    unload(&l);
    free(text);
}

static int check_folder(const char *path)
{
    DIR *dir = opendir(path);
    struct dirent *entry;
    int count = 0;

    while (dir && (entry = readdir(dir))) {
        char *name = xformat("%s/%s", path, entry->d_name);
        size_t length = strlen(name);
        struct stat st;

        if (entry->d_name[0] == '.' || stat(name, &st) != 0) {
            free(name);
            continue;
        }
        if (S_ISDIR(st.st_mode)) {
            count += check_folder(name);
        } else if (length > 4 && strcmp(name + length - 4, ".mtl") == 0) {
            check_file(name);
            count++;
        }
        free(name);
    }
    if (dir)
        closedir(dir);
    return count;
}

static void test_our_files(void **state)
{
    (void)state;
    assert_true(check_folder("scenes") >= 6);
}

static void test_shared_files(void **state)
{
    const char *shared = getenv("GLIM_SHARED");
    char *path = xformat("%s", shared ? shared : "../shared");

    (void)state;
    if (check_folder(path) == 0)
        skip();
    free(path);
}

/* The file keeps its permissions and is whole. */
static void test_save(void **state)
{
    char *path = xformat("%s/s.mtl", folder);
    struct mtl_source after;
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
    check_or_say(mtl_save(&l.scene, path, &change, 1, &written, &err),
                 err.text);
    assert_int_equal(stat(path, &st), 0);
    assert_int_equal(st.st_mode & 0777, 0640);
    assert_true(file_read(path, &text, &size_bytes, &err));
    assert_string_equal(text, "newmtl m\nKd 1 0.5 0.25\n");
    free(text);
    assert_int_equal(unlink(path), 0);
    assert_false(mtl_save(&l.scene, path, &change, 1, &written, &err));
    check_has(err.text, "no such file");
    unload(&l);
    free(path);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_statements),
        cmocka_unit_test(test_maps_come_back),
        cmocka_unit_test(test_backslashes),
        cmocka_unit_test(test_duplicates),
        cmocka_unit_test(test_names_end_in_backslashes),
        cmocka_unit_test(test_what_is_needed),
        cmocka_unit_test(test_our_files),
        cmocka_unit_test(test_shared_files),
        cmocka_unit_test(test_save),
    };

    return cmocka_run_group_tests(tests, make_folder, remove_folder);
}
