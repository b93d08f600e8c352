// SPDX-License-Identifier: MIT
#include "scene/material_values.h"

#include <float.h>
#include <inttypes.h>
#include <math.h>

#include "image/color.h"
#include "kernels/types.h"

#define COLOR(member, key) \
    {key, offsetof(struct material_values, member), true},
#define NUMBER(member, key) \
    {key, offsetof(struct material_values, member), false},

const struct mtl_property mtl_properties[MTL_PROPERTIES] = {
    MTL_PROPERTY_LIST(COLOR, NUMBER)};

#define FACTOR(member)                          offsetof(struct material_values, member)
#define KEYS(...)                               {__VA_ARGS__}, false
#define KEY_OR_BLENDER(...)                     {__VA_ARGS__}, true
#define MAP(name, member, is_data, factor, ...) {is_data, factor, __VA_ARGS__},
#define INSTEAD(name, is_data, factor, ...)     {is_data, factor, __VA_ARGS__},

const struct mtl_map_kind mtl_maps[MTL_MAPS] = {
    MATERIAL_MAP_LIST(MAP, INSTEAD)};

struct material_values material_values_empty(void)
{
    struct material_values s = {.dialect = MTL_CLASSIC};

    for (int i = 0; i < MTL_MAPS; i++) {
        s.maps[i] = NO_INDEX;
        s.map_scales[i] = 1;
    }
    return s;
}

/* Compares two numbers. NaN equals NaN. */
static bool values_equal(double a, double b)
{
    return a == b || (isnan(a) && isnan(b));
}

bool mtl_number_equal(const struct mtl_number *a, const struct mtl_number *b)
{
    return (a->line == 0) == (b->line == 0) &&
           (a->line == 0 || values_equal(a->value, b->value));
}

bool mtl_color_equal(const struct mtl_color *a, const struct mtl_color *b)
{
    return (a->line == 0) == (b->line == 0) &&
           (a->line == 0 || (values_equal(a->rgb[0], b->rgb[0]) &&
                             values_equal(a->rgb[1], b->rgb[1]) &&
                             values_equal(a->rgb[2], b->rgb[2])));
}

static bool property_equal(const struct mtl_property *p,
                           const struct material_values *a,
                           const struct material_values *b)
{
    const void *in_a = (const char *)a + p->member;
    const void *in_b = (const char *)b + p->member;

    return p->is_color ? mtl_color_equal(in_a, in_b)
                       : mtl_number_equal(in_a, in_b);
}

bool material_values_equal(const struct material_values *a,
                           const struct material_values *b)
{
    for (int i = 0; i < MTL_MAPS; i++)
        if (a->maps[i] != b->maps[i] || a->map_scales[i] != b->map_scales[i])
            return false;
    for (int i = 0; i < MTL_PROPERTIES; i++)
        if (!property_equal(&mtl_properties[i], a, b))
            return false;
    return a->dialect == b->dialect && a->maps_off == b->maps_off &&
           mtl_color_equal(&a->emission, &b->emission) &&
           mtl_number_equal(&a->kelvin, &b->kelvin) &&
           mtl_number_equal(&a->luminance, &b->luminance);
}

uint32_t material_values_map(const struct material_values *s, enum mtl_map map)
{
    return (s->maps_off >> map & 1) != 0 ? NO_INDEX : s->maps[map];
}

bool mtl_color_is_black(const struct mtl_color *c)
{
    return !(c->rgb[0] > 0) && !(c->rgb[1] > 0) && !(c->rgb[2] > 0);
}

static void imply_color(struct mtl_color *c, bool is_implied)
{
    if (is_implied)
        *c = (struct mtl_color){{1, 1, 1}, MTL_IMPLIED};
}

static void imply_number(struct mtl_number *n, double value)
{
    if (n->line == 0)
        *n = (struct mtl_number){value, MTL_IMPLIED};
}

struct material_values
material_values_with_factors(const struct material_values *source)
{
    struct material_values s = *source;
    struct mtl_color light = material_values_light(&s);

    for (int i = 0; i < MTL_MAPS; i++) {
        void *factor = (char *)&s + mtl_maps[i].factor;

        if (mtl_maps[i].factor != 0 &&
            material_values_map(&s, (enum mtl_map)i) != NO_INDEX)
            imply_number(factor,
                         factor == &s.coat ? material_values_full_coat(&s) : 1);
    }
    if (material_values_map(&s, MTL_MAP_COLOR) != NO_INDEX)
        imply_color(&s.base_color, mtl_color_is_black(&s.base_color));
    if (material_values_map(&s, MTL_MAP_SPECULAR) != NO_INDEX)
        imply_color(&s.specular_color, mtl_color_is_black(&s.specular_color));
    if (material_values_map(&s, MTL_MAP_TRANSMISSION) != NO_INDEX)
        imply_color(&s.transmission, s.transmission.line == 0);
    if (material_values_map(&s, MTL_MAP_BACK_COLOR) != NO_INDEX)
        imply_color(&s.back_color, s.back_color.line == 0);
    if (s.back_color.line != 0)
        imply_number(&s.translucency, 1);
    if (material_values_map(&s, MTL_MAP_EMISSION) != NO_INDEX &&
        mtl_color_is_black(&light)) {
        s.kelvin = s.luminance = (struct mtl_number){.line = 0};
        imply_color(&s.emission, true);
    }
    return s;
}

struct mtl_color material_values_light(const struct material_values *s)
{
    struct mtl_color light = {.line = s->kelvin.line};
    double kelvin = s->kelvin.value;

    if (s->kelvin.line == 0)
        return s->emission;
    if (!(kelvin >= BLACKBODY_MIN && kelvin <= BLACKBODY_MAX))
        return light;
    blackbody_rgb(kelvin, light.rgb);
    for (int i = 0; i < 3; i++)
        light.rgb[i] *= s->luminance.value;
    return light;
}

double *material_values_map_scale(struct material_values *s, enum mtl_map map)
{
    return map == MTL_MAP_BUMP || map == MTL_MAP_NORMAL ||
                   map == MTL_MAP_COAT_NORMAL
               ? &s->map_scales[map]
               : NULL;
}

double material_values_full_coat(const struct material_values *s)
{
    return s->dialect != MTL_CLASSIC ? 4 : 1;
}

bool material_values_is_mirror(const struct material_values *s)
{
    return s->dialect == MTL_CLASSIC &&
           (s->illum.value == 3 || s->illum.value == 5) &&
           s->metalness.line == 0 &&
           material_values_map(s, MTL_MAP_METALNESS) == NO_INDEX;
}

/* ---- checks ---- */

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

struct vec3 statement_amounts(const struct mtl_color *c, const char *key,
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
        warnings_add(at->report, "colours out of range",
                     "%s:%" PRIu64 ": found %s %g %g %g, expected numbers of "
                     "at least 0: others taken as 0",
                     at->path, c->line, key, c->rgb[0], c->rgb[1], c->rgb[2]);
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
