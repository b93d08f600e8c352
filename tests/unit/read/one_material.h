// SPDX-License-Identifier: MIT
/*
 * one_material.h - materials of short MTL texts
 *
 * Ownership: unload() frees what load() has read
 * Threads:   one
 * Errors:    a failure ends the test
 */
#ifndef TESTS_ONE_MATERIAL_H
#define TESTS_ONE_MATERIAL_H

#include <stdlib.h>
#include <string.h>

#include "read/mtl.h"
#include "tests/unit/check.h"

struct loaded {
    struct scene scene;
    struct warnings report;
    struct error err;
    bool ok;
};

static inline struct loaded load(const char *text)
{
    struct loaded l = {.ok = false};
    size_t size_bytes = strlen(text);
    char *copy = malloc(size_bytes == 0 ? 1 : size_bytes);

    assert_non_null(copy);
    memcpy(copy, text, size_bytes);
    l.ok = mtl_parse(&l.scene, copy, size_bytes, "a.mtl", &l.report, &l.err);
    free(copy);
    return l;
}

static inline void unload(struct loaded *l)
{
    scene_free(&l->scene);
    warnings_free(&l->report);
}

/* Returns the material "m" of these statements, which give this many kinds of
 * warnings. */
static inline struct material only_material(const char *statements,
                                            int warnings)
{
    struct material m;
    char text[1024];
    struct loaded l;
    uint32_t index;

    snprintf(text, sizeof text, "newmtl m\n%s\n", statements);
    l = load(text);
    if (!l.ok)
        print_error("%s\n", l.err.text);
    assert_true(l.ok);
    for (int i = warnings; i < l.report.entry_count; i++)
        print_error("%s\n", l.report.entries[i].text);
    assert_int_equal(l.report.entry_count, warnings);
    index = mtl_find(&l.scene, "m");
    assert_int_not_equal(index, NO_INDEX);
    m = l.scene.materials[index];
    unload(&l);
    return m;
}

static inline void check_color(struct vec3 c, double r, double g, double b)
{
    check_close((double)c.x, r, 1e-7);
    check_close((double)c.y, g, 1e-7);
    check_close((double)c.z, b, 1e-7);
}

#endif
