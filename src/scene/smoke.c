// SPDX-License-Identifier: MIT
#include "scene/smoke.h"

#include <stdlib.h>
#include <string.h>

const struct smoke_numbers smoke_defaults = {.kelvin = 1,
                                             .glow = 1,
                                             .scale = 1};

bool smoke_has_box(const struct smoke_numbers *s)
{
    return s->box[0] < s->box[3];
}

static void smoke_free(struct smoke *s)
{
    free(s->path);
    free(s->grid);
    free(s->temperature);
}

bool smokes_add(struct smokes *smokes, const struct smoke *smoke)
{
    struct smoke copy = *smoke;
    struct smoke *items =
        realloc(smokes->items, (smokes->count + 1ull) * sizeof *items);

    if (items != NULL)
        smokes->items = items;
    copy.path = strdup(smoke->path);
    copy.grid = strdup(smoke->grid);
    copy.temperature = strdup(smoke->temperature);
    if (items == NULL || copy.path == NULL || copy.grid == NULL ||
        copy.temperature == NULL) {
        smoke_free(&copy);
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

static bool smoke_equal(const struct smoke *a, const struct smoke *b)
{
    return strcmp(a->path, b->path) == 0 && strcmp(a->grid, b->grid) == 0 &&
           strcmp(a->temperature, b->temperature) == 0 &&
           a->up_is_z == b->up_is_z &&
           memcmp(&a->numbers, &b->numbers, sizeof a->numbers) == 0;
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
    for (uint32_t i = 0; i < smokes->count; i++)
        smoke_free(&smokes->items[i]);
    free(smokes->items);
    *smokes = (struct smokes){.count = 0};
}
