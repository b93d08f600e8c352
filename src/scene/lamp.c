// SPDX-License-Identifier: MIT
#include "scene/lamp.h"

#include <float.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "base/geometry.h"
#include "base/memory.h"

/* ---- profiles ---- */

struct profile *profile_create(const char *path, uint32_t columns)
{
    struct profile *p = calloc(1, sizeof *p);

    if (p == NULL)
        return NULL;
    atomic_init(&p->references, 1);
    p->columns = columns;
    p->path = strdup(path);
    p->values = alloc_array(profile_value_count(p), sizeof *p->values);
    if (p->path == NULL || p->values == NULL) {
        profile_release(p);
        return NULL;
    }
    return p;
}

struct profile *profile_share(struct profile *p)
{
    if (p != NULL)
        atomic_fetch_add(&p->references, 1);
    return p;
}

void profile_release(struct profile *p)
{
    if (p == NULL || atomic_fetch_sub(&p->references, 1) > 1)
        return;
    free(p->values);
    free(p->path);
    free(p);
}

bool profiles_equal(const struct profile *a, const struct profile *b)
{
    if (a == b || a == NULL || b == NULL)
        return a == b;
    return a->columns == b->columns && strcmp(a->path, b->path) == 0 &&
           memcmp(a->values, b->values,
                  profile_value_count(a) * sizeof *a->values) == 0;
}

struct profile *profile_create_even(const char *path)
{
    struct profile *p = profile_create(path, 1);

    for (uint32_t i = 0; p != NULL && i < profile_value_count(p); i++)
        p->values[i] = 1;
    return p;
}

/* ---- lamps ---- */

/* Luminous efficacy in Blender's files, lm/W: that of green light. */
#define LUMENS_OF_WATT 683.0

const char *const light_units[LIGHT_UNITS] = {
    [LIGHT_UNIT_OF_FILE] = "auto",
    [LIGHT_UNIT_LUMEN] = "lumen",
    [LIGHT_UNIT_WATT] = "watt",
    [LIGHT_UNIT_NONE] = "none",
};

double light_unit_factor(enum light_unit unit, bool is_directional)
{
    if (unit == LIGHT_UNIT_LUMEN)
        return 1 / LUMENS_OF_WATT;
    return unit == LIGHT_UNIT_WATT && !is_directional ? 1 / (4 * M_PI) : 1;
}

void lamp_init(struct lamp *lamp, enum lamp_kind kind)
{
    memset(lamp, 0, sizeof *lamp); /* for lamps_equal() */
    lamp->kind = kind;
    for (int i = 0; i < 3; i++)
        lamp->rgb[i] = 1;
    lamp->outer_deg = 45;
}

void lamp_direction(const struct lamp *lamp, double to[3])
{
    double azimuth = angle_rad(lamp->azimuth_deg);
    double elevation = angle_rad(lamp->elevation_deg);

    to[0] = sin(azimuth) * cos(elevation);
    to[1] = sin(elevation);
    to[2] = -cos(azimuth) * cos(elevation);
}

void lamp_set_direction(struct lamp *lamp, const double to[3])
{
    lamp->azimuth_deg = angle_deg(atan2(to[0], -to[2]));
    lamp->elevation_deg = angle_deg(atan2(to[1], hypot(to[0], to[2])));
}

bool lamps_add(struct lamps *lamps, const struct lamp *lamp)
{
    struct lamp *items = realloc(lamps->items, ((size_t)lamps->count + 1) *
                                                   sizeof *lamps->items);

    if (items == NULL)
        return false;
    lamps->items = items;
    profile_share(lamp->profile);
    lamps->items[lamps->count++] = *lamp;
    return true;
}

void lamps_change_unit(struct lamps *lamps, enum light_unit from,
                       enum light_unit to)
{
    for (uint32_t i = 0; i < lamps->count; i++) {
        struct lamp *lamp = &lamps->items[i];
        bool is_sun = lamp->kind == LAMP_DIRECTIONAL;
        double factor =
            light_unit_factor(to, is_sun) / light_unit_factor(from, is_sun);

        for (int k = 0; k < 3; k++)
            lamp->rgb[k] = fmin(lamp->rgb[k] * factor, FLT_MAX);
    }
}

void lamps_remove(struct lamps *lamps, uint32_t i)
{
    profile_release(lamps->items[i].profile);
    lamps->count--;
    memmove(&lamps->items[i], &lamps->items[i + 1],
            (lamps->count - i) * sizeof *lamps->items);
}

bool lamp_equal(const struct lamp *a, const struct lamp *b)
{
    struct lamp x, y;

    /* copies with the padding */
    memcpy(&x, a, sizeof x);
    memcpy(&y, b, sizeof y);
    x.profile = y.profile = NULL;
    return memcmp(&x, &y, sizeof x) == 0 &&
           profiles_equal(a->profile, b->profile);
}

bool lamps_equal(const struct lamps *a, const struct lamps *b)
{
    bool equal = a->count == b->count;

    for (uint32_t i = 0; i < a->count && equal; i++)
        equal = lamp_equal(&a->items[i], &b->items[i]);
    return equal;
}

bool lamps_copy(struct lamps *to, const struct lamps *from)
{
    struct lamp *items = alloc_array(from->count, sizeof *items);

    if (items == NULL)
        return false;
    if (from->count > 0)
        memcpy(items, from->items, from->count * sizeof *items);
    for (uint32_t i = 0; i < from->count; i++)
        profile_share(items[i].profile);
    lamps_free(to);
    *to = (struct lamps){items, from->count};
    return true;
}

void lamps_free(struct lamps *lamps)
{
    for (uint32_t i = 0; i < lamps->count; i++)
        profile_release(lamps->items[i].profile);
    free(lamps->items);
    *lamps = (struct lamps){.items = NULL};
}
