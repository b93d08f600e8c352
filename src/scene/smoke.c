// SPDX-License-Identifier: MIT
#include "scene/smoke.h"

#include <stdlib.h>
#include <string.h>

bool smokes_add(struct smokes *smokes, const struct smoke *smoke)
{
    struct smoke copy = *smoke;
    struct smoke *items =
        realloc(smokes->items, (smokes->count + 1ull) * sizeof *items);

    if (items != NULL)
        smokes->items = items;
    copy.path = strdup(smoke->path);
    copy.grid = strdup(smoke->grid);
    if (items == NULL || copy.path == NULL || copy.grid == NULL) {
        free(copy.path);
        free(copy.grid);
        return false;
    }
    smokes->items[smokes->count++] = copy;
    return true;
}

bool smokes_copy(struct smokes *to, const struct smokes *from)
{
    struct smokes copy = {.count = 0};

    for (uint32_t i = 0; i < from->count; i++) {
        if (smokes_add(&copy, &from->items[i]))
            continue;
        smokes_free(&copy);
        return false;
    }
    smokes_free(to);
    *to = copy;
    return true;
}

static bool are_same(const double a[3], const double b[3])
{
    return a[0] == b[0] && a[1] == b[1] && a[2] == b[2];
}

static bool smoke_equal(const struct smoke *a, const struct smoke *b)
{
    return strcmp(a->path, b->path) == 0 && strcmp(a->grid, b->grid) == 0 &&
           are_same(a->scatter, b->scatter) && are_same(a->absorb, b->absorb) &&
           a->anisotropy == b->anisotropy && are_same(a->at, b->at) &&
           a->scale == b->scale;
}

bool smokes_equal(const struct smokes *a, const struct smokes *b)
{
    if (a->count != b->count)
        return false;
    for (uint32_t i = 0; i < a->count; i++)
        if (!smoke_equal(&a->items[i], &b->items[i]))
            return false;
    return true;
}

void smokes_free(struct smokes *smokes)
{
    for (uint32_t i = 0; i < smokes->count; i++) {
        free(smokes->items[i].path);
        free(smokes->items[i].grid);
    }
    free(smokes->items);
    *smokes = (struct smokes){.count = 0};
}
