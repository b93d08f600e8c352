// SPDX-License-Identifier: MIT
#include "studio/parameter.h"

#include <assert.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "base/decimal.h"
#include "image/color.h"
#include "read/mtl.h"
#include "studio/material_parameters.h"
#include "studio/parameter_table.h"
#include "terminal/xmalloc.h"

/* ---- selections ---- */

static void find_first_tris(struct selection *s)
{
    const struct scene *scene = s->scene;

    free(s->first_tris);
    s->first_tris = xcalloc(scene->object_count + 1, sizeof *s->first_tris);
    for (uint32_t i = 0; i < scene->object_count; i++)
        s->first_tris[i] = NO_INDEX;
    for (uint32_t i = scene->placed_count; i-- > 0;)
        s->first_tris[scene->placed_objects[i]] = scene->placed[i].mesh_tri;
    for (uint32_t i = scene->placed_count > 0 ? scene->placed[0].first_tri
                                              : scene->tri_count;
         i-- > 0;)
        s->first_tris[scene->tri_objects[i]] = i;
}

void selection_init(struct selection *s, struct edit *edit,
                    const struct scene *scene, const struct host_world *world)
{
    *s = (struct selection){.edit = edit, .scene = scene, .world = world};
    find_first_tris(s);
    selection_settle(s);
}

void selection_free(struct selection *s)
{
    free(s->first_tris);
    free(s->listed);
}

/* ---- list of a page ---- */

static bool is_listed(const struct selection *s, uint32_t i)
{
    if (s->page == PAGE_MATERIALS)
        return i > 0 && s->edit->now.is_there[i];
    return s->first_tris[i] != NO_INDEX;
}

void selection_settle(struct selection *s)
{
    const uint32_t counts[] = {
        [PAGE_MATERIALS] = s->edit->material_count,
        [PAGE_OBJECTS] = s->edit->object_count,
        [PAGE_LIGHT] = 0,
    };
    uint32_t count = counts[s->page];

    s->listed = xrealloc(s->listed, (count + 1) * sizeof *s->listed);
    s->listed_count = s->row = 0;
    for (uint32_t i = 0; i < count; i++) {
        if (!is_listed(s, i))
            continue;
        if (i <= s->index[s->page])
            s->row = s->listed_count;
        s->listed[s->listed_count++] = i;
    }
    selection_move(s, 0);
}

bool selection_has_one(const struct selection *s)
{
    return s->page == PAGE_LIGHT || s->listed_count > 0;
}

void selection_move(struct selection *s, int steps)
{
    int row = s->row + steps;

    if (s->listed_count == 0)
        return;
    row = row >= s->listed_count ? s->listed_count - 1 : row;
    s->row = row < 0 ? 0 : row;
    s->index[s->page] = s->listed[s->row];
}

/* ---- names ---- */

struct selection_names selection_names(const struct selection *s)
{
    const struct scene *scene = s->scene;
    const struct edit *e = s->edit;
    uint32_t material = s->index[PAGE_MATERIALS];
    uint32_t object = s->index[PAGE_OBJECTS];

    return (struct selection_names){
        xstrdup(material < e->material_count ? e->names[material] : ""),
        xstrdup(object < scene->object_count ? scene->object_names[object]
                                             : "")};
}

bool selection_renew(struct selection *s, const struct selection_names *names)
{
    const struct scene *scene = s->scene;
    uint32_t found[] = {
        [PAGE_MATERIALS] = mtl_find(scene, names->material),
        [PAGE_OBJECTS] = scene_find_object(scene, names->object),
        [PAGE_LIGHT] = 0,
    };

    for (int page = 0; page <= PAGE_LIGHT; page++)
        s->index[page] = found[page] != NO_INDEX ? found[page] : 0;
    find_first_tris(s);
    selection_settle(s);
    return found[s->page] != NO_INDEX;
}

const char *selection_name(const struct selection *s, enum selection_page page,
                           uint32_t i)
{
    const char *name =
        page == PAGE_OBJECTS ? s->scene->object_names[i] : s->edit->names[i];

    return *name != '\0' ? name : "(no name)";
}

uint32_t selection_material_of(const struct selection *s, uint32_t object)
{
    const struct scene *scene = s->scene;
    uint32_t assigned = edit_shown(s->edit)->assigned[object];
    uint32_t tri = s->first_tris[object];

    if (assigned != NO_INDEX)
        return assigned;
    return scene->tris[tri].material;
}

uint32_t selection_material(const struct selection *s)
{
    return s->page == PAGE_OBJECTS
               ? selection_material_of(s, s->index[PAGE_OBJECTS])
               : s->index[PAGE_MATERIALS];
}

/* ---- parameters ---- */

/* Factor of a step on a scale whose step is a tenth of the value. */
#define GROWTH 1.1

/* First temperature of a light that had none, in kelvins. */
#define KELVIN_WHITE 6500.0

/* Number of ids for a row of the table: an id is the row times PARTS, plus 0
 * for the value or 1 to 3 for a channel of a colour. */
#define PARTS 4

/* ---- scales ---- */

static double clamped(double x, double least, double most)
{
    return x < least ? least : x > most ? most : x;
}

static double grown(const struct value_scale *s, double value, int steps)
{
    double next = fmax(value, s->from) * pow(GROWTH, steps);
    double digit;

    if (next < s->from || (value < s->from && steps < 0))
        return 0;
    /* three significant digits are finer than a step */
    digit = pow(10, floor(log10(next)) - 2);
    return fmin(round(next / digit) * digit, fmax(s->to, value));
}

static void grow_triple(const struct value_scale *s, double rgb[3], int steps)
{
    for (int i = 0; i < 3; i++)
        rgb[i] = rgb[i] > 0 ? grown(s, rgb[i], steps) : 0;
}

static double stepped(const struct value_scale *s, double value, int steps)
{
    double next;

    if (s->step == 0)
        return grown(s, value, steps);
    /* round to a multiple of the step, without digits of rounding errors */
    next = (round(value / s->step) + steps) * s->step;
    next = round(next * 1e6) / 1e6;
    if (s->wraps)
        return fmod(next + s->to, s->to);
    /* a value typed beyond the ends of the scale is not clamped */
    next = clamped(next, fmin(s->from, value), fmax(s->to, value));
    return s->is_positive ? fmax(next, s->step) : next;
}

static double fraction_of(const struct value_scale *s, double value)
{
    if (s->step != 0)
        return clamped((value - s->from) / (s->to - s->from), 0, 1);
    return value < s->from
               ? 0
               : fmin(log(value / s->from) / log(s->to / s->from), 1);
}

/* Returns the number at a position on the scale, with no more digits than steps
 * have. */
static double number_at(const struct value_scale *s, double fraction)
{
    if (s->step != 0)
        return stepped(s, s->from + fraction * (s->to - s->from), 0);
    return fraction > 0 ? grown(s, s->from * pow(s->to / s->from, fraction), 0)
                        : 0;
}

static void format_number(const struct value_scale *s, double value,
                          char text[PARAMETER_TEXT_BYTES])
{
    if (s->zero != NULL && !(value > 0))
        snprintf(text, PARAMETER_TEXT_BYTES, "%s", s->zero);
    else
        snprintf(text, PARAMETER_TEXT_BYTES, "%.*g%s", s->digits, value,
                 s->suffix != NULL ? s->suffix : "");
}

static bool parse_number(const struct value_scale *s, const char *text,
                         double *value, struct error *err)
{
    const char *p = text;

    if (decimal_parse(&p, text + strlen(text), value) && *p == '\0' &&
        *value >= s->least && *value <= s->most)
        return true;
    return fail(err, "found '%s', expected a number from %g to %g", text,
                s->least, s->most);
}

/* ---- numbers: of a parameter or a channel ---- */

static const struct value_scale *scale_of(const struct owner *o, int part)
{
    if (o->row->scale == NULL)
        return &o->place;
    if (part == 0 || !o->selection->by_hsv)
        return o->row->scale;
    return part == 1 ? &scale_hue : &scale_unit;
}

static double number_of(const struct owner *o, const struct value *v, int part)
{
    double hsv[3];

    if (part == 0)
        return v->number;
    color_to_hsv(v->rgb, hsv);
    return (o->selection->by_hsv ? hsv : v->rgb)[part - 1];
}

static void set_number(const struct owner *o, struct value *v, int part,
                       double number)
{
    double hsv[3];

    if (part == 0) {
        v->number = number;
    } else if (!o->selection->by_hsv) {
        v->rgb[part - 1] = number;
    } else {
        color_to_hsv(v->rgb, hsv);
        hsv[part - 1] = number;
        color_from_hsv(hsv, v->rgb);
    }
}

/* ---- choices ---- */

static const char *choice_name(const struct owner *o, uint32_t i)
{
    const struct parameter_row *row = o->row;

    if (row->name != NULL)
        return row->name(o, i);
    return i < row->name_count ? row->names[i] : NULL;
}

/* Returns the next choice that is offered, or the previous one. The first
 * choice follows the last. */
static uint32_t next_choice(const struct owner *o, uint32_t i, bool is_forward)
{
    uint32_t count = 0;

    while (choice_name(o, count) != NULL)
        count++;
    do
        i = (i + (is_forward ? 1 : count - 1)) % count;
    while (*choice_name(o, i) == '\0');
    return i;
}

/* ---- list of parameters ---- */

static const char *label_of(const struct owner *o, int part)
{
    static const char *const labels[2][PARTS] = {
        {NULL, "red", "green", "blue"},
        {NULL, "hue", "saturation", "value"},
    };

    return part == 0 ? parameter_label(o) : labels[o->selection->by_hsv][part];
}

static struct parameter describe(const struct owner *o, const struct value *v,
                                 int part)
{
    const struct parameter_row *row = o->row;
    struct parameter p = {.label = label_of(o, part),
                          .fraction = -1,
                          .has_steps = true,
                          .takes_text = true,
                          .map = MTL_MAPS,
                          .texture = NO_INDEX,
                          .lamp = o->lamp_number};

    if (part > 0 || row->type == VALUE_NUMBER) {
        const struct value_scale *scale = scale_of(o, part);
        double number = number_of(o, v, part);

        p.fraction = fraction_of(scale, number);
        format_number(scale, number, p.text);
        snprintf(p.takes, sizeof p.takes,
                 scale->most < RADIANCE_MAX ? "%g to %g" : "from %g",
                 scale->least, scale->most);
    } else if (row->type == VALUE_CHOICE) {
        p.takes_text = row->expected != NULL;
        snprintf(p.takes, sizeof p.takes, "%s",
                 row->expected != NULL ? row->expected : "");
        snprintf(p.text, sizeof p.text, "%.60s",
                 choice_name(o, (uint32_t)v->number));
        p.map = row->is_map ? o->map : MTL_MAPS;
        if (v->note == NULL)
            return p;
        p.texture = o->source.maps[o->map];
        snprintf(p.text + strlen(p.text), sizeof p.text - strlen(p.text),
                 " %.50s", v->note);
    } else if (row->type == VALUE_TRIPLE) {
        snprintf(p.takes, sizeof p.takes, "r g b, or one number");
        snprintf(p.text, sizeof p.text, "%.3g %.3g %.3g", v->rgb[0], v->rgb[1],
                 v->rgb[2]);
    } else {
        p.has_color = true;
        p.has_steps = row->type == VALUE_LIGHT_COLOR;
        snprintf(p.takes, sizeof p.takes, "#rrggbb, r g b%s",
                 row->type == VALUE_LIGHT_COLOR ? ", 3000K" : "");
        memcpy(p.color, v->rgb, sizeof p.color);
        if (v->number > 0)
            format_number(row->scale, v->number, p.text);
        else
            color_to_hex(v->rgb, p.text);
    }
    return p;
}

int parameters_list(const struct selection *t,
                    struct parameter list[PARAMETERS_MAX])
{
    struct owner o = parameter_owner(t, edit_shown(t->edit));
    int count = 0;

    for (int i = 0; parameter_choose_row(&o, i); i++) {
        struct value v;
        int parts = o.row->type == VALUE_COLOR ? PARTS : 1;

        if (!parameter_read(&o, &v))
            continue;
        for (int part = 0; part < parts; part++) {
            assert(count < PARAMETERS_MAX);
            list[count] = describe(&o, &v, part);
            list[count].heads = part == 0 ? parameter_heads(&o) : 0;
            list[count++].id = i * PARTS + part;
        }
    }
    return count;
}

struct lamp parameter_new_lamp(const struct selection *t, uint32_t number)
{
    const struct lamps *lamps = &t->edit->now.view.lamps;
    struct lamp lamp;

    if (number != NO_INDEX)
        return lamps->items[number];
    lamp_init(&lamp, LAMP_POINT);
    memcpy(lamp.position, t->scene->center, sizeof lamp.position);
    return lamp;
}

/* ---- changes ---- */

/* Reads the parameter with this id. */
static struct owner open_parameter(const struct selection *t, int id,
                                   struct value *v)
{
    struct owner o = parameter_owner(t, &t->edit->now);

    parameter_choose_row(&o, id / PARTS);
    parameter_read(&o, v);
    return o;
}

static void take_change(struct owner *o, const struct value *v)
{
    const struct selection *t = o->selection;
    uint32_t index = t->index[t->page];

    o->row->set(o, v);
    switch (t->page) {
    case PAGE_MATERIALS: edit_material(t->edit, index, &o->source); break;
    case PAGE_OBJECTS: edit_assign(t->edit, index, o->assigned); break;
    case PAGE_LIGHT:
        if (o->lamp_number != NO_INDEX)
            edit_lamp(t->edit, o->lamp_number, &o->lamp);
        else if (o->smoke_number != NO_INDEX)
            edit_smoke(t->edit, o->smoke_number, &o->smoke);
        else
            edit_lighting(t->edit, &o->lighting);
        break;
    case PAGES: break;
    }
}

void parameter_step(struct selection *t, int id, int steps)
{
    struct value v;
    struct owner o = open_parameter(t, id, &v);
    int part = id % PARTS;

    if (part > 0 || o.row->type == VALUE_NUMBER)
        set_number(&o, &v, part,
                   stepped(scale_of(&o, part), number_of(&o, &v, part), steps));
    else if (o.row->type == VALUE_TRIPLE)
        grow_triple(o.row->scale, v.rgb, steps);
    else if (o.row->type == VALUE_CHOICE)
        v.number = next_choice(&o, (uint32_t)v.number, steps > 0);
    else if (o.row->type == VALUE_LIGHT_COLOR)
        v.number = v.number > 0 ? stepped(o.row->scale, v.number, steps)
                                : KELVIN_WHITE;
    else
        return; /* a colour has no steps, only its channels have */
    if (o.row == &new_map_parameter)
        t->new_map = (enum mtl_map)v.number;
    else
        take_change(&o, &v);
}

void parameter_set_fraction(const struct selection *t, int id, double fraction)
{
    struct value v;
    struct owner o = open_parameter(t, id, &v);
    int part = id % PARTS;

    if (part == 0 && o.row->type != VALUE_NUMBER)
        return;
    set_number(&o, &v, part,
               number_at(scale_of(&o, part), clamped(fraction, 0, 1)));
    take_change(&o, &v);
}

bool parameter_color_at(const struct selection *t, int id, double fraction,
                        double rgb[3])
{
    struct owner o = parameter_owner(t, edit_shown(t->edit));
    int part = id % PARTS;
    struct value v;

    if (part == 0 || !parameter_choose_row(&o, id / PARTS) ||
        !parameter_read(&o, &v))
        return false;
    set_number(&o, &v, part, number_at(scale_of(&o, part), fraction));
    memcpy(rgb, v.rgb, sizeof v.rgb);
    return true;
}

/* ---- texts ---- */

static bool parse_color(const char *text, double most, struct value *v,
                        struct error *err)
{
    if (color_parse(text, v->rgb, &v->number) && color_largest(v->rgb) <= most)
        return true;
    return fail(err,
                "found '%s', expected #rrggbb, r g b or a temperature "
                "such as 3000K",
                text);
}

/* Parses three numbers, or one for all channels. */
static bool parse_triple(const struct value_scale *s, const char *text,
                         struct value *v, struct error *err)
{
    struct error ignored;
    double number;

    if (!parse_number(s, text, &number, &ignored)) {
        if (*text != '#' && color_parse(text, v->rgb, &number) && number <= 0 &&
            color_largest(v->rgb) <= s->most)
            return true;
        return fail(err, "found '%s', expected one number or three from 0 on",
                    text);
    }
    for (int i = 0; i < 3; i++)
        v->rgb[i] = number;
    return true;
}

static bool parse_choice(const struct owner *o, const char *text,
                         struct value *v, struct error *err)
{
    const char *name;

    if (o->row->find != NULL) {
        v->number = o->row->find(o, text);
        return true;
    }
    for (uint32_t i = 0; (name = choice_name(o, i)) != NULL; i++) {
        if (*name == '\0' || strcmp(name, text) != 0)
            continue;
        v->number = i;
        return true;
    }
    return fail(err, "found '%s', expected %s", text, o->row->expected);
}

/* Parses a value. For a channel the text is a number or a whole colour. */
static bool parse(const struct owner *o, const char *text, int part,
                  struct value *v, struct error *err)
{
    const struct parameter_row *row = o->row;
    struct error ignored;
    double number;

    if (row->type == VALUE_CHOICE)
        return parse_choice(o, text, v, err);
    if (row->type == VALUE_TRIPLE)
        return parse_triple(row->scale, text, v, err);
    if (row->type == VALUE_LIGHT_COLOR) /* a single number is a temperature */
        return parse_number(row->scale, text, &v->number, &ignored) ||
               parse_color(text, RADIANCE_MAX, v, err);
    if (row->type == VALUE_COLOR &&
        (part == 0 || strpbrk(text, "#kK ") != NULL))
        return parse_color(text, row->scale->most, v, err);
    if (!parse_number(scale_of(o, part), text, &number, err))
        return false;
    set_number(o, v, part, number);
    return true;
}

bool parameter_set_text(const struct selection *t, int id, const char *text,
                        struct error *err)
{
    struct value v;
    struct owner o = open_parameter(t, id, &v);

    if (!parse(&o, text, id % PARTS, &v, err))
        return false;
    take_change(&o, &v);
    return true;
}
