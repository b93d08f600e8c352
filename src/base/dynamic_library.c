// SPDX-License-Identifier: MIT
#include "base/dynamic_library.h"

#include <dlfcn.h>
#include <string.h>

bool dynamic_library_load(const char *file,
                          const struct library_function *functions,
                          size_t count, void *table, const char **missing)
{
    void *library = dlopen(file, RTLD_NOW | RTLD_LOCAL);

    *missing = NULL;
    if (library == NULL)
        return false;
    for (size_t i = 0; i < count; i++) {
        void *function = dlsym(library, functions[i].name);

        if (function == NULL) {
            *missing = functions[i].name;
            return false;
        }
        /* ISO C does not allow a cast from object pointer to function
         * pointer */
        memcpy((char *)table + functions[i].offset, &function, sizeof function);
    }
    return true;
}
