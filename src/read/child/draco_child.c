// SPDX-License-Identifier: MIT
#include "read/child/draco_child.h"

#include <stdlib.h>

#include "base/file.h"
#include "read/child/draco_decode.h"

bool draco_child(struct library_limits limits, FILE *to)
{
    struct error err;
    size_t size_bytes;
    char *requests;
    bool ok;

    library_child_limit(limits);
    if (!file_read_stdin(&requests, &size_bytes, &err))
        return library_child_fail(to, &err);
    ok = draco_decode(requests, size_bytes, to);
    free(requests);
    return ok;
}
