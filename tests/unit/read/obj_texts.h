// SPDX-License-Identifier: MIT
/*
 * obj_texts.h - OBJ texts that are parsed, and checks of their warnings
 *
 * Ownership: unload() frees what load() has read
 * Threads:   one
 * Errors:    a failed check ends the test
 */
#ifndef TESTS_OBJ_TEXTS_H
#define TESTS_OBJ_TEXTS_H

#include <stdlib.h>
#include <string.h>

#include "read/obj.h"
#include "tests/unit/check.h"

/* Tests add faces to this unit square of four vertices. */
#define SQUARE "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\n"

struct loaded {
    struct scene scene;
    struct warnings report;
    struct error err;
    bool ok;
};

static inline struct loaded load_bytes(const char *text, size_t size_bytes)
{
    struct loaded l = {.ok = false};
    char *copy = malloc(size_bytes == 0 ? 1 : size_bytes);

    /* The copy has the exact size, so that a sanitizer finds reads behind
     * it. */
    assert_non_null(copy);
    memcpy(copy, text, size_bytes);
    l.ok = obj_parse(&l.scene, copy, size_bytes, "a.obj", &l.report, &l.err);
    free(copy);
    return l;
}

static inline struct loaded load(const char *text)
{
    return load_bytes(text, strlen(text));
}

static inline void unload(struct loaded *l)
{
    scene_free(&l->scene);
    warnings_free(&l->report);
}

static inline struct loaded load_good(const char *text, uint32_t tri_count)
{
    struct loaded l = load(text);

    if (!l.ok)
        print_error("%s\n", l.err.text);
    assert_true(l.ok);
    assert_int_equal(l.scene.tri_count, tri_count);
    return l;
}

/* Checks that there are no warnings. */
static inline void check_clean(const char *text, uint32_t tri_count)
{
    struct loaded l = load_good(text, tri_count);

    if (l.report.entry_count > 0)
        print_error("%s\n", l.report.entries[0].text);
    assert_int_equal(l.report.entry_count, 0);
    unload(&l);
}

static inline void check_refused(const char *text, const char *message)
{
    struct loaded l = load(text);

    assert_false(l.ok);
    assert_string_equal(l.err.text, message);
    unload(&l);
}

/* Checks that this kind of warning has this text and this count. */
static inline void check_warned(const char *text, uint32_t tri_count,
                                const char *message, uint64_t count)
{
    struct loaded l = load_good(text, tri_count);

    assert_int_equal(l.report.entry_count, 1);
    assert_string_equal(l.report.entries[0].text, message);
    assert_int_equal(l.report.entries[0].count, count);
    unload(&l);
}

#endif
