// SPDX-License-Identifier: MIT
#include "glim/options.h"

#include <errno.h>
#include <inttypes.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "glim/isa.h"
#include "glim/number.h"
#include "glim/picture.h"

/* Beyond these a value is a slip of the finger, not a wish. */
#define SIDE_MAX    65536
#define SPP_MAX     1000000000000u
#define THREADS_MAX 1024
#define BOUNCES_MAX 999
#define CELLS_MAX   2000

const char options_help[] =
    "usage: glim [options] scene.obj\n"
    "       glim -b [options] [-o picture.png] scene.obj\n"
    "\n"
    "Path traces a Wavefront OBJ scene, live in the terminal; with -b into\n"
    "a file. On the screen, ? shows the keys and q quits.\n"
    "\n"
    "scene and picture\n"
    "  -f FILE          the scene, as without -f\n"
    "  -c FILE          the view file (default: SCENE.view beside the scene)\n"
    "  -w WIDTH         in pixels (default: as the view file, or 1024)\n"
    "  -h HEIGHT        in pixels (default: as the view file, or 576)\n"
    "  -s SAMPLES       samples a pixel (default: 16)\n"
    "  -d BOUNCES       0 to 999 bounces of a path (default: as the view\n"
    "                   file, or no limit)\n"
    "  --seed N         0 to 4294967295: another noise (default: 0)\n"
    "  --crop X,Y,W,H   only W x H pixels of the picture, from (X, Y) on\n"
    "  --up y|z         which way is up in the scene file (default: y)\n"
    "  -t THREADS       1 to 1024 (default: what the process may use)\n"
    "  --stats FILE     times and counts as JSON at the end, - for standard\n"
    "                   output\n"
    "\n"
    "device\n"
    "  --backend KIND   cpu, opencl or auto: OpenCL if it has a GPU, else\n"
    "                   the CPU (default: cpu)\n"
    "  --device N|NAME  the OpenCL device of this number, or with this in its\n"
    "                   name (default: the first GPU, or the first device)\n"
    "  --list-devices   show the OpenCL devices\n"
    "  --kernels FOLDER read the OpenCL kernels from there\n"
    "  --isa NAME       the processor's instructions: plain, avx2 or avx512\n"
    "                   (default: the best it has; see --version)\n"
    "\n"
    "batch mode\n"
    "  -b               render to a file, without the screen\n"
    "  -o FILE          a .png, .hdr or .pfm file, which is replaced, or -\n"
    "                   for standard output (default: a new .png file in\n"
    "                   the current folder, named after the scene)\n"
    "  --ansi COLSxROWS a text of coloured characters, at most so many, for "
    "-o\n"
    "                   or standard output, instead of a picture\n"
    "\n"
    "screen\n"
    "  --color MODE     24, 256, 16, mono or auto (default: auto)\n"
    "  --glyph KIND     half, upper, lower, quadrant, sextant, braille, space\n"
    "                   or ascii cells; sixel or kitty pixels; or auto:\n"
    "                   half or space (default: auto)\n"
    "  --cell-aspect R  height of a character over its width, 0.25 to 8\n"
    "                   (default: ask the terminal)\n"
    "  --watch          load files of the scene that have changed at once, "
    "not\n"
    "                   only when l is pressed\n"
    "  --phoe-keys      W S A D Q E move up, down, left, right, forward and\n"
    "                   back\n"
    "\n"
    "  --help           show this text\n"
    "  --version        show the version\n"
    "  --               end of the options\n";

enum option_id {
    OPTION_SCENE,
    OPTION_VIEW,
    OPTION_WIDTH,
    OPTION_HEIGHT,
    OPTION_SPP,
    OPTION_BOUNCES,
    OPTION_SEED,
    OPTION_CROP,
    OPTION_UP,
    OPTION_THREADS,
    OPTION_BACKEND,
    OPTION_DEVICE,
    OPTION_LIST_DEVICES,
    OPTION_KERNELS,
    OPTION_ISA,
    OPTION_PROBE,
    OPTION_BATCH,
    OPTION_OUTPUT,
    OPTION_ANSI,
    OPTION_STATS,
    OPTION_COLOR,
    OPTION_GLYPH,
    OPTION_CELL_ASPECT,
    OPTION_WATCH,
    OPTION_PHOE_KEYS,
    OPTION_HELP,
    OPTION_VERSION
};

struct option_rule {
    const char *name; /* as it is typed: one letter is a short option */
    enum option_id id;
    const char *value; /* what is expected behind it; NULL: nothing */
};

static const struct option_rule rules[] = {
    {"f", OPTION_SCENE, "the name of a scene"},
    {"c", OPTION_VIEW, "the name of a view file"},
    {"w", OPTION_WIDTH, "a width in pixels"},
    {"h", OPTION_HEIGHT, "a height in pixels"},
    {"s", OPTION_SPP, "a number of samples"},
    {"d", OPTION_BOUNCES, "a number of bounces"},
    {"seed", OPTION_SEED, "a number"},
    {"crop", OPTION_CROP, "X,Y,W,H in pixels"},
    {"up", OPTION_UP, "y or z"},
    {"t", OPTION_THREADS, "a number of threads"},
    {"backend", OPTION_BACKEND, "cpu, opencl or auto"},
    {"device", OPTION_DEVICE, "the number or name of a device"},
    {"list-devices", OPTION_LIST_DEVICES, NULL},
    {"kernels", OPTION_KERNELS, "the name of a folder"},
    {"isa", OPTION_ISA, "the name of a set of instructions"},
    {"probe", OPTION_PROBE, "a number of features"}, /* for glim itself */
    {"b", OPTION_BATCH, NULL},
    {"o", OPTION_OUTPUT, "the name of a picture"},
    {"ansi", OPTION_ANSI, "COLSxROWS in characters"},
    {"stats", OPTION_STATS, "the name of a file"},
    {"color", OPTION_COLOR, "24, 256, 16, mono or auto"},
    {"glyph", OPTION_GLYPH,
     "auto, half, upper, lower, quadrant, sextant, braille, space, ascii, "
     "sixel or kitty"},
    {"cell-aspect", OPTION_CELL_ASPECT, "a number"},
    {"watch", OPTION_WATCH, NULL},
    {"phoe-keys", OPTION_PHOE_KEYS, NULL},
    {"help", OPTION_HELP, NULL},
    {"version", OPTION_VERSION, NULL},
};

/* An option as it stands on the command line or in a file. */
struct given {
    const struct option_rule *rule;
    char shown[512]; /* "-w" or "--seed" or its place, for messages */
    const char *value;
};

static bool parse_digits(const char *text, uint64_t max, uint64_t *value)
{
    char *end;

    if (*text < '0' || *text > '9')
        return false; /* strtoull() takes blanks and signs */
    errno = 0;
    *value = strtoull(text, &end, 10);
    return errno == 0 && *end == '\0' && *value <= max;
}

/* -h asks for help elsewhere. */
static const char *hint(const struct given *g)
{
    return g->rule->id == OPTION_HEIGHT ? " (for help: glim --help)" : "";
}

static bool whole_number(const struct given *g, uint64_t min, uint64_t max,
                         uint64_t *value, struct error *err)
{
    if (parse_digits(g->value, max, value) && *value >= min)
        return true;
    return fail(err,
                "%s: found '%s', expected a whole number from %" PRIu64
                " to %" PRIu64 "%s",
                g->shown, g->value, min, max, hint(g));
}

static bool whole_int(const struct given *g, int min, int max, int *value,
                      struct error *err)
{
    uint64_t number;

    if (!whole_number(g, (uint64_t)min, (uint64_t)max, &number, err))
        return false;
    *value = (int)number;
    return true;
}

/* Index in the words that end with NULL. */
static bool choice(const struct given *g, const char *const *words, int *index,
                   struct error *err)
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

static bool given_text(const struct given *g, const char **text,
                       struct error *err)
{
    if (*g->value == '\0')
        return fail(err, "%s: found '', expected %s", g->shown, g->rule->value);
    *text = g->value;
    return true;
}

static bool set_scene(struct options *o, const char *path, struct error *err)
{
    if (o->scene_path)
        return fail(err, "found a second scene '%s', expected only '%s'", path,
                    o->scene_path);
    o->scene_path = path;
    return true;
}

static bool set_crop(struct options *o, const struct given *g,
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
        if (!parse_digits(text, SIDE_MAX, &number) || (i > 1 && number == 0))
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
                g->shown, g->value, SIDE_MAX);
}

static bool set_cell_aspect(struct options *o, const struct given *g,
                            struct error *err)
{
    const char *p = g->value;
    double number;

    if (!number_parse(&p, p + strlen(p), &number) || *p != '\0' ||
        !(number >= 0.25 && number <= 8.0))
        return fail(err, "%s: found '%s', expected a number from 0.25 to 8",
                    g->shown, g->value);
    o->cell_aspect = number;
    return true;
}

/* COLSxROWS */
static bool set_text_size(struct options *o, const struct given *g,
                          struct error *err)
{
    size_t length = strcspn(g->value, "x");
    char cols_text[8] = "";
    uint64_t cols = 0, rows = 0;

    if (length < sizeof cols_text && g->value[length] == 'x')
        memcpy(cols_text, g->value, length);
    if (!parse_digits(cols_text, CELLS_MAX, &cols) || cols == 0 ||
        !parse_digits(g->value + length + 1, CELLS_MAX, &rows) || rows == 0)
        return fail(err,
                    "%s: found '%s', expected COLSxROWS: two whole numbers "
                    "from 1 to %d",
                    g->shown, g->value, CELLS_MAX);
    o->text_cols = (int)cols;
    o->text_rows = (int)rows;
    return true;
}

static bool set_probe(struct options *o, const struct given *g,
                      struct error *err)
{
    uint64_t features;

    if (!whole_number(g, 0, UINT32_MAX, &features, err))
        return false;
    o->probe = true;
    o->features = (uint32_t)features;
    return true;
}

static bool set_seed(struct options *o, const struct given *g,
                     struct error *err)
{
    uint64_t seed;

    if (!whole_number(g, 0, UINT32_MAX, &seed, err))
        return false;
    o->seed = (uint32_t)seed;
    return true;
}

/* The options that choose one of some words. */
static bool set_word(struct options *o, const struct given *g,
                     struct error *err)
{
    static const char *const ups[] = {"y", "z", NULL};
    static const char *const backends[] = {"cpu", "opencl", "auto", NULL};
    static const char *const colors[] = {"auto", "mono",  "16", "256",
                                         "24",   "24bit", NULL};
    static const char *const glyphs[] = {"auto",    "half",     "upper",
                                         "lower",   "quadrant", "sextant",
                                         "braille", "space",    "ascii",
                                         "sixel",   "kitty",    NULL};
    int index = 0;

    switch (g->rule->id) {
    case OPTION_UP:
        if (!choice(g, ups, &index, err))
            return false;
        o->up_is_z = index == 1;
        return true;
    case OPTION_BACKEND:
        if (!choice(g, backends, &index, err))
            return false;
        o->backend = (enum backend_choice)index;
        o->has_backend = true;
        return true;
    case OPTION_COLOR:
        if (!choice(g, colors, &index, err))
            return false;
        /* 24bit, as in COLORTERM, is the same */
        o->color = index > COLOR_24BIT ? COLOR_24BIT : (enum color_mode)index;
        o->has_color = true;
        return true;
    default:
        if (!choice(g, glyphs, &index, err))
            return false;
        o->glyph = (enum glyph_mode)index;
        return true;
    }
}

static bool set_option(struct options *o, const struct given *g,
                       struct error *err)
{
    switch (g->rule->id) {
    case OPTION_SCENE: {
        const char *path = NULL;

        return given_text(g, &path, err) && set_scene(o, path, err);
    }
    case OPTION_VIEW: return given_text(g, &o->view_path, err);
    case OPTION_WIDTH: return whole_int(g, 1, SIDE_MAX, &o->width_px, err);
    case OPTION_HEIGHT: return whole_int(g, 1, SIDE_MAX, &o->height_px, err);
    case OPTION_SPP:
        o->has_spp = true;
        return whole_number(g, 1, SPP_MAX, &o->spp, err);
    case OPTION_BOUNCES:
        o->has_max_bounces = true;
        return whole_int(g, 0, BOUNCES_MAX, &o->max_bounces, err);
    case OPTION_SEED: return set_seed(o, g, err);
    case OPTION_PROBE: return set_probe(o, g, err);
    case OPTION_CROP: return set_crop(o, g, err);
    case OPTION_THREADS:
        return whole_int(g, 1, THREADS_MAX, &o->thread_count, err);
    case OPTION_OUTPUT: return given_text(g, &o->output_path, err);
    case OPTION_ANSI: return set_text_size(o, g, err);
    case OPTION_STATS: return given_text(g, &o->stats_path, err);
    case OPTION_CELL_ASPECT: return set_cell_aspect(o, g, err);
    case OPTION_DEVICE: return given_text(g, &o->device, err);
    case OPTION_KERNELS: return given_text(g, &o->kernels_path, err);
    case OPTION_ISA:
        o->paths = isa_named(g->value, err);
        return o->paths != NULL;
    case OPTION_UP:
    case OPTION_BACKEND:
    case OPTION_COLOR:
    case OPTION_GLYPH: return set_word(o, g, err);
    case OPTION_BATCH: o->batch = true; return true;
    case OPTION_LIST_DEVICES: o->list_devices = true; return true;
    case OPTION_WATCH: o->watch = true; return true;
    case OPTION_PHOE_KEYS: o->phoe_keys = true; return true;
    case OPTION_HELP: o->show_help = true; return true;
    case OPTION_VERSION: o->show_version = true; return true;
    }
    return true;
}

static const struct option_rule *find_rule(const char *name, size_t length)
{
    for (size_t i = 0; i < sizeof rules / sizeof rules[0]; i++) {
        if (strlen(rules[i].name) == length &&
            memcmp(rules[i].name, name, length) == 0)
            return &rules[i];
    }
    return NULL;
}

/* Finds the rule of the option at the start of `text`, which is behind its
 * dashes. */
static bool find_option(struct given *g, const char *dashes, const char *text,
                        size_t length, struct error *err)
{
    g->rule = find_rule(text, length);
    if (!g->rule || (length == 1) != (dashes[1] == '\0'))
        return fail(err, "unknown option '%s%.*s', see glim --help", dashes,
                    (int)length, text);
    /* the names in the table fit */
    memcpy(g->shown, dashes, strlen(dashes));
    memcpy(g->shown + strlen(dashes), text, length);
    g->shown[strlen(dashes) + length] = '\0';
    return true;
}

/* Takes `attached` or the next argument as the value. */
static bool take_value(struct given *g, const char *attached, int argc,
                       char **argv, int *i, struct error *err)
{
    g->value = attached;
    if (!g->value && *i + 1 < argc)
        g->value = argv[++*i];
    if (!g->value)
        return fail(err, "%s: expected %s behind it%s", g->shown,
                    g->rule->value, hint(g));
    return true;
}

/* --name, --name=value or --name value */
static bool parse_long(struct options *o, int argc, char **argv, int *i,
                       struct error *err)
{
    const char *text = argv[*i] + 2;
    size_t length = strcspn(text, "=");
    const char *attached = text[length] == '=' ? text + length + 1 : NULL;
    struct given g = {0};

    if (!find_option(&g, "--", text, length, err))
        return false;
    if (!g.rule->value && attached)
        return fail(err, "%s: found '%s', expected no value", g.shown,
                    attached);
    if (g.rule->value && !take_value(&g, attached, argc, argv, i, err))
        return false;
    return set_option(o, &g, err);
}

/* -x, -xvalue, -x value, or several letters where only the last has a value */
static bool parse_short(struct options *o, int argc, char **argv, int *i,
                        struct error *err)
{
    const char *p = argv[*i] + 1;

    while (*p) {
        struct given g = {0};

        if (!find_option(&g, "-", p, 1, err))
            return false;
        p++;
        if (g.rule->value) {
            if (!take_value(&g, *p ? p : NULL, argc, argv, i, err))
                return false;
            p = "";
        }
        if (!set_option(o, &g, err))
            return false;
    }
    return true;
}

/* Whoever names a device wants to use it. */
static bool settle_backend(struct options *o, struct error *err)
{
    if ((o->device || o->kernels_path) && !o->has_backend)
        o->backend = BACKEND_OPENCL;
    if (o->backend != BACKEND_CPU)
        return true;
    if (o->device)
        return fail(err, "--device: is for OpenCL, expected no --backend cpu "
                         "beside it");
    if (o->kernels_path)
        return fail(err, "--kernels: is for OpenCL, expected no --backend cpu "
                         "beside it");
    return true;
}

static bool is_standard_output(const char *path)
{
    return path && strcmp(path, "-") == 0;
}

/* What only batch mode has. */
static bool check_batch(const struct options *o, struct error *err)
{
    bool takes_output = is_standard_output(o->output_path) ||
                        (o->text_cols > 0 && !o->output_path);

    if (o->output_path && !o->batch)
        return fail(err, "-o: is for batch mode, expected -b beside it (on "
                         "the screen p saves a picture)");
    if (o->watch && o->batch)
        return fail(err, "--watch: is for the screen, expected no -b beside "
                         "it");
    if (o->text_cols > 0 && !o->batch)
        return fail(err, "--ansi: is for batch mode, expected -b beside it "
                         "(on the screen x saves a text)");
    if (o->text_cols > 0 && o->glyph >= GLYPH_SIXEL)
        return fail(err, "--ansi: a text has no pixels, expected a --glyph "
                         "of cells beside it");
    if (o->output_path && o->text_cols == 0 &&
        picture_format_of(o->output_path) == PICTURE_UNKNOWN)
        return fail(err,
                    "-o: found '%s', expected a name that ends in .png, .hdr "
                    "or .pfm, or - for standard output",
                    o->output_path);
    if (takes_output && is_standard_output(o->stats_path))
        return fail(err,
                    "--stats: standard output is taken by %s, expected the "
                    "name of a file",
                    o->text_cols > 0 ? "--ansi" : "-o -");
    return true;
}

/* What is right alone but wrong together. */
static bool check_together(const struct options *o, struct error *err)
{
    if (o->list_devices || o->probe)
        return true;
    if (!o->scene_path)
        return fail(err, "no scene given, expected: glim [options] scene.obj "
                         "(see glim --help)");
    return check_batch(o, err);
}

enum palette options_palette(enum color_mode mode)
{
    switch (mode) {
    case COLOR_MONO: return PALETTE_MONO;
    case COLOR_16: return PALETTE_16;
    case COLOR_256: return PALETTE_256;
    case COLOR_24BIT:
    case COLOR_AUTO: break;
    }
    return PALETTE_24BIT;
}

enum glyphs options_glyphs(enum glyph_mode mode)
{
    switch (mode) {
    case GLYPH_UPPER: return GLYPHS_UPPER;
    case GLYPH_LOWER: return GLYPHS_LOWER;
    case GLYPH_QUADRANT: return GLYPHS_QUADRANT;
    case GLYPH_SEXTANT: return GLYPHS_SEXTANT;
    case GLYPH_BRAILLE: return GLYPHS_BRAILLE;
    case GLYPH_SPACE: return GLYPHS_SPACE;
    case GLYPH_ASCII: return GLYPHS_ASCII;
    default: return GLYPHS_HALF;
    }
}

/* GLIM_COLOR is what --color is where that is not given. */
static bool take_environment(struct options *o, struct error *err)
{
    struct given g = {find_rule("color", 5), "GLIM_COLOR",
                      getenv("GLIM_COLOR")};

    if ((o->batch && o->text_cols == 0) || o->has_color || !g.value ||
        *g.value == '\0')
        return true;
    return set_word(o, &g, err);
}

void options_init(struct options *o)
{
    *o = (struct options){.spp = 16, .max_bounces = -1};
}

/* What a person or a machine is like, and no picture depends on. */
static bool is_taste(enum option_id id)
{
    return id == OPTION_THREADS || id == OPTION_BACKEND || id == OPTION_COLOR ||
           id == OPTION_GLYPH || id == OPTION_CELL_ASPECT ||
           id == OPTION_PHOE_KEYS;
}

bool options_set_taste(struct options *o, const char *name, const char *value,
                       const char *place, struct error *err)
{
    struct given g = {.rule = find_rule(name, strlen(name)), .value = value};

    if (!g.rule || !is_taste(g.rule->id))
        return fail(err,
                    "%s: found '%s', expected an option that may stand here "
                    "(man glim lists them)",
                    place, name);
    snprintf(g.shown, sizeof g.shown, "%s: %s", place, name);
    if (g.rule->value && !value)
        return fail(err, "%s: expected %s behind it", g.shown, g.rule->value);
    if (!g.rule->value && value)
        return fail(err, "%s: found '%s', expected no value", g.shown, value);
    if (!set_option(o, &g, err))
        return false;
    /* what was not typed now gives way to what was */
    o->has_backend = false;
    o->has_color = false;
    return true;
}

bool options_parse(struct options *o, int argc, char **argv, struct error *err)
{
    bool ended = false;

    for (int i = 1; i < argc; i++) {
        const char *arg = argv[i];
        bool ok;

        if (ended || arg[0] != '-' || arg[1] == '\0') {
            ok = set_scene(o, arg, err);
        } else if (strcmp(arg, "--") == 0) {
            ended = true;
            ok = true;
        } else if (arg[1] == '-') {
            ok = parse_long(o, argc, argv, &i, err);
        } else {
            ok = parse_short(o, argc, argv, &i, err);
        }
        if (!ok)
            return false;
        if (o->show_help || o->show_version)
            return true; /* whatever else is on the line */
    }
    keys_settle(&o->keys, o->phoe_keys);
    return settle_backend(o, err) && check_together(o, err) &&
           take_environment(o, err);
}
