// SPDX-License-Identifier: MIT
#include "session/command_line.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "base/file.h"
#include "base/thread.h"
#include "picture/image_write.h"
#include "session/option_set.h"
#include "session/sub_command.h"

const char *const options_shows[] = {
    [SHOW_LIGHT] = "light",
    [SHOW_PREVIEW] = "preview",
    [SHOW_NORMALS] = "normals",
    [SHOW_FACES] = "faces",
    [SHOW_UVS] = "uvs",
    [SHOW_DEPTH] = "depth",
    [SHOW_MATERIALS] = "materials",
    [SHOW_COST] = "cost",
    /* all pixels of a file have the same number, and --error-map has errors */
    [SHOW_SAMPLES] = NULL,
};

/* Finds the rule of an option. `text` is the option without its dashes. */
static bool find_option(const struct options *o, struct option_given *g,
                        const char *dashes, const char *text, size_t length,
                        struct error *err)
{
    g->rule = option_rule_named(text, length);
    if (!g->rule || (length == 1) != (dashes[1] == '\0'))
        return fail(err, "unknown option '%s%.*s', see glim --help", dashes,
                    (int)length, text);
    if (!sub_command_takes(o->command, g->rule->id))
        return fail(err, "%s%s: not an option of glim%s, see glim --help",
                    dashes, g->rule->name, sub_command_name(o->command));
    /* all names in the table fit */
    memcpy(g->shown, dashes, strlen(dashes));
    memcpy(g->shown + strlen(dashes), text, length);
    g->shown[strlen(dashes) + length] = '\0';
    return true;
}

/* Takes the value: `attached` or the next argument. */
static bool take_value(struct option_given *g, const char *attached, int argc,
                       char **argv, int *i, struct error *err)
{
    g->value = attached;
    if (!g->value && *i + 1 < argc)
        g->value = argv[++*i];
    if (!g->value)
        return fail(err, "%s: found no value, expected %s%s", g->shown,
                    g->rule->value, option_hint(g));
    return true;
}

/* Parses --name, --name=value or --name value. */
static bool parse_long(struct options *o, int argc, char **argv, int *i,
                       struct error *err)
{
    const char *text = argv[*i] + 2;
    size_t length = strcspn(text, "=");
    const char *attached = text[length] == '=' ? text + length + 1 : NULL;
    struct option_given g = {0};

    if (!find_option(o, &g, "--", text, length, err))
        return false;
    if (!g.rule->value && attached)
        return fail(err, "%s: found '%s', expected no value", g.shown,
                    attached);
    if (option_value_is_optional(g.rule))
        g.value = attached;
    else if (g.rule->value && !take_value(&g, attached, argc, argv, i, err))
        return false;
    return option_set(o, &g, err);
}

/* Parses -x, -xvalue, -x value, or several letters of which only the last takes
 * a value. */
static bool parse_short(struct options *o, int argc, char **argv, int *i,
                        struct error *err)
{
    const char *p = argv[*i] + 1;

    while (*p) {
        struct option_given g = {0};

        if (!find_option(o, &g, "-", p, 1, err))
            return false;
        p++;
        if (g.rule->value) {
            if (!take_value(&g, *p ? p : NULL, argc, argv, i, err))
                return false;
            p = "";
        }
        if (!option_set(o, &g, err))
            return false;
    }
    return true;
}

/* Selects OpenCL if a device was named. */
static bool settle_backend(struct options *o, struct error *err)
{
    if ((o->device || o->kernels_path) && !o->has_backend)
        o->backend = BACKEND_OPENCL;
    if (o->backend != BACKEND_CPU)
        return true;
    if (o->device)
        return fail(err,
                    "--device: found --backend cpu, expected opencl or auto");
    if (o->kernels_path)
        return fail(err,
                    "--kernels: found --backend cpu, expected opencl or auto");
    return true;
}

/* Refuses a scene from standard input where it is read more than once, or where
 * keys come from there. */
static bool check_scene(const struct options *o, struct error *err)
{
    if (o->scene_path == NULL || strcmp(o->scene_path, "-") != 0 ||
        (o->batch && o->command == COMMAND_RENDER))
        return true;
    return o->command == COMMAND_RENDER
               ? fail(err, "-: found no -b, expected batch mode for a scene "
                           "from standard input")
               : fail(err, "-: found standard input, expected a scene that can "
                           "be read more than once");
}

static bool is_standard_output(const char *path)
{
    return path && strcmp(path, "-") == 0;
}

/* Refuses a sun beside another sky. */
static bool check_sky(const struct options *o, struct error *err)
{
    return !o->has_sun || !o->has_sky ||
           fail(err, "--sun: found --sky, expected one of the two");
}

/* Refuses options that only batch mode has. */
static bool check_batch(const struct options *o, struct error *err)
{
    bool takes_output = is_standard_output(o->output_path) ||
                        (o->text_cols > 0 && !o->output_path);

    if (o->output_path && !o->batch)
        return fail(err,
                    "-o: found no -b, expected batch mode (on the screen %s "
                    "saves a picture)",
                    keymap_first_name(&o->keys, ACTION_SAVE).text);
    if (o->watch && o->batch)
        return fail(err, "--watch: found -b, expected the screen");
    if (o->text_cols > 0 && !o->batch)
        return fail(err,
                    "--ansi: found no -b, expected batch mode (on the screen "
                    "%s saves a text)",
                    keymap_first_name(&o->keys, ACTION_SAVE_TEXT).text);
    if (o->text_cols > 0 && o->display.glyph >= GLYPH_SIXEL)
        return fail(
            err,
            "--ansi: found --glyph for pixels, expected one for characters");
    if (o->output_path && o->text_cols == 0 && !options_output_is_film(o) &&
        image_write_format_of(o->output_path) == IMAGE_WRITE_UNKNOWN)
        return fail(err,
                    "-o: found '%s', expected a name that ends in .png, .hdr "
                    "or .pfm, or - for standard output",
                    o->output_path);
    if (o->output_path && o->stats_path && !takes_output &&
        path_is_same(o->output_path, o->stats_path))
        return fail(
            err, "--stats: found '%s', the file of -o, expected another file",
            o->stats_path);
    if (takes_output && is_standard_output(o->stats_path))
        return fail(err,
                    "--stats: found - beside %s, expected the name of a file",
                    o->text_cols > 0 ? "--ansi" : "-o -");
    return true;
}

static bool is_other_file(const char *option, const char *path,
                          const char *other_option, const char *other,
                          struct error *err)
{
    return !other || !path_is_same(path, other) ||
           fail(err, "%s: found '%s', the file of %s, expected another file",
                option, path, other_option);
}

/* Refuses a name that is no picture's or that of another output. */
static bool check_side_picture(const struct options *o, const char *option,
                               const char *path, struct error *err)
{
    if (is_standard_output(path) ||
        image_write_format_of(path) == IMAGE_WRITE_UNKNOWN)
        return fail(err,
                    "%s: found '%s', expected a name that ends in .png, .hdr "
                    "or .pfm",
                    option, path);
    return is_other_file(option, path, "-o", o->output_path, err) &&
           is_other_file(option, path, "--stats", o->stats_path, err);
}

/* Refuses a filtered picture on the screen or in the file of another output. */
static bool check_denoise(const struct options *o, struct error *err)
{
    if (!o->denoise)
        return true;
    if (!o->batch)
        return fail(err, "--denoise: found no -b, expected batch mode");
    if (o->show != SHOW_LIGHT)
        return fail(err, "--denoise: found --show, expected a render of light");
    return !o->denoise_path ||
           check_side_picture(o, "--denoise", o->denoise_path, err);
}

static bool check_error_map(const struct options *o, struct error *err)
{
    if (!o->error_map_path)
        return true;
    if (!o->batch)
        return fail(err,
                    "--error-map: found no -b, expected batch mode (on the "
                    "screen %s shows it)",
                    keymap_first_name(&o->keys, ACTION_VIEW_BACK).text);
    if (o->show != SHOW_LIGHT)
        return fail(err,
                    "--error-map: found --show, expected a render of light");
    if (o->has_spp && o->spp < 2)
        return fail(err, "--error-map: found -s 1, expected at least two "
                         "samples, whose difference is the error");
    return check_side_picture(o, "--error-map", o->error_map_path, err) &&
           is_other_file("--error-map", o->error_map_path, "--denoise",
                         o->denoise_path, err);
}

/* Refuses the name of a film that is that of another output. */
static bool check_film_name(const struct options *o, const char *option,
                            const char *path, struct error *err)
{
    if (is_standard_output(path))
        return fail(err, "%s: found -, expected the name of a file", option);
    return is_other_file(option, path, "-o", o->output_path, err) &&
           is_other_file(option, path, "--stats", o->stats_path, err) &&
           is_other_file(option, path, "--denoise", o->denoise_path, err) &&
           is_other_file(option, path, "--error-map", o->error_map_path, err);
}

/* Refuses films on the screen, and shares of what is decided while it
 * renders. */
static bool check_films(const struct options *o, struct error *err)
{
    const struct {
        const char *name, *path;
    } films[] = {{"--film", o->film_path},
                 {"--checkpoint", o->checkpoint_path},
                 {"--resume", o->resume_path}};

    for (int i = 0; i < 3; i++) {
        if (!films[i].path)
            continue;
        if (!o->batch)
            return fail(err, "%s: found no -b, expected batch mode",
                        films[i].name);
        if (o->show != SHOW_LIGHT)
            return fail(err, "%s: found --show, expected a render of light",
                        films[i].name);
        if (!check_film_name(o, films[i].name, films[i].path, err))
            return false;
    }
    if (o->has_checkpoint_interval && !o->checkpoint_path)
        return fail(err, "--checkpoint-interval: found no --checkpoint");
    if (o->share_count == 0)
        return true;
    if (!o->film_path && !o->checkpoint_path)
        return fail(err, "--share: found no --film, expected one to write");
    if (o->error_limit > 0 || o->adaptive)
        return fail(err,
                    "--share: found %s, expected samples that no share "
                    "decides",
                    o->adaptive ? "--adaptive" : "-e");
    return o->has_spp ||
           fail(err, "--share: found no -s, expected the samples of all shares "
                     "together");
}

/* Refuses frames on the screen, frames that do not exist, and one film for all
 * of them. */
static bool check_frames(const struct options *o, struct error *err)
{
    const char *name = o->fly_count > 0 ? "--fly" : "--turntable";
    int count = o->fly_count > 0 ? o->fly_count : o->turntable_count;

    if (count == 0)
        return !o->has_frames ||
               fail(err, "--frames: found no --turntable or --fly");
    if (!o->batch)
        return fail(err, "%s: found no -b, expected batch mode", name);
    if (o->turntable_count > 0 && o->fly_count > 0)
        return fail(err, "--fly: found --turntable, expected one of the two");
    if (o->has_frames && o->last_frame >= count)
        return fail(err, "--frames: found %d:%d, expected frames from 0 to %d",
                    o->first_frame, o->last_frame, count - 1);
    if (o->film_path || o->checkpoint_path || o->resume_path)
        return fail(err, "%s: found %s, expected pictures without films", name,
                    o->film_path         ? "--film"
                    : o->checkpoint_path ? "--checkpoint"
                                         : "--resume");
    if (is_standard_output(o->output_path) || is_standard_output(o->stats_path))
        return fail(err, "%s: found -, expected the name of a file", name);
    return true;
}

/* Refuses options about samples of light beside --show. */
static bool check_show(const struct options *o, struct error *err)
{
    if (o->show == SHOW_LIGHT)
        return true;
    if (!o->batch)
        return fail(err,
                    "--show: found no -b, expected batch mode (on the screen "
                    "%s shows it)",
                    keymap_first_name(&o->keys, ACTION_VIEW_NEXT).text);
    if (o->stats_path)
        return fail(err, "--stats: found --show, expected a render of light");
    if (o->output_path && o->text_cols == 0 &&
        image_write_format_of(o->output_path) != IMAGE_WRITE_PNG)
        return fail(
            err, "-o: found '%s', expected a name that ends in .png for --show",
            o->output_path);
    return true;
}

/* Returns true for options that ask for something else than a render. */
static bool needs_no_scene(const struct options *o)
{
    return o->list_devices || o->list_formats || o->list_sessions || o->probe ||
           o->is_worker;
}

/* Refuses combinations of options. */
static bool check_together(const struct options *o, struct error *err)
{
    if (needs_no_scene(o))
        return true;
    return check_sky(o, err) && check_batch(o, err) && check_denoise(o, err) &&
           check_error_map(o, err) && check_films(o, err) &&
           check_show(o, err) && check_frames(o, err);
}

bool options_adaptive(const struct options *o)
{
    return o->adaptive || (!o->no_adaptive && o->error_limit > 0);
}

bool options_output_is_film(const struct options *o)
{
    const char *ending = o->output_path ? strrchr(o->output_path, '.') : NULL;

    return o->command == COMMAND_MERGE && ending &&
           strcmp(ending, ".film") == 0;
}

struct render_limits options_limits(const struct options *o)
{
    bool has_other = o->error_limit > 0 || o->time_ns != 0;

    return (struct render_limits){
        .spp = o->has_spp || !has_other ? o->spp : 0,
        .error = o->error_limit,
        .time_ns = o->time_ns,
    };
}

int options_threads(const struct options *o)
{
    return o->thread_count != 0 ? o->thread_count : usable_threads();
}

/* Takes the colours from GLIM_COLOR unless --color is given. */
static bool take_environment(struct options *o, struct error *err)
{
    struct option_given g = {option_rule_named("color", 5), "GLIM_COLOR",
                             getenv("GLIM_COLOR")};

    if ((o->batch && o->text_cols == 0) || o->has_color || !g.value ||
        *g.value == '\0')
        return true;
    return option_set(o, &g, err);
}

void options_init(struct options *o)
{
    *o = (struct options){.spp = 16,
                          .checkpoint_ns = 60000000000u,
                          .max_bounces = -1,
                          .seed_count = 8,
                          .tile_count = 16,
                          .false_alarms = 0.01};
}

/* Returns true for options that suit a person or a machine and do not change
 * pictures. Only these are allowed in the configuration file. */
static bool is_configurable(enum option_id id)
{
    return id == OPTION_THREADS || id == OPTION_BACKEND || id == OPTION_COLOR ||
           id == OPTION_GLYPH || id == OPTION_CELL_ASPECT ||
           id == OPTION_PHOE_KEYS || id == OPTION_FILTER ||
           id == OPTION_NO_FILTER;
}

bool options_set_configured(struct options *o, const char *name,
                            const char *value, const char *place,
                            struct error *err)
{
    struct option_given g = {.rule = option_rule_named(name, strlen(name)),
                             .value = value};

    if (!g.rule || !is_configurable(g.rule->id))
        return fail(err,
                    "%s: found '%s', expected an option of the configuration "
                    "file (man glim lists them)",
                    place, name);
    snprintf(g.shown, sizeof g.shown, "%s: %s", place, name);
    if (g.rule->value && !value)
        return fail(err, "%s: found no value, expected %s", g.shown,
                    g.rule->value);
    if (!g.rule->value && value)
        return fail(err, "%s: found '%s', expected no value", g.shown, value);
    if (!option_set(o, &g, err))
        return false;
    /* the command line replaces the configuration */
    o->has_backend = false;
    o->has_color = false;
    return true;
}

bool options_parse(struct options *o, int argc, char **argv, struct error *err)
{
    bool ended = false;

    o->command = argc > 1 ? sub_command_named(argv[1]) : COMMAND_RENDER;
    o->arguments = argv;
    o->batch |= o->command != COMMAND_RENDER;
    for (int i = o->command == COMMAND_RENDER ? 1 : 2; i < argc; i++) {
        const char *arg = argv[i];
        bool ok;

        if (ended || arg[0] != '-' || arg[1] == '\0') {
            ok = sub_command_set_operand(o, arg, err);
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
            return true; /* the rest of the command line does not matter */
    }
    keymap_settle(&o->keys, o->phoe_keys);
    if (!settle_backend(o, err) || !check_together(o, err) ||
        !check_scene(o, err) || !take_environment(o, err))
        return false;
    if (o->command != COMMAND_RENDER)
        return sub_command_check(o, err);
    if (o->scene_path || needs_no_scene(o))
        return true;
    o->lacks_scene = !o->batch;
    return fail(
        err,
        "found no scene, expected: glim [options] scene.obj (see glim --help)");
}
