// SPDX-License-Identifier: MIT
#include "world/world_list.h"

#include <stddef.h>
#include <string.h>

#include "world/light/guide_grid.h"
#include "kernels/sky.h"

_Static_assert(sizeof(struct world) - offsetof(struct world, positions) ==
                   WORLD_LIST_COUNT * sizeof(void *),
               "WORLD_LIST has all arrays");

void world_list(const struct world *w,
                struct world_array list[WORLD_LIST_COUNT])
{
    const struct settings *s = &w->settings;
    size_t i = 0;

#define TAKE(name, count, part_of)                                           \
    list[i++] = (struct world_array){w->name,                                \
                                     w->name != NULL                         \
                                         ? (size_t)(count) * sizeof *w->name \
                                         : 0,                                \
                                     part_of};
    WORLD_LIST(TAKE)
#undef TAKE
}

void world_list_set(struct world *world, enum world_list_index index,
                    const void *data)
{
#define MEMBER(name, count, part) offsetof(struct world, name),
    static const size_t members[] = {WORLD_LIST(MEMBER)};
#undef MEMBER

    memcpy((char *)world + members[index], &data, sizeof data);
}
