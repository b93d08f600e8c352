// SPDX-License-Identifier: MIT
#include "session/option_rules.h"

#include <string.h>

static const struct option_rule picture[] = {
    {"f", OPTION_SCENE, "the name of a scene", "FILE",
     "the scene, or - with -b; -f may be omitted"},
    {"formats", OPTION_FORMATS, NULL, NULL,
     "list the formats of scenes that glim reads"},
    {"c", OPTION_VIEW, "the name of a view file", "FILE",
     "the view file (default: SCENE.view beside the scene)"},
    {"w", OPTION_WIDTH, "a width in pixels", "WIDTH",
     "in pixels (default: from the view file, or 1024)"},
    {"h", OPTION_HEIGHT, "a height in pixels", "HEIGHT",
     "in pixels (default: from the view file, or 576)"},
    {"s", OPTION_SPP, "a number of samples", "SAMPLES",
     "stop at this number of samples per pixel (default: 16, or none "
     "with -e or --time)"},
    {"e", OPTION_ERROR, "an error such as 1% or 0.01", "ERROR",
     "stop at this error of the picture, such as 1% or 0.01"},
    {"time", OPTION_TIME, "a time such as 90, 1.5m or 2h", "TIME",
     "stop after this time of rendering, such as 90, 1.5m or 2h"},
    {"adaptive", OPTION_ADAPTIVE, NULL, NULL,
     "more samples where the error is (default with -e, and with --denoise "
     "without a file)"},
    {"no-adaptive", OPTION_NO_ADAPTIVE, NULL, NULL,
     "the same number of samples in each pixel"},
    {"d", OPTION_BOUNCES, "a number of bounces", "BOUNCES",
     "most bounces of a path, 0 to 999 (default: from the view file, or "
     "no limit)"},
    {"seed", OPTION_SEED, "a number", "N",
     "seed of the noise, 0 to 4294967295 (default: 0)"},
    {"crop", OPTION_CROP, "X,Y,W,H in pixels", "X,Y,W,H",
     "render W x H pixels with (X, Y) as the upper left one"},
    {"eye", OPTION_EYE, "X,Y,Z", "X,Y,Z",
     "position of the camera, instead of the view's"},
    {"at", OPTION_AT, "X,Y,Z", "X,Y,Z", "point that the camera looks at"},
    {"up", OPTION_UP, "y, z or a direction X,Y,Z", "y|z|X,Y,Z",
     "y or z: axis that points up in the scene file (default: that of its "
     "format); X,Y,Z: upward direction of the picture"},
    {"fov", OPTION_FOV, "an angle in degrees", "DEGREES",
     "vertical field of view"},
    {"camera", OPTION_CAMERA, "the number or name of a camera", "N|NAME",
     "a numbered view of the view file, or a camera of the scene file"},
    {"scene", OPTION_SCENE_PART, "the number or name of a scene", "N|NAME",
     "one of several scenes of a glTF file (default: the file's own)"},
    {"variant", OPTION_VARIANT, "the number or name of a variant", "N|NAME",
     "variant of the materials of a glTF file (default: none)"},
    {"animation", OPTION_ANIMATION, "the number or name of an animation",
     "N|NAME", "animation of a glTF file that poses it (default: 1)"},
    {"anim-time", OPTION_ANIM_TIME, "a time in seconds", "SECONDS",
     "pose a glTF file as its animation does then (default: at rest)"},
    {"sky", OPTION_SKY, "an image file or a colour", "FILE|COLOUR",
     "image of the sky, or its radiance: R,G,B, #rrggbb or 5000K"},
    {"sky-strength", OPTION_SKY_STRENGTH, "a number", "X",
     "factor for the sky image or the sun with its sky"},
    {"sky-rotation", OPTION_SKY_ROTATION, "an angle in degrees", "DEGREES",
     "rotation of the sky about the vertical axis"},
    {"exposure", OPTION_EXPOSURE, "a number of stops", "STOPS",
     "exposure of the picture; also of merge and develop"},
    {"tone", OPTION_TONE, "linear, reinhard or aces", "KIND",
     "tone curve: linear, reinhard or aces; also of merge and develop"},
    {"light-unit", OPTION_LIGHT_UNIT, "auto, lumen, watt or none", "UNIT",
     "unit of the lights of glTF: auto, lumen, watt or none"},
    {"sun", OPTION_SUN, "AZ,EL in degrees", "AZ,EL",
     "the sun in a clear sky, AZ degrees clockwise from -z and EL above "
     "the horizon, instead of the view's sky"},
    {"turbidity", OPTION_TURBIDITY, "a number", "T",
     "haze of the sun's sky, 1.7 to 10 (default: from the view file, or "
     "3)"},
    {"t", OPTION_THREADS, "a number of threads", "THREADS",
     "1 to 1024 threads (default: one for each processor)"},
    {"stats", OPTION_STATS, "the name of a file", "FILE",
     "write times and counts as JSON, - to standard output"},
};

static const struct option_rule device[] = {
    {"backend", OPTION_BACKEND, "cpu, opencl or auto", "KIND",
     "cpu, opencl or auto: an OpenCL GPU if there is one, else the CPU "
     "(default: cpu)"},
    {"device", OPTION_DEVICE, "the number or name of a device", "N|NAME",
     "number or part of the name of the OpenCL device (default: the "
     "first GPU, or the first device)"},
    {"list-devices", OPTION_LIST_DEVICES, NULL, NULL,
     "list the OpenCL devices"},
    {"kernels", OPTION_KERNELS, "the name of a folder", "FOLDER",
     "read the OpenCL kernels from this folder"},
    {"isa", OPTION_ISA, "the name of a set of instructions", "NAME",
     "instruction set: plain, avx2 or avx512 (default: the best of the "
     "processor, see --version)"},
    /* internal, see cl_probe.h */
    {"probe", OPTION_PROBE, "a number of features", NULL, NULL},
    /* internal, see import.h */
    {"import", OPTION_IMPORT, "limits of time and memory", NULL, NULL},
    /* internal, see gltf_draco.h */
    {"unpack", OPTION_UNPACK, "limits of time and memory", NULL, NULL},
};

static const struct option_rule cluster[] = {
    {"ranks", OPTION_RANKS, "a number of processes", "N",
     "start N processes that render together"},
    /* internal, see cluster.h */
    {"worker", OPTION_WORKER, NULL, NULL, NULL},
};

static const struct option_rule batch[] = {
    {"b", OPTION_BATCH, NULL, NULL, "render to a file, without the screen"},
    {"o", OPTION_OUTPUT, "the name of a picture", "FILE",
     ".png, .hdr, .pfm or .exr file to write or replace, or - for standard "
     "output (default: a new .png file in the current folder, named "
     "after the scene)"},
    {"turntable", OPTION_TURNTABLE, "a number of frames", "N",
     "render N pictures around the point that the camera looks at, to "
     "numbered files such as out-0000.png"},
    {"fly", OPTION_FLY, "a number of frames", "N",
     "render N pictures along a smooth path through the numbered views"},
    {"frames", OPTION_FRAMES, "A:B", "A:B",
     "only frames A to B, from 0 on, of these; alone, frames of the animation "
     "of a glTF file"},
    {"fps", OPTION_FPS, "a number", "N",
     "frames of a second of animation or video, 1 to 1000 (default: 24)"},
    {"denoise", OPTION_DENOISE, "the name of a picture", "[=FILE]",
     "filter the noise out of the picture; with a file write the "
     "filtered picture to this .png, .hdr, .pfm or .exr file and the "
     "unfiltered one to that of -o"},
    {"ansi", OPTION_ANSI, "COLSxROWS in characters", "COLSxROWS",
     "write coloured text of at most this size instead of a picture, to "
     "the file of -o or standard output"},
    {"error-map", OPTION_ERROR_MAP, "the name of a picture", "FILE",
     "write a .png, .hdr, .pfm or .exr picture of the error of each pixel: "
     "heat colours from black, 0.1 %, to white, 100 %"},
    {"aov", OPTION_AOV,
     "a list of albedo, normals, position, depth, uv, object and material",
     "LIST",
     "also write properties of the surfaces, to files such as "
     "out.normals.pfm, or to layers of an .exr file: a list of albedo, "
     "normals, position, depth, uv, object and material, with commas"},
    {"show", OPTION_SHOW,
     "light, preview, normals, faces, uvs, depth, materials or cost", "KIND",
     "preview, normals, faces, uvs, depth, materials or cost instead of "
     "light"},
};

static const struct option_rule films[] = {
    {"film", OPTION_FILM, "the name of a film", "FILE",
     "write the film, the exact sums of all samples"},
    {"checkpoint", OPTION_CHECKPOINT, "the name of a film", "FILE",
     "write the film at the end, after a signal, and while rendering"},
    {"checkpoint-interval", OPTION_CHECKPOINT_INTERVAL,
     "a time such as 90, 1.5m or 2h", "TIME",
     "time between checkpoints (default: 60)"},
    {"resume", OPTION_RESUME, "the name of a film", "FILE",
     "go on with a film of the same picture; if it is that of "
     "--checkpoint it may be missing at first"},
    {"share", OPTION_SHARE, "I/N such as 3/8", "I/N",
     "render only share I, from 1 to N, of the samples"},
};

static const struct option_rule screen[] = {
    {"color", OPTION_COLOR, "24, 256, 16, mono or auto", "MODE",
     "24, 256, 16, mono or auto (default: auto)"},
    {"glyph", OPTION_GLYPH,
     "auto, half, upper, lower, quadrant, sextant, braille, space, "
     "ascii, sixel or kitty",
     "KIND",
     "characters: half, upper, lower, quadrant, sextant, braille, space "
     "or ascii; pixels: sixel or kitty; or auto: half or space, without "
     "colours braille or ascii (default: auto)"},
    {"theme", OPTION_THEME, "auto, dark, light or plain", "NAME",
     "colours of the text: dark, light, plain (the terminal's own) or auto: "
     "as the terminal's background (default: auto)"},
    {"cell-aspect", OPTION_CELL_ASPECT, "a number", "R",
     "height of a character over its width, 0.25 to 8 (default: ask the "
     "terminal)"},
    {"filter", OPTION_FILTER, NULL, NULL,
     "filter the noise out of the picture on the screen in live mode "
     "(default)"},
    {"no-filter", OPTION_NO_FILTER, NULL, NULL,
     "show the picture with its noise"},
    {"watch", OPTION_WATCH, NULL, NULL,
     "load the scene's files again when they change"},
    {"sessions", OPTION_SESSIONS, NULL, NULL, "list kept sessions"},
    {"phoe-keys", OPTION_PHOE_KEYS, NULL, NULL,
     "W S A D Q E move up, down, left, right, forward, back"},
};

static const struct option_rule measurements[] = {
    {"seeds", OPTION_SEEDS, "a number of seeds", "N",
     "4 to 64 seeds (default: 8), from --seed on (default: 1000000)"},
    {"csv", OPTION_CSV, "the name of a file", "FILE",
     "write the curve as comma-separated values"},
    {"tiles", OPTION_TILES, "a number of tiles", "N",
     "most tiles each way, 1 to 256 (default: 16)"},
    {"false-alarms", OPTION_FALSE_ALARMS, "a probability", "P",
     "probability that anything is marked although only noise differs "
     "(default: 0.01)"},
};

static const struct option_rule general[] = {
    {"help", OPTION_HELP, NULL, NULL, "print this text"},
    {"version", OPTION_VERSION, NULL, NULL, "print the version"},
};

#define SECTION(title, rules)                          \
    {                                                  \
        title, rules, sizeof(rules) / sizeof(rules)[0] \
    }

const struct option_section option_sections[] = {
    SECTION("scene and picture", picture),
    SECTION("device", device),
    SECTION("clusters, in a program that is built with make MPI=1", cluster),
    SECTION("batch mode", batch),
    SECTION("films, in batch mode", films),
    SECTION("screen", screen),
    SECTION("measurements", measurements),
    SECTION("general", general),
    {NULL, NULL, 0},
};

const struct option_rule *option_rule_named(const char *name, size_t length)
{
    for (const struct option_section *s = option_sections; s->title; s++)
        for (size_t i = 0; i < s->rule_count; i++)
            if (strlen(s->rules[i].name) == length &&
                memcmp(s->rules[i].name, name, length) == 0)
                return &s->rules[i];
    return NULL;
}
