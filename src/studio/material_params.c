// SPDX-License-Identifier: MIT
#include "studio/material_params.h"

#include <math.h>
#include <string.h>

#include "base/decimal.h"

/* An ordinary coat; see MATERIAL_COAT. */
#define COAT_USUAL 0.5

struct material material_params_material(const struct mtl_source *s)
{
    struct warnings report = {0};
    struct material m = material_from_source(s, "", &report);

    warnings_free(&report);
    return m;
}

bool material_params_is_glass(const struct material *m)
{
    return m->kind == MATERIAL_GLASS || m->kind == MATERIAL_THIN_GLASS;
}

static bool is_diffuse(const struct material *m)
{
    return m->kind == MATERIAL_DIFFUSE || m->kind == MATERIAL_ROUGH_DIFFUSE;
}

/* The kinds that a person chooses from: rough diffuse is diffuse. */
static const struct {
    uint32_t kind;
    const char *name;
} kinds[] = {
    {MATERIAL_DIFFUSE, "diffuse"},       {MATERIAL_PLASTIC, "plastic"},
    {MATERIAL_METAL, "metal"},           {MATERIAL_GLASS, "glass"},
    {MATERIAL_THIN_GLASS, "thin glass"},
};

#define KINDS ((int)(sizeof kinds / sizeof kinds[0]))

static int kind_of(const struct mtl_source *s)
{
    struct material m = material_params_material(s);

    for (int i = 0; i < KINDS; i++)
        if (kinds[i].kind == m.kind)
            return i;
    return 0;
}

const char *material_params_kind(const struct mtl_source *s)
{
    return kinds[kind_of(s)].name;
}

/* The statement that has the colour of what the material is. */
static struct mtl_color *color_of(struct mtl_source *s)
{
    struct material m = material_params_material(s);

    if (material_params_is_glass(&m))
        return &s->tf;
    return m.kind == MATERIAL_METAL && !(s->pm.value >= 0.5) ? &s->ks : &s->kd;
}

void material_params_color(const struct mtl_source *source, double rgb[3])
{
    struct mtl_source s = *source;
    struct material m = material_params_material(source);
    const struct mtl_color *c = color_of(&s);

    rgb[0] = (double)m.color.x;
    rgb[1] = (double)m.color.y;
    rgb[2] = (double)m.color.z;
    if (c->line != 0)
        memcpy(rgb, c->rgb, sizeof c->rgb);
}

void material_params_shorten(double rgb[3])
{
    for (int i = 0; i < 3; i++)
        rgb[i] = decimal_shortened(rgb[i]);
}

void material_params_put_number(struct mtl_number *n, double value)
{
    *n = (struct mtl_number){decimal_shortened(value),
                             n->line != 0 ? n->line : 1};
}

void material_params_put_color(struct mtl_color *c, const double rgb[3])
{
    memcpy(c->rgb, rgb, sizeof c->rgb);
    material_params_shorten(c->rgb);
    c->line = c->line != 0 ? c->line : 1;
}

static bool is_black(const struct mtl_color *c)
{
    return c->rgb[0] == 0 && c->rgb[1] == 0 && c->rgb[2] == 0;
}

/* Another kind with the same colour. */
static void set_kind(struct mtl_source *s, uint32_t kind)
{
    static const double black[3] = {0, 0, 0};
    static const double coat[3] = {COAT_USUAL, COAT_USUAL, COAT_USUAL};
    double rgb[3];

    material_params_color(s, rgb);
    /* maps that would make something else of it */
    if (s->maps[MTL_MAP_KS] != NO_INDEX)
        s->maps_off |= 1u << MTL_MAP_KS;
    if (s->maps[MTL_MAP_PM] != NO_INDEX)
        s->maps_off |= 1u << MTL_MAP_PM;
    if (kind == MATERIAL_GLASS || kind == MATERIAL_THIN_GLASS) {
        material_params_put_number(&s->illum, kind == MATERIAL_GLASS ? 7 : 4);
        material_params_put_color(&s->tf, rgb);
        return;
    }
    material_params_put_number(&s->illum, kind == MATERIAL_METAL ? 3 : 2);
    material_params_put_color(&s->kd, rgb);
    if (kind == MATERIAL_METAL)
        material_params_put_number(&s->pm, 1);
    else if (s->pm.line != 0)
        material_params_put_number(&s->pm, 0);
    if (kind == MATERIAL_PLASTIC && is_black(&s->ks))
        material_params_put_color(&s->ks, coat);
    if (kind == MATERIAL_DIFFUSE && s->ks.line != 0)
        material_params_put_color(&s->ks, black);
}

double material_params_roughness(const struct mtl_source *s)
{
    struct material m = material_params_material(s);

    if (is_diffuse(&m))
        return s->kd_roughness.value;
    return s->pr.line != 0 ? s->pr.value : sqrt((double)m.alpha);
}

void material_params_set_roughness(struct mtl_source *s, double x)
{
    struct material m = material_params_material(s);

    material_params_put_number(is_diffuse(&m) ? &s->kd_roughness : &s->pr, x);
}

double material_params_largest(const double rgb[3])
{
    return fmax(rgb[0], fmax(rgb[1], rgb[2]));
}

double material_params_strength(const struct mtl_source *s)
{
    return s->kelvin.line != 0 ? s->luminance.value
                               : material_params_largest(s->ke.rgb);
}

void material_params_set_strength(struct mtl_source *s, double x)
{
    double most = material_params_largest(s->ke.rgb);
    double rgb[3];

    if (s->kelvin.line != 0) {
        material_params_put_number(&s->luminance, x);
        return;
    }
    for (int i = 0; i < 3; i++)
        rgb[i] = most > 0 ? s->ke.rgb[i] / most * x : x;
    material_params_put_color(&s->ke, rgb);
}

/* The light's colour, its largest channel 1; white if it is dark. */
void material_params_light_color(const struct mtl_source *s, double rgb[3])
{
    struct mtl_color light = mtl_source_light(s);
    double most = material_params_largest(light.rgb);

    for (int i = 0; i < 3; i++)
        rgb[i] = most > 0 ? light.rgb[i] / most : 1;
}

void material_params_set_kelvin(struct mtl_source *s, double kelvin)
{
    double luminance = s->luminance.value;

    if (s->kelvin.line == 0) /* Rec.709: as bright as it was */
        luminance = 0.2126 * s->ke.rgb[0] + 0.7152 * s->ke.rgb[1] +
                    0.0722 * s->ke.rgb[2];
    s->ke = (struct mtl_color){.line = 0};
    material_params_put_number(&s->kelvin, kelvin);
    material_params_put_number(&s->luminance, luminance);
}

void material_params_set_light_color(struct mtl_source *s, const double rgb[3])
{
    double strength = material_params_largest(mtl_source_light(s).rgb);
    double most = material_params_largest(rgb);
    double scaled[3];

    for (int i = 0; i < 3; i++)
        scaled[i] = most > 0 ? rgb[i] / most * strength : 0;
    s->kelvin = s->luminance = (struct mtl_number){.line = 0};
    material_params_put_color(&s->ke, scaled);
}

void material_params_swatch(const struct mtl_source *s, double rgb[3])
{
    if (material_params_largest(mtl_source_light(s).rgb) > 0)
        material_params_light_color(s, rgb);
    else
        material_params_color(s, rgb);
}

void material_params_set_color(struct mtl_source *s, const double rgb[3])
{
    material_params_put_color(color_of(s), rgb);
}

void material_params_turn_kind(struct mtl_source *s, int step)
{
    int next = (kind_of(s) + (step > 0 ? 1 : KINDS - 1)) % KINDS;

    set_kind(s, kinds[next].kind);
}
