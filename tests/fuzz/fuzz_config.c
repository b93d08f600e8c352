// SPDX-License-Identifier: MIT
/* The user's configuration file, and the keys that remain for other actions. */
#include "fuzz.h"
#include "mutate_text.h"
#include "session/config.h"

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    static char name[] = "glim", scene[] = "a.obj";
    char *argv[] = {name, scene, NULL};
    struct options options;
    struct error err = {""};
    char folder[512];

    snprintf(folder, sizeof folder, "%s/glim", fuzz_folder());
    mkdir(folder, 0700);
    setenv("XDG_CONFIG_HOME", fuzz_folder(), 1);
    free(fuzz_put("glim/config", data, size));
    options_init(&options);
    if (!config_read(&options, &err))
        fuzz_check_message(err.text);
    else
        require(options_parse(&options, 2, argv, &err), err.text);
    return 0;
}
