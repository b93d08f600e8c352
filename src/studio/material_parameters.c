// SPDX-License-Identifier: MIT
#include "studio/material_parameters.h"

#include <math.h>
#include <string.h>

#include "base/decimal.h"
#include "base/file.h"
#include "image/color.h"
#include "studio/medium_parameters.h"
#include "studio/presets.h"
#include "world/textures.h"

/* Ks that a material gets when it becomes plastic; see MATERIAL_SPECULAR. */
#define KS_DEFAULT 0.5

/* Ni of a sheet of glass that would be invisible. */
#define NI_DEFAULT 1.5

/* Pm of a material that becomes a mixture, if it was none. */
#define PM_DEFAULT 0.5

/* ---- statements ---- */

static void put_number(struct mtl_number *n, double value)
{
    *n = (struct mtl_number){decimal_shortened(value),
                             n->line != 0 ? n->line : 1};
}

static void put_color(struct mtl_color *c, const double rgb[3])
{
    for (int i = 0; i < 3; i++)
        c->rgb[i] = decimal_shortened(rgb[i]);
    c->line = c->line != 0 ? c->line : 1;
}

static void put_grey(struct mtl_color *c, double value)
{
    put_color(c, (const double[3]){value, value, value});
}

/* Black beside a map would be white (material_values_with_factors()). */
#define FACTOR_MIN 1e-6

/* Sets a colour that multiplies a map. */
static void put_factor(struct owner *o, struct mtl_color *c, enum mtl_map map,
                       const double rgb[3])
{
    put_color(c, rgb);
    if (material_values_map(&o->source, map) != NO_INDEX &&
        mtl_color_is_black(c))
        put_grey(c, FACTOR_MIN);
}

/* Reads a number that a statement sets: as the material has it if the row says
 * where, else as the source has it. */
static bool get_statement(const struct owner *o, struct value *v)
{
    const void *result = (const char *)&o->material + o->row->result;
    const void *at = (const char *)&o->factors + o->row->member;
    const struct mtl_number *number = at;

    if (o->row->result != 0)
        v->number = (double)*(const float *)result;
    else
        v->number = number->line != 0 ? number->value : o->row->absent;
    return true;
}

static void set_color_statement(struct owner *o, const struct value *v)
{
    void *color = (char *)&o->source + o->row->member;

    put_color(color, v->rgb);
}

static void set_statement(struct owner *o, const struct value *v)
{
    void *number = (char *)&o->source + o->row->member;

    put_number(number, v->number);
}

/* ---- kind and colour of a material ---- */

/* Sets of material kinds as bits. */
#define DIFFUSE (1u << MATERIAL_DIFFUSE | 1u << MATERIAL_ROUGH_DIFFUSE)
#define PLASTIC (1u << MATERIAL_PLASTIC)
#define METAL   (1u << MATERIAL_METAL)
#define GLASS   (1u << MATERIAL_GLASS)
#define THIN    (1u << MATERIAL_THIN_GLASS)
#define MIXED   (1u << MATERIAL_PRINCIPLED)
#define OPAQUE  (DIFFUSE | PLASTIC | METAL | MIXED)
#define CLEAR   (GLASS | THIN)

static const char *const kind_names[] = {"diffuse", "plastic",    "metal",
                                         "glass",   "thin glass", "principled"};

/* Bits of each choice of kind. Rough diffuse differs in roughness only. */
static const uint32_t kind_bits[] = {DIFFUSE, PLASTIC, METAL,
                                     GLASS,   THIN,    MIXED};

void material_parameters_open(struct owner *o,
                              const struct material_values *source,
                              const struct host_world *world)
{
    struct warnings ignored = {0};
    struct material_values found =
        world != NULL ? textures_found(world, source) : *source;

    o->source = *source;
    o->factors = material_values_with_factors(&found);
    o->material = material_from_source(&found, "", &ignored);
    o->kind = o->material.kind;
    warnings_free(&ignored);
}

static bool is_kind(const struct owner *o, uint32_t bits)
{
    return (bits >> o->kind & 1) != 0;
}

static bool get_kind(const struct owner *o, struct value *v)
{
    while (!is_kind(o, kind_bits[(size_t)v->number]))
        v->number++;
    return true;
}

/* Returns the offset of the statement that sets the colour of this kind of
 * material. */
static size_t color_member(const struct owner *o)
{
    if (!is_kind(o, OPAQUE))
        return offsetof(struct material_values, transmission);
    return is_kind(o, METAL | MIXED) &&
                   material_values_is_mirror(&o->factors) &&
                   o->material.metalness == 1
               ? offsetof(struct material_values, specular_color)
               : offsetof(struct material_values, base_color);
}

static bool get_color(const struct owner *o, struct value *v)
{
    const void *at = (const char *)&o->factors + color_member(o);
    const struct mtl_color *c = at;
    struct vec3 m = o->material.color;
    struct mtl_color made = {{(double)m.x, (double)m.y, (double)m.z}, 0};
    bool has_map = o->material.color_texture != NO_INDEX;

    if (c->line == 0 || (mtl_color_is_black(c) && has_map))
        c = &made;
    memcpy(v->rgb, c->rgb, sizeof v->rgb);
    return true;
}

static void set_color(struct owner *o, const struct value *v)
{
    size_t member = color_member(o);
    void *color = (char *)&o->source + member;

    put_factor(o, color,
               member == offsetof(struct material_values, specular_color)
                   ? MTL_MAP_SPECULAR
                   : MTL_MAP_COLOR,
               v->rgb);
}

static void set_opaque(struct material_values *s, uint32_t bits,
                       const double rgb[3])
{
    struct mtl_number *const layers[] = {&s->coat, &s->sheen, &s->film,
                                         &s->anisotropy};

    put_number(&s->illum, bits == METAL ? 3 : 2);
    put_color(&s->base_color, rgb);
    if (bits == METAL || bits == MIXED || s->metalness.line != 0)
        put_number(&s->metalness, bits == METAL   ? 1
                                  : bits == MIXED ? PM_DEFAULT
                                                  : 0);
    for (size_t i = 0; i < sizeof layers / sizeof *layers; i++)
        if (layers[i]->line != 0)
            put_number(layers[i], 0);
    if (s->transmission.line != 0)
        put_grey(&s->transmission, 0);
    if (bits == PLASTIC && s->specular_color.rgb[0] == 0 &&
        s->specular_color.rgb[1] == 0 && s->specular_color.rgb[2] == 0)
        put_grey(&s->specular_color, KS_DEFAULT);
    if (bits == DIFFUSE && s->specular_color.line != 0)
        put_grey(&s->specular_color, 0);
}

/* Removes what would make an untinted sheet of glass an opaque surface. */
static void keep_sheet(struct material_values *s)
{
    if (s->opacity.line != 0)
        put_number(&s->opacity, 1);
    if (s->transparency.line != 0)
        put_number(&s->transparency, 0);
    if (s->maps[MTL_MAP_OPACITY] != NO_INDEX)
        s->maps_off |= 1u << MTL_MAP_OPACITY;
    if (s->ior.line != 0 && s->ior.value == 1)
        put_number(&s->ior, NI_DEFAULT);
}

/* Changes the kind of the material and keeps its colour. Maps that would make
 * it another kind are switched off. */
static void change_kind(struct owner *o, uint32_t bits)
{
    static const enum mtl_map kind_maps[] = {
        MTL_MAP_SPECULAR, MTL_MAP_METALNESS, MTL_MAP_TRANSMISSION,
        MTL_MAP_COAT,     MTL_MAP_SHEEN,     MTL_MAP_SHEEN_COLOR,
        MTL_MAP_FILM};
    struct material_values *s = &o->source;
    struct value color;

    get_color(o, &color);
    for (size_t i = 0; i < sizeof kind_maps / sizeof *kind_maps; i++)
        if (s->maps[kind_maps[i]] != NO_INDEX)
            s->maps_off |= 1u << kind_maps[i];
    if ((bits & OPAQUE) != 0) {
        set_opaque(s, bits, color.rgb);
        return;
    }
    put_number(&s->illum, bits == GLASS ? 7 : 4);
    put_color(&s->transmission, color.rgb);
    if (bits == THIN)
        keep_sheet(s);
}

static void set_kind(struct owner *o, const struct value *v)
{
    change_kind(o, kind_bits[(size_t)v->number]);
}

/* ---- surface of a material ---- */

static bool get_roughness(const struct owner *o, struct value *v)
{
    const struct material_values *s = &o->factors;

    if (is_kind(o, DIFFUSE))
        v->number = s->diffuse_roughness.value;
    else
        v->number = s->roughness.line != 0 ? s->roughness.value
                                           : sqrt((double)o->material.alpha);
    return true;
}

static void set_roughness(struct owner *o, const struct value *v)
{
    put_number(is_kind(o, DIFFUSE) ? &o->source.diffuse_roughness
                                   : &o->source.roughness,
               v->number);
}

/* True if the coefficients of the medium are given, not a distance. */
static bool has_coefficients(const struct owner *o)
{
    return o->source.medium_scatter.line != 0 ||
           o->source.medium_absorb.line != 0;
}

/* Reads the weight of transmission, the mean or the largest channel of Tf. It
 * counts beside Pr only. */
static bool get_transmission(const struct owner *o, struct value *v)
{
    v->number = (double)o->material.transmission;
    return true;
}

static void set_transmission(struct owner *o, const struct value *v)
{
    struct material_values *s = &o->source;
    double top = color_largest(s->transmission.rgb);

    if (s->roughness.line == 0)
        put_number(&s->roughness, sqrt((double)o->material.alpha));
    if (s->dialect == MTL_CLASSIC && s->illum.line != 0 && s->illum.value != 3)
        put_number(&s->illum, 2);
    if (s->attenuation_distance.value > 0 && top > 0 && !has_coefficients(o))
        for (int i = 0; i < 3; i++)
            s->transmission.rgb[i] =
                decimal_shortened(s->transmission.rgb[i] / top * v->number);
    else
        put_grey(&s->transmission, v->number);
}

static const char *const body_names[] = {"solid", "sheet"};

static bool get_body(const struct owner *o, struct value *v)
{
    v->number = o->material.is_thin;
    return o->material.transmission > 0;
}

/* ---- medium in a solid ---- */

static bool is_solid(const struct owner *o)
{
    return is_kind(o, GLASS) ||
           (o->material.transmission > 0 && o->material.is_thin == 0);
}

static double coefficient(double value)
{
    return value > 0 ? fmin(value, RADIANCE_MAX) : 0;
}

static struct fog get_coefficients(const struct owner *o)
{
    const struct medium *m = &o->material.medium;
    const struct vec3 absorbs = v3_sub(m->extinction, m->scattering);
    const struct material_values *s = &o->source;
    struct fog f = {.scatter = {(double)m->scattering.x,
                                (double)m->scattering.y,
                                (double)m->scattering.z},
                    .absorb = {(double)absorbs.x, (double)absorbs.y,
                               (double)absorbs.z},
                    .anisotropy = (double)m->anisotropy};

    for (int c = 0; c < 3 && has_coefficients(o); c++) {
        f.scatter[c] = coefficient(s->medium_scatter.rgb[c]);
        f.absorb[c] = coefficient(s->medium_absorb.rgb[c]);
    }
    return f;
}

static void set_coefficients(struct material_values *s, const struct fog *f)
{
    put_color(&s->medium_scatter, f->scatter);
    put_color(&s->medium_absorb, f->absorb);
    if (!(medium_density(f) > 0))
        s->medium_scatter = s->medium_absorb = (struct mtl_color){.line = 0};
}

/* Reads a value of the medium. Without coefficients, a distance decides about
 * all but the colour. */
static bool get_medium(const struct owner *o, struct value *v)
{
    const struct fog f = get_coefficients(o);

    return is_solid(o) && medium_read(&f, o->row->member, v) &&
           (has_coefficients(o) || o->row->member == MEDIUM_DENSITY ||
            o->row->member == MEDIUM_COLOR);
}

/* Changes the coefficients, or the distance and the colour beside it. */
static void set_medium(struct owner *o, const struct value *v)
{
    struct material_values *s = &o->source;
    struct fog f = get_coefficients(o);
    double density = medium_density(&f);

    if (has_coefficients(o) || !(density > 0)) {
        medium_change(&f, o->row->member, v);
        set_coefficients(s, &f);
    } else if (o->row->member == MEDIUM_COLOR) {
        s->medium_albedo = (struct mtl_color){.line = 0};
        put_color(&s->medium_color, v->rgb);
    } else {
        put_number(&s->attenuation_distance,
                   v->number > 0
                       ? s->attenuation_distance.value * density / v->number
                       : 0);
    }
}

/* Reads the mean cosine of scattering, if there is any. */
static bool get_anisotropy(const struct owner *o, struct value *v)
{
    return get_statement(o, v) && !v3_is_zero(o->material.medium.scattering);
}

/* Reads the distance after which light in a solid has the tint. */
static bool get_distance(const struct owner *o, struct value *v)
{
    v->number = o->source.attenuation_distance.value;
    return is_solid(o) && !has_coefficients(o);
}

/* Reads the colour of a solid after the distance, if it is not the tint. */
static bool get_attenuation(const struct owner *o, struct value *v)
{
    memcpy(v->rgb, o->source.attenuation.rgb, sizeof v->rgb);
    return o->source.attenuation.line != 0 && get_distance(o, v) &&
           v->number > 0;
}

/* Sets the weight of diffuse transmission. Its colour begins as that of the
 * surface. */
static void set_translucency(struct owner *o, const struct value *v)
{
    struct value color;

    get_color(o, &color);
    put_number(&o->source.translucency, v->number);
    if (o->factors.back_color.line == 0)
        put_color(&o->source.back_color, color.rgb);
}

static bool get_back_color(const struct owner *o, struct value *v)
{
    const struct mtl_color *color = &o->factors.back_color;

    for (int i = 0; i < 3; i++)
        v->rgb[i] = color->line != 0 ? color->rgb[i] : 1;
    return o->material.translucency > 0;
}

/* Mean free path of a new subsurface, by the size of the body. */
#define SUBSURFACE_PATH 0.03

static void set_subsurface(struct owner *o, const struct value *v)
{
    put_number(&o->source.subsurface, v->number);
    if (o->source.subsurface_path.line == 0)
        put_grey(&o->source.subsurface_path,
                 decimal_shortened(SUBSURFACE_PATH * body_size(o->selection)));
}

static bool get_mean_path(const struct owner *o, struct value *v)
{
    memcpy(v->rgb, o->source.subsurface_path.rgb, sizeof v->rgb);
    return o->material.subsurface > 0;
}

/* Reads the weight of sheen, which is multiplied by its colour. */
static bool get_sheen(const struct owner *o, struct value *v)
{
    const struct mtl_color *color = &o->factors.sheen_color;
    struct vec3 sheen = o->material.sheen;
    double top = color->line != 0 ? fmin(color_largest(color->rgb), 1) : 1;

    v->number = top > 0 ? (double)v3_max_component(sheen) / top : 0;
    return true;
}

static bool get_sheen_color(const struct owner *o, struct value *v)
{
    const struct mtl_color *color = &o->source.sheen_color;

    for (int i = 0; i < 3; i++)
        v->rgb[i] = color->line != 0 ? color->rgb[i] : 1;
    return v3_max_component(o->material.sheen) > 0;
}

/* Reads the thickness of the film where its map is black. */
static bool get_film_thinnest(const struct owner *o, struct value *v)
{
    return get_statement(o, v) &&
           o->source.maps[MTL_MAP_FILM_THICKNESS] != NO_INDEX;
}

/* Reads the coverage from which a surface is whole. */
static bool get_cutoff(const struct owner *o, struct value *v)
{
    get_statement(o, v);
    return o->source.cutoff.line != 0 ||
           o->source.maps[MTL_MAP_OPACITY] != NO_INDEX;
}

static bool get_specular(const struct owner *o, struct value *v)
{
    v->number = color_largest(o->factors.specular_color.rgb);
    return true;
}

static void set_specular(struct owner *o, const struct value *v)
{
    put_factor(o, &o->source.specular_color, MTL_MAP_SPECULAR,
               (const double[]){v->number, v->number, v->number});
}

static bool get_coat(const struct owner *o, struct value *v)
{
    v->number = (double)o->material.coat;
    return true;
}

static void set_coat(struct owner *o, const struct value *v)
{
    put_number(&o->source.coat,
               v->number * material_values_full_coat(&o->source));
}

static bool get_map(const struct owner *o, struct value *v)
{
    uint32_t texture = o->source.maps[o->map];

    if (texture == NO_INDEX)
        return false;
    v->number = o->source.maps_off >> o->map & 1;
    v->note = path_name(o->selection->scene->texture_paths[texture]);
    return true;
}

static const char *map_name(const struct owner *o, uint32_t i)
{
    (void)o;
    return i < MTL_MAPS ? mtl_maps[i].keys[0] : NULL;
}

static bool get_new_map(const struct owner *o, struct value *v)
{
    v->number = o->map;
    return true;
}

static void set_map(struct owner *o, const struct value *v)
{
    o->source.maps_off &= ~(1u << o->map);
    o->source.maps_off |= (uint32_t)v->number << o->map;
}

/* ---- emission of a material ---- */

/* Returns the luminance of a black body, or the largest channel of Ke. */
static double strength_of(const struct material_values *s)
{
    return s->kelvin.line != 0 ? s->luminance.value
                               : color_largest(s->emission.rgb);
}

static bool get_emission(const struct owner *o, struct value *v)
{
    v->number = strength_of(&o->factors);
    return true;
}

static void set_emission(struct owner *o, const struct value *v)
{
    struct material_values *s = &o->source;
    const double *ke = o->factors.emission.rgb;
    bool has_map = material_values_map(s, MTL_MAP_EMISSION) != NO_INDEX;
    double most = color_largest(ke);
    double rgb[3];

    if (s->kelvin.line != 0) {
        put_number(&s->luminance,
                   has_map ? fmax(v->number, FACTOR_MIN) : v->number);
        return;
    }
    for (int i = 0; i < 3; i++)
        rgb[i] = most > 0 ? ke[i] / most * v->number : v->number;
    put_factor(o, &s->emission, MTL_MAP_EMISSION, rgb);
}

/* Reads the colour of the emission, which is white if there is none. */
static bool get_emission_color(const struct owner *o, struct value *v)
{
    struct mtl_color light = material_values_light(&o->factors);
    double most = color_largest(light.rgb);

    v->number = o->factors.kelvin.line != 0 ? o->factors.kelvin.value : 0;
    for (int i = 0; i < 3; i++)
        v->rgb[i] = most > 0 ? light.rgb[i] / most : 1;
    return strength_of(&o->factors) > 0;
}

/* Changes the colour of the emission. A temperature keeps the luminance, a
 * colour the largest channel. */
static void set_emission_color(struct owner *o, const struct value *v)
{
    struct material_values *s = &o->source;
    const struct material_values *f = &o->factors;
    double strength = color_largest(material_values_light(f).rgb);
    double most = color_largest(v->rgb);
    double luminance = f->luminance.value;
    double rgb[3];

    if (v->number > 0) {
        if (f->kelvin.line == 0) /* luminance of Rec.709 */
            luminance = 0.2126 * f->emission.rgb[0] +
                        0.7152 * f->emission.rgb[1] +
                        0.0722 * f->emission.rgb[2];
        s->emission = (struct mtl_color){.line = 0};
        put_number(&s->kelvin, v->number);
        put_number(&s->luminance, luminance);
        return;
    }
    for (int i = 0; i < 3; i++)
        rgb[i] = most > 0 ? v->rgb[i] / most * strength : 0;
    s->kelvin = s->luminance = (struct mtl_number){.line = 0};
    put_factor(o, &s->emission, MTL_MAP_EMISSION, rgb);
}

/* ---- presets ---- */

/* True if two triples differ by a factor only. */
static bool are_alike(const double a[3], const double b[3])
{
    for (int c = 1; c < 3; c++)
        if (!(fabs(a[c] * b[0] - b[c] * a[0]) <= 1e-3 * fabs(b[c] * a[0])))
            return false;
    return true;
}

/* True for a material with the color and the ratios of mean free paths of the
 * substance, or for glass with its index. The highlight, and the surface of
 * glass, may be others. */
static bool is_of_substance(const struct owner *o, const struct substance *p)
{
    const struct material_values *s = &o->factors;
    double color[3], path[3];

    if (!(p->depth > 0))
        return is_kind(o, GLASS) && s->ior.value == p->ior &&
               s->abbe.value == p->abbe && !has_coefficients(o);
    substance_color(p, color);
    substance_path(p, 1, path);
    return o->material.subsurface == 1 &&
           memcmp(color, s->base_color.rgb, sizeof color) == 0 &&
           are_alike(s->subsurface_path.rgb, path);
}

static bool get_preset(const struct owner *o, struct value *v)
{
    const struct substance *p;

    for (uint32_t i = 1; (p = substance_at(i)) != NULL; i++)
        if (is_of_substance(o, p))
            v->number = i;
    return true;
}

static const char *preset_name(const struct owner *o, uint32_t i)
{
    const struct substance *p = substance_at(i);
    struct value v = {.number = 0};

    if (i > 0)
        return p != NULL ? p->name : NULL;
    get_preset(o, &v);
    return v.number > 0 ? "" : "none";
}

static void set_preset(struct owner *o, const struct value *v)
{
    const struct substance *p = substance_at((uint32_t)v->number);
    struct material_values *s = &o->source;

    if (p == NULL)
        return;
    change_kind(o, p->depth > 0 ? PLASTIC : GLASS);
    s->maps_off |= 1u << MTL_MAP_COLOR;
    put_number(&s->roughness, p->roughness);
    put_number(&s->subsurface, p->depth > 0);
    if (p->depth > 0) {
        substance_color(p, s->base_color.rgb);
        substance_path(p, body_size(o->selection), s->subsurface_path.rgb);
        put_color(&s->base_color, s->base_color.rgb);
        put_color(&s->subsurface_path, s->subsurface_path.rgb);
        put_number(&s->subsurface_anisotropy, 0);
        return;
    }
    put_grey(&s->transmission, 1);
    put_number(&s->ior, p->ior);
    put_number(&s->abbe, p->abbe);
    s->attenuation_distance = s->medium_anisotropy =
        (struct mtl_number){.line = 0};
    s->medium_scatter = s->medium_absorb = (struct mtl_color){.line = 0};
}

/* ---- table ---- */

#define WRITES(name) \
    .set = set_statement, .member = offsetof(struct material_values, name)

#define WRITES_COLOR(name) \
    .set = set_color_statement, .member = offsetof(struct material_values, name)

/* Found in the material, or else in the statement itself. */
#define STATEMENT(name, found)          \
    .get = get_statement, WRITES(name), \
    .result = offsetof(struct material, found)
#define SOURCE_NUMBER(name) .get = get_statement, WRITES(name)

static const char *const map_states[] = {"on", "off"};

const struct parameter_row map_parameter = {
    NULL,           ALL,
    VALUE_CHOICE,   NULL,
    .is_map = true, .get = get_map,
    .set = set_map, CHOICES(map_states)};

const struct parameter_row new_map_parameter = {"add image",
                                                ALL,
                                                VALUE_CHOICE,
                                                NULL,
                                                .is_map = true,
                                                .get = get_new_map,
                                                .name = map_name};

const struct parameter_row material_parameters[] = {
    {"type", ALL, VALUE_CHOICE, NULL, .get = get_kind, .set = set_kind,
     CHOICES(kind_names)},
    {"preset", ALL, VALUE_CHOICE, NULL, .get = get_preset, .set = set_preset,
     .name = preset_name, .expected = "a name such as marble"},
    {"colour", OPAQUE, VALUE_COLOR, &scale_unit, .get = get_color,
     .set = set_color},
    {"tint", CLEAR, VALUE_COLOR, &scale_unit, .get = get_color,
     .set = set_color},
    {"roughness", OPAQUE | CLEAR, VALUE_NUMBER, &scale_unit,
     .get = get_roughness, .set = set_roughness},
    {"specular", PLASTIC, VALUE_NUMBER, &scale_specular, .get = get_specular,
     .set = set_specular},
    {"specular", MIXED, VALUE_NUMBER, &scale_unit, .get = get_specular,
     .set = set_specular},
    {"metal", MIXED, VALUE_NUMBER, &scale_unit,
     STATEMENT(metalness, metalness)},
    {"transmits", MIXED, VALUE_NUMBER, &scale_unit, .get = get_transmission,
     .set = set_transmission},
    {"index", CLEAR | MIXED, VALUE_NUMBER, &scale_ior, STATEMENT(ior, ior)},
    {"Abbe number", CLEAR | MIXED, VALUE_NUMBER, &scale_abbe,
     SOURCE_NUMBER(abbe)},
    {"glass is", MIXED, VALUE_CHOICE, NULL, .get = get_body, WRITES(thinness),
     CHOICES(body_names)},
    {"density", GLASS | MIXED, VALUE_NUMBER, &scale_density, .get = get_medium,
     .set = set_medium, .member = MEDIUM_DENSITY},
    {"scatters", GLASS | MIXED, VALUE_TRIPLE, &scale_density, .get = get_medium,
     .set = set_medium, .member = MEDIUM_SCATTER},
    {"absorbs", GLASS | MIXED, VALUE_TRIPLE, &scale_density, .get = get_medium,
     .set = set_medium, .member = MEDIUM_ABSORB},
    {"tint depth", GLASS | MIXED, VALUE_NUMBER, &scale_emission,
     .get = get_distance, WRITES(attenuation_distance)},
    {"then", GLASS | MIXED, VALUE_COLOR, &scale_unit, .get = get_attenuation,
     WRITES_COLOR(attenuation)},
    {"inside", GLASS | MIXED, VALUE_COLOR, &scale_unit, .get = get_medium,
     .set = set_medium, .member = MEDIUM_COLOR},
    {"anisotropy", GLASS | MIXED, VALUE_NUMBER, &scale_anisotropy,
     .get = get_anisotropy, WRITES(medium_anisotropy)},
    {"translucent", DIFFUSE | PLASTIC | MIXED, VALUE_NUMBER, &scale_unit,
     .get = get_statement, .set = set_translucency,
     .result = offsetof(struct material, translucency)},
    {"back colour", DIFFUSE | PLASTIC | MIXED, VALUE_COLOR, &scale_unit,
     .get = get_back_color, WRITES_COLOR(back_color)},
    {"subsurface", DIFFUSE | PLASTIC | MIXED, VALUE_NUMBER, &scale_unit,
     .get = get_statement, .set = set_subsurface,
     .result = offsetof(struct material, subsurface)},
    {"mean path", DIFFUSE | PLASTIC | MIXED, VALUE_TRIPLE, &scale_density,
     .get = get_mean_path, WRITES_COLOR(subsurface_path)},
    {"coat", MIXED | PLASTIC | METAL, VALUE_NUMBER, &scale_unit,
     .get = get_coat, .set = set_coat},
    {"coat rough", MIXED, VALUE_NUMBER, &scale_unit,
     SOURCE_NUMBER(coat_roughness)},
    {"sheen", MIXED | PLASTIC | METAL, VALUE_NUMBER, &scale_unit,
     .get = get_sheen, WRITES(sheen)},
    {"sheen tint", MIXED, VALUE_COLOR, &scale_unit, .get = get_sheen_color,
     WRITES_COLOR(sheen_color)},
    {"sheen rough", MIXED, VALUE_NUMBER, &scale_unit,
     SOURCE_NUMBER(sheen_roughness), .absent = MATERIAL_SHEEN_ROUGHNESS},
    {"film", MIXED, VALUE_NUMBER, &scale_unit, SOURCE_NUMBER(film)},
    {"film index", MIXED, VALUE_NUMBER, &scale_film_ior,
     SOURCE_NUMBER(film_ior), .absent = MATERIAL_FILM_IOR},
    {"film nm", MIXED, VALUE_NUMBER, &scale_film_thickness,
     SOURCE_NUMBER(film_thickness), .absent = MATERIAL_FILM_THICKNESS},
    {"film from", MIXED, VALUE_NUMBER, &scale_film_thickness,
     .get = get_film_thinnest, WRITES(film_thinnest)},
    {"grain", MIXED | PLASTIC | METAL, VALUE_NUMBER, &scale_unit,
     STATEMENT(anisotropy, anisotropy)},
    {"grain turn", MIXED, VALUE_NUMBER, &scale_unit,
     SOURCE_NUMBER(anisotropy_rotation)},
    {"opacity", OPAQUE, VALUE_NUMBER, &scale_unit, STATEMENT(opacity, opacity)},
    {"cut at", OPAQUE, VALUE_NUMBER, &scale_unit, .get = get_cutoff,
     WRITES(cutoff)},
    {"light", ALL, VALUE_NUMBER, &scale_emission, .get = get_emission,
     .set = set_emission},
    {"of colour", ALL, VALUE_LIGHT_COLOR, &scale_kelvin,
     .get = get_emission_color, .set = set_emission_color},
    {.label = NULL},
};

const char *material_parameters_summary(const struct material_values *source,
                                        const struct host_world *world,
                                        double swatch[3])
{
    struct owner o = {.selection = NULL};
    struct value kind = {.number = 0}, color;

    material_parameters_open(&o, source, world);
    get_kind(&o, &kind);
    if (color_largest(material_values_light(&o.factors).rgb) > 0)
        get_emission_color(&o, &color);
    else
        get_color(&o, &color);
    memcpy(swatch, color.rgb, sizeof color.rgb);
    return kind_names[(size_t)kind.number];
}
