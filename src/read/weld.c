// SPDX-License-Identifier: MIT
#include "read/weld.h"

#include <stdlib.h>
#include <string.h>

#include "base/memory.h"

/* Fewest slots of a table. */
#define SLOTS_MIN 64

/* Returns the bits of a coordinate; -0 has those of 0. */
static uint64_t bits_of(double x)
{
    uint64_t bits;

    x += 0.0;
    memcpy(&bits, &x, sizeof bits);
    return bits;
}

/* Mixes three numbers by multiplication with odd constants, as in MurmurHash 3.
 * Coordinates of grids differ in few high bits, which the shifts bring down. */
static uint64_t hash_of(const double p[3])
{
    uint64_t h = bits_of(p[0]);

    h = (h ^ h >> 32) * 0xff51afd7ed558ccdu + bits_of(p[1]);
    h = (h ^ h >> 32) * 0xc4ceb9fe1a85ec53u + bits_of(p[2]);
    h = (h ^ h >> 32) * 0xff51afd7ed558ccdu;
    return h ^ h >> 32;
}

static bool is_same(const double a[3], const double b[3])
{
    return bits_of(a[0]) == bits_of(b[0]) && bits_of(a[1]) == bits_of(b[1]) &&
           bits_of(a[2]) == bits_of(b[2]);
}

/* Returns the slot of the position, which is free if the position is new. */
static uint32_t *find(const struct weld *w, const double *positions,
                      const double p[3])
{
    size_t i = (size_t)hash_of(p) & (w->slot_count - 1);

    while (w->slots[i] != 0 &&
           !is_same(positions + 3 * ((size_t)w->slots[i] - 1), p))
        i = (i + 1) & (w->slot_count - 1);
    return &w->slots[i];
}

bool weld_init(struct weld *w, size_t count)
{
    *w = (struct weld){.slot_count = SLOTS_MIN};
    while (w->slot_count < 2 * count)
        w->slot_count *= 2;
    w->slots = alloc_array(w->slot_count, sizeof *w->slots);
    return w->slots != NULL;
}

/* Doubles the table. */
static bool grow(struct weld *w, const double *positions)
{
    struct weld larger;

    if (!weld_init(&larger, w->slot_count))
        return false;
    for (size_t i = 0; i < w->slot_count; i++)
        if (w->slots[i] != 0)
            *find(&larger, positions,
                  positions + 3 * ((size_t)w->slots[i] - 1)) = w->slots[i];
    larger.count = w->count;
    free(w->slots);
    *w = larger;
    return true;
}

bool weld_add(struct weld *w, const double *positions, uint32_t index,
              uint32_t *place)
{
    uint32_t *slot = find(w, positions, positions + 3 * (size_t)index);

    if (*slot != 0) {
        *place = *slot - 1;
        return true;
    }
    *place = index;
    *slot = index + 1;
    return ++w->count <= w->slot_count / 2 || grow(w, positions);
}

void weld_free(struct weld *w)
{
    free(w->slots);
    *w = (struct weld){.slots = NULL};
}
