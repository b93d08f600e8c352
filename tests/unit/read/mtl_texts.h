// SPDX-License-Identifier: MIT
/*
 * mtl_texts.h - MTL texts that are read and rewritten
 *
 * Ownership: unload() frees what load() has read
 * Threads:   one
 * Errors:    a failure ends the test
 */
#ifndef TESTS_MTL_TEXTS_H
#define TESTS_MTL_TEXTS_H

#include <stdlib.h>

#include "read/mtl.h"
#include "read/mtl_save.h"
#include "tests/unit/check.h"

struct loaded {
    struct scene scene;
    struct warnings report;
};

static inline void load(struct loaded *l, const char *path, const char *text,
                        size_t size_bytes)
{
    struct error err;

    *l = (struct loaded){.scene = {.path = NULL}};
    check_or_say(mtl_parse(&l->scene, text, size_bytes, path, &l->report, &err),
                 err.text);
}

static inline void unload(struct loaded *l)
{
    scene_free(&l->scene);
    warnings_free(&l->report);
}

/* Returns the new text with a NUL behind it, for free(). */
static inline char *rewrite(const struct scene *scene, const char *path,
                            const char *text, size_t size_bytes,
                            const struct mtl_change *changes, size_t count,
                            size_t *new_size_bytes)
{
    struct error err;
    char *new_text;

    check_or_say(mtl_rewrite(scene,
                             &(struct file_bytes){path, text, size_bytes},
                             (struct mtl_changes){changes, count}, &new_text,
                             new_size_bytes, &err),
                 err.text);
    new_text = realloc(new_text, *new_size_bytes + 1);
    assert_non_null(new_text);
    new_text[*new_size_bytes] = '\0';
    return new_text;
}

static inline struct mtl_number number(double value)
{
    return (struct mtl_number){value, 1};
}

static inline struct mtl_color color(double r, double g, double b)
{
    return (struct mtl_color){{r, g, b}, 1};
}

#endif
