// SPDX-License-Identifier: MIT
#include "session/option_table.h"

#include <inttypes.h>
#include <limits.h>
#include <math.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "base/decimal.h"
#include "base/lexer.h"
#include "image/color.h"
#include "render/cpu_dispatch.h"
#include "scene/view.h"
#include "terminal/xmalloc.h"
#include "world/light/daylight.h"

/* Limits on values; anything beyond is a mistake. */
#define SPP_MAX     1000000000000u
#define THREADS_MAX 1024
#define BOUNCES_MAX 999
#define CELLS_MAX   2000
#define TIME_S_MAX  1e9 /* 32 years */
#define TILES_MAX   256
#define SEEDS_MIN   4
#define SEEDS_MAX   64
#define SHARES_MAX  100000
#define RANKS_MAX   65536
#define FRAMES_MAX  1000000

/* Limits of the time between checkpoints. */
#define INTERVAL_NS_MIN 100000000u
#define INTERVAL_NS_MAX 86400000000000u

/* A line of three numbers is the longest but for names of files. */
#define LINE_BYTES (32 + 3 * DECIMAL_TEXT_BYTES)

/* ---- common kinds of values ---- */

static bool parse_digits(const char *text, uint64_t max, uint64_t *value)
{
    return digits_parse(&text, 10, max, value) && *text == '\0';
}

const char *option_hint(const struct option_given *g)
{
    return strcmp(g->rule->name, "h") == 0 ? " (for help: glim --help)" : "";
}

static bool fail_value(const struct option_given *g, const char *expected,
                       struct error *err)
{
    return fail(err, "%s: found '%s', expected %s", g->shown, g->value,
                expected);
}

static bool set_text(const struct option_given *g, const char **text,
                     struct error *err)
{
    if (*g->value == '\0')
        return fail_value(g, g->rule->expected, err);
    *text = g->value;
    return true;
}

static bool whole_number(const struct option_given *g, uint64_t min,
                         uint64_t max, uint64_t *value, struct error *err)
{
    if (parse_digits(g->value, max, value) && *value >= min)
        return true;
    return fail(err,
                "%s: found '%s', expected a whole number from %" PRIu64
                " to %" PRIu64 "%s",
                g->shown, g->value, min, max, option_hint(g));
}

static bool set_whole(const struct option_given *g, int *value,
                      struct error *err)
{
    uint64_t number;

    if (!whole_number(g, (uint64_t)g->rule->min, (uint64_t)g->rule->max,
                      &number, err))
        return false;
    *value = (int)number;
    return true;
}

/* Sets a number that may have decimals. */
static bool set_number(const struct option_given *g, double *value,
                       struct error *err)
{
    const struct option_rule *r = g->rule;
    const char *p = g->value;
    double number;

    if (!decimal_parse(&p, p + strlen(p), &number) || *p != '\0' ||
        !(number >= r->min && number <= r->max))
        return fail(err, "%s: found '%s', expected a number from %g to %g",
                    g->shown, g->value, r->min, r->max);
    *value = number;
    return true;
}

/* Finds the value among words. */
static bool find_word(const struct option_given *g, const char *const *words,
                      int count, int *index, struct error *err)
{
    for (int i = 0; i < count && words[i] != NULL; i++) {
        if (strcmp(g->value, words[i]) == 0) {
            *index = i;
            return true;
        }
    }
    return fail_value(g, g->rule->expected, err);
}

/* ---- lines of the view ---- */

static void add_line(struct options *o, const char *line)
{
    char *before = o->view_lines;

    o->view_lines = xformat("%s%s\n", before ? before : "", line);
    free(before);
}

static void __attribute__((format(printf, 2, 3)))
add_formatted(struct options *o, const char *format, ...)
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
    add_formatted(o, "%s %s %s %s", key->name, text[0], text[1], text[2]);
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
                 key->count > 1 ? g->rule->expected : "",
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
        return fail_value(g, g->rule->expected, err);
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

    if (!set_numbers(o, g, KEY_EXPOSURE, values, err))
        return false;
    o->exposure = values[0];
    return true;
}

static bool set_tone(struct options *o, const struct option_given *g,
                     struct error *err)
{
    int index = 0;

    if (!find_word(g, view_tones, TONES, &index, err))
        return false;
    o->tone = (uint32_t)index;
    add_formatted(o, "tone %s", g->value);
    return true;
}

static bool set_light_unit(struct options *o, const struct option_given *g,
                           struct error *err)
{
    int index = 0;

    if (!find_word(g, light_units, LIGHT_UNITS, &index, err))
        return false;
    add_formatted(o, "light_unit %s", g->value);
    return true;
}

/* ---- values of their own kinds ---- */

bool option_set_scene(struct options *o, const char *path, struct error *err)
{
    if (o->scene_path)
        return fail(err, "found a second scene '%s', expected only '%s'", path,
                    o->scene_path);
    o->scene_path = path;
    return true;
}

static bool set_crop(struct options *o, const struct option_given *g,
                     struct error *err)
{
    int *const parts[4] = {&o->crop.x, &o->crop.y, &o->crop.width,
                           &o->crop.height};
    const char *p = g->value;

    for (int i = 0; i < 4; i++) {
        char text[8];
        size_t length = strcspn(p, ",");
        uint64_t number;

        if (length >= sizeof text || (p[length] == ',') != (i < 3))
            goto wrong;
        memcpy(text, p, length);
        text[length] = '\0';
        if (!parse_digits(text, VIEW_SIDE_MAX, &number) ||
            (i > 1 && number == 0))
            goto wrong;
        *parts[i] = (int)number;
        p += length + 1;
    }
    return true;
wrong:
    return fail(err,
                "%s: found '%s', expected X,Y,W,H: four whole numbers up to "
                "%d, W and H above 0",
                g->shown, g->value, VIEW_SIDE_MAX);
}

/* Parses AZ,EL. */
static bool set_sun(struct options *o, const struct option_given *g,
                    struct error *err)
{
    const char *p = g->value, *end = p + strlen(p);
    double azimuth, elevation;

    if (!decimal_parse(&p, end, &azimuth) || *p++ != ',' ||
        !decimal_parse(&p, end, &elevation) || *p != '\0' ||
        !(fabs(azimuth) <= SUN_AZIMUTH_MAX) ||
        !(fabs(elevation) <= SUN_ELEVATION_MAX))
        return fail(err,
                    "%s: found '%s', expected AZ,EL: an azimuth from -%d to "
                    "%d and an elevation from -%d to %d degrees",
                    g->shown, g->value, SUN_AZIMUTH_MAX, SUN_AZIMUTH_MAX,
                    SUN_ELEVATION_MAX, SUN_ELEVATION_MAX);
    o->sun_azimuth_deg = azimuth;
    o->sun_elevation_deg = elevation;
    return true;
}

/* Parses a relative error: a percentage, or a fraction below 1, so that a
 * forgotten % is found. */
static bool set_error(struct options *o, const struct option_given *g,
                      struct error *err)
{
    const char *p = g->value;
    double number;
    bool ok = decimal_parse(&p, p + strlen(p), &number);

    if (ok && p[0] == '%' && p[1] == '\0') {
        number /= 100;
        ok = number > 0 && number <= 1;
    } else {
        ok = ok && *p == '\0' && number > 0 && number < 1;
    }
    if (!ok)
        return fail(err, "%s: found '%s', expected %s: above 0, at most 100%%",
                    g->shown, g->value, g->rule->expected);
    o->error_limit = number;
    return true;
}

/* Parses a number of seconds, minutes or hours. */
static bool set_time(const struct option_given *g, uint64_t *ns,
                     struct error *err)
{
    static const char units[] = "smh";
    const char *p = g->value;
    double seconds;
    bool ok = decimal_parse(&p, p + strlen(p), &seconds);
    const char *unit = ok && *p != '\0' ? strchr(units, *p) : units;

    for (long i = 0; unit != NULL && i < unit - units; i++)
        seconds *= 60;
    if (!ok || unit == NULL || p[*p != '\0'] != '\0' ||
        !(seconds > 0 && seconds <= TIME_S_MAX))
        return fail(err, "%s: found '%s', expected %s: above 0, at most 1e9 s",
                    g->shown, g->value, g->rule->expected);
    *ns = seconds > 1e-9 ? (uint64_t)(seconds * 1e9) : 1;
    return true;
}

static bool set_interval(struct options *o, const struct option_given *g,
                         struct error *err)
{
    if (!set_time(g, &o->checkpoint_ns, err))
        return false;
    return (o->checkpoint_ns >= INTERVAL_NS_MIN &&
            o->checkpoint_ns <= INTERVAL_NS_MAX) ||
           fail(err, "%s: found '%s', expected 0.1 s to 24 h", g->shown,
                g->value);
}

/* Parses two whole numbers with a sign between them, of up to 7 digits. */
static bool parse_pair(const char *text, char sign, uint64_t max,
                       uint64_t values[2])
{
    const char *p = strchr(text, sign);
    char first[8] = "";

    if (p == NULL || (size_t)(p - text) >= sizeof first)
        return false;
    memcpy(first, text, (size_t)(p - text));
    return parse_digits(first, max, &values[0]) &&
           parse_digits(p + 1, max, &values[1]);
}

/* Parses I/N. */
static bool set_share(struct options *o, const struct option_given *g,
                      struct error *err)
{
    uint64_t share[2];

    if (!parse_pair(g->value, '/', SHARES_MAX, share) || share[0] == 0 ||
        share[0] > share[1])
        return fail(err,
                    "%s: found '%s', expected %s: two whole numbers, the first "
                    "from 1 to the second, which is at most %d",
                    g->shown, g->value, g->rule->expected, SHARES_MAX);
    o->share_index = (int)share[0];
    o->share_count = (int)share[1];
    return true;
}

/* Parses A:B. */
static bool set_frames(struct options *o, const struct option_given *g,
                       struct error *err)
{
    uint64_t frames[2];

    if (!parse_pair(g->value, ':', FRAMES_MAX - 1, frames) ||
        frames[0] > frames[1])
        return fail(err,
                    "%s: found '%s', expected A:B: two whole numbers from 0 "
                    "to %d, the second at least the first",
                    g->shown, g->value, FRAMES_MAX - 1);
    o->first_frame = (int)frames[0];
    o->last_frame = (int)frames[1];
    return true;
}

/* Parses COLSxROWS. */
static bool set_text_size(struct options *o, const struct option_given *g,
                          struct error *err)
{
    uint64_t size[2];

    if (!parse_pair(g->value, 'x', CELLS_MAX, size) || size[0] == 0 ||
        size[1] == 0)
        return fail(err,
                    "%s: found '%s', expected COLSxROWS: two whole numbers "
                    "from 1 to %d",
                    g->shown, g->value, CELLS_MAX);
    o->text_cols = (int)size[0];
    o->text_rows = (int)size[1];
    return true;
}

static bool set_probe(struct options *o, const struct option_given *g,
                      struct error *err)
{
    return whole_number(g, 0, FEATURES_ALL, &o->features, err);
}

static bool set_library_limits(struct options *o, const struct option_given *g,
                               struct error *err)
{
    const char *p = g->value;
    uint64_t time_s;

    if (!digits_parse(&p, 10, UINT_MAX, &time_s) || *p++ != ',' ||
        !digits_parse(&p, 10, UINT64_MAX, &o->library_limits.memory_bytes) ||
        *p != '\0')
        return fail(err, "%s: found '%s', expected SECONDS,BYTES", g->shown,
                    g->value);
    o->library_limits.time_s = (unsigned)time_s;
    return true;
}

static bool set_seed(struct options *o, const struct option_given *g,
                     struct error *err)
{
    uint64_t seed;

    if (!whole_number(g, 0, UINT32_MAX, &seed, err))
        return false;
    o->seed = (uint32_t)seed;
    return true;
}

/* Parses X,Y,SAMPLE. The samples of the training of radiance cells come after
 * those of pictures. */
static bool set_trace(struct options *o, const struct option_given *g,
                      struct error *err)
{
    const char *p = g->value;
    uint64_t x, y;

    if (!digits_parse(&p, 10, VIEW_SIDE_MAX - 1, &x) || *p++ != ',' ||
        !digits_parse(&p, 10, VIEW_SIDE_MAX - 1, &y) || *p++ != ',' ||
        !digits_parse(&p, 10, SPP_MAX - 1, &o->trace.index) || *p != '\0')
        return fail(err,
                    "%s: found '%s', expected X,Y,SAMPLE: three whole numbers "
                    "from 0 on, such as 120,45,3",
                    g->shown, g->value);
    o->trace.x = (uint32_t)x;
    o->trace.y = (uint32_t)y;
    o->batch = true;
    return true;
}

/* Adds the words of a list with commas. */
static bool set_aovs(struct options *o, const struct option_given *g,
                     struct error *err)
{
    const char *p = g->value;

    for (;;) {
        size_t length = strcspn(p, ",");
        int i = 0;

        while (options_aovs[i] && (strlen(options_aovs[i]) != length ||
                                   memcmp(options_aovs[i], p, length) != 0))
            i++;
        if (!options_aovs[i])
            return fail(err, "%s: found '%.*s', expected %s", g->shown,
                        length < 60 ? (int)length : 60, p, g->rule->expected);
        o->aovs |= 1u << i;
        if (p[length] == '\0')
            return true;
        p += length + 1;
    }
}

static bool set_scene(struct options *o, const struct option_given *g,
                      struct error *err)
{
    const char *path = NULL;

    return set_text(g, &path, err) && option_set_scene(o, path, err);
}

static bool set_spp(struct options *o, const struct option_given *g,
                    struct error *err)
{
    return whole_number(g, 1, SPP_MAX, &o->spp, err);
}

static bool set_time_limit(struct options *o, const struct option_given *g,
                           struct error *err)
{
    return set_time(g, &o->time_ns, err);
}

static bool set_denoise(struct options *o, const struct option_given *g,
                        struct error *err)
{
    return g->value == NULL || set_text(g, &o->denoise_path, err);
}

static bool set_isa(struct options *o, const struct option_given *g,
                    struct error *err)
{
    o->paths = cpu_kernel_named(g->value, err);
    return o->paths != NULL;
}

static bool set_color(struct options *o, const struct option_given *g,
                      struct error *err)
{
    static const char *const colors[] = {"auto", "mono", "16",
                                         "256",  "24",   "24bit"};
    int index = 0;

    if (!find_word(g, colors, 6, &index, err))
        return false;
    /* 24bit, as in COLORTERM, means truecolor */
    o->display.color =
        index > COLOR_24BIT ? COLOR_24BIT : (enum color_mode)index;
    return true;
}

/* ---- the table ---- */

static const char *const gi_kinds[] = {"cells", "exact"};
static const char *const backends[] = {"cpu", "opencl", "auto"};
static const char *const themes[] = {"auto", "dark", "light", "plain"};

#define MAIN      (1u << COMMAND_RENDER)
#define COMPARE   (1u << COMMAND_COMPARE)
#define CURVE     (1u << COMMAND_CURVE)
#define REFERENCE (1u << COMMAND_REFERENCE)
#define SCENES    (MAIN | CURVE | REFERENCE)
#define FILMS     (1u << COMMAND_MERGE | 1u << COMMAND_DEVELOP)
#define ALL       UINT_MAX

#define TO(member)     .to = offsetof(struct options, member)
#define GIVEN(member)  .given = offsetof(struct options, member)
#define CLEARS(member) .clears = offsetof(struct options, member)
#define FLAG(member)   .kind = OPTION_FLAG, GIVEN(member)
#define TEXT(member)   .kind = OPTION_TEXT, TO(member)
#define WHOLE(member, least, most) \
    .kind = OPTION_WHOLE, TO(member), .min = (least), .max = (most)
#define NUMBER(member, least, most) \
    .kind = OPTION_NUMBER, TO(member), .min = (least), .max = (most)
#define WORDS(member, list, count) \
    .kind = OPTION_WORD, TO(member), .words = (list), .word_count = (count)
#define LINE(view_key) .kind = OPTION_LINE, .key = (view_key)
#define OWN(function)  .kind = OPTION_OWN, .set = (function)
#define CONFIGURABLE   .is_configurable = true

static const struct option_rule rules[] = {
    {.kind = OPTION_TITLE, .help = "scene and picture"},
    {"f", "FILE", "the name of a scene",
     "the scene, or - with -b; -f may be omitted", SCENES, OWN(set_scene)},
    {"formats", NULL, NULL, "list the formats of scenes that glim reads", MAIN,
     FLAG(list_formats)},
    {"c", "FILE", "the name of a view file",
     "the view file (default: SCENE.view beside the scene)", SCENES,
     TEXT(view_path)},
    {"w", "WIDTH", "a width in pixels",
     "in pixels (default: from the view file, or 1024)", SCENES,
     WHOLE(width_px, 1, VIEW_SIDE_MAX)},
    {"h", "HEIGHT", "a height in pixels",
     "in pixels (default: from the view file, or 576)", SCENES,
     WHOLE(height_px, 1, VIEW_SIDE_MAX)},
    {"s", "SAMPLES", "a number of samples",
     "stop at this number of samples per pixel (default: 16, or none "
     "with -e or --time)",
     SCENES, OWN(set_spp), GIVEN(has_spp)},
    {"e", "ERROR", "an error such as 1% or 0.01",
     "stop at this error of the picture, such as 1% or 0.01", MAIN,
     OWN(set_error)},
    {"time", "TIME", "a time such as 90, 1.5m or 2h",
     "stop after this time of rendering, such as 90, 1.5m or 2h", SCENES,
     OWN(set_time_limit)},
    {"adaptive", NULL, NULL,
     "more samples where the error is (default with -e, and with --denoise "
     "without a file)",
     SCENES, FLAG(adaptive), CLEARS(no_adaptive)},
    {"no-adaptive", NULL, NULL, "the same number of samples in each pixel",
     SCENES, FLAG(no_adaptive), CLEARS(adaptive)},
    {"gi", "KIND", "cells or exact",
     "exact: no cells of space, in which light after two bounces, and what is "
     "seen through glass, is blurred (default: cells)",
     SCENES, WORDS(gi, gi_kinds, 2)},
    {"d", "BOUNCES", "a number of bounces",
     "most bounces of a path, 0 to 999 (default: from the view file, or "
     "no limit)",
     SCENES, WHOLE(max_bounces, 0, BOUNCES_MAX), GIVEN(has_max_bounces)},
    {"seed", "N", "a number", "seed of the noise, 0 to 4294967295 (default: 0)",
     SCENES, OWN(set_seed), GIVEN(has_seed)},
    {"crop", "X,Y,W,H", "X,Y,W,H in pixels",
     "render W x H pixels with (X, Y) as the upper left one", SCENES,
     OWN(set_crop), GIVEN(has_crop)},
    {"eye", "X,Y,Z", "X,Y,Z", "position of the camera, instead of the view's",
     SCENES, LINE(KEY_EYE)},
    {"at", "X,Y,Z", "X,Y,Z", "point that the camera looks at", SCENES,
     LINE(KEY_AT)},
    {"up", "y|z|X,Y,Z", "y, z or a direction X,Y,Z",
     "y or z: axis that points up in the scene file (default: that of its "
     "format); X,Y,Z: upward direction of the picture",
     SCENES, OWN(set_up)},
    {"fov", "DEGREES", "an angle in degrees", "vertical field of view", SCENES,
     LINE(KEY_FOVY)},
    {"camera", "N|NAME", "the number or name of a camera",
     "a numbered view of the view file, or a camera of the scene file", SCENES,
     TEXT(camera)},
    {"scene", "N|NAME", "the number or name of a scene",
     "one of several scenes of a glTF file (default: the file's own)", SCENES,
     TEXT(choice.scene)},
    {"variant", "N|NAME", "the number or name of a variant",
     "variant of the materials of a glTF file (default: none)", SCENES,
     TEXT(choice.variant)},
    {"animation", "N|NAME", "the number or name of an animation",
     "animation of a glTF file that poses it (default: 1)", SCENES,
     TEXT(choice.animation)},
    {"anim-time", "SECONDS", "a time in seconds",
     "pose a glTF file as its animation does then (default: at rest)", SCENES,
     NUMBER(choice.time_s, 0, 1e9), GIVEN(choice.has_time)},
    {"sky", "FILE|COLOUR", "an image file or a colour",
     "image of the sky, or its radiance: R,G,B, #rrggbb or 5000K", SCENES,
     OWN(set_sky)},
    {"sky-strength", "X", "a number",
     "factor for the sky image or the sun with its sky", SCENES,
     LINE(KEY_SKY_STRENGTH)},
    {"sky-rotation", "DEGREES", "an angle in degrees",
     "rotation of the sky about the vertical axis", SCENES,
     LINE(KEY_SKY_ROTATION)},
    {"exposure", "STOPS", "a number of stops",
     "exposure of the picture; also of merge and develop", SCENES | FILMS,
     OWN(set_exposure), GIVEN(has_exposure)},
    {"tone", "KIND", "linear, reinhard or aces",
     "tone curve: linear, reinhard or aces; also of merge and develop",
     SCENES | FILMS, OWN(set_tone), GIVEN(has_tone)},
    {"light-unit", "UNIT", "auto, lumen, watt or none",
     "unit of the lights of glTF: auto, lumen, watt or none", SCENES,
     OWN(set_light_unit)},
    {"sun", "AZ,EL", "AZ,EL in degrees",
     "the sun in a clear sky, AZ degrees clockwise from -z and EL above "
     "the horizon, instead of the view's sky",
     SCENES, OWN(set_sun), GIVEN(has_sun)},
    {"turbidity", "T", "a number",
     "haze of the sun's sky, 1.7 to 10 (default: from the view file, or "
     "3)",
     SCENES, NUMBER(turbidity, TURBIDITY_MIN, TURBIDITY_MAX)},
    {"t", "THREADS", "a number of threads",
     "1 to 1024 threads (default: one for each processor)", SCENES,
     WHOLE(thread_count, 1, THREADS_MAX), CONFIGURABLE},
    {"stats", "FILE", "the name of a file",
     "write times and counts as JSON, - to standard output", MAIN,
     TEXT(stats_path)},
    {.kind = OPTION_TITLE, .help = "device"},
    {"backend", "KIND", "cpu, opencl or auto",
     "cpu, opencl or auto: an OpenCL GPU if there is one, else the CPU "
     "(default: cpu)",
     SCENES, WORDS(backend, backends, 3), GIVEN(has_backend), CONFIGURABLE},
    {"device", "N|NAME", "the number or name of a device",
     "number or part of the name of the OpenCL device (default: the "
     "first GPU, or the first device)",
     SCENES, TEXT(device)},
    {"list-devices", NULL, NULL, "list the OpenCL devices", MAIN,
     FLAG(list_devices)},
    {"kernels", "FOLDER", "the name of a folder",
     "read the OpenCL kernels from this folder", MAIN, TEXT(kernels_path)},
    {"isa", "NAME", "the name of a set of instructions",
     "instruction set: plain, avx2 or avx512 (default: the best of the "
     "processor, see --version)",
     MAIN, OWN(set_isa)},
    /* internal, see cl_probe.h */
    {"probe", NULL, "a number of features", NULL, MAIN, OWN(set_probe),
     GIVEN(probe)},
    /* internal, see import.h */
    {"import", NULL, "limits of time and memory", NULL, MAIN,
     OWN(set_library_limits), GIVEN(is_import)},
    /* internal, see gltf_draco.h */
    {"unpack", NULL, "limits of time and memory", NULL, MAIN,
     OWN(set_library_limits), GIVEN(is_unpack)},
    /* internal, see vdb_read.h */
    {"voxels", NULL, "limits of time and memory", NULL, MAIN,
     OWN(set_library_limits), GIVEN(is_voxels)},
    {.kind = OPTION_TITLE,
     .help = "clusters, in a program that is built with make MPI=1"},
    {"ranks", "N", "a number of processes",
     "start N processes that render together", MAIN,
     WHOLE(ranks, 1, RANKS_MAX)},
    /* internal, see cluster.h */
    {"worker", NULL, NULL, NULL, MAIN, FLAG(is_worker)},
    {.kind = OPTION_TITLE, .help = "batch mode"},
    {"b", NULL, NULL, "render to a file, without the screen", MAIN,
     FLAG(batch)},
    {"o", "FILE", "the name of a picture",
     ".png, .hdr, .pfm or .exr file to write or replace, or - for standard "
     "output (default: a new .png file in the current folder, named "
     "after the scene)",
     MAIN | COMPARE | CURVE | FILMS, TEXT(output_path)},
    {"turntable", "N", "a number of frames",
     "render N pictures around the point that the camera looks at, to "
     "numbered files such as out-0000.png",
     MAIN, WHOLE(turntable_count, 1, FRAMES_MAX)},
    {"fly", "N", "a number of frames",
     "render N pictures along a smooth path through the numbered views", MAIN,
     WHOLE(fly_count, 2, FRAMES_MAX)},
    {"frames", "A:B", "A:B",
     "only frames A to B, from 0 on, of these; alone, frames of the animation "
     "of a glTF file",
     MAIN, OWN(set_frames), GIVEN(has_frames)},
    {"fps", "N", "a number",
     "frames of a second of animation or video, 1 to 1000 (default: 24)", MAIN,
     NUMBER(fps, 1, 1000)},
    {"denoise", "[=FILE]", "the name of a picture",
     "filter the noise out of the picture; with a file write the "
     "filtered picture to this .png, .hdr, .pfm or .exr file and the "
     "unfiltered one to that of -o",
     MAIN | FILMS, OWN(set_denoise), GIVEN(denoise), .value_is_optional = true},
    {"ansi", "COLSxROWS", "COLSxROWS in characters",
     "write coloured text of at most this size instead of a picture, to "
     "the file of -o or standard output",
     MAIN, OWN(set_text_size)},
    {"error-map", "FILE", "the name of a picture",
     "write a .png, .hdr, .pfm or .exr picture of the error of each pixel: "
     "heat colours from black, 0.1 %, to white, 100 %",
     MAIN, TEXT(error_map_path)},
    {"aov", "LIST",
     "a list of albedo, normals, position, depth, uv, object and material",
     "also write properties of the surfaces, to files such as "
     "out.normals.pfm, or to layers of an .exr file: a list of albedo, "
     "normals, position, depth, uv, object and material, with commas",
     MAIN, OWN(set_aovs)},
    {"show", "KIND",
     "light, preview, normals, faces, uvs, depth, materials or cost",
     "preview, normals, faces, uvs, depth, materials or cost instead of "
     "light",
     MAIN, WORDS(show, options_shows, SHOW_KINDS)},
    {"trace", "X,Y,SAMPLE", "X,Y,SAMPLE",
     "print the path of one sample of a pixel, each counted from 0, of a saved "
     "picture in place of the scene, or of what these options render",
     MAIN, OWN(set_trace), GIVEN(has_trace)},
    {.kind = OPTION_TITLE, .help = "films, in batch mode"},
    {"film", "FILE", "the name of a film",
     "write the film, the exact sums of all samples", MAIN, TEXT(film_path)},
    {"checkpoint", "FILE", "the name of a film",
     "write the film at the end, after a signal, and while rendering", MAIN,
     TEXT(checkpoint_path)},
    {"checkpoint-interval", "TIME", "a time such as 90, 1.5m or 2h",
     "time between checkpoints (default: 60)", MAIN, OWN(set_interval),
     GIVEN(has_checkpoint_interval)},
    {"resume", "FILE", "the name of a film",
     "go on with a film of the same picture; if it is that of "
     "--checkpoint it may be missing at first",
     MAIN, TEXT(resume_path)},
    {"share", "I/N", "I/N such as 3/8",
     "render only share I, from 1 to N, of the samples", MAIN, OWN(set_share)},
    {.kind = OPTION_TITLE, .help = "screen"},
    {"color", "MODE", "24, 256, 16, mono or auto",
     "24, 256, 16, mono or auto (default: auto)", MAIN, OWN(set_color),
     GIVEN(has_color), CONFIGURABLE},
    {"glyph", "KIND",
     "auto, half, block, braille, shade, space, ascii, sixel or kitty",
     "characters: half, block, braille, shade, space or ascii; pixels: sixel "
     "or kitty; or auto: block or space, in 16 colours shade, without colours "
     "braille or ascii (default: auto)",
     MAIN, WORDS(display.glyph, term_caps_glyph_names, GLYPH_KITTY + 1),
     GIVEN(display.has_glyph), CONFIGURABLE},
    {"theme", "NAME", "auto, dark, light or plain",
     "colours of the text: dark, light, plain (the terminal's own) or auto: "
     "as the terminal's background (default: auto)",
     MAIN, WORDS(display.theme, themes, 4), CONFIGURABLE},
    {"cell-aspect", "R", "a number",
     "height of a character over its width, 0.25 to 8 (default: ask the "
     "terminal)",
     MAIN, NUMBER(display.cell_aspect, 0.25, 8), CONFIGURABLE},
    {"filter", NULL, NULL,
     "filter the noise out of the picture on the screen in live mode "
     "(default)",
     MAIN, .kind = OPTION_FLAG, CLEARS(no_filter), CONFIGURABLE},
    {"no-filter", NULL, NULL, "show the picture with its noise", MAIN,
     FLAG(no_filter), CONFIGURABLE},
    {"watch", NULL, NULL, "load the scene's files again when they change", MAIN,
     FLAG(watch)},
    {"sessions", NULL, NULL, "list kept sessions", MAIN, FLAG(list_sessions)},
    {"phoe-keys", NULL, NULL,
     "W S A D Q E move up, down, left, right, forward, back", MAIN,
     FLAG(phoe_keys), CONFIGURABLE},
    {.kind = OPTION_TITLE, .help = "measurements"},
    {"seeds", "N", "a number of seeds",
     "4 to 64 seeds (default: 8), from --seed on (default: 1000000)", REFERENCE,
     WHOLE(seed_count, SEEDS_MIN, SEEDS_MAX)},
    {"csv", "FILE", "the name of a file",
     "write the curve as comma-separated values", CURVE, TEXT(csv_path)},
    {"tiles", "N", "a number of tiles",
     "most tiles each way, 1 to 256 (default: 16)", COMPARE,
     WHOLE(tile_count, 1, TILES_MAX)},
    {"false-alarms", "P", "a probability",
     "probability that anything is marked although only noise differs "
     "(default: 0.01)",
     COMPARE, NUMBER(false_alarms, 1e-9, 0.5)},
    {.kind = OPTION_TITLE, .help = "general"},
    {"help", NULL, NULL, "print this text", ALL, FLAG(show_help)},
    {"version", NULL, NULL, "print the version", ALL, FLAG(show_version)},
};

#define RULES (int)(sizeof rules / sizeof rules[0])

const struct option_rule *option_rule(int i)
{
    return i < RULES ? &rules[i] : NULL;
}

const struct option_rule *option_rule_named(const char *name, size_t length)
{
    for (int i = 0; i < RULES; i++)
        if (rules[i].name != NULL && strlen(rules[i].name) == length &&
            memcmp(rules[i].name, name, length) == 0)
            return &rules[i];
    return NULL;
}

bool option_set(struct options *o, const struct option_given *g,
                struct error *err)
{
    const struct option_rule *r = g->rule;
    void *to = (char *)o + r->to;
    double numbers[3];

    if (r->given != 0)
        *(bool *)((char *)o + r->given) = true;
    if (r->clears != 0)
        *(bool *)((char *)o + r->clears) = false;
    switch (r->kind) {
    case OPTION_TITLE:
    case OPTION_FLAG: break;
    case OPTION_TEXT: return set_text(g, to, err);
    case OPTION_WHOLE: return set_whole(g, to, err);
    case OPTION_NUMBER: return set_number(g, to, err);
    case OPTION_WORD: return find_word(g, r->words, r->word_count, to, err);
    case OPTION_LINE: return set_numbers(o, g, r->key, numbers, err);
    case OPTION_OWN: return r->set(o, g, err);
    }
    return true;
}
