// SPDX-License-Identifier: MIT
/* The command line: each line of the input is an argument. */
#include "fuzz.h"
#include "session/command_line.h"

#define ARGUMENTS_MAX 64

static void check(const struct options *o)
{
    require(o->show_help || o->show_version || o->scene_path ||
                o->list_devices || o->list_formats || o->list_sessions ||
                o->probe || o->is_worker || o->film_count > 0 ||
                (o->picture_path && o->reference_path),
            "a scene, films or two pictures");
    require(o->error_limit >= 0 && o->error_limit <= 1, "an error");
    require(o->time_ns <= UINT64_C(1000000000000000000), "a time");
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    static char name[] = "glim";
    char *text = strndup((const char *)data, size);
    char *argv[ARGUMENTS_MAX + 2] = {name};
    int argc = 1;
    struct options options;
    struct error err = {""};

    require(text != NULL, "memory");
    for (char *p = text; p != NULL && argc <= ARGUMENTS_MAX;)
        argv[argc++] = strsep(&p, "\n");
    options_init(&options);
    if (!options_parse(&options, argc, argv, &err))
        fuzz_check_message(err.text);
    else
        check(&options);
    free(options.films);
    free(options.view_lines);
    free(text);
    return 0;
}
