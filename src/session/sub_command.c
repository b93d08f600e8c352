// SPDX-License-Identifier: MIT
#include "session/sub_command.h"

#include <string.h>

#include "picture/image_write.h"
#include "terminal/xmalloc.h"

const char sub_command_help[] =
    "\n"
    "films, in batch mode\n"
    "  --film FILE      write the film, the exact sums of all samples\n"
    "  --checkpoint FILE\n"
    "                   write the film at the end, after a signal, and while\n"
    "                   rendering\n"
    "  --checkpoint-interval TIME\n"
    "                   time between checkpoints (default: 60)\n"
    "  --resume FILE    go on with a film of the same picture; if it is that "
    "of\n"
    "                   --checkpoint it may be missing at first\n"
    "  --share I/N      render only share I, from 1 to N, of the samples\n"
    "  info             print what films are of\n"
    "  merge            join films of the same picture; -o names a picture, or "
    "a\n"
    "                   film that ends in .film\n"
    "  develop          as merge, of one film\n"
    "  --exposure STOPS exposure of the picture of merge and develop\n"
    "  --tone KIND      linear, reinhard or aces likewise\n"
    "\n"
    "clusters, in a program that is built with make MPI=1\n"
    "  --ranks N        start N processes that render together\n"
    "\n"
    "measurements\n"
    "  compare          compare two .pfm, .hdr or .png pictures of one size:\n"
    "                   errors, and the tiles that differ by more than noise;\n"
    "                   -o writes a picture of the differences\n"
    "  curve            render with 1, 2, 4 .. samples up to -s (default: "
    "256)\n"
    "                   and print the error and the time of each; -o draws a\n"
    "                   diagram\n"
    "  reference        render with several seeds and write the mean, and its\n"
    "                   error to out.json; -s counts the samples of all seeds\n"
    "                   together (default: 4096)\n"
    "  --seeds N        4 to 64 seeds (default: 8), from --seed on (default:\n"
    "                   1000000)\n"
    "  --csv FILE       write the curve as comma-separated values\n"
    "  --tiles N        most tiles each way, 1 to 256 (default: 16)\n"
    "  --false-alarms P probability that anything is marked although only\n"
    "                   noise differs (default: 0.01)\n";

static const char *const names[] = {
    [COMMAND_RENDER] = "",          [COMMAND_COMPARE] = " compare",
    [COMMAND_CURVE] = " curve",     [COMMAND_REFERENCE] = " reference",
    [COMMAND_INFO] = " info",       [COMMAND_MERGE] = " merge",
    [COMMAND_DEVELOP] = " develop",
};

#define COMMAND_COUNT (int)(sizeof names / sizeof names[0])

enum sub_command sub_command_named(const char *name)
{
    for (int i = COMMAND_RENDER + 1; i < COMMAND_COUNT; i++)
        if (strcmp(names[i] + 1, name) == 0)
            return (enum sub_command)i;
    return COMMAND_RENDER;
}

const char *sub_command_name(enum sub_command command)
{
    return names[command];
}

/* Returns true for the sub-commands whose operands are films. */
static bool takes_films(enum sub_command command)
{
    return command >= COMMAND_INFO;
}

bool sub_command_takes(enum sub_command command, enum option_id id)
{
    switch (id) {
    case OPTION_HELP:
    case OPTION_VERSION: return true;
    case OPTION_TILES:
    case OPTION_FALSE_ALARMS: return command == COMMAND_COMPARE;
    case OPTION_CSV: return command == COMMAND_CURVE;
    case OPTION_SEEDS: return command == COMMAND_REFERENCE;
    case OPTION_OUTPUT:
        return command != COMMAND_REFERENCE && command != COMMAND_INFO;
    case OPTION_EXPOSURE:
    case OPTION_TONE:
        return command == COMMAND_MERGE || command == COMMAND_DEVELOP;
    case OPTION_DENOISE:
        return command == COMMAND_RENDER || command == COMMAND_MERGE ||
               command == COMMAND_DEVELOP;
    case OPTION_SCENE:
    case OPTION_VIEW:
    case OPTION_WIDTH:
    case OPTION_HEIGHT:
    case OPTION_SPP:
    case OPTION_BOUNCES:
    case OPTION_SEED:
    case OPTION_CROP:
    case OPTION_TIME:
    case OPTION_ADAPTIVE:
    case OPTION_NO_ADAPTIVE:
    case OPTION_UP:
    case OPTION_SUN:
    case OPTION_TURBIDITY:
    case OPTION_THREADS:
    case OPTION_BACKEND:
    case OPTION_DEVICE:
        return command != COMMAND_COMPARE && !takes_films(command);
    default: return command == COMMAND_RENDER;
    }
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

bool sub_command_set_operand(struct options *o, const char *path,
                             struct error *err)
{
    const char **operands[2];

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

/* Checks the name of the picture that is written. */
static bool check_output(const struct options *o, struct error *err)
{
    static const struct {
        const char *place, *expected;
        bool takes_png, takes_pfm;
    } rules[] = {
        [COMMAND_COMPARE] = {"-o: ", ".png or .pfm", true, true},
        [COMMAND_CURVE] = {"-o: ", ".png", true, false},
        [COMMAND_REFERENCE] = {"", ".pfm", false, true},
    };
    const char *path = o->output_path;
    enum image_write_format format;

    if (!path)
        return true;
    format = image_write_format_of(path);
    if (strcmp(path, "-") != 0 &&
        ((format == IMAGE_WRITE_PNG && rules[o->command].takes_png) ||
         (format == IMAGE_WRITE_PFM && rules[o->command].takes_pfm)))
        return true;
    return fail(err, "%sfound '%s', expected a name that ends in %s",
                rules[o->command].place, path, rules[o->command].expected);
}

static bool check_films(const struct options *o, struct error *err)
{
    bool needs_output = o->command != COMMAND_INFO;

    if (o->film_count == 0 || (needs_output && !o->output_path) ||
        (o->command == COMMAND_DEVELOP && o->film_count > 1))
        return fail(err,
                    "found %d film%s%s, expected: glim%s %s (see glim "
                    "--help)",
                    o->film_count, o->film_count == 1 ? "" : "s",
                    needs_output && !o->output_path ? " and no -o" : "",
                    names[o->command],
                    o->command == COMMAND_INFO    ? "FILM ..."
                    : o->command == COMMAND_MERGE ? "-o OUT FILM ..."
                                                  : "-o PICTURE FILM");
    return true;
}

bool sub_command_check(struct options *o, struct error *err)
{
    static const char *const expected[] = {
        [COMMAND_COMPARE] = "picture.pfm reference.pfm",
        [COMMAND_CURVE] = "reference.pfm scene.obj",
        [COMMAND_REFERENCE] = "out.pfm scene.obj",
    };
    const char **operands[2];

    if (takes_films(o->command))
        return check_films(o, err);
    operands_of(o, operands);
    if (!*operands[0] || !*operands[1])
        return fail(err,
                    "found too few files, expected: glim%s [options] %s (see "
                    "glim --help)",
                    names[o->command], expected[o->command]);
    return check_output(o, err);
}
