// SPDX-License-Identifier: MIT
#include "studio/parameter_text.h"

#include <string.h>

#include "base/decimal.h"
#include "picture/blackbody.h"
#include "picture/color.h"
#include "studio/material_params.h"
#include "studio/value_scale.h"

static bool parse_color(const char *text, double most, double rgb[3],
                        double *kelvin, struct error *err)
{
    if (color_parse(text, rgb, kelvin) && material_params_largest(rgb) <= most)
        return true;
    return fail(err,
                "found '%s', expected #rrggbb, r g b or a temperature "
                "such as 3000K",
                text);
}

bool knob_takes_text(int id)
{
    return id != PARAMETER_KIND && id < PARAMETER_MAP;
}

/* A colour, or a number for one of its channels. */
static bool type_color(double rgb[3], double most,
                       const struct parameter_target *t, int id,
                       const char *text, struct error *err)
{
    int channel = id - PARAMETER_CHANNEL;
    double hsv[3], kelvin, x;

    if (id == PARAMETER_COLOR || strpbrk(text, "#kK ") != NULL)
        return parse_color(text, most, rgb, &kelvin, err);
    if (!t->by_hsv) {
        if (!value_scale_parse(most > 1 ? &scale_light : &scale_unit, text, &x,
                               err))
            return false;
        rgb[channel] = x;
        return true;
    }
    if (!value_scale_parse(channel == 0 ? &scale_hue : &scale_unit, text, &x,
                           err))
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
    if (decimal_parse(&p, text + strlen(text), &kelvin) && *p == '\0' &&
        kelvin >= BLACKBODY_LEAST && kelvin <= BLACKBODY_GREATEST) {
        material_params_set_kelvin(s, kelvin);
        return true;
    }
    if (!parse_color(text, 1e30, rgb, &kelvin, err))
        return false;
    if (kelvin > 0)
        material_params_set_kelvin(s, kelvin);
    else
        material_params_set_light_color(s, rgb);
    return true;
}

static bool type_material(struct mtl_source *s,
                          const struct parameter_target *t, int id,
                          const char *text, struct error *err)
{
    double rgb[3], x;

    material_params_color(s, rgb);
    switch (id) {
    case PARAMETER_COLOR:
    case PARAMETER_CHANNEL:
    case PARAMETER_CHANNEL + 1:
    case PARAMETER_CHANNEL + 2:
        if (!type_color(rgb, 1, t, id, text, err))
            return false;
        material_params_set_color(s, rgb);
        return true;
    case PARAMETER_ROUGHNESS:
        if (!value_scale_parse(&scale_unit, text, &x, err))
            return false;
        material_params_set_roughness(s, x);
        return true;
    case PARAMETER_COAT:
        if (!value_scale_parse(&scale_unit, text, &rgb[0], err))
            return false;
        rgb[1] = rgb[2] = rgb[0];
        material_params_put_color(&s->ks, rgb);
        return true;
    case PARAMETER_IOR:
        if (!value_scale_parse(&scale_ior, text, &x, err))
            return false;
        material_params_put_number(&s->ni, x);
        return true;
    case PARAMETER_COVER:
        if (!value_scale_parse(&scale_unit, text, &x, err))
            return false;
        material_params_put_number(&s->d, x);
        return true;
    case PARAMETER_GLOW:
        if (!value_scale_parse(&scale_light, text, &x, err))
            return false;
        material_params_set_strength(s, x);
        return true;
    case PARAMETER_GLOW_COLOR: return type_light_color(s, text, err);
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
                      const struct parameter_target *t, int id,
                      const char *text, struct error *err)
{
    switch (id) {
    case PARAMETER_SKY_IMAGE: m->sky = edit_sky(e, text); return true;
    case PARAMETER_SKY_STRENGTH:
        return value_scale_parse(&scale_light, text, &m->sky_strength, err);
    case PARAMETER_SKY_ROTATION:
        return value_scale_parse(&scale_rotation, text, &m->sky_rotation_deg,
                                 err);
    case PARAMETER_TONE: return parse_tone(text, &m->tone, err);
    case PARAMETER_EXPOSURE:
        return value_scale_parse(&scale_exposure, text, &m->exposure, err);
    default:
        if (!type_color(m->background, 1e30, t, id, text, err))
            return false;
        material_params_shorten(m->background);
        m->has_background = true;
        return true;
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

bool knob_set_text(struct edit *e, const struct parameter_target *t, int id,
                   const char *text, struct error *err)
{
    struct mtl_source source;
    struct mood mood = e->now.mood;

    if (t->page == PARAMETER_OBJECT)
        return type_assigned(e, t->index, text, err);
    if (t->page == PARAMETER_LIGHT) {
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
