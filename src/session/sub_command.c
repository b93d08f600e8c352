// SPDX-License-Identifier: MIT
#include "session/sub_command.h"

#include <inttypes.h>
#include <string.h>
#include <strings.h>

#include "base/print.h"
#include "terminal/xmalloc.h"

static const struct sub_command_rule rules[] = {
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

#define COMMAND_COUNT (int)(sizeof rules / sizeof rules[0])

const struct sub_command_rule *sub_command_rule(int i)
{
    return i + 1 < COMMAND_COUNT ? &rules[i + 1] : NULL;
}

enum sub_command sub_command_named(const char *name)
{
    for (int i = COMMAND_RENDER + 1; i < COMMAND_COUNT; i++)
        if (strcmp(rules[i].name + 1, name) == 0)
            return (enum sub_command)i;
    return COMMAND_RENDER;
}

const char *sub_command_name(enum sub_command command)
{
    return rules[command].name;
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
        return command != COMMAND_COMPARE && command != COMMAND_INFO;
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
    case OPTION_EYE:
    case OPTION_AT:
    case OPTION_UP:
    case OPTION_FOV:
    case OPTION_CAMERA:
    case OPTION_LIGHT_UNIT:
    case OPTION_SCENE_PART:
    case OPTION_VARIANT:
    case OPTION_ANIMATION:
    case OPTION_ANIM_TIME:
    case OPTION_SKY:
    case OPTION_SKY_STRENGTH:
    case OPTION_SKY_ROTATION:
    case OPTION_SUN:
    case OPTION_TURBIDITY:
    case OPTION_THREADS:
    case OPTION_BACKEND:
    case OPTION_DEVICE:
        return command != COMMAND_COMPARE && !takes_films(command);
    default: return command == COMMAND_RENDER;
    }
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

/* Checks the name of the file that is written. */
static bool check_output(const struct options *o, struct error *err)
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

static bool check_films(const struct options *o, struct error *err)
{
    bool needs_output = o->command != COMMAND_INFO;

    if (o->film_count == 0 || (needs_output && !o->output_path) ||
        (o->command == COMMAND_DEVELOP && o->film_count > 1))
        return fail(err,
                    "found %d film%s%s, expected: glim%s %s (see glim "
                    "--help)",
                    o->film_count, print_plural((uint64_t)o->film_count),
                    needs_output && !o->output_path ? " and no -o" : "",
                    rules[o->command].name, rules[o->command].operands);
    return !o->denoise || !o->output_path || !options_output_is_film(o) ||
           fail(err, "--denoise: found -o %s, a film, expected a picture",
                o->output_path);
}

bool sub_command_check(struct options *o, struct error *err)
{
    const char **operands[2];

    if (takes_films(o->command))
        return check_films(o, err);
    operands_of(o, operands);
    if (!*operands[0] || !*operands[1])
        return fail(err,
                    "found too few files, expected: glim%s %s (see glim "
                    "--help)",
                    rules[o->command].name, rules[o->command].operands);
    if (o->csv_path && strcmp(o->csv_path, "-") == 0)
        return fail(err, "--csv: found -, expected the name of a file");
    return check_output(o, err) && check_seeds(o, err);
}
