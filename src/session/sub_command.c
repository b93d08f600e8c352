// SPDX-License-Identifier: MIT
#include "session/sub_command.h"

#include <string.h>

#include "picture/image_write.h"

static const char *const names[] = {
    [COMMAND_RENDER] = "",
    [COMMAND_COMPARE] = " compare",
    [COMMAND_CURVE] = " curve",
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
    case OPTION_OUTPUT: return true;
    case OPTION_SCENE:
    case OPTION_VIEW:
    case OPTION_WIDTH:
    case OPTION_HEIGHT:
    case OPTION_SPP:
    case OPTION_BOUNCES:
    case OPTION_SEED:
    case OPTION_CROP:
    case OPTION_UP:
    case OPTION_THREADS:
    case OPTION_BACKEND:
    case OPTION_DEVICE: return command != COMMAND_COMPARE;
    default: return command == COMMAND_RENDER;
    }
}

/* Returns the operands of a sub-command in their order; NULL: no second one. */
static void operands_of(struct options *o, const char **operands[2])
{
    operands[0] = &o->reference_path;
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

/* Checks the name of the picture that -o draws. */
static bool check_output(const struct options *o, struct error *err)
{
    bool may_be_pfm = o->command == COMMAND_COMPARE;
    enum image_write_format format;

    if (!o->output_path)
        return true;
    format = image_write_format_of(o->output_path);
    if (strcmp(o->output_path, "-") != 0 &&
        (format == IMAGE_WRITE_PNG ||
         (may_be_pfm && format == IMAGE_WRITE_PFM)))
        return true;
    return fail(err, "-o: found '%s', expected a name that ends in .png%s",
                o->output_path, may_be_pfm ? " or .pfm" : "");
}

bool sub_command_check(const struct options *o, struct error *err)
{
    static const char *const expected[] = {
        [COMMAND_COMPARE] = "picture.pfm reference.pfm",
        [COMMAND_CURVE] = "reference.pfm scene.obj",
    };
    bool is_complete =
        o->reference_path &&
        (o->command == COMMAND_COMPARE ? o->picture_path : o->scene_path);

    if (!is_complete)
        return fail(err,
                    "found too few files, expected: glim%s [options] %s (see "
                    "glim --help)",
                    names[o->command], expected[o->command]);
    return check_output(o, err);
}
