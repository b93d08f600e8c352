// SPDX-License-Identifier: MIT
/* The command line: each line of the input is an argument. */
#include "session/command_line.h"
#include "fuzz.h"

#define ARGUMENTS_MAX 64

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
    else if (!options.show_help && !options.show_version)
        require(options.scene_path || options.list_devices || options.probe ||
                    (options.picture_path && options.reference_path),
                "a scene or two pictures");
    free(text);
    return 0;
}
