// SPDX-License-Identifier: MIT
#include "scene/mtl_source.h"

#include <math.h>

#include "image/color.h"
#include "kernels/types.h"

#define MEMBER(name) offsetof(struct mtl_source, name)

const struct mtl_property mtl_properties[MTL_PROPERTIES] = {
    {"Kd", MEMBER(kd), true},
    {"Ks", MEMBER(ks), true},
    {"Tf", MEMBER(tf), true},
    {"Ka", MEMBER(ka), true},
    {"Tf_attenuation", MEMBER(tf_attenuation), true},
    {"Ps_color", MEMBER(ps_color), true},
    {"illum", MEMBER(illum), false},
    {"Ns", MEMBER(ns), false},
    {"Ni", MEMBER(ni), false},
    {"d", MEMBER(d), false},
    {"Tr", MEMBER(tr), false},
    {"Pr", MEMBER(pr), false},
    {"Pm", MEMBER(pm), false},
    {"Pc", MEMBER(pc), false},
    {"Pcr", MEMBER(pcr), false},
    {"Kd_roughness", MEMBER(kd_roughness), false},
    {"Ps", MEMBER(ps), false},
    {"aniso", MEMBER(aniso), false},
    {"anisor", MEMBER(anisor), false},
    {"Tf_distance", MEMBER(tf_distance), false},
    {"Tf_thin", MEMBER(tf_thin), false},
    {"Ps_roughness", MEMBER(ps_roughness), false},
    {"Pf", MEMBER(pf), false},
    {"Pf_ior", MEMBER(pf_ior), false},
    {"Pf_thickness", MEMBER(pf_thickness), false},
    {"Pf_thinnest", MEMBER(pf_thinnest), false},
    {"d_cutoff", MEMBER(d_cutoff), false},
    {"Ks_full", MEMBER(ks_full), false},
};

const char *const mtl_map_keys[MTL_MAPS] = {
    [MTL_MAP_KD] = "map_Kd",
    [MTL_MAP_KS] = "map_Ks",
    [MTL_MAP_KE] = "map_Ke",
    [MTL_MAP_PR] = "map_Pr",
    [MTL_MAP_PM] = "map_Pm",
    [MTL_MAP_D] = "map_d",
    [MTL_MAP_TF] = "map_Tf",
    [MTL_MAP_PC] = "map_Pc",
    [MTL_MAP_PCR] = "map_Pcr",
    [MTL_MAP_PS] = "map_Ps",
    [MTL_MAP_PS_COLOR] = "map_Ps_color",
    [MTL_MAP_PS_ROUGHNESS] = "map_Ps_roughness",
    [MTL_MAP_KS_WEIGHT] = "map_Ks_weight",
    [MTL_MAP_PF] = "map_Pf",
    [MTL_MAP_PF_THICKNESS] = "map_Pf_thickness",
    [MTL_MAP_GRAIN] = "map_grain",
    [MTL_MAP_PC_NORM] = "map_Pc_norm",
    [MTL_MAP_NORM] = "norm",
    [MTL_MAP_BUMP] = "map_Bump",
};

struct mtl_source mtl_source_empty(void)
{
    struct mtl_source s = {.dialect = MTL_CLASSIC};

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
                           const struct mtl_source *a,
                           const struct mtl_source *b)
{
    const void *in_a = (const char *)a + p->member;
    const void *in_b = (const char *)b + p->member;

    return p->is_color ? mtl_color_equal(in_a, in_b)
                       : mtl_number_equal(in_a, in_b);
}

bool mtl_source_equal(const struct mtl_source *a, const struct mtl_source *b)
{
    for (int i = 0; i < MTL_MAPS; i++)
        if (a->maps[i] != b->maps[i] || a->map_scales[i] != b->map_scales[i])
            return false;
    for (int i = 0; i < MTL_PROPERTIES; i++)
        if (!property_equal(&mtl_properties[i], a, b))
            return false;
    return a->dialect == b->dialect && a->maps_off == b->maps_off &&
           mtl_color_equal(&a->ke, &b->ke) &&
           mtl_number_equal(&a->kelvin, &b->kelvin) &&
           mtl_number_equal(&a->luminance, &b->luminance);
}

uint32_t mtl_source_map(const struct mtl_source *s, enum mtl_map map)
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

struct mtl_source mtl_source_with_factors(const struct mtl_source *source)
{
    struct mtl_source s = *source;
    const struct {
        enum mtl_map map;
        struct mtl_number *factor;
    } numbers[] = {
        {MTL_MAP_PR, &s.pr},
        {MTL_MAP_PM, &s.pm},
        {MTL_MAP_PC, &s.pc},
        {MTL_MAP_PCR, &s.pcr},
        {MTL_MAP_PS, &s.ps},
        {MTL_MAP_PS_COLOR, &s.ps},
        {MTL_MAP_PS_ROUGHNESS, &s.ps_roughness},
        {MTL_MAP_PF, &s.pf},
    };
    struct mtl_color light = mtl_source_light(&s);

    for (size_t i = 0; i < sizeof numbers / sizeof numbers[0]; i++)
        if (mtl_source_map(&s, numbers[i].map) != NO_INDEX)
            imply_number(numbers[i].factor, numbers[i].factor == &s.pc
                                                ? mtl_source_full_coat(&s)
                                                : 1);
    if (mtl_source_map(&s, MTL_MAP_KD) != NO_INDEX)
        imply_color(&s.kd, mtl_color_is_black(&s.kd));
    if (mtl_source_map(&s, MTL_MAP_KS) != NO_INDEX)
        imply_color(&s.ks, mtl_color_is_black(&s.ks));
    if (mtl_source_map(&s, MTL_MAP_TF) != NO_INDEX)
        imply_color(&s.tf, s.tf.line == 0);
    if (mtl_source_map(&s, MTL_MAP_KE) != NO_INDEX &&
        mtl_color_is_black(&light)) {
        s.kelvin = s.luminance = (struct mtl_number){.line = 0};
        imply_color(&s.ke, true);
    }
    return s;
}

struct mtl_color mtl_source_light(const struct mtl_source *s)
{
    struct mtl_color light = {.line = s->kelvin.line};
    double kelvin = s->kelvin.value;

    if (s->kelvin.line == 0)
        return s->ke;
    if (!(kelvin >= BLACKBODY_LEAST && kelvin <= BLACKBODY_GREATEST))
        return light;
    blackbody_rgb(kelvin, light.rgb);
    for (int i = 0; i < 3; i++)
        light.rgb[i] *= s->luminance.value;
    return light;
}

double *mtl_source_map_scale(struct mtl_source *s, enum mtl_map map)
{
    return map == MTL_MAP_BUMP || map == MTL_MAP_NORM || map == MTL_MAP_PC_NORM
               ? &s->map_scales[map]
               : NULL;
}

double mtl_source_full_coat(const struct mtl_source *s)
{
    return s->dialect != MTL_CLASSIC ? 4 : 1;
}

bool mtl_source_is_mirror(const struct mtl_source *s)
{
    return s->dialect == MTL_CLASSIC &&
           (s->illum.value == 3 || s->illum.value == 5) && s->pm.line == 0 &&
           mtl_source_map(s, MTL_MAP_PM) == NO_INDEX;
}
