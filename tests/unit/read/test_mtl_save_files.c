// SPDX-License-Identifier: MIT
/*
 * test_mtl_save_files.c - random changes of the materials of all MTL files
 * here: the saved text gives the changed materials, and keeps foreign lines
 */
#include <dirent.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>

#include "base/file.h"
#include "base/memory.h"
#include "terminal/xmalloc.h"
#include "tests/unit/read/mtl_texts.h"
#include "tests/unit/shared.h"

#define ROUNDS 40

static uint64_t seed = 1;

static double random_unit(void)
{
    /* Some numbers have few digits, like those that people type. */
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

static struct material_values changed(const struct material_values *from)
{
    struct material_values s = *from;

    change_color(&s.base_color);
    change_color(&s.specular_color);
    change_color(&s.emission);
    change_color(&s.transmission);
    change_number(&s.illum, 10);
    change_number(&s.shininess, 900);
    change_number(&s.ior, 3);
    change_number(&s.opacity, 1);
    change_number(&s.transparency, 1);
    change_number(&s.roughness, 1);
    change_number(&s.metalness, 1);
    change_number(&s.coat, 1);
    change_number(&s.coat_roughness, 1);
    change_number(&s.diffuse_roughness, 1);
    change_number(&s.attenuation_distance, 9);
    change_number(&s.thinness, 1);
    change_number(&s.sheen_roughness, 1);
    change_number(&s.film, 1);
    change_number(&s.film_ior, 3);
    change_number(&s.film_thickness, 1000);
    change_number(&s.cutoff, 1);
    change_number(&s.kelvin, 9000);
    s.luminance = s.kelvin.line != 0 ? number(random_unit() * 50)
                                     : (struct mtl_number){.line = 0};
    if (s.kelvin.line != 0)
        /* Glim writes only one of the two. */
        s.emission = (struct mtl_color){.line = 0};
    for (int i = 0; i < MTL_MAPS; i++)
        if (s.maps[i] != NO_INDEX && check_random(&seed) < .3)
            s.maps_off ^= 1u << i;
    return s;
}

/* Returns comments and the statements that glim neither reads nor writes, in
 * order, for free(). */
static char *foreign_lines(const char *text, size_t size_bytes)
{
    char *rest = calloc(size_bytes + 1, 1);
    size_t length = 0;

    assert_non_null(rest);
    for (const char *p = text, *end = text + size_bytes; p < end;) {
        const char *line_end = p + strcspn(p, "\r\n");
        const char *word = p + strspn(p, " \t");
        const char *hash = memchr(p, '#', (size_t)(line_end - p));
        bool is_foreign =
            strncmp(word, "Ka", 2) == 0 || strncmp(word, "Ps ", 3) == 0 ||
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

/* Compares materials, except for textures that are off, which the reader does
 * not see. */
static void check_same(const struct scene *got, uint32_t g,
                       const struct material_values *want, const char *path)
{
    struct warnings none = {.entries = NULL};
    struct material_values there = *want;
    struct material a, b;

    for (int i = 0; i < MTL_MAPS; i++) {
        there.maps[i] = material_values_map(want, (enum mtl_map)i);
        if (there.maps[i] == NO_INDEX)
            there.map_scales[i] = 1;
    }
    there.maps_off = 0;
    a = material_from_source(&got->material_origins[g].source, path, &none);
    b = material_from_source(&there, path, &none);
    /* Textures have new numbers, so only their presence is compared. */
    for (int i = 0; i < MTL_MAPS; i++)
        assert_int_equal(got->material_origins[g].source.maps[i] == NO_INDEX,
                         there.maps[i] == NO_INDEX);
    b.color_texture = a.color_texture;
    b.emission_texture = a.emission_texture;
    b.specular_texture = a.specular_texture;
    b.alpha_texture = a.alpha_texture;
    b.metal_texture = a.metal_texture;
    b.opacity_texture = a.opacity_texture;
    b.normal_texture = a.normal_texture;
    b.bump_texture = a.bump_texture;
    b.transmission_texture = a.transmission_texture;
    b.coat_texture = a.coat_texture;
    b.coat_alpha_texture = a.coat_alpha_texture;
    b.sheen_texture = a.sheen_texture;
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
        struct material_values *after = alloc_array(count, sizeof *after);
        struct mtl_change *changes = alloc_array(count, sizeof *changes);
        char *before_rest = foreign_lines(text, size_bytes);
        size_t new_bytes;
        struct loaded again;
        char *got, *got_rest;

        for (uint32_t i = 0; i < count; i++) {
            const struct material_values *s =
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
        got_rest = foreign_lines(got, new_bytes);
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

static void our_files_are_saved_as_they_were_changed(void **state)
{
    (void)state;
    assert_true(check_folder("scenes") >= 6);
}

static void shared_files_are_saved_as_they_were_changed(void **state)
{
    char *path = shared_path("suites");

    (void)state;
    free(path);
    assert_true(check_folder(shared_folder()) > 0);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(our_files_are_saved_as_they_were_changed),
        cmocka_unit_test(shared_files_are_saved_as_they_were_changed),
    };

    return cmocka_run_group_tests(tests, NULL, NULL);
}
