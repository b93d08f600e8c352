// SPDX-License-Identifier: MIT
#include "session/option_checks.h"

#include <string.h>

#include "base/file.h"
#include "picture/image_write.h"

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

/* Returns true for options that ask for something else than a render. */
bool options_need_no_scene(const struct options *o)
{
    return o->list_devices || o->list_formats || o->list_sessions || o->probe ||
           o->is_import || o->is_unpack || o->is_worker;
}

bool options_check(const struct options *o, struct error *err)
{
    bool ok =
        options_need_no_scene(o) ||
        (check_sky(o, err) && check_batch(o, err) && check_denoise(o, err) &&
         check_error_map(o, err) && check_films(o, err) && check_show(o, err) &&
         check_aovs(o, err) && check_frames(o, err));

    return ok && check_scene(o, err);
}
