// SPDX-License-Identifier: MIT
#include "session/command_line.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "base/file.h"
#include "base/thread_pool.h"
#include "picture/image_write.h"
#include "session/option_checks.h"
#include "session/option_set.h"
#include "session/sub_command.h"
#include "session/video_pipe.h"

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

const char *const options_aovs[] = {
    [AOV_ALBEDO] = "albedo",
    [AOV_NORMALS] = "normals",
    [AOV_POSITION] = "position",
    [AOV_DEPTH] = "depth",
    [AOV_UV] = "uv",
    [AOV_OBJECT] = "object",
    [AOV_MATERIAL] = "material",
    [AOV_KINDS] = NULL,
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

bool options_adaptive(const struct options *o)
{
    bool is_filtered = o->denoise && !o->denoise_path && o->share_count == 0;

    return o->adaptive ||
           (!o->no_adaptive && (o->error_limit > 0 || is_filtered));
}

struct engine_options options_engine(const struct options *o)
{
    return (struct engine_options){
        .scene_path = o->scene_path,
        .view_path = o->view_path,
        .scene = {.up = o->up,
                  .thread_count = options_threads(o),
                  .camera = o->camera,
                  .choice = o->choice,
                  .view_lines = o->view_lines},
        .width_px = o->width_px,
        .height_px = o->height_px,
        .has_max_bounces = o->has_max_bounces,
        .max_bounces = o->max_bounces,
        .has_sun = o->has_sun,
        .sun_azimuth_deg = o->sun_azimuth_deg,
        .sun_elevation_deg = o->sun_elevation_deg,
        .turbidity = o->turbidity,
        .has_crop = o->has_crop,
        .crop = o->crop,
        .seed = o->seed,
        .is_adaptive = options_adaptive(o),
        .wants_filter = o->denoise,
        .drops_tree = o->batch,
        .kernel = o->paths,
        .device = {.program = "/proc/self/exe",
                   .device = o->device,
                   .kernels_path = o->kernels_path,
                   .needs_gpu = o->backend == BACKEND_AUTO},
    };
}

bool options_output_is_video(const struct options *o)
{
    return o->output_path && o->text_cols == 0 &&
           (o->turntable_count > 0 || o->fly_count > 0 || o->has_frames) &&
           video_pipe_is_name(o->output_path);
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
                          .fps = 24,
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
           id == OPTION_GLYPH || id == OPTION_THEME ||
           id == OPTION_CELL_ASPECT || id == OPTION_PHOE_KEYS ||
           id == OPTION_FILTER || id == OPTION_NO_FILTER;
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
    if (!settle_backend(o, err) ||
        (o->command != COMMAND_RENDER && !sub_command_check(o, err)) ||
        !options_check(o, err) || !take_environment(o, err))
        return false;
    if (o->command != COMMAND_RENDER || o->scene_path ||
        options_need_no_scene(o))
        return true;
    o->lacks_scene = !o->batch;
    return fail(
        err,
        "found no scene, expected: glim [options] scene.obj (see glim --help)");
}
