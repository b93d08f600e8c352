// SPDX-License-Identifier: MIT
#include "scene/material_values.h"

#include <float.h>
#include <inttypes.h>
#include <math.h>

#include "image/color.h"
#include "kernels/types.h"

#define MEMBER(name) offsetof(struct material_values, name)

const struct mtl_property mtl_properties[MTL_PROPERTIES] = {
    {"Kd", MEMBER(base_color), true},
    {"Ks", MEMBER(specular_color), true},
    {"Tf", MEMBER(transmission), true},
    {"Ka", MEMBER(ambient), true},
    {"Tf_attenuation", MEMBER(attenuation), true},
    {"Ps_color", MEMBER(sheen_color), true},
    {"illum", MEMBER(illum), false},
    {"Ns", MEMBER(shininess), false},
    {"Ni", MEMBER(ior), false},
    {"d", MEMBER(opacity), false},
    {"Tr", MEMBER(transparency), false},
    {"Pr", MEMBER(roughness), false},
    {"Pm", MEMBER(metalness), false},
    {"Pc", MEMBER(coat), false},
    {"Pcr", MEMBER(coat_roughness), false},
    {"Kd_roughness", MEMBER(diffuse_roughness), false},
    {"Ps", MEMBER(sheen), false},
    {"aniso", MEMBER(anisotropy), false},
    {"anisor", MEMBER(anisotropy_rotation), false},
    {"Tf_distance", MEMBER(attenuation_distance), false},
    {"Tf_thin", MEMBER(thinness), false},
    {"Ps_roughness", MEMBER(sheen_roughness), false},
    {"Pf", MEMBER(film), false},
    {"Pf_ior", MEMBER(film_ior), false},
    {"Pf_thickness", MEMBER(film_thickness), false},
    {"Pf_thinnest", MEMBER(film_thinnest), false},
    {"d_cutoff", MEMBER(cutoff), false},
    {"Ks_full", MEMBER(specular_scale), false},
};

const char *const mtl_map_keys[MTL_MAPS] = {
    [MTL_MAP_COLOR] = "map_Kd",
    [MTL_MAP_SPECULAR] = "map_Ks",
    [MTL_MAP_EMISSION] = "map_Ke",
    [MTL_MAP_ROUGHNESS] = "map_Pr",
    [MTL_MAP_METALNESS] = "map_Pm",
    [MTL_MAP_OPACITY] = "map_d",
    [MTL_MAP_TRANSMISSION] = "map_Tf",
    [MTL_MAP_COAT] = "map_Pc",
    [MTL_MAP_COAT_ROUGHNESS] = "map_Pcr",
    [MTL_MAP_SHEEN] = "map_Ps",
    [MTL_MAP_SHEEN_COLOR] = "map_Ps_color",
    [MTL_MAP_SHEEN_ROUGHNESS] = "map_Ps_roughness",
    [MTL_MAP_SPECULAR_WEIGHT] = "map_Ks_weight",
    [MTL_MAP_FILM] = "map_Pf",
    [MTL_MAP_FILM_THICKNESS] = "map_Pf_thickness",
    [MTL_MAP_GRAIN] = "map_grain",
    [MTL_MAP_COAT_NORMAL] = "map_Pc_norm",
    [MTL_MAP_NORMAL] = "norm",
    [MTL_MAP_BUMP] = "map_Bump",
};

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
    const struct {
        enum mtl_map map;
        struct mtl_number *factor;
    } numbers[] = {
        {MTL_MAP_ROUGHNESS, &s.roughness},
        {MTL_MAP_METALNESS, &s.metalness},
        {MTL_MAP_COAT, &s.coat},
        {MTL_MAP_COAT_ROUGHNESS, &s.coat_roughness},
        {MTL_MAP_SHEEN, &s.sheen},
        {MTL_MAP_SHEEN_COLOR, &s.sheen},
        {MTL_MAP_SHEEN_ROUGHNESS, &s.sheen_roughness},
        {MTL_MAP_FILM, &s.film},
    };
    struct mtl_color light = material_values_light(&s);

    for (size_t i = 0; i < sizeof numbers / sizeof numbers[0]; i++)
        if (material_values_map(&s, numbers[i].map) != NO_INDEX)
            imply_number(numbers[i].factor, numbers[i].factor == &s.coat
                                                ? material_values_full_coat(&s)
                                                : 1);
    if (material_values_map(&s, MTL_MAP_COLOR) != NO_INDEX)
        imply_color(&s.base_color, mtl_color_is_black(&s.base_color));
    if (material_values_map(&s, MTL_MAP_SPECULAR) != NO_INDEX)
        imply_color(&s.specular_color, mtl_color_is_black(&s.specular_color));
    if (material_values_map(&s, MTL_MAP_TRANSMISSION) != NO_INDEX)
        imply_color(&s.transmission, s.transmission.line == 0);
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
    if (!(kelvin >= BLACKBODY_LEAST && kelvin <= BLACKBODY_GREATEST))
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
