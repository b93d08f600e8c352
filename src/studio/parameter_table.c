// SPDX-License-Identifier: MIT
#include "studio/parameter_table.h"

#include <math.h>
#include <string.h>

#include "base/decimal.h"
#include "base/file.h"
#include "image/color.h"
#include "studio/material_parameters.h"
#include "studio/medium_parameters.h"
#include "studio/presets.h"
#include "world/light/daylight.h"

/* ---- scales ---- */

/* Limits of typed numbers, ends of the scale, step, digits, and the rest. */
#define SCALE(a, b, c, d, by, numerals, ...)                   \
    {                                                          \
        .least = a, .most = b, .from = c, .to = d, .step = by, \
        .digits = numerals, __VA_ARGS__                        \
    }

/* clang-format off */
const struct value_scale scale_unit = SCALE(0, 1, 0, 1, 0.01, 3,);
const struct value_scale scale_specular =
    SCALE(0, 1, 0, 1, 0.01, 3, .is_positive = true);
const struct value_scale scale_hue = SCALE(0, 360, 0, 360, 1, 3, .wraps = true);
const struct value_scale scale_ior = SCALE(1e-6, 1e6, 1, 3, 0.01, 4,);
const struct value_scale scale_abbe =
    SCALE(0, 1e6, 10, 100, 0, 4, .zero = "off");
const struct value_scale scale_film_ior = SCALE(1, 10, 1, 3, 0.01, 4,);
const struct value_scale scale_film_thickness =
    SCALE(0, 2000, 0, 1000, 10, 4, .zero = "off");
const struct value_scale scale_emission =
    SCALE(0, RADIANCE_MAX, 0.01, 1e4, 0, 4, .zero = "off");
const struct value_scale scale_kelvin =
    SCALE(BLACKBODY_MIN, BLACKBODY_MAX, 1000, 20000, 100, 6,
          .suffix = "K");
const struct value_scale scale_density =
    SCALE(0, RADIANCE_MAX, 1e-5, 1e4, 0, 4, .zero = "off");
const struct value_scale scale_anisotropy = SCALE(-1, 1, -1, 1, 0.01, 3,);
static const struct value_scale scale_size =
    SCALE(1e-30, RADIANCE_MAX, 1e-4, 1e4, 0, 4,);
static const struct value_scale scale_radiance =
    SCALE(0, RADIANCE_MAX, 0, 1, 0.01, 3,);
static const struct value_scale scale_sky =
    SCALE(0, RADIANCE_MAX, 0.01, 1e4, 0, 4,);
static const struct value_scale scale_rotation =
    SCALE(-1e6, 1e6, 0, 360, 1, 4, .wraps = true);
static const struct value_scale scale_azimuth =
    SCALE(-SUN_AZIMUTH_MAX, SUN_AZIMUTH_MAX, 0, 360, 1, 4, .wraps = true);
static const struct value_scale scale_elevation =
    SCALE(-SUN_ELEVATION_MAX, SUN_ELEVATION_MAX, 0, 90, 1, 4,);
static const struct value_scale scale_turbidity =
    SCALE(TURBIDITY_MIN, TURBIDITY_MAX, TURBIDITY_MIN,
          TURBIDITY_MAX, 0.1, 3,);
static const struct value_scale scale_lamp_elevation =
    SCALE(-90, 90, -90, 90, 1, 4,);
static const struct value_scale scale_cone = SCALE(0, 90, 0, 90, 1, 4,);
static const struct value_scale scale_disc =
    SCALE(0, 180, 0.01, 180, 0, 4, .zero = "none");
static const struct value_scale scale_radius =
    SCALE(0, RADIANCE_MAX, 1e-3, 1e3, 0, 4, .zero = "none");
static const struct value_scale scale_exposure =
    SCALE(-100, 100, -8, 8, 0.1, 3, .suffix = " EV");
/* clang-format on */

/* ---- material of an object ---- */

/* Returns the name of choice i. The choice after the last material is the
 * material of the file. */
static const char *material_name(const struct owner *o, uint32_t i)
{
    const struct edit *e = o->selection->edit;

    if (i >= e->material_count)
        return i == e->material_count ? "as in the file" : NULL;
    return i == o->assigned || e->now.is_there[i] ? e->names[i] : "";
}

static bool get_assigned(const struct owner *o, struct value *v)
{
    v->number = o->assigned != NO_INDEX ? o->assigned
                                        : o->selection->edit->material_count;
    return true;
}

static void set_assigned(struct owner *o, const struct value *v)
{
    uint32_t i = (uint32_t)v->number;

    o->assigned = i < o->selection->edit->material_count ? i : NO_INDEX;
}

/* ---- light ---- */

/* Kinds of sky as bits. */
#define OF_CONSTANT (1u << SKY_CONSTANT)
#define OF_IMAGE    (1u << SKY_IMAGE)
#define OF_SUN      (1u << SKY_SUN)

static const char *const switches[] = {"off", "on"};

static bool get_sun(const struct owner *o, struct value *v)
{
    v->number = o->lighting.sun.is_on;
    return true;
}

static void set_sun(struct owner *o, const struct value *v)
{
    o->lighting.sun.is_on = v->number > 0;
}

static const char *sky_name(const struct owner *o, uint32_t i)
{
    const struct name_table *skies = &o->selection->edit->skies;

    if (i == 0)
        return "none";
    return i < skies->count ? path_name(skies->items[i]) : NULL;
}

static bool get_sky(const struct owner *o, struct value *v)
{
    const char *path = o->lighting.sky_path;

    v->number = path ? name_table_find(&o->selection->edit->skies, path) : 0;
    return true;
}

static void set_sky(struct owner *o, const struct value *v)
{
    uint32_t i = (uint32_t)v->number;

    o->lighting.sky_path = i > 0 ? o->selection->edit->skies.items[i] : NULL;
}

static uint32_t find_sky(const struct owner *o, const char *path)
{
    return edit_sky(o->selection->edit, path);
}

/* Reads a member of struct lighting: a double, or a choice as uint32_t. */
static bool get_lighting(const struct owner *o, struct value *v)
{
    const void *at = (const char *)&o->lighting + o->row->member;

    v->number = o->row->type == VALUE_CHOICE ? *(const uint32_t *)at
                                             : *(const double *)at;
    return true;
}

static void set_lighting(struct owner *o, const struct value *v)
{
    void *at = (char *)&o->lighting + o->row->member;

    if (o->row->type == VALUE_CHOICE)
        *(uint32_t *)at = (uint32_t)v->number;
    else
        *(double *)at = v->number;
}

static bool get_background(const struct owner *o, struct value *v)
{
    memcpy(v->rgb, o->lighting.background, sizeof v->rgb);
    return true;
}

static void set_background(struct owner *o, const struct value *v)
{
    for (int i = 0; i < 3; i++)
        o->lighting.background[i] = decimal_shortened(v->rgb[i]);
    o->lighting.has_background = true;
}

/* ---- fog ---- */

static bool get_preset(const struct owner *o, struct value *v)
{
    v->number = fog_find(&o->lighting.fog);
    return true;
}

static void set_preset(struct owner *o, const struct value *v)
{
    struct fog *f = &o->lighting.fog;

    if (v->number != fog_find(f))
        *f = fog_preset((uint32_t)v->number, o->selection);
}

static bool get_medium(const struct owner *o, struct value *v)
{
    return medium_read(&o->lighting.fog, o->row->member, v);
}

static void set_medium(struct owner *o, const struct value *v)
{
    medium_change(&o->lighting.fog, o->row->member, v);
}

static bool get_fog(const struct owner *o, struct value *v)
{
    return get_lighting(o, v) && fog_is_there(&o->lighting.fog);
}

static bool get_fog_height(const struct owner *o, struct value *v)
{
    return get_fog(o, v) && o->lighting.fog.falloff > 0;
}

/* ---- smoke ---- */

static struct fog medium_of_smoke(const struct smoke_numbers *s)
{
    struct fog f = {.anisotropy = s->anisotropy};

    memcpy(f.scatter, s->scatter, sizeof f.scatter);
    memcpy(f.absorb, s->absorb, sizeof f.absorb);
    return f;
}

static bool get_smoke_medium(const struct owner *o, struct value *v)
{
    struct fog f = medium_of_smoke(&o->smoke);

    return medium_read(&f, o->row->member, v);
}

static void set_smoke_medium(struct owner *o, const struct value *v)
{
    struct fog f = medium_of_smoke(&o->smoke);

    medium_change(&f, o->row->member, v);
    memcpy(o->smoke.scatter, f.scatter, sizeof f.scatter);
    memcpy(o->smoke.absorb, f.absorb, sizeof f.absorb);
}

/* Reads a double of struct smoke_numbers. */
static bool get_smoke(const struct owner *o, struct value *v)
{
    v->number = *(const double *)(const void *)((const char *)&o->smoke +
                                                o->row->member);
    return true;
}

static void set_smoke(struct owner *o, const struct value *v)
{
    *(double *)(void *)((char *)&o->smoke + o->row->member) = v->number;
}

static bool get_glow(const struct owner *o, struct value *v)
{
    return o->smokes->items[o->smoke_number].temperature[0] != '\0' &&
           get_smoke(o, v);
}

/* Reads where a smoke is that is not fitted into a box. */
static bool get_smoke_place(const struct owner *o, struct value *v)
{
    return !smoke_has_box(&o->smoke) && get_smoke(o, v);
}

/* ---- lamps ---- */

static bool get_strength(const struct owner *o, struct value *v)
{
    v->number = color_largest(o->lamp.rgb);
    return true;
}

/* Reads the colour of a lamp with a largest channel of 1, white if it is off.
 */
static bool get_lamp_color(const struct owner *o, struct value *v)
{
    double most = color_largest(o->lamp.rgb);

    for (int i = 0; i < 3; i++)
        v->rgb[i] = most > 0 ? o->lamp.rgb[i] / most : 1;
    return true;
}

/* Changes the colour and keeps the strength. */
static void set_lamp_color(struct owner *o, const struct value *v)
{
    double strength = color_largest(o->lamp.rgb), most = color_largest(v->rgb);

    for (int i = 0; i < 3; i++)
        o->lamp.rgb[i] =
            most > 0 ? decimal_shortened(v->rgb[i] / most * strength) : 0;
}

static void set_strength(struct owner *o, const struct value *v)
{
    struct value color = {.number = 0};

    get_lamp_color(o, &color);
    for (int i = 0; i < 3; i++)
        o->lamp.rgb[i] = decimal_shortened(color.rgb[i] * v->number);
}

#define OF_POINT       (1u << LAMP_POINT)
#define OF_SPOT        (1u << LAMP_SPOT)
#define OF_DIRECTIONAL (1u << LAMP_DIRECTIONAL)

static const char *const lamp_kinds[LAMP_KINDS] = {
    [LAMP_POINT] = "point",
    [LAMP_SPOT] = "spot",
    [LAMP_DIRECTIONAL] = "direction",
};

static bool get_lamp_kind(const struct owner *o, struct value *v)
{
    v->number = o->lamp.kind;
    return true;
}

/* Returns true if a spot has no direction. */
static bool is_aimless(const struct lamp *l)
{
    return !(fabs(l->at[0] - l->position[0]) > 0 ||
             fabs(l->at[1] - l->position[1]) > 0 ||
             fabs(l->at[2] - l->position[2]) > 0);
}

/* Turns a spot down that has no direction. */
static void settle_lamp(struct owner *o)
{
    if (o->lamp.kind == LAMP_SPOT && is_aimless(&o->lamp))
        o->lamp.at[1] = o->lamp.position[1] - o->place.to / 10;
}

/* A new direction comes from above, since the default is the horizon. */
static void set_lamp_kind(struct owner *o, const struct value *v)
{
    struct lamp *l = &o->lamp;

    l->kind = (uint32_t)v->number;
    if (l->kind == LAMP_DIRECTIONAL && !(l->azimuth_deg > 0) &&
        !(l->elevation_deg > 0))
        l->elevation_deg = 45;
    settle_lamp(o);
}

static bool get_lamp(const struct owner *o, struct value *v)
{
    v->number = *(const double *)(const void *)((const char *)&o->lamp +
                                                o->row->member);
    return true;
}

/* The angles of a spot stay in their order. */
static void set_lamp(struct owner *o, const struct value *v)
{
    struct lamp *l = &o->lamp;

    *(double *)(void *)((char *)l + o->row->member) = v->number;
    if (o->row->member == offsetof(struct lamp, inner_deg))
        l->outer_deg = fmax(l->outer_deg, l->inner_deg);
    l->inner_deg = fmin(l->inner_deg, l->outer_deg);
    settle_lamp(o);
}

/* Sets the scale of coordinates: a step is a 200th of a power of ten that is
 * larger than the scene. */
static struct value_scale place_scale(const struct scene *scene)
{
    double reach = 1 / scene->scale, most;

    for (int k = 0; k < 3; k++)
        reach = fmax(reach, fabs(scene->center[k]) + 1 / scene->scale);
    most = pow(10, ceil(log10(reach)));
    return (struct value_scale)SCALE(-RADIANCE_MAX, RADIANCE_MAX, -most, most,
                                     most / 200, 5, );
}

/* ---- table ---- */

#define LAMP(name) \
    .get = get_lamp, .set = set_lamp, .member = offsetof(struct lamp, name)

#define LIGHTING_BY(reader, name)         \
    .get = (reader), .set = set_lighting, \
    .member = offsetof(struct lighting, name)
#define LIGHTING(name) LIGHTING_BY(get_lighting, name)

#define MEDIUM(value) .get = get_medium, .set = set_medium, .member = value

static const struct parameter_row object_rows[] = {
    {"material", ALL, VALUE_CHOICE, NULL, .get = get_assigned,
     .set = set_assigned, .name = material_name,
     .expected = "the name of a material"},
    {.label = NULL},
};

static const struct parameter_row light_rows[] = {
    {"sun", ALL, VALUE_CHOICE, NULL, .get = get_sun, .set = set_sun,
     CHOICES(switches), .expected = "off or on"},
    {"azimuth", OF_SUN, VALUE_NUMBER, &scale_azimuth,
     LIGHTING(sun.azimuth_deg)},
    {"elevation", OF_SUN, VALUE_NUMBER, &scale_elevation,
     LIGHTING(sun.elevation_deg)},
    {"turbidity", OF_SUN, VALUE_NUMBER, &scale_turbidity,
     LIGHTING(sun.turbidity)},
    {"sky image", OF_CONSTANT | OF_IMAGE, VALUE_CHOICE, NULL, .get = get_sky,
     .set = set_sky, .name = sky_name, .find = find_sky,
     .expected = "the path of an image"},
    {"strength", OF_IMAGE | OF_SUN, VALUE_NUMBER, &scale_sky,
     LIGHTING(sky_strength)},
    {"rotation", OF_IMAGE, VALUE_NUMBER, &scale_rotation,
     LIGHTING(sky_rotation_deg)},
    {"constant", OF_CONSTANT, VALUE_COLOR, &scale_radiance,
     .get = get_background, .set = set_background},
    {"exposure", ALL, VALUE_NUMBER, &scale_exposure, LIGHTING(exposure)},
    {"tone", ALL, VALUE_CHOICE, NULL, LIGHTING(tone), CHOICES(view_tones),
     .expected = "linear, reinhard or aces"},
    {"fog", ALL, VALUE_CHOICE, NULL, .get = get_preset, .set = set_preset,
     .name = fog_name, .expected = "off, fog, haze or smoke"},
    {"density", ALL, VALUE_NUMBER, &scale_density, MEDIUM(MEDIUM_DENSITY)},
    {"scatters", ALL, VALUE_TRIPLE, &scale_density, MEDIUM(MEDIUM_SCATTER)},
    {"absorbs", ALL, VALUE_TRIPLE, &scale_density, MEDIUM(MEDIUM_ABSORB)},
    {"fog colour", ALL, VALUE_COLOR, &scale_unit, MEDIUM(MEDIUM_COLOR)},
    {"anisotropy", ALL, VALUE_NUMBER, &scale_anisotropy,
     LIGHTING_BY(get_fog, fog.anisotropy)},
    {"falloff", ALL, VALUE_NUMBER, &scale_radius,
     LIGHTING_BY(get_fog, fog.falloff)},
    {"height", ALL, VALUE_NUMBER, NULL, LIGHTING_BY(get_fog_height, fog.base)},
    {.label = NULL},
};

/* Rows of each lamp. */
static const struct parameter_row lamp_rows[] = {
    {NULL, ALL, VALUE_COLOR, &scale_unit, .get = get_lamp_color,
     .set = set_lamp_color},
    {"strength", ALL, VALUE_NUMBER, &scale_emission, .get = get_strength,
     .set = set_strength},
    {"kind", ALL, VALUE_CHOICE, NULL, .get = get_lamp_kind,
     .set = set_lamp_kind, CHOICES(lamp_kinds),
     .expected = "point, spot or direction"},
    {"x", OF_POINT | OF_SPOT, VALUE_NUMBER, NULL, LAMP(position[0])},
    {"y", OF_POINT | OF_SPOT, VALUE_NUMBER, NULL, LAMP(position[1])},
    {"z", OF_POINT | OF_SPOT, VALUE_NUMBER, NULL, LAMP(position[2])},
    {"to x", OF_SPOT, VALUE_NUMBER, NULL, LAMP(at[0])},
    {"to y", OF_SPOT, VALUE_NUMBER, NULL, LAMP(at[1])},
    {"to z", OF_SPOT, VALUE_NUMBER, NULL, LAMP(at[2])},
    {"inner", OF_SPOT, VALUE_NUMBER, &scale_cone, LAMP(inner_deg)},
    {"outer", OF_SPOT, VALUE_NUMBER, &scale_cone, LAMP(outer_deg)},
    {"radius", OF_POINT | OF_SPOT, VALUE_NUMBER, &scale_radius, LAMP(radius)},
    {"azimuth", OF_DIRECTIONAL, VALUE_NUMBER, &scale_azimuth,
     LAMP(azimuth_deg)},
    {"elevation", OF_DIRECTIONAL, VALUE_NUMBER, &scale_lamp_elevation,
     LAMP(elevation_deg)},
    {"angle", OF_DIRECTIONAL, VALUE_NUMBER, &scale_disc, LAMP(angle_deg)},
};

#define SMOKE_BY(reader, name)         \
    .get = (reader), .set = set_smoke, \
    .member = offsetof(struct smoke_numbers, name)
#define SMOKE(value) \
    .get = get_smoke_medium, .set = set_smoke_medium, .member = value

/* Rows of each smoke. */
static const struct parameter_row smoke_rows[] = {
    {"smoke", ALL, VALUE_NUMBER, &scale_density, SMOKE(MEDIUM_DENSITY)},
    {"scatters", ALL, VALUE_TRIPLE, &scale_density, SMOKE(MEDIUM_SCATTER)},
    {"absorbs", ALL, VALUE_TRIPLE, &scale_density, SMOKE(MEDIUM_ABSORB)},
    {"smoke colour", ALL, VALUE_COLOR, &scale_unit, SMOKE(MEDIUM_COLOR)},
    {"anisotropy", ALL, VALUE_NUMBER, &scale_anisotropy,
     SMOKE_BY(get_smoke, anisotropy)},
    {"glow", ALL, VALUE_NUMBER, &scale_emission, SMOKE_BY(get_glow, glow)},
    {"x", ALL, VALUE_NUMBER, NULL, SMOKE_BY(get_smoke_place, at[0])},
    {"y", ALL, VALUE_NUMBER, NULL, SMOKE_BY(get_smoke_place, at[1])},
    {"z", ALL, VALUE_NUMBER, NULL, SMOKE_BY(get_smoke_place, at[2])},
    {"scale", ALL, VALUE_NUMBER, &scale_size, SMOKE_BY(get_smoke_place, scale)},
};

#define COUNT(rows) ((int)(sizeof(rows) / sizeof(rows)[0]))

/* Returns row i of the parameters that all owners of a page have, or NULL.
 * *after becomes i less their number. */
static const struct parameter_row *row_at(enum selection_page page, int i,
                                          int *after)
{
    static const struct parameter_row *const tables[] = {
        [PAGE_MATERIALS] = material_parameters,
        [PAGE_OBJECTS] = object_rows,
        [PAGE_LIGHT] = light_rows,
    };
    const struct parameter_row *row = tables[page];

    for (*after = i; row->label != NULL; row++, --*after)
        if (*after == 0)
            return row;
    return NULL;
}

/* Chooses row i of those of smokes, then of lamps. */
static bool choose_item_row(struct owner *o, int i)
{
    int smoke = i / COUNT(smoke_rows);
    int after = i - (int)o->smokes->count * COUNT(smoke_rows);
    int lamp = after / COUNT(lamp_rows);

    if (smoke < (int)o->smokes->count) {
        o->row = &smoke_rows[i % COUNT(smoke_rows)];
        o->smoke_number = (uint32_t)smoke;
        o->smoke = o->smokes->items[smoke].numbers;
        return true;
    }
    if (lamp >= (int)o->lamps->count || lamp >= PARAMETER_LAMPS)
        return false;
    o->row = &lamp_rows[after % COUNT(lamp_rows)];
    o->lamp_number = (uint32_t)lamp;
    o->lamp = o->lamps->items[lamp];
    return true;
}

bool parameter_choose_row(struct owner *o, int i)
{
    enum selection_page page = o->selection->page;
    int after;

    o->lamp_number = o->smoke_number = NO_INDEX;
    o->row = row_at(page, i, &after);
    if (o->row != NULL)
        return true;
    if (page == PAGE_MATERIALS && after < MTL_MAPS) {
        o->row = &map_parameter;
        o->map = (enum mtl_map)after;
        return true;
    }
    if (page == PAGE_MATERIALS && after == MTL_MAPS) {
        o->row = &new_map_parameter;
        o->map = o->selection->new_map;
        return true;
    }
    return page == PAGE_LIGHT && choose_item_row(o, after);
}

uint32_t parameter_heads(const struct owner *o)
{
    return o->row == &lamp_rows[0]    ? o->lamp_number + 1
           : o->row == &smoke_rows[0] ? o->smoke_number + 1
                                      : 0;
}

const char *parameter_label(const struct owner *o)
{
    if (o->row->label != NULL)
        return o->row->label;
    return o->row == &map_parameter ? mtl_maps[o->map].keys[0]
                                    : lamp_kinds[o->lamp.kind];
}

struct owner parameter_owner(const struct selection *t,
                             const struct edit_state *state)
{
    struct owner o = {.selection = t};
    uint32_t index = t->index[t->page];

    switch (t->page) {
    case PAGE_MATERIALS:
        material_parameters_open(&o, &state->sources[index], t->world);
        break;
    case PAGE_OBJECTS: o.assigned = state->assigned[index]; break;
    case PAGE_LIGHT:
        o.lighting = state->view.lighting;
        o.lamps = &state->view.lamps;
        o.smokes = &state->view.smokes;
        o.place = place_scale(t->scene);
        o.kind = o.lighting.sun.is_on          ? SKY_SUN
                 : o.lighting.sky_path != NULL ? SKY_IMAGE
                                               : SKY_CONSTANT;
        break;
    case PAGES: break;
    }
    return o;
}

bool parameter_read(const struct owner *o, struct value *v)
{
    bool is_lamp = o->lamps != NULL && o->lamp_number != NO_INDEX;
    uint32_t kind = is_lamp ? o->lamp.kind : o->kind;

    *v = (struct value){.number = 0};
    return (o->row->kinds >> kind & 1) != 0 && o->row->get(o, v);
}
