// SPDX-License-Identifier: MIT
#include "session/command_line.h"

#include <inttypes.h>
#include <stdlib.h>
#include <string.h>
#include <strings.h>

#include "base/file.h"
#include "base/print.h"
#include "base/thread_pool.h"
#include "film/image_write.h"
#include "session/frame_series.h"
#include "session/option_table.h"
#include "terminal/xmalloc.h"

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

/* ---- values of options together ---- */

bool options_adaptive(const struct options *o)
{
    bool is_filtered = o->denoise && !o->denoise_path && o->share_count == 0;

    return o->adaptive ||
           (!o->no_adaptive && (o->error_limit > 0 || is_filtered));
}

void options_use_scene(struct options *o, const char *path)
{
    free(o->view_lines);
    o->scene_path = path;
    o->view_lines = NULL;
    o->view_path = NULL;
    o->camera = NULL;
    o->choice = (struct scene_choice){0};
    o->up = SCENE_UP_OF_FILE;
    o->has_sky = o->has_sun = o->has_crop = false;
}

struct engine_options options_engine(const struct options *o)
{
    return (struct engine_options){
        .view_path = o->view_path,
        .view_text = o->view_text,
        .scene = {.path = o->scene_path,
                  .up = o->up,
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
        .is_exact = o->gi == GI_EXACT,
        .wants_filter = o->denoise,
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

/* ---- commands ---- */

static const struct {
    const char *name;     /* after a blank */
    const char *operands; /* and options that it needs, for messages */
    const char *help;
} commands[] = {
    [COMMAND_RENDER] = {"", "", NULL},
    [COMMAND_COMPARE] =
        {" compare", "[options] picture.pfm reference.pfm",
         "compare two .pfm, .exr, .hdr or .png pictures of one size: errors, "
         "and the "
         "tiles that differ by more than noise; -o writes a picture of the "
         "differences"},
    [COMMAND_CURVE] =
        {" curve", "[options] reference.pfm scene.obj",
         "render with 1, 2, 4 .. samples up to -s (default: 256) and print the "
         "error and the time of each; -o writes a diagram for gnuplot"},
    [COMMAND_REFERENCE] =
        {" reference", "[options] out.pfm scene.obj",
         "render with several seeds and write the mean, and its error to "
         "out.json; -s counts the samples of all seeds together (default: "
         "4096)"},
    [COMMAND_INFO] = {" info", "FILM ...", "print what films are of"},
    [COMMAND_MERGE] =
        {" merge", "-o OUT FILM ...",
         "join films of the same picture; -o names a picture, or a film that "
         "ends in .film"},
    [COMMAND_DEVELOP] = {" develop", "-o PICTURE FILM",
                         "as merge, of one film"},
};

#define COMMAND_COUNT (int)(sizeof commands / sizeof commands[0])

/* Returns the command of this name, COMMAND_RENDER if there is none. */
static enum sub_command command_named(const char *name)
{
    for (int i = COMMAND_RENDER + 1; i < COMMAND_COUNT; i++)
        if (strcmp(commands[i].name + 1, name) == 0)
            return (enum sub_command)i;
    return COMMAND_RENDER;
}

/* Returns true for the commands whose operands are films. */
static bool takes_films(enum sub_command command)
{
    return command >= COMMAND_INFO;
}

/* Checks that the seeds of a reference do not begin again at 0, where those of
 * measurements are. */
static bool check_seeds(const struct options *o, struct error *err)
{
    uint32_t last = UINT32_MAX - ((uint32_t)o->seed_count - 1);

    return o->command != COMMAND_REFERENCE || o->seed <= last ||
           fail(err,
                "--seed: found %" PRIu32 ", expected at most %" PRIu32
                " as the first of %d",
                o->seed, last, o->seed_count);
}

/* Returns the operands of a sub-command in their order; NULL: no second one. */
static void operands_of(struct options *o, const char **operands[2])
{
    operands[0] =
        o->command == COMMAND_REFERENCE ? &o->output_path : &o->reference_path;
    operands[1] = &o->scene_path;
    if (o->command == COMMAND_COMPARE) {
        operands[0] = &o->picture_path;
        operands[1] = &o->reference_path;
    }
}

/* Sets the next file that is given without an option: the scene, or a picture
 * of a command. */
static bool set_operand(struct options *o, const char *path, struct error *err)
{
    const char **operands[2];

    if (o->command == COMMAND_RENDER && o->picture_path == NULL &&
        strcmp(path, "-") != 0 &&
        image_write_format_of(path) != IMAGE_WRITE_UNKNOWN) {
        o->picture_path = path;
        return true;
    }
    if (o->command == COMMAND_RENDER)
        return option_set_scene(o, path, err);
    if (takes_films(o->command)) {
        o->films =
            xrealloc(o->films, (size_t)(o->film_count + 1) * sizeof *o->films);
        o->films[o->film_count++] = path;
        return true;
    }
    operands_of(o, operands);
    for (int i = 0; i < 2; i++)
        if (!*operands[i]) {
            *operands[i] = path;
            return true;
        }
    return fail(err, "found '%s' beside '%s' and '%s', expected two files",
                path, *operands[0], *operands[1]);
}

/* Checks the name of the file that is written. */
static bool check_ending(const struct options *o, struct error *err)
{
    static const struct {
        const char *place, *endings[2], *expected;
    } outputs[] = {
        [COMMAND_COMPARE] = {"-o: ", {".png", ".pfm"}, ".png or .pfm"},
        [COMMAND_CURVE] = {"-o: ", {".gp"}, ".gp"},
        [COMMAND_REFERENCE] = {"", {".pfm"}, ".pfm"},
    };
    const char *path = o->output_path;
    const char *ending = path ? strrchr(path, '.') : NULL;

    for (int i = 0; i < 2 && ending; i++)
        if (outputs[o->command].endings[i] &&
            strcasecmp(ending, outputs[o->command].endings[i]) == 0)
            return true;
    return !path ||
           fail(err, "%sfound '%s', expected a name that ends in %s",
                outputs[o->command].place, path, outputs[o->command].expected);
}

static bool check_film_operands(const struct options *o, struct error *err)
{
    bool needs_output = o->command != COMMAND_INFO;

    if (o->film_count == 0 || (needs_output && !o->output_path) ||
        (o->command == COMMAND_DEVELOP && o->film_count > 1))
        return fail(err,
                    "found %d film%s%s, expected: glim%s %s (see glim "
                    "--help)",
                    o->film_count, print_plural((uint64_t)o->film_count),
                    needs_output && !o->output_path ? " and no -o" : "",
                    commands[o->command].name, commands[o->command].operands);
    return !o->denoise || !o->output_path || !options_output_is_film(o) ||
           fail(err, "--denoise: found -o %s, a film, expected a picture",
                o->output_path);
}

/* Checks the operands and options of a command together. */
static bool check_command(struct options *o, struct error *err)
{
    const char **operands[2];

    if (takes_films(o->command))
        return check_film_operands(o, err);
    operands_of(o, operands);
    if (!*operands[0] || !*operands[1])
        return fail(err,
                    "found too few files, expected: glim%s %s (see glim "
                    "--help)",
                    commands[o->command].name, commands[o->command].operands);
    if (o->csv_path && strcmp(o->csv_path, "-") == 0)
        return fail(err, "--csv: found -, expected the name of a file");
    return check_ending(o, err) && check_seeds(o, err);
}

/* ---- combinations of options ---- */

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
        !options_output_is_video(o) && o->command != COMMAND_CURVE &&
        image_write_format_of(o->output_path) == IMAGE_WRITE_UNKNOWN)
        return fail(
            err,
            "-o: found '%s', expected a name that ends in " IMAGE_WRITE_ENDINGS
            ", or - for standard output",
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
        return fail(
            err,
            "%s: found '%s', expected a name that ends in " IMAGE_WRITE_ENDINGS,
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

/* Refuses surfaces without a file of a picture beside which they are written.
 */
static bool check_aovs(const struct options *o, struct error *err)
{
    if (o->aovs == 0)
        return true;
    if (!o->batch)
        return fail(err, "--aov: found no -b, expected batch mode");
    if (o->show != SHOW_LIGHT)
        return fail(err, "--aov: found --show, expected a render of light");
    if (o->text_cols > 0)
        return fail(err, "--aov: found --ansi, expected a picture");
    if (options_output_is_video(o))
        return fail(err, "--aov: found a video, expected pictures");
    return !is_standard_output(o->output_path) ||
           fail(err, "--aov: found -o -, expected the name of a file");
}

/* Refuses frames on the screen, frames that do not exist, and one film for all
 * of them. */
static bool check_frames(const struct options *o, struct error *err)
{
    const char *name = o->fly_count > 0         ? "--fly"
                       : o->turntable_count > 0 ? "--turntable"
                                                : "--frames";
    int count = o->fly_count > 0 ? o->fly_count : o->turntable_count;

    if (count == 0 && !o->has_frames)
        return true;
    if (!o->batch)
        return fail(err, "%s: found no -b, expected batch mode", name);
    if (o->turntable_count > 0 && o->fly_count > 0)
        return fail(err, "--fly: found --turntable, expected one of the two");
    if (count == 0 && o->choice.has_time)
        return fail(err, "--frames: found --anim-time, expected --fps, which "
                         "gives each frame its time");
    if (count > 0 && o->has_frames && o->last_frame >= count)
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
    if (o->output_path && o->text_cols == 0 && !options_output_is_video(o) &&
        image_write_format_of(o->output_path) != IMAGE_WRITE_PNG)
        return fail(
            err, "-o: found '%s', expected a name that ends in .png for --show",
            o->output_path);
    return true;
}

/* Refuses outputs beside a path, and pictures beside a scene that is rendered.
 */
static bool check_trace(const struct options *o, struct error *err)
{
    const struct {
        const char *name;
        bool is_given;
    } others[] = {{"-o", o->output_path != NULL},
                  {"--stats", o->stats_path != NULL},
                  {"--film", o->film_path != NULL},
                  {"--checkpoint", o->checkpoint_path != NULL},
                  {"--resume", o->resume_path != NULL},
                  {"--error-map", o->error_map_path != NULL},
                  {"--aov", o->aovs != 0},
                  {"--ansi", o->text_cols > 0},
                  {"--show", o->show != SHOW_LIGHT},
                  {"--turntable", o->turntable_count > 0},
                  {"--fly", o->fly_count > 0},
                  {"--frames", o->has_frames},
                  {"--ranks", o->ranks > 0}};

    for (size_t i = 0; o->has_trace && i < sizeof others / sizeof others[0];
         i++)
        if (others[i].is_given)
            return fail(err, "--trace: found %s, expected no other output",
                        others[i].name);
    return true;
}

/* Returns true for options that ask for something else than a render. */
static bool needs_no_scene(const struct options *o)
{
    return o->list_devices || o->list_formats || o->list_sessions || o->probe ||
           o->is_import || o->is_unpack || o->is_voxels || o->is_worker;
}

static bool check_options(const struct options *o, struct error *err)
{
    bool ok =
        needs_no_scene(o) ||
        (check_sky(o, err) && check_batch(o, err) && check_denoise(o, err) &&
         check_error_map(o, err) && check_films(o, err) && check_show(o, err) &&
         check_aovs(o, err) && check_frames(o, err) && check_trace(o, err));

    return ok && check_scene(o, err);
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

/* ---- --help ---- */

/* Columns of the names of options, and of a line. */
#define NAME_COLS 16
#define LINE_COLS 79

/* Columns before the text beside a name. */
#define TEXT_COL (2 + NAME_COLS + 1)

/* Returns the bytes of the first words of a text that fit in a line. */
static int words_that_fit(const char *text, int cols)
{
    int length = (int)strlen(text), fit = cols;

    if (length <= cols)
        return length;
    while (fit > 0 && text[fit] != ' ')
        fit--;
    return fit > 0 ? fit : length;
}

/* Prints a name with the text beside it. */
static void print_row(FILE *to, const char *name, const char *text)
{
    bool fits = strlen(name) <= NAME_COLS;

    if (!fits)
        print_line(to, "  %s", name);
    for (bool is_first = true; *text != '\0'; is_first = false) {
        int length = words_that_fit(text, LINE_COLS - TEXT_COL);

        print_line(to, "  %-*s %.*s", NAME_COLS, is_first && fits ? name : "",
                   length, text);
        text += length;
        text += strspn(text, " ");
    }
}

static void print_option(FILE *to, const struct option_rule *rule)
{
    bool needs_blank = rule->argument && !rule->value_is_optional;
    char name[64];

    snprintf(name, sizeof name, "%s%s%s%s", rule->name[1] == '\0' ? "-" : "--",
             rule->name, needs_blank ? " " : "",
             rule->argument ? rule->argument : "");
    print_row(to, name, rule->help);
}

void options_print_help(FILE *to)
{
    const struct option_rule *rule;

    print_line(to, "usage: glim [options] scene.obj");
    print_line(to, "       glim -b [options] [-o picture.png] scene.obj");
    print_line(to, "       glim --trace X,Y,SAMPLE [options] picture.png");
    for (int i = 1; i < COMMAND_COUNT; i++)
        print_line(to, "       glim%s %s", commands[i].name,
                   commands[i].operands);
    print_lines(to,
                "\n"
                "Path traces an OBJ, glTF, PLY or STL scene, live in the "
                "terminal or, with -b, to\n"
                "a file. On the screen, ? shows the keys and Ctrl-Q quits.\n"
                "\n"
                "commands\n");
    for (int i = 1; i < COMMAND_COUNT; i++)
        print_row(to, commands[i].name + 1, commands[i].help);
    for (int i = 0; (rule = option_rule(i)) != NULL; i++)
        if (rule->kind == OPTION_TITLE) {
            print_line(to, "%s", "");
            print_line(to, "%s", rule->help);
        } else if (rule->help != NULL) {
            print_option(to, rule);
        }
    print_row(to, "--", "end of the options");
}

/* ---- the command line ---- */

/* Finds the rule of an option. `text` is the option without its dashes. */
static bool find_option(const struct options *o, struct option_given *g,
                        const char *dashes, const char *text, size_t length,
                        struct error *err)
{
    g->rule = option_rule_named(text, length);
    if (!g->rule || (length == 1) != (dashes[1] == '\0'))
        return fail(err, "unknown option '%s%.*s', see glim --help", dashes,
                    (int)length, text);
    if ((g->rule->commands & 1u << o->command) == 0)
        return fail(err, "%s%s: not an option of glim%s, see glim --help",
                    dashes, g->rule->name, commands[o->command].name);
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
                    g->rule->expected, option_hint(g));
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
    if (!g.rule->expected && attached)
        return fail(err, "%s: found '%s', expected no value", g.shown,
                    attached);
    if (g.rule->value_is_optional)
        g.value = attached;
    else if (g.rule->expected && !take_value(&g, attached, argc, argv, i, err))
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
        if (g.rule->expected) {
            if (!take_value(&g, *p ? p : NULL, argc, argv, i, err))
                return false;
            p = "";
        }
        if (!option_set(o, &g, err))
            return false;
    }
    return true;
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

bool options_set_configured(struct options *o, const char *name,
                            const char *value, const char *place,
                            struct error *err)
{
    struct option_given g = {.rule = option_rule_named(name, strlen(name)),
                             .value = value};

    if (!g.rule || !g.rule->is_configurable)
        return fail(err,
                    "%s: found '%s', expected an option of the configuration "
                    "file (man glim lists them)",
                    place, name);
    snprintf(g.shown, sizeof g.shown, "%s: %s", place, name);
    if (g.rule->expected && !value)
        return fail(err, "%s: found no value, expected %s", g.shown,
                    g.rule->expected);
    if (!g.rule->expected && value)
        return fail(err, "%s: found '%s', expected no value", g.shown, value);
    if (!option_set(o, &g, err))
        return false;
    /* the command line replaces the configuration */
    o->has_backend = false;
    o->has_color = false;
    return true;
}

/* Without --trace a picture counts as a scene. */
static bool settle_operands(struct options *o, struct error *err)
{
    const char *path = o->picture_path;

    if (o->command != COMMAND_RENDER || o->has_trace || path == NULL)
        return true;
    o->picture_path = NULL;
    return option_set_scene(o, path, err);
}

bool options_parse(struct options *o, int argc, char **argv, struct error *err)
{
    bool ended = false;

    o->command = argc > 1 ? command_named(argv[1]) : COMMAND_RENDER;
    o->arguments = argv;
    o->batch |= o->command != COMMAND_RENDER;
    for (int i = o->command == COMMAND_RENDER ? 1 : 2; i < argc; i++) {
        const char *arg = argv[i];
        bool ok;

        if (ended || arg[0] != '-' || arg[1] == '\0') {
            ok = set_operand(o, arg, err);
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
    if (!settle_operands(o, err) || !settle_backend(o, err) ||
        (o->command != COMMAND_RENDER && !check_command(o, err)) ||
        !check_options(o, err) || !take_environment(o, err))
        return false;
    if (o->command != COMMAND_RENDER || o->scene_path || o->picture_path ||
        needs_no_scene(o))
        return true;
    o->lacks_scene = !o->batch;
    return fail(
        err,
        "found no scene, expected: glim [options] scene.obj (see glim --help)");
}
