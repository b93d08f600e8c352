// SPDX-License-Identifier: MIT
#include "read/child/assimp_api.h"

#include <stddef.h>

#include "base/library_child.h"

#if HAS_ASSIMP

#define LIBRARY "libassimp.so.5"

static const struct library_function functions[] = {
#define ROW(name) {"ai" #name, offsetof(struct assimp_api, name)},
    ASSIMP_FUNCTIONS(ROW)
#undef ROW
};

const struct assimp_api *assimp_api_open(struct error *err)
{
    static struct assimp_api api;
    const char *missing;

    if (dynamic_library_load(LIBRARY, functions,
                             sizeof functions / sizeof functions[0], &api,
                             &missing))
        return &api;
    if (missing == NULL)
        fail(err, "found no %s (Debian's package: %s)", LIBRARY,
             ASSIMP_PACKAGE);
    else
        fail(err, "%s has no %s", LIBRARY, missing);
    return NULL;
}

#else

const struct assimp_api *assimp_api_open(struct error *err)
{
    fail(err, "this glim was built without libassimp-dev");
    return NULL;
}

#endif
