// SPDX-License-Identifier: MIT
#include "scene/lamp.h"

#include <stdlib.h>
#include <string.h>

#include "base/memory.h"

void lamp_init(struct lamp *lamp, enum lamp_kind kind)
{
    memset(lamp, 0, sizeof *lamp); /* for lamps_equal() */
    lamp->kind = kind;
    for (int i = 0; i < 3; i++)
        lamp->rgb[i] = 1;
    lamp->outer_deg = 45;
}

bool lamps_add(struct lamps *lamps, const struct lamp *lamp)
{
    struct lamp *items = realloc(lamps->items, ((size_t)lamps->count + 1) *
                                                   sizeof *lamps->items);

    if (items == NULL)
        return false;
    lamps->items = items;
    lamps->items[lamps->count++] = *lamp;
    return true;
}

bool lamps_equal(const struct lamps *a, const struct lamps *b)
{
    return a->count == b->count &&
           (a->count == 0 ||
            memcmp(a->items, b->items, a->count * sizeof *a->items) == 0);
}

bool lamps_copy(struct lamps *to, const struct lamps *from)
{
    struct lamp *items = alloc_array(from->count, sizeof *items);

    if (items == NULL)
        return false;
    if (from->count > 0)
        memcpy(items, from->items, from->count * sizeof *items);
    free(to->items);
    *to = (struct lamps){items, from->count};
    return true;
}

void lamps_free(struct lamps *lamps)
{
    free(lamps->items);
    *lamps = (struct lamps){.items = NULL};
}
