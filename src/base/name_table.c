// SPDX-License-Identifier: MIT
#include "base/name_table.h"

#include <stdlib.h>
#include <string.h>

#include "base/memory.h"

/* Returns the FNV-1a hash, which is fast for short names. */
static uint32_t hash(const char *name)
{
    uint32_t h = 2166136261u;

    for (; *name != '\0'; name++)
        h = (h ^ (unsigned char)*name) * 16777619u;
    return h ^ h >> 15;
}

/* Returns the slot of the name, or the free slot where it belongs. The table is
 * never full. */
static uint32_t *slot_of(const struct name_table *names, const char *name)
{
    uint32_t mask = names->slot_count - 1;
    uint32_t i = hash(name) & mask;

    while (names->slots[i] != 0 &&
           strcmp(names->items[names->slots[i] - 1], name) != 0)
        i = (i + 1) & mask;
    return &names->slots[i];
}

static bool grow_slots(struct name_table *names)
{
    uint32_t old_count = names->slot_count;
    uint32_t *old = names->slots;
    uint32_t count = old_count == 0 ? 16 : 2 * old_count;
    uint32_t *slots =
        count > old_count ? alloc_array(count, sizeof *slots) : NULL;

    if (slots == NULL)
        return false;
    names->slots = slots;
    names->slot_count = count;
    for (uint32_t i = 0; i < names->count; i++)
        *slot_of(names, names->items[i]) = i + 1;
    free(old);
    return true;
}

uint32_t name_table_find(const struct name_table *names, const char *name)
{
    uint32_t slot = names->slot_count == 0 ? 0 : *slot_of(names, name);

    return slot == 0 ? NO_NAME : slot - 1;
}

uint32_t name_table_add(struct name_table *names, const char *name)
{
    uint32_t found = name_table_find(names, name);
    void *items = names->items;
    char *copy;

    if (found != NO_NAME)
        return found;
    if (names->count >= names->slot_count / 2 && !grow_slots(names))
        return NO_NAME;
    if (!grow_array(&items, &names->capacity, (size_t)names->count + 1,
                    sizeof *names->items))
        return NO_NAME;
    names->items = items;
    copy = strdup(name);
    if (copy == NULL)
        return NO_NAME;
    *slot_of(names, name) = names->count + 1;
    names->items[names->count] = copy;
    return names->count++;
}

void name_table_free(struct name_table *names)
{
    for (uint32_t i = 0; i < names->count; i++)
        free(names->items[i]);
    free(names->items);
    free(names->slots);
    memset(names, 0, sizeof *names);
}
