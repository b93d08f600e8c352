// SPDX-License-Identifier: MIT
/*
 * test_round_trips.c - views and materials that are read, written and read
 * again are equal; the texts are random or made to break this
 */
#include <glob.h>
#include <stdlib.h>
#include <string.h>

#include "base/memory.h"
#include "read/mtl.h"
#include "read/mtl_save.h"
#include "read/view_file.h"
#include "terminal/xmalloc.h"
#include "tests/unit/folder.h"
#include "tests/unit/shared.h"

#define ROUNDS     20000
#define TEXT_BYTES 512

static uint64_t seed = 1;

struct text {
    const char *bytes;
    size_t size;
};

/* The literal may contain NULs. */
#define TEXT(literal)                   \
    {                                   \
        literal, sizeof(literal "") - 1 \
    }

static size_t random_below(size_t count)
{
    return (size_t)(check_random(&seed) * (double)count);
}

/* Makes a text of random words. Some of them end lines, join lines or are not
 * words. */
static size_t random_text(char bytes[TEXT_BYTES], const struct text *words,
                          size_t count)
{
    size_t size = 0;

    for (size_t left = random_below(40); left > 0; left--) {
        const struct text *w = &words[random_below(count)];

        if (size + w->size + 1 > TEXT_BYTES)
            break;
        memcpy(bytes + size, w->bytes, w->size);
        size += w->size;
        if (check_random(&seed) < .5)
            bytes[size++] = ' ';
    }
    return size;
}

static void print_text_bytes(const char *bytes, size_t size)
{
    for (size_t i = 0; i < size; i++) {
        unsigned char c = (unsigned char)bytes[i];

        print_error(c < 0x20 || c > 0x7e ? "\\x%02x" : "%c", c);
    }
    print_error("\n");
}

/* Compares skies, which may have different paths to one file. */
static bool skies_are_equal(const char *a, const char *b)
{
    char *x = a == NULL ? NULL : path_seen_from("t.view", a);
    char *y = b == NULL ? NULL : path_seen_from("t.view", b);
    bool ok = (a == NULL) == (b == NULL) && (a == NULL || strcmp(x, y) == 0);

    free(x);
    free(y);
    return ok;
}

static bool views_are_equal(const struct view *a, const struct view *b)
{
    struct view x = *a, y = *b;
    bool ok = a->assigns.count == b->assigns.count &&
              lamps_equal(&a->lamps, &b->lamps) &&
              skies_are_equal(a->lighting.sky_path, b->lighting.sky_path);

    for (size_t i = 0; ok && i < a->assigns.count; i++)
        ok = strcmp(a->assigns.items[i].object, b->assigns.items[i].object) ==
                 0 &&
             strcmp(a->assigns.items[i].material,
                    b->assigns.items[i].material) == 0;
    x.lighting.sky_path = y.lighting.sky_path = NULL;
    x.assigns = y.assigns = (struct assigns){0};
    x.lamps = y.lamps = (struct lamps){0};
    /* Values of absent keys are those of view_init(). */
    return ok && memcmp(&x, &y, sizeof x) == 0;
}

/* Returns whether the text is a view file, and checks it if it is. */
static bool check_view(const char *bytes, size_t size)
{
    struct warnings none = {0};
    struct error err;
    struct view view, again;
    char *text, *second;
    size_t text_bytes, second_bytes;
    bool ok;

    view_init(&view);
    view_init(&again);
    if (!view_parse(&view, bytes, size, "t.view", &none, &err)) {
        view_free(&view);
        warnings_free(&none);
        return false;
    }
    check_or_say(view_format(&view, &(struct file_bytes){"t.view", bytes, size},
                             &text, &text_bytes, &err),
                 err.text);
    ok = view_parse(&again, text, text_bytes, "t.view", &none, &err);
    if (!ok || !views_are_equal(&view, &again)) {
        print_text_bytes(bytes, size);
        print_text_bytes(text, text_bytes);
    }
    check_or_say(ok, err.text);
    assert_true(views_are_equal(&view, &again));
    assert_true(view_format(&again,
                            &(struct file_bytes){"t.view", text, text_bytes},
                            &second, &second_bytes, &err));
    assert_int_equal(second_bytes, text_bytes);
    assert_memory_equal(second, text, text_bytes);
    free(second);
    free(text);
    view_free(&view);
    view_free(&again);
    warnings_free(&none);
    return true;
}

static void broken_views_survive_the_round_trip(void **state)
{
    static const struct text texts[] = {
        TEXT("sun 120 30\nturbidity 2.5\nsky a.hdr\n"),
        TEXT("turbidity 5\nsun -359.9 -90\nsun 1e-3 90\nsun 7 8\n"),
        TEXT("turbidity 5\n"),
        TEXT("light point 0 1e-9 .1 radius -0\nfovy 3\nlight directional 1 2"),
        TEXT("light spot -0 1 2 at 0 1 3 outer 90 inner 1e-9 at 1 1 1\\\n"),
        TEXT("light point 1 2 3 \\\nintensity .1 .2 .3333333333333 # \\\n"),
        TEXT("fog scatter 1 .1 .3333333333 absorb 0 0 1e-9 height 2\n"),
        TEXT("fog anisotropy .5 falloff 2\nfog absorb 0 0 -0 falloff -0\n"),
        TEXT("fog falloff 1e-300 absorb 1 0 0 height -0 anisotropy -1\nfog "
             "\\\n"),
        TEXT("# x\nsky s\\\\"),
        TEXT("sky s\\ \nexposure 1\n"),
        TEXT("sky \\\\\\\\\\\r\r\r ex\\%\\\\ 2 0\n"),
        TEXT("sky a#b\\\nexposure 2\n"),
        TEXT("sky \0p 0 1 0\nexposure -.5\n"),
        TEXT("sky .\n"),
        TEXT("sky ./\n"),
        TEXT("shutter 2\\"),
        TEXT("shutter 2\\\n"),
        TEXT("# C:\\"),
        TEXT("assign \"a\\\" b\\"),
        TEXT("assign \"a # b\" c \\\n\nexposure 1\n"),
        TEXT("eye 1 2 3\nat 0 0 0\nview 1 eye 9 9 9 at 1e-9 .1 .3333333333\n"),
        TEXT("eye -1.2 2.3 7.4\nat .15 .75 0\nu\0\0\0map 0 1 0\n"
             "f \0\0\0p 0 1 0\nsky \0p 0 1 0\nsky_strength 1\n"),
    };

    (void)state;
    for (size_t i = 0; i < sizeof texts / sizeof texts[0]; i++)
        assert_true(check_view(texts[i].bytes, texts[i].size));
}

static void random_views_survive_the_round_trip(void **state)
{
    static const struct text words[] = {
        TEXT("\neye 1 2 3\nat 4 5 6\n"),
        TEXT("\nfovy 39.1"),
        TEXT("\nexposure .1"),
        TEXT("\nsun 1 2"),
        TEXT("\nlight point 1 2 3"),
        TEXT("\nlight spot 1 2 3 at .1 .2 .3"),
        TEXT("\nlight directional 4 5 angle .5"),
        TEXT("radius .7"),
        TEXT("\nturbidity 4"),
        TEXT("\nfog scatter .1 .2 .3"),
        TEXT("\nfog"),
        TEXT("absorb 4 5 6"),
        TEXT("anisotropy .7"),
        TEXT("height 2 falloff .3"),
        TEXT("\nsky"),
        TEXT("\nsky"),
        TEXT("\nassign"),
        TEXT("a"),
        TEXT("b.hdr"),
        TEXT("\\"),
        TEXT("\\"),
        TEXT("\\\n"),
        TEXT("\\\r\n"),
        TEXT("#"),
        TEXT("\""),
        TEXT("\n"),
        TEXT("\r"),
        TEXT("\0"),
        TEXT("\t"),
        TEXT("shutter"),
        TEXT("\ntone aces"),
        TEXT("\nview 3 eye 1 2 3 at 0 0 .1"),
        TEXT("/"),
        TEXT("."),
        TEXT("\xff\x9b"),
    };
    int count = 0;

    (void)state;
    for (int i = 0; i < ROUNDS; i++) {
        char bytes[TEXT_BYTES];
        size_t size = random_text(bytes, words, sizeof words / sizeof words[0]);

        count += check_view(bytes, size);
    }
    assert_in_range(count, ROUNDS / 20, ROUNDS);
}

struct loaded {
    struct scene scene;
    struct warnings report;
};

static bool load(struct loaded *l, const char *bytes, size_t size)
{
    struct error err;

    *l = (struct loaded){.scene = {.path = NULL}};
    return mtl_parse(&l->scene, bytes, size, "t.mtl", &l->report, &err);
}

static void unload(struct loaded *l)
{
    scene_free(&l->scene);
    warnings_free(&l->report);
}

static void change(struct material_values *s)
{
    for (int i = 0; i < 3; i++)
        s->base_color.rgb[i] = check_random(&seed);
    s->base_color.line = 1;
    s->shininess = (struct mtl_number){check_random(&seed) * 900, 1};
    if (check_random(&seed) < .3)
        s->opacity = (struct mtl_number){.line = 0};
    for (int i = 0; i < MTL_MAPS; i++)
        if (s->maps[i] != NO_INDEX && check_random(&seed) < .3)
            s->maps_off ^= 1u << i;
}

static bool maps_are_equal(const struct scene *a, uint32_t map,
                           const struct scene *b, uint32_t wanted)
{
    if (map == NO_INDEX || wanted == NO_INDEX)
        return map == wanted;
    return strcmp(a->texture_paths[map], b->texture_paths[wanted]) == 0 &&
           memcmp(&a->textures[map].scale, &b->textures[wanted].scale,
                  sizeof a->textures[map].scale) == 0;
}

/* Returns whether the file has the material with the wanted values. */
static bool is_written(const struct scene *got, const char *name,
                       const struct scene *from,
                       const struct material_values *want)
{
    uint32_t m = mtl_find(got, name);
    struct material_values a, b = *want;
    bool ok = m != NO_INDEX;

    if (!ok)
        return false;
    a = got->material_origins[m].source;
    for (int i = 0; i < MTL_MAPS; i++) {
        ok &= maps_are_equal(got, a.maps[i], from,
                             material_values_map(want, (enum mtl_map)i));
        a.maps[i] = b.maps[i] = NO_INDEX;
        if (material_values_map(want, (enum mtl_map)i) == NO_INDEX)
            b.map_scales[i] = a.map_scales[i];
    }
    b.maps_off = 0;
    return ok && material_values_equal(&a, &b);
}

/* Changes and copies every material. Returns false if the text is not MTL text
 * with a material. */
static bool check_mtl(const char *bytes, size_t size)
{
    struct loaded l, again;
    struct material_values *after;
    struct mtl_change *changes;
    struct error err;
    uint32_t count;
    char **copies, *text;
    size_t text_bytes;
    bool ok = load(&l, bytes, size) && l.scene.material_count > 1;

    if (!ok) {
        unload(&l);
        return false;
    }
    count = l.scene.material_count - 1;
    after = alloc_array(2 * (size_t)count, sizeof *after);
    changes = alloc_array(2 * (size_t)count, sizeof *changes);
    copies = alloc_array(count, sizeof *copies);
    for (uint32_t i = 0; i < 2 * count; i++) {
        uint32_t m = i % count + 1;
        const struct material_values *s = &l.scene.material_origins[m].source;
        const char *name = l.scene.material_names[m];

        after[i] = *s;
        if (i < count || check_random(&seed) < .7)
            change(&after[i]);
        if (i >= count)
            copies[m - 1] = xformat("copy of %s", name);
        changes[i] = (struct mtl_change){i < count ? name : copies[m - 1],
                                         i < count ? NULL : name, s, &after[i]};
    }
    ok = mtl_rewrite(&l.scene, &(struct file_bytes){"t.mtl", bytes, size},
                     (struct mtl_changes){changes, 2 * count}, &text,
                     &text_bytes, &err);
    if (!ok)
        print_text_bytes(bytes, size);
    check_or_say(ok, err.text);
    ok = load(&again, text, text_bytes) &&
         again.scene.material_count == 2 * count + 1;
    for (uint32_t i = 0; ok && i < 2 * count; i++)
        ok = is_written(&again.scene, changes[i].name, &l.scene, &after[i]);
    if (!ok) {
        print_text_bytes(bytes, size);
        print_text_bytes(text, text_bytes);
    }
    assert_true(ok);
    for (uint32_t i = 0; i < count; i++)
        free(copies[i]);
    free(copies);
    free(changes);
    free(after);
    free(text);
    unload(&again);
    unload(&l);
    return true;
}

static void broken_mtl_survives_the_round_trip(void **state)
{
    static const struct text texts[] = {
        TEXT("newmtl der MTL Fi\\\n"),
        TEXT("newmtl a\\"),
        TEXT("newmtl a\nNi 1\\"),
        TEXT("newmtl a\nNi 1 # C:\\"),
        TEXT("newmtl a\nfoo \\\n"),
        TEXT("newmtl a\nKd 1\n\\"),
        TEXT("newmtl \0a\nKd 1\n"),
        TEXT("newmtl a#\\\nNi 1 \n"),
        TEXT("newmtl a\nfoo a#b \\\nNi 2\n"),
        TEXT("newmtl a\nmap_Kd x#.png\\\nNi 1.5\n"),
        TEXT("llib\nnewmtl Whatever\nKa 0 0\0\0\0\0(\nNs 3\nfoo\0bar\nd 1\n"),
    };

    (void)state;
    for (size_t i = 0; i < sizeof texts / sizeof texts[0]; i++)
        assert_true(check_mtl(texts[i].bytes, texts[i].size));
}

/* A statement behind a NUL is part of its block's copy. */
static void copies_keep_what_follows_a_nul(void **state)
{
    static const char bytes[] = "newmtl a\nKa 0 0\0\0\nfoo\nNi 3\n";
    struct loaded l;
    struct error err;
    char *text;
    size_t size;

    (void)state;
    assert_true(load(&l, bytes, sizeof bytes - 1));
    const struct material_values *s = &l.scene.material_origins[1].source;
    struct mtl_change c = {"b", "a", s, s};
    check_or_say(mtl_rewrite(&l.scene,
                             &(struct file_bytes){"t.mtl", bytes,
                                                  sizeof bytes - 1},
                             (struct mtl_changes){&c, 1}, &text, &size, &err),
                 err.text);
    static const char want[] = "newmtl a\nKa 0 0\0\0\nfoo\nNi 3\n\n"
                               "newmtl b\nKa 0 0\0\0\nfoo\nNi 3\n";
    assert_int_equal(size, sizeof want - 1);
    assert_memory_equal(text, want, size);
    free(text);
    unload(&l);
}

/* A copy of the default material is made from no block, even if a block has an
 * empty name. */
static void copies_of_the_default_are_of_no_block(void **state)
{
    static const char bytes[] = "newmtl\nKd 1 0 0\nnewmtl a\nNi 3\n";
    struct material_values none = material_values_empty();
    struct mtl_change c = {"b", "", &none, &none};
    struct loaded l;
    struct error err;
    char *text;
    size_t size;

    (void)state;
    assert_true(load(&l, bytes, sizeof bytes - 1));
    check_or_say(mtl_rewrite(&l.scene,
                             &(struct file_bytes){"t.mtl", bytes,
                                                  sizeof bytes - 1},
                             (struct mtl_changes){&c, 1}, &text, &size, &err),
                 err.text);
    static const char want[] = "newmtl\nKd 1 0 0\nnewmtl a\nNi 3\n\nnewmtl b\n";
    assert_int_equal(size, sizeof want - 1);
    assert_memory_equal(text, want, size);
    free(text);
    unload(&l);
}

static void random_mtl_survives_the_round_trip(void **state)
{
    static const struct text words[] = {
        TEXT("\nnewmtl"), TEXT("\nnewmtl"),  TEXT("\nnewmtl a\n"),
        TEXT("\nKd 1"),   TEXT("\nNi 1.25"), TEXT("\nd -halo 0.5"),
        TEXT("\nfoo"),    TEXT("\nmap_Kd"),  TEXT("\nnorm"),
        TEXT("\nKa"),     TEXT("\\"),        TEXT("\\"),
        TEXT("\\\n"),     TEXT("\\\r\n"),    TEXT("#"),
        TEXT("\n#"),      TEXT("\0"),        TEXT("x.png"),
        TEXT("-s 2 2 1"), TEXT("\n"),        TEXT("\r"),
        TEXT("\t"),       TEXT("b"),         TEXT("0"),
        TEXT("\x80"),
    };
    int count = 0;

    (void)state;
    for (int i = 0; i < ROUNDS; i++) {
        char bytes[TEXT_BYTES];
        size_t size = random_text(bytes, words, sizeof words / sizeof words[0]);

        count += check_mtl(bytes, size);
    }
    assert_in_range(count, ROUNDS / 20, ROUNDS);
}

/* Returns how many files that match the pattern are of the type that their name
 * says. */
static int check_files(const char *suites, const char *pattern,
                       bool (*check)(const char *, size_t))
{
    char *path = xformat("%s/%s", suites, pattern);
    glob_t found;
    int count = 0;

    if (glob(path, 0, NULL, &found) != 0)
        found = (glob_t){0};
    for (size_t i = 0; i < found.gl_pathc; i++) {
        struct error err;
        char *text;
        size_t size;

        check_or_say(file_read(found.gl_pathv[i], &text, &size, &err),
                     err.text);
        count += check(text, size);
        free(text);
    }
    globfree(&found);
    free(path);
    return count;
}

static void shared_files_survive_the_round_trip(void **state)
{
    char *suites = shared_path("suites");
    int count = check_files(suites, "*/*.view", check_view) +
                check_files(suites, "*/*.mtl", check_mtl) +
                check_files(suites, "attack/mtl_*.bin", check_mtl);

    (void)state;
    assert_true(count > 0);
    free(suites);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(broken_views_survive_the_round_trip),
        cmocka_unit_test(random_views_survive_the_round_trip),
        cmocka_unit_test(broken_mtl_survives_the_round_trip),
        cmocka_unit_test(copies_keep_what_follows_a_nul),
        cmocka_unit_test(copies_of_the_default_are_of_no_block),
        cmocka_unit_test(random_mtl_survives_the_round_trip),
        cmocka_unit_test(shared_files_survive_the_round_trip),
    };

    return cmocka_run_group_tests(tests, make_folder, remove_folder);
}
