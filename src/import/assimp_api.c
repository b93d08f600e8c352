// SPDX-License-Identifier: MIT
#include "import/assimp_api.h"

#include <dlfcn.h>
#include <stddef.h>
#include <string.h>

#if HAS_ASSIMP

#define LIBRARY "libassimp.so.5"

static const struct {
    const char *name;
    size_t offset; /* of the pointer in struct assimp_api */
} functions[] = {
#define ROW(name) {"ai" #name, offsetof(struct assimp_api, name)},
    ASSIMP_FUNCTIONS(ROW)
#undef ROW
};

const struct assimp_api *assimp_api_open(struct error *err)
{
    static struct assimp_api api;
    void *library = dlopen(LIBRARY, RTLD_NOW | RTLD_LOCAL);

    if (library == NULL) {
        fail(err, "found no %s (Debian's package: %s)", LIBRARY,
             ASSIMP_PACKAGE);
        return NULL;
    }
    for (size_t i = 0; i < sizeof functions / sizeof functions[0]; i++) {
        void *function = dlsym(library, functions[i].name);

        if (function == NULL) {
            fail(err, "%s has no %s", LIBRARY, functions[i].name);
            return NULL;
        }
        /* ISO C does not allow a cast from object pointer to function
         * pointer */
        memcpy((char *)&api + functions[i].offset, &function, sizeof function);
    }
    return &api;
}

#else

const struct assimp_api *assimp_api_open(struct error *err)
{
    fail(err, "this glim was built without libassimp-dev");
    return NULL;
}

#endif
