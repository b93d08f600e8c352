// SPDX-License-Identifier: MIT
#include "scene/statement.h"

#include <float.h>
#include <inttypes.h>

double statement_clamped(double x)
{
    if (!(x > 0))
        return 0;
    return x < 1 ? x : 1;
}

struct vec3 statement_reflectance(const struct mtl_color *c, const char *key,
                                  float missing,
                                  const struct statement_place *at)
{
    double rgb[3];
    bool is_clamped = false;

    if (c->line == 0)
        return (struct vec3){missing, missing, missing};
    for (int i = 0; i < 3; i++) {
        rgb[i] = statement_clamped(c->rgb[i]);
        is_clamped |= !(rgb[i] == c->rgb[i]);
    }
    if (is_clamped)
        warnings_add(at->report, "colours outside 0 to 1",
                     "%s:%" PRIu64
                     ": found %s %g %g %g, expected numbers from 0 "
                     "to 1: clamped",
                     at->path, c->line, key, c->rgb[0], c->rgb[1], c->rgb[2]);
    return (struct vec3){(float)rgb[0], (float)rgb[1], (float)rgb[2]};
}

struct vec3 statement_radiance(const struct mtl_color *c,
                               const struct statement_place *at)
{
    float rgb[3] = {0, 0, 0};
    bool is_changed = false;

    for (int i = 0; i < 3 && c->line != 0; i++) {
        if (c->rgb[i] >= 0 && c->rgb[i] <= (double)FLT_MAX)
            rgb[i] = (float)c->rgb[i];
        else
            is_changed = true;
    }
    if (is_changed)
        warnings_add(at->report, "radiances out of range",
                     "%s:%" PRIu64 ": found Ke %g %g %g, expected numbers of "
                     "at least 0: others taken as 0",
                     at->path, c->line, c->rgb[0], c->rgb[1], c->rgb[2]);
    return (struct vec3){rgb[0], rgb[1], rgb[2]};
}

double statement_within(const struct mtl_number *n, const char *key, double lo,
                        double hi, double missing,
                        const struct statement_place *at)
{
    if (n->line == 0)
        return missing;
    if (n->value >= lo && n->value <= hi)
        return n->value;
    warnings_add(at->report, "material values out of range",
                 "%s:%" PRIu64
                 ": found %s %g, expected a number from %g to %g: "
                 "taken as %g",
                 at->path, n->line, key, n->value, lo, hi, missing);
    return missing;
}

double statement_unit(const struct mtl_number *n, const char *key,
                      const struct statement_place *at)
{
    return statement_within(n, key, 0, 1, statement_clamped(n->value), at);
}
