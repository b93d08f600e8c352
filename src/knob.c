// SPDX-License-Identifier: MIT
#include "glim/knob.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "glim/blackbody.h"
#include "glim/color.h"
#include "glim/look.h"
#include "glim/number.h"
#include "glim/scale.h"

/* Where a temperature begins that was none. */
#define KELVIN_WHITE 6500.0

enum knob_id {
    ID_KIND,
    ID_COLOR,
    ID_CHANNEL, /* and the two after it */
    ID_ROUGHNESS = ID_CHANNEL + 3,
    ID_COAT,
    ID_IOR,
    ID_LIGHT,
    ID_LIGHT_COLOR,
    ID_COVER,
    ID_ASSIGNED,
    ID_SKY_IMAGE,
    ID_SKY_STRENGTH,
    ID_SKY_ROTATION,
    ID_EXPOSURE,
    ID_TONE,
    ID_MAP /* and the others after it */
};

static const struct scale ior = {.least = 1e-6,
                                 .most = 1e6,
                                 .from = 1,
                                 .to = 3,
                                 .step = 0.01,
                                 .digits = 4,
                                 .expected = "a number above 0"};
static const struct scale rotation = {.least = -1e6,
                                      .most = 1e6,
                                      .to = 360,
                                      .step = 1,
                                      .digits = 4,
                                      .wraps = true,
                                      .expected = "an angle in degrees"};
static const struct scale exposure = {.least = -100,
                                      .most = 100,
                                      .from = -8,
                                      .to = 8,
                                      .step = 0.1,
                                      .digits = 3,
                                      .of = " stops",
                                      .expected =
                                          "a number of stops from -100 to 100"};
static const struct scale kelvins = {.from = 1000, .to = 20000, .step = 100};

/* ---- lists ---- */

struct list {
    struct knob *knobs;
    int count;
};

static struct knob *add(struct list *l, int id, const char *label)
{
    struct knob *k = &l->knobs[l->count];

    l->count += l->count < KNOBS_MAX - 1;
    *k = (struct knob){.id = id, .label = label, .place = -1};
    return k;
}

static void add_scale(struct list *l, int id, const char *label,
                      const struct scale *s, double value)
{
    struct knob *k = add(l, id, label);

    k->place = scale_place(s, value);
    scale_format(s, value, k->text, sizeof k->text);
}

static void add_color(struct list *l, int id, const char *label,
                      const double rgb[3])
{
    struct knob *k = add(l, id, label);

    k->has_color = true;
    memcpy(k->color, rgb, sizeof k->color);
    color_to_hex(rgb, k->text);
}

static void add_channels(struct list *l, const struct knob_target *t,
                         const double rgb[3])
{
    static const char *const rgb_labels[] = {"red", "green", "blue"};
    static const char *const hsv_labels[] = {"hue", "saturation", "value"};
    double v[3];

    memcpy(v, rgb, sizeof v);
    if (t->by_hsv)
        color_to_hsv(rgb, v);
    for (int i = 0; i < 3; i++)
        add_scale(l, ID_CHANNEL + i, t->by_hsv ? hsv_labels[i] : rgb_labels[i],
                  t->by_hsv && i == 0 ? &scale_hue : &scale_unit, v[i]);
}

static void add_light(struct list *l, const struct mtl_source *s)
{
    double strength = look_strength(s);
    struct knob *k = add(l, ID_LIGHT, "light");
    double rgb[3];

    k->place = scale_place(&scale_light, strength);
    if (!(strength > 0)) {
        snprintf(k->text, sizeof k->text, "off");
        return;
    }
    scale_format(&scale_light, strength, k->text, sizeof k->text);
    look_light_color(s, rgb);
    add_color(l, ID_LIGHT_COLOR, "of colour", rgb);
    k = &l->knobs[l->count - 1];
    if (s->kelvin.line != 0)
        snprintf(k->text, sizeof k->text, "%.6gK", s->kelvin.value);
}

static void add_maps(struct list *l, const struct scene *scene,
                     const struct mtl_source *s)
{
    for (int i = 0; i < MTL_MAPS; i++) {
        const char *path, *slash;
        struct knob *k;

        if (s->maps[i] == NO_INDEX)
            continue;
        path = scene->texture_paths[s->maps[i]];
        slash = strrchr(path, '/');
        k = add(l, ID_MAP + i, mtl_map_keys[i]);
        snprintf(k->text, sizeof k->text, "%s %.50s",
                 (s->maps_off >> i & 1) != 0 ? "off" : "on",
                 slash != NULL ? slash + 1 : path);
    }
}

static void list_material(struct list *l, const struct scene *scene,
                          const struct knob_target *t,
                          const struct mtl_source *s)
{
    struct material m = look_material(s);
    double rgb[3];

    snprintf(add(l, ID_KIND, "type")->text, sizeof l->knobs->text, "%s",
             look_kind(s));
    look_color(s, rgb);
    add_color(l, ID_COLOR, look_is_glass(&m) ? "tint" : "colour", rgb);
    add_channels(l, t, rgb);
    if (m.kind != MATERIAL_THIN_GLASS)
        add_scale(l, ID_ROUGHNESS, "roughness", &scale_unit, look_roughness(s));
    if (m.kind == MATERIAL_PLASTIC)
        add_scale(l, ID_COAT, "coat", &scale_unit, look_largest(s->ks.rgb));
    if (look_is_glass(&m))
        add_scale(l, ID_IOR, "index", &ior, (double)m.ior);
    else
        add_scale(l, ID_COVER, "cover", &scale_unit, (double)m.opacity);
    add_light(l, s);
    add_maps(l, scene, s);
}

static void list_mood(struct list *l, const struct edit *e,
                      const struct knob_target *t, const struct mood *m)
{
    const char *path = e->skies.items[m->sky];
    const char *slash = strrchr(path, '/');
    struct knob *k = add(l, ID_SKY_IMAGE, "sky image");

    snprintf(k->text, sizeof k->text, "%.60s",
             m->sky == 0     ? "none"
             : slash != NULL ? slash + 1
                             : path);
    if (m->sky != 0) {
        add_scale(l, ID_SKY_STRENGTH, "strength", &scale_light,
                  m->sky_strength);
        snprintf(k->text, sizeof k->text, "%.4g", m->sky_strength);
        add_scale(l, ID_SKY_ROTATION, "rotation", &rotation,
                  m->sky_rotation_deg);
    } else {
        add_color(l, ID_COLOR, "constant", m->background);
        add_channels(l, t, m->background);
    }
    add_scale(l, ID_EXPOSURE, "exposure", &exposure, m->exposure);
    k = add(l, ID_TONE, "tone");
    snprintf(k->text, sizeof k->text, "%s", view_tones[m->tone]);
}

int knobs_list(const struct edit *e, const struct scene *scene,
               const struct knob_target *t, struct knob knobs[KNOBS_MAX])
{
    const struct edit_state *s = edit_shown(e);
    struct list l = {knobs, 0};
    uint32_t material;

    if (t->page == KNOB_MATERIAL) {
        list_material(&l, scene, t, &s->sources[t->index]);
    } else if (t->page == KNOB_LIGHT) {
        list_mood(&l, e, t, &s->mood);
    } else {
        material = s->assigned[t->index];
        snprintf(add(&l, ID_ASSIGNED, "material")->text, sizeof knobs->text,
                 "%.60s",
                 material == NO_INDEX ? "as in the file" : e->names[material]);
    }
    return l.count;
}

/* ---- turning ---- */

/* A colour that is turned or typed: the material's or the sky's. */
static void turn_channel(double rgb[3], const struct knob_target *t,
                         int channel, int steps)
{
    double hsv[3];

    if (!t->by_hsv) {
        rgb[channel] = scale_turned(&scale_unit, rgb[channel], steps);
        return;
    }
    color_to_hsv(rgb, hsv);
    hsv[channel] = scale_turned(channel == 0 ? &scale_hue : &scale_unit,
                                hsv[channel], steps);
    color_from_hsv(hsv, rgb);
}

static void turn_material(struct mtl_source *s, const struct knob_target *t,
                          int id, int steps)
{
    struct material m = look_material(s);
    double rgb[3];

    look_color(s, rgb);
    switch (id) {
    case ID_KIND: look_turn_kind(s, steps); break;
    case ID_COLOR: break;
    case ID_CHANNEL:
    case ID_CHANNEL + 1:
    case ID_CHANNEL + 2:
        turn_channel(rgb, t, id - ID_CHANNEL, steps);
        look_set_color(s, rgb);
        break;
    case ID_ROUGHNESS:
        look_set_roughness(s,
                           scale_turned(&scale_unit, look_roughness(s), steps));
        break;
    case ID_COAT:
        /* black would be no coat, and the knob would be gone */
        rgb[0] = fmax(scale_turned(&scale_unit, look_largest(s->ks.rgb), steps),
                      scale_unit.step);
        rgb[1] = rgb[2] = rgb[0];
        look_put_color(&s->ks, rgb);
        break;
    case ID_IOR:
        look_put_number(&s->ni, scale_turned(&ior, (double)m.ior, steps));
        break;
    case ID_COVER:
        look_put_number(&s->d,
                        scale_turned(&scale_unit, (double)m.opacity, steps));
        break;
    case ID_LIGHT:
        look_set_strength(s,
                          scale_turned(&scale_light, look_strength(s), steps));
        break;
    case ID_LIGHT_COLOR:
        look_set_kelvin(s,
                        s->kelvin.line == 0
                            ? KELVIN_WHITE
                            : scale_turned(&kelvins, s->kelvin.value, steps));
        break;
    default: s->maps_off ^= 1u << (id - ID_MAP); break;
    }
}

static void turn_mood(const struct edit *e, struct mood *m,
                      const struct knob_target *t, int id, int steps)
{
    switch (id) {
    case ID_SKY_IMAGE:
        m->sky =
            (m->sky + (steps > 0 ? 1 : e->skies.count - 1)) % e->skies.count;
        break;
    case ID_SKY_STRENGTH:
        m->sky_strength = scale_turned(&scale_light, m->sky_strength, steps);
        break;
    case ID_SKY_ROTATION:
        m->sky_rotation_deg =
            scale_turned(&rotation, m->sky_rotation_deg, steps);
        break;
    case ID_EXPOSURE:
        m->exposure = scale_turned(&exposure, m->exposure, steps);
        break;
    case ID_TONE:
        m->tone = (m->tone + (steps > 0 ? 1 : TONES - 1)) % TONES;
        break;
    case ID_CHANNEL:
    case ID_CHANNEL + 1:
    case ID_CHANNEL + 2:
        turn_channel(m->background, t, id - ID_CHANNEL, steps);
        m->has_background = true;
        break;
    default: break;
    }
}

/* The next material that has a name, round; between last and first what the
 * file says. */
static uint32_t next_material(const struct edit *e, uint32_t material, int step)
{
    uint32_t count = e->material_count + 1;
    uint32_t i = material == NO_INDEX ? count - 1 : material;

    do
        i = (i + (step > 0 ? 1 : count - 1)) % count;
    while (i == 0 || (i < count - 1 && !e->now.is_there[i]));
    return i == count - 1 ? NO_INDEX : i;
}

void knob_turn(struct edit *e, const struct knob_target *t, int id, int steps)
{
    struct mtl_source source;
    struct mood mood = e->now.mood;

    if (t->page == KNOB_MATERIAL) {
        source = e->now.sources[t->index];
        turn_material(&source, t, id, steps);
        edit_material(e, t->index, &source);
    } else if (t->page == KNOB_LIGHT) {
        turn_mood(e, &mood, t, id, steps);
        edit_mood(e, &mood);
    } else {
        edit_assign(e, t->index,
                    next_material(e, e->now.assigned[t->index], steps));
    }
}

/* ---- typing ---- */

static bool parse_color(const char *text, double most, double rgb[3],
                        double *kelvin, struct error *err)
{
    if (color_parse(text, rgb, kelvin) && look_largest(rgb) <= most)
        return true;
    return fail(err,
                "found '%s', expected #rrggbb, r g b or a temperature "
                "such as 3000K",
                text);
}

/* A colour, or a number for one of its channels. */
static bool type_color(double rgb[3], double most, const struct knob_target *t,
                       int id, const char *text, struct error *err)
{
    int channel = id - ID_CHANNEL;
    double hsv[3], kelvin, x;

    if (id == ID_COLOR || strpbrk(text, "#kK ") != NULL)
        return parse_color(text, most, rgb, &kelvin, err);
    if (!t->by_hsv) {
        if (!scale_parse(most > 1 ? &scale_light : &scale_unit, text, &x, err))
            return false;
        rgb[channel] = x;
        return true;
    }
    if (!scale_parse(channel == 0 ? &scale_hue : &scale_unit, text, &x, err))
        return false;
    color_to_hsv(rgb, hsv);
    hsv[channel] = x;
    color_from_hsv(hsv, rgb);
    return true;
}

static bool type_light_color(struct mtl_source *s, const char *text,
                             struct error *err)
{
    double rgb[3], kelvin;
    const char *p = text;

    /* here a number alone is a temperature */
    if (number_parse(&p, text + strlen(text), &kelvin) && *p == '\0' &&
        kelvin >= BLACKBODY_LEAST && kelvin <= BLACKBODY_GREATEST) {
        look_set_kelvin(s, kelvin);
        return true;
    }
    if (!parse_color(text, 1e30, rgb, &kelvin, err))
        return false;
    if (kelvin > 0)
        look_set_kelvin(s, kelvin);
    else
        look_set_light_color(s, rgb);
    return true;
}

static bool type_material(struct mtl_source *s, const struct knob_target *t,
                          int id, const char *text, struct error *err)
{
    double rgb[3], x;

    look_color(s, rgb);
    switch (id) {
    case ID_COLOR:
    case ID_CHANNEL:
    case ID_CHANNEL + 1:
    case ID_CHANNEL + 2:
        if (!type_color(rgb, 1, t, id, text, err))
            return false;
        look_set_color(s, rgb);
        return true;
    case ID_ROUGHNESS:
        if (!scale_parse(&scale_unit, text, &x, err))
            return false;
        look_set_roughness(s, x);
        return true;
    case ID_COAT:
        if (!scale_parse(&scale_unit, text, &rgb[0], err))
            return false;
        rgb[1] = rgb[2] = rgb[0];
        look_put_color(&s->ks, rgb);
        return true;
    case ID_IOR:
        if (!scale_parse(&ior, text, &x, err))
            return false;
        look_put_number(&s->ni, x);
        return true;
    case ID_COVER:
        if (!scale_parse(&scale_unit, text, &x, err))
            return false;
        look_put_number(&s->d, x);
        return true;
    case ID_LIGHT:
        if (!scale_parse(&scale_light, text, &x, err))
            return false;
        look_set_strength(s, x);
        return true;
    case ID_LIGHT_COLOR: return type_light_color(s, text, err);
    default: return fail(err, "this is changed with the arrows");
    }
}

static bool parse_tone(const char *text, uint32_t *tone, struct error *err)
{
    for (uint32_t i = 0; i < TONES; i++) {
        if (strcmp(text, view_tones[i]) != 0)
            continue;
        *tone = i;
        return true;
    }
    return fail(err, "found '%s', expected linear, reinhard or aces", text);
}

static bool type_mood(struct edit *e, struct mood *m,
                      const struct knob_target *t, int id, const char *text,
                      struct error *err)
{
    switch (id) {
    case ID_SKY_IMAGE: m->sky = edit_sky(e, text); return true;
    case ID_SKY_STRENGTH:
        return scale_parse(&scale_light, text, &m->sky_strength, err);
    case ID_SKY_ROTATION:
        return scale_parse(&rotation, text, &m->sky_rotation_deg, err);
    case ID_TONE: return parse_tone(text, &m->tone, err);
    case ID_EXPOSURE: return scale_parse(&exposure, text, &m->exposure, err);
    default:
        m->has_background = true;
        return type_color(m->background, 1e30, t, id, text, err);
    }
}

static bool type_assigned(struct edit *e, uint32_t object, const char *text,
                          struct error *err)
{
    for (uint32_t i = 0; i < e->material_count; i++) {
        if (!e->now.is_there[i] || strcmp(e->names[i], text) != 0)
            continue;
        edit_assign(e, object, i);
        return true;
    }
    return fail(err, "found '%s', expected the name of a material", text);
}

bool knob_type(struct edit *e, const struct knob_target *t, int id,
               const char *text, struct error *err)
{
    struct mtl_source source;
    struct mood mood = e->now.mood;

    if (t->page == KNOB_OBJECT)
        return type_assigned(e, t->index, text, err);
    if (t->page == KNOB_LIGHT) {
        if (!type_mood(e, &mood, t, id, text, err))
            return false;
        edit_mood(e, &mood);
        return true;
    }
    source = e->now.sources[t->index];
    if (!type_material(&source, t, id, text, err))
        return false;
    edit_material(e, t->index, &source);
    return true;
}
