// SPDX-License-Identifier: MIT
#include "session/sub_command.h"

#include <string.h>

#include "picture/image_write.h"

const char sub_command_help[] =
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
    [COMMAND_RENDER] = "",
    [COMMAND_COMPARE] = " compare",
    [COMMAND_CURVE] = " curve",
    [COMMAND_REFERENCE] = " reference",
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

bool sub_command_takes(enum sub_command command, enum option_id id)
{
    switch (id) {
    case OPTION_HELP:
    case OPTION_VERSION: return true;
    case OPTION_TILES:
    case OPTION_FALSE_ALARMS: return command == COMMAND_COMPARE;
    case OPTION_CSV: return command == COMMAND_CURVE;
    case OPTION_SEEDS: return command == COMMAND_REFERENCE;
    case OPTION_OUTPUT: return command != COMMAND_REFERENCE;
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
    case OPTION_DEVICE: return command != COMMAND_COMPARE;
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

bool sub_command_check(struct options *o, struct error *err)
{
    static const char *const expected[] = {
        [COMMAND_COMPARE] = "picture.pfm reference.pfm",
        [COMMAND_CURVE] = "reference.pfm scene.obj",
        [COMMAND_REFERENCE] = "out.pfm scene.obj",
    };
    const char **operands[2];

    operands_of(o, operands);
    if (!*operands[0] || !*operands[1])
        return fail(err,
                    "found too few files, expected: glim%s [options] %s (see "
                    "glim --help)",
                    names[o->command], expected[o->command]);
    return check_output(o, err);
}
