// SPDX-License-Identifier: MIT
#include "session/option_view.h"

#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "base/decimal.h"
#include "base/lexer.h"
#include "formats/view_parse.h"
#include "picture/color.h"
#include "terminal/xmalloc.h"

/* A line of three numbers is the longest but for names of files. */
#define LINE_BYTES (32 + 3 * DECIMAL_TEXT_BYTES)

static void add_line(struct options *o, const char *line)
{
    char *before = o->view_lines;

    o->view_lines = xformat("%s%s\n", before ? before : "", line);
    free(before);
}

void option_view_add(struct options *o, const char *format, ...)
{
    char line[LINE_BYTES];
    va_list values;

    va_start(values, format);
    vsnprintf(line, sizeof line, format, values);
    va_end(values);
    add_line(o, line);
}

/* Adds the line of a key with these numbers. */
static void add_numbers(struct options *o, const struct view_key *key,
                        const double *values)
{
    char text[3][DECIMAL_TEXT_BYTES] = {"", "", ""};

    for (int i = 0; i < key->count; i++)
        decimal_format(text[i], values[i]);
    option_view_add(o, "%s %s %s %s", key->name, text[0], text[1], text[2]);
}

static bool fail_value(const struct option_given *g, const char *expected,
                       struct error *err)
{
    return fail(err, "%s: found '%s', expected %s", g->shown, g->value,
                expected);
}

/* Reads the numbers of a key and adds its line. */
static bool set_numbers(struct options *o, const struct option_given *g,
                        enum view_key_id id, double values[3],
                        struct error *err)
{
    const struct view_key *key = view_key(id);

    if (!view_key_numbers(key, g->value, values)) {
        char expected[128];

        snprintf(expected, sizeof expected, "%s%s%s",
                 key->count > 1 ? g->rule->value : "",
                 key->count > 1 ? ": " : "", key->expected);
        return fail_value(g, expected, err);
    }
    add_numbers(o, key, values);
    return true;
}

/* Sets the axis of the file, or the direction of the picture. */
static bool set_up(struct options *o, const struct option_given *g,
                   struct error *err)
{
    bool is_y = strcmp(g->value, "y") == 0;
    double up[3];

    if (!is_y && strcmp(g->value, "z") != 0)
        return set_numbers(o, g, KEY_UP, up, err);
    o->up = is_y ? SCENE_UP_Y : SCENE_UP_Z;
    return true;
}

/* Adds a line with the name of an image file. */
static bool set_sky_file(struct options *o, const struct option_given *g,
                         struct error *err)
{
    size_t length = strlen(g->value);
    char *name, *line;

    if (length == 0)
        return fail_value(g, g->rule->value, err);
    if (strpbrk(g->value, "\r\n") != NULL ||
        lexer_is_blank(g->value[length - 1]))
        return fail(err,
                    "%s: found a line end, or a blank at the end, in the name "
                    "of a file, expected none",
                    g->shown);
    name = xchecked(view_name(g->value, ""));
    line = xformat("sky %s%s", name, lexer_rest_guard(name));
    add_line(o, line);
    free(line);
    free(name);
    return true;
}

/* Sets the sky to a colour or an image: a file whose name is a colour is given
 * as ./1,2,3. */
static bool set_sky(struct options *o, const struct option_given *g,
                    struct error *err)
{
    const struct view_key *background = view_key(KEY_BACKGROUND);
    double rgb[3], kelvin;

    o->has_sky = true;
    if (!view_key_numbers(background, g->value, rgb) &&
        !(strchr(g->value, ' ') == NULL && color_parse(g->value, rgb, &kelvin)))
        return set_sky_file(o, g, err);
    add_numbers(o, background, rgb);
    return true;
}

/* Sets the exposure, which merge and develop take from the options. */
static bool set_exposure(struct options *o, const struct option_given *g,
                         struct error *err)
{
    double values[3];

    o->has_exposure = set_numbers(o, g, KEY_EXPOSURE, values, err);
    if (o->has_exposure)
        o->exposure = values[0];
    return o->has_exposure;
}

bool option_view_set(struct options *o, const struct option_given *g,
                     struct error *err)
{
    double values[3];

    switch (g->rule->id) {
    case OPTION_EYE: return set_numbers(o, g, KEY_EYE, values, err);
    case OPTION_AT: return set_numbers(o, g, KEY_AT, values, err);
    case OPTION_UP: return set_up(o, g, err);
    case OPTION_FOV: return set_numbers(o, g, KEY_FOVY, values, err);
    case OPTION_SKY: return set_sky(o, g, err);
    case OPTION_SKY_STRENGTH:
        return set_numbers(o, g, KEY_SKY_STRENGTH, values, err);
    case OPTION_SKY_ROTATION:
        return set_numbers(o, g, KEY_SKY_ROTATION, values, err);
    default: return set_exposure(o, g, err);
    }
}
