// SPDX-License-Identifier: MIT
#include "session/option_set.h"

#include <inttypes.h>
#include <math.h>
#include <limits.h>
#include <stdlib.h>
#include <string.h>

#include "base/decimal.h"
#include "light/daylight.h"
#include "render/cpu_dispatch.h"
#include "scene/view.h"
#include "session/option_view.h"

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

static bool parse_digits(const char *text, uint64_t max, uint64_t *value)
{
    return digits_parse(&text, 10, max, value) && *text == '\0';
}

const char *option_hint(const struct option_given *g)
{
    return g->rule->id == OPTION_HEIGHT ? " (for help: glim --help)" : "";
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

static bool whole_int(const struct option_given *g, int min, int max,
                      int *value, struct error *err)
{
    uint64_t number;

    if (!whole_number(g, (uint64_t)min, (uint64_t)max, &number, err))
        return false;
    *value = (int)number;
    return true;
}

/* Finds the value in a list of words that ends with NULL. */
static bool choice(const struct option_given *g, const char *const *words,
                   int *index, struct error *err)
{
    for (int i = 0; words[i]; i++) {
        if (strcmp(g->value, words[i]) == 0) {
            *index = i;
            return true;
        }
    }
    return fail(err, "%s: found '%s', expected %s", g->shown, g->value,
                g->rule->value);
}

static bool given_text(const struct option_given *g, const char **text,
                       struct error *err)
{
    if (*g->value == '\0')
        return fail(err, "%s: found '', expected %s", g->shown, g->rule->value);
    *text = g->value;
    return true;
}

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
    o->has_crop = true;
    return true;
wrong:
    return fail(err,
                "%s: found '%s', expected X,Y,W,H: four whole numbers up to "
                "%d, W and H above 0",
                g->shown, g->value, VIEW_SIDE_MAX);
}

/* Sets a number that may have decimals. */
static bool set_decimal(const struct option_given *g, double min, double max,
                        double *value, struct error *err)
{
    const char *p = g->value;
    double number;

    if (!decimal_parse(&p, p + strlen(p), &number) || *p != '\0' ||
        !(number >= min && number <= max))
        return fail(err, "%s: found '%s', expected a number from %g to %g",
                    g->shown, g->value, min, max);
    *value = number;
    return true;
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
    o->has_sun = true;
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
                    g->shown, g->value, g->rule->value);
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
                    g->shown, g->value, g->rule->value);
    *ns = seconds > 1e-9 ? (uint64_t)(seconds * 1e9) : 1;
    return true;
}

static bool set_interval(struct options *o, const struct option_given *g,
                         struct error *err)
{
    if (!set_time(g, &o->checkpoint_ns, err))
        return false;
    o->has_checkpoint_interval = true;
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
                    g->shown, g->value, g->rule->value, SHARES_MAX);
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
    o->has_frames = true;
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
    uint64_t features;

    if (!whole_number(g, 0, UINT32_MAX, &features, err))
        return false;
    o->probe = true;
    o->features = (uint32_t)features;
    return true;
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
    o->has_seed = true;
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
                        length < 60 ? (int)length : 60, p, g->rule->value);
        o->aovs |= 1u << i;
        if (p[length] == '\0')
            return true;
        p += length + 1;
    }
}

/* Sets an option whose value is one of several words. */
static bool set_word(struct options *o, const struct option_given *g,
                     struct error *err)
{
    static const char *const backends[] = {"cpu", "opencl", "auto", NULL};
    static const char *const colors[] = {"auto", "mono",  "16", "256",
                                         "24",   "24bit", NULL};
    static const char *const themes[] = {"auto", "dark", "light", "plain",
                                         NULL};
    const char *tones[TONES + 1] = {NULL}; /* ends with NULL */
    const char *units[LIGHT_UNITS + 1] = {NULL};
    int index = 0;

    switch (g->rule->id) {
    case OPTION_BACKEND:
        if (!choice(g, backends, &index, err))
            return false;
        o->backend = (enum backend_choice)index;
        o->has_backend = true;
        return true;
    case OPTION_COLOR:
        if (!choice(g, colors, &index, err))
            return false;
        /* 24bit, as in COLORTERM, means truecolor */
        o->display.color =
            index > COLOR_24BIT ? COLOR_24BIT : (enum color_mode)index;
        o->has_color = true;
        return true;
    case OPTION_THEME:
        if (!choice(g, themes, &index, err))
            return false;
        o->display.theme = (enum theme_mode)index;
        return true;
    case OPTION_TONE:
        memcpy(tones, view_tones, sizeof view_tones);
        if (!choice(g, tones, &index, err))
            return false;
        o->tone = (uint32_t)index;
        o->has_tone = true;
        option_view_add(o, "tone %s", g->value);
        return true;
    case OPTION_LIGHT_UNIT:
        memcpy(units, light_units, sizeof light_units);
        if (!choice(g, units, &index, err))
            return false;
        option_view_add(o, "light_unit %s", g->value);
        return true;
    case OPTION_SHOW:
        if (!choice(g, options_shows, &index, err))
            return false;
        o->show = (enum show_kind)index;
        return true;
    default:
        if (!choice(g, term_caps_glyph_names, &index, err))
            return false;
        o->display.glyph = (enum glyph_mode)index;
        o->display.has_glyph = true;
        return true;
    }
}

bool option_set(struct options *o, const struct option_given *g,
                struct error *err)
{
    switch (g->rule->id) {
    case OPTION_SCENE: {
        const char *path = NULL;

        return given_text(g, &path, err) && option_set_scene(o, path, err);
    }
    case OPTION_VIEW: return given_text(g, &o->view_path, err);
    case OPTION_WIDTH: return whole_int(g, 1, VIEW_SIDE_MAX, &o->width_px, err);
    case OPTION_HEIGHT:
        return whole_int(g, 1, VIEW_SIDE_MAX, &o->height_px, err);
    case OPTION_SPP:
        o->has_spp = true;
        return whole_number(g, 1, SPP_MAX, &o->spp, err);
    case OPTION_ERROR: return set_error(o, g, err);
    case OPTION_TIME: return set_time(g, &o->time_ns, err);
    case OPTION_ADAPTIVE:
    case OPTION_NO_ADAPTIVE: /* the last one counts */
        o->adaptive = g->rule->id == OPTION_ADAPTIVE;
        o->no_adaptive = !o->adaptive;
        return true;
    case OPTION_BOUNCES:
        o->has_max_bounces = true;
        return whole_int(g, 0, BOUNCES_MAX, &o->max_bounces, err);
    case OPTION_SEED: return set_seed(o, g, err);
    case OPTION_PROBE: return set_probe(o, g, err);
    case OPTION_IMPORT:
        o->is_import = true;
        return set_library_limits(o, g, err);
    case OPTION_UNPACK:
        o->is_unpack = true;
        return set_library_limits(o, g, err);
    case OPTION_CROP: return set_crop(o, g, err);
    case OPTION_THREADS:
        return whole_int(g, 1, THREADS_MAX, &o->thread_count, err);
    case OPTION_SUN: return set_sun(o, g, err);
    case OPTION_TURBIDITY:
        return set_decimal(g, TURBIDITY_LEAST, TURBIDITY_GREATEST,
                           &o->turbidity, err);
    case OPTION_OUTPUT: return given_text(g, &o->output_path, err);
    case OPTION_TURNTABLE:
        return whole_int(g, 1, FRAMES_MAX, &o->turntable_count, err);
    case OPTION_FLY: return whole_int(g, 2, FRAMES_MAX, &o->fly_count, err);
    case OPTION_FRAMES: return set_frames(o, g, err);
    case OPTION_FPS: return set_decimal(g, 1, 1000, &o->fps, err);
    case OPTION_AOV: return set_aovs(o, g, err);
    case OPTION_ANSI: return set_text_size(o, g, err);
    case OPTION_DENOISE:
        o->denoise = true;
        return !g->value || given_text(g, &o->denoise_path, err);
    case OPTION_STATS: return given_text(g, &o->stats_path, err);
    case OPTION_ERROR_MAP: return given_text(g, &o->error_map_path, err);
    case OPTION_FILM: return given_text(g, &o->film_path, err);
    case OPTION_CHECKPOINT: return given_text(g, &o->checkpoint_path, err);
    case OPTION_CHECKPOINT_INTERVAL: return set_interval(o, g, err);
    case OPTION_RESUME: return given_text(g, &o->resume_path, err);
    case OPTION_SHARE: return set_share(o, g, err);
    case OPTION_CELL_ASPECT:
        return set_decimal(g, 0.25, 8, &o->display.cell_aspect, err);
    case OPTION_DEVICE: return given_text(g, &o->device, err);
    case OPTION_KERNELS: return given_text(g, &o->kernels_path, err);
    case OPTION_ISA:
        o->paths = cpu_kernel_named(g->value, err);
        return o->paths != NULL;
    case OPTION_EYE:
    case OPTION_AT:
    case OPTION_UP:
    case OPTION_FOV:
    case OPTION_SKY:
    case OPTION_SKY_STRENGTH:
    case OPTION_SKY_ROTATION:
    case OPTION_EXPOSURE: return option_view_set(o, g, err);
    case OPTION_CAMERA: return given_text(g, &o->camera, err);
    case OPTION_SCENE_PART: return given_text(g, &o->choice.scene, err);
    case OPTION_ANIMATION: return given_text(g, &o->choice.animation, err);
    case OPTION_VARIANT: return given_text(g, &o->choice.variant, err);
    case OPTION_ANIM_TIME:
        o->choice.has_time = true;
        return set_decimal(g, 0, 1e9, &o->choice.time_s, err);
    case OPTION_TONE:
    case OPTION_LIGHT_UNIT:
    case OPTION_BACKEND:
    case OPTION_COLOR:
    case OPTION_SHOW:
    case OPTION_THEME:
    case OPTION_GLYPH: return set_word(o, g, err);
    case OPTION_RANKS: return whole_int(g, 1, RANKS_MAX, &o->ranks, err);
    case OPTION_WORKER: o->is_worker = true; return true;
    case OPTION_BATCH: o->batch = true; return true;
    case OPTION_LIST_DEVICES: o->list_devices = true; return true;
    case OPTION_FORMATS: o->list_formats = true; return true;
    case OPTION_SESSIONS: o->list_sessions = true; return true;
    case OPTION_FILTER:
    case OPTION_NO_FILTER: /* the last one counts */
        o->no_filter = g->rule->id == OPTION_NO_FILTER;
        return true;
    case OPTION_WATCH: o->watch = true; return true;
    case OPTION_PHOE_KEYS: o->phoe_keys = true; return true;
    case OPTION_CSV: return given_text(g, &o->csv_path, err);
    case OPTION_SEEDS:
        return whole_int(g, SEEDS_MIN, SEEDS_MAX, &o->seed_count, err);
    case OPTION_TILES: return whole_int(g, 1, TILES_MAX, &o->tile_count, err);
    case OPTION_FALSE_ALARMS:
        return set_decimal(g, 1e-9, 0.5, &o->false_alarms, err);
    case OPTION_HELP: o->show_help = true; return true;
    case OPTION_VERSION: o->show_version = true; return true;
    }
    return true;
}
