// SPDX-License-Identifier: MIT
#include "studio/parameter.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

#include "picture/color.h"
#include "studio/material_params.h"
#include "studio/value_scale.h"

/* Where a temperature begins that was none. */
#define KELVIN_WHITE 6500.0

static const struct value_scale kelvins = {.from = 1000,
                                           .to = 20000,
                                           .step = 100};

/* ---- lists ---- */

struct list {
    struct parameter *knobs;
    int count;
};

static struct parameter *add(struct list *l, int id, const char *label)
{
    struct parameter *k = &l->knobs[l->count];

    l->count += l->count < PARAMETERS_MAX - 1;
    *k = (struct parameter){.id = id, .label = label, .place = -1};
    return k;
}

static void add_scale(struct list *l, int id, const char *label,
                      const struct value_scale *s, double value)
{
    struct parameter *k = add(l, id, label);

    k->place = value_scale_place(s, value);
    value_scale_format(s, value, k->text, sizeof k->text);
}

static void add_color(struct list *l, int id, const char *label,
                      const double rgb[3])
{
    struct parameter *k = add(l, id, label);

    k->has_color = true;
    memcpy(k->color, rgb, sizeof k->color);
    color_to_hex(rgb, k->text);
}

static void add_channels(struct list *l, const struct parameter_target *t,
                         const double rgb[3])
{
    static const char *const rgb_labels[] = {"red", "green", "blue"};
    static const char *const hsv_labels[] = {"hue", "saturation", "value"};
    double v[3];

    memcpy(v, rgb, sizeof v);
    if (t->by_hsv)
        color_to_hsv(rgb, v);
    for (int i = 0; i < 3; i++)
        add_scale(l, PARAMETER_CHANNEL + i,
                  t->by_hsv ? hsv_labels[i] : rgb_labels[i],
                  t->by_hsv && i == 0 ? &scale_hue : &scale_unit, v[i]);
}

static void add_light(struct list *l, const struct mtl_source *s)
{
    double strength = material_params_strength(s);
    struct parameter *k = add(l, PARAMETER_GLOW, "light");
    double rgb[3];

    k->place = value_scale_place(&scale_light, strength);
    if (!(strength > 0)) {
        snprintf(k->text, sizeof k->text, "off");
        return;
    }
    value_scale_format(&scale_light, strength, k->text, sizeof k->text);
    material_params_light_color(s, rgb);
    add_color(l, PARAMETER_GLOW_COLOR, "of colour", rgb);
    k = &l->knobs[l->count - 1];
    if (s->kelvin.line != 0)
        snprintf(k->text, sizeof k->text, "%.6gK", s->kelvin.value);
}

static void add_maps(struct list *l, const struct scene *scene,
                     const struct mtl_source *s)
{
    for (int i = 0; i < MTL_MAPS; i++) {
        const char *path, *slash;
        struct parameter *k;

        if (s->maps[i] == NO_INDEX)
            continue;
        path = scene->texture_paths[s->maps[i]];
        slash = strrchr(path, '/');
        k = add(l, PARAMETER_MAP + i, mtl_map_keys[i]);
        snprintf(k->text, sizeof k->text, "%s %.50s",
                 (s->maps_off >> i & 1) != 0 ? "off" : "on",
                 slash != NULL ? slash + 1 : path);
    }
}

static void list_material(struct list *l, const struct scene *scene,
                          const struct parameter_target *t,
                          const struct mtl_source *s)
{
    struct material m = material_params_material(s);
    double rgb[3];

    snprintf(add(l, PARAMETER_KIND, "type")->text, sizeof l->knobs->text, "%s",
             material_params_kind(s));
    material_params_color(s, rgb);
    add_color(l, PARAMETER_COLOR,
              material_params_is_glass(&m) ? "tint" : "colour", rgb);
    add_channels(l, t, rgb);
    if (m.kind != MATERIAL_THIN_GLASS)
        add_scale(l, PARAMETER_ROUGHNESS, "roughness", &scale_unit,
                  material_params_roughness(s));
    if (m.kind == MATERIAL_PLASTIC)
        add_scale(l, PARAMETER_COAT, "coat", &scale_unit,
                  material_params_largest(s->ks.rgb));
    if (material_params_is_glass(&m))
        add_scale(l, PARAMETER_IOR, "index", &scale_ior, (double)m.ior);
    else
        add_scale(l, PARAMETER_COVER, "cover", &scale_unit, (double)m.opacity);
    add_light(l, s);
    add_maps(l, scene, s);
}

static void list_mood(struct list *l, const struct edit *e,
                      const struct parameter_target *t, const struct mood *m)
{
    const char *path = e->skies.items[m->sky];
    const char *slash = strrchr(path, '/');
    struct parameter *k = add(l, PARAMETER_SKY_IMAGE, "sky image");

    snprintf(k->text, sizeof k->text, "%.60s",
             m->sky == 0     ? "none"
             : slash != NULL ? slash + 1
                             : path);
    if (m->sky != 0) {
        add_scale(l, PARAMETER_SKY_STRENGTH, "strength", &scale_light,
                  m->sky_strength);
        snprintf(k->text, sizeof k->text, "%.4g", m->sky_strength);
        add_scale(l, PARAMETER_SKY_ROTATION, "rotation", &scale_rotation,
                  m->sky_rotation_deg);
    } else {
        add_color(l, PARAMETER_COLOR, "constant", m->background);
        add_channels(l, t, m->background);
    }
    add_scale(l, PARAMETER_EXPOSURE, "exposure", &scale_exposure, m->exposure);
    k = add(l, PARAMETER_TONE, "tone");
    snprintf(k->text, sizeof k->text, "%s", view_tones[m->tone]);
}

int parameters_list(const struct edit *e, const struct scene *scene,
                    const struct parameter_target *t,
                    struct parameter knobs[PARAMETERS_MAX])
{
    const struct edit_state *s = edit_shown(e);
    struct list l = {knobs, 0};
    uint32_t material;

    if (t->page == PARAMETER_MATERIAL) {
        list_material(&l, scene, t, &s->sources[t->index]);
    } else if (t->page == PARAMETER_LIGHT) {
        list_mood(&l, e, t, &s->mood);
    } else {
        material = s->assigned[t->index];
        snprintf(add(&l, PARAMETER_ASSIGNED, "material")->text,
                 sizeof knobs->text, "%.60s",
                 material == NO_INDEX ? "as in the file" : e->names[material]);
    }
    return l.count;
}

/* ---- turning ---- */

/* A colour that is turned or typed: the material's or the sky's. */
static void turn_channel(double rgb[3], const struct parameter_target *t,
                         int channel, int steps)
{
    double hsv[3];

    if (!t->by_hsv) {
        rgb[channel] = value_scale_turned(&scale_unit, rgb[channel], steps);
        return;
    }
    color_to_hsv(rgb, hsv);
    hsv[channel] = value_scale_turned(channel == 0 ? &scale_hue : &scale_unit,
                                      hsv[channel], steps);
    color_from_hsv(hsv, rgb);
}

static void turn_material(struct mtl_source *s,
                          const struct parameter_target *t, int id, int steps)
{
    struct material m = material_params_material(s);
    double rgb[3];

    material_params_color(s, rgb);
    switch (id) {
    case PARAMETER_KIND: material_params_turn_kind(s, steps); break;
    case PARAMETER_COLOR: break;
    case PARAMETER_CHANNEL:
    case PARAMETER_CHANNEL + 1:
    case PARAMETER_CHANNEL + 2:
        turn_channel(rgb, t, id - PARAMETER_CHANNEL, steps);
        material_params_set_color(s, rgb);
        break;
    case PARAMETER_ROUGHNESS:
        material_params_set_roughness(
            s, value_scale_turned(&scale_unit, material_params_roughness(s),
                                  steps));
        break;
    case PARAMETER_COAT:
        /* black would be no coat, and the knob would be gone */
        rgb[0] =
            fmax(value_scale_turned(&scale_unit,
                                    material_params_largest(s->ks.rgb), steps),
                 scale_unit.step);
        rgb[1] = rgb[2] = rgb[0];
        material_params_put_color(&s->ks, rgb);
        break;
    case PARAMETER_IOR:
        material_params_put_number(&s->ni,
                                   value_scale_turned(&scale_ior, (double)m.ior,
                                                      steps));
        break;
    case PARAMETER_COVER:
        material_params_put_number(&s->d, value_scale_turned(&scale_unit,
                                                             (double)m.opacity,
                                                             steps));
        break;
    case PARAMETER_GLOW:
        material_params_set_strength(
            s, value_scale_turned(&scale_light, material_params_strength(s),
                                  steps));
        break;
    case PARAMETER_GLOW_COLOR:
        material_params_set_kelvin(s, s->kelvin.line == 0
                                          ? KELVIN_WHITE
                                          : value_scale_turned(&kelvins,
                                                               s->kelvin.value,
                                                               steps));
        break;
    default: s->maps_off ^= 1u << (id - PARAMETER_MAP); break;
    }
}

static void turn_mood(const struct edit *e, struct mood *m,
                      const struct parameter_target *t, int id, int steps)
{
    switch (id) {
    case PARAMETER_SKY_IMAGE:
        m->sky =
            (m->sky + (steps > 0 ? 1 : e->skies.count - 1)) % e->skies.count;
        break;
    case PARAMETER_SKY_STRENGTH:
        m->sky_strength =
            value_scale_turned(&scale_light, m->sky_strength, steps);
        break;
    case PARAMETER_SKY_ROTATION:
        m->sky_rotation_deg =
            value_scale_turned(&scale_rotation, m->sky_rotation_deg, steps);
        break;
    case PARAMETER_EXPOSURE:
        m->exposure = value_scale_turned(&scale_exposure, m->exposure, steps);
        break;
    case PARAMETER_TONE:
        m->tone = (m->tone + (steps > 0 ? 1 : TONES - 1)) % TONES;
        break;
    case PARAMETER_CHANNEL:
    case PARAMETER_CHANNEL + 1:
    case PARAMETER_CHANNEL + 2:
        turn_channel(m->background, t, id - PARAMETER_CHANNEL, steps);
        material_params_shorten(m->background);
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

void parameter_turn(struct edit *e, const struct parameter_target *t, int id,
                    int steps)
{
    struct mtl_source source;
    struct mood mood = e->now.mood;

    if (t->page == PARAMETER_MATERIAL) {
        source = e->now.sources[t->index];
        turn_material(&source, t, id, steps);
        edit_material(e, t->index, &source);
    } else if (t->page == PARAMETER_LIGHT) {
        turn_mood(e, &mood, t, id, steps);
        edit_mood(e, &mood);
    } else {
        edit_assign(e, t->index,
                    next_material(e, e->now.assigned[t->index], steps));
    }
}
