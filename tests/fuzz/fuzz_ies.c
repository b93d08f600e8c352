// SPDX-License-Identifier: MIT
/* IES text. Profiles are finite, and some light is in them. */
#include <math.h>

#include "fuzz.h"
#include "mutate_text.h"
#include "read/ies.h"

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    struct error err = {""};
    struct profile *p = ies_parse((const char *)data, size, "a.ies", &err);

    if (p == NULL) {
        fuzz_check_message(err.text);
        return 0;
    }
    require(p->columns > 0, "columns");
    for (uint32_t i = 0; i < profile_value_count(p); i++)
        require(p->values[i] >= 0 && isfinite(p->values[i]), "values");
    profile_release(p);
    return 0;
}
