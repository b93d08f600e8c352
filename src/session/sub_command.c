// SPDX-License-Identifier: MIT
#include "session/sub_command.h"

#include <string.h>

#include "picture/image_write.h"

static const char *const names[] = {
    [COMMAND_RENDER] = "",
    [COMMAND_COMPARE] = " compare",
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
    case OPTION_OUTPUT:
        return command == COMMAND_RENDER || command == COMMAND_COMPARE;
    default: return command == COMMAND_RENDER;
    }
}

bool sub_command_set_operand(struct options *o, const char *path,
                             struct error *err)
{
    const char **to = !o->picture_path ? &o->picture_path : &o->reference_path;

    if (o->command == COMMAND_RENDER)
        return option_set_scene(o, path, err);
    if (*to)
        return fail(err, "found a third picture '%s', expected two", path);
    *to = path;
    return true;
}

bool sub_command_check(const struct options *o, struct error *err)
{
    enum image_write_format format = o->output_path
                                         ? image_write_format_of(o->output_path)
                                         : IMAGE_WRITE_PNG;

    if (!o->picture_path || !o->reference_path)
        return fail(err,
                    "found %s, expected: glim compare [options] "
                    "picture.pfm reference.pfm (see glim --help)",
                    o->picture_path ? "one picture" : "no pictures");
    if ((format != IMAGE_WRITE_PNG && format != IMAGE_WRITE_PFM) ||
        (o->output_path && strcmp(o->output_path, "-") == 0))
        return fail(err,
                    "-o: found '%s', expected a name that ends in .png or .pfm",
                    o->output_path);
    return true;
}
